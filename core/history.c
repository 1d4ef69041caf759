/* history.c: history.csv, a row per step or per history.every steps. Rows are gathered and put on the disk at least once a second and with
 * every frame, so that a run that is killed keeps them. A file that lost its last rows still ends on a whole one or on a part without line end. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <zlib.h>

#include "core/files.h"
#include "core/results_inner.h"

struct ab_history {
    const ab_scene *scene;
    FILE *file;
    char *path;
    size_t columns;
    long last_step;
    double flushed;       /* s */
    ab_history_mark mark; /* of the last checkpoint */
};

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static ab_status failed(const ab_history *history, ab_report *report) {
    return ab_report_failure(report, "cannot write '%s': %s; %s", history->path, strerror(errno),
                             history->last_step < 0 ? "name another folder with -o" : "the rows before are kept");
}

/* A name as a field of a csv file: quoted where it has to be. */
static void put_name(FILE *file, const char *name) {
    if (strpbrk(name, ",\"\n") == NULL) {
        fputs(name, file);
        return;
    }
    fputc('"', file);
    for (; *name != '\0'; name++) {
        if (*name == '"') fputc('"', file);
        fputc(*name, file);
    }
    fputc('"', file);
}

static void put_header(FILE *file, const ab_scene *scene) {
    char name[320];
    for (size_t c = 0; c < ab_column_count(scene); c++) {
        ab_column_name(scene, c, name, sizeof name);
        if (c > 0) fputc(',', file);
        put_name(file, name);
    }
    for (size_t m = 0; m < scene->monitor_count; m++) {
        fputc(',', file);
        put_name(file, scene->monitors[m].name);
    }
    fputc('\n', file);
}

static ab_status begin(const char *folder, const ab_scene *scene, ab_history **result, ab_report *report) {
    ab_history *history = calloc(1, sizeof *history);
    *result = history;
    if (history == NULL || (history->path = ab_path_join(folder, "history.csv")) == NULL)
        return ab_report_failure(report, "no memory for history.csv");
    history->scene = scene;
    history->columns = ab_column_count(scene);
    history->last_step = -1;
    return AB_OK;
}

ab_status ab_history_is_free(const char *folder, ab_report *report) {
    char *path = ab_path_join(folder, "history.csv");
    if (path == NULL) return ab_report_failure(report, "no memory for history.csv");
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    const bool taken = file >= 0 && flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (file >= 0) close(file);
    free(path);
    return taken ? ab_report_failure(report, "another run is writing its results into '%s'; name another folder with -o, or end that run",
                                     folder)
                 : AB_OK;
}

/* The lock is gone with the run, however it ends; file systems without locks do without. */
static ab_status take(ab_history *history, int file, ab_report *report) {
    if (file >= 0) flock(file, LOCK_EX | LOCK_NB);
    history->file = file < 0 ? NULL : fdopen(file, "w");
    if (history->file == NULL) {
        const ab_status status = failed(history, report);
        if (file >= 0) close(file);
        return status;
    }
    setvbuf(history->file, NULL, _IOFBF, 1 << 18);
    return AB_OK;
}

ab_status ab_history_create(const char *folder, const ab_scene *scene, ab_history **result, ab_report *report) {
    AB_TRY(begin(folder, scene, result, report));
    ab_history *history = *result;
    unlink(history->path); /* an old one; or a link, which may lead out of the folder */
    AB_TRY(take(history, open(history->path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666), report));
    put_header(history->file, scene);
    return ab_history_flush(history, report);
}

/* CRC-32 of the bytes between two places of a file, on top of `crc`. False: they are not there. */
static bool add_crc(int file, size_t from, size_t to, size_t *crc) {
    unsigned char bytes[1 << 14];
    while (from < to) {
        const ssize_t done = pread(file, bytes, to - from < sizeof bytes ? to - from : sizeof bytes, (off_t)from);
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return false;
        *crc = crc32(*crc, bytes, (uInt)done);
        from += (size_t)done;
    }
    return true;
}

ab_status ab_history_get_mark(ab_history *history, ab_history_mark *mark, ab_report *report) {
    AB_TRY(ab_history_flush(history, report));
    const off_t at = ftello(history->file);
    if (at < 0 || fsync(fileno(history->file)) != 0 || !add_crc(fileno(history->file), history->mark.bytes, (size_t)at, &history->mark.crc))
        return failed(history, report);
    history->mark.bytes = (size_t)at;
    history->mark.last_step = history->last_step;
    *mark = history->mark;
    return AB_OK;
}

/* Is this the file that the mark is of? */
static ab_status compare(const ab_history *history, int file, const ab_history_mark *mark, ab_report *report) {
    static const char remedy[] = "name another folder with -o, which then begins with what comes after the checkpoint";
    char *header = NULL, *found = NULL;
    size_t length = 0, crc = crc32(0, NULL, 0);
    struct stat size;
    FILE *text = open_memstream(&header, &length);
    if (text != NULL) put_header(text, history->scene), fclose(text);
    found = malloc(length + 1);
    const bool same =
        header != NULL && found != NULL && pread(file, found, length, 0) == (ssize_t)length && memcmp(found, header, length) == 0;
    free(header), free(found);
    if (fstat(file, &size) != 0 || !S_ISREG(size.st_mode))
        return ab_report_error(report, AB_NOWHERE, "'%s' is no file; %s", history->path, remedy);
    if (!same)
        return ab_report_error(report, AB_NOWHERE,
                               "'%s' has other columns than this scene (its monitors have changed, or it is of another run); %s",
                               history->path, remedy);
    if ((size_t)size.st_size < mark->bytes)
        return ab_report_error(report, AB_NOWHERE,
                               "'%s' ends before the checkpoint: it has %zu bytes and had %zu; restart from an older checkpoint, or %s",
                               history->path, (size_t)size.st_size, mark->bytes, remedy);
    if (!add_crc(file, 0, mark->bytes, &crc) || crc != mark->crc)
        return ab_report_error(report, AB_NOWHERE, "'%s' is not the one that the checkpoint was written beside; %s", history->path, remedy);
    return AB_OK;
}

ab_status ab_history_continue(const char *folder, const ab_scene *scene, const ab_history_mark *mark, bool only_look, ab_history **result,
                              ab_report *report) {
    AB_TRY(begin(folder, scene, result, report));
    ab_history *history = *result;
    const int file = open(history->path, (only_look ? O_RDONLY : O_RDWR) | O_CLOEXEC | O_NOFOLLOW);
    if (file < 0) return failed(history, report);
    ab_status status = compare(history, file, mark, report);
    if (only_look || status != AB_OK) {
        close(file);
        return status;
    }
    history->mark = *mark;
    history->last_step = mark->last_step;
    const bool cut = ftruncate(file, (off_t)mark->bytes) == 0 && lseek(file, 0, SEEK_END) >= 0;
    status = cut ? AB_OK : failed(history, report);
    if (cut) return take(history, file, report);
    close(file);
    return status;
}

/* Every digit that matters; the zeros that fill most ledgers and whole numbers take a short way. */
static void put_number(FILE *file, double value) {
    if (value == 0 || (fabs(value) < 1e15 && value == (double)(long long)value))
        fprintf(file, "%lld", (long long)value);
    else
        fprintf(file, "%.17g", value);
}

ab_status ab_history_row(ab_history *history, const ab_state_view *view, ab_monitors *monitors, ab_report *report) {
    if (history->last_step == view->step) return AB_OK;
    for (size_t c = 0; c < history->columns; c++) {
        if (c > 0) fputc(',', history->file);
        put_number(history->file, ab_column_value(view, c));
    }
    for (size_t m = 0; m < history->scene->monitor_count; m++) {
        double value = 0;
        AB_TRY(ab_monitor_value(monitors, m, view, &value, report));
        fputc(',', history->file);
        put_number(history->file, value);
    }
    fputc('\n', history->file);
    history->last_step = view->step;
    if (ferror(history->file)) return failed(history, report);
    return now() - history->flushed > 1.0 ? ab_history_flush(history, report) : AB_OK;
}

ab_status ab_history_flush(ab_history *history, ab_report *report) {
    struct stat found;
    history->flushed = now();
    if (fstat(fileno(history->file), &found) == 0 && found.st_nlink == 0) { /* rows would go nowhere, and nobody would know */
        errno = ENOENT;
        return ab_report_failure(report, "cannot write '%s': it was removed while the run went on", history->path);
    }
    return fflush(history->file) != 0 || ferror(history->file) ? failed(history, report) : AB_OK;
}

long ab_history_last_step(const ab_history *history) { return history->last_step; }

ab_status ab_history_close(ab_history *history, ab_report *report) {
    FILE *file = history->file;
    history->file = NULL;
    if (file == NULL) return AB_OK;
    const bool bad = ferror(file) != 0;
    return fclose(file) != 0 || bad ? failed(history, report) : AB_OK;
}

void ab_history_destroy(ab_history *history) {
    if (history == NULL) return;
    if (history->file != NULL) fclose(history->file);
    free(history->path);
    free(history);
}
