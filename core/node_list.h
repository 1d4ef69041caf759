/* node_list.h: arrays of what a contact finder is shown of a body at a list of nodes (ab_trace), kept from call to call. */
#ifndef AB_NODE_LIST_H
#define AB_NODE_LIST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "plugins/abut_plugin.h"

typedef struct ab_node_list { /* rows of `capacity` nodes; lists of near points and of stencils one node after the other */
    size_t capacity, density_capacity, near_capacity, stencil_capacity;
    double *position, *mass, *mass_gradient, *area_vector; /* 2, 1, 2, 2 rows */
    double *density_gradient;                              /* 2 rows, where it is needed */
    uint64_t *key;                                         /* ab_tile_key of the node */
    size_t *near_start, *stencil_start;                    /* one more than nodes */
    double *near_position, *near_extent;                   /* 2, 3 rows of near_capacity */
    uint32_t *stencil_dof;
    double *stencil_weight;
} ab_node_list;

void ab_node_list_clear(ab_node_list *);
/* Room for `count` nodes with what `needs` (AB_NEED_...) says; for so many near points; for so many entries of all stencils. False: no memory. */
bool ab_node_list_reserve(ab_node_list *, size_t count, uint32_t needs);
bool ab_node_list_reserve_near(ab_node_list *, size_t count);
bool ab_node_list_reserve_stencil(ab_node_list *, size_t count);
/* As the finder sees it; `body`, `stiffness` (Pa) and `cell` (m) are the caller's to add. */
ab_trace ab_node_list_show(const ab_node_list *, size_t count, uint32_t needs);

#endif
