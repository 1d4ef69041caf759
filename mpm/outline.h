/* outline.h: closed loops along the outline of a material-point body, for its faces. Inside mpm/ only.
 *
 * Face k runs from vertex k to vertex next[k] with the body on its left, so that outer loops are counter-clockwise and holes clockwise. */
#ifndef AB_MPM_OUTLINE_H
#define AB_MPM_OUTLINE_H

#include "mpm/fill.h"

typedef struct mpm_loops {
    size_t count, capacity;
    double *x;       /* 2 a vertex, m */
    uint32_t *next;  /* vertex after it in its loop */
    uint32_t *prior; /* and before it */
    bool *corner;    /* where the outline was drawn with a corner */
    uint32_t *point; /* 2 a vertex: under the outline before it and after it (or twice the same); the fill's number, which is its id */
    double *arm;     /* 2 for each of those, m: from the point to the vertex */
} mpm_loops;

/* Loops from the pieces of outline that a fill leaves, in vertices about `spacing` apart (corners always; smooth stretches evenly, so that the loops enclose the
 * area of the outline to second order). An error where the pieces do not close. */
ab_status mpm_loops_create(const ab_fill *fill, double spacing, const char *body, mpm_loops *loops, ab_report *);
void mpm_loops_clear(mpm_loops *);

/* following[k], of fill->surface_count: the piece of outline that begins where piece k ends. AB_BAD_INPUT: the pieces do not close; AB_FAILED: no memory. */
ab_status mpm_pieces_chain(const ab_fill *fill, uint32_t *following);

/* Divides faces longer than `longest` and drops vertices that are no corners where a face is shorter than `shortest`. */
ab_status mpm_loops_even(mpm_loops *, double shortest, double longest, const char *body, ab_report *);

#endif
