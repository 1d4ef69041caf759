/* material.c: a body's material: its plugin's instance, its start, and how its states turn with the material. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mpm/body.h"

int mpm_state_components(uint32_t shape) { return shape == AB_VECTOR ? 2 : shape == AB_SYMMETRIC ? 4 : shape == AB_FULL ? 5 : 1; }

void mpm_turn_state(const ab_class *class_, const double *state, v8 cosine, v8 sine, double *turned) {
    const v8 cc = cosine * cosine, ss = sine * sine, cs = cosine * sine;
    for (uint32_t k = 0; k < class_->nstate; ++k) {
        const uint32_t shape = class_->state[k].shape;
        const int n = mpm_state_components(shape);
        v8 a[5] = {{0}};
        for (int c = 0; c < n; ++c) a[c] = v8_load(state + 8 * c);
        if (shape == AB_VECTOR) { /* Q a */
            const v8 x = a[0], y = a[1];
            a[0] = cosine * x - sine * y;
            a[1] = sine * x + cosine * y;
        } else if (shape == AB_SYMMETRIC) { /* Q a Q^T; xx, yy, zz, xy */
            const v8 xx = a[0], yy = a[1], xy = a[3];
            a[0] = cc * xx + ss * yy - (cs + cs) * xy;
            a[1] = ss * xx + cc * yy + (cs + cs) * xy;
            a[3] = cs * (xx - yy) + (cc - ss) * xy;
        } else if (shape == AB_FULL) { /* Q a Q^T; xx, xy, yx, yy, zz */
            const v8 xx = a[0], xy = a[1], yx = a[2], yy = a[3];
            a[0] = cc * xx + ss * yy - cs * (xy + yx);
            a[1] = cc * xy - ss * yx + cs * (xx - yy);
            a[2] = cc * yx - ss * xy + cs * (xx - yy);
            a[3] = ss * xx + cc * yy + cs * (xy + yx);
        }
        for (int c = 0; c < n; ++c) v8_store(turned + 8 * c, a[c]);
        state += 8 * n;
        turned += 8 * n;
    }
}

/* Before the first step: initial states, initial stress where it has one, wave speed. */
ab_status mpm_material_start(mpm_body *body, ab_report *report) {
    const ab_loaded_class *loaded = body->material->loaded;
    char who[96];
    snprintf(who, sizeof who, "material '%s' (%s)", body->material->name, loaded->class_.name);
    ab_service_init(&body->service, who);
    if (loaded->class_.create && loaded->class_.create(&body->service.host, body->material->settings, &body->self) != 0)
        return ab_report_error(report, body->material->mark, "material '%s' refused its settings: %s", body->material->name,
                               body->service.message[0] ? body->service.message : "no reason given");
    const mpm_rows rows = body->rows;
    double zero[9][8] __attribute__((aligned(64))) = {{0}}, unit[5][8] __attribute__((aligned(64))) = {{0}}, density[8], speed[8],
                      dissipation[8];
    double stress1[4][8] __attribute__((aligned(64))), state0[MAX_STATE][8] __attribute__((aligned(64))),
        state1[MAX_STATE][8] __attribute__((aligned(64)));
    for (int l = 0; l < 8; ++l) {
        density[l] = body->material->density;
        speed[l] = 0.0;
        unit[0][l] = unit[3][l] = unit[4][l] = 1.0;
    }
    int row = 0;
    for (uint32_t s = 0; s < loaded->class_.nstate; ++s) {
        const uint32_t shape = loaded->class_.state[s].shape;
        const int components = mpm_state_components(shape);
        for (int c = 0; c < components; ++c, ++row)
            for (int l = 0; l < 8; ++l) state0[row][l] = state1[row][l] = loaded->class_.state[s].initial;
    }
    memset(stress1, 0, sizeof stress1);
    uint8_t flag[8] = {0};
    ab_batch batch = {.struct_size = sizeof batch,
                      .dimension = 2,
                      .components = 4,
                      .count = 8,
                      .ld = 8,
                      .density = density,
                      .strain_increment = zero[0],
                      .deformation_gradient = unit[0],
                      .velocity_gradient = zero[4],
                      .stress0 = zero[0],
                      .stress1 = stress1[0],
                      .state0 = rows.states ? state0[0] : NULL,
                      .state1 = rows.states ? state1[0] : NULL,
                      .dissipation = (loaded->class_.gives & AB_GIVE_DISSIPATION) ? dissipation : NULL,
                      .wave_speed = speed,
                      .flag = flag};
    int (*call)(void *, ab_batch *) = loaded->material.start ? loaded->material.start : loaded->material.update;
    const int code = call(body->self, &batch);
    const char *what = loaded->material.start ? "start" : "update", *name = body->material->name, *why = body->service.message;
    if (code != 0)
        return ab_report_error(report, body->material->mark, "material '%s' (%s) could not start: its %s returned %d and gave %s%s", name,
                               loaded->class_.name, what, code, why[0] ? "the reason: " : "no reason", why);
    if (!(speed[0] > 0.0) || !isfinite(speed[0]))
        return ab_report_error(report, body->material->mark,
                               "material '%s' (%s) could not start: its %s must set a wave speed above 0 when asked for it, and set %g m/s",
                               name, loaded->class_.name, what, speed[0]);
    body->wave_speed = speed[0];
    body->modulus = speed[0] * speed[0] * body->material->density;
    for (size_t b = 0; b < body->block_count; ++b) {
        double *block = mpm_block(body, b);
        for (int c = 0; c < 4; ++c) memcpy(block + 8 * (ROW_STRESS + c), stress1[c], 8 * sizeof(double));
        for (int s = 0; s < rows.states; ++s) memcpy(block + 8 * (rows.state + s), state1[s], 8 * sizeof(double));
    }
    return AB_OK;
}
