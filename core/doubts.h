/* doubts.h: what is known not to work, said before the first step: by abut check, abut plan and abut run. */
#ifndef AB_DOUBTS_H
#define AB_DOUBTS_H

#include "core/scheduler.h"

/* With bodies and plugins made and the first step chosen. Warns, with line and column, of what will most likely not hold; AB_BAD_INPUT where no run can be right: a dt or
 * cfl of more than three times the stable limit, or points that pass a cell in their first step. (watchdog: {stop: false} lets those be tried.) */
ab_status ab_doubts(const ab_schedule *schedule, ab_report *report);

#endif
