/* material.c: the start of a body's material on its points. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/initial.h"
#include "core/material.h"
#include "mpm/body.h"

static void set_start(mpm_body *body, double *block, const ab_material_start *start) {
    for (int c = 0; c < 4; ++c) memcpy(block + 8 * (ROW_STRESS + c), start->stress[c], 8 * sizeof(double));
    if (body->rows.mean_stress >= 0)
        for (int l = 0; l < 8; ++l) block[8 * body->rows.mean_stress + l] = 0.5 * (start->stress[0][l] + start->stress[1][l]);
    for (int s = 0; s < body->rows.states; ++s) memcpy(block + 8 * (body->rows.state + s), start->state[s], 8 * sizeof(double));
}

/* The outline as the fill leaves it, in pieces. */
static ab_status open_initial(const mpm_body *body, const ab_fill *fill, ab_initial **initial, ab_report *report) {
    double(*edges)[4] = malloc((fill->surface_count + 1) * sizeof *edges);
    if (!edges) return ab_report_failure(report, "body '%s': no memory for its initial stress", body->domain.spec->name);
    for (size_t k = 0; k < fill->surface_count; ++k) {
        const ab_outline_piece *piece = fill->surface + k;
        const double half = 0.5 * piece->length, along[2] = {-half * piece->normal[1], half * piece->normal[0]};
        for (int c = 0; c < 2; ++c) edges[k][c] = piece->position[c] - along[c], edges[k][2 + c] = piece->position[c] + along[c];
    }
    const ab_status status =
        ab_initial_open(body->scene, body->domain.index, (const double(*)[4])edges, fill->surface_count, initial, report);
    free(edges);
    return status;
}

static ab_status start_points(mpm_body *body, const ab_initial *initial, ab_report *report) {
    double fastest = 0.0;
    for (size_t b = 0; b < body->block_count; ++b) {
        double *block = mpm_block(body, b), place[2][8];
        ab_material_start start;
        for (int c = 0; c < 2; ++c)
            for (int l = 0; l < 8; ++l) place[c][l] = block[8 * (ROW_X + c) + l] + body->origin[c];
        AB_TRY(ab_initial_eight(initial, body->material, &body->service, body->self, (const double(*)[8])place, &start, report));
        set_start(body, block, &start);
        fastest = fmax(fastest, start.wave_speed);
    }
    if (fastest > 0.0) body->wave_speed = fastest;
    if (body->f_bar) mpm_volumetric_stress(body);
    return AB_OK;
}

ab_status mpm_material_start(mpm_body *body, const ab_fill *fill, ab_report *report) {
    ab_material_start start;
    AB_TRY(ab_material_open(body->material, &body->service, &body->self, &start, report));
    body->wave_speed = start.wave_speed;
    for (size_t b = 0; b < body->block_count; ++b) set_start(body, mpm_block(body, b), &start);
    if (body->domain.spec->initial.kind != AB_INITIAL_NONE) {
        ab_initial *initial = NULL;
        AB_TRY(open_initial(body, fill, &initial, report));
        const ab_status status = initial ? start_points(body, initial, report) : AB_OK;
        ab_initial_close(initial);
        AB_TRY(status);
    }
    body->modulus = body->wave_speed * body->wave_speed * body->material->density;
    for (size_t k = 0; k < body->scene->boundary_count && body->shear_modulus == 0.0; ++k) {
        double lambda;
        if (body->scene->boundaries[k].body == body->domain.index)
            AB_TRY(ab_material_tangent(body->material, &body->service, body->self, &start, &lambda, &body->shear_modulus, report));
    }
    return AB_OK;
}
