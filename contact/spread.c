/* spread.c: how a pair's forces are shared among contact points that are more than the freedoms they push on.
 *
 * Points on the outline of a body of material points (surface: points) need not stand over its nodes, and what goes up and down from one of them to the next its nodes
 * hardly feel, or not at all: rounds that put one point right after the other find any of many sets of forces that do the same to the bodies. Of all those the one
 * is wanted whose pressure changes from point to point as the body's own stencils do: pressure of a node, sum w F / sum w A; of a point, sum w p. A step begins with
 * the forces of the last one shared out so: what no node feels is gone, what they feel the rounds put right at once. And the pressure that is reported is that one. */
#include <math.h>
#include <stdlib.h>

#include "contact/contact.h"

void contact_spread_destroy(contact_spread *s) {
    free(s->node), free(s->mark), free(s->force);
    *s = (contact_spread){0};
}

static bool reserve(contact_spread *s, size_t dofs) {
    if (dofs <= s->dofs) return true;
    const size_t n = 2 * dofs + 64;
    double *node = realloc(s->node, 3 * n * sizeof *node);
    if (node) s->node = node;
    uint32_t *mark = realloc(s->mark, n * sizeof *mark);
    if (mark) s->mark = mark;
    if (!node || !mark) return false;
    for (size_t k = 0; k < n; ++k) mark[k] = 0;
    s->look = 0;
    s->dofs = n;
    return true;
}

double *contact_spread_room(contact_points *points) {
    contact_spread *s = &points->spread;
    if (points->view.ld > s->ld) {
        free(s->force);
        s->force = malloc(4 * points->view.ld * sizeof *s->force);
        s->ld = s->force ? points->view.ld : 0;
    }
    return s->force;
}

double contact_spread_pressure(contact_points *points, const contact_side side[2], const double *normal, const double *tangential) {
    const ab_points *p = &points->view;
    double *force = contact_spread_room(points), peak = 0.0;
    if (!force) return 0.0; /* no memory: the next step says so */
    for (size_t i = 0; i < p->count; ++i) force[i] = normal[i], force[p->ld + i] = tangential[i];
    /* 1 - (1 - S)^2, S the sharing: keeps what S loses of a bent profile */
    if (!contact_spread_forces(points, side)) return 0.0;
    for (size_t row = 0; row < 2; ++row)
        for (size_t i = 0; i < p->count; ++i) force[(2 + row) * p->ld + i] = 2.0 * force[row * p->ld + i];
    if (!contact_spread_forces(points, side)) return 0.0;
    for (size_t row = 0; row < 2; ++row)
        for (size_t i = 0; i < p->count; ++i) {
            double *to = force + (2 + row) * p->ld + i;
            *to = p->area[i] > 0.0 ? (*to - force[row * p->ld + i]) / p->area[i] : 0.0;
        }
    for (size_t i = 0; i < p->count; ++i) peak = fmax(peak, force[2 * p->ld + i]);
    return peak;
}

bool contact_spread_forces(contact_points *points, const contact_side side[2]) {
    contact_spread *s = &points->spread;
    const ab_points *p = &points->view;
    const contact_side *body = side + s->side;
    double *normal = s->force, *across = s->force + p->ld;
    size_t dofs = 0;
    for (size_t e = 0; e < body->start[p->count]; ++e)
        if (body->dof[e] >= dofs) dofs = (size_t)body->dof[e] + 1;
    if (!reserve(s, dofs)) return false;
    if (++s->look == 0) { /* after 2^32 looks */
        for (size_t k = 0; k < s->dofs; ++k) s->mark[k] = 0;
        s->look = 1;
    }
    for (int back = 0; back < 2; ++back)
        for (size_t i = 0; i < p->count; ++i) {
            double pn = 0.0, pt = 0.0, all = 0.0;
            if (normal[i] == 0.0 && across[i] == 0.0) continue;
            for (size_t e = body->start[i]; e < body->start[i + 1]; ++e) all += fmax(body->weight[e], 0.0);
            for (size_t e = body->start[i]; e < body->start[i + 1]; ++e) {
                const double w = body->weight[e] / all;
                double *node = s->node + 3 * (size_t)body->dof[e];
                if (!(w > 0.0)) continue;
                if (back) {
                    pn += w * node[0] / node[2], pt += w * node[1] / node[2];
                    continue;
                }
                if (s->mark[body->dof[e]] != s->look) node[0] = node[1] = node[2] = 0.0, s->mark[body->dof[e]] = s->look;
                node[0] += w * normal[i], node[1] += w * across[i], node[2] += w * p->area[i];
            }
            if (back) normal[i] = p->area[i] * pn, across[i] = p->area[i] * pt;
        }
    return true;
}
