/* outline.h: closed loops along the outline of a material-point body, for its faces. Inside mpm/ only.
 *
 * Face k runs from vertex k to vertex next[k] with the body on its left, so that outer loops are counter-clockwise and holes clockwise. */
#ifndef AB_MPM_OUTLINE_H
#define AB_MPM_OUTLINE_H

#include "mpm/body.h"

typedef struct mpm_loops {
    size_t count, capacity;
    double *x;       /* 2 a vertex, m */
    uint32_t *next;  /* vertex after it in its loop */
    uint32_t *prior; /* and before it */
    bool *corner;    /* where the outline was drawn with a corner */
    uint32_t *point; /* 2 a vertex: under the outline before it and after it (or twice the same); the fill's number, which is its id */
    double *arm;     /* 2 for each of those, m: from the point to the vertex */
    double *slip;    /* 2 a vertex, m: how far it went in the last step beyond the mean of those points */
} mpm_loops;

struct mpm_outline {
    mpm_loops loops;
    struct mpm_touching *touching; /* vertices that touch other bodies in place of the points' domains (surface: points); else NULL */
    size_t capacity, ld;
    double *position;    /* rows of ld */
    size_t *start, room; /* room: in dof and weight */
    uint32_t *dof;
    double *weight;
    uint32_t *vertex, *beside; /* of the faces */
};

/* surface_points.c: vertices that touch. Each is a fixed combination of the material points around it, x = sum a x_p with sum a = 1, and so are its velocity and what
 * it is pushed by. */
ab_status mpm_touching_create(mpm_body *, const ab_fill *, ab_report *);
/* Where the vertices are now, into loops.x; false: all that one of them hung on has left. stencils: and what mpm_touching_stencil needs. */
bool mpm_touching_place(mpm_body *, bool stencils);
/* Nodes and weights of vertex k, after mpm_touching_place: they add up to 1 and their centre is the vertex. Their number, mpm_touching_most_nodes() at most; 0: what
 * it hung on is torn apart. */
size_t mpm_touching_stencil(const mpm_body *, size_t k, uint32_t *dof, double *weight);
size_t mpm_touching_most_nodes(void);
ab_status mpm_touching_points(mpm_body *, const ab_region *, ab_surface *, ab_report *); /* after mpm_faces */
void mpm_touching_destroy(struct mpm_touching *);
size_t mpm_touching_bytes(const struct mpm_touching *);

/* trace_outline.c: pieces of the outline between vertices that touch, near nodes. */
typedef struct mpm_near_piece {
    uint32_t node;    /* number among the nodes asked for */
    double x[2];      /* m, its middle */
    double extent[3]; /* m2: xx, yy, xy of s s^T, s from there to its end */
} mpm_near_piece;
typedef struct mpm_near_pieces {
    size_t count, room;
    mpm_near_piece *list;
} mpm_near_pieces;
/* The pieces within reach of the body's basis of each node, `nodes` ascending, in the order of the outline. False: no memory. */
bool mpm_pieces_near(mpm_body *, const uint32_t *nodes, size_t count, mpm_near_pieces *);

/* Loops from the pieces of outline that a fill leaves, in vertices about `spacing` apart (corners always; smooth stretches evenly). lifted: those of
 * smooth stretches stand a little outside, so that the loops enclose the area of the outline to second order; else on the outline. An error where the pieces do not close. */
ab_status mpm_loops_create(const ab_fill *fill, double spacing, bool lifted, const char *body, mpm_loops *loops, ab_report *);
bool mpm_loops_reserve(mpm_loops *, size_t count); /* room; false: no memory */
void mpm_loops_clear(mpm_loops *);

/* following[k], of fill->surface_count: the piece of outline that begins where piece k ends. AB_BAD_INPUT: the pieces do not close; AB_FAILED: no memory. */
ab_status mpm_pieces_chain(const ab_fill *fill, uint32_t *following);

/* Divides faces longer than `longest` and drops vertices that are no corners where a face is shorter than `shortest`. */
ab_status mpm_loops_even(mpm_loops *, double shortest, double longest, const char *body, ab_report *);

#endif
