/* initial.h: the stress that a body begins with, place by place: by the weight of what the body has above (K0), or as the scene writes it. */
#ifndef AB_INITIAL_H
#define AB_INITIAL_H

#include "core/material.h"

typedef struct ab_initial ab_initial;

/* edges: the body's outline as drawn, m: from (x, y) to (x, y), the body on the left; closed but for rounding, in any order. *initial is NULL for a body that begins
 * as its material does; then nothing else is called. */
ab_status ab_initial_open(const ab_scene *, size_t body, const double (*edges)[4], size_t count, ab_initial **initial, ab_report *);
void ab_initial_close(ab_initial *);

/* m: how much of the body lies above a place of it, against gravity. */
double ab_initial_above(const ab_initial *, const double place[2]);

/* Stress and states of the material at eight places (as drawn), and its largest wave speed there. The material is asked twice: by start, with the stress in stress0,
 * for states that follow from it; by update, without strain, whether it bears it. AB_BAD_INPUT names the place and the remedy where it does not. */
ab_status ab_initial_eight(const ab_initial *, const ab_material_spec *, ab_service *, void *self, const double place[2][8],
                           ab_material_start *, ab_report *);

#endif
