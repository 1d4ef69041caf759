/* surface.c: the outer faces of a body, for finders that look at surfaces. Every node on an outer face is a vertex and may be a point: both stand for themselves. */
#include <math.h>
#include <string.h>

#include "fem/domain.h"

ab_status fem_outer_create(fem_body *body, fem_faces *faces, ab_report *report) {
    const size_t n = faces->node_count;
    fem_outer *o = fem_take(body, 1, sizeof *o);
    body->outer = o;
    if (o) {
        o->faces = faces;
        o->place = fem_take(body, body->nodes, sizeof *o->place);
        o->start = fem_take(body, n + 1, sizeof *o->start);
        o->weight = fem_take(body, n, sizeof *o->weight);
        o->vertex = fem_take(body, 3 * faces->count, sizeof *o->vertex);
        o->beside = fem_take(body, 2 * faces->count, sizeof *o->beside);
        o->vertex_place = fem_take(body, 2 * n, sizeof *o->vertex_place);
        o->area = fem_take(body, n, sizeof *o->area);
        o->key = fem_take(body, n, sizeof *o->key);
        o->point_dof = fem_take(body, n, sizeof *o->point_dof);
        o->point_vertex = fem_take(body, n, sizeof *o->point_vertex);
        o->point_place = fem_take(body, 2 * n, sizeof *o->point_place);
        o->point_area = fem_take(body, n, sizeof *o->point_area);
        o->point_extent = fem_take(body, 3 * n, sizeof *o->point_extent);
    } else
        fem_faces_destroy(faces);
    if (!o || !o->place || !o->start || !o->weight || !o->vertex || !o->beside || !o->vertex_place || !o->area || !o->key ||
        !o->point_dof || !o->point_vertex || !o->point_place || !o->point_area || !o->point_extent)
        return ab_report_failure(report, "body '%s': no memory for %zu outer faces", body->domain.spec->name, faces->count);
    for (size_t i = 0; i < body->nodes; ++i) o->place[i] = FEM_NONE;
    for (size_t k = 0; k < n; ++k) {
        o->place[faces->node[k]] = (uint32_t)k;
        o->start[k] = k;
        o->weight[k] = 1.0;
    }
    o->start[n] = n;
    for (size_t k = 0; k < 3 * faces->count; ++k) o->vertex[k] = faces->vertex[k] == FEM_NONE ? FEM_NONE : o->place[faces->vertex[k]];
    memcpy(o->beside, faces->beside, 2 * faces->count * sizeof *o->beside);
    o->face_count = faces->count;
    if (!body->element->axisymmetric) return AB_OK;
    for (size_t k = 0; k < n; ++k) o->vertex_place[k] = body->x[2 * (size_t)faces->node[k]];
    o->face_count = fem_faces_off_axis(o->vertex_place, 1, body->mesh->high[0] - body->mesh->low[0], faces->count, o->vertex, o->beside);
    if (o->face_count == SIZE_MAX) return ab_report_failure(report, "body '%s': no memory for its outer faces", body->domain.spec->name);
    return AB_OK;
}

void fem_outer_destroy(fem_body *body) {
    if (body->outer) fem_faces_destroy(body->outer->faces);
    body->outer = NULL;
}

ab_status fem_surface_faces(ab_domain *domain, ab_surface *surface, ab_report *report) {
    (void)report;
    fem_body *body = (fem_body *)domain;
    fem_outer *o = body->outer;
    const size_t n = o->faces->node_count;
    for (size_t k = 0; k < n; ++k)
        for (size_t c = 0; c < 2; ++c) o->vertex_place[c * n + k] = body->x[2 * (size_t)o->faces->node[k] + c];
    surface->vertex_count = surface->vertex_ld = n;
    surface->vertex_position = o->vertex_place;
    surface->vertex_start = o->start;
    surface->vertex_dof = o->faces->node;
    surface->vertex_weight = o->weight;
    surface->face_count = o->face_count;
    surface->face_vertex = o->vertex;
    surface->face_beside = o->beside;
    return AB_OK;
}

/* Share of the surface of each outer node, m: half of a straight face for each end; of a quadratic one 1/6, 4/6, 1/6, as a uniform pressure is spread. */
static void share_area(const fem_body *body, fem_outer *o) {
    const fem_faces *faces = o->faces;
    memset(o->area, 0, faces->node_count * sizeof *o->area);
    for (size_t f = 0; f < o->face_count; ++f) {
        const uint32_t *place = o->vertex + 3 * f;
        const double *a = body->x + 2 * (size_t)faces->node[place[0]], *b = body->x + 2 * (size_t)faces->node[place[1]];
        if (place[2] == FEM_NONE) {
            const double half = 0.5 * hypot(b[0] - a[0], b[1] - a[1]);
            o->area[place[0]] += half;
            o->area[place[1]] += half;
        } else {
            const double *m = body->x + 2 * (size_t)faces->node[place[2]],
                         length = hypot(m[0] - a[0], m[1] - a[1]) + hypot(b[0] - m[0], b[1] - m[1]);
            o->area[place[0]] += length / 6.0;
            o->area[place[1]] += length / 6.0;
            o->area[place[2]] += length * 4.0 / 6.0;
        }
    }
}

static bool in_region(const ab_region *region, const double *x) {
    const double i = floor(x[0] / region->cell), j = floor(x[1] / region->cell), far = 1e9;
    if (!(fabs(i) < far && fabs(j) < far)) return false;
    const int32_t ci = (int32_t)i, cj = (int32_t)j, tx = (int32_t)floor(i / AB_TILE), ty = (int32_t)floor(j / AB_TILE);
    const uint64_t key = ab_tile_key(tx, ty);
    size_t low = 0, high = region->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (region->key[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    if (low == region->count || region->key[low] != key) return false;
    return region->cells[low] >> ((cj - ty * AB_TILE) * AB_TILE + ci - tx * AB_TILE) & 1;
}

ab_status fem_surface_points(ab_domain *domain, const ab_region *region, ab_surface *surface, ab_report *report) {
    (void)report;
    fem_body *body = (fem_body *)domain;
    fem_outer *o = body->outer;
    const size_t ld = o->faces->node_count;
    share_area(body, o);
    size_t count = 0;
    for (size_t k = 0; k < ld; ++k) {
        const uint32_t node = o->faces->node[k];
        const double *x = body->x + 2 * (size_t)node;
        if (!(o->area[k] > 0.0) || !in_region(region, x)) continue; /* on the axis, it has no face */
        o->key[count] = (uint64_t)node + 1;
        o->point_dof[count] = node;
        o->point_vertex[count] = (uint32_t)k;
        o->point_place[count] = x[0];
        o->point_place[ld + count] = x[1];
        o->point_area[count++] = o->area[k];
    }
    surface->point_count = count;
    surface->point_ld = ld;
    surface->point_position = o->point_place;
    surface->point_extent = o->point_extent; /* zeros */
    surface->point_area = o->point_area;
    surface->point_key = o->key;
    surface->point_vertex = o->point_vertex;
    surface->point_start = o->start;
    surface->point_dof = o->point_dof;
    surface->point_weight = o->weight;
    return AB_OK;
}
