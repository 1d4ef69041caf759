/* doubts_weight.h: gravity that no body of the scene could bear, most often one in other units than the rest: part of ab_doubts. */
#ifndef AB_DOUBTS_WEIGHT_H
#define AB_DOUBTS_WEIGHT_H

#include "core/scheduler.h"

/* With bodies made and the first step chosen. AB_BAD_INPUT where a body would fall by more than a cell, or element, in its first step; warns where its weight would strain it by
 * more than 1. */
ab_status ab_doubt_weight(const ab_schedule *schedule, size_t body, ab_report *report);

#endif
