/* table_lines.h: lines of a text, cells of a line, numbers in cells: as instruments and spreadsheets write columns. */
#ifndef AB_TABLE_LINES_H
#define AB_TABLE_LINES_H

#include "core/quantity.h"

typedef struct ab_cell {
    const char *begin; /* in the text; without blanks and quotes around it */
    size_t length;
} ab_cell;

typedef struct ab_line {
    const char *start;       /* of the line in the text */
    const char *begin, *end; /* without comment and blanks at both ends; equal: nothing in it */
    const char *comment;     /* behind '#', to comment_end; NULL: none */
    const char *comment_end;
    int number; /* from 1; 0 before the first call */
} ab_line;

/* The line at *at of a text that ends at `end`; *at goes on to the next one. "\n", "\r\n" and "\r" end lines. False at the end. */
bool ab_line_next(const char **at, const char *end, ab_line *line);

/* ';', a tab, ',' or ' ' (any blanks): the first of these that the text holds. */
char ab_line_separator(const char *begin, const char *end);

/* Cells; blanks inside of brackets and all inside of quotes separate nothing; a separator at the very end opens no cell. At most `most` are kept; returns how many there are. */
size_t ab_line_split(char separator, const char *begin, const char *end, ab_cell *cells, size_t most);

/* A decimal number; also as Fortran writes it (1.5D-3, 007.50). `why`: of AB_LITERAL_REFUSED. */
ab_literal ab_cell_number(const ab_cell *cell, double *value, char *why, size_t size);

/* For a message: at most 40 bytes, without what would upset a terminal. */
const char *ab_cell_shown(const ab_cell *cell, char text[48]);

#endif
