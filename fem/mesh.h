/* mesh.h: a mesh of quadrilaterals as it is drawn: boxes by rule, patches between four edges, Gmsh files. Inside fem/ only. */
#ifndef AB_FEM_MESH_H
#define AB_FEM_MESH_H

#include "core/mesh.h"
#include "core/scene.h"

typedef ab_mesh fem_mesh;

/* The mesh of a body with spec->mesh, checked: no orphan nodes, no inverted or duplicate element, positive det J at all Gauss points. Mistakes name the place in
 * the scene or the ids of the file, all at once. `folder`: of the scene, for files. */
ab_status fem_mesh_create(const ab_body_spec *spec, const char *folder, fem_mesh **mesh, ab_report *);
/* The same, from the folder of the scene's own file. */
ab_status fem_mesh_read(const ab_scene *scene, const ab_body_spec *spec, fem_mesh **mesh, ab_report *);
void fem_mesh_destroy(fem_mesh *);

static const uint32_t FEM_NONE = UINT32_MAX;

/* The outer faces of a mesh, from its connectivity: sides that belong to one element, in the order of elements and sides. Going from vertex 0 to vertex 1 the body
 * is on the left, so outlines go counter-clockwise and holes clockwise. Where two parts of the body touch in one node only, the chains of `beside` do not change
 * from one part to the other: the next face is found by turning about the node through elements that share sides. */
typedef struct fem_faces {
    size_t count;
    uint32_t *vertex;  /* 3 a face: first, last, middle node (FEM_NONE: linear) */
    uint32_t *beside;  /* 2 a face: the face that ends at its first vertex, the one that begins at its last */
    uint32_t *element; /* that the face belongs to */
    uint8_t *side;     /* of it: 0..3 */
    size_t node_count;
    uint32_t *node;  /* nodes on outer faces, ascending */
    uint32_t *start; /* node_count + 1: the faces of the k-th of them, corners and middles alike: face[start[k]] .. */
    uint32_t *face;
} fem_faces;

ab_status fem_faces_create(const fem_mesh *, const char *body, fem_faces **faces, ab_report *);
void fem_faces_destroy(fem_faces *);
/* Takes out of a list of faces (3 vertices, 2 neighbours each, as above) those with both ends on the axis x = 0, within 1e-9 of `size`, m; the faces beside them then end
 * there. radius: of vertex v at radius[stride*v], m. Returns how many are left; SIZE_MAX: no memory. */
size_t fem_faces_off_axis(const double *radius, size_t stride, double size, size_t count, uint32_t *face, uint32_t *beside);

/* True where a place of the initial mesh is in the set. `side` means an outer face whose outward normal (of its chord) points that way by less than 45 degrees; slack of
 * places 1e-9 of the mesh's size. A node belongs to a side when one of its faces does. */
bool fem_where_node(const ab_where *, const fem_mesh *, const fem_faces *, uint32_t node);
bool fem_where_face(const ab_where *, const fem_mesh *, const fem_faces *, size_t face); /* both ends in the set */

#endif
