/* plan.h: the plan of a scene in words: what has been allocated for it, what each step does, which plugins were loaded and why, what it will
 * cost, and what it does not pay for. Written from a schedule that stands, so that it says what is, not what was meant. */
#ifndef AB_PLAN_H
#define AB_PLAN_H

#include "core/files.h"
#include "core/scheduler.h"

/* A JSON object. The schedule must know its dt. seconds_per_step: measured; 0: not known, and then no time is estimated. */
void ab_plan_add_json(ab_text *text, const ab_schedule *schedule, const ab_run_options *options, double seconds_per_step);
/* The same for people, several lines. */
void ab_plan_add_text(ab_text *text, const ab_schedule *schedule, const ab_run_options *options, double seconds_per_step);

#endif
