/* check_physics.c: promises of a material about its answers: frame indifference, wave speed, finite numbers, dissipation. */
#include <math.h>
#include <string.h>

#include "core/check_bench.h"

static bench one, two;

void ab_check_frame(ab_check *);
void ab_check_speed(ab_check *);
void ab_check_finite(ab_check *);
void ab_check_dissipation(ab_check *);

/* ---- turning ---------------------------------------------------------------------------------------------------------------------- */

static void rotation(ab_check *check, uint32_t dimension, double Q[3][3]) {
    double q[4] = {cos(0.3), 0.0, 0.0, sin(0.3)}, size = 0.0;
    for (int k = 0; k < 4; k++)
        if (dimension == 3 || k == 0 || k == 3) q[k] = ab_check_uniform(check, -1.0, 1.0);
    for (int k = 0; k < 4; k++) size += q[k] * q[k];
    for (int k = 0; k < 4; k++) q[k] /= sqrt(size);
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double R[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                            {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                            {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    memcpy(Q, R, sizeof R);
}

static const int PAIR[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
static const int PLANE_FULL[5][2] = {{0, 0}, {0, 1}, {1, 0}, {1, 1}, {2, 2}};

/* Row (axis 0) or column (axis 1) of component k of a tensor as it is stored. */
static int place_of(uint32_t shape, uint32_t dimension, int k, int axis) {
    if (shape == AB_SYMMETRIC) return PAIR[k][axis];
    if (dimension == 2) return PLANE_FULL[k][axis];
    return axis == 0 ? k / 3 : k % 3;
}

/* One tensor or vector of an item; both: Q A Q^T, else Q A. `shear` of the off-diagonal ones of a symmetric tensor as they are stored: 2 for strain. */
static void turn(double Q[3][3], uint32_t shape, uint32_t dimension, bool both, double shear, const double *from, double *to, size_t ld) {
    double A[3][3] = {{0}}, B[3][3], C[3][3];
    const int symmetric = dimension == 2 ? 4 : 6, full = dimension == 2 ? 5 : 9;
    if (shape == AB_SCALAR) {
        to[0] = from[0];
        return;
    }
    if (shape == AB_VECTOR) {
        for (uint32_t r = 0; r < dimension; r++) {
            double sum = 0.0;
            for (uint32_t c = 0; c < dimension; c++) sum += Q[r][c] * from[c * ld];
            to[r * ld] = sum;
        }
        return;
    }
    const int rows = shape == AB_SYMMETRIC ? symmetric : full;
    for (int k = 0; k < rows; k++) {
        const int r = place_of(shape, dimension, k, 0), c = place_of(shape, dimension, k, 1);
        const double value = from[(size_t)k * ld] / (shape == AB_SYMMETRIC && r != c ? shear : 1.0);
        A[r][c] = value;
        if (shape == AB_SYMMETRIC) A[c][r] = value;
    }
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            B[r][c] = 0.0;
            for (int k = 0; k < 3; k++) B[r][c] += Q[r][k] * A[k][c];
        }
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            C[r][c] = 0.0;
            for (int k = 0; k < 3; k++) C[r][c] += B[r][k] * Q[c][k];
        }
    for (int k = 0; k < rows; k++) {
        const int r = place_of(shape, dimension, k, 0), c = place_of(shape, dimension, k, 1);
        to[(size_t)k * ld] = (both ? C[r][c] : B[r][c]) * (shape == AB_SYMMETRIC && r != c ? shear : 1.0);
    }
}

static void turn_states(double Q[3][3], const ab_class *class_, uint32_t dimension, const double *from, double *to) {
    for (uint32_t s = 0; s < class_->nstate; s++) {
        const uint32_t shape = class_->state[s].shape;
        turn(Q, shape, dimension, true, 1.0, from, to, BENCH_LD);
        const size_t rows = shape == AB_SCALAR      ? 1
                            : shape == AB_VECTOR    ? dimension
                            : shape == AB_SYMMETRIC ? (dimension == 2 ? 4 : 6)
                            : dimension == 2        ? 5
                                                    : 9;
        from += rows * BENCH_LD, to += rows * BENCH_LD;
    }
}

/* Whether what came out of turned input is `wanted`, the turned output. */
static void compare(ab_check *check, const ab_value *settings, const char *name, size_t i, const double *got, const double *wanted,
                    const double *old, int rows, double least, const bench *b) {
    static const double LIKE = 1e-7; /* of the largest number of the item, or `least`: rounding, magnified near corners of yield surfaces */
    double scale = least;
    for (int r = 0; r < rows; r++) scale = fmax(scale, fmax(fabs(wanted[r * BENCH_LD]), old ? fabs(old[r * BENCH_LD]) : 0.0));
    for (int r = 0; r < rows; r++) {
        if (!isfinite(got[r * BENCH_LD]) || !isfinite(wanted[r * BENCH_LD]) ||
            fabs(got[r * BENCH_LD] - wanted[r * BENCH_LD]) <= LIKE * scale)
            continue;
        char words[500];
        ab_check_fail(check, "row %d of %s is %.9g from turned input, and %.9g when what comes out is turned: %s", r, name,
                      got[r * BENCH_LD], wanted[r * BENCH_LD], bench_words(check, b, settings, i, words, sizeof words));
    }
}

static void frame(ab_check *check, const ab_value *settings, const ab_check_instance *instance, uint32_t dimension) {
    const ab_class *class_ = &check->loaded->class_;
    static double wanted[BENCH_STATES * BENCH_LD];
    for (int n = 0; n < 6; n++) {
        double Q[3][3];
        rotation(check, dimension, Q);
        bench_start(check, &one, instance, dimension);
        bench_drive(check, &one, instance, n);
        bench_increment(check, &one, 1e-4);
        if (bench_update(&one, instance) != 0) continue;
        two = one;
        for (size_t i = 0; i < BENCH_ITEMS; i++) {
            turn(Q, AB_SYMMETRIC, dimension, true, 2.0, one.strain + i, two.strain + i, BENCH_LD);
            turn(Q, AB_SYMMETRIC, dimension, true, 1.0, one.stress0 + i, two.stress0 + i, BENCH_LD);
            turn(Q, AB_FULL, dimension, false, 1.0, one.F + i, two.F + i, BENCH_LD);
            double L[9] = {0};
            for (int r = 0; r < 4; r++) L[r] = one.L[r * BENCH_LD + (int)i]; /* in the plane: a full tensor without zz */
            if (dimension == 3)
                turn(Q, AB_FULL, dimension, true, 1.0, one.L + i, two.L + i, BENCH_LD);
            else {
                turn(Q, AB_FULL, dimension, true, 1.0, L, L, 1);
                for (int r = 0; r < 4; r++) two.L[r * BENCH_LD + (int)i] = L[r];
            }
            turn_states(Q, class_, dimension, one.state0 + i, two.state0 + i);
        }
        bench_batch(&two, instance, BENCH_ITEMS, 1e-4);
        ab_check_trying(check, "update with turned input");
        if (bench_update(&two, instance) != 0)
            ab_check_fail(check, "it gives up on turned input, and does not on what was not turned: %s", instance->service.message);
        for (size_t i = 0; i < BENCH_ITEMS; i++) {
            turn(Q, AB_SYMMETRIC, dimension, true, 1.0, one.stress1 + i, wanted + i, BENCH_LD);
            double strain = 0.0; /* stress that the step goes through, though it may end at none */
            for (int c = 0; c < one.components; c++) strain = fmax(strain, fabs(one.strain[c * BENCH_LD + (int)i]));
            const double trial = one.density[i] * one.speed[i] * one.speed[i] * strain;
            compare(check, settings, "stress1", i, two.stress1 + i, wanted + i, two.stress0 + i, one.components,
                    isfinite(trial) ? trial : 0.0, &one);
            turn_states(Q, class_, dimension, one.state1 + i, wanted + i);
            int row = 0;
            for (uint32_t s = 0; s < class_->nstate; s++) {
                const uint32_t shape = class_->state[s].shape;
                const char *unit = class_->state[s].unit; /* what a step changes such a state by, at most */
                const double least = strcmp(unit, "Pa") == 0 ? trial : strcmp(unit, "1") == 0 ? strain : 0.0;
                const int rows = shape == AB_SCALAR      ? 1
                                 : shape == AB_VECTOR    ? (int)dimension
                                 : shape == AB_SYMMETRIC ? one.components
                                                         : one.gradients;
                compare(check, settings, class_->state[s].name, i, two.state1 + row * BENCH_LD + i, wanted + row * BENCH_LD + i,
                        two.state0 + row * BENCH_LD + i, rows, isfinite(least) ? least : 0.0, &one);
                row += rows;
            }
        }
    }
}

static void for_all(ab_check *check, size_t most, void (*what)(ab_check *, const ab_value *, const ab_check_instance *, uint32_t)) {
    uint32_t dimension[3];
    bench_dimensions(&check->loaded->class_, dimension);
    for (size_t v = 0; v < check->shared->variants && v < most; v++)
        for (int d = 0; dimension[d]; d++) {
            ab_check_instance instance;
            check->random = 29 + v;
            if (!ab_check_open(check, &instance, check->shared->settings[v], NULL))
                ab_check_fail(check, "create refuses settings that it took before");
            what(check, check->shared->settings[v], &instance, dimension[d]);
            ab_check_close(&instance);
        }
}

void ab_check_frame(ab_check *check) { for_all(check, 8, frame); }

/* ---- wave speed -------------------------------------------------------------------------------------------------------------------- */

/* Items are pulled and pushed by a little along each axis, at the start and after a few steps. */
static void speed(ab_check *check, const ab_value *settings, const ab_check_instance *instance, uint32_t dimension) {
    /* SLOWER: of the modulus, at the start and later: flow that is not associated may stiffen a direction a little */
    static const double SMALL = 1e-7, SLOWER[] = {0.02, 0.25};
    for (int steps = 0; steps < 6; steps += 5) {
        bench_start(check, &one, instance, dimension);
        bench_drive(check, &one, instance, steps);
        for (int axis = 0; axis < (int)dimension; axis++)
            for (int sign = -1; sign <= 1; sign += 2) {
                two = one;
                for (size_t i = 0; i < BENCH_ITEMS; i++) {
                    for (int c = 0; c < two.components; c++) two.strain[c * BENCH_LD + (int)i] = c == axis ? sign * SMALL : 0.0;
                    for (uint32_t c = 0; c < (dimension == 3 ? 3u : 2u); c++) {
                        const size_t row = dimension == 3 ? 3 * (size_t)axis + c : 2 * (size_t)axis + c;
                        two.F[row * BENCH_LD + i] *= 1.0 + sign * SMALL;
                    }
                    for (int c = 0; c < 9; c++) two.L[c * BENCH_LD + (int)i] = 0.0;
                    two.L[(dimension == 3 ? 4 * axis : 3 * axis) * BENCH_LD + (int)i] = sign * SMALL / 1e-6;
                    two.density[i] /= 1.0 + sign * SMALL;
                }
                bench_batch(&two, instance, BENCH_ITEMS, 1e-6);
                ab_check_trying(check, "update with a strain of %g along axis %d", sign * SMALL, axis);
                if (bench_update(&two, instance) != 0) continue;
                for (size_t i = 0; i < BENCH_ITEMS; i++) {
                    const double old = one.stress0[axis * BENCH_LD + (int)i],
                                 stiffness = (two.stress1[axis * BENCH_LD + (int)i] - old) / (sign * SMALL);
                    const double said = two.density[i] * two.speed[i] * two.speed[i];
                    if (!isfinite(said) || !isfinite(stiffness) || said >= (1.0 - SLOWER[steps > 0]) * stiffness - 1e-8 / SMALL * fabs(old))
                        continue;
                    char words[500];
                    ab_check_fail(check,
                                  "it says waves travel at %.6g m/s, and its stiffness of %.6g Pa along axis %d makes that %.6g m/s: runs "
                                  "would take too long steps: %s",
                                  two.speed[i], stiffness, axis, sqrt(stiffness / two.density[i]),
                                  bench_words(check, &one, settings, i, words, sizeof words));
                }
            }
    }
}

void ab_check_speed(ab_check *check) { for_all(check, 8, speed); }

/* ---- finite numbers ---------------------------------------------------------------------------------------------------------------- */

static void look(ab_check *check, const ab_value *settings, const char *name, const double *array, int rows, const bench *b) {
    char words[500];
    for (int r = 0; array && r < rows; r++)
        for (size_t i = 0; i < BENCH_ITEMS; i++) {
            const double x = array[r * BENCH_LD + (int)i];
            if (isfinite(x)) continue;
            bench_words(check, b, settings, i, words, sizeof words);
            if (ab_guard_poisoned(x))
                ab_check_fail(check, "row %d of %s is not written for item %zu of %d: %s", r, name, i, BENCH_ITEMS, words);
            ab_check_fail(check, "row %d of %s is %g: %s", r, name, x, words);
        }
}

static void poison(double *array, size_t count) {
    for (size_t k = 0; k < count; k++) array[k] = ab_guard_poison();
}

static void numbers(ab_check *check, const ab_value *settings, const ab_check_instance *instance, uint32_t dimension) {
    static const double AMPLITUDE[] = {0.0, 1e-12, 1e-5, 1e-3, 1e-2, 0.1, 0.3};
    for (size_t k = 0; k < sizeof AMPLITUDE / sizeof *AMPLITUDE; k++)
        for (int driven = 0; driven < 2; driven++) {
            bench_start(check, &one, instance, dimension);
            bench_drive(check, &one, instance, driven ? 3 : 0);
            for (size_t i = 0; i < BENCH_ITEMS; i++) one.amplitude[i] = AMPLITUDE[k] * (dimension == 2 ? 1.0 : 0.6);
            const double dt = k == 1 ? 1e-300 : 1e-4;
            bench_increment(check, &one, dt);
            bench_batch(&one, instance, BENCH_ITEMS, k == 0 && !driven ? 0.0 : dt);
            if (k == 1) memset(one.L, 0, sizeof one.L); /* no rates beyond all bounds */
            poison(one.stress1, (size_t)one.components * BENCH_LD), poison(one.state1, (size_t)one.states * BENCH_LD),
                poison(one.dissipation, BENCH_LD), poison(one.speed, BENCH_LD);
            ab_check_instance *mutable = (ab_check_instance *)(uintptr_t)instance;
            mutable->service.message[0] = '\0';
            char words[500];
            ab_check_trying(check, "update: %s", bench_words(check, &one, settings, 0, words, sizeof words));
            const int code = bench_update(&one, instance);
            if (code != 0) {
                bool flagged = false;
                for (size_t i = 0; i < BENCH_ITEMS; i++) flagged = flagged || one.flag[i];
                if (!flagged && !instance->service.message[0])
                    ab_check_fail(check, "update returned %d, flagged nothing and gave no reason: %s", code,
                                  bench_words(check, &one, settings, 0, words, sizeof words));
                continue;
            }
            look(check, settings, "stress1", one.stress1, one.components, &one);
            look(check, settings, "state1", one.state1, one.states, &one);
            look(check, settings, "dissipation", one.batch.dissipation, 1, &one);
            look(check, settings, "wave_speed", one.speed, 1, &one);
            for (size_t i = 0; i < BENCH_ITEMS; i++)
                if (!(one.speed[i] >= 0.0) || (k == 0 && !driven && one.speed[i] == 0.0))
                    ab_check_fail(check, "wave_speed is %g: %s", one.speed[i], bench_words(check, &one, settings, i, words, sizeof words));
        }
}

void ab_check_finite(ab_check *check) { for_all(check, AB_CHECK_VARIANTS, numbers); }

/* ---- dissipation ------------------------------------------------------------------------------------------------------------------- */

static void dissipation(ab_check *check, const ab_value *settings, const ab_check_instance *instance, uint32_t dimension) {
    static const double ROUNDING = 1e-9;
    bench_start(check, &one, instance, dimension);
    for (int step = 0; step < 12; step++) {
        bench_drive(check, &one, instance, 1);
        two = one;
        bench_increment(check, &two, 1e-4);
        if (bench_update(&two, instance) != 0) continue;
        for (size_t i = 0; i < BENCH_ITEMS; i++) {
            double scale = 0.0;
            for (int c = 0; c < two.components; c++)
                scale += (fabs(two.stress0[c * BENCH_LD + (int)i]) + fabs(two.stress1[c * BENCH_LD + (int)i])) *
                         fabs(two.strain[c * BENCH_LD + (int)i]);
            if (!(two.dissipation[i] < -ROUNDING * scale)) continue;
            char words[500];
            ab_check_fail(check, "dissipation is %g J/m3: %s", two.dissipation[i],
                          bench_words(check, &two, settings, i, words, sizeof words));
        }
    }
}

void ab_check_dissipation(ab_check *check) {
    if (!(check->loaded->class_.gives & AB_GIVE_DISSIPATION)) ab_check_skip(check, "the class does not give AB_GIVE_DISSIPATION");
    for_all(check, 8, dissipation);
}
