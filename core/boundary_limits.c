/* boundary_limits.c: what boundaries cannot do: larger steps than their springs let, and what moves an edge that something else moves. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/boundary_inside.h"

/* Frequencies that springs can reach: the largest row sum of the edges' stiffness through the masses of their dofs bounds them (Gershgorin 1931). */
ab_status ab_boundary_note_springs(ab_boundaries *all, ab_report *report) {
    memset(all->rate2, 0, all->scene->body_count * sizeof *all->rate2);
    for (size_t body = 0; body < all->scene->body_count; ++body) {
        size_t most = 0;
        for (size_t k = 0; k < all->count; ++k) {
            const ab_boundary *b = all->list + k;
            if (!b->active || b->spec->body != body || !(b->spec->loaded->class_.gives & AB_GIVE_STIFFNESS)) continue;
            for (size_t i = 0; i < b->list.start[b->count]; ++i) most = b->list.dof[i] >= most ? (size_t)b->list.dof[i] + 1 : most;
        }
        if (most == 0) continue;
        if (most > all->sum_room) {
            free(all->sum);
            all->sum = malloc(2 * most * sizeof *all->sum);
            all->sum_room = all->sum ? 2 * most : 0;
            if (!all->sum) return ab_report_failure(report, "no memory for the springs of boundaries");
        }
        double largest = 0.0;
        for (int pass = 0; pass < 3; ++pass) /* clear, add up, look */
            for (size_t k = 0; k < all->count; ++k) {
                const ab_boundary *b = all->list + k;
                const ab_edge_list *l = &b->list;
                if (!b->active || b->spec->body != body || !(b->spec->loaded->class_.gives & AB_GIVE_STIFFNESS)) continue;
                for (size_t e = 0; e < b->count; ++e) {
                    const double stiffness = l->area[e] * fmax(b->stiffness[e], b->stiffness[b->ld + e]);
                    double row = 0.0;
                    for (size_t i = l->start[e]; i < l->start[e + 1]; ++i) {
                        const double *inverse = b->dofs.inverse_mass + l->dof[i] * b->dofs.mass_stride;
                        if (pass == 0) all->sum[l->dof[i]] = 0.0;
                        if (pass == 1) all->sum[l->dof[i]] += fabs(l->weight[i]) * stiffness;
                        if (pass == 2) row += fabs(l->weight[i]) * all->sum[l->dof[i]] * fmax(inverse[0], inverse[1]);
                    }
                    largest = fmax(largest, row);
                }
            }
        all->rate2[body] = largest;
    }
    return AB_OK;
}

/* What moves an edge must be alone with it. Nodes that a side of the grid or a support holds would have to be torn from that: none but edges at rest can have them. */
ab_status ab_boundary_refuse_held(const ab_boundary *b, ab_report *report) {
    static const double NEARLY_ALL = 0.9; /* of an edge's weight */
    for (size_t e = 0; e < b->count; ++e)
        for (size_t c = 0; c < 2; ++c) {
            if (!(b->list.area[e] > 0.0) || !ab_boundary_holds(b, e, c) || b->prescribed[c * b->ld + e] == 0.0) continue;
            double held = 0.0, weight = 0.0;
            for (size_t i = b->list.start[e]; i < b->list.start[e + 1]; ++i) {
                const double w = fabs(b->list.weight[i]);
                weight += w;
                if (b->dofs.inverse_mass[b->list.dof[i] * b->dofs.mass_stride + c] == 0.0) held += w;
            }
            if (held > NEARLY_ALL * weight)
                return ab_report_error(
                    report, b->spec->mark,
                    "boundaries[%zu] (%s) says how '%s' moves along %c near (%.6g, %.6g) m, where a side of the grid or `fix` "
                    "holds it: take one of the two away",
                    b->number, b->spec->loaded->class_.name, b->domain->spec->name, c ? 'y' : 'x', b->position[e], b->position[b->ld + e]);
        }
    return AB_OK;
}

/* Once: two that say how the same edge moves. */
ab_status ab_boundary_refuse_two(const ab_boundaries *all, const ab_boundary *b, ab_report *report) {
    static const double SAME = 1e-9; /* of an edge's size */
    for (size_t k = 0; k < b->number; ++k) {
        const ab_boundary *o = all->list + k;
        if (!o->active || o->domain != b->domain || !(o->spec->loaded->class_.gives & AB_GIVE_MOTION)) continue;
        for (size_t e = 0; e < b->count; ++e)
            for (size_t f = 0; f < o->count; ++f) {
                const double x = b->position[e], y = b->position[b->ld + e];
                const bool along = ab_boundary_holds(b, e, 0) && ab_boundary_holds(o, f, 0),
                           across = ab_boundary_holds(b, e, 1) && ab_boundary_holds(o, f, 1);
                if ((along || across) && hypot(o->position[f] - x, o->position[o->ld + f] - y) <= SAME * b->list.area[e])
                    return ab_report_error(
                        report, b->spec->mark,
                        "boundaries[%zu] and boundaries[%zu] both say how '%s' moves along %c near (%.6g, %.6g) m: keep one "
                        "of them there",
                        o->number, b->number, b->domain->spec->name, along ? 'x' : 'y', x, y);
            }
    }
    return AB_OK;
}

/* The body alone is stable up to dt = 2/w; with springs of frequency s beside it up to 2/sqrt(w^2 + s^2), as the largest frequency of a sum is no larger. */
double ab_boundaries_critical_dt(ab_boundaries *all, size_t body, double dt, const char **limit) {
    const double rate2 = all->rate2[body];
    if (!(rate2 > 0.0)) return dt;
    const double with = 1.0 / sqrt(1.0 / (dt * dt) + 0.25 * rate2);
    if (0.25 * rate2 * dt * dt > 1.0) {
        snprintf(all->limit, sizeof all->limit, "springs of boundaries on '%.80s', %.3g 1/s on its edges", all->scene->bodies[body].name,
                 sqrt(rate2));
        *limit = all->limit;
    }
    return with;
}
