/* element_q8.c: the serendipity quadrilateral with eight nodes, 3 x 3 or 2 x 2 Gauss points.
 *
 * A field is c + xi a + eta b + xi eta h + xi^2 aa + eta^2 bb + xi^2 eta aab + xi eta^2 abb; the loops over Gauss points see these seven
 * and the forces conjugate to them, not the nodes. Compiled once more with RINGS: as rings about the axis x = 0, volumes times 2 pi r, and hoops that stretch by
 * u_r/r. */
#include "fem/element_inner.h"

#ifndef RINGS
#define RINGS 0
#endif
#if RINGS
#define NAME(f) f##_rings
#else
#define NAME(f) f
#endif

typedef struct serendipity {
    lanes a[2], b[2], h[2], aa[2], bb[2], aab[2], abb[2];
} serendipity;

static inline serendipity serendipity_of(const double (*x)[8], const double (*minus)[8], int first) {
    serendipity f;
    for (int c = 0; c < 2; c++) {
        lanes n[8];
        for (int k = 0; k < 8; k++)
            n[k] = minus ? lanes_load(x[2 * k + c] + first) - lanes_load(minus[2 * k + c] + first) : lanes_load(x[2 * k + c] + first);
        const lanes bottom = n[1] - n[0], top = n[2] - n[3], left = n[3] - n[0], right = n[2] - n[1];
        f.a[c] = 0.5 * (n[5] - n[7]);
        f.b[c] = 0.5 * (n[6] - n[4]);
        f.h[c] = 0.25 * (top - bottom);
        f.aa[c] = 0.25 * ((n[0] - n[4]) + (n[1] - n[4]) + (n[2] - n[6]) + (n[3] - n[6]));
        f.bb[c] = 0.25 * ((n[0] - n[7]) + (n[1] - n[5]) + (n[2] - n[5]) + (n[3] - n[7]));
        f.aab[c] = 0.25 * (left + right) - f.b[c];
        f.abb[c] = 0.25 * (bottom + top) - f.a[c];
    }
    return f;
}

static inline fem_jacobian serendipity_at(const serendipity *f, double xi, double eta) {
    const double xx = 2 * xi, ee = 2 * eta, xe = 2 * xi * eta, x2 = xi * xi, e2 = eta * eta;
    return (fem_jacobian){
        f->a[0] + eta * f->h[0] + xx * f->aa[0] + xe * f->aab[0] + e2 * f->abb[0],
        f->b[0] + xi * f->h[0] + ee * f->bb[0] + x2 * f->aab[0] + xe * f->abb[0],
        f->a[1] + eta * f->h[1] + xx * f->aa[1] + xe * f->aab[1] + e2 * f->abb[1],
        f->b[1] + xi * f->h[1] + ee * f->bb[1] + x2 * f->aab[1] + xe * f->abb[1],
    };
}

#if RINGS
/* The radial component itself; the constant from the middles of the sides. */
static inline lanes radial_centre(const double (*x)[8], const serendipity *f, int first) {
    return 0.25 * (lanes_load(x[8] + first) + lanes_load(x[10] + first) + lanes_load(x[12] + first) + lanes_load(x[14] + first)) -
           0.5 * (f->aa[0] + f->bb[0]);
}
static inline lanes radial_at(lanes centre, const serendipity *f, double xi, double eta) {
    return centre + xi * f->a[0] + eta * f->b[0] + xi * eta * f->h[0] + xi * xi * f->aa[0] + eta * eta * f->bb[0] +
           xi * xi * eta * f->aab[0] + xi * eta * eta * f->abb[0];
}
#endif

static inline __attribute__((always_inline)) void strain(fem_block *block, const int side, int first) {
    const serendipity x = serendipity_of(block->start, NULL, first), u = serendipity_of(block->end, block->start, first);
    lanes area = {0}, lowest = lanes_set(1e300);
#if RINGS
    const serendipity y = serendipity_of(block->end, NULL, first);
    const lanes start = radial_centre(block->start, &x, first), moved = radial_centre(block->end, &y, first) - start;
#endif
    for (int q = 0; q < side * side; q++) {
        const double g = side == 2 ? FEM_GAUSS_2 : FEM_GAUSS_3, step = side == 2 ? 2 * g : g;
        const int column = q % side, row = q / side;
        const double xi = -g + step * column, eta = -g + step * row;
        const double w = side == 2 ? 1 : (column == 1 ? 8.0 / 9 : 5.0 / 9) * (row == 1 ? 8.0 / 9 : 5.0 / 9);
        const fem_jacobian j = serendipity_at(&x, xi, eta), du = serendipity_at(&u, xi, eta);
        const lanes det = fem_det(j), end = fem_det(fem_jacobian_sum(j, du));
        const fem_jacobian h = fem_gradient(du, j, 1.0 / det);
        lanes_store(block->h[q][0] + first, h.xx);
        lanes_store(block->h[q][1] + first, h.xy);
        lanes_store(block->h[q][2] + first, h.yx);
        lanes_store(block->h[q][3] + first, h.yy);
#if RINGS
        const lanes r0 = radial_at(start, &x, xi, eta), ur = radial_at(moved, &u, xi, eta);
        lanes_store(block->hoop[q] + first, ur / r0);
        lanes_store(block->volume0[q] + first, fem_circumference(r0) * (w * det));
        lanes_store(block->volume[q] + first, fem_circumference(r0 + ur) * (w * end));
#else
        lanes_store(block->volume0[q] + first, w * det);
        lanes_store(block->volume[q] + first, w * end);
#endif
        area += w * end;
        lowest = lanes_min(lowest, end);
    }
    for (int k = 0; k < 4; k++) {
        const double xi = k == 1 || k == 2 ? 1 : -1, eta = k >= 2 ? 1 : -1;
        lowest = lanes_min(lowest, fem_det(fem_jacobian_sum(serendipity_at(&x, xi, eta), serendipity_at(&u, xi, eta))));
    }
    lanes_store(block->jacobian + first, fem_relative_jacobian(lowest, area));
    lanes_store(block->control_work + first, (lanes){0});
    lanes_store(block->control_first + first, (lanes){0});
}

static inline __attribute__((always_inline)) void force(fem_block *block, const int side, int first) {
    const serendipity y = serendipity_of(block->end, NULL, first);
    serendipity s = {.a = {{0}}};
#if RINGS
    const lanes centre = radial_centre(block->end, &y, first);
    lanes all = {0};
#endif
    for (int q = 0; q < side * side; q++) {
        const double g = side == 2 ? FEM_GAUSS_2 : FEM_GAUSS_3, step = side == 2 ? 2 * g : g;
        const int column = q % side, row = q / side;
        const double xi = -g + step * column, eta = -g + step * row;
#if RINGS /* 2 pi r det J (sigma : G + s_tt N/r): the radius cancels in the second */
        const double share = side == 2 ? 1 : (column == 1 ? 8.0 / 9 : 5.0 / 9) * (row == 1 ? 8.0 / 9 : 5.0 / 9);
        const lanes w = share * fem_circumference(radial_at(centre, &y, xi, eta));
        const lanes hoop = share * fem_circumference(fem_det(serendipity_at(&y, xi, eta)) * lanes_load(block->stress[q][2] + first));
        all += hoop;
        s.a[0] += xi * hoop;
        s.b[0] += eta * hoop;
        s.h[0] += xi * eta * hoop;
        s.aa[0] += xi * xi * hoop;
        s.bb[0] += eta * eta * hoop;
        s.aab[0] += xi * xi * eta * hoop;
        s.abb[0] += xi * eta * eta * hoop;
#else
        const double w = side == 2 ? 1 : (column == 1 ? 8.0 / 9 : 5.0 / 9) * (row == 1 ? 8.0 / 9 : 5.0 / 9);
#endif
        const fem_jacobian p = fem_pull(w * lanes_load(block->stress[q][0] + first), w * lanes_load(block->stress[q][1] + first),
                                        w * lanes_load(block->stress[q][3] + first), serendipity_at(&y, xi, eta));
        const lanes along[2] = {p.xx, p.yx}, across[2] = {p.xy, p.yy};
        for (int c = 0; c < 2; c++) {
            s.a[c] += along[c];
            s.b[c] += across[c];
            s.h[c] += eta * along[c] + xi * across[c];
            s.aa[c] += 2 * xi * along[c];
            s.bb[c] += 2 * eta * across[c];
            s.aab[c] += 2 * xi * eta * along[c] + xi * xi * across[c];
            s.abb[c] += eta * eta * along[c] + 2 * xi * eta * across[c];
        }
    }
    for (int c = 0; c < 2; c++) {
        const lanes both = 0.25 * (s.aa[c] + s.bb[c]), h = 0.25 * s.h[c], aab = 0.25 * s.aab[c], abb = 0.25 * s.abb[c];
        lanes_store(block->force[0 + c] + first, both + h - aab - abb);
        lanes_store(block->force[2 + c] + first, both - h - aab + abb);
        lanes_store(block->force[4 + c] + first, both + h + aab + abb);
        lanes_store(block->force[6 + c] + first, both - h + aab - abb);
        const lanes vertical = 0.5 * (s.b[c] - s.aab[c]), horizontal = 0.5 * (s.a[c] - s.abb[c]), aa = 0.5 * s.aa[c], bb = 0.5 * s.bb[c];
        lanes_store(block->force[8 + c] + first, -aa - vertical);
        lanes_store(block->force[10 + c] + first, horizontal - bb);
        lanes_store(block->force[12 + c] + first, vertical - aa);
        lanes_store(block->force[14 + c] + first, -horizontal - bb);
    }
#if RINGS /* the constant is half the sum of the middles less a quarter of that of the corners */
    for (int k = 0; k < 8; k++)
        lanes_store(block->force[2 * k] + first, lanes_load(block->force[2 * k] + first) + (k < 4 ? -0.25 : 0.5) * all);
#endif
}

void NAME(fem_q8_strain)(fem_block *block, const fem_elastic *elastic, bool f_bar, double hourglass) {
    (void)elastic, (void)f_bar, (void)hourglass;
    for (int first = 0; first < 8; first += LANES) strain(block, 3, first);
}
void NAME(fem_q8_force)(fem_block *block, bool f_bar) {
    (void)f_bar;
    for (int first = 0; first < 8; first += LANES) force(block, 3, first);
}
void NAME(fem_q8r_strain)(fem_block *block, const fem_elastic *elastic, bool f_bar, double hourglass) {
    (void)elastic, (void)f_bar, (void)hourglass;
    for (int first = 0; first < 8; first += LANES) strain(block, 2, first);
}
void NAME(fem_q8r_force)(fem_block *block, bool f_bar) {
    (void)f_bar;
    for (int first = 0; first < 8; first += LANES) force(block, 2, first);
}
