/* boundary.h: boundary plugins at work: one instance for each entry of the scene, the edges it acts on, what it says of them, and how that reaches the nodes.
 *
 * A traction t on an edge of area A is the impulse j = dt A t, spread to the dofs of the edge by its weights. A class that gives damping has its traction taken at the mean
 * velocity of the step: j = dt A (t - D (v_new - v_old)/2), where v_new has the impulses of all edges in it: a small coupled system along the outline, solved by
 * Gauss-Seidel in the order of the list until velocities stand still. So a dashpot takes energy from any node, however light, at any step. What a class prescribes is held
 * by the impulses that it takes. */
#ifndef AB_BOUNDARY_H
#define AB_BOUNDARY_H

#include "core/results.h"

typedef struct ab_boundaries ab_boundaries;

/* For scenes that have some. Creates the instances; a body without edges, a class that refuses its settings: AB_BAD_INPUT. */
ab_status ab_boundaries_create(const ab_scene *, ab_domain **, ab_boundaries **, ab_report *);
void ab_boundaries_destroy(ab_boundaries *);

/* Asks the plugins and changes the trial velocities of all bodies: after trial, before contact. */
ab_status ab_boundaries_apply(ab_boundaries *, const ab_step *, ab_report *);
/* Prescribed velocities again, after others (contact) have changed velocities; these impulses count as the boundary's, too. */
void ab_boundaries_hold(ab_boundaries *, const ab_step *);
/* After the bodies have taken their final velocities (finish): displacements of edges, forces; work on bodies that do not map velocities back. */
void ab_boundaries_settle(ab_boundaries *, const ab_step *);
/* After velocities were mapped back: work on bodies that do; prescribed velocities again, for the strain alone. */
void ab_boundaries_remap(ab_boundaries *, const ab_step *);

/* What boundaries took from a body so far, J. */
double ab_boundaries_taken(const ab_boundaries *, size_t body);
/* dt, s, at which body and springs of its boundaries together are neutrally stable; dt: of the body alone. *limit: changed where springs bind. */
double ab_boundaries_critical_dt(ab_boundaries *, size_t body, double dt, const char **limit);
const ab_boundary_totals *ab_boundaries_totals(const ab_boundaries *); /* one per boundary of the scene */
void ab_boundaries_keep(ab_boundaries *, struct ab_checkpoint *);

#endif
