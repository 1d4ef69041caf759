/* files.c: folders, files written in one piece, and texts that grow. */
#include "core/files.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

char *ab_path_join(const char *folder, const char *name) {
    const size_t length = strlen(folder);
    char *path = malloc(length + strlen(name) + 2);
    if (path != NULL) sprintf(path, "%s%s%s", folder, length > 0 && folder[length - 1] == '/' ? "" : "/", name);
    return path;
}

ab_status ab_folder_make(const char *path, ab_report *report) {
    char *copy = strdup(path);
    if (copy == NULL) return ab_report_failure(report, "no memory to make the folder '%s'", path);
    ab_status status = AB_OK;
    for (char *end = copy + 1; status == AB_OK; end++) {
        if (*end != '/' && *end != '\0') continue;
        const char kept = *end;
        *end = '\0';
        if (mkdir(copy, 0777) != 0 && errno != EEXIST)
            status = ab_report_failure(report, "cannot make the folder '%s': %s; name another with -o", copy, strerror(errno));
        *end = kept;
        if (kept == '\0') break;
    }
    struct stat found;
    if (status == AB_OK && (stat(path, &found) != 0 || !S_ISDIR(found.st_mode)))
        status = ab_report_failure(report, "'%s' is not a folder; name another with -o", path);
    free(copy);
    return status;
}

static int write_all(int file, const char *bytes, size_t count) {
    while (count > 0) {
        const size_t most = (size_t)1 << 30; /* one call never moves more than 2 GiB */
        const ssize_t done = write(file, bytes, count < most ? count : most);
        if (done < 0 && errno == EINTR) continue;
        if (done < 0) return errno;
        bytes += done;
        count -= (size_t)done;
    }
    return 0;
}

ab_status ab_file_replace(const char *path, const void *bytes, size_t count, ab_report *report) {
    char *beside = malloc(strlen(path) + 6);
    if (beside == NULL) return ab_report_failure(report, "no memory to write '%s'", path);
    sprintf(beside, "%s.part", path);
    unlink(beside); /* of a run that was killed; or a link, which may lead out of the folder */
    const int file = open(beside, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
    int failed = file < 0 ? errno : write_all(file, bytes, count);
    if (file >= 0 && close(file) != 0 && failed == 0) failed = errno; /* a network disk reports a full disk here */
    if (failed == 0 && rename(beside, path) != 0) failed = errno;
    if (failed != 0 && file >= 0) unlink(beside);
    free(beside);
    if (failed != 0)
        return ab_report_failure(report, "cannot write '%s' (%zu bytes): %s; what was written before is kept", path, count,
                                 strerror(failed));
    return AB_OK;
}

/* ---- texts ---- */

static bool text_reserve(ab_text *text, size_t more) {
    if (text->failed) return false;
    if (text->count + more <= text->capacity) return true;
    size_t capacity = text->capacity < 1024 ? 1024 : text->capacity;
    while (capacity < text->count + more) capacity *= 2;
    char *bytes = realloc(text->bytes, capacity);
    if (bytes == NULL) {
        text->failed = true;
        return false;
    }
    text->bytes = bytes;
    text->capacity = capacity;
    return true;
}

void ab_text_add(ab_text *text, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (length < 0 || !text_reserve(text, (size_t)length + 1)) {
        text->failed = true;
        return;
    }
    va_start(arguments, format);
    vsnprintf(text->bytes + text->count, (size_t)length + 1, format, arguments);
    va_end(arguments);
    text->count += (size_t)length;
}

void ab_text_add_escaped(ab_text *text, const char *string) {
    if (string == NULL) {
        ab_text_add(text, "null");
        return;
    }
    ab_text_add(text, "\"");
    for (; *string != '\0'; string++) {
        const unsigned char c = (unsigned char)*string;
        if (c == '"' || c == '\\')
            ab_text_add(text, "\\%c", c);
        else if (c == '\n')
            ab_text_add(text, "\\n");
        else if (c < 0x20 || c == 0x7f)
            ab_text_add(text, "\\u%04x", c);
        else
            ab_text_add(text, "%c", c);
    }
    ab_text_add(text, "\"");
}

void ab_text_add_xml(ab_text *text, const char *string) {
    for (; *string != '\0'; string++) {
        const unsigned char c = (unsigned char)*string;
        if (c == '&')
            ab_text_add(text, "&amp;");
        else if (c == '<')
            ab_text_add(text, "&lt;");
        else if (c == '>')
            ab_text_add(text, "&gt;");
        else if (c == '"')
            ab_text_add(text, "&quot;");
        else if (c >= 0x20)
            ab_text_add(text, "%c", c);
    }
}

void ab_text_add_csv(ab_text *text, const char *field) {
    if (strpbrk(field, ",\"\n") == NULL) {
        ab_text_add(text, "%s", field);
        return;
    }
    ab_text_add(text, "\"");
    for (; *field != '\0'; field++) ab_text_add(text, *field == '"' ? "\"\"" : "%c", *field);
    ab_text_add(text, "\"");
}

void ab_text_add_number(ab_text *text, double value) {
    if (!isfinite(value)) {
        ab_text_add(text, "null");
        return;
    }
    char digits[32];
    snprintf(digits, sizeof digits, "%.15g", value);
    if (strtod(digits, NULL) != value) snprintf(digits, sizeof digits, "%.17g", value);
    ab_text_add(text, "%s", digits);
}

void ab_text_clear(ab_text *text) {
    free(text->bytes);
    *text = (ab_text){0};
}

ab_status ab_text_write(ab_text *text, const char *folder, const char *name, ab_report *report) {
    char *path = ab_path_join(folder, name);
    const ab_status status = text->failed || path == NULL ? ab_report_failure(report, "no memory for %s", name)
                                                          : ab_file_replace(path, text->bytes, text->count, report);
    free(path);
    ab_text_clear(text);
    return status;
}
