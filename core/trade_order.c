/* trade_order.c: which way a ladder goes from coarse to fine: by the point-steps of its runs, before any is made.
 *
 * The point-steps of a run are its material points and nodes of elements, times its steps: finer cells have more points and smaller steps, a smaller cfl more steps, more points
 * per cell more points, other elements more nodes. What a setting means need not be known. They are counted as `abut plan` counts them, with one value of one ladder, all else as
 * the scene has it; in a process of its own, so that a value that takes all memory is not the end. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/plan_lists.h"
#include "core/trade.h"

static const double CLEARLY = 1.1; /* words: a basis may have a somewhat smaller step than another without being any finer */

static double count(const ab_trade *trade, const ab_override *list, size_t set, const ab_run_options *options, ab_registry *registry) {
    double work = NAN;
    ab_scene *scene = NULL;
    ab_schedule *schedule = NULL;
    ab_report *report = ab_report_create(); /* what is wrong with a value its run will say */
    if (report != NULL && ab_scene_read(trade->runs.scene, list, set, registry, &scene, report) == AB_OK &&
        ab_schedule_create(scene, options, &schedule, report) == AB_OK) {
        size_t nodes;
        const ab_plan_body sum = ab_plan_totals_of(schedule, &nodes);
        work = ab_plan_steps_of(schedule) * fmax((double)(sum.points + nodes), 1);
        ab_schedule_destroy(schedule);
    }
    ab_scene_destroy(scene);
    ab_report_destroy(report);
    return work;
}

/* The same in a process of its own; NaN where it does not come to its end. */
static double count_apart(const ab_trade *trade, const ab_override *list, size_t set, const ab_run_options *options,
                          ab_registry *registry) {
    double work = NAN;
    int ends[2];
    if (pipe(ends) != 0) return NAN;
    const pid_t process = fork();
    if (process == 0) {
        if (isfinite(trade->spec->limit)) alarm((unsigned)fmin(ceil(trade->spec->limit), 1e6)); /* as its run would be stopped */
        work = count(trade, list, set, options, registry);
        _exit(write(ends[1], &work, sizeof work) == (ssize_t)sizeof work ? 0 : 1);
    }
    close(ends[1]);
    if (process < 0 || read(ends[0], &work, sizeof work) != (ssize_t)sizeof work) work = NAN;
    close(ends[0]);
    if (process > 0) waitpid(process, NULL, 0);
    return work;
}

/* Of a setting with which work does not change, or cannot be counted: cells and steps are the finer the smaller they are. */
static bool is_finer_when_smaller(const ab_ladder *ladder) {
    static const char *const paths[] = {"grid.cell", "time.cfl", "time.dt"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++)
        if (strcmp(ladder->paths[0], paths[i]) == 0) return ab_ladder_is_numeric(ladder);
    return false;
}

static bool comes_after(const ab_ladder *ladder, const double *work, size_t a, size_t b) {
    if (isfinite(work[a]) && isfinite(work[b]) && work[a] != work[b])
        return work[a] > (ab_ladder_is_numeric(ladder) ? 1 : CLEARLY) * work[b];
    return is_finer_when_smaller(ladder) && strtod(ladder->values[a], NULL) < strtod(ladder->values[b], NULL);
}

void ab_trade_sort(ab_ladder *ladder, double *work) {
    for (size_t i = 1; i < ladder->value_count; i++)
        for (size_t k = i; k > 0 && comes_after(ladder, work, k - 1, k); k--) {
            const char *value = ladder->values[k];
            const double its = work[k];
            ladder->values[k] = ladder->values[k - 1], work[k] = work[k - 1];
            ladder->values[k - 1] = value, work[k - 1] = its;
        }
}

ab_status ab_trade_order(ab_trade *trade, const ab_run_options *options, ab_registry *registry, ab_report *report) {
    ab_override *list = calloc(trade->runs.override_count + AB_TRADE_PATHS, sizeof *list);
    if (list == NULL) return ab_report_failure(report, "no memory");
    if (trade->runs.override_count > 0) memcpy(list, trade->runs.overrides, trade->runs.override_count * sizeof *list);
    fflush(stdout), fflush(stderr);
    for (size_t k = 0; k < trade->spec->ladder_count; k++) {
        ab_ladder *ladder = &trade->spec->ladders[k];
        for (size_t v = 0; v < ladder->value_count; v++) {
            size_t set = trade->runs.override_count;
            for (size_t p = 0; p < ladder->path_count; p++)
                if (strcmp(ladder->paths[p], AB_CHILD_THREADS) != 0) list[set++] = (ab_override){ladder->paths[p], ladder->values[v]};
            trade->work[k][v] = ladder->value_count > 1 ? count_apart(trade, list, set, options, registry) : NAN;
        }
        ab_trade_sort(ladder, trade->work[k]);
    }
    free(list);
    return AB_OK;
}

bool ab_trade_refines(const ab_trade *trade, size_t k, size_t top, double *factor) {
    const ab_ladder *ladder = &trade->spec->ladders[k];
    if (top < 2 || !ab_ladder_is_numeric(ladder)) return false;
    double value[3];
    for (size_t i = 0; i < 3; i++) value[i] = strtod(ladder->values[top - 2 + i], NULL);
    if (!(value[0] > 0 && value[1] > 0 && value[2] > 0) || fabs(log(value[1] / value[0]) - log(value[2] / value[1])) > 1e-6) return false;
    *factor = fmax(value[1] / value[0], value[0] / value[1]);
    const double *work = &trade->work[k][top - 2]; /* a ladder of anything else, friction say, tends to no limit that is an answer */
    const bool grows =
        !(work[0] > 0 && work[1] > 0 && work[2] > 0) || is_finer_when_smaller(ladder) || (work[0] < work[1] && work[1] < work[2]);
    return *factor > 1 && grows;
}
