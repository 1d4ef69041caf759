/* monitor.h: the values a scene watches, found once and then read as cheaply as each allows.
 *
 * A value of a whole body that the body's motion or energy already holds (position, velocity or displacement over mass; momentum; mass; energies)
 * costs nothing. Everything else reads fields of the points, only in steps in which somebody asks, each field once for all monitors. */
#ifndef AB_MONITOR_H
#define AB_MONITOR_H

#include "core/results.h"

typedef struct ab_monitors ab_monitors;

/* Finds points, fields and components; every monitor that cannot be found is reported. The view is that of the start. */
ab_status ab_monitors_create(const ab_state_view *start, ab_monitors **monitors, ab_report *report);
/* Value of monitor `index` in this view; NaN where it has none (a point that left). Values are kept until the step changes. */
ab_status ab_monitor_value(ab_monitors *monitors, size_t index, const ab_state_view *view, double *value, ab_report *report);
const char *ab_monitor_unit(const ab_monitors *monitors, size_t index);
bool ab_monitor_is_cheap(const ab_monitors *monitors, size_t index); /* true where no field is read */
/* Between two steps: displacements are counted from the places of now; and for checkpoints, where they are counted from. */
ab_status ab_monitors_datum(ab_monitors *monitors, const ab_state_view *view, ab_report *report);
void ab_monitors_keep(ab_monitors *monitors, struct ab_checkpoint *checkpoint);
void ab_monitors_destroy(ab_monitors *monitors);

#endif
