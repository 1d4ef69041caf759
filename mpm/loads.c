/* loads.c: tractions on a body's outline, carried by the points under it. A traction acts on the outline's initial length and keeps its direction. */
#include <stdlib.h>

#include "core/memory.h"
#include "mpm/body.h"

ab_status mpm_loads_create(mpm_body *body, const ab_fill *fill, ab_report *report)
{
    const ab_scene *scene = body->scene;
    size_t count = 0;
    for (int pass = 0; pass < 2; ++pass) {
        count = 0;
        for (size_t k = 0; k < scene->load_count; ++k) {
            if (scene->loads[k].body != body->domain.index) continue;
            const size_t before = count;
            for (size_t s = 0; s < fill->surface_count; ++s) {
                if (!ab_where_holds(&scene->loads[k].where, fill, fill->surface + s)) continue;
                if (pass) body->loads[count] = (mpm_load){fill->surface[s].point, (uint32_t)k, fill->surface[s].length};
                ++count;
            }
            if (count == before)
                return ab_report_error(report, scene->loads[k].mark, "loads[%zu] meets no part of the outline of '%s'; use side: left|right|top|bottom or a place on its outline", k,
                                       body->domain.spec->name);
        }
        if (count == 0) return AB_OK;
        if (!pass) {
            body->loads = malloc(count * sizeof *body->loads);
            body->slot = malloc((body->born + 1) * sizeof *body->slot);
            if (!body->loads || !body->slot) return ab_report_failure(report, "body '%s': no memory for %zu loaded points", body->domain.spec->name, count);
        }
    }
    body->load_count = count;
    for (size_t slot = 0; slot < body->block_count * 8; ++slot)
        if (body->ids[slot] != UINT64_MAX) body->slot[body->ids[slot]] = (uint32_t)slot;
    return AB_OK;
}

/* Tile that owns a block: tiles with points hold ascending runs. */
static size_t tile_of_block(const mpm_body *body, uint32_t block)
{
    size_t low = 0, high = body->tile_count;
    size_t found = 0;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        size_t filled = middle;
        while (filled < high && body->tiles[filled].patch < 0) ++filled;
        if (filled == high) high = middle;
        else if (body->tiles[filled].first <= block) found = filled, low = filled + 1;
        else high = middle;
    }
    return found;
}

typedef struct reach { double n[9]; size_t node[9]; int count; const mpm_tile *tile; } reach;

/* The nodes a loaded point hangs on: values, and places in its tile's patch. */
static reach reach_of(const mpm_body *body, uint32_t slot)
{
    reach r = {.count = 0};
    r.tile = body->tiles + tile_of_block(body, slot / 8);
    mpm_weights w;
    body->kernel->weights(body, r.tile, mpm_block(body, slot / 8), &w);
    const int l = (int)(slot % 8), nodes = body->kernel->nodes;
    for (int j = 0; j < nodes; ++j)
        for (int i = 0; i < nodes; ++i) {
            r.n[r.count] = w.n[0][i][l] * w.n[1][j][l];
            r.node[r.count++] = (size_t)(w.node[l] + j * PATCH + i);
        }
    return r;
}

static void load_force(const mpm_body *body, const mpm_load *load, double time, double force[2])
{
    for (int c = 0; c < 2; ++c) force[c] = load->length * ab_number_at(body->scene->loads[load->spec].traction + c, time, 0.0, 0.0, 0.0);
}

void mpm_loads_scatter(mpm_body *body, const ab_step *step)
{
    for (size_t k = 0; k < body->load_count; ++k) {
        const uint32_t slot = body->slot[body->loads[k].id];
        if (slot == UINT32_MAX) continue;
        double force[2];
        load_force(body, body->loads + k, step->time + 0.5 * step->dt, force);
        const reach r = reach_of(body, slot);
        double *patch = body->patches + (size_t)r.tile->patch * PATCH_DOUBLES;
        for (int i = 0; i < r.count; ++i)
            for (int c = 0; c < 2; ++c) patch[8 * r.node[i] + NODE_FORCE_X + (size_t)c] += r.n[i] * force[c];
    }
}

void mpm_loads_work(mpm_body *body, const ab_step *step)
{
    for (size_t k = 0; k < body->load_count; ++k) {
        const uint32_t slot = body->slot[body->loads[k].id];
        if (slot == UINT32_MAX) continue;
        double force[2];
        load_force(body, body->loads + k, step->time + 0.5 * step->dt, force);
        const reach r = reach_of(body, slot);
        for (int i = 0; i < r.count; ++i) {
            const int pi = (int)(r.node[i] % PATCH) - 1, pj = (int)(r.node[i] / PATCH) - 1;
            const int dx = pi < 0 ? -1 : pi >= AB_TILE ? 1 : 0, dy = pj < 0 ? -1 : pj >= AB_TILE ? 1 : 0;
            const int32_t tile = r.tile->around[(dy + 1) * 3 + dx + 1];
            const double *own = body->own + ((size_t)tile * AB_TILE_NODES + (size_t)((pj - dy * AB_TILE) * AB_TILE + pi - dx * AB_TILE)) * OWN_RECORD;
            for (int c = 0; c < 2; ++c) body->energy.external += step->dt * r.n[i] * force[c] * 0.5 * (own[OWN_VELOCITY + c] + own[OWN_OLD + c]);
        }
    }
}
