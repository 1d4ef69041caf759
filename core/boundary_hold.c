/* boundary_hold.c: what boundaries carry from their first step on, on bodies whose edges stand at one node each: what the node has out of balance without them. So whatever
 * held the node until now, and wherever its stress comes from, the node is at rest to rounding with it.
 *
 * A node on a corner has an edge of each side. Sides that begin to act together share its force f as the pressures on each that give it: by c_i n_i with sum c_i n_i = f, or,
 * weighted by their areas, p = (sum A_i n_i n_i^T)^-1 f, f_i = A_i n_i (n_i . p). A side alone takes it all, shear too. What is held there by something else is left
 * to that. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/boundary_inside.h"

enum { FORCE, TENSOR = 2, AREA = 5, SHARERS, PER_DOF }; /* N: x, y; m2: xx, yy, xy of sum A n n^T; m2; how many edges share it */
static const double FLAT =
    1e-4; /* of the square of the trace: edges of one node whose tensor has no larger determinant look the same way */

static bool shares(const ab_boundary *b) { return b->active && b->begins && b->list.own_force; }

static double *room_for(ab_boundaries *all, size_t dofs) {
    const size_t needed = PER_DOF * dofs;
    if (needed > all->sum_room) {
        free(all->sum);
        all->sum = malloc(needed * sizeof *all->sum);
        all->sum_room = all->sum ? needed : 0;
    }
    if (all->sum) memset(all->sum, 0, needed * sizeof *all->sum);
    return all->sum;
}

/* All that acts at the nodes but what the beginning boundaries are to carry; nothing where another holds the node. */
static void add_forces(const ab_boundary *b, double *sum) {
    const ab_edge_list *l = &b->list;
    for (size_t e = 0; e < b->count; ++e)
        for (size_t i = l->start[e]; i < l->start[e + 1]; ++i)
            for (size_t c = 0; c < 2; ++c) {
                const double carried = l->own_force ? b->held[c * b->ld + e] : 0.0;
                if (!ab_boundary_holds(b, e, c))
                    sum[PER_DOF * l->dof[i] + FORCE + c] += l->weight[i] * (l->area[e] * b->traction[c * b->ld + e] + carried);
            }
}

static void add_edges(const ab_boundary *b, double *sum) {
    const ab_edge_list *l = &b->list;
    for (size_t e = 0; e < b->count; ++e) {
        double *s = sum + PER_DOF * l->dof[l->start[e]];
        const double nx = l->normal[e], ny = l->normal[l->ld + e], area = l->area[e];
        s[TENSOR] += area * nx * nx, s[TENSOR + 1] += area * ny * ny, s[TENSOR + 2] += area * nx * ny;
        s[AREA] += area;
        s[SHARERS] += 1.0;
    }
}

static void leave_to_others(const ab_boundary *b, double *sum) {
    for (size_t e = 0; e < b->count; ++e)
        for (size_t c = 0; c < 2; ++c)
            if (ab_boundary_holds(b, e, c))
                for (size_t i = b->list.start[e]; i < b->list.start[e + 1]; ++i) sum[PER_DOF * b->list.dof[i] + FORCE + c] = 0.0;
}

static void share_out(ab_boundary *b, const double *sum) {
    const ab_edge_list *l = &b->list;
    for (size_t e = 0; e < b->count; ++e) {
        const double *s = sum + PER_DOF * l->dof[l->start[e]], *f = s + FORCE, *t = s + TENSOR, trace = t[0] + t[1];
        const double n[2] = {l->normal[e], l->normal[l->ld + e]}, area = l->area[e], det = t[0] * t[1] - t[2] * t[2];
        double part[2];
        if (det > FLAT * trace * trace) {
            const double p[2] = {(t[1] * f[0] - t[2] * f[1]) / det, (t[0] * f[1] - t[2] * f[0]) / det};
            for (int c = 0; c < 2; ++c) part[c] = area * n[c] * (n[0] * p[0] + n[1] * p[1]);
        } else {
            const double share = s[AREA] > 0.0 ? area / s[AREA] : 1.0 / s[SHARERS];
            for (int c = 0; c < 2; ++c) part[c] = share * f[c];
        }
        for (size_t c = 0; c < 2; ++c) b->held[c * b->ld + e] = -part[c];
    }
}

static ab_status take_over(ab_boundaries *all, const ab_domain *domain, ab_report *report) {
    size_t dofs = 0;
    for (size_t k = 0; k < all->count; ++k) {
        const ab_boundary *b = all->list + k;
        if (!b->active || b->domain != domain) continue;
        for (size_t i = 0; i < b->list.start[b->count]; ++i) dofs = b->list.dof[i] >= dofs ? (size_t)b->list.dof[i] + 1 : dofs;
    }
    double *sum = room_for(all, dofs);
    if (!sum) return ab_report_failure(report, "no memory for what boundaries on '%s' hold", domain->spec->name);
    const ab_boundary *any = NULL;
    for (size_t k = 0; k < all->count; ++k) {
        const ab_boundary *b = all->list + k;
        if (!b->active || b->domain != domain) continue;
        if (shares(b)) {
            any = b;
            add_edges(b, sum);
        } else if (!b->begins) {
            add_forces(b, sum);
        }
    }
    for (size_t d = 0; d < dofs; ++d)
        for (size_t c = 0; c < 2; ++c) {
            double *f = sum + PER_DOF * d + FORCE + c;
            *f = any->dofs.inverse_mass[d * any->dofs.mass_stride + c] > 0.0 ? *f + any->list.own_force[2 * d + c] : 0.0;
        }
    for (size_t k = 0; k < all->count; ++k)
        if (all->list[k].active && all->list[k].domain == domain) leave_to_others(all->list + k, sum);
    for (size_t k = 0; k < all->count; ++k)
        if (all->list[k].domain == domain && shares(all->list + k)) share_out(all->list + k, sum);
    return AB_OK;
}

ab_status ab_boundary_take_over(ab_boundaries *all, ab_report *report) {
    for (size_t k = 0; k < all->count; ++k) {
        if (!shares(all->list + k)) continue;
        bool done = false; /* with an earlier boundary of the same body */
        for (size_t o = 0; o < k; ++o) done = done || (shares(all->list + o) && all->list[o].domain == all->list[k].domain);
        if (!done) AB_TRY(take_over(all, all->list[k].domain, report));
    }
    return AB_OK;
}
