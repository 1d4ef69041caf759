/* checkpoint.c: the file: records on their way to the disk and back. */
#define _GNU_SOURCE
#include "core/checkpoint_inner.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

static const char MAGIC[16] = "abut checkpoint\n";
enum { FORMAT = 1, ORDER = 0x01020304, BUFFER = 1 << 20, MOST_RECORDS = 1 << 26 };

typedef struct head { /* 64 bytes; each entry where every format has it */
    char magic[16];
    uint32_t format, order;
    uint64_t bytes;   /* of the file */
    uint32_t crc;     /* of all of it, with this 0 */
    char version[28]; /* of the program */
} head;

typedef struct record_head {
    uint32_t name, type; /* length of the name, without NUL */
    uint64_t count;
} record_head;

static const char *const WORD[] = {"", "doubles", "64-bit numbers", "32-bit numbers", "bytes"};

static size_t padded(size_t bytes) { return (bytes + 7) / 8 * 8; }

bool ab_checkpoint_loads(const ab_checkpoint *c) { return c->part == NULL; }
ab_report *ab_checkpoint_report(const ab_checkpoint *c) { return c->report; }
const char *ab_checkpoint_path(const ab_checkpoint *c) { return c->path; }
ab_status ab_checkpoint_status(const ab_checkpoint *c) { return c->status; }

bool ab_checkpoint_refuse(ab_checkpoint *c, const char *format, ...) {
    if (c->status != AB_OK) return false;
    char text[600];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    c->status = ab_checkpoint_loads(c) ? ab_report_error(c->report, AB_NOWHERE, "checkpoint '%s': %s", c->path, text)
                                       : ab_report_failure(c->report, "cannot write checkpoint '%s': %s", c->path, text);
    return false;
}

void ab_checkpoint_enter(ab_checkpoint *c, const char *format, ...) {
    const size_t used = strlen(c->prefix);
    c->depths[c->depth++] = used;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(c->prefix + used, sizeof c->prefix - used - 2, format, arguments);
    va_end(arguments);
    strcat(c->prefix, ".");
}

void ab_checkpoint_leave(ab_checkpoint *c) { c->prefix[c->depths[--c->depth]] = '\0'; }

/* ---- writing ---------------------------------------------------------------------------------------------------------------- */

static void flush(ab_checkpoint *c) {
    const char *bytes = c->buffer;
    size_t left = c->buffered;
    c->buffered = 0;
    while (left > 0 && c->error == 0) {
        const ssize_t done = write(c->file, bytes, left);
        if (done < 0 && errno == EINTR) continue;
        if (done < 0) c->error = errno;
        if (done > 0) bytes += done, left -= (size_t)done;
    }
}

static void add(ab_checkpoint *c, const void *values, size_t count) {
    const char *from = values;
    c->written += count;
    for (size_t at = 0; at < count;) { /* zlib counts in unsigned int */
        const size_t some = count - at < BUFFER ? count - at : BUFFER;
        c->crc = (uint32_t)crc32(c->crc, (const Bytef *)from + at, (uInt)some);
        at += some;
    }
    while (count > 0) {
        if (c->buffered == BUFFER) flush(c);
        const size_t room = BUFFER - c->buffered, some = count < room ? count : room;
        memcpy(c->buffer + c->buffered, from, some);
        c->buffered += some;
        from += some;
        count -= some;
    }
}

void ab_checkpoint_save(ab_checkpoint *c, const char *name, uint32_t type, const void *values, size_t count) {
    static const char zeros[8] = {0};
    char whole[2 * AB_CHECKPOINT_ITEM];
    const size_t length = (size_t)snprintf(whole, sizeof whole, "%s%s", c->prefix, name), bytes = count * AB_CHECKPOINT_WIDTH[type];
    const record_head r = {(uint32_t)length, type, count};
    add(c, &r, sizeof r);
    add(c, whole, length);
    add(c, zeros, padded(length) - length);
    add(c, values, bytes);
    add(c, zeros, padded(bytes) - bytes);
}

static ab_checkpoint *make(const char *path, ab_report *report) {
    ab_checkpoint *c = calloc(1, sizeof *c);
    if (c == NULL || (c->path = strdup(path)) == NULL) {
        free(c);
        return NULL;
    }
    c->report = report;
    c->file = -1;
    return c;
}

ab_status ab_checkpoint_create(const char *path, ab_checkpoint **checkpoint, ab_report *report) {
    ab_checkpoint *c = make(path, report);
    *checkpoint = NULL;
    if (c != NULL) c->buffer = malloc(BUFFER), c->part = malloc(strlen(path) + 6);
    if (c == NULL || c->buffer == NULL || c->part == NULL) {
        if (c != NULL) free(c->part), c->part = NULL, ab_checkpoint_destroy(c);
        return ab_report_failure(report, "no memory for the checkpoint '%s'", path);
    }
    sprintf(c->part, "%s.part", path);
    unlink(c->part); /* of a run that was killed; or a link to elsewhere */
    c->file = open(c->part, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (c->file < 0) {
        const ab_status status = ab_report_failure(report, "cannot write checkpoint '%s': %s", path, strerror(errno));
        ab_checkpoint_destroy(c);
        return status;
    }
    const head empty = {{0}, 0, 0, 0, 0, {0}};
    add(c, &empty, sizeof empty);
    c->crc = (uint32_t)crc32(0, NULL, 0);
    *checkpoint = c;
    return AB_OK;
}

static uint32_t whole_crc(const head *h, uint32_t rest, uint64_t bytes) {
    head own = *h;
    own.crc = 0;
    return (uint32_t)crc32_combine(crc32(crc32(0, NULL, 0), (const Bytef *)&own, sizeof own), rest, (z_off_t)(bytes - sizeof own));
}

/* A new name of the folder is on the disk when the folder is. */
static void sync_folder(const char *path) {
    char *copy = strdup(path);
    char *slash = copy == NULL ? NULL : strrchr(copy, '/');
    if (slash != NULL) slash[slash == copy] = '\0';
    const int folder = copy == NULL ? -1 : open(slash == NULL ? "." : copy, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder >= 0) {
        fsync(folder); /* file systems that cannot, need not */
        close(folder);
    }
    free(copy);
}

ab_status ab_checkpoint_commit(ab_checkpoint *c, const char *previous) {
    if (c->status != AB_OK) return c->status;
    flush(c);
    head h = {.format = FORMAT, .order = ORDER, .bytes = c->written};
    memcpy(h.magic, MAGIC, sizeof MAGIC);
    snprintf(h.version, sizeof h.version, "%s", ABUT_VERSION);
    h.crc = whole_crc(&h, c->crc, c->written);
    if (c->error == 0 && pwrite(c->file, &h, sizeof h, 0) != (ssize_t)sizeof h) c->error = errno ? errno : ENOSPC;
    if (c->error == 0 && fsync(c->file) != 0) c->error = errno;
    if (close(c->file) != 0 && c->error == 0) c->error = errno;
    c->file = -1;
    if (c->error == 0 && previous != NULL) {
        /* the one before stays under its own name until the new one takes it */
        unlink(previous);
        if (link(c->path, previous) != 0 && errno != ENOENT && rename(c->path, previous) != 0 && errno != ENOENT) c->error = errno;
    }
    if (c->error == 0 && rename(c->part, c->path) != 0) c->error = errno;
    if (c->error != 0) {
        ab_checkpoint_refuse(c, "%s (%llu bytes); the one before is kept", strerror(c->error), (unsigned long long)c->written);
        return c->status;
    }
    free(c->part);
    c->part = NULL;
    sync_folder(c->path);
    return AB_OK;
}

void ab_checkpoint_destroy(ab_checkpoint *c) {
    if (c == NULL) return;
    if (c->file >= 0) close(c->file);
    if (c->part != NULL) unlink(c->part);
    free(c->part), free(c->path), free(c->buffer), free(c->bytes), free(c->records), free(c);
}

/* ---- reading ---------------------------------------------------------------------------------------------------------------- */

/* The whole file, padded by a NUL. False: reported. */
static bool read_file(ab_checkpoint *c, size_t *size) {
    c->file = open(c->path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* not to wait for a pipe */
    struct stat found;
    if (c->file < 0 || fstat(c->file, &found) != 0) return ab_checkpoint_refuse(c, "cannot be opened: %s", strerror(errno));
    if (!S_ISREG(found.st_mode)) return ab_checkpoint_refuse(c, "is no file");
    *size = (size_t)found.st_size;
    c->bytes = malloc(*size + 1);
    if (c->bytes == NULL) return ab_checkpoint_refuse(c, "no memory for its %zu bytes", *size);
    for (size_t at = 0; at < *size;) {
        const ssize_t done = read(c->file, c->bytes + at, *size - at);
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return ab_checkpoint_refuse(c, "cannot be read: %s", done < 0 ? strerror(errno) : "it has become shorter");
        at += (size_t)done;
    }
    c->bytes[*size] = '\0';
    close(c->file);
    c->file = -1;
    return true;
}

static bool check_head(ab_checkpoint *c, size_t size) {
    head h;
    if (size < sizeof h || memcmp(c->bytes, MAGIC, sizeof MAGIC) != 0)
        return size > 0 && size < sizeof h && memcmp(c->bytes, MAGIC, size < sizeof MAGIC ? size : sizeof MAGIC) == 0
                   ? ab_checkpoint_refuse(c, "is cut off after %zu bytes; restart from the one before", size)
                   : ab_checkpoint_refuse(c, "is no checkpoint of abut");
    memcpy(&h, c->bytes, sizeof h);
    h.version[sizeof h.version - 1] = '\0';
    for (char *v = h.version; *v != '\0'; v++)
        if (*v < ' ' || *v > '~') *v = '?';
    if (h.order != ORDER) return ab_checkpoint_refuse(c, "comes from a machine with another order of bytes, or is damaged");
    if (h.format != FORMAT || strcmp(h.version, ABUT_VERSION) != 0)
        return ab_checkpoint_refuse(
            c,
            "was written by abut %s (format %u), and this is abut %s (format %d), which cannot go on with it; use that "
            "version, or run the scene from its start",
            h.version, h.format, ABUT_VERSION, FORMAT);
    if (h.bytes != size)
        return ab_checkpoint_refuse(c,
                                    size < h.bytes ? "is cut off: it has %zu bytes of %llu; restart from the one before"
                                                   : "is damaged: it has %zu bytes and should have %llu; restart from the one before",
                                    size, (unsigned long long)h.bytes);
    uLong crc = crc32(0, NULL, 0);
    for (size_t at = sizeof h; at < size;) {
        const size_t some = size - at < BUFFER ? size - at : BUFFER;
        crc = crc32(crc, (const Bytef *)c->bytes + at, (uInt)some);
        at += some;
    }
    if (whole_crc(&h, (uint32_t)crc, size) != h.crc)
        return ab_checkpoint_refuse(c, "is damaged: its check sum is wrong; restart from the one before");
    return true;
}

static bool cut(ab_checkpoint *c, size_t size) {
    size_t capacity = 0;
    for (size_t at = sizeof(head); at < size;) {
        record_head r;
        bool good = size - at >= sizeof r;
        if (good) memcpy(&r, c->bytes + at, sizeof r), at += sizeof r;
        good = good && r.type >= AB_DOUBLES && r.type <= AB_BYTES && r.name > 0 && r.name < 2 * AB_CHECKPOINT_ITEM &&
               padded(r.name) <= size - at;
        const size_t values = good ? at + padded(r.name) : 0;
        good = good && r.count <= (size - values) / AB_CHECKPOINT_WIDTH[r.type] &&
               padded(r.count * AB_CHECKPOINT_WIDTH[r.type]) <= size - values && c->count < MOST_RECORDS;
        if (!good) return ab_checkpoint_refuse(c, "is damaged: record %zu does not fit in it", c->count);
        if (c->count == capacity) {
            capacity = 2 * capacity + 256;
            ab_checkpoint_record *more = realloc(c->records, capacity * sizeof *more);
            if (more == NULL) return ab_checkpoint_refuse(c, "no memory for its list of records");
            c->records = more;
        }
        c->records[c->count++] = (ab_checkpoint_record){c->bytes + at, r.name, r.type, r.count, c->bytes + values};
        at = values + padded(r.count * AB_CHECKPOINT_WIDTH[r.type]);
    }
    return true;
}

ab_status ab_checkpoint_open(const char *path, ab_checkpoint **checkpoint, ab_report *report) {
    ab_checkpoint *c = make(path, report);
    *checkpoint = NULL;
    if (c == NULL) return ab_report_failure(report, "no memory for the checkpoint '%s'", path);
    size_t size = 0;
    if (read_file(c, &size) && check_head(c, size) && cut(c, size)) {
        *checkpoint = c;
        return AB_OK;
    }
    const ab_status status = c->status;
    ab_checkpoint_destroy(c);
    return status;
}

const ab_checkpoint_record *ab_checkpoint_find(ab_checkpoint *c, const char *name) {
    char whole[2 * AB_CHECKPOINT_ITEM];
    const size_t length = (size_t)snprintf(whole, sizeof whole, "%s%s", c->prefix, name);
    for (size_t k = 0; k < c->count; k++) {
        const ab_checkpoint_record *r = &c->records[(c->next + k) % c->count];
        if (r->length != length || memcmp(r->name, whole, length) != 0) continue;
        c->next = (size_t)(r - c->records) + 1;
        return r;
    }
    return NULL;
}

bool ab_checkpoint_load(ab_checkpoint *c, const char *name, uint32_t type, void *values, size_t count) {
    const ab_checkpoint_record *r = ab_checkpoint_find(c, name);
    if (r == NULL) return ab_checkpoint_refuse(c, "has no '%s%s': it is of another scene or of another build of abut", c->prefix, name);
    if (r->type != type || r->count != count)
        return ab_checkpoint_refuse(c, "'%s%s' has %zu %s and %zu %s are wanted: it is of another scene or of another build of abut",
                                    c->prefix, name, r->count, WORD[r->type], count, WORD[type]);
    if (count > 0) memcpy(values, r->values, count * AB_CHECKPOINT_WIDTH[type]);
    return true;
}
