/* material.c: what every method does alike with a material: its plugin's instance, its start, how its states turn, and its tangent at the start. */
#include "core/material.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

int ab_state_components(uint32_t shape) { return shape == AB_VECTOR ? 2 : shape == AB_SYMMETRIC ? 4 : shape == AB_FULL ? 5 : 1; }

int ab_state_count(const ab_class *class_) {
    int count = 0;
    for (uint32_t s = 0; s < class_->nstate; ++s) count += ab_state_components(class_->state[s].shape);
    return count;
}

bool ab_state_turns(const ab_class *class_) {
    for (uint32_t s = 0; s < class_->nstate; ++s)
        if (class_->state[s].shape != AB_SCALAR) return true;
    return false;
}

void ab_state_turn(const ab_class *class_, const double *state, v8 cosine, v8 sine, double *turned) {
    const v8 cc = cosine * cosine, ss = sine * sine, cs = cosine * sine;
    for (uint32_t k = 0; k < class_->nstate; ++k) {
        const uint32_t shape = class_->state[k].shape;
        const int n = ab_state_components(shape);
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

/* Eight points in one batch, with whatever a class may ask for. */
typedef struct small_batch {
    double strain[4][8], gradient[5][8], spatial[4][8], density[8], speed[8], dissipation[8];
    double stress0[4][8], stress1[4][8], state0[AB_MATERIAL_STATES][8], state1[AB_MATERIAL_STATES][8];
    uint8_t flag[8];
    ab_batch view;
} __attribute__((aligned(64))) small_batch;

static void open_batch(small_batch *b, const ab_material_spec *material) {
    const ab_class *class_ = &material->loaded->class_;
    memset(b, 0, sizeof *b);
    for (int l = 0; l < 8; ++l) {
        b->density[l] = material->density;
        b->gradient[0][l] = b->gradient[3][l] = b->gradient[4][l] = 1.0;
    }
    b->view = (ab_batch){.struct_size = sizeof b->view,
                         .dimension = 2,
                         .components = 4,
                         .count = 8,
                         .ld = 8,
                         .density = b->density,
                         .strain_increment = b->strain[0],
                         .deformation_gradient = b->gradient[0],
                         .velocity_gradient = b->spatial[0],
                         .stress0 = b->stress0[0],
                         .stress1 = b->stress1[0],
                         .state0 = class_->nstate ? b->state0[0] : NULL,
                         .state1 = class_->nstate ? b->state1[0] : NULL,
                         .dissipation = (class_->gives & AB_GIVE_DISSIPATION) ? b->dissipation : NULL,
                         .wave_speed = b->speed,
                         .flag = b->flag};
}

ab_status ab_material_open(const ab_material_spec *material, ab_service *service, void **self, ab_material_start *start,
                           ab_report *report) {
    const ab_loaded_class *loaded = material->loaded;
    const ab_class *class_ = &loaded->class_;
    const int states = ab_state_count(class_);
    if (states > AB_MATERIAL_STATES)
        return ab_report_error(report, material->mark, "material '%s' keeps %d numbers per point; at most %d are possible", material->name,
                               states, AB_MATERIAL_STATES);
    char who[96];
    snprintf(who, sizeof who, "material '%s' (%s)", material->name, class_->name);
    ab_service_init(service, who);
    service->guarded = loaded->guarded;
    const char *why = service->message;
    if (class_->create && class_->create(&service->host, material->settings, self) != 0)
        return ab_report_error(report, material->mark, "material '%s' refused its settings: %s", material->name,
                               why[0] ? why : "no reason given");
    small_batch batch;
    open_batch(&batch, material);
    int row = 0;
    for (uint32_t s = 0; s < class_->nstate; ++s)
        for (int c = 0; c < ab_state_components(class_->state[s].shape); ++c, ++row)
            for (int l = 0; l < 8; ++l) batch.state0[row][l] = batch.state1[row][l] = class_->state[s].initial;
    int (*call)(void *, ab_batch *) = loaded->material.start ? loaded->material.start : loaded->material.update;
    const int code = call(*self, &batch.view);
    const char *what = loaded->material.start ? "start" : "update";
    if (code != 0)
        return ab_report_error(report, material->mark, "material '%s' (%s) could not start: its %s returned %d and gave %s%s",
                               material->name, class_->name, what, code, why[0] ? "the reason: " : "no reason", why);
    if (!(batch.speed[0] > 0.0) || !isfinite(batch.speed[0]))
        return ab_report_error(report, material->mark,
                               "material '%s' (%s) could not start: its %s must set a wave speed above 0 when asked for it, and set %g m/s",
                               material->name, class_->name, what, batch.speed[0]);
    memcpy(start->stress, batch.stress1, sizeof start->stress);
    memcpy(start->state, batch.state1, sizeof start->state);
    start->wave_speed = batch.speed[0];
    return AB_OK;
}

int ab_material_start_from(const ab_material_spec *material, void *self, const double stress[4][8], ab_material_start *start,
                           double borne[4][8]) {
    const ab_loaded_class *loaded = material->loaded;
    const ab_class *class_ = &loaded->class_;
    small_batch batch;
    open_batch(&batch, material);
    memcpy(batch.stress0, stress, sizeof batch.stress0);
    memcpy(batch.stress1, stress, sizeof batch.stress1);
    memcpy(borne, stress, sizeof batch.stress0);
    int row = 0;
    for (uint32_t s = 0; s < class_->nstate; ++s)
        for (int c = 0; c < ab_state_components(class_->state[s].shape); ++c, ++row)
            for (int l = 0; l < 8; ++l) batch.state0[row][l] = batch.state1[row][l] = class_->state[s].initial;
    int code = loaded->material.start ? loaded->material.start(self, &batch.view) : 0;
    for (int l = 0; l < 8; ++l)
        if (code != 0 && batch.flag[l]) borne[0][l] = NAN;
    if (code != 0) return code;
    memcpy(start->stress, stress, sizeof start->stress);
    memcpy(start->state, batch.state1, sizeof start->state);
    memcpy(batch.state0, batch.state1, sizeof batch.state0);
    memcpy(batch.stress1, stress, sizeof batch.stress1);
    batch.view.dt = 1.0; /* without strain, however long */
    code = loaded->material.update(self, &batch.view);
    memcpy(borne, batch.stress1, sizeof batch.stress1);
    for (int l = 0; l < 8; ++l)
        if (code != 0 && batch.flag[l]) borne[0][l] = NAN;
    start->wave_speed = 0.0;
    for (int l = 0; l < 8; ++l) start->wave_speed = fmax(start->wave_speed, batch.speed[l]);
    return code;
}

/* Slopes of the stress over a strain of SMALL from the stress in `batch`, each for itself: pulled, pushed, sheared one way and the other. */
enum { PULLED, PUSHED, SHEARED, SHEARED_BACK, WAYS };
static const double SMALL = 1e-7; /* strain: rounding and curvature both stay below 1e-8 of the tangent */

static int slopes(const ab_material_spec *material, void *self, small_batch *batch, double *along, double *mu) {
    const double rate = 1.0; /* 1/s: for materials that ask how fast */
    batch->view.dt = SMALL / rate;
    for (int l = 0; l < 8; ++l) {
        const double sign = l % 2 ? -1.0 : 1.0, strain = sign * SMALL;
        if (l % 4 < SHEARED) {
            batch->strain[0][l] = strain;
            batch->gradient[0][l] = 1.0 + strain;
            batch->spatial[0][l] = sign * rate;
            batch->density[l] = material->density / (1.0 + strain);
        } else {
            batch->strain[3][l] = strain;
            batch->gradient[1][l] = batch->gradient[2][l] = 0.5 * strain;
            batch->spatial[1][l] = batch->spatial[2][l] = 0.5 * sign * rate;
        }
    }
    const int code = material->loaded->material.update(self, &batch->view);
    if (code != 0) return code;
    double slope[WAYS];
    for (int l = 0; l < WAYS; ++l) {
        const int c = l < SHEARED ? 0 : 3;
        slope[l] = (batch->stress1[c][l] - batch->stress0[c][l]) / (l % 2 ? -SMALL : SMALL);
    }
    *along = (batch->stress1[0][PULLED] - batch->stress1[0][PUSHED]) / (2.0 * SMALL);
    *mu = (batch->stress1[3][SHEARED] - batch->stress1[3][SHEARED_BACK]) / (2.0 * SMALL);
    /* Where one way yields the other shows the elastic slope. */
    if (fabs(slope[PULLED] - slope[PUSHED]) > 1e-3 * fabs(*along)) *along = fmax(slope[PULLED], slope[PUSHED]);
    if (fabs(slope[SHEARED] - slope[SHEARED_BACK]) > 1e-3 * fabs(*mu)) *mu = fmax(slope[SHEARED], slope[SHEARED_BACK]);
    return 0;
}

ab_status ab_material_tangent(const ab_material_spec *material, ab_service *service, void *self, const ab_material_start *start,
                              double *lambda, double *mu, ab_report *report) {
    static const double SLIGHT = 1e-4; /* pressure over modulus: a thousand times that of the strain */
    const double expected = material->density * start->wave_speed * start->wave_speed;
    double along = 0.0;
    for (int attempt = 0; attempt < 2; ++attempt) {
        small_batch batch;
        open_batch(&batch, material);
        memcpy(batch.stress0, start->stress, sizeof batch.stress0);
        memcpy(batch.state0, start->state, sizeof batch.state0);
        if (attempt == 1) /* soil without cohesion is stiff only under pressure */
            for (int c = 0; c < 3; ++c)
                for (int l = 0; l < 8; ++l) batch.stress0[c][l] -= SLIGHT * expected;
        const int code = slopes(material, self, &batch, &along, mu);
        const char *why = service->message;
        if (code != 0)
            return ab_report_error(report, material->mark, "material '%s' (%s) gave no stress for a strain of %g: %s", material->name,
                                   material->loaded->class_.name, SMALL, why[0] ? why : "no reason given");
        if (fabs(along / expected - 1.0) < 0.02 && *mu > 0.0) break;
    }
    *lambda = along - 2.0 * *mu;
    if (!(along > 0.0) || !(*mu >= 0.0) || !isfinite(along) || !isfinite(*mu))
        return ab_report_error(report, material->mark,
                               "material '%s' (%s): its stiffness at the start is %g Pa along and %g Pa in shear; it must be positive",
                               material->name, material->loaded->class_.name, along, *mu);
    const double speed = sqrt(along / material->density);
    if (!(fabs(speed / start->wave_speed - 1.0) < 0.01))
        ab_report_warning(report, material->mark,
                          "material '%s' (%s) says its waves travel at %g m/s, and its stiffness of %g Pa makes that %g m/s; the critical "
                          "time step goes by the faster one",
                          material->name, material->loaded->class_.name, start->wave_speed, along, speed);
    return AB_OK;
}
