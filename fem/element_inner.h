/* element_inner.h: what the element kernels share: Jacobians of eight elements at once, bilinear fields by their three gradients.
 *
 * A bilinear field is c + xi a + eta b + xi eta h; only a, b, h matter here. With the forces conjugate to them, the nodes never appear in the loops over
 * Gauss points, and no gradient of a basis function is divided by det J: V_q G_a = w cof(J) dN_a. */
#ifndef AB_FEM_ELEMENT_INNER_H
#define AB_FEM_ELEMENT_INNER_H

#include "fem/element.h"

#define FEM_GAUSS_2 0.57735026918962576451 /* 1/sqrt(3) */
#define FEM_GAUSS_3 0.77459666924148337704 /* sqrt(3/5) */

typedef struct fem_jacobian { /* d(x, y)/d(xi, eta): first letter the component, second xi (x) or eta (y) */
    v8 xx, xy, yx, yy;
} fem_jacobian;

static inline v8 fem_det(fem_jacobian j) { return j.xx * j.yy - j.xy * j.yx; }
static inline fem_jacobian fem_jacobian_sum(fem_jacobian a, fem_jacobian b) {
    return (fem_jacobian){a.xx + b.xx, a.xy + b.xy, a.yx + b.yx, a.yy + b.yy};
}
/* du/dx = (du/dxi) J^-1; r = 1/det J. */
static inline fem_jacobian fem_gradient(fem_jacobian u, fem_jacobian j, v8 r) {
    return (fem_jacobian){(u.xx * j.yy - u.xy * j.yx) * r, (u.xy * j.xx - u.xx * j.xy) * r, (u.yx * j.yy - u.yy * j.yx) * r,
                          (u.yy * j.xx - u.yx * j.xy) * r};
}
/* sigma cof(J): what a Gauss point of weight 1 does on the derivatives with respect to (xi, eta). */
static inline fem_jacobian fem_pull(v8 xx, v8 yy, v8 xy, fem_jacobian j) {
    return (fem_jacobian){xx * j.yy - xy * j.xy, xy * j.xx - xx * j.yx, xy * j.yy - yy * j.xy, yy * j.xx - xy * j.yx};
}
/* Smallest det J over that of a square of the same area; 0 where a coordinate is not a number. */
static inline v8 fem_relative_jacobian(v8 lowest, v8 area) {
    const v8 zero = {0}, ratio = lowest / (0.25 * v8_max(area, zero - area));
    return v8_select(ratio > zero, ratio, v8_min(ratio, zero));
}

typedef struct fem_bilinear { /* of a field with two components */
    v8 a[2], b[2], h[2];
} fem_bilinear;

/* x: rows of the four corners; minus: rows to be subtracted, or NULL. */
static inline fem_bilinear fem_bilinear_of(const double (*x)[8], const double (*minus)[8]) {
    fem_bilinear f;
    for (int c = 0; c < 2; c++) {
        v8 n[4];
        for (int k = 0; k < 4; k++) n[k] = minus ? v8_load(x[2 * k + c]) - v8_load(minus[2 * k + c]) : v8_load(x[2 * k + c]);
        const v8 bottom = n[1] - n[0], top = n[2] - n[3], left = n[3] - n[0], right = n[2] - n[1];
        f.a[c] = 0.25 * (bottom + top);
        f.b[c] = 0.25 * (left + right);
        f.h[c] = 0.25 * (top - bottom);
    }
    return f;
}
static inline fem_jacobian fem_bilinear_at(const fem_bilinear *f, double xi, double eta) {
    return (fem_jacobian){f->a[0] + eta * f->h[0], f->b[0] + xi * f->h[0], f->a[1] + eta * f->h[1], f->b[1] + xi * f->h[1]};
}
static inline fem_bilinear fem_bilinear_sum(const fem_bilinear *f, const fem_bilinear *g, double factor) {
    fem_bilinear s;
    for (int c = 0; c < 2; c++) {
        s.a[c] = f->a[c] + factor * g->a[c];
        s.b[c] = f->b[c] + factor * g->b[c];
        s.h[c] = f->h[c] + factor * g->h[c];
    }
    return s;
}
/* Nodal forces from those conjugate to a, b, h. */
static inline void fem_bilinear_force(const fem_bilinear *s, double (*force)[8]) {
    for (int c = 0; c < 2; c++) {
        const v8 a = 0.25 * s->a[c], b = 0.25 * s->b[c], h = 0.25 * s->h[c];
        v8_store(force[0 + c], h - a - b);
        v8_store(force[2 + c], a - b - h);
        v8_store(force[4 + c], a + b + h);
        v8_store(force[6 + c], b - a - h);
    }
}
/* det J of a bilinear field is linear in xi and eta: smallest at a corner. */
static inline v8 fem_bilinear_lowest(const fem_bilinear *f) {
    return v8_min(v8_min(fem_det(fem_bilinear_at(f, -1, -1)), fem_det(fem_bilinear_at(f, 1, -1))),
                  v8_min(fem_det(fem_bilinear_at(f, 1, 1)), fem_det(fem_bilinear_at(f, -1, 1))));
}

/* The frame that turns with a quadrilateral: the rotation of the polar decomposition of J at its centre. Numbering the nodes from another corner turns it by 90
 * degrees. cosine, sine: of the angle from the x axis. */
static inline void fem_frame(fem_jacobian j, v8 *cosine, v8 *sine) {
    const v8 c = j.xx + j.yy, s = j.yx - j.xy, square = c * c + s * s;
    v8 length;
    for (int l = 0; l < 8; l++) length[l] = __builtin_sqrt(square[l]);
    *cosine = c / length;
    *sine = s / length;
}

/* Physical stabilisation of the quadrilateral with one point (Belytschko and Bindeman 1991, ASQBI): in the element's frame the strains besides the constant ones are
 * exx = h,x qx - n h,y qy and eyy = h,y qy - n h,x qx with n = nu/(1 - nu), no shear: exact for the bending of a rectangle and free of locking as nu -> 1/2.
 * Their energy is modulus/2 (Hxx qx^2 - 2 n Hxy qx qy + Hyy qy^2), H_ij = integral of h,i h,j with the Jacobian at the centre. */
typedef struct fem_hourglass {
    double modulus, n;
    v8 hxx, hxy, hyy, cosine, sine;
} fem_hourglass;

static inline fem_hourglass fem_hourglass_of(fem_jacobian j, v8 r, const fem_elastic *elastic, double factor) {
    const double p = elastic->lambda + 2 * elastic->mu;
    fem_hourglass s = {.modulus = factor * 4 * elastic->mu * (elastic->lambda + elastic->mu) / p, .n = elastic->lambda / p};
    fem_frame(j, &s.cosine, &s.sine);
    const v8 c = s.cosine, n = s.sine; /* J in the frame */
    const fem_jacobian f = {c * j.xx + n * j.yx, c * j.xy + n * j.yy, c * j.yx - n * j.xx, c * j.yy - n * j.xy};
    s.hxx = 4.0 / 3.0 * r * (f.yy * f.yy + f.yx * f.yx);
    s.hyy = 4.0 / 3.0 * r * (f.xx * f.xx + f.xy * f.xy);
    s.hxy = -4.0 / 3.0 * r * (f.xy * f.yy + f.xx * f.yx);
    return s;
}

void fem_q4_strain(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
void fem_q4_force(fem_block *, bool f_bar);
void fem_q4r_strain(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
void fem_q4r_force(fem_block *, bool f_bar);
void fem_q6_strain(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
void fem_q6_force(fem_block *, bool f_bar);
void fem_q8_strain(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
void fem_q8_force(fem_block *, bool f_bar);
void fem_q8r_strain(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
void fem_q8r_force(fem_block *, bool f_bar);

#endif
