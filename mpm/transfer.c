/* transfer.c: transfers of velocity outside of the passes over points (transfer.inc): which one a body uses; the filter of xpic and fmpm; what apic and tpic keep of
 * a point besides its velocity: how it starts, its energy and spin. */
#include <math.h>

#include "mpm/body.h"

void mpm_transfer_choose(mpm_body *body) {
    const ab_body_spec *spec = body->domain.spec;
    body->flip = spec->flip;
    body->finish = MPM_FINISH_BLEND;
    if (spec->transfer == AB_TRANSFER_APIC || spec->transfer == AB_TRANSFER_TPIC) body->finish = MPM_FINISH_AFFINE;
    body->moment = spec->transfer == AB_TRANSFER_APIC && body->kernel->moment;
    body->keeps_moment = body->moment && !body->kernel->same_spread;
    if (spec->transfer == AB_TRANSFER_XPIC || spec->transfer == AB_TRANSFER_FMPM) {
        body->order = spec->order;
        body->full = spec->transfer == AB_TRANSFER_FMPM;
        body->flip = 0.0; /* of order 1 both are pic */
        if (body->order > 1) body->finish = MPM_FINISH_EXTENDED;
    }
}

/* With S from nodes to points, v_p = sum N_i v_i, and S+ back, v_i = sum N_i m_p v_p / m_i, both transfers use A = sum (1 - S+ S)^k, k = 0 .. m-1, which tends to
 * the inverse of S+ S, that is, of the full mass matrix where the lumped one stands:
 *   xpic  v_p = S (A v_old + a dt)   Hammerquist and Nairn 2017: v_p + S a dt - (1 - S S+)^m v_p, as S A S+ = 1 - (1 - S S+)^m
 *   fmpm  v_p = S A (v_old + a dt)   Nairn and Hammerquist 2021: the velocity of the nodes by the full mass matrix
 * v_old + a dt is what the nodes have after contact, sides and damping, and moves the points as in every other transfer: x_p += dt S (v_old + a dt).
 * A - 1 is found term by term, r_0 = v_old or v_old + a dt, r_k = r_(k-1) - S+ S r_(k-1): m-1 times to the points and back. Nodes that a side holds stay held
 * in every term. All of S+ S lies between 0 and 1, so the terms only fall. */
void mpm_filter(mpm_body *body) {
    if (body->order < 2) return;
    mpm_grid_filter_start(body);
    for (int k = 1; k < body->order; ++k) {
#pragma omp parallel for schedule(dynamic, 1) num_threads(body->threads)
        for (size_t n = 0; n < body->tile_count; ++n)
            if (body->tiles[n].patch >= 0) body->kernel->filter(body, n);
        mpm_grid_filter_assemble(body);
    }
}

/* Slope of a start velocity along one direction across the point's own domain, 1/s. So a linear field has its slope to rounding, a jump is spread over the point
 * it lies in, and nothing is asked far outside of the body, where a formula may have no value; where it has none on one side, the other side serves. */
static double slope_of(const ab_number *velocity, const double place[2], int direction, double half) {
    if (ab_number_is_constant(velocity)) return 0.0;
    double at[3][2], v[3];
    for (int k = 0; k < 3; ++k) {
        at[k][0] = place[0], at[k][1] = place[1];
        at[k][direction] += (k - 1) * half;
        v[k] = ab_number_at(velocity, 0.0, at[k][0], at[k][1], 0.0);
    }
    const double before = at[1][direction] - at[0][direction], behind = at[2][direction] - at[1][direction];
    if (isfinite(v[0]) && isfinite(v[2])) return (v[2] - v[0]) / (before + behind);
    if (isfinite(v[2])) return (v[2] - v[1]) / behind;
    return isfinite(v[0]) ? (v[1] - v[0]) / before : 0.0;
}

void mpm_affine_start(mpm_body *body, const ab_fill *fill) {
    if (body->rows.affine < 0) return;
    const ab_body_spec *spec = body->domain.spec;
    for (size_t k = 0; k < body->tile_count; ++k) {
        const mpm_tile *tile = body->tiles + k;
        for (uint32_t b = tile->first; tile->patch >= 0 && b < tile->first + tile->blocks; ++b) {
            double *block = mpm_block(body, b), d[3][8]; /* domains are boxes yet: xy is 0 */
            body->kernel->spreads(body, tile, block, d);
            for (size_t l = 0; l < 8; ++l) {
                const uint64_t id = body->ids[b * 8 + l];
                if (id == UINT64_MAX) continue; /* a massless copy: zeros will do */
                const double place[2] = {fill->x[id], fill->y[id]};
                for (int c = 0; c < 4; ++c) {
                    const int along = c % 2;
                    const double slope = slope_of(spec->velocity + c / 2, place, along, sqrt(fill->extent[3 * id + (size_t)along]));
                    block[8 * (body->rows.affine + c) + (int)l] = body->keeps_moment ? slope * d[along][l] : slope;
                }
            }
        }
    }
}

double mpm_affine_inner(const mpm_body *body, size_t slot, double *spin, double *inertia) {
    *spin = *inertia = 0.0;
    if (body->rows.affine < 0) return 0.0;
    const double *block = mpm_block(body, slot / 8), *kept = block + 8 * body->rows.affine + slot % 8;
    double d[3][8], c[4], b[4], inner = 0.0;
    body->kernel->spreads(body, body->tiles + mpm_tile_of_block(body, (uint32_t)(slot / 8)), block, d);
    const double xx = d[0][slot % 8], yy = d[1][slot % 8], xy = d[2][slot % 8], area = xx * yy - xy * xy;
    for (int k = 0; k < 4; k += 2) {
        const double x = kept[8 * k], y = kept[8 * (k + 1)];
        b[k] = c[k] = x, b[k + 1] = c[k + 1] = y;
        if (!body->keeps_moment)
            b[k] = x * xx + y * xy, b[k + 1] = x * xy + y * yy;
        else if (body->kernel->convected)
            c[k] = (x * yy - y * xy) / area, c[k + 1] = (y * xx - x * xy) / area;
        else
            c[k] = x / xx, c[k + 1] = y / yy;
        inner += b[k] * c[k] + b[k + 1] * c[k + 1];
    }
    *spin = b[2] - b[1];
    *inertia = xx + yy;
    return inner;
}
