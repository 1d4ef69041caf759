/* one_body.h: one material-point body from a scene's text, with the built-in plugins, for tests that look inside it. */
#ifndef AB_ONE_BODY_H
#define AB_ONE_BODY_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "mpm/body.h"
#include "whole_scene.h"

typedef struct one_body {
    ab_report *report;
    ab_registry *registry;
    ab_scene *scene;
    mpm_body *mpm;
    ab_domain *domain;
    ab_step step;
} one_body;

static inline void say_all(const ab_report *report) {
    for (size_t i = 0; ab_report_text(report, i); i++) print_error("%s\n", ab_report_text(report, i));
}

#define must(one, call)                                                                                                                    \
    do {                                                                                                                                   \
        const ab_status status_ = (call);                                                                                                  \
        if (status_ != AB_OK) say_all((one)->report);                                                                                      \
        assert_int_equal(status_, AB_OK);                                                                                                  \
    } while (0)

/* As far as it goes: what is said is in the report. The domain is NULL unless the status is AB_OK. */
static inline ab_status one_body_attempt(one_body *one, const char *text, int threads) {
    one->report = ab_report_create();
    must(one, whole_scene_read(text, &one->registry, &one->scene, one->report));
    const ab_status status = mpm_create(one->scene, 0, threads, &one->domain, one->report);
    one->mpm = (mpm_body *)one->domain;
    one->step.dt = one->scene->time_dt;
    return status;
}

static inline one_body *one_body_create(const char *text, int threads) {
    one_body *one = calloc(1, sizeof *one);
    must(one, one_body_attempt(one, text, threads));
    return one;
}

static inline void one_body_destroy(one_body *one) {
    if (one->domain) one->domain->ops->destroy(one->domain);
    ab_scene_destroy(one->scene);
    ab_registry_destroy(one->registry);
    ab_report_destroy(one->report);
    free(one);
}

/* One step as the scheduler takes it; `hold`, where given, may change nodal velocities before they are used. */
static inline void one_body_step(one_body *one, void (*hold)(one_body *, void *), void *data) {
    const ab_domain_ops *ops = one->domain->ops;
    must(one, ops->begin(one->domain, &one->step, one->report));
    if (hold) hold(one, data);
    if (ops->early) {
        must(one, ops->early(one->domain, &one->step, one->report));
        if (hold) hold(one, data);
    }
    must(one, ops->finish(one->domain, &one->step, one->report));
    if (ops->remap) must(one, ops->remap(one->domain, &one->step, one->report));
    if (hold) hold(one, data);
    must(one, ops->stress(one->domain, &one->step, one->report));
    one->step.time += one->step.dt;
    one->step.number++;
}

/* Place of node n of tile k, m from the grid's corner. */
static inline void node_place(const mpm_body *body, size_t k, int n, double x[2]) {
    x[0] = (body->tiles[k].tx * AB_TILE + n % AB_TILE) * body->h;
    x[1] = (body->tiles[k].ty * AB_TILE + n / AB_TILE) * body->h;
}

static inline double *node_record(const mpm_body *body, size_t k, int n) {
    return body->own + (k * AB_TILE_NODES + (size_t)n) * OWN_RECORD;
}

static inline bool is_point(const mpm_body *body, size_t slot) { return body->ids[slot] != UINT64_MAX; }

/* Row `row` of the point in a slot. */
static inline double *point_row(const mpm_body *body, size_t slot, int row) { return mpm_block(body, slot / 8) + 8 * row + slot % 8; }

static inline double random_between(double low, double high) {
    static uint64_t state = 20;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(state >> 11) * 0x1p-53;
}

#endif
