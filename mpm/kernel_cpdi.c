/* kernel_cpdi.c: the passes over points with convected particle domains, CPDI (Sadeghirad, Brannon and Burghardt 2011): a point's domain is a parallelogram
 * that the deformation carries along, a and b from its middle to the middles of two sides, r <- (I + dt L) r. On it the hat functions are replaced by what is
 * bilinear between their values at the four corners, so that with x_c = x_p -+ a -+ b
 *     N_ip = 1/4 sum_c N_i(x_c),   (a.G_ip, b.G_ip) = half the differences of N_i across the parallelogram.
 * Weights add up to 1 and reproduce places wherever the corners are, beyond sides, too, where nodes are held as those on the side are; no weight is negative, and
 * no gradient is large where the weight is small, |G| <= 4 N/width.
 *
 * A stencil has the 4 x 4 nodes around the point's cell, which reach a cell to every side of the point. Where a domain has grown beyond, the corners that stick out are
 * drawn back along their diagonals until they are inside (corner limiting: Homel, Brannon and Guilkey 2016); a and b themselves go on unlimited. So the body stays
 * joined until points are two cells apart, and every sum above still holds.
 *
 * Weights are no products of one weight per direction, so every pass goes over a table of 16 nodes. Transfers are those of transfer.inc; D of apic is a full tensor.
 *
 * Compiled once more with AXISYMMETRIC, for rings: a domain is the piece of the plane that sweeps the ring, its volume 2 pi r_p times its area, and gradients are means weighted by r. */
#include "mpm/cpdi_weights.h"

/* ---- points to nodes ----------------------------------------------------------------------------------------------------- */

INLINE void scatter_any(mpm_body *body, size_t number, const bool affine) {
    const mpm_tile *tile = body->tiles + number;
    double *patch = body->patches + (size_t)tile->patch * PATCH_DOUBLES;
    const v8 zero = v8_set(0.0);
    for (int i = 0; i < PATCH_NODES; ++i) *(v8 *)(patch + 8 * i) = zero;
    const frame f = frame_of(body, tile);
    const double *block = mpm_block(body, tile->first);
    for (uint32_t number_ = 0; number_ < tile->blocks; ++number_, block += f.stride) {
        mpm_stencils w;
        weigh(&f, block, true, &w);
        const v8 mass = v8_load(block + 8 * ROW_MASS), minus_volume = -v8_load(block + 8 * ROW_VOLUME);
        v8 row[8], to_x[8], to_y[8];
        row[0] = mass;
        row[1] = mass * v8_load(block + 8 * ROW_V);
        row[2] = mass * v8_load(block + 8 * (ROW_V + 1));
#if AXISYMMETRIC
        row[3] = minus_volume * v8_load(block + 8 * (ROW_STRESS + 2)) * inverse_radius_of(&f, block); /* of hoops: NODE_HOOP */
#else
        row[3] = zero;
#endif
        row[4] = minus_volume * v8_load(block + 8 * ROW_STRESS);
        row[5] = row[6] = minus_volume * v8_load(block + 8 * (ROW_STRESS + 3));
        row[7] = minus_volume * v8_load(block + 8 * (ROW_STRESS + 1));
        if (affine) {
            v8 arm[2], kept[4], c[4], d[3];
            arms(&f, block, arm);
            for (int k = 0; k < 4; ++k) c[k] = kept[k] = v8_load(block + 8 * (body->rows.affine + k));
            if (body->keeps_moment) {
                spread(&f, &w, arm, d);
                solve(kept, d, c);
            }
            for (int k = 0; k < 8; ++k) to_x[k] = to_y[k] = zero;
            for (int k = 0; k < 2; ++k) {
                row[1 + k] += mass * (c[2 * k] * arm[0] + c[2 * k + 1] * arm[1]);
                to_x[1 + k] = mass * f.h * c[2 * k];
                to_y[1 + k] = mass * f.h * c[2 * k + 1];
            }
            v8_transpose(to_x);
            v8_transpose(to_y);
        }
        v8_transpose(row);
        for (int l = 0; l < 8; ++l) {
            double *at = patch + 8 * w.node[l];
            UNROLL for (int j = 0; j < NODES; ++j) {
                v8 all = row[l];
                if (affine) all += v8_set((double)j) * to_y[l];
                UNROLL for (int i = 0; i < NODES; ++i) {
                    const int k = j * NODES + i;
                    const double n = w.value[k][l], gx = w.gx[k][l], gy = w.gy[k][l];
                    const v8 weight = {n, n, n, n, gx, gx, gy, gy};
                    double *to = at + 8 * (j * PATCH + i);
                    v8_store(to, v8_load(to) + all * weight);
                    if (affine) all += to_x[l];
                }
            }
        }
    }
}

static void scatter(mpm_body *body, size_t number) { scatter_any(body, number, false); }
static void scatter_affine(mpm_body *body, size_t number) { scatter_any(body, number, true); }

/* Adds momenta of a block's points onto a patch of pairs: N (p + i to_x + j to_y). */
INLINE void give_pairs(double *patch, const mpm_stencils *w, const v8 momentum[2], const bool affine, const v8 to[4]) {
    double p[2][8], step[4][8];
    for (int c = 0; c < 2; ++c) v8_store(p[c], momentum[c]);
    if (affine)
        for (int c = 0; c < 4; ++c) v8_store(step[c], to[c]);
    for (int l = 0; l < 8; ++l) {
        double *at = patch + 2 * w->node[l];
        for (int j = 0; j < NODES; ++j) {
            v2 all = {p[0][l], p[1][l]};
            if (affine) all += (double)j * (v2){step[1][l], step[3][l]};
            for (int i = 0; i < NODES; ++i) {
                double *to_ = at + 2 * (j * PATCH + i);
                v2_store(to_, v2_load(to_) + w->value[j * NODES + i][l] * all);
                if (affine) all += (v2){step[0][l], step[2][l]};
            }
        }
    }
}

/* ---- nodes to points ----------------------------------------------------------------------------------------------------- */

/* Four sums over the nodes of each point: of N times quadruples of nodes. */
INLINE void gather_quadruples(const double *motion, const mpm_stencils *w, v8 sum[4]) {
    v4 point[8];
    for (int l = 0; l < 8; ++l) {
        const double *at = motion + 4 * w->node[l];
        v4 all = {0};
        UNROLL for (int k = 0; k < STENCIL; ++k) all += v4_set(w->value[k][l]) * v4_load(at + 4 * (k / NODES * PATCH + k % NODES));
        point[l] = all;
    }
    v8_transpose_half(point, sum);
}

/* With pairs u in records of `lanes` doubles: sum u_x a, u_y a, u_x b, u_y b over the nodes of each point, a and b tables of weights. */
INLINE void gather_products(const double *records, const int lanes, const mpm_stencils *w, const double a[STENCIL][8],
                            const double b[STENCIL][8], v8 sum[4]) {
    v4 point[8];
    for (int l = 0; l < 8; ++l) {
        const double *at = records + lanes * w->node[l];
        v4 all = {0};
        UNROLL for (int k = 0; k < STENCIL; ++k) {
            const v2 u = v2_load(at + lanes * (k / NODES * PATCH + k % NODES));
            all += (v4){a[k][l], a[k][l], b[k][l], b[k][l]} * __builtin_shufflevector(u, u, 0, 1, 0, 1);
        }
        point[l] = all;
    }
    v8_transpose_half(point, sum);
}

/* The affine part of a block's points: C, what is kept of it, and per kg its spin, twice its energy tr(C D C^T) and its inertia. */
INLINE void gather_affine(const frame *f, const mpm_body *body, const double *motion, mpm_stencils *w, const v8 arm[2], double *block,
                          v8 c[4], v8 *spin, v8 *inner, v8 *inertia) {
    v8 d[3], sum[4], b[4];
    spread(f, w, arm, d);
    if (body->moment) {
        double x[STENCIL][8], y[STENCIL][8];
        UNROLL for (int k = 0; k < STENCIL; ++k) {
            const v8 n = v8_load(w->value[k]);
            v8_store(x[k], n * (arm[0] + v8_set((double)(k % NODES)) * f->h));
            v8_store(y[k], n * (arm[1] + v8_set((double)(k / NODES)) * f->h));
        }
        gather_products(motion, 4, w, (const double(*)[8])x, (const double(*)[8])y, sum);
    } else
        gather_products(motion, 4, w, (const double(*)[8])w->gx, (const double(*)[8])w->gy, sum);
    const v8 got[4] = {sum[0], sum[2], sum[1], sum[3]}; /* xx, xy, yx, yy */
    for (int k = 0; k < 4; ++k) v8_store(block + 8 * (body->rows.affine + k), got[k]);
    for (int k = 0; k < 4; ++k) b[k] = c[k] = got[k];
    if (body->moment)
        solve(got, d, c);
    else
        for (int k = 0; k < 4; k += 2) {
            b[k] = got[k] * d[0] + got[k + 1] * d[2];
            b[k + 1] = got[k] * d[2] + got[k + 1] * d[1];
        }
    *spin = b[2] - b[1];
    *inertia = d[0] + d[1];
    *inner = (b[0] * c[0] + b[1] * c[1]) + (b[2] * c[2] + b[3] * c[3]);
}

INLINE void finish_any(mpm_body *body, size_t number, const ab_step *step, bool remap, mpm_sums *sums, const int way) {
    const bool affine = way == MPM_FINISH_AFFINE, extended = way == MPM_FINISH_EXTENDED;
    double correction[2 * PATCH_NODES + 8] __attribute__((aligned(64)));
    if (extended) mpm_grid_fetch_filter(body, number, FILTER_SUM, correction);
    const mpm_tile *tile = body->tiles + number;
    double motion[4 * PATCH_NODES + 8] __attribute__((aligned(64))); /* velocity, and its change in this step */
    mpm_grid_fetch_motion(body, number, motion);
    double *patch = body->patches + (size_t)tile->patch * PATCH_DOUBLES;
    const v8 zero = v8_set(0.0), dt = v8_set(step->dt), flip = v8_set(body->flip), half = v8_set(0.5);
    const bool blend = way == MPM_FINISH_BLEND && body->flip != 1.0, weight = body->gravity;
    const v8 gx = v8_set(weight ? -step->gravity[0] * step->dt : 0.0), gy = v8_set(weight ? -step->gravity[1] * step->dt : 0.0);
    if (remap) memset(patch, 0, 2 * PATCH_NODES * sizeof *patch);
    v8 kinetic = zero, mx = zero, my = zero, angular = zero, fx = zero, fy = zero, potential = zero, total = zero, speed2 = zero;
    v8 own_inertia = zero;
    v8 low[2] = {v8_set(1e300), v8_set(1e300)}, high[2] = {v8_set(-1e300), v8_set(-1e300)};
    const frame f = frame_of(body, tile);
    double *block = mpm_block(body, tile->first);
    for (uint32_t b = 0; b < tile->blocks; ++b, block += f.stride) {
        mpm_stencils w;
        weigh(&f, block, affine, &w);
        v8 got[4], v[2], next[2], middle[2], arm[2], slope[4], to[4], spin = zero, inner = zero, inertia = zero, more[4];
        gather_quadruples(motion, &w, got);
        if (affine) {
            arms(&f, block, arm);
            gather_affine(&f, body, motion, &w, arm, block, slope, &spin, &inner, &inertia);
        }
        if (extended) gather_products(correction, 2, &w, (const double(*)[8])w.value, (const double(*)[8])w.value, more);
        const v8 mass = v8_load(block + 8 * ROW_MASS);
        UNROLL for (int c = 0; c < 2; ++c) {
            const v8 vc = got[c], dc = got[2 + c];
            v[c] = affine ? vc : v8_load(block + 8 * (ROW_V + c)) + dc;
            if (blend) v[c] = vc + flip * (v[c] - vc);
            if (extended) v[c] = vc + more[c];
            next[c] = v8_load(block + 8 * (ROW_X + c)) + dt * vc;
            middle[c] = vc - half * dc;
            v8_store(block + 8 * (ROW_V + c), v[c]);
            v8_store(block + 8 * (ROW_NEXT + c), next[c]);
            low[c] = v8_min(low[c], next[c]);
            high[c] = v8_max(high[c], next[c]);
        }
        v8 p[2] = {mass * v[0], mass * v[1]};
        const v8 vv = v[0] * v[0] + v[1] * v[1];
        kinetic += affine ? mass * (vv + inner) : mass * vv;
        if (affine) own_inertia += mass * inertia;
        speed2 = v8_max(speed2, vv);
        mx += p[0];
        my += p[1];
        angular += affine ? next[0] * p[1] - next[1] * p[0] + mass * spin : next[0] * p[1] - next[1] * p[0];
        fx += mass * next[0];
        fy += mass * next[1];
        total += mass;
        potential += mass * (gx * middle[0] + gy * middle[1]);
        if (!remap) continue;
        if (affine)
            for (int c = 0; c < 2; ++c) {
                p[c] += mass * (slope[2 * c] * arm[0] + slope[2 * c + 1] * arm[1]);
                for (int k = 0; k < 2; ++k) to[2 * c + k] = mass * f.h * slope[2 * c + k];
            }
        give_pairs(patch, &w, p, affine, to);
    }
    sums->mass = v8_sum(total);
    sums->kinetic = 0.5 * v8_sum(kinetic);
    sums->momentum[0] = v8_sum(mx);
    sums->momentum[1] = v8_sum(my);
    sums->angular = v8_sum(angular);
    sums->own_inertia = affine ? v8_sum(own_inertia) : 0.0;
    sums->first[0] = v8_sum(fx);
    sums->first[1] = v8_sum(fy);
    sums->potential = v8_sum(potential);
    sums->speed2 = v8_highest(speed2);
    for (int c = 0; c < 2; ++c) {
        sums->low[c] = v8_lowest(low[c]);
        sums->high[c] = v8_highest(high[c]);
        sums->begin[c] = floor(sums->low[c] * body->inverse_h - ROUNDING) - 1.0;
        sums->end[c] = floor(sums->high[c] * body->inverse_h + ROUNDING) - 1.0;
    }
}

static void finish(mpm_body *body, size_t number, const ab_step *step, bool remap, mpm_sums *sums) {
    finish_any(body, number, step, remap, sums, MPM_FINISH_BLEND);
}
static void finish_affine(mpm_body *body, size_t number, const ab_step *step, bool remap, mpm_sums *sums) {
    finish_any(body, number, step, remap, sums, MPM_FINISH_AFFINE);
}
static void finish_extended(mpm_body *body, size_t number, const ab_step *step, bool remap, mpm_sums *sums) {
    finish_any(body, number, step, remap, sums, MPM_FINISH_EXTENDED);
}

/* What the filter still holds at the nodes, to the points and back: sum_p N_i m_p sum_j N_j r_j onto the patch (pairs). */
static void filter(mpm_body *body, size_t number) {
    const mpm_tile *tile = body->tiles + number;
    double rest[2 * PATCH_NODES + 8] __attribute__((aligned(64)));
    mpm_grid_fetch_filter(body, number, FILTER_REST, rest);
    double *patch = body->patches + (size_t)tile->patch * PATCH_DOUBLES;
    memset(patch, 0, 2 * PATCH_NODES * sizeof *patch);
    const frame f = frame_of(body, tile);
    const double *block = mpm_block(body, tile->first);
    for (uint32_t b = 0; b < tile->blocks; ++b, block += f.stride) {
        mpm_stencils w;
        v8 sum[4];
        weigh(&f, block, false, &w);
        gather_products(rest, 2, &w, (const double(*)[8])w.value, (const double(*)[8])w.value, sum);
        const v8 mass = v8_load(block + 8 * ROW_MASS), p[2] = {mass * sum[0], mass * sum[1]};
        give_pairs(patch, &w, p, false, NULL);
    }
}

/* ---- strain and stress --------------------------------------------------------------------------------------------------- */

/* a and b of a block to the end of the step. */
INLINE void convect(double *r, const double h[STRAINS][LONG], uint32_t b) {
    const size_t at = 8 * (size_t)b;
    for (int k = 0; k < 4; k += 2) {
        const v8 x = v8_load(r + 8 * k), y = v8_load(r + 8 * (k + 1));
        v8_store(r + 8 * k, x + v8_load(h[0] + at) * x + v8_load(h[1] + at) * y);
        v8_store(r + 8 * (k + 1), y + v8_load(h[2] + at) * x + v8_load(h[3] + at) * y);
    }
}

/* Displacement gradient of the step, H = dt grad v, of `blocks` blocks: rows of LONG doubles (xx, xy, yx, yy, and of hoops). */
INLINE void gradients(const frame *f, bool from_end, const double *velocity, double dt_, const double *block, uint32_t blocks,
                      double h[STRAINS][LONG]) {
    const v8 dt = v8_set(dt_);
    for (uint32_t b = 0; b < blocks; ++b, block += f->stride) {
        mpm_stencils w;
        v8 sum[4];
        weigh(f, block, true, &w);
        gather_products(velocity, 2, &w, (const double(*)[8])w.gx, (const double(*)[8])w.gy, sum);
        v8_store(h[0] + 8 * b, dt * sum[0]);
        v8_store(h[1] + 8 * b, dt * sum[2]);
        v8_store(h[2] + 8 * b, dt * sum[1]);
        v8_store(h[3] + 8 * b, dt * sum[3]);
#if AXISYMMETRIC
        gather_products(velocity, 2, &w, (const double(*)[8])w.value, (const double(*)[8])w.value, sum);
        v8_store(h[4] + 8 * b, dt * sum[0] * inverse_radius_of(f, block));
#endif
    }
    if (from_end) mpm_seen_from_end(h, blocks, AXISYMMETRIC);
}

/* f_bar: V d and V of a tile's points by cells onto its patch, d the change of volume in the step by the nodes' velocities. */
static void dilate(mpm_body *body, size_t number, const ab_step *step) {
    const mpm_tile *tile = body->tiles + number;
    const frame f = frame_of(body, tile);
    double velocity[2 * PATCH_NODES + 8] __attribute__((aligned(64))), h[STRAINS][LONG] __attribute__((aligned(64)));
    mpm_grid_fetch_velocity(body, number, velocity);
    double *patch = mpm_cells_open(body, tile);
    for (uint32_t begin = 0; begin < tile->blocks; begin += LONG / 8) {
        const uint32_t left = tile->blocks - begin, blocks = left < LONG / 8 ? left : LONG / 8;
        const double *block = mpm_block(body, tile->first + begin);
        gradients(&f, body->from_end, velocity, step->dt, block, blocks, h);
        for (uint32_t b = 0; b < blocks; ++b, block += f.stride)
            mpm_cells_add(body, tile, block, mpm_dilatation((const double(*)[LONG])h, b, AXISYMMETRIC), patch);
    }
}

static int stress(mpm_body *body, size_t number, const ab_step *step, bool advance, mpm_sums *sums) {
    const mpm_tile *tile = body->tiles + number;
    const mpm_rows rows = body->rows;
    const frame f = frame_of(body, tile);
    double velocity[2 * PATCH_NODES + 8] __attribute__((aligned(64)));
    mpm_grid_fetch_velocity(body, number, velocity);
    double h[STRAINS][LONG] __attribute__((aligned(64)));
    double means[2 * PATCH_NODES + 8] __attribute__((aligned(64)));
    if (body->f_bar) mpm_volumetric_fetch(body, number, means);
    mpm_long_batch batch;
    mpm_batch_open(&batch, body, step);
    v8 strain_work = v8_set(0.0), plastic_work = v8_set(0.0), fastest = v8_set(0.0);
    for (uint32_t begin = 0; begin < tile->blocks; begin += LONG / 8) {
        const uint32_t left = tile->blocks - begin, blocks = left < LONG / 8 ? left : LONG / 8;
        double *block = mpm_block(body, tile->first + begin);
        gradients(&f, body->from_end, velocity, step->dt, block, blocks, h);
        if (body->f_bar) mpm_average_dilatation(body, tile, means, block, blocks, h, AXISYMMETRIC);
        for (uint32_t b = 0; b < blocks; ++b)
            mpm_batch_strain(&batch, rows, block + b * f.stride, (const double(*)[LONG])h, b, AXISYMMETRIC);
        if (mpm_batch_call(&batch, body, 8 * blocks) != 0) return (int)(tile->first + begin);
        for (uint32_t b = 0; b < blocks; ++b, block += f.stride) {
            mpm_batch_settle(&batch, rows, block, b, &strain_work, &plastic_work, &fastest, AXISYMMETRIC);
            convect(block + 8 * rows.corners, (const double(*)[LONG])h, b);
            if (rows.extent >= 0) mpm_stretch_extent(block + 8 * rows.extent, (const double(*)[LONG])h, b);
            if (advance)
                for (int c = 0; c < 2; ++c) v8_store(block + 8 * (ROW_X + c), v8_load(block + 8 * (ROW_NEXT + c)));
        }
    }
    sums->wave_speed = v8_highest(fastest);
    sums->plastic = v8_sum(plastic_work);
    sums->strain = v8_sum(strain_work) - sums->plastic;
    return -1;
}

#if AXISYMMETRIC
#define KERNEL mpm_kernel_cpdi_axisymmetric
#else
#define KERNEL mpm_kernel_cpdi
#endif
extern const mpm_kernel KERNEL;
const mpm_kernel KERNEL = {.basis = "cpdi",
                           .nodes = NODES,
                           .patch = PATCH,
                           .reach = 2.0,
                           .light = AXISYMMETRIC ? 0 : 0.07, /* with 0.05 blocks on points of the surface quiver at rest, by 1e-3 of the wave speed */
                           .convected = true,
                           .moment = true,
                           .courant = {1.000, 0.907, 0.785, 0.688, 0.621, 0.573, 0.535, 0.496},
                           .first = first,
                           .stencils = stencils,
                           .spreads = spreads,
                           .carry = carry,
                           .scatter = {scatter, scatter_affine},
                           .finish = {finish, finish_affine, finish_extended},
                           .filter = filter,
                           .dilate = dilate,
                           .stress = stress};
