/* response_bench.h: one response and contact points of any kind to ask it about. Includes cmocka and what it needs. */
#ifndef RESPONSE_BENCH_H
#define RESPONSE_BENCH_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/plugin_host.h"

enum { MOST = 16, ROWS = 4, STATES = 6 }; /* of penalty: elastic_slip, slips, stored, stiffness_across */

typedef struct bench { /* one response and room for contact points */
    ab_report *report;
    ab_registry *registry;
    const ab_loaded_class *loaded;
    ab_service service;
    void *self;
    double position[ROWS * MOST], normal[ROWS * MOST], gap[MOST], area[MOST], velocity[ROWS * MOST], normal_mass[MOST],
        tangential_mass[MOST];
    double impulse[ROWS * MOST], state0[STATES * MOST], state1[STATES * MOST], distance[MOST], stiffness[MOST], velocity_old[ROWS * MOST];
    size_t start[MOST + 1];
    ab_points points;
} bench;

static char built_in[4096];
static uint64_t random_state = 1;

static inline double uniform(double low, double high) {
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(random_state >> 11) * 0x1p-53;
}

/* Settings by name, then values; the others as declared. */
typedef struct setting {
    const char *name;
    double value;
} setting;

static inline int create(bench *b, const setting *settings, size_t count) {
    const ab_class *class_ = &b->loaded->class_;
    ab_value values[16] = {{0}};
    for (uint32_t k = 0; k < class_->nparam; k++)
        values[k].real = class_->param[k].initial, values[k].integer = isfinite(values[k].real) ? (int64_t)values[k].real : 0;
    for (size_t s = 0; s < count; s++) {
        bool found = false;
        for (uint32_t k = 0; k < class_->nparam; k++)
            if (!strcmp(class_->param[k].name, settings[s].name)) {
                values[k].real = settings[s].value, values[k].integer = (int64_t)settings[s].value;
                values[k].given = 1;
                found = true;
            }
        assert_true(found);
    }
    return class_->create(&b->service.host, values, &b->self);
}

static inline bench *open_bench(const char *name) {
    bench *b = calloc(1, sizeof *b);
    b->report = ab_report_create();
    assert_int_equal(ab_registry_create(built_in, &b->registry, b->report), AB_OK);
    b->loaded = ab_registry_find(b->registry, AB_CONTACT, name, AB_NOWHERE, b->report);
    assert_non_null(b->loaded);
    ab_service_init(&b->service, name);
    for (size_t i = 0; i <= MOST; i++) b->start[i] = i; /* every point is a node */
    b->points = (ab_points){.struct_size = sizeof(ab_points),
                            .dimension = 2,
                            .dt = 1e-3,
                            .cell = 1,
                            .count = MOST,
                            .capacity = MOST,
                            .ld = MOST,
                            .a_start = b->start,
                            .b_start = b->start,
                            .position = b->position,
                            .normal = b->normal,
                            .gap = b->gap,
                            .area = b->area,
                            .relative_velocity = b->velocity,
                            .normal_mass = b->normal_mass,
                            .tangential_mass = b->tangential_mass,
                            .impulse = b->impulse,
                            .state0 = b->state0,
                            .state1 = b->state1,
                            .distance = b->distance,
                            .stiffness = b->stiffness,
                            .modulus = 1e3,
                            .relative_velocity_old = b->velocity_old};
    return b;
}

static inline void close_bench(bench *b) {
    if (b->self) b->loaded->class_.destroy(b->self);
    ab_registry_destroy(b->registry);
    ab_report_destroy(b->report);
    free(b);
}

static inline void respond(bench *b) { assert_int_equal(b->loaded->contact.respond(b->self, &b->points, 0, b->points.count), 0); }

/* Applies what the impulses have become to the relative velocities. */
static inline void apply(bench *b, double before[ROWS * MOST]) {
    const size_t ld = b->points.ld, d = b->points.dimension;
    for (size_t i = 0; i < b->points.count; i++) {
        double along = 0;
        for (size_t c = 0; c < d; c++) along += (b->impulse[c * ld + i] - before[c * ld + i]) * b->normal[c * ld + i];
        for (size_t c = 0; c < d; c++) {
            const double n = along * b->normal[c * ld + i], t = b->impulse[c * ld + i] - before[c * ld + i] - n;
            b->velocity[c * ld + i] -= n / b->normal_mass[i] + t / b->tangential_mass[i];
        }
    }
    memcpy(before, b->impulse, sizeof b->impulse);
}

/* What the spring of point i holds, J/m. */
static inline double *stored(double *state, const bench *b, size_t i) { return state + (b->points.dimension + 1) * MOST + i; }

static inline double along(const bench *b, const double *rows, size_t i) {
    double sum = 0;
    for (size_t c = 0; c < b->points.dimension; c++) sum += rows[c * MOST + i] * b->normal[c * MOST + i];
    return sum;
}

/* Points of any kind: apart, deep, meeting, leaving. */
static inline void scramble(bench *b, uint32_t dimension) {
    b->points.dimension = dimension;
    memset(b->impulse, 0, sizeof b->impulse);
    for (size_t i = 0; i < MOST; i++) {
        double length = 0;
        for (size_t c = 0; c < dimension; c++) b->normal[c * MOST + i] = uniform(-1, 1);
        for (size_t c = 0; c < dimension; c++) length += b->normal[c * MOST + i] * b->normal[c * MOST + i];
        for (size_t c = 0; c < dimension; c++) {
            b->normal[c * MOST + i] /= sqrt(length);
            b->velocity[c * MOST + i] = uniform(-2, 2);
            b->velocity_old[c * MOST + i] = uniform(-2, 2);
            b->state0[c * MOST + i] = uniform(-1e-4, 1e-4);
        }
        b->gap[i] = uniform(-2e-3, 1e-3);
        b->area[i] = uniform(0.1, 1);
        b->normal_mass[i] = b->tangential_mass[i] = uniform(0.1, 3);
        b->distance[i] = uniform(0, 1.2);
        *stored(b->state0, b, i) = uniform(-1, 1); /* half of the springs hold nothing */
        if (*stored(b->state0, b, i) < 0) *stored(b->state0, b, i) = 0;
        b->state0[(dimension + 2) * MOST + i] = uniform(0, 1e6);
    }
}

static const setting penalty_mass[] = {{"stiffness", 0.5}, {"damping", 0.3}, {"friction", 0.4}};
static const setting penalty_modulus[] = {{"stiffness_of", 1}, {"stiffness", 20}, {"damping", 0.3}, {"friction", 0.4}, {"tangential", 0.5}};
static const setting fading[] = {{"friction", 0.4}};
static const struct law {
    const char *name;
    const setting *settings;
    size_t count;
} LAWS[] = {{"penalty", penalty_mass, 3}, {"penalty", penalty_modulus, 5}, {"penalty", NULL, 0}, {"distance-power", fading, 1}};
enum { LAW_COUNT = sizeof LAWS / sizeof *LAWS };

/* For main: the plugins of this build. */
static inline void bench_find_plugins(void) {
    const char *build = getenv("ABUT_BUILD");
    snprintf(built_in, sizeof built_in, "%s/plugins", build ? build : "../..");
}

#endif
