/* material.c: the start of a body's material on its points. */
#include <string.h>

#include "core/material.h"
#include "mpm/body.h"

ab_status mpm_material_start(mpm_body *body, ab_report *report) {
    ab_material_start start;
    AB_TRY(ab_material_open(body->material, &body->service, &body->self, &start, report));
    body->wave_speed = start.wave_speed;
    body->modulus = start.wave_speed * start.wave_speed * body->material->density;
    for (size_t k = 0; k < body->scene->boundary_count && body->shear_modulus == 0.0; ++k) {
        double lambda;
        if (body->scene->boundaries[k].body == body->domain.index)
            AB_TRY(ab_material_tangent(body->material, &body->service, body->self, &start, &lambda, &body->shear_modulus, report));
    }
    for (size_t b = 0; b < body->block_count; ++b) {
        double *block = mpm_block(body, b);
        for (int c = 0; c < 4; ++c) memcpy(block + 8 * (ROW_STRESS + c), start.stress[c], 8 * sizeof(double));
        if (body->rows.mean_stress >= 0)
            for (int l = 0; l < 8; ++l) block[8 * body->rows.mean_stress + l] = 0.5 * (start.stress[0][l] + start.stress[1][l]);
        for (int s = 0; s < body->rows.states; ++s) memcpy(block + 8 * (body->rows.state + s), start.state[s], 8 * sizeof(double));
    }
    return AB_OK;
}
