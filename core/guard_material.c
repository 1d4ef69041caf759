/* guard_material.c: update and start of a material under guard. */
#include <math.h>
#include <string.h>

#include "core/guard.h"

enum { DENSITY, STRAIN, GRADIENT, RATE, STRESS0, STATE0, STRESS1, STATE1, DISSIPATION, SPEED, FLAG };

/* Rows of `ld` with `count` items each; what lies beyond the items is NaN, which must not matter. */
static bool show(ab_guard_set *set, size_t k, const char *name, const double **array, int rows, const ab_batch *b) {
    if (!*array) return true;
    const double *host = *array;
    double *own = ab_guard_room(set, k, name, (size_t)rows * b->ld * sizeof(double), true, array);
    if (!own) return false;
    for (int r = 0; r < rows; r++) {
        memcpy(own + (size_t)r * b->ld, host + (size_t)r * b->ld, b->count * sizeof(double));
        for (size_t i = b->count; i < b->ld; i++) own[(size_t)r * b->ld + i] = NAN;
    }
    return true;
}

static bool open(ab_guard_set *set, size_t k, const char *name, double **array, int rows, const ab_batch *b) {
    if (!*array) return true;
    const size_t n = (size_t)rows * b->ld;
    double *own = ab_guard_room(set, k, name, n * sizeof(double), false, array);
    for (size_t i = 0; own && i < n; i++) own[i] = ab_guard_poison();
    return own != NULL;
}

/* What was written where it had to be, and nowhere else. */
static int look(ab_guard *guard, const char *name, const double *array, int rows, ab_batch *b) {
    if (!array) return 0;
    for (int r = 0; r < rows; r++) {
        const double *row = array + (size_t)r * b->ld;
        for (size_t i = b->count; i < b->ld; i++)
            if (!ab_guard_poisoned(row[i]))
                return ab_guard_break(guard, AB_PROMISE_ARRAYS, "it wrote row %d of %s for item %zu, and the batch has %zu", r, name, i,
                                      b->count);
        for (size_t i = 0; i < b->count; i++) {
            if (isfinite(row[i]) || (b->density && !(b->density[i] > 0.0)))
                continue; /* items without mass fill a batch up: nobody looks at theirs */
            b->flag[i] = 1;
            return ab_guard_poisoned(row[i])
                       ? ab_guard_break(guard, AB_PROMISE_FINITE, "row %d of %s was not written for item %zu of %zu at t = %g s", r, name,
                                        i, b->count, b->time)
                       : ab_guard_break(guard, AB_PROMISE_FINITE, "row %d of %s is %g for item %zu of %zu at t = %g s, dt = %g s", r, name,
                                        row[i], i, b->count, b->time, b->dt);
        }
    }
    return 0;
}

static int look_at_dissipation(ab_guard *guard, const ab_batch *inner, ab_batch *b) {
    static const double ROUNDING = 1e-9; /* of stress times strain */
    if (!inner->dissipation) return 0;
    for (size_t i = 0; i < b->count; i++) {
        double scale = 0.0;
        for (uint32_t c = 0; c < b->components; c++)
            scale +=
                (fabs(inner->stress0[c * b->ld + i]) + fabs(inner->stress1[c * b->ld + i])) * fabs(inner->strain_increment[c * b->ld + i]);
        if (inner->dissipation[i] >= -ROUNDING * scale) continue;
        b->flag[i] = 1;
        return ab_guard_break(guard, AB_PROMISE_DISSIPATION, "it lost %g J/m3 in a step, item %zu of %zu at t = %g s",
                              inner->dissipation[i], i, b->count, b->time);
    }
    return 0;
}

typedef struct call {
    int (*function)(void *, ab_batch *);
    void *self;
    ab_batch *batch;
} call;

static int make(void *data) {
    const call *c = data;
    return c->function(c->self, c->batch);
}

static void take(double *to, const double *from, int rows, const ab_batch *b) {
    for (int r = 0; to && r < rows; r++) memcpy(to + (size_t)r * b->ld, from + (size_t)r * b->ld, b->count * sizeof(double));
}

static int guarded(ab_guard *guard, ab_guard_set *set, ab_batch *b, int (*function)(void *, ab_batch *), bool update) {
    const bool plane = b->dimension == 2;
    const int stress = (int)b->components, states = ab_guard_state_rows(&guard->inner->class_, b->dimension);
    ab_batch inner = *b;
    bool good = show(set, DENSITY, "density", &inner.density, 1, b) &&
                show(set, STRAIN, "strain_increment", &inner.strain_increment, stress, b) &&
                show(set, GRADIENT, "deformation_gradient", &inner.deformation_gradient, plane ? 5 : 9, b) &&
                show(set, RATE, "velocity_gradient", &inner.velocity_gradient, plane ? 4 : 9, b) &&
                show(set, STRESS0, "stress0", &inner.stress0, stress, b) && show(set, STATE0, "state0", &inner.state0, states, b) &&
                open(set, STRESS1, "stress1", &inner.stress1, stress, b) && open(set, STATE1, "state1", &inner.state1, states, b) &&
                open(set, DISSIPATION, "dissipation", &inner.dissipation, 1, b) && open(set, SPEED, "wave_speed", &inner.wave_speed, 1, b);
    uint8_t *flag = good ? ab_guard_room(set, FLAG, "flag", b->count, false, &inner.flag) : NULL;
    if (!flag) return guard->host.message(guard, "no memory for guarded arrays (checked: true)"), -1;
    memset(flag, 0, b->count);
    if (!update) { /* start may leave what is there, and need not say what is lost */
        take(inner.stress1, b->stress1, stress, b);
        take(inner.state1, b->state1, states, b);
        if (inner.dissipation) memset(inner.dissipation, 0, b->count * sizeof(double));
    }
    ab_fault fault;
    int code = 0;
    if (!ab_guard_call(set, make, &(call){function, guard->self, &inner}, &code, &fault))
        return ab_guard_break(guard, fault.promise, "%s, in a batch of %zu at t = %g s", fault.text, b->count, b->time);
    const char *before = ab_guard_underrun(set);
    if (before) return ab_guard_break(guard, AB_PROMISE_ARRAYS, "it wrote before the start of %s, in a batch of %zu", before, b->count);
    memcpy(b->flag, flag, b->count);
    if (code != 0) return code;
    if ((code = look(guard, "stress1", inner.stress1, stress, b)) || (code = look(guard, "state1", inner.state1, states, b)) ||
        (code = look(guard, "dissipation", inner.dissipation, 1, b)) || (code = look(guard, "wave_speed", inner.wave_speed, 1, b)) ||
        (update && (code = look_at_dissipation(guard, &inner, b))))
        return code;
    take(b->stress1, inner.stress1, stress, b);
    take(b->state1, inner.state1, states, b);
    take(b->dissipation, inner.dissipation, 1, b);
    take(b->wave_speed, inner.wave_speed, 1, b);
    return 0;
}

static int with_set(ab_guard *guard, ab_batch *b, int (*function)(void *, ab_batch *), bool update) {
    ab_guard_set *set = ab_guard_take(guard);
    if (!set) return guard->host.message(guard, "no memory for guarded arrays (checked: true)"), -1;
    const int code = guarded(guard, set, b, function, update);
    ab_guard_give(guard, set);
    return code;
}

int ab_guard_update(void *self, ab_batch *batch) { return with_set(self, batch, ((ab_guard *)self)->inner->material.update, true); }
int ab_guard_start(void *self, ab_batch *batch) { return with_set(self, batch, ((ab_guard *)self)->inner->material.start, false); }
