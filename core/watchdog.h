/* watchdog.h: ends a run that has made more energy than it was ever given, and says where. Of a step it costs a few additions. */
#ifndef AB_WATCHDOG_H
#define AB_WATCHDOG_H

#include "core/scheduler.h"

/* After a step. What a run is given: the kinetic and strain energy it starts with, the largest work from outside, the largest change of potential energy. A remainder above
 * `watchdog.energy` of that for WATCH_STEPS steps on end ends the run: AB_FAILED, with body, point, place, time, limit of the step, likely cause and remedy. */
ab_status ab_watchdog_step(ab_schedule *schedule, ab_report *report);

/* What it remembers of a run, for checkpoints. */
struct ab_checkpoint;
bool ab_watchdog_keep(ab_schedule *schedule, struct ab_checkpoint *checkpoint);

enum { WATCH_STEPS = 20 };

#endif
