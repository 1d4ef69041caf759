/* progress.c: one line, drawn seldom enough to cost nothing. */
#include "core/progress.h"

#include <math.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void ab_progress_begin(ab_progress *p, FILE *stream, bool quiet, double time_end, size_t work) {
    *p = (ab_progress){.stream = stream, .quiet = quiet, .time_end = time_end, .work = work, .stride = 1};
    p->terminal = isatty(fileno(stream)) == 1;
    p->started = p->checked = p->shown = p->rate_clock = now();
}

static int terminal_width(FILE *stream) {
    struct winsize size;
    return ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

static void duration(double seconds, char *text, size_t size) {
    const double whole = seconds > 0 && seconds < 1e8 ? ceil(seconds) : 0;
    const long s = (long)whole;
    if (!(seconds < 1e8))
        snprintf(text, size, "?");
    else if (s < 60)
        snprintf(text, size, "%ld s", s);
    else if (s < 3600)
        snprintf(text, size, "%ld:%02ld min", s / 60, s % 60);
    else
        snprintf(text, size, "%ld:%02ld h", s / 3600, s % 3600 / 60);
}

static double share(const ab_progress *p, const ab_state_view *view) {
    const double part = p->time_end > 0 ? view->time / p->time_end : 0;
    return part > 1 ? 1 : part > 0 ? part : 0;
}

/* Adds a part where it still fits, and none after one that did not: what matters most comes first. */
static bool add(char *line, size_t size, int width, const char *part) {
    const size_t used = strlen(line), more = strlen(part);
    if (used + more >= size || (int)(used + more) > width) return false;
    memcpy(line + used, part, more + 1);
    return true;
}

/* Parts keep their widths while their numbers change, so that a bar stands still. */
void ab_progress_format(const ab_progress *p, const ab_state_view *view, int width, char *line, size_t size) {
    const double part = share(p, view);
    char bar[24] = "", left[24], parts[9][256];
    const ab_scene *scene = view->scene;
    const bool staged = scene != NULL && scene->stage_count > 0;
    if (p->terminal && width >= 60) {
        const int cells = width < 110 ? 10 : 20, full = (int)(cells * part);
        bar[0] = ' ';
        for (int k = 0; k < cells; k++) bar[k + 1] = k < full ? '#' : '.';
        bar[cells + 1] = '\0';
    }
    duration(p->time_per_second > 0 ? (p->time_end - view->time) / p->time_per_second : INFINITY, left, sizeof left);
    snprintf(parts[0], sizeof parts[0], "%3d %%%s", (int)(100 * part), bar);
    snprintf(parts[1], sizeof parts[1], "  t %.4g of %.4g s", view->time, p->time_end);
    snprintf(parts[2], sizeof parts[2], "  left %-7s", left);
    snprintf(parts[3], sizeof parts[3], "  %5.3g M/s", 1e-6 * p->work_per_second); /* point-steps and element-steps */
    snprintf(parts[4], sizeof parts[4], "  remainder %+.1e J", view->remainder);
    snprintf(parts[5], sizeof parts[5], "  step %ld", view->step);
    snprintf(parts[6], sizeof parts[6], "  dt %.2e s", view->dt);
    snprintf(parts[7], sizeof parts[7], " (%.200s)", view->limit != NULL ? view->limit : "as given");
    snprintf(parts[8], sizeof parts[8], "  stage %.64s", staged ? scene->stages[view->stage].name : "");
    line[0] = '\0';
    for (int k = 0; k < 8; k++) {
        if (k == 1 && staged && !add(line, size, width, parts[8])) return;
        if (!add(line, size, width, parts[k])) return;
    }
}

static void measure(ab_progress *p, const ab_state_view *view, double clock) {
    const double span = clock - p->rate_clock;
    if (span < 0.5 && p->work_per_second > 0) return; /* a rate over less jumps about */
    if (!(span > 0)) return;
    p->work_per_second = (double)(view->step - p->rate_step) * (double)p->work / span;
    p->time_per_second = (view->time - p->rate_time) / span;
    p->rate_clock = clock;
    p->rate_step = view->step;
    p->rate_time = view->time;
}

static void show(ab_progress *p, const ab_state_view *view, double clock) {
    char line[512];
    const int tenth = (int)(10 * share(p, view) + 1e-9);
    const double since = clock - p->shown;
    if (p->terminal ? since < 0.1 : since < 1 || (tenth == p->tenth && since < 10)) return;
    measure(p, view, clock);
    ab_progress_format(p, view, p->terminal ? terminal_width(p->stream) - 1 : 200, line, sizeof line);
    if (p->terminal)
        fprintf(p->stream, "\r%s\033[K", line);
    else
        fprintf(p->stream, "%s\n", line);
    fflush(p->stream);
    p->drawn = true;
    p->shown = clock;
    p->tenth = tenth;
}

void ab_progress_step(ab_progress *p, const ab_state_view *view) {
    if (p->quiet || view->step < p->next) return;
    const double clock = now(), since = clock - p->checked;
    if (since < 0.01 && p->stride < 1 << 20)
        p->stride *= 2;
    else if (since > 0.04 && p->stride > 1)
        p->stride /= 2;
    p->checked = clock;
    p->next = view->step + p->stride;
    show(p, view, clock);
}

void ab_progress_prepare(void *progress, double part, const char *text) {
    ab_progress *p = progress;
    const double clock = now(), within = part > 1 ? 1 : part > 0 ? part : 0;
    const int tenth = (int)(10 * within + 1e-9);
    const double since = clock - p->shown;
    if (p->quiet || (clock - p->started < 1) || (p->terminal ? since < 0.1 : since < 1 || (tenth == p->tenth && since < 10))) return;
    char bar[24] = "";
    const int width = p->terminal ? terminal_width(p->stream) - 1 : 200, cells = 10, full = (int)(cells * within);
    for (int k = 0; k < cells && p->terminal; k++) bar[k] = k < full ? '#' : '.';
    if (p->terminal)
        fprintf(p->stream, "\r%3d %% %s  %.*s\033[K", (int)(100 * within), bar, width > 18 ? width - 18 : 0, text);
    else
        fprintf(p->stream, "%3d %%  %s\n", (int)(100 * within), text);
    fflush(p->stream);
    p->drawn = true;
    p->shown = clock;
    p->tenth = tenth;
}

void ab_progress_end(ab_progress *p) {
    if (!p->quiet && p->terminal && p->drawn) {
        fputs("\r\033[K", p->stream);
        fflush(p->stream);
    }
    p->drawn = false;
}
