/* mesh_parts.h: what the makers of meshes share. Inside fem/mesh*.c only. */
#ifndef AB_FEM_MESH_PARTS_H
#define AB_FEM_MESH_PARTS_H

#include "fem/mesh.h"

enum { FEM_MOST_ELEMENTS = 4000000, FEM_MOST_SAID = 10 /* messages of one kind */ };

/* Memory for a mesh; x and connectivity not set, no ids. */
ab_status fem_mesh_allocate(int nodes, size_t node_count, size_t element_count, const char *body, fem_mesh **, ab_report *);

/* Parameters in [0, 1] of the n + 1 corners along one direction; grading: size of the last element over that of the first, sizes in equal ratio. */
void fem_mesh_divide(long n, double grading, double *s);

/* A mesh of elements[0] x elements[1] quadrilaterals, nodes and elements row by row from the bottom, each row from the left. With 8 nodes an element a row of
 * corners also holds the middles of its sides, and between two such rows stands one of the middles of the upright sides. The place of a node is asked by its
 * parameters, that of the middle of a side by the mean of those of its ends. */
typedef void (*fem_mesh_place)(const void *context, double s, double t, double x[2]);
ab_status fem_mesh_lattice(const ab_body_spec *, fem_mesh_place, const void *context, fem_mesh **, ab_report *);

/* For each side of each element (4*element + side) the side of the other element that it is joined to, or FEM_NONE: outside. To be freed. Mistakes: a side of three
 * elements, two that run the same way (elements that lie on each other), another node in the middle. */
ab_status fem_sides_join(const fem_mesh *, const char *body, ab_mark, uint32_t **mate, ab_report *);

/* Elements that cover the same place without sharing sides: an error where more than a tenth of an element lies on another, else a warning; both say how much area.
 * The mesh has its bounds, joined sides and no folded element. n log n. */
ab_status fem_mesh_overlaps(const fem_mesh *, const char *body, ab_mark, const char *file, ab_report *);

/* The smallest det J of an element over its Gauss points and corners, over that of a square of the same area; 0 or less: folded or inverted. */
double fem_mesh_jacobian(const fem_mesh *, ab_element_type, size_t element);

static inline unsigned long long fem_element_id(const fem_mesh *mesh, size_t e) {
    return mesh->element_id != NULL ? mesh->element_id[e] : e;
}
static inline unsigned long long fem_node_id(const fem_mesh *mesh, size_t i) { return mesh->node_id != NULL ? mesh->node_id[i] : i; }

ab_status fem_mesh_box(const ab_body_spec *, fem_mesh **, ab_report *);
ab_status fem_mesh_patch(const ab_body_spec *, fem_mesh **, ab_report *);
ab_status fem_mesh_gmsh(const ab_body_spec *, const char *folder, fem_mesh **, ab_report *);

#endif
