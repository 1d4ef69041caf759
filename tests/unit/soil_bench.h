/* soil_bench.h: one soil material by the names of its settings, and room for a batch, for the tests of soils. */
#ifndef SOIL_BENCH_H
#define SOIL_BENCH_H

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

enum { SOIL_MOST = 64, SOIL_STATES = 3, SOIL_SETTINGS = 12 };

typedef struct soil_setting {
    const char *name;
    double value;
} soil_setting;

typedef struct soil_bench {
    ab_report *report;
    ab_registry *registry;
    const ab_loaded_class *loaded;
    ab_service service;
    void *self;
    double density[SOIL_MOST], strain[6 * SOIL_MOST], stress0[6 * SOIL_MOST], stress1[6 * SOIL_MOST];
    double state0[SOIL_STATES * SOIL_MOST], state1[SOIL_STATES * SOIL_MOST], dissipation[SOIL_MOST], speed[SOIL_MOST];
    uint8_t flag[SOIL_MOST];
    ab_batch batch;
} soil_bench;

static inline const char *soil_plugins(void) {
    static char folder[4096];
    const char *build = getenv("ABUT_BUILD");
    snprintf(folder, sizeof folder, "%s/plugins", build ? build : ".");
    unsetenv("ABUT_PLUGIN_PATH");
    return folder;
}

/* Settings end with a NULL name. Returns what create returned; the message is in service.message. */
static inline int soil_create(soil_bench *b, const soil_setting *settings) {
    const ab_class *class_ = &b->loaded->class_;
    ab_value values[SOIL_SETTINGS + 8] = {{0}};
    for (uint32_t p = 0; p < class_->nparam; p++)
        values[p].real = class_->param[p].initial, values[p].integer = (int64_t)class_->param[p].initial;
    for (; settings->name; settings++) {
        uint32_t p = 0;
        while (p < class_->nparam && strcmp(class_->param[p].name, settings->name) != 0) p++;
        if (p == class_->nparam) fail_msg("%s has no setting %s", class_->name, settings->name);
        values[p].real = settings->value, values[p].integer = (int64_t)settings->value, values[p].given = 1;
    }
    b->service.message[0] = '\0';
    return class_->create(&b->service.host, values, &b->self);
}

static inline soil_bench *soil_bench_open(const char *name) {
    soil_bench *b = calloc(1, sizeof *b);
    b->report = ab_report_create();
    assert_int_equal(ab_registry_create(soil_plugins(), &b->registry, b->report), AB_OK);
    b->loaded = ab_registry_find(b->registry, AB_MATERIAL, name, AB_NOWHERE, b->report);
    assert_non_null(b->loaded);
    ab_service_init(&b->service, name);
    for (size_t i = 0; i < SOIL_MOST; i++) b->density[i] = 2000.0;
    return b;
}

static inline soil_bench *soil_bench_make(const char *name, const soil_setting *settings) {
    soil_bench *b = soil_bench_open(name);
    if (soil_create(b, settings) != 0) fail_msg("%s refused its settings: %s", name, b->service.message);
    return b;
}

static inline void soil_bench_close(soil_bench *b) {
    if (b->self) b->loaded->class_.destroy(b->self);
    ab_registry_destroy(b->registry);
    ab_report_destroy(b->report);
    free(b);
}

static inline ab_batch soil_batch(soil_bench *b, int components, size_t count, size_t ld) {
    return (ab_batch){.struct_size = sizeof(ab_batch),
                      .dimension = components == 4 ? 2 : 3,
                      .components = (uint32_t)components,
                      .count = count,
                      .ld = ld,
                      .dt = 1e-3,
                      .density = b->density,
                      .strain_increment = b->strain,
                      .stress0 = b->stress0,
                      .stress1 = b->stress1,
                      .state0 = b->state0,
                      .state1 = b->state1,
                      .dissipation = b->dissipation,
                      .wave_speed = b->speed,
                      .flag = b->flag};
}

static inline int soil_bench_update(soil_bench *b, int components, size_t count, size_t ld) {
    memset(b->flag, 0, sizeof b->flag);
    b->batch = soil_batch(b, components, count, ld);
    return b->loaded->material.update(b->self, &b->batch);
}

static inline void soil_bench_start(soil_bench *b, int components) {
    memset(b->flag, 0, sizeof b->flag);
    b->batch = soil_batch(b, components, 8, 8);
    if (b->loaded->material.start) assert_int_equal(b->loaded->material.start(b->self, &b->batch), 0);
    memcpy(b->stress0, b->stress1, sizeof b->stress0);
    memcpy(b->state0, b->state1, sizeof b->state0);
}

/* One point, kept in item 0 of eight: stress0 and state0 move on. */
typedef struct soil_point {
    soil_bench *bench;
    int components;
    double stress[6], state[SOIL_STATES], strain[6], dissipated, speed;
} soil_point;

static inline soil_point soil_point_of(soil_bench *b, int components) {
    soil_point p = {.bench = b, .components = components};
    memset(b->stress1, 0, sizeof b->stress1);
    memset(b->state1, 0, sizeof b->state1);
    soil_bench_start(b, components);
    for (int c = 0; c < components; c++) p.stress[c] = b->stress0[c * 8];
    for (int s = 0; s < SOIL_STATES; s++) p.state[s] = b->state0[s * 8];
    return p;
}

/* What the stress would be after an increment of strain; `keep`: the point moves on. */
static inline void soil_point_step(soil_point *p, const double strain[6], double stress[6], int keep) {
    soil_bench *b = p->bench;
    for (int c = 0; c < p->components; c++) b->strain[c * 8] = strain[c], b->stress0[c * 8] = p->stress[c];
    for (int s = 0; s < SOIL_STATES; s++) b->state0[s * 8] = p->state[s];
    if (soil_bench_update(b, p->components, 1, 8) != 0) fail_msg("the material gave up: %s", b->service.message);
    for (int c = 0; c < 6; c++) stress[c] = c < p->components ? b->stress1[c * 8] : 0.0;
    if (!keep) return;
    for (int c = 0; c < p->components; c++) p->stress[c] = stress[c], p->strain[c] += strain[c];
    for (int s = 0; s < SOIL_STATES; s++) p->state[s] = b->state1[s * 8];
    p->dissipated += b->dissipation[0];
    p->speed = b->speed[0];
}

/* A step with some components of strain given, and others such that their stress is what `held` says (`free_` has 1 for these): Newton's
 * method with a tangent by differences, to 1e-9 of `scale`. `round`: z is strained as x is (triaxial tests), so that only x needs to be
 * held. `strain` has the given increments and takes the others as a first guess; it is left with what was found. */
static inline void soil_point_mixed(soil_point *p, double strain[6], const int free_[6], bool round, const double held[6], double scale) {
    int list[6], n = 0;
    for (int c = 0; c < p->components; c++)
        if (free_[c]) list[n++] = c;
    double stress[6];
    for (int iteration = 0; iteration < 60; iteration++) {
        double A[6][7], worst = 0.0;
        if (round) strain[2] = strain[0];
        soil_point_step(p, strain, stress, 0);
        for (int r = 0; r < n; r++) A[r][n] = held[list[r]] - stress[list[r]], worst = fmax(worst, fabs(A[r][n]));
        if (worst <= 1e-9 * scale) break;
        if (iteration == 59) fail_msg("the held stress is not met: off by %g of %g", worst, scale);
        for (int k = 0; k < n; k++) {
            double moved[6], other[6];
            const double h = 1e-9;
            memcpy(moved, strain, sizeof moved);
            moved[list[k]] += h;
            if (round) moved[2] = moved[0];
            soil_point_step(p, moved, other, 0);
            for (int r = 0; r < n; r++) A[r][k] = (other[list[r]] - stress[list[r]]) / h;
        }
        for (int k = 0; k < n; k++) { /* the tangents are well enough conditioned */
            int best = k;
            for (int r = k + 1; r < n; r++)
                if (fabs(A[r][k]) > fabs(A[best][k])) best = r;
            for (int c = 0; c <= n; c++) {
                const double keep = A[k][c];
                A[k][c] = A[best][c], A[best][c] = keep;
            }
            for (int r = 0; r < n; r++)
                if (r != k) {
                    const double f = A[r][k] / A[k][k];
                    for (int c = k; c <= n; c++) A[r][c] -= f * A[k][c];
                }
        }
        for (int k = 0; k < n; k++) strain[list[k]] += A[k][n] / A[k][k];
    }
    soil_point_step(p, strain, stress, 1);
}

static inline void soil_near(const char *what, double value, double wanted, double tolerance) {
    if (!(fabs(value - wanted) <= tolerance)) fail_msg("%s: %.12g, wanted %.12g within %.3g", what, value, wanted, tolerance);
}

static uint64_t soil_random_state = 1;
static inline double soil_uniform(double low, double high) {
    soil_random_state = soil_random_state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(soil_random_state >> 11) * 0x1p-53;
}

#define SOIL(...) ((const soil_setting[]){__VA_ARGS__, {NULL, 0}})
#define SOIL_DEGREE (3.14159265358979323846 / 180.0)

#endif
