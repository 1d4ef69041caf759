/* cpdi_weights.h: weights, gradients and moments of convected particle domains, by blocks of eight points. Part of kernel_cpdi.c, compiled into its loops. */
#ifndef AB_MPM_CPDI_WEIGHTS_H
#define AB_MPM_CPDI_WEIGHTS_H

#include <math.h>
#include <string.h>

#include "mpm/axisymmetric.h"
#include "mpm/volumetric.h"

#ifndef AXISYMMETRIC /* 1 for the instance in which x is a radius and points are rings: mpm/axisymmetric.h */
#define AXISYMMETRIC 0
#endif
enum { STRAINS = AXISYMMETRIC ? 5 : 4 }; /* rows of a displacement gradient */
enum { NODES = 4, STENCIL = NODES * NODES, PATCH = MPM_PATCH_WIDE, PATCH_NODES = PATCH * PATCH, PATCH_DOUBLES = 8 * PATCH_NODES };
#define ROUNDING 1e-9 /* cells: by so much the place of a point in its tile may differ from that in the grid */
#define INLINE static inline __attribute__((always_inline))
#define UNROLL _Pragma("GCC unroll 16")

typedef struct frame { /* what the weights of a tile's points hang on */
    v8 corner[2], inverse_h, h;
    size_t corners, stride;
#if AXISYMMETRIC
    v8 axis; /* m, from the grid's corner */
#endif
} frame;

INLINE frame frame_of(const mpm_body *body, const mpm_tile *tile) {
    return (frame) {
        {v8_set(tile->tx * (AB_TILE * body->h)), v8_set(tile->ty * (AB_TILE * body->h))}, v8_set(body->inverse_h), v8_set(body->h),
            8 * (size_t)body->rows.corners, 8 * (size_t)body->rows.count
#if AXISYMMETRIC
            ,
            v8_set(-body->origin[0])
#endif
    };
}

#if AXISYMMETRIC
/* 1/m of a block's points. */
INLINE v8 inverse_radius_of(const frame *f, const double *block) { return mpm_inverse_radius(v8_load(block + 8 * ROW_X) - f->axis); }
#endif

/* Half diagonals of the domains, cells, drawn back to a cell at most: from the point to the corners at +a+b and +a-b. */
INLINE void diagonals(const frame *f, const double *block, v8 d[2][2]) {
    const double *r = block + f->corners;
    const v8 one = v8_set(1.0);
    for (int c = 0; c < 2; ++c) {
        const v8 a = v8_load(r + 8 * c), b = v8_load(r + 8 * (2 + c));
        d[0][c] = (a + b) * f->inverse_h;
        d[1][c] = (a - b) * f->inverse_h;
    }
    for (int k = 0; k < 2; ++k) {
        const v8 longest = v8_max(v8_max(d[k][0], -d[k][0]), v8_max(d[k][1], -d[k][1])), scale = one / v8_max(longest, one);
        for (int c = 0; c < 2; ++c) d[k][c] *= scale;
    }
}

/* Hat functions of the four nodes at u, cells from the first, 0 <= u <= 3. */
INLINE void hats(v8 u, v8 n[NODES]) {
    const v8 zero = v8_set(0.0), one = v8_set(1.0);
    UNROLL for (int i = 0; i < NODES; ++i) {
        const v8 off = u - v8_set((double)i);
        n[i] = v8_max(one - v8_max(off, -off), zero);
    }
}

/* From the first node of the stencil to the points, cells, 1 .. 2; the first node in the patch. */
INLINE void base_of(const frame *f, const double *block, v8 base[2], int32_t node[8]) {
    const v8 one = v8_set(1.0);
    v8 cell[2];
    for (int c = 0; c < 2; ++c) {
        const v8 s = (v8_load(block + 8 * (ROW_X + c)) - f->corner[c]) * f->inverse_h;
        cell[c] = v8_floor(s); /* the first node is one before */
        base[c] = s - cell[c] + one;
    }
    *(v8_int *)node = __builtin_convertvector(cell[1] * v8_set((double)PATCH) + cell[0], v8_int);
    V8_IN_MEMORY(node);
}

#if AXISYMMETRIC
/* The mean of dN/dx over a domain, weighted by r: with N = n + xi p + eta q + xi eta t on it and r = r_p + xi a_r + eta b_r, what N gains along a and b is p + t b_r/(3 r_p) and
 * q + t a_r/(3 r_p), or along the diagonals d0_r and -d1_r times t/(3 r_p) more. So the force of a uniform stress is the integral of r N over the outline of the domain,
 * which cancels from neighbour to neighbour. lean: d_r/(6 r_p), d_r cut where a domain reaches beyond the axis. */
INLINE void lean_of(const frame *f, const double *block, const v8 d[2][2], v8 lean[2]) {
    const v8 one = v8_set(1.0), inverse = f->h * inverse_radius_of(f, block);
    for (int k = 0; k < 2; ++k) lean[k] = v8_set(1.0 / 6.0) * v8_max(v8_min(d[k][0] * inverse, one), -one);
}
#endif

/* The table of a block; gradients with `slopes` only. */
INLINE void weigh(const frame *f, const double *block, const bool slopes, mpm_stencils *w) {
    v8 d[2][2], base[2], n[4][2][NODES];
    int32_t node[8] __attribute__((aligned(32)));
    base_of(f, block, base, node);
    memcpy(w->node, node, sizeof node);
    diagonals(f, block, d);
    for (int c = 0; c < 2; ++c) {
        hats(base[c] + d[0][c], n[0][c]);
        hats(base[c] - d[0][c], n[1][c]);
        hats(base[c] + d[1][c], n[2][c]);
        hats(base[c] - d[1][c], n[3][c]);
    }
    /* with p = N(+d0) - N(-d0) and q = N(+d1) - N(-d1): d0.G = p/2 and d1.G = q/2, so G = (p (d1y, -d1x) - q (d0y, -d0x))/(2 (d0x d1y - d0y d1x)) */
    const v8 turn = v8_set(0.5) * f->inverse_h / (d[0][0] * d[1][1] - d[0][1] * d[1][0]), quarter = v8_set(0.25);
    const v8 px = d[1][1] * turn, py = -d[1][0] * turn, qx = -d[0][1] * turn, qy = d[0][0] * turn;
#if AXISYMMETRIC
    v8 lean[2];
    lean_of(f, block, d, lean);
#endif
    UNROLL for (int k = 0; k < STENCIL; ++k) {
        const int i = k % NODES, j = k / NODES;
        const v8 n0 = n[0][0][i] * n[0][1][j], n1 = n[1][0][i] * n[1][1][j], n2 = n[2][0][i] * n[2][1][j], n3 = n[3][0][i] * n[3][1][j];
        v8_store(w->value[k], quarter * ((n0 + n1) + (n2 + n3)));
        if (!slopes) continue;
#if AXISYMMETRIC /* weighted by r: what is xi eta on the domain slopes where r is larger, too */
        const v8 twist = (n0 + n1) - (n2 + n3), p = n0 - n1 + lean[0] * twist, q = n2 - n3 - lean[1] * twist;
#else
        const v8 p = n0 - n1, q = n2 - n3;
#endif
        v8_store(w->gx[k], p * px + q * qx);
        v8_store(w->gy[k], p * py + q * qy);
    }
}

static void stencils(const mpm_body *body, const mpm_tile *tile, const double *block, mpm_stencils *w) {
    const frame f = frame_of(body, tile);
    weigh(&f, block, true, w);
}

static void first(const mpm_body *body, const double *block, int x, int32_t node[2][8]) {
    for (int c = 0; c < 2; ++c) {
        const v8_int cell = __builtin_convertvector(v8_floor(v8_load(block + 8 * (x + c)) * v8_set(body->inverse_h)), v8_int);
        for (int l = 0; l < 8; ++l) node[c][l] = cell[l] - 1;
    }
}

/* From the points to the first node of their stencils, m. */
INLINE void arms(const frame *f, const double *block, v8 arm[2]) {
    for (int c = 0; c < 2; ++c) {
        const v8 s = (v8_load(block + 8 * (ROW_X + c)) - f->corner[c]) * f->inverse_h;
        arm[c] = (v8_floor(s) - s - v8_set(1.0)) * f->h;
    }
}

/* D = sum N_i (x_i - x_p)(x_i - x_p)^T, m2: xx, yy, xy. */
INLINE void spread(const frame *f, const mpm_stencils *w, const v8 arm[2], v8 d[3]) {
    d[0] = d[1] = d[2] = v8_set(0.0);
    UNROLL for (int k = 0; k < STENCIL; ++k) {
        const v8 n = v8_load(w->value[k]), x = arm[0] + v8_set((double)(k % NODES)) * f->h, y = arm[1] + v8_set((double)(k / NODES)) * f->h;
        d[0] += n * x * x;
        d[1] += n * y * y;
        d[2] += n * x * y;
    }
}

static void spreads(const mpm_body *body, const mpm_tile *tile, const double *block, double d[3][8]) {
    const frame f = frame_of(body, tile);
    mpm_stencils w;
    v8 arm[2], all[3];
    weigh(&f, block, false, &w);
    arms(&f, block, arm);
    spread(&f, &w, arm, all);
    for (int c = 0; c < 3; ++c) v8_store(d[c], all[c]);
}

/* C = B D^-1; xx, xy, yx, yy. */
INLINE void solve(const v8 b[4], const v8 d[3], v8 c[4]) {
    const v8 inverse = v8_set(1.0) / (d[0] * d[1] - d[2] * d[2]);
    for (int k = 0; k < 4; k += 2) {
        const v8 x = b[k], y = b[k + 1];
        c[k] = (x * d[1] - y * d[2]) * inverse;
        c[k + 1] = (y * d[0] - x * d[2]) * inverse;
    }
}

/* What is bilinear between the corners is the basis inside of the domain, too: so a force on a piece of its outline goes to the nodes by its values at the middle of
 * the piece. Along a side of the domain it balances the internal force of a uniform stress to rounding; a piece that lies off the domain acts at its nearest place. */
static void carry(const mpm_body *body, const mpm_tile *tile, const double *block, int lane, const mpm_load *load,
                  double value[MPM_STENCIL]) {
    const frame f = frame_of(body, tile);
    v8 d[2][2], base[2], n[4][2][NODES];
    int32_t node[8] __attribute__((aligned(32)));
    double away[2], a[2], b[2];
    base_of(&f, block, base, node);
    diagonals(&f, block, d);
    for (int c = 0; c < 2; ++c) {
        hats(base[c] + d[0][c], n[0][c]);
        hats(base[c] - d[0][c], n[1][c]);
        hats(base[c] + d[1][c], n[2][c]);
        hats(base[c] - d[1][c], n[3][c]);
        away[c] = (load->now[c] - block[8 * (ROW_X + c) + lane]) * body->inverse_h;
        a[c] = 0.5 * (d[0][c][lane] + d[1][c][lane]);
        b[c] = 0.5 * (d[0][c][lane] - d[1][c][lane]);
    }
    const double area = a[0] * b[1] - a[1] * b[0];
    const double u = fmin(fmax((away[0] * b[1] - away[1] * b[0]) / area, -1.0), 1.0),
                 v = fmin(fmax((a[0] * away[1] - a[1] * away[0]) / area, -1.0), 1.0);
    double share[4] = {(1 + u) * (1 + v), (1 - u) * (1 - v), (1 + u) * (1 - v), (1 - u) * (1 + v)};
#if AXISYMMETRIC /* the force on a piece is that of its middle times 2 pi r there; its outer half bears more of it: the mean of N along it, weighted by r */
    const double radius = load->now[0] + body->origin[0],
                 lean = load->stretch[0] / (3.0 * fmax(radius, fmax(fabs(load->stretch[0]), 1e-12)));
    const double along[2] = {load->stretch[0] * body->inverse_h, load->stretch[1] * body->inverse_h};
    const double du = lean * (along[0] * b[1] - along[1] * b[0]) / area, dv = lean * (a[0] * along[1] - a[1] * along[0]) / area;
    share[0] += du * (1 + v) + dv * (1 + u), share[1] -= du * (1 - v) + dv * (1 - u);
    share[2] += du * (1 - v) - dv * (1 + u), share[3] -= du * (1 + v) - dv * (1 - u);
#endif
    for (int k = 0; k < STENCIL; ++k) {
        value[k] = 0.0;
        for (int q = 0; q < 4; ++q) value[k] += 0.25 * share[q] * n[q][0][k % NODES][lane] * n[q][1][k / NODES][lane];
    }
}

#endif
