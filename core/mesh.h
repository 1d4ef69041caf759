/* mesh.h: a mesh of quadrilaterals as it is drawn. fem/ makes it, from boxes, patches and files; main hands it to bodies of other methods that are filled by one. */
#ifndef AB_MESH_H
#define AB_MESH_H

#include <stddef.h>
#include <stdint.h>

typedef struct ab_mesh {
    int nodes; /* per element: 4 or 8; corners counter-clockwise, then the middles of the sides 0-1, 1-2, 2-3, 3-0 */
    size_t node_count, element_count;
    double *x;                      /* 2 a node, m, as drawn */
    uint32_t *connectivity;         /* nodes an element */
    uint64_t *node_id, *element_id; /* as in the file, for messages; NULL: places from 0 */
    double low[2], high[2];         /* bounds of the nodes, m */
} ab_mesh;

#endif
