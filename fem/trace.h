/* trace.h: how a body that has no points on the grid of its own is seen there: through points inside it that carry its mass (numerics: trace of a finite-element
 * body). Node i has mass m_i = sum_q N_i(x_q) m_q and velocity sum_k w_ik v_k, w_ik = sum_q N_i(x_q) m_q phi_k(x_q)/m_i. Inside fem/ only; used by
 * finite-element and rigid bodies alike. */
#ifndef AB_FEM_TRACE_H
#define AB_FEM_TRACE_H

#include "core/domain.h"

typedef struct fem_trace fem_trace;

typedef struct
    fem_inner { /* points inside a body: where they are now, what they carry and on which dofs they hang; the body keeps them up to date */
    size_t count, ld;
    double *position; /* 2 rows of ld, m from the grid's corner */
    double *mass, *volume;
    double *extent; /* 3 rows of ld (xx, yy, xy), m2: r1 r1^T + r2 r2^T of the half edges of the point's parallelogram */
    size_t *start;  /* count + 1 */
    uint32_t *dof;
    double *weight;
    uint8_t *inmost; /* 1: beyond this point there may be parts of the body without points. NULL: nowhere */
} fem_inner;

ab_status fem_trace_create(const ab_scene *, const char *body, double modulus, fem_trace **, ab_report *);
void fem_trace_destroy(fem_trace *);
/* Cells: farther away in some direction a node gets nothing of a point. 1, or what the splines of bodies that may be touched reach. */
double fem_trace_reach(const fem_trace *);
/* Masses on the grid of the points as they stand now: once a step, before node_tiles. Tiles are listed anew only when a point has left its cell for a tile that is
 * not listed. */
ab_status fem_trace_update(fem_trace *, const fem_inner *, ab_report *);
void fem_trace_tiles(const fem_trace *, ab_node_tiles *);
ab_status fem_trace_nodes(fem_trace *, const fem_inner *, const uint32_t *nodes, size_t count, uint32_t needs, ab_trace *, ab_report *);
/* True where a node that was asked for since the last update has got mass from an inmost point. */
bool fem_trace_saw_inmost(const fem_trace *);
void fem_trace_note_inmost(fem_trace *, bool saw); /* as it was when a checkpoint was written */

#endif
