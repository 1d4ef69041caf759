/* files.h: files that are either whole or absent. */
#ifndef AB_FILES_H
#define AB_FILES_H

#include "core/report.h"

/* Makes a folder with its parents; no error where it exists already. */
ab_status ab_folder_make(const char *path, ab_report *report);
/* Puts bytes into `path`: a file beside it is written, closed and renamed, so that a reader finds the old text or the new one. */
ab_status ab_file_replace(const char *path, const void *bytes, size_t count, ab_report *report);
/* "folder/name" in memory of its own; NULL without memory. */
char *ab_path_join(const char *folder, const char *name);

/* A text that grows. A failed allocation is remembered and found at the end by ab_text_failed. */
typedef struct ab_text {
    char *bytes;
    size_t count, capacity;
    bool failed;
} ab_text;
void ab_text_add(ab_text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));
void ab_text_add_escaped(ab_text *text, const char *string); /* a JSON string with its quotes */
void ab_text_add_xml(ab_text *text, const char *string);     /* & < > " escaped */
void ab_text_add_csv(ab_text *text, const char *field);      /* in quotes where it holds commas, quotes or ends of lines */
void ab_text_add_number(ab_text *text, double value);        /* shortest JSON number that reads back the same; null for NaN and infinity */
void ab_text_clear(ab_text *text);                           /* frees */
/* The text as the file folder/name, by ab_file_replace; the text is freed. */
ab_status ab_text_write(ab_text *text, const char *folder, const char *name, ab_report *report);

#endif
