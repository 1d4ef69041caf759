/* element_inner.h: what the element kernels share: Jacobians of eight elements at once, bilinear fields by their three gradients.
 *
 * A bilinear field is c + xi a + eta b + xi eta h; only a, b, h matter here. With the forces conjugate to them, the nodes never appear
 * in the loops over Gauss points, and no gradient of a basis function is divided by det J: V_q G_a = w cof(J) dN_a. */
#ifndef AB_FEM_ELEMENT_INNER_H
#define AB_FEM_ELEMENT_INNER_H

#include "fem/element.h"

/* As many lanes as fit into a register: gcc takes longer vectors apart through memory. The kernels go through the eight lanes of a block
 * in 8 / LANES rounds. */
#if defined(__AVX512F__)
typedef v8 lanes;
typedef v8_loose lanes_loose;
typedef v8_mask lanes_mask;
enum { LANES = 8 };
#elif defined(__AVX__)
typedef v4 lanes;
typedef v4_loose lanes_loose;
typedef int64_t lanes_mask __attribute__((vector_size(32)));
enum { LANES = 4 };
#else
typedef v2 lanes;
typedef v2_loose lanes_loose;
typedef int64_t lanes_mask __attribute__((vector_size(16)));
enum { LANES = 2 };
#endif

static inline lanes lanes_load(const double *p) { return *(const lanes_loose *)p; }
static inline void lanes_store(double *p, lanes a) { *(lanes_loose *)p = a; }
static inline lanes lanes_set(double a) { return a - (lanes){0}; }
static inline lanes lanes_select(lanes_mask c, lanes a, lanes b) { return (lanes)((c & (lanes_mask)a) | (~c & (lanes_mask)b)); }
static inline lanes lanes_min(lanes a, lanes b) { return lanes_select(a < b, a, b); }
static inline lanes lanes_max(lanes a, lanes b) { return lanes_select(a > b, a, b); }
static inline lanes lanes_root(lanes a) {
    lanes r;
    for (int l = 0; l < LANES; l++) r[l] = __builtin_sqrt(a[l]);
    return r;
}

#define FEM_GAUSS_2 0.57735026918962576451 /* 1/sqrt(3) */
#define FEM_GAUSS_3 0.77459666924148337704 /* sqrt(3/5) */

typedef struct fem_jacobian { /* d(x, y)/d(xi, eta): first letter the component, second xi (x) or eta (y) */
    lanes xx, xy, yx, yy;
} fem_jacobian;

static inline lanes fem_det(fem_jacobian j) { return j.xx * j.yy - j.xy * j.yx; }
static inline fem_jacobian fem_jacobian_sum(fem_jacobian a, fem_jacobian b) {
    return (fem_jacobian){a.xx + b.xx, a.xy + b.xy, a.yx + b.yx, a.yy + b.yy};
}
/* du/dx = (du/dxi) J^-1; r = 1/det J. */
static inline fem_jacobian fem_gradient(fem_jacobian u, fem_jacobian j, lanes r) {
    return (fem_jacobian){(u.xx * j.yy - u.xy * j.yx) * r, (u.xy * j.xx - u.xx * j.xy) * r, (u.yx * j.yy - u.yy * j.yx) * r,
                          (u.yy * j.xx - u.yx * j.xy) * r};
}
/* sigma cof(J): what a Gauss point of weight 1 does on the derivatives with respect to (xi, eta). */
static inline fem_jacobian fem_pull(lanes xx, lanes yy, lanes xy, fem_jacobian j) {
    return (fem_jacobian){xx * j.yy - xy * j.xy, xy * j.xx - xx * j.yx, xy * j.yy - yy * j.xy, yy * j.xx - xy * j.yx};
}
/* Smallest det J over that of a square of the same area; 0 where a coordinate is not a number. */
static inline lanes fem_relative_jacobian(lanes lowest, lanes area) {
    const lanes zero = {0}, ratio = lowest / (0.25 * lanes_max(area, zero - area));
    return lanes_select(ratio > zero, ratio, lanes_min(ratio, zero));
}

typedef struct fem_bilinear { /* of a field with two components */
    lanes a[2], b[2], h[2];
} fem_bilinear;

/* x: rows of the four corners; minus: rows to be subtracted, or NULL. */
static inline fem_bilinear fem_bilinear_of(const double (*x)[8], const double (*minus)[8], int first) {
    fem_bilinear f;
    for (int c = 0; c < 2; c++) {
        lanes n[4];
        for (int k = 0; k < 4; k++)
            n[k] = minus ? lanes_load(x[2 * k + c] + first) - lanes_load(minus[2 * k + c] + first) : lanes_load(x[2 * k + c] + first);
        const lanes bottom = n[1] - n[0], top = n[2] - n[3], left = n[3] - n[0], right = n[2] - n[1];
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
static inline void fem_bilinear_force(const fem_bilinear *s, double (*force)[8], int first) {
    for (int c = 0; c < 2; c++) {
        const lanes a = 0.25 * s->a[c], b = 0.25 * s->b[c], h = 0.25 * s->h[c];
        lanes_store(force[0 + c] + first, h - a - b);
        lanes_store(force[2 + c] + first, a - b - h);
        lanes_store(force[4 + c] + first, a + b + h);
        lanes_store(force[6 + c] + first, b - a - h);
    }
}
/* det J of a bilinear field is linear in xi and eta: smallest at a corner. */
static inline lanes fem_bilinear_lowest(const fem_bilinear *f) {
    return lanes_min(lanes_min(fem_det(fem_bilinear_at(f, -1, -1)), fem_det(fem_bilinear_at(f, 1, -1))),
                     lanes_min(fem_det(fem_bilinear_at(f, 1, 1)), fem_det(fem_bilinear_at(f, -1, 1))));
}

/* The frame that turns with a quadrilateral: the rotation of the polar decomposition of J at its centre. Numbering the nodes from
 * another corner turns it by 90 degrees. cosine, sine: of the angle from the x axis. */
static inline void fem_frame(fem_jacobian j, lanes *cosine, lanes *sine) {
    const lanes c = j.xx + j.yy, s = j.yx - j.xy, r = 1.0 / lanes_root(c * c + s * s);
    *cosine = c * r;
    *sine = s * r;
}

/* Physical stabilisation of the quadrilateral with one point (Belytschko and Bindeman 1991, ASQBI): in the element's frame the strains
 * besides the constant ones are exx = h,x qx - n h,y qy and eyy = h,y qy - n h,x qx with n = nu/(1 - nu), no shear: exact for the
 * bending of a rectangle and free of locking as nu -> 1/2. Their energy is modulus/2 (Hxx qx^2 - 2 n Hxy qx qy + Hyy qy^2), H_ij =
 * integral of h,i h,j with the Jacobian at the centre. */
typedef struct fem_hourglass {
    double modulus, n;
    lanes hxx, hxy, hyy, cosine, sine;
} fem_hourglass;

static inline fem_hourglass fem_hourglass_of(fem_jacobian j, lanes r, const fem_elastic *elastic, double factor) {
    const double p = elastic->lambda + 2 * elastic->mu;
    fem_hourglass s = {.modulus = factor * 4 * elastic->mu * (elastic->lambda + elastic->mu) / p, .n = elastic->lambda / p};
    fem_frame(j, &s.cosine, &s.sine);
    const lanes c = s.cosine, n = s.sine; /* J in the frame */
    const fem_jacobian f = {c * j.xx + n * j.yx, c * j.xy + n * j.yy, c * j.yx - n * j.xx, c * j.yy - n * j.xy};
    s.hxx = 4.0 / 3.0 * r * (f.yy * f.yy + f.yx * f.yx);
    s.hyy = 4.0 / 3.0 * r * (f.xx * f.xx + f.xy * f.xy);
    s.hxy = -4.0 / 3.0 * r * (f.xy * f.yy + f.xx * f.yx);
    return s;
}

/* Length of the circle at a radius, m. */
static inline lanes fem_circumference(lanes radius) { return 6.283185307179586 * radius; }
/* r of four nodes: the mean of the corners, and at a place of the reference square. */
static inline lanes fem_radius_centre(const double (*x)[8], int first) {
    return 0.25 * (lanes_load(x[0] + first) + lanes_load(x[2] + first) + lanes_load(x[4] + first) + lanes_load(x[6] + first));
}
static inline lanes fem_radius_at(lanes centre, const fem_bilinear *f, const double place[2]) {
    return centre + place[0] * f->a[0] + place[1] * f->b[0] + place[0] * place[1] * f->h[0];
}

void fem_q4_strain(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
void fem_q4_force(fem_block *, bool f_bar);
void fem_q4_strain_rings(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
void fem_q4_force_rings(fem_block *, bool f_bar);
void fem_q4r_strain(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
void fem_q4r_force(fem_block *, bool f_bar);
void fem_q4r_strain_rings(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
void fem_q4r_force_rings(fem_block *, bool f_bar);
void fem_q6_strain(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
void fem_q6_force(fem_block *, bool f_bar);
void fem_q6_strain_rings(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
void fem_q6_force_rings(fem_block *, bool f_bar);
void fem_q8_strain(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
void fem_q8_force(fem_block *, bool f_bar);
void fem_q8r_strain(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
void fem_q8r_force(fem_block *, bool f_bar);
void fem_q8_strain_rings(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
void fem_q8_force_rings(fem_block *, bool f_bar);
void fem_q8r_strain_rings(fem_block *, const fem_elastic *, bool f_bar, double hourglass);
void fem_q8r_force_rings(fem_block *, bool f_bar);

#endif
