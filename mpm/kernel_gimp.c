/* kernel_gimp.c: the passes over points with the generalised interpolation (GIMP) basis. */
#include <math.h>

#include "mpm/body.h"

/* Integral of the hat function from -1 to u. */
static double hat_integral(double u) {
    if (u <= -1.0) return 0.0;
    if (u >= 1.0) return 1.0;
    return u < 0.0 ? 0.5 * (1.0 + u) * (1.0 + u) : 1.0 - 0.5 * (1.0 - u) * (1.0 - u);
}

/* Hat functions of three nodes in a row averaged over [s-l, s+l]; s in cells from the first node, l kept so small that they add up to 1. */
static void average_hats(double s, double l, double n[3]) {
    s = fmin(fmax(s, 0.0), 2.0);
    l = fmin(l, fmin(s, 2.0 - s));
    for (int i = 0; i < 3; ++i) {
        const double u = s - i;
        n[i] = l > 1e-6 ? (hat_integral(u + l) - hat_integral(u - l)) / (2.0 * l) : fmax(1.0 - fabs(u), 0.0);
    }
}

/* The same, over no more than the point's own domain [x-domain, x+domain]: beyond it there are nodes that the body gives no mass, and force on them would be lost.
 * A piece along a side of its domain is within it; of one that runs across, the part about its middle is taken, so that its moment stays. */
static void average_near(double s, double l, double x, double domain, double n[3]) {
    const double off = fmin(fmax(s - x, -domain), domain);
    average_hats(x + off, fmin(l, domain - fabs(off)), n);
}

/* The basis averages hat functions over the points' domains, so that the internal force of a uniform stress is the integral of hat functions over the surface of the
 * domains. A traction is mapped in the same way, hats averaged over the piece of outline where it stands now, and balances that stress to rounding; mapped from the
 * middle of the point under it, it would leave a layer of wrong stress. */
static void carry(const mpm_body *body, const mpm_tile *tile, const double *block, int lane, const mpm_load *load,
                  double value[MPM_STENCIL]) {
    double n[2][3];
    int32_t node[2][8];
    body->kernel->first(body, block, ROW_X, node);
    (void)tile;
    for (int c = 0; c < 2; ++c)
        average_near(load->now[c] * body->inverse_h - node[c][lane], fabs(load->stretch[c]) * body->inverse_h,
                     block[8 * (ROW_X + c) + lane] * body->inverse_h - node[c][lane],
                     block[8 * (body->rows.half + c) + lane] * body->inverse_h, n[c]);
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) value[j * 3 + i] = n[0][i] * n[1][j];
}

#ifndef AXISYMMETRIC
#define AXISYMMETRIC 0
#endif
#define NODES 3
#define GIMP 1
#define SPLINE 0
#define BASIS "gimp"
#define COURANT 0.803, 0.803, 0.664, 0.664, 0.608, 0.562, 0.525, 0.493 /* 1 and 3 bear a little more */
#define LIGHT (AXISYMMETRIC ? 0 : 0.03) /* a face 0.25 of a cell beyond a line of nodes. More: a ring that turns gets energy as nodes come and go (0.05: 2e-3; 0.03: 2e-4). Less: blocks quiver at rest */
#define CARRY carry
#if AXISYMMETRIC
#define NAME(f) f##_gimp_axisymmetric
#else
#define NAME(f) f##_gimp
#endif
#include "mpm/kernel.inc"
