/* trace_nodes.c: what a contact finder sees of a body's inner points at the nodes it asks for. */
#include <math.h>
#include <string.h>

#include "core/density.h"
#include "fem/trace_inside.h"

/* Slope of the density at a node (core/density.h), from the points in the sixteen cells that reach it: 2 numbers. Of a body whose points are a layer along its outline it is
 * right where the layer is two cells deep below the node. */
static void density_gradient(const fem_trace *t, const fem_inner *inner, uint32_t node, const double at[2], double slope[2]) {
    const uint32_t home = node / AB_TILE_NODES;
    const int i = (int)(node % AB_TILE), j = (int)(node % AB_TILE_NODES) / AB_TILE;
    const double *x = inner->position, *y = x + inner->ld;
    slope[0] = slope[1] = 0.0;
    for (int c = 0; c < 16; ++c) {
        const int ci = i - 2 + c % 4, cj = j - 2 + c / 4, dx = ci < 0 ? -1 : ci / AB_TILE, dy = cj < 0 ? -1 : cj / AB_TILE;
        const int32_t k = dx || dy ? t->tiles[home].around[(dy + 1) * 3 + dx + 1] : (int32_t)home;
        if (k < 0) continue;
        const uint32_t *start = t->cell_start + (size_t)k * AB_TILE_NODES + (cj - dy * AB_TILE) * AB_TILE + ci - dx * AB_TILE;
        for (uint32_t s = start[0]; s < start[1]; ++s) {
            const uint32_t q = t->order[s];
            double difference[2], mean[2];
            ab_density_pair((x[q] - at[0]) * t->inverse_h, &difference[0], &mean[0]);
            ab_density_pair((y[q] - at[1]) * t->inverse_h, &difference[1], &mean[1]);
            const double mass = t->axisymmetric ? inner->mass[q] / ab_circumference(x[q]) : inner->mass[q];
            slope[0] += mass * difference[0] * mean[1];
            slope[1] += mass * mean[0] * difference[1];
        }
    }
    for (int d = 0; d < 2; ++d) slope[d] *= t->inverse_h * t->inverse_h * t->inverse_h;
    if (t->axisymmetric && !(at[0] > 0.0)) slope[0] = 0.0;
}

static bool reserve(fem_trace *t, const uint32_t *nodes, size_t count, uint32_t needs) {
    if (!ab_node_list_reserve(&t->list, count, needs)) return false;
    if (!(needs & AB_NEED_NEAR_POINTS)) return true;
    size_t near = 0;
    for (size_t k = 0; k < count; ++k) {
        uint32_t first[16], last[16];
        const int cells = fem_trace_cells_around(t, nodes[k], first, last);
        for (int c = 0; c < cells; ++c) near += last[c] - first[c];
    }
    return ab_node_list_reserve_near(&t->list, near);
}

/* Adds `share` to the weight of a dof in the stencil that begins at `begin` and ends at *end. */
static bool add_weight(fem_trace *t, size_t begin, size_t *end, uint32_t dof, double share) {
    if (dof >= t->place_capacity) {
        const size_t n = 2 * (size_t)dof + 64;
        if (!ab_memory_resize(&t->place, n, sizeof *t->place)) return false;
        memset(t->place + t->place_capacity, 0, (n - t->place_capacity) * sizeof *t->place);
        t->place_capacity = n;
    }
    const size_t at = t->place[dof];
    if (at >= begin && at < *end && t->list.stencil_dof[at] == dof) {
        t->list.stencil_weight[at] += share;
        return true;
    }
    if (!ab_node_list_reserve_stencil(&t->list, *end + 1)) return false;
    t->place[dof] = *end;
    t->list.stencil_dof[*end] = dof;
    t->list.stencil_weight[(*end)++] = share;
    return true;
}

/* Sums over the points around node k of the list. *stencil, *near: ends of both lists so far. */
static bool look_around(fem_trace *t, const fem_inner *inner, uint32_t node, size_t k, uint32_t needs, size_t *stencil, size_t *near) {
    const size_t ld = t->list.capacity, begin = *stencil;
    const double *x = inner->position, *y = x + inner->ld;
    const double at[2] = {t->list.position[k], t->list.position[ld + k]};
    double gradient[2] = {0.0}, area[2] = {0.0}, mass = 0.0;
    uint32_t first[16], last[16];
    const int cells = fem_trace_cells_around(t, node, first, last);
    const bool wide = t->width > 2;
    for (int c = 0; c < cells; ++c) {
        const double slope[2] = {c % 2 ? -t->inverse_h : t->inverse_h, c / 2 ? -t->inverse_h : t->inverse_h};
        for (uint32_t s = first[c]; s < last[c]; ++s) {
            const uint32_t q = t->order[s];
            double nx, ny, sx = slope[0], sy = slope[1];
            if (wide) {
                fem_trace_weigh(t, (x[q] - at[0]) * t->inverse_h, &nx, &sx), sx *= t->inverse_h;
                fem_trace_weigh(t, (y[q] - at[1]) * t->inverse_h, &ny, &sy), sy *= t->inverse_h;
            } else {
                nx = ab_larger(1.0 - fabs(x[q] - at[0]) * t->inverse_h, 0.0);
                ny = ab_larger(1.0 - fabs(y[q] - at[1]) * t->inverse_h, 0.0);
            }
            const double m = inner->mass[q], v = inner->volume[q], gx = sx * ny, gy = sy * nx, value = nx * ny;
            const double plane = t->axisymmetric ? m / ab_circumference(x[q]) : m; /* normals are those of the plane that is drawn */
            gradient[0] += plane * gx;
            gradient[1] += plane * gy;
            area[0] += v * gx;
            area[1] += v * gy;
            if (!(value > 0.0)) continue;
            mass += value * m;
            if (inner->inmost && inner->inmost[q]) t->saw_inmost = true;
            for (size_t e = inner->start[q]; e < inner->start[q + 1]; ++e)
                if (!add_weight(t, begin, stencil, inner->dof[e], value * m * inner->weight[e])) return false;
            if (!(needs & AB_NEED_NEAR_POINTS)) continue;
            t->list.near_position[*near] = x[q];
            t->list.near_position[t->list.near_capacity + *near] = y[q];
            for (size_t r = 0; r < 3; ++r) t->list.near_extent[r * t->list.near_capacity + *near] = inner->extent[r * inner->ld + q];
            ++*near;
        }
    }
    for (size_t e = begin; e < *stencil; ++e) t->list.stencil_weight[e] /= mass;
    if (t->axisymmetric && !(at[0] > 0.0)) gradient[0] = area[0] = 0.0; /* the other side of the axis is alike */
    for (size_t d = 0; d < 2; ++d) {
        t->list.mass_gradient[d * ld + k] = gradient[d];
        t->list.area_vector[d * ld + k] = area[d];
    }
    return true;
}

ab_status fem_trace_nodes(fem_trace *t, const fem_inner *inner, const uint32_t *nodes, size_t count, uint32_t needs, ab_trace *trace,
                          ab_report *report) {
    if (!reserve(t, nodes, count, needs)) goto no_memory;
    const size_t ld = t->list.capacity;
    size_t stencil = 0, near = 0;
    for (size_t k = 0; k < count; ++k) {
        const uint64_t tile_key = t->key[nodes[k] / AB_TILE_NODES];
        const int32_t n = (int32_t)(nodes[k] % AB_TILE_NODES), i = ab_tile_x(tile_key) * AB_TILE + n % AB_TILE,
                      j = ab_tile_y(tile_key) * AB_TILE + n / AB_TILE;
        t->list.position[k] = t->h * i;
        t->list.position[ld + k] = t->h * j;
        t->list.mass[k] = t->mass[nodes[k]];
        t->list.key[k] = ab_tile_key(i, j);
        t->list.stencil_start[k] = stencil;
        t->list.near_start[k] = near;
        if (!look_around(t, inner, nodes[k], k, needs, &stencil, &near)) goto no_memory;
        if (needs & AB_NEED_DENSITY_GRADIENT) {
            double slope[2];
            density_gradient(t, inner, nodes[k], (const double[2]){t->list.position[k], t->list.position[ld + k]}, slope);
            for (size_t d = 0; d < 2; ++d) t->list.density_gradient[d * ld + k] = slope[d];
        }
    }
    t->list.stencil_start[count] = stencil;
    t->list.near_start[count] = near;
    *trace = ab_node_list_show(&t->list, count, needs);
    trace->body = t->body, trace->stiffness = t->modulus, trace->cell = t->h;
    return AB_OK;
no_memory:
    return ab_report_failure(report, "body '%s': no memory for %zu nodes in contact", t->body, count);
}
