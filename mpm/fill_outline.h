/* fill_outline.h: an outline of straight edges, and its cells: what a lattice laid over it cuts it into. Inside the fill only. */
#ifndef AB_FILL_OUTLINE_H
#define AB_FILL_OUTLINE_H

#include "mpm/fill_parts.h"

typedef struct ab_edge {
    double from[2], to[2];
} ab_edge;

/* Closed chains of edges with the body on their left: outer ones counter-clockwise, holes clockwise; order within a chain kept. */
typedef struct ab_outline {
    ab_edge *edge;
    size_t count;
    bool convex;
    double area; /* m2 */
} ab_outline;

/* The outline of a polygon shape, either way round, after all checks: three vertices, none repeated, no edges that touch or cross. */
ab_status ab_outline_create(const ab_shape_spec *shape, ab_outline *outline, const char *body, ab_report *report);
void ab_outline_clear(ab_outline *outline);

/* Directions of the lattice: u along (c, s), v across, origin in the middle of the outline's bounding box. */
typedef struct ab_frame {
    double origin[2], c, s;
} ab_frame;

/* Along the longest edge; of several equally long ones the one nearest to an axis; where two of those lie mirrored, along the axes. So the
 * lattice of a mirrored outline, or one turned by a quarter, is the lattice mirrored or turned. */
ab_frame ab_outline_frame(const ab_outline *outline);

static inline void ab_frame_in(const ab_frame *f, const double x[2], double u[2]) {
    const double a = x[0] - f->origin[0], b = x[1] - f->origin[1];
    u[0] = f->c * a + f->s * b;
    u[1] = f->c * b - f->s * a;
}

static inline void ab_frame_out(const ab_frame *f, const double u[2], double x[2]) {
    x[0] = f->origin[0] + (f->c * u[0] - f->s * u[1]);
    x[1] = f->origin[1] + (f->s * u[0] + f->c * u[1]);
}

/* Lines of the lattice in one direction: line[0] < .. < line[count]; `count` cells. With parts > 1 every cell of size about `size` is
 * divided into so many; cells of the undivided lattice are then numbered index / parts. */
typedef struct ab_lines {
    double *line;
    uint32_t count;
} ab_lines;

/* Lines that stand on every straight side that runs along them: evenly spaced where one spacing within 15 % of `size` fits all of those sides,
 * else evenly between each two. edge: in the frame; direction: 0 for lines u = const. */
ab_status ab_lines_create(const ab_edge *edge, size_t count, int direction, double size, uint32_t parts, ab_lines *lines,
                          ab_filler *filler);
uint32_t ab_lines_find(const ab_lines *lines, double place); /* the cell that holds it; the nearest one outside */

/* Moments of the part of a cell that the body fills, about the middle of the cell. */
typedef struct ab_moments {
    double area, u, v, uu, uv, vv;
} ab_moments;

typedef struct ab_cell { /* one that the outline runs through, or a neighbour of such a one */
    uint32_t i, j;
    uint32_t root;   /* the cell that it is merged into, itself unless it is a sliver */
    uint32_t pieces; /* of outline in it */
    ab_moments moments;
    double cover[3], across; /* sums over its pieces: -dv {1, v, v^2}, du */
    double left, bottom;     /* m, lengths of these sides that lie in the body */
    bool full;               /* and nothing merged into it */
    bool inside_after;       /* cells to its right, up to the next one listed, are full (else empty) */
} ab_cell;

typedef struct ab_cut {
    uint32_t edge, cell;
    double a[2], b[2];
} ab_cut; /* a piece of an edge in one cell; in order along the outline */

typedef struct ab_cells {
    ab_lines lines[2];
    ab_cell *cell; /* ordered by row j, then column i */
    size_t count;
    size_t *row; /* first cell of each row; lines[1].count + 1 */
    ab_cut *cut;
    size_t cut_count;
    size_t *cut_row; /* pieces by row: those of row j are cut[cut_of_row[cut_row[j]]] .. */
    uint32_t *cut_of_row;
} ab_cells;

/* Cuts the outline (edges in the frame, nudged onto lines that they all but touch) by the lattice. Exact for any outline, in time
 * proportional to its pieces. Takes over lines. */
ab_status ab_cells_create(ab_edge *edge, size_t count, ab_lines lines[2], ab_cells *cells, ab_filler *filler);
void ab_cells_clear(ab_cells *cells);
ab_cell *ab_cells_find(const ab_cells *cells, uint32_t i, uint32_t j); /* NULL where it is not listed: full or empty */

/* Joins every cell filled to less than 0.3 to the neighbour it shares the longest side with. */
ab_status ab_cells_merge(ab_cells *cells, ab_filler *filler);
uint32_t ab_cells_root(const ab_cells *cells, uint32_t cell);

/* Whether a place (in the frame) lies in the body; and the middle of the longest stretch of the body in a cell near height v. */
bool ab_cells_inside(const ab_cells *cells, const double u[2]);
bool ab_cells_place_inside(const ab_cells *cells, const ab_cell *cell, double u[2]);

/* Fills an outline. */
ab_status ab_fill_outline(ab_filler *filler, ab_mark mark, const ab_outline *outline);

/* Fits the extents of the points under pieces from `first_piece` on: half size = distance to the outline, as closely as the pieces allow. */
ab_status ab_fill_fit_extents(ab_filler *filler, size_t first_piece);

#endif
