/* rigid_surface.c: what contact finders see of a rigid body: its faces, the places that may touch others, its trace on the grid. All of it hangs on one dof. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/rigid.h"

static const double POINTS_EVERY = 0.5,
                    LAYER = 4.0; /* cells: a node that another body reaches, and all cells round it, are not deeper inside */

static bool wants_trace(const rigid_body *body) {
    static const uint32_t NODES = AB_NEED_SHARED_NODES | AB_NEED_MASS_GRADIENT | AB_NEED_AREA_VECTOR | AB_NEED_NEAR_POINTS;
    const ab_scene *scene = body->scene;
    for (size_t k = 0; k < scene->contact_count; ++k) {
        const ab_contact_spec *contact = scene->contacts + k;
        if (contact->body[0] != body->domain.index && contact->body[1] != body->domain.index) continue;
        if (contact->finder->class_.needs & NODES) return true;
    }
    return false;
}

static bool inner_create(rigid_body *body, double cell) {
    const double depth = (LAYER + 2.0 * (fem_trace_reach(body->trace) - 1.0)) * cell; /* points and nodes reach further on splines */
    if (!rigid_layer_create(&body->outline, POINTS_EVERY * cell, depth, &body->layer)) return false;
    const size_t count = body->layer.count;
    fem_inner *in = &body->inner;
    in->count = in->ld = count;
    in->position = rigid_take(body, 2 * count, sizeof(double));
    in->mass = rigid_take(body, count, sizeof(double));
    in->volume = body->layer.volume;
    in->extent = rigid_take(body, 3 * count, sizeof(double));
    in->start = body->counting;
    in->dof = body->zeros;
    in->weight = body->ones;
    if (!in->position || !in->mass || !in->extent) return false;
    for (size_t q = 0; q < count; ++q) {
        in->mass[q] = body->mass_density * in->volume[q];
        if (body->scene->space == AB_SPACE_AXISYMMETRIC) in->mass[q] *= ab_circumference(body->outline.centre[0] + body->layer.place[q][0]);
    }
    body->bytes += body->layer.capacity * 6 * sizeof(double);
    return true;
}

ab_status rigid_surface_create(rigid_body *body, ab_report *report) {
    const rigid_outline *o = &body->outline;
    const bool traced = wants_trace(body);
    if (traced) {
        AB_TRY(fem_trace_create(body->scene, body->domain.spec->name, INFINITY, &body->trace, report));
        if (!inner_create(body, body->scene->grid_cell)) goto no_memory;
    }
    size_t most = o->point_count > o->vertex_count ? o->point_count : o->vertex_count;
    if (body->layer.count > most) most = body->layer.count;
    body->vertex_place = rigid_take(body, 2 * o->vertex_count, sizeof(double));
    body->point_place = rigid_take(body, 2 * o->point_count, sizeof(double));
    body->point_area = rigid_take(body, o->point_count, sizeof(double));
    body->point_extent = rigid_take(body, 3 * o->point_count, sizeof(double));
    body->point_vertex = rigid_take(body, o->point_count, sizeof *body->point_vertex);
    body->key = rigid_take(body, o->point_count, sizeof *body->key);
    body->face = rigid_take(body, 3 * o->face_count, sizeof *body->face);
    body->beside = rigid_take(body, 2 * o->face_count, sizeof *body->beside);
    body->ones = rigid_take(body, most, sizeof *body->ones);
    body->zeros = rigid_take(body, most, sizeof *body->zeros);
    body->counting = rigid_take(body, most + 1, sizeof *body->counting);
    if (!body->vertex_place || !body->point_place || !body->point_area || !body->point_extent || !body->point_vertex || !body->key ||
        !body->ones || !body->zeros || !body->counting || !body->face || !body->beside)
        goto no_memory;
    memcpy(body->face, o->face, 3 * o->face_count * sizeof *body->face);
    memcpy(body->beside, o->beside, 2 * o->face_count * sizeof *body->beside);
    body->face_count = o->face_count;
    if (body->scene->space == AB_SPACE_AXISYMMETRIC) {
        double size = 0.0;
        for (size_t k = 0; k < o->vertex_count; ++k) size = fmax(size, o->vertex[k][0]);
        body->face_count = fem_faces_off_axis(o->vertex[0], 2, size, o->face_count, body->face, body->beside);
        if (body->face_count == SIZE_MAX) goto no_memory;
    }
    for (size_t k = 0; k < most; ++k) body->ones[k] = 1.0;
    for (size_t k = 0; k <= most; ++k) body->counting[k] = k;
    body->inner.start = body->counting;
    body->inner.dof = body->zeros;
    body->inner.weight = body->ones;
    body->moved = true;
    return rigid_surface_follow(body, report);
no_memory:
    return ab_report_failure(report, "no memory for the surface of body '%s'", body->domain.spec->name);
}

void rigid_surface_destroy(rigid_body *body) {
    free(body->vertex_place), free(body->point_place), free(body->point_area), free(body->point_extent), free(body->point_vertex);
    free(body->face), free(body->beside), free(body->key), free(body->ones), free(body->zeros), free(body->counting);
    free(body->inner.position), free(body->inner.mass), free(body->inner.extent);
    rigid_layer_clear(&body->layer);
    fem_trace_destroy(body->trace);
}

static void follow_inner(rigid_body *body) {
    const rigid_layer *l = &body->layer;
    fem_inner *in = &body->inner;
    const double c = body->cosine, s = body->sine;
#pragma omp parallel for schedule(static) if (l->count >= 8000)
    for (size_t q = 0; q < l->count; ++q) {
        const double *e = l->extent[q];
        double x[2];
        rigid_turn(body, l->place[q], x);
        for (size_t d = 0; d < 2; ++d) in->position[d * in->ld + q] = body->centre[d] + x[d];
        in->extent[q] = c * c * e[0] + s * s * e[1] - 2.0 * c * s * e[2];
        in->extent[in->ld + q] = s * s * e[0] + c * c * e[1] + 2.0 * c * s * e[2];
        in->extent[2 * in->ld + q] = c * s * (e[0] - e[1]) + (c * c - s * s) * e[2];
    }
}

ab_status rigid_surface_follow(rigid_body *body, ab_report *report) {
    if (!body->moved) return AB_OK;
    const rigid_outline *o = &body->outline;
    for (size_t k = 0; k < o->vertex_count; ++k) {
        double x[2];
        rigid_place(body, o->vertex[k], x);
        for (size_t c = 0; c < 2; ++c) body->vertex_place[c * o->vertex_count + k] = x[c];
    }
    if (body->trace) {
        follow_inner(body);
        AB_TRY(fem_trace_update(body->trace, &body->inner, report));
    }
    body->moved = false;
    return AB_OK;
}

ab_status rigid_faces(ab_domain *domain, ab_surface *surface, ab_report *report) {
    (void)report;
    rigid_body *body = (rigid_body *)domain;
    const rigid_outline *o = &body->outline;
    surface->vertex_count = surface->vertex_ld = o->vertex_count;
    surface->vertex_position = body->vertex_place;
    surface->vertex_start = body->counting;
    surface->vertex_dof = body->zeros;
    surface->vertex_weight = body->ones;
    surface->face_count = body->face_count;
    surface->face_vertex = body->face;
    surface->face_beside = body->beside;
    return AB_OK;
}

static bool in_region(const ab_region *region, const double x[2]) {
    const double u = floor(x[0] / region->cell), v = floor(x[1] / region->cell);
    if (!(fabs(u) < 0x20000000 && fabs(v) < 0x20000000)) return false;
    const int32_t i = (int32_t)u, j = (int32_t)v;
    const int32_t tx = (i >= 0 ? i : i - (AB_TILE - 1)) / AB_TILE, ty = (j >= 0 ? j : j - (AB_TILE - 1)) / AB_TILE;
    const uint64_t key = ab_tile_key(tx, ty);
    size_t low = 0, high = region->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (region->key[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low < region->count && region->key[low] == key && (region->cells[low] >> ((j - ty * AB_TILE) * AB_TILE + i - tx * AB_TILE) & 1);
}

ab_status rigid_surface_points(ab_domain *domain, const ab_region *region, ab_surface *surface, ab_report *report) {
    (void)report;
    rigid_body *body = (rigid_body *)domain;
    const rigid_outline *o = &body->outline;
    size_t n = 0;
    for (size_t k = 0; k < o->point_count; ++k) {
        double x[2];
        rigid_place(body, o->point[k], x);
        if (!in_region(region, x)) continue;
        for (size_t c = 0; c < 2; ++c) body->point_place[c * o->point_count + n] = x[c];
        body->point_area[n] = o->point_area[k];
        body->point_vertex[n] = o->point_vertex[k];
        body->key[n++] = k;
    }
    surface->point_count = n;
    surface->point_ld = o->point_count;
    surface->point_position = body->point_place;
    surface->point_extent = body->point_extent; /* zeros */
    surface->point_area = body->point_area;
    surface->point_vertex = body->point_vertex;
    surface->point_key = body->key;
    surface->point_start = body->counting;
    surface->point_dof = body->zeros;
    surface->point_weight = body->ones;
    return AB_OK;
}

ab_status rigid_trace(ab_domain *domain, const uint32_t *nodes, size_t count, uint32_t needs, ab_trace *trace, ab_report *report) {
    rigid_body *body = (rigid_body *)domain;
    return fem_trace_nodes(body->trace, &body->inner, nodes, count, needs, trace, report);
}

void rigid_node_tiles(const ab_domain *domain, ab_node_tiles *tiles) {
    const rigid_body *body = (const rigid_body *)domain;
    *tiles = (ab_node_tiles){.stride = 1};
    if (body->trace) fem_trace_tiles(body->trace, tiles);
}
