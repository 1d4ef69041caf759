/* carried.c: the area that an impulse acts on, for what monitors show of contacts on shared nodes. Such points are more than the freedoms they push on: nodes on both sides
 * of a face, or finer than a body's own. Any of them can carry the force of those around it, and some are left with none, though the bodies touch there. Their areas go to
 * the points around them that carry. */
#include <math.h>
#include <stdlib.h>

#include "contact/contact.h"

static const double TOUCH = 1e-3; /* of a cell: points no further open touch; gaps are no better known */
static const double REACH = 2.0;  /* cells: as far as splines of two nodes have points in common */

static bool carries(const ab_points *p, size_t i) { return p->impulse[i] != 0.0 || p->impulse[p->ld + i] != 0.0; }

/* Carries, and lies by i. */
static bool carries_beside(const ab_points *p, size_t i, size_t k) {
    const double reach = REACH * p->cell;
    return fabs(p->position[i] - p->position[k]) <= reach && fabs(p->position[p->ld + i] - p->position[p->ld + k]) <= reach &&
           carries(p, k);
}

bool contact_carried_areas(contact_points *points) {
    const ab_points *p = &points->view;
    if (p->count > points->carried_capacity) {
        free(points->carried);
        points->carried_capacity = 2 * p->count;
        points->carried = malloc(points->carried_capacity * sizeof *points->carried);
        if (!points->carried) return points->carried_capacity = 0, false;
    }
    for (size_t i = 0; i < p->count; ++i) points->carried[i] = p->area[i];
    for (size_t i = 0; i < p->count; ++i) {
        if (carries(p, i) || !(p->area[i] > 0.0) || !(p->gap[i] <= TOUCH * p->cell)) continue;
        double all = 0.0;
        for (size_t k = 0; k < p->count; ++k)
            if (carries_beside(p, i, k)) all += p->area[k];
        if (!(all > 0.0)) continue;
        for (size_t k = 0; k < p->count; ++k)
            if (carries_beside(p, i, k)) points->carried[k] += p->area[i] * (p->area[k] / all);
    }
    return true;
}
