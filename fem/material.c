/* material.c: a body's material at its Gauss points: instance and tangent at the start, and the batch that a group of blocks makes. */
#include "fem/domain.h"

#include <math.h>
#include <string.h>

#include "core/strain.h"

ab_status fem_material_create(fem_body *body, ab_report *report) {
    AB_TRY(ab_material_open(body->material, &body->service, &body->self, &body->start, report));
    body->elastic.density = body->material->density;
    AB_TRY(ab_material_tangent(body->material, &body->service, body->self, &body->start, &body->elastic.lambda, &body->elastic.mu, report));
    const ab_class *class_ = &body->material->loaded->class_;
    fem_rows rows = {
        .count = FEM_ROW_OTHERS, .gradient = -1, .state = -1, .states = ab_state_count(class_), .turns = ab_state_turns(class_)};
    if (class_->needs & AB_NEED_DEFORMATION_GRADIENT) rows.gradient = rows.count, rows.count += body->element->axisymmetric ? 5 : 4;
    if (rows.states) rows.state = rows.count, rows.count += rows.states;
    body->rows = rows;
    return AB_OK;
}

void fem_batch_open(fem_batch *batch, const fem_body *body, const ab_step *step) {
    const ab_class *class_ = &body->material->loaded->class_;
    batch->view =
        (ab_batch){.struct_size = sizeof(ab_batch), .dimension = 2, .components = 4, .ld = FEM_BATCH, .time = step->time, .dt = step->dt};
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
    memset(batch->strain[2], 0, sizeof batch->strain[2]); /* plane strain; rings write theirs */
    memset(batch->flag, 0, sizeof batch->flag);
}

static inline __attribute__((always_inline)) void batch_strain(fem_batch *batch, const fem_body *body, size_t number,
                                                               const fem_block *block, size_t at, const bool rings) {
    const fem_rows rows = body->rows;
    const v8 one = v8_set(1.0);
    for (int q = 0; q < body->element->gauss; ++q, at += 8) {
        double *point = fem_gauss_rows(body, number, q);
        const v8 hxx = v8_load(block->h[q][0]), hxy = v8_load(block->h[q][1]), hyx = v8_load(block->h[q][2]), hyy = v8_load(block->h[q][3]);
        ab_increment increment = ab_strain_increment(hxx, hxy, hyx, hyy);
        ab_turn_increment(&increment);
        const v8 hoop = rings ? v8_load(block->hoop[q]) : v8_set(0.0);
        if (rings) v8_store(batch->strain[2] + at, ab_hoop_strain(hoop));
        v8_store(batch->strain[0] + at, increment.xx);
        v8_store(batch->strain[1] + at, increment.yy);
        v8_store(batch->strain[3] + at, increment.xy);
        v8 xx = v8_load(block->stress[q][0]), yy = v8_load(block->stress[q][1]), xy = v8_load(block->stress[q][3]);
        ab_turn_stress(increment.cosine, increment.sine, &xx, &yy, &xy);
        v8_store(batch->turned[0] + at, xx);
        v8_store(batch->turned[1] + at, yy);
        v8_store(batch->turned[2] + at, v8_load(block->stress[q][2]));
        v8_store(batch->turned[3] + at, xy);
        if (batch->view.density) v8_store(batch->density + at, v8_load(point + 8 * FEM_ROW_MASS) / v8_load(block->volume[q]));
        if (rows.gradient >= 0) {
            v8 moved[4];
            ab_move_gradient(hxx, hxy, hyx, hyy, point + 8 * rows.gradient, moved);
            for (int c = 0; c < 4; ++c) v8_store(batch->gradient[c] + at, moved[c]);
            v8_store(batch->gradient[4] + at, rings ? ab_move_hoop(hoop, point + 8 * (rows.gradient + 4)) : one);
        }
        if (batch->view.velocity_gradient) {
            const v8 rate = v8_set(1.0 / batch->view.dt);
            for (int c = 0; c < 4; ++c) v8_store(batch->spatial[c] + at, v8_load(block->h[q][c]) * rate);
        }
        if (rows.states) {
            double turned[AB_MATERIAL_STATES][8] __attribute__((aligned(64)));
            const double *state = point + 8 * rows.state;
            if (rows.turns) { /* vectors and tensors turn with the material before it sees them */
                ab_state_turn(&body->material->loaded->class_, state, increment.cosine, increment.sine, turned[0]);
                state = turned[0];
            }
            for (int s = 0; s < rows.states; ++s) v8_store(batch->state0[s] + at, v8_load(state + 8 * s));
        }
    }
}

void fem_batch_strain(fem_batch *batch, const fem_body *body, size_t number, const fem_block *block, size_t at) {
    if (body->element->axisymmetric)
        batch_strain(batch, body, number, block, at, true);
    else
        batch_strain(batch, body, number, block, at, false);
}

int fem_batch_call(fem_batch *batch, const fem_body *body, size_t count) {
    batch->view.count = count;
    return body->material->loaded->material.update(body->self, &batch->view);
}

/* 1 for lanes of elements, 0 for the copies that fill the last block up. */
static v8 real_lanes(const fem_body *body, size_t number) {
    const int lanes = fem_lanes(body, number);
    v8 real;
    for (int l = 0; l < 8; ++l) real[l] = l < lanes ? 1.0 : 0.0;
    return real;
}

static inline __attribute__((always_inline)) void batch_settle(const fem_batch *batch, const fem_body *body, size_t number,
                                                               fem_block *block, size_t at, fem_sums *sums, const bool rings) {
    const fem_rows rows = body->rows;
    const v8 zero = v8_set(0.0);
    v8 work = v8_load(block->control_work), first = v8_load(block->control_first), plastic = zero, travelled = zero, stiffest = zero;
    for (int q = 0; q < body->element->gauss; ++q, at += 8) {
        double *point = fem_gauss_rows(body, number, q);
        const v8 volume0 = v8_load(block->volume0[q]), volume = v8_load(block->volume[q]);
        v8 both = zero, old = zero;
        for (int c = 0; c < 4; ++c) {
            const v8 stress = v8_load(batch->stress[c] + at);
            if (c != 2 || rings) {
                const v8 strain = v8_load(batch->strain[c] + at), turned = v8_load(batch->turned[c] + at);
                both += (turned + stress) * strain;
                old += turned * strain;
                travelled = v8_max(travelled, v8_max(strain, -strain));
            }
            v8_store(point + 8 * (FEM_ROW_STRESS + c), stress);
            v8_store(block->stress[q][c], stress);
        }
        work += v8_set(0.25) * (volume0 + volume) * both;
        first += v8_set(0.5) * (volume0 + volume) * old;
        if (batch->view.dissipation) plastic += volume * v8_load(batch->dissipation + at);
        if (batch->view.wave_speed) {
            const v8 speed = v8_load(batch->wave_speed + at);
            stiffest = v8_max(stiffest, v8_load(batch->density + at) * speed * speed);
        }
        for (int s = 0; s < rows.states; ++s) v8_store(point + 8 * (rows.state + s), v8_load(batch->state1[s] + at));
    }
    const v8 real = real_lanes(body, number);
    sums->work += v8_sum(real * work);
    sums->first_work += v8_sum(real * first);
    sums->plastic += v8_sum(real * plastic);
    body->stretch[number] += v8_highest(travelled);
    if (batch->view.wave_speed)
        body->stiffening[number] = v8_highest(stiffest) / (body->elastic.density * body->start.wave_speed * body->start.wave_speed);
}

void fem_batch_settle(const fem_batch *batch, const fem_body *body, size_t number, fem_block *block, size_t at, fem_sums *sums) {
    if (body->element->axisymmetric)
        batch_settle(batch, body, number, block, at, sums, true);
    else
        batch_settle(batch, body, number, block, at, sums, false);
}
