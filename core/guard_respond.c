/* guard_respond.c: respond of a contact plugin under guard. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/guard.h"

enum {
    KEY,
    A_START,
    B_START,
    A_DOF,
    B_DOF,
    A_WEIGHT,
    B_WEIGHT,
    POSITION,
    NORMAL,
    GAP,
    AREA,
    VELOCITY,
    NORMAL_MASS,
    TANGENTIAL_MASS,
    DISTANCE,
    VELOCITY_OLD,
    POINT_STATE0,
    IMPULSE,
    POINT_STATE1,
    STIFFNESS,
    IMPULSE_BEFORE
};

typedef struct response_call {
    ab_guard *guard;
    ab_points *points;
    size_t first, count;
} response_call;

static int call_respond(void *data) {
    const response_call *c = data;
    return c->guard->inner->contact.respond(c->guard->self, c->points, c->first, c->count);
}

enum { ROWS = 13, WRITTEN = 10 }; /* rows of numbers by point; the first that the response writes */

typedef struct point_rows {
    size_t k, rows;
    const char *name;
    const double *host, **shown;
} point_rows;

static void list_rows(const ab_points *p, size_t states, ab_points *inner, point_rows rows[ROWS]) {
    const size_t d = p->dimension;
    const point_rows list[ROWS] = {{POSITION, d, "position", p->position, (const double **)&inner->position},
                                   {NORMAL, d, "normal", p->normal, (const double **)&inner->normal},
                                   {GAP, 1, "gap", p->gap, (const double **)&inner->gap},
                                   {AREA, 1, "area", p->area, (const double **)&inner->area},
                                   {VELOCITY, d, "relative_velocity", p->relative_velocity, &inner->relative_velocity},
                                   {NORMAL_MASS, 1, "normal_mass", p->normal_mass, &inner->normal_mass},
                                   {TANGENTIAL_MASS, 1, "tangential_mass", p->tangential_mass, &inner->tangential_mass},
                                   {DISTANCE, 1, "distance", p->distance, (const double **)&inner->distance},
                                   {VELOCITY_OLD, d, "relative_velocity_old", p->relative_velocity_old, &inner->relative_velocity_old},
                                   {POINT_STATE0, states, "state0", states ? p->state0 : NULL, &inner->state0},
                                   {IMPULSE, d, "impulse", p->impulse, (const double **)&inner->impulse},
                                   {POINT_STATE1, states, "state1", states ? p->state1 : NULL, (const double **)&inner->state1},
                                   {STIFFNESS, 1, "stiffness", p->stiffness, (const double **)&inner->stiffness}};
    memcpy(rows, list, sizeof list);
}

/* Everything, into arrays whose ld is the number of points. */
static bool show_points(ab_guard_set *set, const ab_points *p, ab_points *inner, const point_rows rows[ROWS]) {
    const size_t n = p->count, a = p->a_start[n], b = p->b_start[n];
    *inner = *p;
    inner->capacity = inner->ld = n;
    if (!ab_guard_show(set, KEY, "key", &inner->key, n * sizeof *p->key) ||
        !ab_guard_show(set, A_START, "a_start", &inner->a_start, (n + 1) * sizeof(size_t)) ||
        !ab_guard_show(set, B_START, "b_start", &inner->b_start, (n + 1) * sizeof(size_t)) ||
        !ab_guard_show(set, A_DOF, "a_dof", &inner->a_dof, a * sizeof(uint32_t)) ||
        !ab_guard_show(set, B_DOF, "b_dof", &inner->b_dof, b * sizeof(uint32_t)) ||
        !ab_guard_show(set, A_WEIGHT, "a_weight", &inner->a_weight, a * sizeof(double)) ||
        !ab_guard_show(set, B_WEIGHT, "b_weight", &inner->b_weight, b * sizeof(double)))
        return false;
    for (size_t k = 0; k < ROWS; k++) {
        *rows[k].shown = NULL;
        if (!rows[k].host) continue;
        double *own = ab_guard_room(set, rows[k].k, rows[k].name, rows[k].rows * n * sizeof(double), k < WRITTEN, rows[k].shown);
        if (!own) return false;
        for (size_t r = 0; r < rows[k].rows; r++) memcpy(own + r * n, rows[k].host + r * p->ld, n * sizeof(double));
    }
    return true;
}

/* Only what changes from one call to the next of the same round. */
static void show_again(ab_guard_set *set, const ab_points *p, const point_rows rows[ROWS], size_t first, size_t count) {
    for (size_t k = 0; k < ROWS; k++) {
        const ab_guarded *g = set->array + rows[k].k;
        double *own = rows[k].host ? (double *)(void *)(g->own + (g->room - g->bytes)) : NULL;
        for (size_t r = 0; own && r < rows[k].rows; r++)
            memcpy(own + r * p->count + first, rows[k].host + r * p->ld + first, count * sizeof(double));
    }
}

/* What the response wrote in rows k: for its points it goes to the host's; `all`: and nowhere else. */
static int take_rows(ab_guard *guard, const ab_points *p, const point_rows *k, size_t first, size_t count, bool all) {
    const size_t n = p->count;
    const double *own = *k->shown;
    double *host = (double *)(uintptr_t)k->host;
    for (size_t r = 0; own && r < k->rows; r++) {
        for (size_t i = 0; all && i < n; i++)
            if ((i < first || i >= first + count) && memcmp(own + r * n + i, host + r * p->ld + i, sizeof *own))
                return ab_guard_break(guard, AB_PROMISE_ARRAYS, "asked for points %zu to %zu it wrote %s of point %zu", first,
                                      first + count - 1, k->name, i);
        for (size_t i = first; i < first + count; i++) {
            const double made = own[r * n + i];
            if (isfinite(made) && !(k->k == STIFFNESS && made < 0.0)) continue;
            return ab_guard_break(guard, AB_PROMISE_FINITE, "%s of point %zu at (%g, %g) m from the grid's corner is %g at t = %g s",
                                  k->name, i, p->position[i], p->position[p->ld + i], made, p->time);
        }
        memcpy(host + r * p->ld + first, own + r * n + first, count * sizeof(double));
    }
    return 0;
}

/* Alone, a point whose bodies do not overlap takes energy from them: with v the relative velocity without its impulse j and v - j/m the one with it, j (v + v - j/m)/2
 * is not negative. A response that acts as a spring may give back what it took, and one that parts bodies that overlap has to. */
static int look_at_energy(ab_guard *guard, const ab_points *p, const double *before, size_t first, size_t count) {
    static const double ROUNDING = 1e-9;
    const size_t ld = p->ld, d = p->dimension;
    for (size_t i = first; i < first + count; i++) {
        const double mn = p->normal_mass[i], mt = p->tangential_mass[i];
        if (p->gap[i] < 0.0 || !(mn > 0.0) || !(mt > 0.0) || (p->stiffness && p->stiffness[i] > 0.0)) continue;
        double on = 0.0, jn = 0.0, work = 0.0, scale = 0.0;
        for (size_t c = 0; c < d; c++) {
            const double n = p->normal[c * ld + i];
            on += before[c * count + i - first] * n, jn += p->impulse[c * ld + i] * n;
        }
        for (size_t c = 0; c < d; c++) {
            const double n = p->normal[c * ld + i], old = before[c * count + i - first], j = p->impulse[c * ld + i];
            const double free = p->relative_velocity[c * ld + i] + on * n / mn + (old - on * n) / mt,
                         with = free - jn * n / mn - (j - jn * n) / mt;
            work += 0.5 * j * (free + with);
            scale += fabs(j) * (fabs(free) + fabs(with) + fabs(j) / mt + fabs(j) / mn);
        }
        if (work >= -ROUNDING * scale) continue;
        return ab_guard_break(guard, AB_PROMISE_DISSIPATION,
                              "by itself its impulse (%g, %g) N s gives the bodies %g J, at point %zu at (%g, %g) m from the grid's "
                              "corner, gap %g m, t = %g s",
                              p->impulse[i], p->impulse[ld + i], -work, i, p->position[i], p->position[ld + i], p->gap[i], p->time);
    }
    return 0;
}

int ab_guard_respond(void *self, ab_points *points, size_t first, size_t count) {
    ab_guard *guard = self;
    const size_t states = (size_t)ab_guard_state_rows(&guard->inner->class_, points->dimension);
    if (!guard->points_set && !(guard->points_set = calloc(1, sizeof *guard->points_set))) return ab_guard_no_memory(guard);
    ab_guard_set *set = guard->points_set;
    ab_points *inner = &guard->points_shown;
    const bool anew = first == 0 || first != guard->points_next || guard->points_of != points || inner->count != points->count;
    const bool all = anew || first + count == points->count; /* what belongs to others is looked at in the last call of a round */
    point_rows rows[ROWS];
    list_rows(points, states, inner, rows);
    if (!anew)
        show_again(set, points, rows, first, count);
    else if (!show_points(set, points, inner, rows))
        return ab_guard_no_memory(guard);
    guard->points_of = points;
    guard->points_next = first + count;
    ab_fault fault;
    int code = 0;
    response_call c = {guard, inner, first, count};
    if (!ab_guard_call(set, call_respond, &c, &code, &fault))
        return ab_guard_break(guard, fault.promise, "%s, at points %zu to %zu, t = %g s", fault.text, first, first + count - 1,
                              points->time);
    const char *before = all ? ab_guard_underrun(set) : NULL;
    if (before) return ab_guard_break(guard, AB_PROMISE_ARRAYS, "it wrote before the start of %s, t = %g s", before, points->time);
    if (code != 0) return code;
    double *old = ab_guard_room(set, IMPULSE_BEFORE, "impulse before", points->dimension * count * sizeof *old, false, &old);
    if (!old) return ab_guard_no_memory(guard);
    for (size_t r = 0; r < points->dimension; r++) memcpy(old + r * count, points->impulse + r * points->ld + first, count * sizeof *old);
    for (size_t k = WRITTEN; code == 0 && k < ROWS; k++) code = take_rows(guard, points, rows + k, first, count, all);
    return code != 0 ? code : look_at_energy(guard, points, old, first, count);
}
