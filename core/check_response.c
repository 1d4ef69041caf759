/* check_response.c: promises of a contact response, on contact points that are not coupled with each other. */
#include <math.h>
#include <string.h>

#include "core/check.h"

enum { POINTS = 24, LD = 32, SLACK = 512, STATES = 64 * 9, STENCIL = 2 };

typedef struct contact_bench {
    ab_points points;
    size_t states;
    uint64_t key[LD];
    size_t a_start[LD + 1], b_start[LD + 1];
    uint32_t a_dof[STENCIL * LD], b_dof[STENCIL * LD];
    double a_weight[STENCIL * LD], b_weight[STENCIL * LD];
    double position[3 * LD + SLACK], normal[3 * LD + SLACK], gap[LD + SLACK], area[LD + SLACK], distance[LD + SLACK], stiffness[LD + SLACK];
    double velocity[3 * LD + SLACK], velocity_old[3 * LD + SLACK], normal_mass[LD + SLACK], tangential_mass[LD + SLACK],
        impulse[3 * LD + SLACK];
    double state0[STATES * LD + SLACK], state1[STATES * LD + SLACK];
} contact_bench;

static contact_bench one, two; /* large; every promise has a process of its own */

/* Pointers of a bench into its own arrays. */
static void point_at(contact_bench *b) {
    ab_points *p = &b->points;
    p->key = b->key, p->a_start = b->a_start, p->b_start = b->b_start, p->a_dof = b->a_dof, p->b_dof = b->b_dof, p->a_weight = b->a_weight,
    p->b_weight = b->b_weight;
    p->position = b->position, p->normal = b->normal, p->gap = b->gap, p->area = b->area, p->distance = b->distance,
    p->stiffness = b->stiffness;
    p->relative_velocity = b->velocity, p->relative_velocity_old = b->velocity_old, p->normal_mass = b->normal_mass,
    p->tangential_mass = b->tangential_mass;
    p->impulse = b->impulse, p->state0 = b->state0, p->state1 = b->state1;
}

static void unit_vector(ab_check *check, uint32_t dimension, double *v) {
    double size = 0.0;
    while (!(size > 0.1 && size < 1.0)) {
        size = 0.0;
        for (uint32_t c = 0; c < dimension; c++) v[c] = ab_check_uniform(check, -1.0, 1.0), size += v[c] * v[c];
    }
    for (uint32_t c = 0; c < dimension; c++) v[c] /= sqrt(size);
}

static void begin(ab_check *check, contact_bench *b, uint32_t dimension) {
    memset(b, 0, sizeof *b);
    b->states = (size_t)ab_guard_state_rows(&check->loaded->class_, dimension);
    b->points = (ab_points){.struct_size = sizeof(ab_points),
                            .dimension = dimension,
                            .time = 1.0,
                            .dt = 1e-4,
                            .cell = 0.1,
                            .count = POINTS,
                            .capacity = LD,
                            .ld = LD,
                            .modulus = 1e7,
                            .speed = 1.0,
                            .density = 1000.0,
                            .fixed_places = 1,
                            .measure_area = 1};
    point_at(b);
    for (size_t i = 0; i < LD; i++) {
        double n[3] = {0};
        unit_vector(check, dimension, n);
        b->key[i] = 100 + i;
        b->a_start[i + 1] = b->b_start[i + 1] = (i + 1) * (i % 2 ? 1 : STENCIL) + (i % 2 ? (i + 1) / 2 : 0); /* filled below */
        for (uint32_t c = 0; c < dimension; c++) {
            b->normal[c * LD + i] = n[c];
            b->position[c * LD + i] = ab_check_uniform(check, 0.0, 1.0);
            b->velocity[c * LD + i] = ab_check_uniform(check, -0.5, 0.5);
        }
        b->gap[i] = i % 3 ? 0.0 : ab_check_uniform(check, 0.0, 2e-5);
        b->area[i] = 0.1;
        b->distance[i] = ab_check_uniform(check, 0.0, 0.1);
        b->normal_mass[i] = pow(10.0, ab_check_uniform(check, -1.0, 1.0));
        b->tangential_mass[i] = i % 2 ? b->normal_mass[i] : b->normal_mass[i] * ab_check_uniform(check, 0.5, 1.0);
    }
    size_t end = 0;
    for (size_t i = 0; i < LD; i++) {
        const size_t count = i % 2 ? STENCIL : 1;
        for (size_t s = 0; s < count; s++, end++)
            b->a_dof[end] = b->b_dof[end] = (uint32_t)end, b->a_weight[end] = b->b_weight[end] = 1.0 / (double)count;
        b->a_start[i + 1] = b->b_start[i + 1] = end;
    }
}

static int respond(contact_bench *b, const ab_check_instance *instance, size_t first, size_t count) {
    return instance->loaded->contact.respond(instance->self, &b->points, first, count);
}

static const char *words_of(const ab_check *check, const contact_bench *b, const ab_value *settings, size_t i, char *text, size_t size) {
    const ab_points *p = &b->points;
    const size_t ld = p->ld;
    char set[300];
    ab_check_words(check, settings, set, sizeof set);
    snprintf(text, size, "%s; %uD, normal (%.3g, %.3g), gap %.3g m, relative velocity (%.4g, %.4g) m/s, masses %.3g and %.3g kg, dt %.3g s",
             set, p->dimension, p->normal[i], p->normal[ld + i], p->gap[i], p->relative_velocity[i], p->relative_velocity[ld + i],
             p->normal_mass[i], p->tangential_mass[i], p->dt);
    return text;
}

/* What the change of an impulse from `before` does to the relative velocities. */
static void apply(contact_bench *b, const double *before) {
    const uint32_t d = b->points.dimension;
    for (size_t i = 0; i < POINTS; i++) {
        double along = 0.0;
        for (uint32_t c = 0; c < d; c++) along += (b->impulse[c * LD + i] - before[c * LD + i]) * b->normal[c * LD + i];
        for (uint32_t c = 0; c < d; c++) {
            const double n = along * b->normal[c * LD + i], t = b->impulse[c * LD + i] - before[c * LD + i] - n;
            if (b->normal_mass[i] > 0.0) b->velocity[c * LD + i] -= n / b->normal_mass[i];
            if (b->tangential_mass[i] > 0.0) b->velocity[c * LD + i] -= t / b->tangential_mass[i];
        }
    }
}

/* One step of the host: rounds until the impulses stand still. False: the response gave up. */
static bool step(ab_check *check, contact_bench *b, const ab_check_instance *instance, const ab_value *settings) {
    double before[3 * LD];
    char words[500];
    memset(b->impulse, 0, sizeof b->impulse);
    memset(b->stiffness, 0, sizeof b->stiffness);
    memcpy(b->velocity_old, b->velocity, sizeof b->velocity_old);
    ab_check_trying(check, "respond: %s", words_of(check, b, settings, 0, words, sizeof words));
    for (int round = 0; round < 20; round++) {
        memcpy(before, b->impulse, sizeof before);
        if (respond(b, instance, 0, POINTS) != 0) return false;
        apply(b, before);
        double change = 0.0, largest = 0.0;
        for (size_t k = 0; k < 3 * LD; k++)
            change = fmax(change, fabs(b->impulse[k] - before[k])), largest = fmax(largest, fabs(b->impulse[k]));
        if (change <= 1e-14 * largest) break;
    }
    return true;
}

/* The next step: states, gaps, and what other forces do to the velocities. */
static void move_on(ab_check *check, contact_bench *b, double kick) {
    memcpy(b->state0, b->state1, sizeof b->state0);
    for (size_t i = 0; i < POINTS; i++)
        for (uint32_t c = 0; c < b->points.dimension; c++) {
            b->gap[i] -= b->velocity[c * LD + i] * b->normal[c * LD + i] * b->points.dt;
            b->velocity[c * LD + i] += ab_check_uniform(check, -kick, kick);
        }
}

typedef void (*each)(ab_check *, const ab_value *, ab_check_instance *, uint32_t dimension);

static void for_all(ab_check *check, size_t most, each what) {
    const uint32_t spaces = check->loaded->class_.spaces;
    for (size_t v = 0; v < check->shared->variants && v < most; v++)
        for (uint32_t d = 2; d <= 3; d++) {
            if (!(spaces & (d == 2 ? AB_PLANE_STRAIN | AB_AXISYMMETRIC : AB_SPACE_3D))) continue;
            ab_check_instance instance;
            check->random = 41 + v;
            if (!ab_check_open(check, &instance, check->shared->settings[v], NULL))
                ab_check_fail(check, "create refuses settings that it took before");
            what(check, check->shared->settings[v], &instance, d);
            ab_check_close(&instance);
        }
}

/* Points after a few steps, ready to be asked about the next one. */
static void prepare(ab_check *check, contact_bench *b, const ab_check_instance *instance, const ab_value *settings, uint32_t dimension) {
    begin(check, b, dimension);
    for (int n = 0; n < 4; n++) {
        if (!step(check, b, instance, settings))
            ab_check_fail(check, "respond gives up on plain contact points: %s",
                          instance->service.message[0] ? instance->service.message : "no reason");
        move_on(check, b, 0.2);
    }
    memset(b->impulse, 0, sizeof b->impulse), memset(b->stiffness, 0, sizeof b->stiffness),
        memcpy(b->velocity_old, b->velocity, sizeof b->velocity_old);
}

static void same_point(ab_check *check, const ab_value *settings, const contact_bench *wanted, size_t j, const contact_bench *got, size_t i,
                       size_t ld, const char *what) {
    const struct {
        const char *name;
        const double *wanted, *got;
        size_t rows;
    } list[] = {{"impulse", wanted->impulse, got->impulse, wanted->points.dimension},
                {"state1", wanted->state1, got->state1, wanted->states},
                {"stiffness", wanted->stiffness, got->stiffness, 1}};
    for (size_t k = 0; k < sizeof list / sizeof *list; k++)
        for (size_t r = 0; r < list[k].rows; r++) {
            const double *x = list[k].got + r * ld + i, *y = list[k].wanted + r * LD + j;
            char words[500];
            if (memcmp(x, y, sizeof *x))
                ab_check_fail(check, "row %zu of %s is %.17g %s, and %.17g before: %s", r, list[k].name, *x, what, *y,
                              words_of(check, wanted, settings, j, words, sizeof words));
        }
}

/* ---- again, batches ---------------------------------------------------------------------------------------------------------------- */

static void again(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    prepare(check, &one, instance, settings, dimension);
    two = one;
    point_at(&two);
    if (respond(&one, instance, 0, POINTS) != 0) return;
    const contact_bench fresh = two;
    for (int round = 0; round < 3; round++) {
        ab_check_instance other;
        if (round == 1) { /* something else between */
            for (size_t k = 0; k < 3 * LD; k++) two.velocity[k] *= -0.7;
            respond(&two, instance, 0, POINTS);
        }
        if (round == 2 && !ab_check_open(check, &other, settings, NULL))
            ab_check_fail(check, "create refuses settings that it took before");
        two = fresh;
        point_at(&two);
        respond(&two, round == 2 ? &other : instance, 0, POINTS);
        for (size_t i = 0; i < POINTS; i++)
            same_point(check, settings, &one, i, &two, i, LD,
                       round == 0   ? "when asked again"
                       : round == 1 ? "when asked again after other input"
                                    : "from an instance made anew");
        if (round == 2) ab_check_close(&other);
    }
}
static void keep_again(ab_check *check) { for_all(check, 8, again); }

static void batches(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    static const size_t COUNT[] = {1, 2, 3, 5, 8};
    prepare(check, &one, instance, settings, dimension);
    const contact_bench fresh = one;
    if (respond(&one, instance, 0, POINTS) != 0) return;
    for (size_t k = 0; k < sizeof COUNT / sizeof *COUNT; k++) {
        char what[60];
        snprintf(what, sizeof what, "asked for %zu points at a time", COUNT[k]);
        two = fresh;
        point_at(&two);
        for (size_t first = POINTS; first > 0; first -= first < COUNT[k] ? first : COUNT[k]) { /* from the last to the first */
            const size_t from = first < COUNT[k] ? 0 : first - COUNT[k];
            if (respond(&two, instance, from, first - from) != 0) ab_check_fail(check, "%s it gives up", what);
        }
        for (size_t i = 0; i < POINTS; i++) same_point(check, settings, &one, i, &two, i, LD, what);
    }
}
static void keep_batches(ab_check *check) { for_all(check, 8, batches); }

/* ---- frame ------------------------------------------------------------------------------------------------------------------------- */

static void turn(double Q[3][3], double *v, uint32_t dimension) {
    double w[3] = {0};
    for (uint32_t r = 0; r < dimension; r++)
        for (uint32_t c = 0; c < dimension; c++) w[r] += Q[r][c] * v[c * LD];
    for (uint32_t r = 0; r < dimension; r++) v[r * LD] = w[r];
}

static void turn_bench(ab_check *check, contact_bench *b, double Q[3][3]) {
    const ab_class *class_ = &check->loaded->class_;
    for (size_t i = 0; i < POINTS; i++) {
        double *vectors[] = {b->position, b->normal, b->velocity, b->velocity_old, b->impulse};
        for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++) turn(Q, vectors[k] + i, b->points.dimension);
        size_t row = 0;
        for (uint32_t s = 0; s < class_->nstate; s++) {
            const bool vector = class_->state[s].shape == AB_VECTOR;
            if (vector) turn(Q, b->state0 + row * LD + i, b->points.dimension), turn(Q, b->state1 + row * LD + i, b->points.dimension);
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
        prepare(check, &one, instance, settings, dimension);
        two = one;
        point_at(&two);
        turn_bench(check, &two, Q);
        if (respond(&one, instance, 0, POINTS) != 0 || respond(&two, instance, 0, POINTS) != 0) return;
        turn_bench(check, &one, Q);
        for (size_t i = 0; i < POINTS; i++) {
            double scale = 0.0;
            for (uint32_t c = 0; c < dimension; c++)
                scale = fmax(scale, fmax(fabs(one.impulse[c * LD + i]), one.normal_mass[i] * fabs(one.velocity[c * LD + i])));
            for (uint32_t c = 0; c < dimension; c++) {
                const double got = two.impulse[c * LD + i], wanted = one.impulse[c * LD + i];
                char words[500];
                if (isfinite(got) && isfinite(wanted) && fabs(got - wanted) > LIKE * scale)
                    ab_check_fail(check,
                                  "component %u of the impulse is %.9g N s from turned input, and %.9g when what comes out is turned: %s",
                                  c, got, wanted, words_of(check, &one, settings, i, words, sizeof words));
            }
        }
    }
}
static void keep_frame(ab_check *check) { for_all(check, 8, frame); }

/* ---- a fixed point ----------------------------------------------------------------------------------------------------------------- */

static void fixed(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    static const double LIKE = 1e-8;
    prepare(check, &one, instance, settings, dimension);
    if (!step(check, &one, instance, settings)) return;
    two = one;
    point_at(&two);
    if (respond(&two, instance, 0, POINTS) != 0) return;
    for (size_t i = 0; i < POINTS; i++) {
        double scale = 0.0, change = 0.0;
        for (uint32_t c = 0; c < dimension; c++) {
            scale = fmax(scale, fmax(fabs(one.impulse[c * LD + i]), one.normal_mass[i] * fabs(one.velocity_old[c * LD + i])));
            change = fmax(change, fabs(one.impulse[c * LD + i] - two.impulse[c * LD + i]));
        }
        char words[500];
        if (change > LIKE * scale)
            ab_check_fail(
                check,
                "asked again with the velocity that its impulse of (%.9g, %.9g) N s has left, it wants (%.9g, %.9g), after 20 rounds: %s",
                one.impulse[i], one.impulse[LD + i], two.impulse[i], two.impulse[LD + i],
                words_of(check, &one, settings, i, words, sizeof words));
    }
}
static void keep_fixed(ab_check *check) { for_all(check, 8, fixed); }

/* ---- memory ------------------------------------------------------------------------------------------------------------------------ */

static void guarded(ab_check *check, ab_promise promise) {
    static const size_t RANGE[][2] = {{0, POINTS}, {0, 1}, {POINTS - 1, 1}, {5, 7}, {9, 1}, {POINTS - 3, 3}};
    for (uint32_t d = 2; d <= 3; d++) {
        if (!(check->loaded->class_.spaces & (d == 2 ? AB_PLANE_STRAIN | AB_AXISYMMETRIC : AB_SPACE_3D))) continue;
        for (size_t v = 0; v < check->shared->variants && v < 6; v++) {
            ab_check_instance plain, instance;
            ab_loaded_class guard;
            const ab_value *settings = check->shared->settings[v];
            if (!ab_check_open(check, &plain, settings, NULL) || !ab_check_open(check, &instance, settings, &guard))
                ab_check_fail(check, "create refuses settings that it took before");
            prepare(check, &one, &plain, settings, d);
            for (size_t k = 0; k < sizeof RANGE / sizeof *RANGE; k++) {
                two = one;
                point_at(&two);
                if (!check->loaded->class_.nstate) two.points.state0 = two.points.state1 = NULL;
                ab_check_trying(check, "respond for points %zu to %zu", RANGE[k][0], RANGE[k][0] + RANGE[k][1] - 1);
                if (respond(&two, &instance, RANGE[k][0], RANGE[k][1]) != 0 && ab_guard_broken(instance.self) == promise)
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
    prepare(check, &one, instance, settings, dimension);
    two = one;
    point_at(&two);
    if (respond(&one, instance, 0, POINTS) != 0) return;
    if (!(check->loaded->class_.needs & AB_NEED_DISTANCE)) two.points.distance = NULL;
    if (!check->loaded->class_.nstate) two.points.state0 = two.points.state1 = NULL;
    ab_check_trying(check, "respond with NULL for %s%s", two.points.distance ? "" : "distance ", two.points.state0 ? "" : "state0, state1");
    if (respond(&two, instance, 0, POINTS) != 0)
        ab_check_fail(check, "it gives up without what it did not ask for: %s", instance->service.message);
    for (size_t i = 0; i < POINTS; i++) same_point(check, settings, &one, i, &two, i, LD, "without what it did not ask for");
}
static void keep_unasked(ab_check *check) { for_all(check, 8, unasked); }

/* ---- finite numbers ---------------------------------------------------------------------------------------------------------------- */

static void numbers(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    static const double GAP[] = {0.0, 1e-3, 0.5, -1e-6, -1e-2, -0.3}, MASS[] = {1.0, 0.0, 1e-12, 1e6}, SPEED[] = {0.1, 0.0, 1e3};
    static contact_bench plain;
    prepare(check, &plain, instance, settings, dimension);
    for (int n = 0; n < 6 * 4 * 3; n++) {
        one = plain;
        point_at(&one);
        for (size_t i = 0; i < POINTS; i++) {
            one.gap[i] = GAP[n % 6];
            one.normal_mass[i] = MASS[n / 6 % 4];
            one.tangential_mass[i] = i % 3 ? MASS[n / 6 % 4] : 0.0;
            one.area[i] = i % 4 ? 0.1 : 0.0;
            if (i % 5 == 0) one.distance[i] = 0.0;
            for (uint32_t c = 0; c < dimension; c++)
                one.velocity[c * LD + i] *= SPEED[n / 24], one.velocity_old[c * LD + i] = one.velocity[c * LD + i];
        }
        two = one;
        point_at(&two);
        for (size_t k = 0; k < two.states * LD; k++) two.state1[k] = two.state0[k];
        instance->service.message[0] = '\0';
        char words[500];
        ab_check_trying(check, "respond: %s", words_of(check, &two, settings, 0, words, sizeof words));
        const int code = respond(&two, instance, 0, POINTS);
        if (code != 0) {
            if (!instance->service.message[0])
                ab_check_fail(check, "respond returned %d and gave no reason: %s", code,
                              words_of(check, &two, settings, 0, words, sizeof words));
            continue;
        }
        for (size_t i = 0; i < POINTS; i++) {
            for (uint32_t c = 0; c < dimension; c++)
                if (!isfinite(two.impulse[c * LD + i]))
                    ab_check_fail(check, "the impulse is %g N s: %s", two.impulse[c * LD + i],
                                  words_of(check, &one, settings, i, words, sizeof words));
            for (size_t s = 0; s < two.states; s++)
                if (!isfinite(two.state1[s * LD + i]))
                    ab_check_fail(check, "row %zu of state1 is %g: %s", s, two.state1[s * LD + i],
                                  words_of(check, &one, settings, i, words, sizeof words));
            if (!(two.stiffness[i] >= 0.0) || !isfinite(two.stiffness[i]))
                ab_check_fail(check, "stiffness is %g N/m: %s", two.stiffness[i], words_of(check, &one, settings, i, words, sizeof words));
        }
    }
}
static void keep_finite(ab_check *check) { for_all(check, AB_CHECK_VARIANTS, numbers); }

/* ---- dissipation ------------------------------------------------------------------------------------------------------------------- */

/* Bodies that start apart meet, slide and part, pushed about by other forces between the steps. What the impulses take from the motion, impulse x mean of the old and
 * the new velocity, may be stored (a spring) and come back, but never more of it than was taken. A spring across the normal that is integrated explicitly is behind by
 * up to k (v dt)^2/8, which is less than half of the kinetic energy where the step is stable. */
static void dissipation(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    static const double OWED = 0.5, LIKE = 1e-9;
    enum { STEPS = 160 };
    double taken[POINTS] = {0}, most[POINTS] = {0}, moved[POINTS] = {0};
    begin(check, &one, dimension);
    for (size_t i = 0; i < POINTS; i++) one.gap[i] = ab_check_uniform(check, 1e-6, 4e-5);
    bool springs = false;
    for (int n = 0; n < STEPS; n++) {
        if (!step(check, &one, instance, settings)) return;
        for (size_t i = 0; i < POINTS; i++) {
            double work = 0.0, along = 0.0, square = 0.0;
            for (uint32_t c = 0; c < dimension; c++) {
                const size_t k = c * LD + i;
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
                    n + 1, -taken[i], most[i], words_of(check, &one, settings, i, words, sizeof words));
        }
        move_on(check, &one, 0.1);
    }
    double all = 0.0, largest = 0.0;
    for (size_t i = 0; i < POINTS; i++) all += taken[i], largest += most[i];
    if (all < -0.01 * largest) {
        char words[400];
        ab_check_fail(check, "in %d steps its impulses gave %d pairs of points %.6g J more than they took (kinetic energy %.3g J): %s",
                      (int)STEPS, (int)POINTS, -all, largest, ab_check_words(check, settings, words, sizeof words));
    }
}
static void keep_dissipation(ab_check *check) { for_all(check, 12, dissipation); }

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
