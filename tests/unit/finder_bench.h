/* finder_bench.h: the finder point-to-segment alone, on surfaces that are drawn by hand. */
#ifndef FINDER_BENCH_H
#define FINDER_BENCH_H

#include "fake_surface.h"

enum { POINTS_MOST = 64 };

typedef struct finder { /* the plugin with its own points */
    contact_plugins plugins;
    const ab_loaded_class *class_;
    ab_service service;
    ab_value settings[16];
    void *self;
    contact_points points;
    ab_trace a, b;
    ab_surface surface_a, surface_b;
    size_t *near_start[2];
    uint32_t *near_face[2];
} finder;

static inline int reserve(void *context, ab_points *view, size_t points_more, size_t stencil_more) {
    (void)context;
    const size_t stencil = points_more + stencil_more + (view->count ? view->a_start[view->count] + view->b_start[view->count] : 0);
    return contact_points_reserve((contact_points *)view, view->count + points_more, stencil) ? 0 : -1;
}

static inline void finder_open(finder *f, const char *setting, double value) {
    *f = (finder){.plugins = contact_plugins_open()};
    f->class_ = contact_class(&f->plugins, "point-to-segment");
    ab_service_init(&f->service, "test");
    f->service.host.reserve = reserve;
    default_settings(f->class_, f->settings, setting, value);
    assert_int_equal(f->class_->class_.create(&f->service.host, f->settings, &f->self), 0);
    f->points.surfaces = f->points.distances = true;
    f->points.states = HISTORY;
    f->points.view = (ab_points){.struct_size = sizeof(ab_points), .dimension = 2, .dt = 1, .cell = 1};
}

static inline void finder_close(finder *f) {
    f->class_->class_.destroy(f->self);
    contact_points_destroy(&f->points);
    for (int k = 0; k < 2; k++) free(f->near_start[k]), free(f->near_face[k]);
    contact_plugins_close(&f->plugins);
}

/* Every point near every face. */
static inline void all_near(finder *f, int side, ab_surface *points, const ab_surface *faces) {
    free(f->near_start[side]), free(f->near_face[side]);
    f->near_start[side] = calloc(points->point_count + 1, sizeof(size_t));
    f->near_face[side] = calloc(points->point_count * faces->face_count + 1, sizeof(uint32_t));
    for (size_t i = 0; i < points->point_count; i++) {
        for (size_t k = 0; k < faces->face_count; k++) f->near_face[side][i * faces->face_count + k] = (uint32_t)k;
        f->near_start[side][i + 1] = (i + 1) * faces->face_count;
    }
    points->near_start = f->near_start[side];
    points->near_face = f->near_face[side];
}

/* Contact points of two bodies; gaps up to `reach` are given out. Returns how many. */
static inline size_t look(finder *f, surface_body *a, surface_body *b, double reach) {
    surface_body *body[2] = {a, b};
    ab_surface *surface[2] = {&f->surface_a, &f->surface_b};
    ab_trace *trace[2] = {&f->a, &f->b};
    for (int k = 0; k < 2; k++) {
        *surface[k] = (ab_surface){.struct_size = sizeof(ab_surface), .dimension = 2};
        if (body[k]->faces) surface_body_faces(&body[k]->domain, surface[k], NULL);
        surface_body_list(body[k], NULL, surface[k]);
        *trace[k] =
            (ab_trace){.struct_size = sizeof(ab_trace), .dimension = 2, .body = body[k]->spec.name, .cell = 1, .surface = surface[k]};
    }
    all_near(f, 0, surface[0], surface[1]);
    all_near(f, 1, surface[1], surface[0]);
    f->points.view.cell = reach / 0.03; /* a small part of a cell is given out whatever the speed */
    f->points.view.failures = 0;
    assert_int_equal(f->class_->contact.find(f->self, &f->a, &f->b, &f->points.view), 0);
    const ab_points *p = &f->points.view;
    for (size_t i = 0; i < p->count; i++) {
        double sum[2] = {0, 0};
        for (size_t s = p->a_start[i]; s < p->a_start[i + 1]; s++) sum[0] += p->a_weight[s];
        for (size_t s = p->b_start[i]; s < p->b_start[i + 1]; s++) sum[1] += p->b_weight[s];
        assert_true(fabs(sum[0] - 1) <= 1e-14 && fabs(sum[1] - 1) <= 1e-14);
        assert_true(fabs(hypot(p->normal[i], p->normal[p->ld + i]) - 1) <= 1e-14);
        assert_true(isfinite(p->gap[i] + p->area[i] + p->position[i] + p->position[p->ld + i] + p->distance[i]));
        assert_true(p->distance[i] == fmax(p->gap[i], 0));
        for (size_t k = 0; k < i; k++) assert_true(p->key[k] != p->key[i]);
    }
    return p->count;
}

static inline double nx(const finder *f, size_t i) { return f->points.view.normal[i]; }
static inline double ny(const finder *f, size_t i) { return f->points.view.normal[f->points.view.ld + i]; }
static inline double gap(const finder *f, size_t i) { return f->points.view.gap[i]; }

#define near(x, y, tolerance) assert_true(fabs((x) - (y)) <= (tolerance))

static inline surface_body *cloud(const double (*place)[2], size_t count, double half) {
    surface_body *b = surface_body_create("points", count, 0, 0);
    for (size_t k = 0; k < count; k++) {
        surface_body_put(b, k, place[k][0], place[k][1]);
        b->extent[k] = b->extent[count + k] = half * half;
        b->area[k] = 2 * half;
    }
    return b;
}

static inline surface_body *box(const char *name, double x0, double y0, double x1, double y1) {
    const double corner[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    return surface_polygon(name, corner, 4, false, 1);
}

#endif
