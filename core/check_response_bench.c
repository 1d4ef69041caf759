/* check_response_bench.c: contact points that are not coupled with each other, for the promises of a response. */
#include <math.h>
#include <string.h>

#include "core/check_response_bench.h"

/* Pointers of a bench into its own arrays. */
void ab_contact_bench_point(ab_contact_bench *b) {
    ab_points *p = &b->points;
    p->key = b->key, p->a_start = b->a_start, p->b_start = b->b_start, p->a_dof = b->a_dof, p->b_dof = b->b_dof, p->a_weight = b->a_weight,
    p->b_weight = b->b_weight;
    p->position = b->position, p->normal = b->normal, p->gap = b->gap, p->area = b->area, p->distance = b->distance,
    p->stiffness = b->stiffness;
    p->relative_velocity = b->velocity, p->relative_velocity_old = b->velocity_old, p->normal_mass = b->normal_mass,
    p->tangential_mass = b->tangential_mass;
    p->impulse = b->impulse, p->state0 = b->state0, p->state1 = b->state1;
}

void ab_contact_bench_begin(ab_check *check, ab_contact_bench *b, uint32_t dimension) {
    memset(b, 0, sizeof *b);
    b->states = (size_t)ab_guard_state_rows(&check->loaded->class_, dimension);
    b->points = (ab_points){.struct_size = sizeof(ab_points),
                            .dimension = dimension,
                            .time = 1.0,
                            .dt = 1e-4,
                            .cell = 0.1,
                            .count = AB_BENCH_POINTS,
                            .capacity = AB_BENCH_LD,
                            .ld = AB_BENCH_LD,
                            .modulus = 1e7,
                            .speed = 1.0,
                            .density = 1000.0,
                            .fixed_places = 1,
                            .measure_area = 1};
    ab_contact_bench_point(b);
    for (size_t i = 0; i < AB_BENCH_LD; i++) {
        double n[3] = {0};
        ab_check_unit_vector(check, dimension, n);
        b->key[i] = 100 + i;
        b->a_start[i + 1] = b->b_start[i + 1] = (i + 1) * (i % 2 ? 1 : AB_BENCH_STENCIL) + (i % 2 ? (i + 1) / 2 : 0); /* filled below */
        for (uint32_t c = 0; c < dimension; c++) {
            b->normal[c * AB_BENCH_LD + i] = n[c];
            b->position[c * AB_BENCH_LD + i] = ab_check_uniform(check, 0.0, 1.0);
            b->velocity[c * AB_BENCH_LD + i] = ab_check_uniform(check, -0.5, 0.5);
        }
        b->gap[i] = i % 3 ? 0.0 : ab_check_uniform(check, 0.0, 2e-5);
        b->area[i] = 0.1;
        b->distance[i] = ab_check_uniform(check, 0.0, 0.1);
        b->normal_mass[i] = pow(10.0, ab_check_uniform(check, -1.0, 1.0));
        b->tangential_mass[i] = i % 2 ? b->normal_mass[i] : b->normal_mass[i] * ab_check_uniform(check, 0.5, 1.0);
    }
    size_t end = 0;
    for (size_t i = 0; i < AB_BENCH_LD; i++) {
        const size_t count = i % 2 ? AB_BENCH_STENCIL : 1;
        for (size_t s = 0; s < count; s++, end++)
            b->a_dof[end] = b->b_dof[end] = (uint32_t)end, b->a_weight[end] = b->b_weight[end] = 1.0 / (double)count;
        b->a_start[i + 1] = b->b_start[i + 1] = end;
    }
}

int ab_contact_bench_respond(ab_contact_bench *b, const ab_check_instance *instance, size_t first, size_t count) {
    return instance->loaded->contact.respond(instance->self, &b->points, first, count);
}

const char *ab_contact_bench_words(const ab_check *check, const ab_contact_bench *b, const ab_value *settings, size_t i, char *text,
                                   size_t size) {
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
static void apply(ab_contact_bench *b, const double *before) {
    const uint32_t d = b->points.dimension;
    for (size_t i = 0; i < AB_BENCH_POINTS; i++) {
        double along = 0.0;
        for (uint32_t c = 0; c < d; c++)
            along += (b->impulse[c * AB_BENCH_LD + i] - before[c * AB_BENCH_LD + i]) * b->normal[c * AB_BENCH_LD + i];
        for (uint32_t c = 0; c < d; c++) {
            const double n = along * b->normal[c * AB_BENCH_LD + i], t = b->impulse[c * AB_BENCH_LD + i] - before[c * AB_BENCH_LD + i] - n;
            if (b->normal_mass[i] > 0.0) b->velocity[c * AB_BENCH_LD + i] -= n / b->normal_mass[i];
            if (b->tangential_mass[i] > 0.0) b->velocity[c * AB_BENCH_LD + i] -= t / b->tangential_mass[i];
        }
    }
}

/* One step of the host: rounds until the impulses stand still. False: the response gave up. */
bool ab_contact_bench_step(ab_check *check, ab_contact_bench *b, const ab_check_instance *instance, const ab_value *settings) {
    double before[3 * AB_BENCH_LD];
    char words[500];
    memset(b->impulse, 0, sizeof b->impulse);
    memset(b->stiffness, 0, sizeof b->stiffness);
    memcpy(b->velocity_old, b->velocity, sizeof b->velocity_old);
    ab_check_trying(check, "respond: %s", ab_contact_bench_words(check, b, settings, 0, words, sizeof words));
    for (int round = 0; round < 20; round++) {
        memcpy(before, b->impulse, sizeof before);
        if (ab_contact_bench_respond(b, instance, 0, AB_BENCH_POINTS) != 0) return false;
        apply(b, before);
        double change = 0.0, largest = 0.0;
        for (size_t k = 0; k < 3 * AB_BENCH_LD; k++)
            change = fmax(change, fabs(b->impulse[k] - before[k])), largest = fmax(largest, fabs(b->impulse[k]));
        if (change <= 1e-14 * largest) break;
    }
    return true;
}

/* The next step: states, gaps, and what other forces do to the velocities. */
void ab_contact_bench_move_on(ab_check *check, ab_contact_bench *b, double kick) {
    memcpy(b->state0, b->state1, sizeof b->state0);
    for (size_t i = 0; i < AB_BENCH_POINTS; i++)
        for (uint32_t c = 0; c < b->points.dimension; c++) {
            b->gap[i] -= b->velocity[c * AB_BENCH_LD + i] * b->normal[c * AB_BENCH_LD + i] * b->points.dt;
            b->velocity[c * AB_BENCH_LD + i] += ab_check_uniform(check, -kick, kick);
        }
}

void ab_contact_bench_for_all(ab_check *check, size_t most, ab_contact_bench_each what) {
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
void ab_contact_bench_prepare(ab_check *check, ab_contact_bench *b, const ab_check_instance *instance, const ab_value *settings,
                              uint32_t dimension) {
    ab_contact_bench_begin(check, b, dimension);
    for (int n = 0; n < 4; n++) {
        if (!ab_contact_bench_step(check, b, instance, settings))
            ab_check_fail(check, "respond gives up on plain contact points: %s",
                          instance->service.message[0] ? instance->service.message : "no reason");
        ab_contact_bench_move_on(check, b, 0.2);
    }
    memset(b->impulse, 0, sizeof b->impulse), memset(b->stiffness, 0, sizeof b->stiffness),
        memcpy(b->velocity_old, b->velocity, sizeof b->velocity_old);
}

void ab_contact_bench_same(ab_check *check, const ab_value *settings, const ab_contact_bench *wanted, size_t j, const ab_contact_bench *got,
                           size_t i, size_t ld, const char *what) {
    const struct {
        const char *name;
        const double *wanted, *got;
        size_t rows;
    } list[] = {{"impulse", wanted->impulse, got->impulse, wanted->points.dimension},
                {"state1", wanted->state1, got->state1, wanted->states},
                {"stiffness", wanted->stiffness, got->stiffness, 1}};
    for (size_t k = 0; k < sizeof list / sizeof *list; k++)
        for (size_t r = 0; r < list[k].rows; r++) {
            const double *x = list[k].got + r * ld + i, *y = list[k].wanted + r * AB_BENCH_LD + j;
            char words[500];
            if (memcmp(x, y, sizeof *x))
                ab_check_fail(check, "row %zu of %s is %.17g %s, and %.17g before: %s", r, list[k].name, *x, what, *y,
                              ab_contact_bench_words(check, wanted, settings, j, words, sizeof words));
        }
}
