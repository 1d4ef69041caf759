/* doubts_room.h: whether the grid has room for the motion that can be foreseen: part of ab_doubts. */
#ifndef AB_DOUBTS_ROOM_H
#define AB_DOUBTS_ROOM_H

#include "core/scheduler.h"

/* With bodies made and the first step chosen. Warns of each body of material points that flies out of the grid before the run ends: by its speed and by gravity, as
 * long as nothing comes near that it has a contact with and no side holds it. What meets anything, is loaded or damped, is not foreseen and not spoken of. */
ab_status ab_doubt_room(const ab_schedule *schedule, ab_report *report);

#endif
