/* drag.h: what local damping takes of the work that moves what is driven. Damping takes its part of every change of a node's velocity; a body that is pushed on steadily and trembles is dragged by that, and
 * its reaction holds the drag beside what the ground bears. Of a step it costs a few additions. */
#ifndef AB_DRAG_H
#define AB_DRAG_H

#include "core/scheduler.h"

struct ab_checkpoint;

/* Around a step, the ledgers read: books the work of what is driven, and what damping takes where both act. Driven: a rigid body with a `motion`, or elements with a `fix`, of a velocity
 * that is not the constant 0; loads alone drive nothing here, as a load that is put on at once must lose half of its work to come to rest. */
void ab_drag_before(ab_schedule *schedule);
void ab_drag_after(ab_schedule *schedule, const ab_step *step);

/* At the end of a run: warns where damping took more than AB_DRAG_PART of the largest work done on what is driven. What gravity gave meanwhile is taken off first: that is what damping is asked to take. */
void ab_drag_warn(const ab_schedule *schedule, ab_report *report);
#define AB_DRAG_PART 0.02

bool ab_drag_keep(ab_schedule *schedule, struct ab_checkpoint *checkpoint); /* for checkpoints */

#endif
