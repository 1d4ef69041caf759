/* check_response.c: promises of a contact response, on contact points that are not coupled with each other. */
#include <math.h>
#include <string.h>

#include "core/check_response_bench.h"

static ab_contact_bench one, two; /* large; every promise has a process of its own */

/* ---- again, batches ---------------------------------------------------------------------------------------------------------------- */

static void again(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    ab_contact_bench_prepare(check, &one, instance, settings, dimension);
    two = one;
    ab_contact_bench_point(&two);
    if (ab_contact_bench_respond(&one, instance, 0, AB_BENCH_POINTS) != 0) return;
    const ab_contact_bench fresh = two;
    for (int round = 0; round < 3; round++) {
        ab_check_instance other;
        if (round == 1) { /* something else between */
            for (size_t k = 0; k < 3 * AB_BENCH_LD; k++) two.velocity[k] *= -0.7;
            ab_contact_bench_respond(&two, instance, 0, AB_BENCH_POINTS);
        }
        if (round == 2 && !ab_check_open(check, &other, settings, NULL))
            ab_check_fail(check, "create refuses settings that it took before");
        two = fresh;
        ab_contact_bench_point(&two);
        ab_contact_bench_respond(&two, round == 2 ? &other : instance, 0, AB_BENCH_POINTS);
        for (size_t i = 0; i < AB_BENCH_POINTS; i++)
            ab_contact_bench_same(check, settings, &one, i, &two, i, AB_BENCH_LD,
                                  round == 0   ? "when asked again"
                                  : round == 1 ? "when asked again after other input"
                                               : "from an instance made anew");
        if (round == 2) ab_check_close(&other);
    }
}
static void keep_again(ab_check *check) { ab_contact_bench_for_all(check, 8, again); }

static void batches(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    static const size_t COUNT[] = {1, 2, 3, 5, 8};
    ab_contact_bench_prepare(check, &one, instance, settings, dimension);
    const ab_contact_bench fresh = one;
    if (ab_contact_bench_respond(&one, instance, 0, AB_BENCH_POINTS) != 0) return;
    for (size_t k = 0; k < sizeof COUNT / sizeof *COUNT; k++) {
        char what[60];
        snprintf(what, sizeof what, "asked for %zu points at a time", COUNT[k]);
        two = fresh;
        ab_contact_bench_point(&two);
        for (size_t first = AB_BENCH_POINTS; first > 0; first -= first < COUNT[k] ? first : COUNT[k]) { /* from the last to the first */
            const size_t from = first < COUNT[k] ? 0 : first - COUNT[k];
            if (ab_contact_bench_respond(&two, instance, from, first - from) != 0) ab_check_fail(check, "%s it gives up", what);
        }
        for (size_t i = 0; i < AB_BENCH_POINTS; i++) ab_contact_bench_same(check, settings, &one, i, &two, i, AB_BENCH_LD, what);
    }
}
static void keep_batches(ab_check *check) { ab_contact_bench_for_all(check, 8, batches); }

/* ---- frame ------------------------------------------------------------------------------------------------------------------------- */

static void turn(double Q[3][3], double *v, uint32_t dimension) {
    double w[3] = {0};
    for (uint32_t r = 0; r < dimension; r++)
        for (uint32_t c = 0; c < dimension; c++) w[r] += Q[r][c] * v[c * AB_BENCH_LD];
    for (uint32_t r = 0; r < dimension; r++) v[r * AB_BENCH_LD] = w[r];
}

static void turn_bench(ab_check *check, ab_contact_bench *b, double Q[3][3]) {
    const ab_class *class_ = &check->loaded->class_;
    for (size_t i = 0; i < AB_BENCH_POINTS; i++) {
        double *vectors[] = {b->position, b->normal, b->velocity, b->velocity_old, b->impulse};
        for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++) turn(Q, vectors[k] + i, b->points.dimension);
        size_t row = 0;
        for (uint32_t s = 0; s < class_->nstate; s++) {
            const bool vector = class_->state[s].shape == AB_VECTOR;
            if (vector)
                turn(Q, b->state0 + row * AB_BENCH_LD + i, b->points.dimension),
                    turn(Q, b->state1 + row * AB_BENCH_LD + i, b->points.dimension);
            row += vector ? b->points.dimension : 1;
        }
    }
}

static void frame(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    static const double LIKE = 1e-9;
    const ab_class *class_ = &check->loaded->class_;
    for (uint32_t s = 0; s < class_->nstate; s++)
        if (class_->state[s].shape > AB_VECTOR) return; /* a tensor at a contact point: the host does not turn it */
    for (int n = 0; n < 4; n++) {
        const double a = ab_check_uniform(check, 0.0, 6.28), b = dimension == 3 ? ab_check_uniform(check, 0.0, 6.28) : 0.0;
        double Q[3][3] = {{cos(a), -sin(a) * cos(b), sin(a) * sin(b)}, {sin(a), cos(a) * cos(b), -cos(a) * sin(b)}, {0.0, sin(b), cos(b)}};
        ab_contact_bench_prepare(check, &one, instance, settings, dimension);
        two = one;
        ab_contact_bench_point(&two);
        turn_bench(check, &two, Q);
        if (ab_contact_bench_respond(&one, instance, 0, AB_BENCH_POINTS) != 0 ||
            ab_contact_bench_respond(&two, instance, 0, AB_BENCH_POINTS) != 0)
            return;
        turn_bench(check, &one, Q);
        for (size_t i = 0; i < AB_BENCH_POINTS; i++) {
            double scale = 0.0;
            for (uint32_t c = 0; c < dimension; c++)
                scale =
                    fmax(scale, fmax(fabs(one.impulse[c * AB_BENCH_LD + i]), one.normal_mass[i] * fabs(one.velocity[c * AB_BENCH_LD + i])));
            for (uint32_t c = 0; c < dimension; c++) {
                const double got = two.impulse[c * AB_BENCH_LD + i], wanted = one.impulse[c * AB_BENCH_LD + i];
                char words[500];
                if (isfinite(got) && isfinite(wanted) && fabs(got - wanted) > LIKE * scale)
                    ab_check_fail(check,
                                  "component %u of the impulse is %.9g N s from turned input, and %.9g when what comes out is turned: %s",
                                  c, got, wanted, ab_contact_bench_words(check, &one, settings, i, words, sizeof words));
            }
        }
    }
}
static void keep_frame(ab_check *check) { ab_contact_bench_for_all(check, 8, frame); }

/* ---- a fixed point ----------------------------------------------------------------------------------------------------------------- */

static void fixed(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    static const double LIKE = 1e-8;
    ab_contact_bench_prepare(check, &one, instance, settings, dimension);
    if (!ab_contact_bench_step(check, &one, instance, settings)) return;
    two = one;
    ab_contact_bench_point(&two);
    if (ab_contact_bench_respond(&two, instance, 0, AB_BENCH_POINTS) != 0) return;
    for (size_t i = 0; i < AB_BENCH_POINTS; i++) {
        double scale = 0.0, change = 0.0;
        for (uint32_t c = 0; c < dimension; c++) {
            scale =
                fmax(scale, fmax(fabs(one.impulse[c * AB_BENCH_LD + i]), one.normal_mass[i] * fabs(one.velocity_old[c * AB_BENCH_LD + i])));
            change = fmax(change, fabs(one.impulse[c * AB_BENCH_LD + i] - two.impulse[c * AB_BENCH_LD + i]));
        }
        char words[500];
        if (change > LIKE * scale)
            ab_check_fail(
                check,
                "asked again with the velocity that its impulse of (%.9g, %.9g) N s has left, it wants (%.9g, %.9g), after 20 rounds: %s",
                one.impulse[i], one.impulse[AB_BENCH_LD + i], two.impulse[i], two.impulse[AB_BENCH_LD + i],
                ab_contact_bench_words(check, &one, settings, i, words, sizeof words));
    }
}
static void keep_fixed(ab_check *check) { ab_contact_bench_for_all(check, 8, fixed); }

/* ---- memory ------------------------------------------------------------------------------------------------------------------------ */

static void guarded(ab_check *check, ab_promise promise) {
    static const size_t RANGE[][2] = {{0, AB_BENCH_POINTS}, {0, 1}, {AB_BENCH_POINTS - 1, 1}, {5, 7}, {9, 1}, {AB_BENCH_POINTS - 3, 3}};
    for (uint32_t d = 2; d <= 3; d++) {
        if (!(check->loaded->class_.spaces & (d == 2 ? AB_PLANE_STRAIN | AB_AXISYMMETRIC : AB_SPACE_3D))) continue;
        for (size_t v = 0; v < check->shared->variants && v < 6; v++) {
            ab_check_instance plain, instance;
            ab_loaded_class guard;
            const ab_value *settings = check->shared->settings[v];
            if (!ab_check_open(check, &plain, settings, NULL) || !ab_check_open(check, &instance, settings, &guard))
                ab_check_fail(check, "create refuses settings that it took before");
            ab_contact_bench_prepare(check, &one, &plain, settings, d);
            for (size_t k = 0; k < sizeof RANGE / sizeof *RANGE; k++) {
                two = one;
                ab_contact_bench_point(&two);
                if (!check->loaded->class_.nstate) two.points.state0 = two.points.state1 = NULL;
                ab_check_trying(check, "respond for points %zu to %zu", RANGE[k][0], RANGE[k][0] + RANGE[k][1] - 1);
                if (ab_contact_bench_respond(&two, &instance, RANGE[k][0], RANGE[k][1]) != 0 && ab_guard_broken(instance.self) == promise)
                    ab_check_fail(check, "%s", instance.service.message);
            }
            ab_check_close(&instance);
            ab_check_close(&plain);
        }
    }
}
static void keep_old(ab_check *check) { guarded(check, AB_PROMISE_OLD); }
static void keep_arrays(ab_check *check) { guarded(check, AB_PROMISE_ARRAYS); }

static void unasked(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    ab_contact_bench_prepare(check, &one, instance, settings, dimension);
    two = one;
    ab_contact_bench_point(&two);
    if (ab_contact_bench_respond(&one, instance, 0, AB_BENCH_POINTS) != 0) return;
    if (!(check->loaded->class_.needs & AB_NEED_DISTANCE)) two.points.distance = NULL;
    if (!check->loaded->class_.nstate) two.points.state0 = two.points.state1 = NULL;
    ab_check_trying(check, "respond with NULL for %s%s", two.points.distance ? "" : "distance ", two.points.state0 ? "" : "state0, state1");
    if (ab_contact_bench_respond(&two, instance, 0, AB_BENCH_POINTS) != 0)
        ab_check_fail(check, "it gives up without what it did not ask for: %s", instance->service.message);
    for (size_t i = 0; i < AB_BENCH_POINTS; i++)
        ab_contact_bench_same(check, settings, &one, i, &two, i, AB_BENCH_LD, "without what it did not ask for");
}
static void keep_unasked(ab_check *check) { ab_contact_bench_for_all(check, 8, unasked); }

/* ---- finite numbers ---------------------------------------------------------------------------------------------------------------- */

static void numbers(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    static const double GAP[] = {0.0, 1e-3, 0.5, -1e-6, -1e-2, -0.3}, MASS[] = {1.0, 0.0, 1e-12, 1e6}, SPEED[] = {0.1, 0.0, 1e3};
    static ab_contact_bench plain;
    ab_contact_bench_prepare(check, &plain, instance, settings, dimension);
    for (int n = 0; n < 6 * 4 * 3; n++) {
        one = plain;
        ab_contact_bench_point(&one);
        for (size_t i = 0; i < AB_BENCH_POINTS; i++) {
            one.gap[i] = GAP[n % 6];
            one.normal_mass[i] = MASS[n / 6 % 4];
            one.tangential_mass[i] = i % 3 ? MASS[n / 6 % 4] : 0.0;
            one.area[i] = i % 4 ? 0.1 : 0.0;
            if (i % 5 == 0) one.distance[i] = 0.0;
            for (uint32_t c = 0; c < dimension; c++)
                one.velocity[c * AB_BENCH_LD + i] *= SPEED[n / 24],
                    one.velocity_old[c * AB_BENCH_LD + i] = one.velocity[c * AB_BENCH_LD + i];
        }
        two = one;
        ab_contact_bench_point(&two);
        for (size_t k = 0; k < two.states * AB_BENCH_LD; k++) two.state1[k] = two.state0[k];
        instance->service.message[0] = '\0';
        char words[500];
        ab_check_trying(check, "respond: %s", ab_contact_bench_words(check, &two, settings, 0, words, sizeof words));
        const int code = ab_contact_bench_respond(&two, instance, 0, AB_BENCH_POINTS);
        if (code != 0) {
            if (!instance->service.message[0])
                ab_check_fail(check, "respond returned %d and gave no reason: %s", code,
                              ab_contact_bench_words(check, &two, settings, 0, words, sizeof words));
            continue;
        }
        for (size_t i = 0; i < AB_BENCH_POINTS; i++) {
            for (uint32_t c = 0; c < dimension; c++)
                if (!isfinite(two.impulse[c * AB_BENCH_LD + i]))
                    ab_check_fail(check, "the impulse is %g N s: %s", two.impulse[c * AB_BENCH_LD + i],
                                  ab_contact_bench_words(check, &one, settings, i, words, sizeof words));
            for (size_t s = 0; s < two.states; s++)
                if (!isfinite(two.state1[s * AB_BENCH_LD + i]))
                    ab_check_fail(check, "row %zu of state1 is %g: %s", s, two.state1[s * AB_BENCH_LD + i],
                                  ab_contact_bench_words(check, &one, settings, i, words, sizeof words));
            if (!(two.stiffness[i] >= 0.0) || !isfinite(two.stiffness[i]))
                ab_check_fail(check, "stiffness is %g N/m: %s", two.stiffness[i],
                              ab_contact_bench_words(check, &one, settings, i, words, sizeof words));
        }
    }
}
static void keep_finite(ab_check *check) { ab_contact_bench_for_all(check, AB_CHECK_VARIANTS, numbers); }

/* ---- dissipation ------------------------------------------------------------------------------------------------------------------- */

/* Bodies that start apart meet, slide and part, pushed about by other forces between the steps. What the impulses take from the motion, impulse x mean of the old and
 * the new velocity, may be stored (a spring) and come back, but never more of it than was taken. A spring across the normal that is integrated explicitly is behind by
 * up to k (v dt)^2/8, which is less than half of the kinetic energy where the step is stable. */
static void dissipation(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    static const double OWED = 0.5, LIKE = 1e-9;
    enum { STEPS = 160 };
    double taken[AB_BENCH_POINTS] = {0}, most[AB_BENCH_POINTS] = {0}, moved[AB_BENCH_POINTS] = {0};
    ab_contact_bench_begin(check, &one, dimension);
    for (size_t i = 0; i < AB_BENCH_POINTS; i++) one.gap[i] = ab_check_uniform(check, 1e-6, 4e-5);
    bool springs = false;
    for (int n = 0; n < STEPS; n++) {
        if (!ab_contact_bench_step(check, &one, instance, settings)) return;
        for (size_t i = 0; i < AB_BENCH_POINTS; i++) {
            double work = 0.0, along = 0.0, square = 0.0;
            for (uint32_t c = 0; c < dimension; c++) {
                const size_t k = c * AB_BENCH_LD + i;
                work += one.impulse[k] * 0.5 * (one.velocity_old[k] + one.velocity[k]);
                along += one.velocity_old[k] * one.normal[k];
                square += one.velocity_old[k] * one.velocity_old[k];
            }
            const double kinetic = 0.5 * (one.normal_mass[i] * along * along + one.tangential_mass[i] * fmax(0.0, square - along * along));
            most[i] = fmax(most[i], kinetic);
            taken[i] += work;
            moved[i] += fabs(work);
            springs = springs || one.stiffness[i] > 0.0 || one.states > 0;
            char words[500];
            if (taken[i] < -(springs ? OWED : 0.0) * most[i] - LIKE * (moved[i] + most[i]))
                ab_check_fail(
                    check, "in %d steps its impulses gave a pair of points %.6g J more than they took (largest kinetic energy %.3g J): %s",
                    n + 1, -taken[i], most[i], ab_contact_bench_words(check, &one, settings, i, words, sizeof words));
        }
        ab_contact_bench_move_on(check, &one, 0.1);
    }
    double all = 0.0, largest = 0.0;
    for (size_t i = 0; i < AB_BENCH_POINTS; i++) all += taken[i], largest += most[i];
    if (all < -0.01 * largest) {
        char words[400];
        ab_check_fail(check, "in %d steps its impulses gave %d pairs of points %.6g J more than they took (kinetic energy %.3g J): %s",
                      (int)STEPS, (int)AB_BENCH_POINTS, -all, largest, ab_check_words(check, settings, words, sizeof words));
    }
}
static void keep_dissipation(ab_check *check) { ab_contact_bench_for_all(check, 12, dissipation); }

const ab_check_promise ab_check_response[] = {
    {"again", "the same input gives the same bits: asked again, and from an instance made anew", keep_again, true},
    {"batch", "a point has the same bits asked for alone and among many", keep_batches, false},
    {"frame", "turned input gives turned impulses", keep_frame, false},
    {"fixed-point", "given the velocity that its own impulse has left, it asks for the same impulse", keep_fixed, false},
    {"old-state", "state0, normals, weights and all else that is handed in is not written", keep_old, false},
    {"arrays", "nothing but the points in question is written, nothing outside of arrays is read", keep_arrays, false},
    {"unasked", "what it did not ask for may be NULL", keep_unasked, false},
    {"finite", "finite numbers in, finite numbers out, also where masses are 0", keep_finite, false},
    {"dissipation", "impulses give back no more than they took", keep_dissipation, false},
    {.name = NULL},
};
