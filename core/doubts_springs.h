/* doubts_springs.h: springs of contact and of boundaries against the step, before anything has met: part of ab_doubts. */
#ifndef AB_DOUBTS_SPRINGS_H
#define AB_DOUBTS_SPRINGS_H

#include "core/scheduler.h"

/* With bodies and plugins made and the first step chosen. Warns of springs that a fixed dt is too long for, or that make the step by cfl much shorter; AB_BAD_INPUT where
 * a fixed dt is more than twice as long as springs of contact bear, and where springs of a boundary are so stiff that no run would end. */
ab_status ab_doubt_springs(const ab_schedule *schedule, ab_report *report);

/* The setting of that name; NULL where the class has none. */
const ab_value *ab_doubt_setting(const ab_class *, const ab_value *values, const char *name);

#endif
