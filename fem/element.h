/* element.h: the quadrilateral elements: eight elements of one type at a time, lane l of every row being one element. Pure functions of arrays; no memory, no
 * state but what the caller hands over. Plane strain, per m of thickness; axisymmetric elements are whole rings, their x the radius. Inside fem/ only.
 *
 * Rows: positions and forces x[2*a + c] of node a; stress in the order (xx, yy, zz, xy); displacement gradient (xx, xy, yx, yy), H_ij = d(du_i)/dx_j. */
#ifndef AB_FEM_ELEMENT_H
#define AB_FEM_ELEMENT_H

#include "core/scene.h"
#include "core/vector.h"

enum { FEM_NODES = 8, FEM_GAUSS = 9, FEM_EXTRA = 4 };

typedef struct
    fem_elastic { /* the material's tangent at the start, isotropic: what incompatible modes, hourglass control and critical steps go by */
    double lambda, mu, density; /* Pa, Pa, kg/m3 */
} fem_elastic;

typedef struct fem_block {                                 /* eight elements in one step */
    double start[2 * FEM_NODES][8], end[2 * FEM_NODES][8]; /* in: node positions at the start and at the end of the step, m */
    double extra[FEM_EXTRA][8]; /* in and out: what the element keeps itself (q4r: hourglass stresses); carried from step to step */
    double h[FEM_GAUSS][4][8];  /* out of strain: displacement gradient of the step with respect to the start */
    double volume0[FEM_GAUSS][8], volume[FEM_GAUSS][8]; /* out of strain: of each Gauss point at the start and at the end, m2 */
    double stress[FEM_GAUSS][4][8];                     /* in: of strain, at the start; of force, at the end; Pa */
    double force[2 * FEM_NODES][8];                     /* out of force: internal force on the nodes (to be subtracted), N */
    double control_work[8];                             /* out of strain: work of hourglass forces in this step, J */
    double control_first[8];                            /* the same of those at its start alone (q4r; the others leave it) */
    double jacobian
        [8]; /* out of strain: smallest det J over Gauss points and corners at the end, over that of a square of the same area; <= 0: inverted */
    double hoop[FEM_GAUSS][8]; /* out of strain, axisymmetric elements: u_r/r of the step; their volumes are in m3 */
} fem_block;

typedef struct fem_element {
    const char *name;
    int nodes, gauss, extra;
    bool axisymmetric;
    void (*strain)(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
    void (*force)(fem_block *, bool f_bar);
    /* Masses of the nodes, kg: row sum (q4, q4r, q6), diagonal scaling of the consistent mass (q8, q8r: Hinton, Rock, Zienkiewicz 1976). x: 2*nodes rows. */
    void (*mass)(const double (*x)[8], double density, double (*mass)[8]);
} fem_element;

const fem_element *fem_element_of(ab_element_type);
const fem_element *fem_element_axisymmetric_of(ab_element_type);

/* Largest eigenfrequency squared, 1/s2, of each of eight free elements with lumped masses: bounds that of the whole mesh (Irons). Power iteration to 1e-3, never
 * below the true value by more. */
void fem_element_frequency(const fem_element *, const double (*x)[8], const fem_elastic *, bool f_bar, double hourglass,
                           double frequency2[8]);

/* Values of the basis at (xi, eta); derivatives with respect to them. nodes 4 or 8. */
void fem_shape(int nodes, double xi, double eta, double *n);
void fem_shape_derivatives(int nodes, double xi, double eta, double (*dn)[2]);
/* Places and weights of Gauss points in the reference square. */
void fem_gauss(const fem_element *, int point, double place[2], double *weight);

#endif
