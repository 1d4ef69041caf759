/* batch.h: strain and the material's batch, the same for every basis: what stands between the gradients of eight blocks of points and
 * their new stress. Included by the kernels, so that it is compiled into their loops; `axisymmetric` is a constant there: with it h has a fifth row, the hoop
 * part u_r/r of the step, and component zz is the hoop's. */
#ifndef AB_MPM_BATCH_H
#define AB_MPM_BATCH_H

#include "core/strain.h"
#include "mpm/body.h"

enum { LONG = 64 }; /* points in a batch: rows of a batch have this length */

typedef struct mpm_long_batch {
    ab_batch view;
    bool turns;
    const ab_class *class_;
    double strain[4][LONG] __attribute__((aligned(64)));
    double turned[4][LONG] __attribute__((aligned(64))); /* old stress, turned with the material */
    double stress[4][LONG] __attribute__((aligned(64)));
    double jacobian[LONG] __attribute__((aligned(64)));
    double gradient[5][LONG] __attribute__((aligned(64)));
    double spatial[4][LONG] __attribute__((aligned(64)));
    double density[LONG] __attribute__((aligned(64)));
    double dissipation[LONG] __attribute__((aligned(64)));
    double wave_speed[LONG] __attribute__((aligned(64)));
    double state0[AB_MATERIAL_STATES][LONG] __attribute__((aligned(64)));
    double state1[AB_MATERIAL_STATES][LONG] __attribute__((aligned(64)));
    uint8_t flag[LONG];
} mpm_long_batch;

/* H of a half step seen from its end, A = dt/2 grad v there: I + H = (I - A)^-1. A half step that ends here and one that begins here, I + A, make together exactly the
 * turn of a body that turns; twice I + A would let it swell by half of the angle squared in each step. */
static inline __attribute__((always_inline)) void mpm_seen_from_end(double (*h)[LONG], uint32_t blocks, const bool axisymmetric) {
    const v8 one = v8_set(1.0);
    for (size_t at = 0; at < 8 * (size_t)blocks; at += 8) {
        const v8 xx = v8_load(h[0] + at), xy = v8_load(h[1] + at), yx = v8_load(h[2] + at), yy = v8_load(h[3] + at);
        const v8 area = xx * yy - xy * yx, inverse = one / (one - xx - yy + area);
        v8_store(h[0] + at, (xx - area) * inverse);
        v8_store(h[1] + at, xy * inverse);
        v8_store(h[2] + at, yx * inverse);
        v8_store(h[3] + at, (yy - area) * inverse);
        if (axisymmetric) v8_store(h[4] + at, v8_load(h[4] + at) / (one - v8_load(h[4] + at)));
    }
}

static inline void mpm_batch_open(mpm_long_batch *batch, const mpm_body *body, const ab_step *step) {
    const ab_class *class_ = &body->material->loaded->class_;
    batch->class_ = class_;
    batch->turns = body->rows.turns;
    batch->view =
        (ab_batch){.struct_size = sizeof(ab_batch), .dimension = 2, .components = 4, .ld = LONG, .time = step->time, .dt = step->dt};
    ab_batch *v = &batch->view;
    v->strain_increment = batch->strain[0];
    v->stress0 = batch->turned[0];
    v->stress1 = batch->stress[0];
    v->flag = batch->flag;
    if ((class_->needs & AB_NEED_DENSITY) || body->ask_wave_speed) v->density = batch->density;
    if (class_->needs & AB_NEED_DEFORMATION_GRADIENT) v->deformation_gradient = batch->gradient[0];
    if (class_->needs & AB_NEED_VELOCITY_GRADIENT) v->velocity_gradient = batch->spatial[0];
    if (class_->gives & AB_GIVE_DISSIPATION) v->dissipation = batch->dissipation;
    if (body->ask_wave_speed) v->wave_speed = batch->wave_speed;
    if (body->rows.states) v->state0 = batch->state0[0], v->state1 = batch->state1[0];
    for (int l = 0; l < LONG; l += 8) v8_store(batch->strain[2] + l, v8_set(0.0)); /* plane strain */
    for (int l = 0; l < LONG; ++l) batch->flag[l] = 0;
}

/* Block b of the batch: strain increment and turned stress. Deformation gradients of the points move on to the end of the step. */
static inline __attribute__((always_inline)) void mpm_batch_strain(mpm_long_batch *batch, mpm_rows rows, double *block,
                                                                   const double (*h)[LONG], uint32_t b, const bool axisymmetric) {
    const size_t at = 8 * (size_t)b;
    const v8 one = v8_set(1.0);
    const v8 hxx = v8_load(h[0] + at), hxy = v8_load(h[1] + at), hyx = v8_load(h[2] + at), hyy = v8_load(h[3] + at);
    ab_increment increment = ab_strain_increment(hxx, hxy, hyx, hyy);
    const v8 hoop = axisymmetric ? v8_load(h[4] + at) : v8_set(0.0);
    if (axisymmetric) {
        v8_store(batch->strain[2] + at, ab_hoop_strain(hoop));
        increment.jacobian *= one + hoop;
    }
    v8_store(batch->strain[0] + at, increment.xx);
    v8_store(batch->strain[1] + at, increment.yy);
    v8_store(batch->strain[3] + at, increment.xy);
    v8_store(batch->jacobian + at, increment.jacobian);
    v8 sxx = v8_load(block + 8 * ROW_STRESS), syy = v8_load(block + 8 * (ROW_STRESS + 1)), sxy = v8_load(block + 8 * (ROW_STRESS + 3));
    ab_turn_stress(increment.cosine, increment.sine, &sxx, &syy, &sxy);
    v8_store(batch->turned[0] + at, sxx);
    v8_store(batch->turned[1] + at, syy);
    v8_store(batch->turned[2] + at, v8_load(block + 8 * (ROW_STRESS + 2)));
    v8_store(batch->turned[3] + at, sxy);
    if (batch->view.density) {
        const v8 volume = v8_load(block + 8 * ROW_VOLUME) * increment.jacobian;
        v8_store(batch->density + at, v8_load(block + 8 * ROW_MASS) / v8_less(v8_set(0.0), volume, volume, one));
    }
    if (rows.gradient >= 0) {
        v8 moved[4];
        ab_move_gradient(hxx, hxy, hyx, hyy, block + 8 * rows.gradient, moved);
        for (int c = 0; c < 4; ++c) v8_store(batch->gradient[c] + at, moved[c]);
        v8_store(batch->gradient[4] + at, axisymmetric ? ab_move_hoop(hoop, block + 8 * (rows.gradient + 4)) : one);
    }
    if (batch->view.velocity_gradient) {
        const v8 rate = v8_set(1.0 / batch->view.dt);
        for (int c = 0; c < 4; ++c) v8_store(batch->spatial[c] + at, v8_load(h[c] + at) * rate);
    }
    if (rows.states) {
        double turned[AB_MATERIAL_STATES][8] __attribute__((aligned(64)));
        const double *state = block + 8 * rows.state;
        if (batch->turns) { /* vectors and tensors turn with the material before it sees them */
            ab_state_turn(batch->class_, state, increment.cosine, increment.sine, turned[0]);
            state = turned[0];
        }
        for (int s = 0; s < rows.states; ++s) v8_store(batch->state0[s] + at, v8_load(state + 8 * s));
    }
}

/* The material's answer for `count` points; not 0: it gave up. */
static inline int mpm_batch_call(mpm_long_batch *batch, const mpm_body *body, size_t count) {
    batch->view.count = count;
    return body->material->loaded->material.update(body->self, &batch->view);
}

/* Block b: new stress, states and volume; work of the step. */
static inline __attribute__((always_inline)) void mpm_batch_settle(const mpm_long_batch *batch, mpm_rows rows, double *block, uint32_t b,
                                                                   v8 *strain_work, v8 *plastic_work, v8 *fastest,
                                                                   const bool axisymmetric) {
    const size_t at = 8 * (size_t)b;
    const v8 volume0 = v8_load(block + 8 * ROW_VOLUME), volume = volume0 * v8_load(batch->jacobian + at);
    v8 work = v8_set(0.0);
    for (int c = 0; c < 4; ++c) {
        const v8 stress = v8_load(batch->stress[c] + at);
        if (c != 2 || axisymmetric) work += (v8_load(batch->turned[c] + at) + stress) * v8_load(batch->strain[c] + at);
        v8_store(block + 8 * (ROW_STRESS + c), stress);
    }
    *strain_work += v8_set(0.25) * (volume0 + volume) * work;
    v8_store(block + 8 * ROW_VOLUME, volume);
    if (batch->view.dissipation) *plastic_work += volume * v8_load(batch->dissipation + at);
    if (batch->view.wave_speed) *fastest = v8_max(*fastest, v8_less(v8_set(0.0), volume, v8_load(batch->wave_speed + at), v8_set(0.0)));
    for (int s = 0; s < rows.states; ++s) v8_store(block + 8 * (rows.state + s), v8_load(batch->state1[s] + at));
}

/* A' = (I + H) A (I + H)^T for the domain tensor (xx, yy, xy) of block b. */
static inline __attribute__((always_inline)) void mpm_stretch_extent(double *e, const double (*h)[LONG], uint32_t b) {
    const size_t at = 8 * (size_t)b;
    const v8 fxx = v8_set(1.0) + v8_load(h[0] + at), fxy = v8_load(h[1] + at), fyx = v8_load(h[2] + at),
             fyy = v8_set(1.0) + v8_load(h[3] + at);
    const v8 axx = v8_load(e), ayy = v8_load(e + 8), axy = v8_load(e + 16);
    const v8 bxx = fxx * axx + fxy * axy, bxy = fxx * axy + fxy * ayy, byx = fyx * axx + fyy * axy, byy = fyx * axy + fyy * ayy;
    v8_store(e, bxx * fxx + bxy * fxy);
    v8_store(e + 8, byx * fyx + byy * fyy);
    v8_store(e + 16, bxx * fyx + bxy * fyy);
}

#endif
