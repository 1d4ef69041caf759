/* element_q4r.c: the quadrilateral with four nodes and one Gauss point, its two hourglass modes held by physical stabilisation.
 *
 * extra[0], extra[1]: the forces Qx, Qy (N) conjugate to the hourglass coordinates qx, qy in the element's own frame, which turns with
 * it: so they are objective, and grow from step to step with the strains of the modes. Here the coordinate of a field u is its part in
 * xi eta less what the linear part of the geometry has of it: q = u_h - (du/dx) x_h - (du/dy) y_h, which is gamma.u of Flanagan and
 * Belytschko (1981) and zero for every linear u.
 *
 * Compiled once more with RINGS, as a ring about the axis x = 0: the strain is the mean over the ring of those of q4, hoops with it, by 2 x 2 points (the uniform
 * strain of Flanagan and Belytschko), so that uniform stress is in equilibrium in every shape; volumes are those of rings, and the stabilisation is that of
 * the plane times the circumference at the centre. */
#include <string.h>

#include "fem/element_inner.h"

#ifndef RINGS
#define RINGS 0
#endif
#if RINGS
#define NAME(f) fem_q4r_##f##_rings

static const double PLACE[4][2] = {
    {-FEM_GAUSS_2, -FEM_GAUSS_2}, {FEM_GAUSS_2, -FEM_GAUSS_2}, {-FEM_GAUSS_2, FEM_GAUSS_2}, {FEM_GAUSS_2, FEM_GAUSS_2}};

/* Mean strain over the ring, and its volumes. */
static inline fem_jacobian mean_gradient(fem_block *block, const fem_bilinear *x, const fem_bilinear *u, const fem_bilinear *y, int first) {
    const lanes centre = fem_radius_centre(block->start, first), now = fem_radius_centre(block->end, first);
    fem_jacobian h = {.xx = {0}};
    lanes hoop = {0}, volume = {0}, end = {0};
    for (int q = 0; q < 4; q++) {
        const fem_jacobian j = fem_bilinear_at(x, PLACE[q][0], PLACE[q][1]);
        const lanes r0 = fem_radius_at(centre, x, PLACE[q]), r1 = fem_radius_at(now, y, PLACE[q]), det = fem_det(j);
        h = fem_jacobian_sum(h, fem_gradient(fem_bilinear_at(u, PLACE[q][0], PLACE[q][1]), j, fem_circumference(r0)));
        hoop += fem_circumference(r1 - r0) * det;
        volume += fem_circumference(r0) * det;
        end += fem_circumference(r1) * fem_det(fem_bilinear_at(y, PLACE[q][0], PLACE[q][1]));
    }
    const lanes inverse = 1.0 / volume;
    lanes_store(block->hoop[0] + first, hoop * inverse);
    lanes_store(block->volume0[0] + first, volume);
    lanes_store(block->volume[0] + first, end);
    return (fem_jacobian){h.xx * inverse, h.xy * inverse, h.yx * inverse, h.yy * inverse};
}
#else
#define NAME(f) fem_q4r_##f
#endif

static inline void strain(fem_block *block, const fem_elastic *elastic, double hourglass, int first) {
    const fem_bilinear x = fem_bilinear_of(block->start, NULL, first), u = fem_bilinear_of(block->end, block->start, first),
                       middle = fem_bilinear_sum(&x, &u, 0.5), y = fem_bilinear_sum(&x, &u, 1);
    const fem_jacobian du = fem_bilinear_at(&u, 0, 0);
    const lanes area = 4.0 * fem_det(fem_bilinear_at(&y, 0, 0));
#if RINGS
    const fem_jacobian h = mean_gradient(block, &x, &u, &y, first);
#else
    const fem_jacobian j = fem_bilinear_at(&x, 0, 0);
    const lanes det = fem_det(j);
    const fem_jacobian h = fem_gradient(du, j, 1.0 / det);
    lanes_store(block->volume0[0] + first, 4.0 * det);
    lanes_store(block->volume[0] + first, area);
#endif
    lanes_store(block->h[0][0] + first, h.xx);
    lanes_store(block->h[0][1] + first, h.xy);
    lanes_store(block->h[0][2] + first, h.yx);
    lanes_store(block->h[0][3] + first, h.yy);
    lanes_store(block->jacobian + first, fem_relative_jacobian(fem_bilinear_lowest(&y), area));
    if (hourglass == 0.0) {
        lanes_store(block->control_work + first, (lanes){0});
        lanes_store(block->control_first + first, (lanes){0});
        return;
    }
    /* The increment in the middle of the step. */
    const fem_jacobian m = fem_bilinear_at(&middle, 0, 0);
    const lanes r = 1.0 / fem_det(m);
    const fem_jacobian g = fem_gradient(du, m, r);
    const fem_hourglass s = fem_hourglass_of(m, r, elastic, hourglass);
    const lanes dx = u.h[0] - g.xx * middle.h[0] - g.xy * middle.h[1], dy = u.h[1] - g.yx * middle.h[0] - g.yy * middle.h[1];
    const lanes qx = s.cosine * dx + s.sine * dy, qy = s.cosine * dy - s.sine * dx;
    const lanes cross = s.n * s.hxy;
#if RINGS
    const lanes modulus =
        s.modulus * fem_circumference(0.5 * (fem_radius_centre(block->start, first) + fem_radius_centre(block->end, first)));
#else
    const double modulus = s.modulus;
#endif
    const lanes gain_x = modulus * (s.hxx * qx - cross * qy), gain_y = modulus * (s.hyy * qy - cross * qx);
    const lanes old_x = lanes_load(block->extra[0] + first), old_y = lanes_load(block->extra[1] + first);
    lanes_store(block->extra[0] + first, old_x + gain_x);
    lanes_store(block->extra[1] + first, old_y + gain_y);
    lanes_store(block->control_work + first, (old_x + 0.5 * gain_x) * qx + (old_y + 0.5 * gain_y) * qy);
    lanes_store(block->control_first + first, old_x * qx + old_y * qy);
}

static inline void force(fem_block *block, int first) {
    const fem_bilinear y = fem_bilinear_of(block->end, NULL, first);
    const fem_jacobian j = fem_bilinear_at(&y, 0, 0);
#if RINGS
    const fem_jacobian p = {.xx = {0}}; /* the stress has left its force there */
#else
    const fem_jacobian p = fem_pull(lanes_load(block->stress[0][0] + first), lanes_load(block->stress[0][1] + first),
                                    lanes_load(block->stress[0][3] + first), j);
#endif
    lanes c, s;
    fem_frame(j, &c, &s);
    const lanes qx = lanes_load(block->extra[0] + first), qy = lanes_load(block->extra[1] + first), r = 1.0 / fem_det(j);
    const lanes along = (y.h[0] * j.yy - y.h[1] * j.xy) * r, across = (y.h[1] * j.xx - y.h[0] * j.yx) * r;
    const lanes fx = c * qx - s * qy, fy = s * qx + c * qy;
    const fem_bilinear sum = {
        .a = {4.0 * p.xx - along * fx, 4.0 * p.yx - along * fy}, .b = {4.0 * p.xy - across * fx, 4.0 * p.yy - across * fy}, .h = {fx, fy}};
#if RINGS
    double control[8][8];
    fem_bilinear_force(&sum, control, first);
    for (int k = 0; k < 8; k++) lanes_store(block->force[k] + first, lanes_load(block->force[k] + first) + lanes_load(control[k] + first));
#else
    fem_bilinear_force(&sum, block->force, first);
#endif
}

void NAME(strain)(fem_block *block, const fem_elastic *elastic, bool f_bar, double hourglass) {
    (void)f_bar; /* one point: the dilatation is the mean one as it is */
    for (int first = 0; first < 8; first += LANES) strain(block, elastic, hourglass, first);
}
void NAME(force)(fem_block *block, bool f_bar) {
    (void)f_bar;
#if RINGS /* the force conjugate to the mean strain: that of q4 with the one stress at all of its points */
    for (int q = 1; q < 4; q++) memcpy(block->stress[q], block->stress[0], sizeof block->stress[0]);
    fem_q4_force_rings(block, false);
#endif
    for (int first = 0; first < 8; first += LANES) force(block, first);
}
