/* plan.c: the command `abut plan`: a few steps are measured, then the plan is written. */
#define _GNU_SOURCE
#include "core/plan.h"

#include <time.h>

#include "core/doubts.h"

static double now(void) {
    struct timespec clock;
    clock_gettime(CLOCK_MONOTONIC, &clock);
    return (double)clock.tv_sec + 1e-9 * (double)clock.tv_nsec;
}

/* Steps a little: one step warms up, then as many as fit in a fifth of a second, at most 200. A step that fails only ends the estimate: the run
 * will say what is wrong. */
static double measure(ab_schedule *schedule, ab_report *report) {
    const double end = schedule->scene->time_end;
    double begin = 0.0, spent = 0.0;
    int steps = -1;
    while (schedule->time < end && steps < 200 && spent < 0.2) {
        if (ab_schedule_step(schedule, report) != AB_OK) return 0.0;
        if (++steps == 0) begin = now();
        spent = now() - begin;
    }
    return steps > 0 ? spent / steps : 0.0;
}

ab_status ab_plan_print(const ab_scene *scene, const ab_run_options *options, bool json, FILE *stream, ab_report *report) {
    ab_schedule *schedule = NULL;
    AB_TRY(ab_schedule_create(scene, options, &schedule, report));
    const ab_status doubts = ab_doubts(schedule, report);
    if (doubts != AB_OK) ab_schedule_destroy(schedule);
    AB_TRY(doubts);
    ab_report *first_steps = ab_report_create(); /* their mistakes belong to the run */
    const double seconds_per_step = first_steps ? measure(schedule, first_steps) : 0.0;
    ab_report_destroy(first_steps);
    ab_schedule_destroy(schedule);
    AB_TRY(ab_schedule_create(scene, options, &schedule, report)); /* as it is at the start, not where measuring left it */
    ab_text text = {0};
    (json ? ab_plan_add_json : ab_plan_add_text)(&text, schedule, options, seconds_per_step);
    ab_schedule_destroy(schedule);
    ab_status status = AB_OK;
    if (text.failed)
        status = ab_report_failure(report, "no memory for the plan");
    else
        fprintf(stream, json ? "%s\n" : "%s", text.bytes);
    ab_text_clear(&text);
    return status;
}
