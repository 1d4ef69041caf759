/* node_list.c: arrays of what a contact finder is shown of a body at a list of nodes. */
#include <stdlib.h>

#include "core/memory.h"
#include "core/node_list.h"

void ab_node_list_clear(ab_node_list *l) {
    free(l->position), free(l->mass), free(l->mass_gradient), free(l->area_vector), free(l->density_gradient), free(l->key);
    free(l->near_start), free(l->stencil_start), free(l->near_position), free(l->near_extent), free(l->stencil_dof),
        free(l->stencil_weight);
    *l = (ab_node_list){0};
}

bool ab_node_list_reserve(ab_node_list *l, size_t count, uint32_t needs) {
    if (count >= l->capacity) {
        const size_t n = (2 * count + 64) & ~(size_t)7;
        if (!ab_memory_resize(&l->position, 2 * n, sizeof(double)) || !ab_memory_resize(&l->mass, n, sizeof(double)) ||
            !ab_memory_resize(&l->mass_gradient, 2 * n, sizeof(double)) || !ab_memory_resize(&l->area_vector, 2 * n, sizeof(double)) ||
            !ab_memory_resize(&l->near_start, n + 1, sizeof(size_t)) || !ab_memory_resize(&l->stencil_start, n + 1, sizeof(size_t)) ||
            !ab_memory_resize(&l->key, n, sizeof(uint64_t)))
            return false;
        l->capacity = n;
    }
    if ((needs & AB_NEED_DENSITY_GRADIENT) && l->capacity > l->density_capacity) {
        if (!ab_memory_resize(&l->density_gradient, 2 * l->capacity, sizeof(double))) return false;
        l->density_capacity = l->capacity;
    }
    return true;
}

bool ab_node_list_reserve_near(ab_node_list *l, size_t count) {
    if (count <= l->near_capacity) return true;
    const size_t n = (2 * count + 64) & ~(size_t)7;
    if (!ab_memory_resize(&l->near_position, 2 * n, sizeof(double)) || !ab_memory_resize(&l->near_extent, 3 * n, sizeof(double)))
        return false;
    l->near_capacity = n;
    return true;
}

bool ab_node_list_reserve_stencil(ab_node_list *l, size_t count) {
    if (count <= l->stencil_capacity) return true;
    const size_t n = 2 * count + 256;
    if (!ab_memory_resize(&l->stencil_dof, n, sizeof(uint32_t)) || !ab_memory_resize(&l->stencil_weight, n, sizeof(double))) return false;
    l->stencil_capacity = n;
    return true;
}

ab_trace ab_node_list_show(const ab_node_list *l, size_t count, uint32_t needs) {
    return (ab_trace){
        .struct_size = sizeof(ab_trace),
        .dimension = 2,
        .count = count,
        .ld = l->capacity,
        .position = l->position,
        .stencil_start = l->stencil_start,
        .stencil_dof = l->stencil_dof,
        .stencil_weight = l->stencil_weight,
        .key = l->key,
        .mass = l->mass,
        .mass_gradient = (needs & AB_NEED_MASS_GRADIENT) ? l->mass_gradient : NULL,
        .area_vector = (needs & AB_NEED_AREA_VECTOR) ? l->area_vector : NULL,
        .near_start = (needs & AB_NEED_NEAR_POINTS) ? l->near_start : NULL,
        .near_ld = l->near_capacity,
        .near_position = l->near_position,
        .near_extent = l->near_extent,
        .density_gradient = (needs & AB_NEED_DENSITY_GRADIENT) ? l->density_gradient : NULL,
    };
}
