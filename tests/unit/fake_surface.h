/* fake_surface.h: bodies that are nothing but a surface, with masses at its vertices or rigid as a whole, for tests of contact between surfaces. */
#ifndef FAKE_SURFACE_H
#define FAKE_SURFACE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "contact/contact.h"

typedef struct surface_body {
    ab_domain domain;
    ab_body_spec spec;
    size_t vertices, faces, listed;
    bool rigid;
    double *x, *place, *extent, *list_extent, *area, *list_area, *weight; /* two (extents three) rows of `vertices` */
    uint32_t *face, *beside, *dof, *list_dof, *list_vertex;
    size_t *start;
    uint64_t *key;
    double *velocity, *old, *inverse_mass; /* two a dof */
    double spin, spin_old, inverse_inertia, centre[2], modulus;
} surface_body;

static inline ab_status surface_body_faces(ab_domain *domain, ab_surface *s, ab_report *report) {
    (void)report;
    surface_body *b = (surface_body *)domain;
    s->vertex_count = s->vertex_ld = b->vertices;
    s->vertex_position = b->x;
    s->vertex_start = b->start;
    s->vertex_dof = b->dof;
    s->vertex_weight = b->weight;
    s->face_count = b->faces;
    s->face_vertex = b->face;
    s->face_beside = b->beside;
    return AB_OK;
}

static inline bool in_cells(const ab_region *region, const double x[2]) {
    const int32_t i = (int32_t)floor(x[0] / region->cell), j = (int32_t)floor(x[1] / region->cell);
    const int32_t tx = (int32_t)floor((double)i / AB_TILE), ty = (int32_t)floor((double)j / AB_TILE);
    size_t low = 0, high = region->count;
    const uint64_t key = ab_tile_key(tx, ty);
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (region->key[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low < region->count && region->key[low] == key && (region->cells[low] >> ((j - ty * AB_TILE) * AB_TILE + i - tx * AB_TILE) & 1);
}

/* region NULL: all. */
static inline void surface_body_list(surface_body *b, const ab_region *region, ab_surface *s) {
    const size_t ld = b->vertices;
    b->listed = 0;
    for (size_t k = 0; k < ld; k++) {
        const double x[2] = {b->x[k], b->x[ld + k]};
        if (region && !in_cells(region, x)) continue;
        const size_t n = b->listed++;
        for (size_t c = 0; c < 2; c++) b->place[c * ld + n] = x[c];
        for (size_t c = 0; c < 3; c++) b->list_extent[c * ld + n] = b->extent[c * ld + k];
        b->list_area[n] = b->area[k];
        b->list_dof[n] = b->dof[k];
        b->list_vertex[n] = (uint32_t)k;
        b->key[n] = k + 1;
    }
    s->point_count = b->listed;
    s->point_ld = ld;
    s->point_position = b->place;
    s->point_extent = b->list_extent;
    s->point_area = b->list_area;
    s->point_key = b->key;
    s->point_start = b->start;
    s->point_dof = b->list_dof;
    s->point_weight = b->weight;
    s->point_vertex = b->faces ? b->list_vertex : NULL;
}

static inline ab_status surface_body_points(ab_domain *domain, const ab_region *region, ab_surface *s, ab_report *report) {
    (void)report;
    surface_body_list((surface_body *)domain, region, s);
    return AB_OK;
}

static inline void surface_body_dofs(const ab_domain *domain, ab_dofs *d) {
    surface_body *b = (surface_body *)(uintptr_t)domain;
    *d = (ab_dofs){.velocity = b->velocity,
                   .velocity_old = b->old,
                   .inverse_mass = b->inverse_mass,
                   .velocity_stride = 2,
                   .old_stride = 2,
                   .mass_stride = 2,
                   .inverse_inertia = b->inverse_inertia,
                   .centre = {b->centre[0], b->centre[1]}};
    if (b->rigid) d->spin = &b->spin, d->spin_old = &b->spin_old;
}

static inline double surface_body_modulus(const ab_domain *domain) { return ((const surface_body *)domain)->modulus; }

/* No node_tiles, no trace: whoever asks for nodes of these bodies falls. */
static const ab_domain_ops SURFACE_BODY_OPS = {.method = "surface",
                                               .dofs = surface_body_dofs,
                                               .faces = surface_body_faces,
                                               .surface_points = surface_body_points,
                                               .modulus = surface_body_modulus};
static const ab_domain_ops SURFACE_CLOUD_OPS = {
    .method = "cloud", .dofs = surface_body_dofs, .surface_points = surface_body_points, .modulus = surface_body_modulus};

/* Vertices without faces; mass 1 each, area 1, modulus 1. */
static inline surface_body *surface_body_create(const char *name, size_t vertices, size_t faces, size_t index) {
    surface_body *b = calloc(1, sizeof *b);
    const size_t n = vertices;
    b->domain = (ab_domain){faces ? &SURFACE_BODY_OPS : &SURFACE_CLOUD_OPS, &b->spec, 2, index};
    b->spec.name = strdup(name);
    b->spec.material = SIZE_MAX;
    b->vertices = n, b->faces = faces;
    b->x = calloc(2 * n + 1, sizeof *b->x), b->place = calloc(2 * n + 1, sizeof *b->x);
    b->extent = calloc(3 * n + 1, sizeof *b->x), b->list_extent = calloc(3 * n + 1, sizeof *b->x);
    b->area = calloc(n + 1, sizeof *b->x), b->list_area = calloc(n + 1, sizeof *b->x), b->weight = calloc(n + 1, sizeof *b->x);
    b->face = calloc(3 * faces + 1, sizeof *b->face), b->beside = calloc(2 * faces + 1, sizeof *b->face);
    b->dof = calloc(n + 1, sizeof *b->dof), b->list_dof = calloc(n + 1, sizeof *b->dof), b->list_vertex = calloc(n + 1, sizeof *b->dof);
    b->start = calloc(n + 1, sizeof *b->start);
    b->key = calloc(n + 1, sizeof *b->key);
    b->velocity = calloc(2 * n + 2, sizeof *b->x), b->old = calloc(2 * n + 2, sizeof *b->x);
    b->inverse_mass = calloc(2 * n + 2, sizeof *b->x);
    b->modulus = 1;
    for (size_t k = 0; k <= n; k++) b->start[k] = k;
    for (size_t k = 0; k < n; k++) {
        b->dof[k] = (uint32_t)k;
        b->weight[k] = b->area[k] = 1;
        b->inverse_mass[2 * k] = b->inverse_mass[2 * k + 1] = 1;
    }
    return b;
}

static inline void surface_body_destroy(surface_body *b) {
    free(b->spec.name), free(b->x), free(b->place), free(b->extent), free(b->list_extent), free(b->area), free(b->list_area);
    free(b->weight), free(b->face), free(b->beside), free(b->dof), free(b->list_dof), free(b->list_vertex), free(b->start), free(b->key);
    free(b->velocity), free(b->old), free(b->inverse_mass), free(b);
}

static inline void surface_body_put(surface_body *b, size_t vertex, double x, double y) {
    b->x[vertex] = x;
    b->x[b->vertices + vertex] = y;
}

/* Shares of the faces' lengths, as the elements would spread a uniform pressure. */
static inline void surface_body_share(surface_body *b) {
    memset(b->area, 0, b->vertices * sizeof *b->area);
    for (size_t f = 0; f < b->faces; f++) {
        const uint32_t *v = b->face + 3 * f;
        const double length = hypot(b->x[v[1]] - b->x[v[0]], b->x[b->vertices + v[1]] - b->x[b->vertices + v[0]]);
        const double end = v[2] == UINT32_MAX ? 0.5 : 1.0 / 6.0;
        b->area[v[0]] += end * length;
        b->area[v[1]] += end * length;
        if (v[2] != UINT32_MAX) b->area[v[2]] += (1 - 2 * end) * length;
    }
}

/* A closed polygon, counter-clockwise; quadratic: every second place is a middle node. */
static inline surface_body *surface_polygon(const char *name, const double (*corner)[2], size_t count, bool quadratic, size_t index) {
    const size_t faces = quadratic ? count / 2 : count, step = quadratic ? 2 : 1;
    surface_body *b = surface_body_create(name, count, faces, index);
    for (size_t k = 0; k < count; k++) surface_body_put(b, k, corner[k][0], corner[k][1]);
    for (size_t f = 0; f < faces; f++) {
        b->face[3 * f] = (uint32_t)(step * f);
        b->face[3 * f + 1] = (uint32_t)(step * f + step) % (uint32_t)count;
        b->face[3 * f + 2] = quadratic ? (uint32_t)(2 * f + 1) : UINT32_MAX;
        b->beside[2 * f] = (uint32_t)((f + faces - 1) % faces);
        b->beside[2 * f + 1] = (uint32_t)((f + 1) % faces);
    }
    surface_body_share(b);
    return b;
}

/* All vertices hang on one dof that turns about a centre. */
static inline void surface_body_stiffen(surface_body *b, double mass, double inertia, double cx, double cy) {
    b->rigid = true;
    b->modulus = INFINITY;
    for (size_t k = 0; k < b->vertices; k++) b->dof[k] = 0;
    b->inverse_mass[0] = b->inverse_mass[1] = 1 / mass;
    b->inverse_inertia = 1 / inertia;
    b->centre[0] = cx, b->centre[1] = cy;
}

static inline double *surface_body_velocity(surface_body *b, size_t vertex) { return b->velocity + 2 * (size_t)b->dof[vertex]; }

/* ---- plugins ---- */

typedef struct contact_plugins {
    ab_report *report;
    ab_registry *registry;
} contact_plugins;

static inline contact_plugins contact_plugins_open(void) {
    contact_plugins p = {.report = ab_report_create()};
    char path[4096];
    const char *build = getenv("ABUT_BUILD");
    snprintf(path, sizeof path, "%s/plugins", build ? build : "../..");
    assert_int_equal(ab_registry_create(path, &p.registry, p.report), AB_OK);
    return p;
}

static inline void contact_plugins_close(contact_plugins *p) {
    ab_registry_destroy(p->registry);
    ab_report_destroy(p->report);
}

static inline const ab_loaded_class *contact_class(const contact_plugins *p, const char *name) {
    const ab_loaded_class *found = ab_registry_find(p->registry, AB_CONTACT, name, AB_NOWHERE, p->report);
    assert_non_null(found);
    return found;
}

/* Default settings of a class; one of them may be given another value. */
static inline void default_settings(const ab_loaded_class *class_, ab_value *value, const char *name, double given) {
    for (uint32_t k = 0; k < class_->class_.nparam; k++) {
        const ab_param *param = class_->class_.param + k;
        const double number = name && !strcmp(param->name, name) ? given : param->initial;
        value[k] = (ab_value){.real = number, .integer = isfinite(number) ? (int64_t)number : 0};
    }
}

/* A step of two bodies in contact, with the host's own loop. */
typedef struct surface_scene {
    contact_plugins plugins;
    ab_scene scene;
    ab_body_spec body[2];
    ab_contact_spec contact;
    ab_value finder[16], responder[16];
    surface_body *bodies[2];
    ab_domain *domains[2];
    ab_interaction *interaction;
    ab_step step;
} surface_scene;

static inline void surface_scene_create(surface_scene *s, surface_body *a, surface_body *b, const char *response, const char *setting,
                                        double value) {
    *s = (surface_scene){.plugins = contact_plugins_open(), .bodies = {a, b}, .domains = {&a->domain, &b->domain}};
    s->body[0] = a->spec, s->body[1] = b->spec;
    s->contact.body[1] = 1;
    s->contact.finder = contact_class(&s->plugins, "point-to-segment");
    s->contact.responder = contact_class(&s->plugins, response);
    s->contact.finder_settings = s->finder;
    s->contact.responder_settings = s->responder;
    default_settings(s->contact.finder, s->finder, setting, value);
    default_settings(s->contact.responder, s->responder, setting, value);
    s->scene = (ab_scene){.dimension = 2, .bodies = s->body, .body_count = 2, .contacts = &s->contact, .contact_count = 1};
    s->step.dt = 1e-3;
    assert_int_equal(contact_create(&s->scene, s->domains, &s->interaction, s->plugins.report), AB_OK);
}

static inline void surface_scene_solve(surface_scene *s) {
    const ab_status status = s->interaction->solve(s->interaction, &s->step, AB_STAGE_DYNAMIC, s->plugins.report);
    for (size_t k = 0; ab_report_text(s->plugins.report, k); k++) print_message("%s\n", ab_report_text(s->plugins.report, k));
    assert_int_equal(status, AB_OK);
    s->interaction->settle(s->interaction, &s->step);
    s->step.number++;
}

static inline void surface_scene_destroy(surface_scene *s) {
    s->interaction->destroy(s->interaction);
    contact_plugins_close(&s->plugins);
    surface_body_destroy(s->bodies[0]), surface_body_destroy(s->bodies[1]);
}

#endif
