/* mesh_gmsh.h: a Gmsh file as libgmsh reads it, before any check. Inside fem/mesh_gmsh*.c only. */
#ifndef AB_FEM_MESH_GMSH_H
#define AB_FEM_MESH_GMSH_H

#include <stdint.h>

#include "core/report.h"
#include "fem/mesh.h"

typedef struct fem_gmsh_block { /* elements of one type */
    uint64_t type, dimension, nodes, count;
    const uint64_t *id, *node; /* count; nodes an element, ids */
} fem_gmsh_block;

enum { FEM_GMSH_BLOCKS = 64, FEM_GMSH_TEXT = 400 };

typedef struct fem_gmsh_file {
    size_t node_count, block_count;
    const uint64_t *node_id;
    const double *x; /* 3 a node */
    fem_gmsh_block block[FEM_GMSH_BLOCKS];
    char *bytes; /* that all of this lies in */
} fem_gmsh_file;

/* Reads the elements of dimension 2 and 3 and all nodes. Mistakes stand at `mark` and name the body and the file. */
ab_status fem_gmsh_read(const char *path, const char *body, ab_mark mark, fem_gmsh_file *file, ab_report *report);
/* Finds the lists in a stream of `count` bytes, at a place for 8-byte numbers; file->bytes is left to the caller. 1: read; 0: refused, with `text`; -1: the stream
 * ends too early. */
int fem_gmsh_take(const char *bytes, size_t count, fem_gmsh_file *file, char text[FEM_GMSH_TEXT]);
/* The mesh of a body from the contents of its file, every mistake with the ids of the file; `path` is for messages. */
ab_status fem_gmsh_mesh(const ab_body_spec *spec, const char *path, const fem_gmsh_file *file, fem_mesh **mesh, ab_report *report);
void fem_gmsh_forget(fem_gmsh_file *file);

#endif
