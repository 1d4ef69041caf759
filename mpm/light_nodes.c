/* light_nodes.c: nodes with next to no mass, as there are wherever a body's edge has just passed a node. On the linear basis a point eps of a cell behind it gives the node
 * eps of its mass, but pulls at it with all its stress, so the node's frequency grows as 1/sqrt(eps) and no step is stable. As the slivers of cut elements are made
 * part of their neighbours (extended B-splines: Hoellig, Reif and Wipper 2001; aggregation of cut cells: Badia, Verdugo and Martin 2018), a light node here is no
 * degree of freedom: it goes on the line through two heavy nodes beside it,
 *     v_i = sum_j w_ij v_j,   w = (2, -1) along a row, a column or a diagonal of the grid, and the mean where there are several,
 * and what it holds goes to them by the same weights, so that their space is that of N_j + w_ij N_i:
 *     m_j += w_ij m_i,   p_j += w_ij p_i,   f_j += w_ij f_i.
 * As sum_j w_ij = 1 and sum_j w_ij x_j = x_i, momentum and angular momentum of the nodes are kept to rounding, and a uniform strain is felt as before, in the
 * light node's cells too. The internal force does just the work that the strain takes. Where a body is too thin for a second heavy node, the light one moves with
 * the first (w = 1): momentum is kept, angular momentum but for m_i h.
 * With `light` of a full node's mass on the linear basis the scheme has a limit at frozen points again: see COURANT in kernel_linear.c and test_stability_limits.c.
 *
 * Smooth bases (gimp, cpdi, bspline2) leave eps of the stress and eps^2 of the mass at the nodes beyond an edge. That is stable, but what points do there against each other is seen by
 * these nodes alone: a mode 1/eps times slower than waves that nothing brakes, which rocks blocks at rest; and contact, which pushes by the basis at a face,
 * moves such a node instead of the points behind it. With ties neither is there. A node counts as light there by the nodes of its own row or column, and goes by lines along
 * that; one at a corner by those of both edges, w = (2, -1) x (2, -1): so the functions stay products of those along x and y, and a bar with nu 0 feels nothing of
 * what it does along itself across it. (By diagonals, and by the fullest node all round, a vibrating bar that flies past lines had 0.15 of its stress across.)
 * Affine transfers keep the angular momentum to rounding, which the lumped mass of ties does not: theirs is in light_mass.c. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "mpm/body.h"

static const double LOOKED_AT = 4; /* where a full node is heavier than at the start by more than this, all are looked at again */
static const double LEFT = 0.5;    /* of the least mass of a heavy node is left to one that hands some on */

enum { MOST = sizeof(((mpm_tie *)0)->to) / sizeof(uint32_t) }; /* nodes that a light one goes by, at most */

enum { HANDED = OWN_RECORD - 1 }; /* mass that a heavy node has handed on, kg: the last place of its record; then its place in the list of lines, from 1 */

static bool ties(const mpm_body *body) { return body->kernel->light > 0.0; }

bool mpm_light_reserve(mpm_body *body, size_t tiles) {
    if (!ties(body)) return true;
    if (!body->light) body->light_limit = body->kernel->light * LOOKED_AT * body->material->density * body->h * body->h;
    return ab_memory_grow((void **)&body->light, &body->light_capacity, tiles, sizeof *body->light) &&
           (body->order < 2 || ab_memory_grow((void **)&body->back, &body->back_capacity, tiles, 2 * AB_TILE_NODES * sizeof *body->back));
}

void mpm_light_destroy(mpm_body *body) {
    ab_memory_give(body->work, body->work_capacity * sizeof *body->work);
    ab_memory_give(body->back, body->back_capacity * 2 * AB_TILE_NODES * sizeof *body->back);
    ab_memory_give(body->light, body->light_capacity * sizeof *body->light);
    ab_memory_give(body->ties, body->tie_capacity * sizeof *body->ties);
    ab_memory_give(body->lines, body->line_capacity * sizeof *body->lines);
}

static double *record(const mpm_body *body, uint32_t dof) { return body->own + (size_t)dof * OWN_RECORD; }
static double mass_at(const mpm_body *body, uint32_t dof) { return dof == UINT32_MAX ? 0.0 : record(body, dof)[OWN_MASS]; }

static const int ROUND[8][2] = {{1, 0}, {-1, 0},  {0, 1},  {0, -1},
                                {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}; /* rows and columns, then diagonals */

/* The heaviest of those beside the node and behind them: what a full one holds thereabouts. */
static double full_mass(const mpm_body *body, size_t k, int n) {
    double full = 0.0;
    for (int d = 0; d < 8; ++d)
        for (int far = 1; far <= 2; ++far) full = fmax(full, mass_at(body, mpm_dof_beside(body, k, n, far * ROUND[d][0], far * ROUND[d][1])));
    return full;
}

static bool is_heavy(const mpm_body *body, uint32_t dof) {
    return mass_at(body, dof) > 0.0 && !(body->light[dof / AB_TILE_NODES].nodes >> dof % AB_TILE_NODES & 1);
}

/* The heaviest of those beside the node along x (0) or y (1) and behind them. */
static double most_along(const mpm_body *body, size_t k, int n, int axis) {
    double most = 0.0;
    for (int d = 2 * axis; d < 2 * axis + 2; ++d)
        for (int far = 1; far <= 2; ++far) most = fmax(most, mass_at(body, mpm_dof_beside(body, k, n, far * ROUND[d][0], far * ROUND[d][1])));
    return most;
}

/* Less than `light` of what a node beside it along x (0) or y (1), or behind that one, holds. */
static bool light_along(const mpm_body *body, size_t k, int n, int axis) {
    return record(body, (uint32_t)(k * AB_TILE_NODES) + (uint32_t)n)[OWN_MASS] < body->kernel->light * most_along(body, k, n, axis);
}

/* Lines from the node through two heavy ones, `first` .. first + 3 of ROUND, of the axes (bits: 1 x, 2 y) where these are such; or with `near_only` to one. */
static void tie(const mpm_body *body, int axes, int first, bool near_only, mpm_tie *t) {
    const size_t k = t->dof / AB_TILE_NODES;
    const int n = (int)(t->dof % AB_TILE_NODES);
    int lines = 0;
    for (int d = first; d < first + 4; ++d) {
        if (first == 0 && !(axes >> d / 2 & 1)) continue;
        const uint32_t near = mpm_dof_beside(body, k, n, ROUND[d][0], ROUND[d][1]), far = mpm_dof_beside(body, k, n, 2 * ROUND[d][0], 2 * ROUND[d][1]);
        if (!is_heavy(body, near)) continue;
        if (!near_only && (!is_heavy(body, far) || record(body, far)[HANDED] == INFINITY)) continue;
        ++lines;
        t->to[t->count] = near, t->weight[t->count++] = near_only ? 1.0 : 2.0;
        if (!near_only) t->to[t->count] = far, t->weight[t->count++] = -1.0;
    }
    for (int e = 0; e < t->count; ++e) t->weight[e] /= lines;
}

/* Adds `weight` of a node, or of those that it goes by on straight lines of its own, to a tie. False: it has none, or there is no room. */
static bool go_by(const mpm_body *body, uint32_t dof, double weight, mpm_tie *t) {
    if (!(mass_at(body, dof) > 0.0)) return false;
    mpm_tie self = {.to = {dof}, .weight = {1.0}, .count = 1};
    const mpm_tie *its = is_heavy(body, dof) ? &self : mpm_light_tie_of(body, dof);
    if (!its || !its->count || (its != &self && !its->straight) || (its == &self && weight < 0.0 && record(body, dof)[HANDED] == INFINITY))
        return false;
    for (int e = 0; e < its->count; ++e) {
        int f = 0;
        while (f < t->count && t->to[f] != its->to[e]) ++f;
        if (f == MOST) return false;
        if (f == t->count) t->to[t->count] = its->to[e], t->weight[t->count++] = 0.0;
        t->weight[f] += weight * its->weight[e];
    }
    return true;
}

/* Lines through two nodes of which one or both go by others: at a corner, over those of the two edges, so that the functions of a body with sides along the grid stay products
 * of those of its two directions. */
static void tie_by_ties(const mpm_body *body, int axes, mpm_tie *t) {
    const size_t k = t->dof / AB_TILE_NODES;
    const int n = (int)(t->dof % AB_TILE_NODES);
    mpm_tie sum = {0};
    int lines = 0;
    for (int d = 0; d < 4; ++d) {
        if (!(axes >> d / 2 & 1)) continue;
        mpm_tie line = {0};
        if (!go_by(body, mpm_dof_beside(body, k, n, ROUND[d][0], ROUND[d][1]), 2.0, &line) ||
            !go_by(body, mpm_dof_beside(body, k, n, 2 * ROUND[d][0], 2 * ROUND[d][1]), -1.0, &line))
            continue;
        for (int e = 0; e < line.count; ++e) {
            int f = 0;
            while (f < sum.count && sum.to[f] != line.to[e]) ++f;
            if (f == MOST) return; /* not on some of them: which would depend on whose turn comes first */
            if (f == sum.count) sum.to[sum.count] = line.to[e], sum.weight[sum.count++] = 0.0;
            sum.weight[f] += line.weight[e];
        }
        ++lines;
    }
    for (int e = 0; e < sum.count; ++e)
        if (sum.weight[e] < 0.0 && record(body, sum.to[e])[HANDED] == INFINITY) return; /* also one that only an edge's line makes negative */
    for (int e = 0; e < sum.count; ++e) t->to[e] = sum.to[e], t->weight[e] = sum.weight[e] / lines;
    t->count = sum.count;
}

enum { X = 1, Y = 2, BOTH = 3 };

/* The tie of a light node: along which axes it is light, and from what mass on a node there is heavy: by those of the same row or column, else what holds for the rows inside a body
 * would not for those at its edges, where nodes have half of the mass. On the linear basis, which is to have a limit of its step wherever a node is light at all, both axes and all round. */
static mpm_tie tie_of(const mpm_body *body, size_t k, int n) {
    mpm_tie t = {.dof = (uint32_t)(k * AB_TILE_NODES) + (uint32_t)n};
    double full = 0.0;
    for (int axis = 0; body->kernel->moment && axis < 2; ++axis)
        if (light_along(body, k, n, axis)) t.axes |= 1 << axis, full = fmax(full, most_along(body, k, n, axis));
    if (!body->kernel->moment) t.axes = BOTH, full = full_mass(body, k, n);
    t.heavy = body->kernel->light * full;
    return t;
}

/* All ties anew: rows and columns first; then, with `moment`, those that go by others' ties; then diagonals; then one node alone. Each step is done with all nodes
 * before the next is begun, so that it does not matter whose turn comes first. No tie where nothing beside the node is heavier. */
static void find_ties(mpm_body *body) {
    for (size_t k = 0; k < body->tie_count; ++k) {
        mpm_tie *t = body->ties + k;
        t->count = 0;
        tie(body, t->axes, 0, false, t);
        t->straight = t->count > 0;
    }
    for (size_t k = 0; body->kernel->moment && k < body->tie_count; ++k)
        if (!body->ties[k].count) tie_by_ties(body, body->ties[k].axes, body->ties + k);
    for (size_t k = 0; k < body->tie_count; ++k)
        for (int way = 0; way < 4 && body->ties[k].count == 0; ++way) tie(body, BOTH, way % 2 ? 4 : 0, way > 1, body->ties + k);
}

static double on_line(const mpm_tie *t, const double *velocity, size_t stride, size_t c) {
    double line = 0.0;
    for (int e = 0; e < t->count; ++e) line += t->weight[e] * velocity[t->to[e] * stride + c];
    return line;
}

/* The lines' velocities change by the momenta that light nodes have beyond theirs. */
static void move_lines(mpm_body *body, double *velocity, size_t stride) {
    if (!body->line_count) return; /* there may be no place to work in */
    for (size_t c = 0; c < 2; ++c) {
        memset(body->work, 0, body->line_count * sizeof *body->work);
        for (size_t k = 0; k < body->tie_count; ++k)
            for (int e = 0; e < body->ties[k].count; ++e)
                body->work[mpm_light_line(body, body->ties[k].to[e])] += body->ties[k].weight[e] * body->ties[k].rest[c];
        mpm_light_mass_solve(body, c);
        for (size_t k = 0; k < body->line_count; ++k) velocity[body->lines[k] * stride + c] += body->work[body->line_count + k];
    }
}

/* Velocities of nodes, a pair every `stride` doubles, each its own momentum over its own mass on entry (0 where a side holds it): light nodes hand their momentum to those
 * of their lines and move onto them. That is the transpose of what the points get from the nodes, and so makes no energy. With an affine transfer they hand on only
 * what their lines have not, p_i - m_i sum_j w_ij v_j, and a velocity that is affine in x is left as it is; what that could make, such a transfer takes. */
static void project(mpm_body *body, double *velocity, size_t stride) {
    const bool affine = body->finish == MPM_FINISH_AFFINE;
    for (size_t k = 0; k < body->tie_count; ++k) {
        mpm_tie *t = body->ties + k;
        const double *own = record(body, t->dof), *v = velocity + t->dof * stride;
        for (size_t c = 0; c < 2; ++c)
            t->rest[c] = own[OWN_INVERSE + c] != 0.0 ? own[OWN_MASS] * (v[c] - (affine ? on_line(t, velocity, stride, c) : 0.0)) : 0.0;
    }
    for (size_t k = 0; k < body->line_count && !affine; ++k) {
        const double *own = record(body, body->lines[k]);
        for (size_t c = 0; c < 2; ++c) velocity[body->lines[k] * stride + c] *= own[OWN_MASS] * own[OWN_INVERSE + c];
    }
    if (mpm_light_mass_consistent(body))
        move_lines(body, velocity, stride);
    else
        for (size_t k = 0; k < body->tie_count; ++k) {
            const mpm_tie *t = body->ties + k;
            for (int e = 0; e < t->count; ++e)
                for (size_t c = 0; c < 2; ++c)
                    velocity[t->to[e] * stride + c] += t->weight[e] * t->rest[c] * record(body, t->to[e])[OWN_INVERSE + c];
        }
    for (size_t k = 0; k < body->tie_count; ++k) {
        const mpm_tie *t = body->ties + k;
        const double *own = record(body, t->dof);
        for (size_t c = 0; c < 2; ++c) velocity[t->dof * stride + c] = own[OWN_INVERSE + c] != 0.0 ? on_line(t, velocity, stride, c) : 0.0;
    }
}

/* A node's velocity by its own mass, from that by the mass which it has with those that go by it. */
static double by_own_mass(const double *own, int c, double velocity) {
    return own[OWN_INVERSE + c] != 0.0 ? velocity / (own[OWN_INVERSE + c] * own[OWN_MASS]) : 0.0;
}

static void hand_on(mpm_body *body) {
    for (size_t k = 0; k < body->line_count; ++k) { /* velocities become impulses of the forces */
        double *own = record(body, body->lines[k]);
        for (int c = 0; c < 2; ++c) own[OWN_VELOCITY + c] = own[OWN_MASS] * (own[OWN_VELOCITY + c] - own[OWN_OLD + c]);
    }
    for (size_t k = 0; k < body->tie_count; ++k) {
        const mpm_tie *t = body->ties + k;
        const double *own = record(body, t->dof);
        for (int e = 0; e < t->count; ++e) {
            double *to = record(body, t->to[e]);
            for (int c = 0; c < 2; ++c) { /* what a side holds, it takes */
                if (own[OWN_INVERSE + c] == 0.0 || to[OWN_INVERSE + c] == 0.0) continue;
                to[OWN_INVERSE + c] = 1.0 / (1.0 / to[OWN_INVERSE + c] + t->weight[e] * own[OWN_MASS]);
                to[OWN_VELOCITY + c] += t->weight[e] * own[OWN_MASS] * (own[OWN_VELOCITY + c] - own[OWN_OLD + c]);
            }
        }
    }
    project(body, body->own + OWN_OLD, OWN_RECORD);
    for (size_t k = 0; k < body->line_count; ++k) {
        double *own = record(body, body->lines[k]);
        for (int c = 0; c < 2; ++c) own[OWN_VELOCITY + c] = own[OWN_OLD + c] + own[OWN_VELOCITY + c] * own[OWN_INVERSE + c];
    }
    mpm_light_follow(body);
}

void mpm_light_settle(mpm_body *body) {
    if (!body->tie_count || !mpm_light_mass_consistent(body)) return;
    for (size_t c = 0; c < 2; ++c) {
        for (size_t k = 0; k < body->line_count; ++k) {
            const double *own = record(body, body->lines[k]);
            body->work[k] = own[OWN_INVERSE + c] != 0.0 ? (own[OWN_VELOCITY + c] - own[OWN_OLD + c]) / own[OWN_INVERSE + c] : 0.0;
        }
        mpm_light_mass_solve(body, c);
        for (size_t k = 0; k < body->line_count; ++k) {
            double *own = record(body, body->lines[k]);
            if (own[OWN_INVERSE + c] != 0.0) own[OWN_VELOCITY + c] = own[OWN_OLD + c] + body->work[body->line_count + k];
        }
    }
}

static bool add_tie(mpm_body *body, const mpm_tie *t) {
    if (body->tie_count == body->tie_capacity &&
        !ab_memory_grow((void **)&body->ties, &body->tie_capacity, 2 * body->tie_count + 64, sizeof *t))
        return false;
    body->ties[body->tie_count++] = *t;
    return true;
}

/* Mass that each node may have to hand on to light ones; those with too little left are refused (INFINITY) and stay in the list of lines. True: some are that were not before. */
static bool refuse_poor(mpm_body *body) {
    size_t kept = 0;
    for (size_t k = 0; k < body->line_count; ++k) {
        double *handed = record(body, body->lines[k]) + HANDED;
        if (*handed == INFINITY)
            body->lines[kept++] = body->lines[k];
        else
            *handed = 0.0;
    }
    body->line_count = kept;
    for (size_t k = 0; k < body->tie_count; ++k)
        for (int e = 0; e < body->ties[k].count; ++e) {
            const mpm_tie *t = body->ties + k;
            if (t->weight[e] >= 0.0) continue;
            double *handed = record(body, t->to[e]) + HANDED;
            if (*handed == 0.0) body->lines[body->line_count++] = t->to[e];
            *handed += fmax(1.0, -t->weight[e]) * mass_at(body, t->dof); /* all of it, however many lines share it */
        }
    bool some = false;
    for (size_t k = 0; k < body->tie_count; ++k)
        for (int e = 0; e < body->ties[k].count; ++e) {
            const mpm_tie *t = body->ties + k;
            double *handed = record(body, t->to[e]) + HANDED;
            if (t->weight[e] < 0.0 && *handed != INFINITY && mass_at(body, t->to[e]) - *handed < LEFT * t->heavy) *handed = INFINITY, some = true;
        }
    return some;
}

/* The nodes that others go by, each once, in place of those that were looked at. */
static void list_lines(mpm_body *body) {
    for (size_t k = 0; k < body->line_count; ++k) record(body, body->lines[k])[HANDED] = 0.0;
    body->line_count = 0;
    for (size_t k = 0; k < body->tie_count; ++k)
        for (int e = 0; e < body->ties[k].count; ++e) {
            double *to = record(body, body->ties[k].to[e]);
            if (to[HANDED] == 0.0) body->lines[body->line_count++] = body->ties[k].to[e], to[HANDED] = (double)body->line_count;
        }
}

/* Marks what may be light in a body that has been compressed so far that the mass to look below, which goes by the density of the start, is too little. */
static void look_again(mpm_body *body) {
    double most = 0.0;
    for (size_t k = 0; k < body->tile_count; ++k) most = fmax(most, body->light[k].most);
    const double limit = body->kernel->light * most;
    if (!(body->light_limit > 0.0 && limit > body->light_limit)) return;
    for (size_t k = 0; k < body->tile_count; ++k)
        for (int n = 0; n < AB_TILE_NODES; ++n) {
            const double mass = mass_at(body, (uint32_t)(k * AB_TILE_NODES) + (uint32_t)n);
            body->light[k].nodes |= (uint64_t)(mass > 0.0 && mass < limit) << n;
        }
}

ab_status mpm_light_tie(mpm_body *body, ab_report *report) {
    for (size_t k = 0; k < body->line_count; ++k) record(body, body->lines[k])[HANDED] = 0.0;
    body->tie_count = body->line_count = 0;
    if (!ties(body)) return AB_OK;
    look_again(body);
    for (size_t k = 0; k < body->tile_count; ++k) /* which are light, before any is a degree of freedom of another */
        for (uint64_t bits = body->light[k].nodes; bits; bits &= bits - 1) {
            const int n = __builtin_ctzll(bits);
            const double mass = body->own[(k * AB_TILE_NODES + (size_t)n) * OWN_RECORD + OWN_MASS];
            const bool light = body->kernel->moment ? light_along(body, k, n, 0) || light_along(body, k, n, 1)
                                                    : mass < body->kernel->light * full_mass(body, k, n);
            if (!light) body->light[k].nodes &= ~(UINT64_C(1) << n);
        }
    for (size_t k = 0; k < body->tile_count; ++k)
        for (uint64_t bits = body->light[k].nodes; bits; bits &= bits - 1) {
            const mpm_tie t = tie_of(body, k, __builtin_ctzll(bits));
            if (!add_tie(body, &t)) goto no_memory;
        }
    if (!body->tie_count) return AB_OK;
    const size_t lines = 8 * body->tie_count; /* a node has eight, whether they are refused or not */
    if (lines > body->line_capacity && !ab_memory_grow((void **)&body->lines, &body->line_capacity, lines + 256, sizeof *body->lines))
        goto no_memory;
    if (!mpm_light_mass_reserve(body)) goto no_memory;
    do find_ties(body);
    while (refuse_poor(body));
    size_t kept = 0;
    for (size_t k = 0; k < body->tie_count; ++k)
        if (body->ties[k].count) body->ties[kept++] = body->ties[k];
    body->tie_count = kept;
    list_lines(body);
    hand_on(body);
    return AB_OK;
no_memory:
    return ab_report_failure(report, "body '%s': no memory for %zu light nodes", body->domain.spec->name, body->tie_count);
}

void mpm_light_follow(mpm_body *body) {
    for (size_t k = 0; k < body->tie_count; ++k) {
        const mpm_tie *t = body->ties + k;
        double *own = record(body, t->dof);
        for (size_t c = 0; c < 2; ++c)
            own[OWN_VELOCITY + c] = own[OWN_INVERSE + c] != 0.0 ? on_line(t, body->own + OWN_VELOCITY, OWN_RECORD, c) : 0.0;
    }
}

void mpm_light_quiet(mpm_body *body) {
    for (size_t k = 0; k < body->tie_count; ++k) {
        double *own = record(body, body->ties[k].dof);
        for (int c = 0; c < 2; ++c) own[OWN_VELOCITY + c] = own[OWN_OLD + c];
    }
}

void mpm_light_remap(mpm_body *body) {
    for (size_t k = 0; k < body->line_count; ++k) {
        double *own = record(body, body->lines[k]);
        for (int c = 0; c < 2; ++c) own[OWN_VELOCITY + c] = by_own_mass(own, c, own[OWN_VELOCITY + c]);
    }
    project(body, body->own + OWN_VELOCITY, OWN_RECORD);
}

void mpm_light_filter(mpm_body *body, double *back) { project(body, back, 2); }

const mpm_tie *mpm_light_tie_of(const mpm_body *body, uint32_t dof) {
    size_t low = 0, high = body->tie_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (body->ties[middle].dof < dof)
            low = middle + 1;
        else
            high = middle;
    }
    return low < body->tie_count && body->ties[low].dof == dof ? body->ties + low : NULL;
}

size_t mpm_light_expand(const mpm_body *body, uint32_t *dof, double *weight, size_t count) {
    if (!body->tie_count) return count;
    size_t last = count;
    for (size_t n = 0; n < last;) {
        const mpm_tie *t = mpm_light_tie_of(body, dof[n]);
        if (!t) {
            ++n;
            continue;
        }
        const double share = weight[n];
        --last; /* the node makes way for those it goes by */
        memmove(dof + n, dof + n + 1, (last - n) * sizeof *dof);
        memmove(weight + n, weight + n + 1, (last - n) * sizeof *weight);
        for (int e = 0; e < t->count; ++e) {
            size_t m = 0;
            while (m < last && dof[m] != t->to[e]) ++m;
            if (m == last) dof[last] = t->to[e], weight[last++] = 0.0;
            weight[m] += share * t->weight[e];
        }
    }
    return last;
}
