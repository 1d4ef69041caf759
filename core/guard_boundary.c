/* guard_boundary.c: apply of a boundary plugin under guard. */
#include <math.h>
#include <string.h>

#include "core/guard.h"

enum {
    POSITION,
    NORMAL,
    DISPLACEMENT,
    VELOCITY,
    AREA,
    DENSITY,
    P_SPEED,
    S_SPEED,
    STATE0,
    TRACTION,
    STATE1,
    DAMPING,
    STIFFNESS,
    PRESCRIBED,
    FLAG
};

typedef struct boundary_call {
    ab_guard *guard;
    ab_edges *edges;
} boundary_call;

static int call_apply(void *data) {
    const boundary_call *c = data;
    return c->guard->inner->boundary.apply(c->guard->self, c->edges);
}

typedef struct edge_rows { /* that the class writes */
    size_t k, rows;
    const char *name;
    double *host, **shown;
    double first; /* what the plugin finds there */
} edge_rows;
enum { OUTPUTS = 5 };

/* Arrays whose ld is the number of edges, what goes in read-only. */
static bool show(ab_guard_set *set, const ab_edges *e, size_t states, ab_edges *inner, const edge_rows outputs[OUTPUTS]) {
    const size_t d = e->dimension, n = e->count, ld = e->ld;
    bool good = ab_guard_show_rows(set, POSITION, "position", &inner->position, d, n, ld) &&
                ab_guard_show_rows(set, NORMAL, "normal", &inner->normal, d, n, ld) &&
                ab_guard_show_rows(set, DISPLACEMENT, "displacement", &inner->displacement, d, n, ld) &&
                ab_guard_show_rows(set, VELOCITY, "velocity", &inner->velocity, d, n, ld) &&
                ab_guard_show_rows(set, AREA, "area", &inner->area, 1, n, ld) &&
                ab_guard_show_rows(set, DENSITY, "density", &inner->density, 1, n, ld) &&
                ab_guard_show_rows(set, P_SPEED, "p_wave_speed", &inner->p_wave_speed, 1, n, ld) &&
                ab_guard_show_rows(set, S_SPEED, "s_wave_speed", &inner->s_wave_speed, 1, n, ld) &&
                ab_guard_show_rows(set, STATE0, "state0", &inner->state0, states, n, ld);
    for (size_t k = 0; good && k < OUTPUTS; k++) {
        if (!outputs[k].host) continue;
        double *own = ab_guard_room(set, outputs[k].k, outputs[k].name, outputs[k].rows * n * sizeof *own, false, outputs[k].shown);
        for (size_t i = 0; own && i < outputs[k].rows * n; i++) own[i] = outputs[k].first;
        good = own != NULL;
    }
    return good;
}

/* Numbers that the host can use go to it. */
static int take(ab_guard *guard, const ab_edges *e, const edge_rows *k) {
    const double *own = *k->shown;
    const bool least = k->k == DAMPING || k->k == STIFFNESS;
    for (size_t r = 0; k->host && r < k->rows; r++)
        for (size_t i = 0; i < e->count; i++) {
            const double x = own[r * e->count + i];
            const bool idle = !(e->area[i] > 0.0) && k->k != STATE1; /* nobody looks at it */
            const bool good = idle || (isfinite(x) && (!least || x >= 0.0)) || (k->k == PRESCRIBED && isnan(x));
            if (!good && ab_guard_poisoned(x)) {
                e->flag[i] = 1;
                return ab_guard_break(guard, AB_PROMISE_FINITE, "row %zu of %s was not written for edge %zu of %zu at t = %g s", r, k->name,
                                      i, e->count, e->time);
            }
            if (!good) {
                e->flag[i] = 1;
                return ab_guard_break(guard, AB_PROMISE_FINITE, "row %zu of %s is %g for edge %zu of %zu at (%g, %g) m, t = %g s", r,
                                      k->name, x, i, e->count, e->position[i], e->position[e->ld + i], e->time);
            }
            k->host[r * e->ld + i] = x;
        }
    return 0;
}

int ab_guard_apply(void *self, ab_edges *e) {
    ab_guard *guard = self;
    const size_t states = (size_t)ab_guard_state_rows(&guard->inner->class_, e->dimension);
    ab_guard_set *set = ab_guard_take(guard);
    if (!set) return ab_guard_no_memory(guard);
    ab_edges inner = *e;
    inner.ld = e->count;
    const edge_rows outputs[OUTPUTS] = {{TRACTION, e->dimension, "traction", e->traction, &inner.traction, 0.0},
                                        {STATE1, states, "state1", e->state1, &inner.state1, ab_guard_poison()},
                                        {DAMPING, 2, "damping", e->damping, &inner.damping, 0.0},
                                        {STIFFNESS, 2, "stiffness", e->stiffness, &inner.stiffness, 0.0},
                                        {PRESCRIBED, e->dimension, "prescribed", e->prescribed, &inner.prescribed, NAN}};
    uint8_t *flag = show(set, e, states, &inner, outputs) ? ab_guard_room(set, FLAG, "flag", e->count, false, &inner.flag) : NULL;
    if (!flag) return ab_guard_give(guard, set), ab_guard_no_memory(guard);
    memset(flag, 0, e->count);
    ab_fault fault;
    int code = 0;
    const char *before = NULL;
    if (!ab_guard_call(set, call_apply, &(boundary_call){guard, &inner}, &code, &fault))
        code = ab_guard_break(guard, fault.promise, "%s, with %zu edges at t = %g s", fault.text, e->count, e->time);
    else if ((before = ab_guard_underrun(set)) != NULL)
        code = ab_guard_break(guard, AB_PROMISE_ARRAYS, "it wrote before the start of %s, with %zu edges at t = %g s", before, e->count,
                              e->time);
    else {
        memcpy(e->flag, flag, e->count);
        for (size_t k = 0; code == 0 && k < OUTPUTS; k++) code = take(guard, e, &outputs[k]);
    }
    ab_guard_give(guard, set);
    return code;
}
