/* loads.c: tractions on a body's outline. A traction acts on the outline's initial length and keeps its direction.
 *
 * The gimp basis averages hat functions over the points' domains, so that the internal force of a uniform stress is the integral of hat functions over
 * the surface of the domains. A traction is mapped in the same way, hats averaged over the piece of outline where it stands now, and balances that stress
 * to rounding; mapped from the middle of the point under it, it would leave a layer of wrong stress. A linear basis knows points only. */
#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "mpm/body.h"

ab_status mpm_loads_create(mpm_body *body, const ab_fill *fill, ab_report *report) {
    const ab_scene *scene = body->scene;
    size_t count = 0;
    for (int pass = 0; pass < 2; ++pass) {
        count = 0;
        for (size_t k = 0; k < scene->load_count; ++k) {
            if (scene->loads[k].body != body->domain.index) continue;
            const size_t before = count;
            for (size_t s = 0; s < fill->surface_count; ++s) {
                if (!ab_where_holds(&scene->loads[k].where, fill, fill->surface + s)) continue;
                if (pass) {
                    const ab_outline_piece *piece = fill->surface + s;
                    const double arm[2] = {piece->position[0] - fill->x[piece->point], piece->position[1] - fill->y[piece->point]},
                                 half = 0.5 * piece->length;
                    body->loads[count] = (mpm_load){
                        piece->point, (uint32_t)k, piece->length, {arm[0], arm[1]}, {-half * piece->normal[1], half * piece->normal[0]}};
                }
                ++count;
            }
            if (count == before)
                return ab_report_error(
                    report, scene->loads[k].mark,
                    "loads[%zu] meets no part of the outline of '%s'; use side: left|right|top|bottom or a place on its outline", k,
                    body->domain.spec->name);
        }
        if (count == 0) return AB_OK;
        if (!pass) {
            body->loads = malloc(count * sizeof *body->loads);
            if (!body->loads || !mpm_points_index(body))
                return ab_report_failure(report, "body '%s': no memory for %zu loaded points", body->domain.spec->name, count);
        }
    }
    body->load_count = count;
    return AB_OK;
}

typedef struct reach {
    double n[9], g[9][2];
    size_t node[9];
    int count;
    const mpm_tile *tile;
} reach;

/* Integral of the hat function from -1 to u. */
static double hat_integral(double u) {
    if (u <= -1.0) return 0.0;
    if (u >= 1.0) return 1.0;
    return u < 0.0 ? 0.5 * (1.0 + u) * (1.0 + u) : 1.0 - 0.5 * (1.0 - u) * (1.0 - u);
}

/* Hat functions of three nodes in a row averaged over [s-l, s+l]; s in cells from the first node, l kept so small that they add up to 1. */
static void average_hats(double s, double l, double n[3]) {
    s = fmin(fmax(s, 0.0), 2.0);
    l = fmin(l, fmin(s, 2.0 - s));
    for (int i = 0; i < 3; ++i) {
        const double u = s - i;
        n[i] = l > 1e-6 ? (hat_integral(u + l) - hat_integral(u - l)) / (2.0 * l) : fmax(1.0 - fabs(u), 0.0);
    }
}

/* The nodes that carry a load: values, gradients at the point under it, and places in its tile's patch. */
static reach reach_of(const mpm_body *body, const mpm_load *load) {
    const uint32_t slot = body->slot[load->id];
    reach r = {.count = 0};
    r.tile = body->tiles + mpm_tile_of_block(body, slot / 8);
    mpm_weights w;
    const double *block = mpm_block(body, slot / 8);
    body->kernel->weights(body, r.tile, block, &w);
    const int l = (int)(slot % 8), nodes = body->kernel->nodes;
    const int first[2] = {w.node[l] % PATCH - 1 + r.tile->tx * AB_TILE, w.node[l] / PATCH - 1 + r.tile->ty * AB_TILE};
    double n[2][3];
    for (int c = 0; c < 2; ++c) {
        for (int i = 0; i < nodes; ++i) n[c][i] = w.n[c][i][l];
        if (nodes == 3)
            average_hats((block[8 * (ROW_X + c) + l] + load->arm[c]) * body->inverse_h - first[c], fabs(load->half[c]) * body->inverse_h,
                         n[c]);
    }
    for (int j = 0; j < nodes; ++j)
        for (int i = 0; i < nodes; ++i) {
            r.n[r.count] = n[0][i] * n[1][j];
            r.g[r.count][0] = w.g[0][i][l] * w.n[1][j][l];
            r.g[r.count][1] = w.n[0][i][l] * w.g[1][j][l];
            r.node[r.count++] = (size_t)(w.node[l] + j * PATCH + i);
        }
    return r;
}

static void load_force(const mpm_body *body, const mpm_load *load, double time, double force[2]) {
    for (int c = 0; c < 2; ++c) force[c] = load->length * ab_number_at(body->scene->loads[load->spec].traction + c, time, 0.0, 0.0, 0.0);
}

void mpm_loads_scatter(mpm_body *body, const ab_step *step) {
    for (size_t k = 0; k < body->load_count; ++k) {
        if (body->slot[body->loads[k].id] == UINT32_MAX) continue;
        double force[2];
        load_force(body, body->loads + k, step->time + 0.5 * step->dt, force);
        const reach r = reach_of(body, body->loads + k);
        double *patch = body->patches + (size_t)r.tile->patch * PATCH_DOUBLES;
        for (int i = 0; i < r.count; ++i)
            for (int c = 0; c < 2; ++c) patch[8 * r.node[i] + NODE_FORCE_X + (size_t)c] += r.n[i] * force[c];
    }
}

void mpm_loads_work(mpm_body *body, const ab_step *step) {
    for (size_t k = 0; k < body->load_count; ++k) {
        if (body->slot[body->loads[k].id] == UINT32_MAX) continue;
        double force[2];
        load_force(body, body->loads + k, step->time + 0.5 * step->dt, force);
        const reach r = reach_of(body, body->loads + k);
        for (int i = 0; i < r.count; ++i) {
            const double *own = body->own + (size_t)mpm_dof_of(r.tile, (int)r.node[i]) * OWN_RECORD;
            for (int c = 0; c < 2; ++c)
                body->energy.external += step->dt * r.n[i] * force[c] * 0.5 * (own[OWN_VELOCITY + c] + own[OWN_OLD + c]);
        }
    }
}

/* Arms stretch and turn as the domains of their points do; domains of fixed size have fixed arms. */
void mpm_loads_follow(mpm_body *body, const ab_step *step) {
    if (!body->contiguous) return;
    for (size_t k = 0; k < body->load_count; ++k) {
        mpm_load *load = body->loads + k;
        if (body->slot[load->id] == UINT32_MAX) continue;
        const reach r = reach_of(body, load);
        double arm[2] = {load->arm[0], load->arm[1]}, half[2] = {load->half[0], load->half[1]};
        for (int i = 0; i < r.count; ++i) {
            const double *own = body->own + (size_t)mpm_dof_of(r.tile, (int)r.node[i]) * OWN_RECORD;
            const double along_arm = step->dt * (r.g[i][0] * load->arm[0] + r.g[i][1] * load->arm[1]);
            const double along_half = step->dt * (r.g[i][0] * load->half[0] + r.g[i][1] * load->half[1]);
            for (int c = 0; c < 2; ++c) {
                arm[c] += along_arm * own[OWN_VELOCITY + c];
                half[c] += along_half * own[OWN_VELOCITY + c];
            }
        }
        for (int c = 0; c < 2; ++c) load->arm[c] = arm[c], load->half[c] = half[c];
    }
}
