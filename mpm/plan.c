/* plan.c: what a material-point body costs: points, cells, bytes, arrays, passes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mpm/body.h"

static int compare_cells(const void *a, const void *b) {
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Cells of the grid with points in them. Points come sorted by the first node of their stencil, so equal cells mostly follow each other. */
static size_t count_cells(const mpm_body *body) {
    uint64_t *cells = malloc((body->points + 1) * sizeof *cells);
    if (!cells) return 0;
    size_t n = 0;
    for (size_t slot = 0; slot < body->block_count * 8; ++slot) {
        if (body->ids[slot] == UINT64_MAX) continue;
        const double *x = mpm_block(body, slot / 8) + 8 * ROW_X + slot % 8;
        const uint64_t key = ab_tile_key((int32_t)floor(x[0] * body->inverse_h), (int32_t)floor(x[8] * body->inverse_h));
        if (n == 0 || cells[n - 1] != key) cells[n++] = key;
    }
    qsort(cells, n, sizeof *cells, compare_cells);
    size_t unique = 0;
    for (size_t k = 0; k < n; ++k) unique += k == 0 || cells[k] != cells[k - 1];
    free(cells);
    return unique;
}

void mpm_plan(const ab_domain *domain, ab_plan_body *p) {
    const mpm_body *body = (const mpm_body *)domain;
    memset(p, 0, sizeof *p);
    p->points = body->points;
    p->tiles = body->tile_count;
    p->cells = count_cells(body);
    p->bytes = body->block_capacity * (64 * (size_t)body->rows.count + 64) + body->own_capacity * 8 * OWN_RECORD * AB_TILE_NODES +
               body->patch_capacity * 8 * mpm_patch_doubles(body) + body->filter_capacity * 8 * FILTER_RECORD * AB_TILE_NODES +
               body->volumetric_capacity * 8 * VOLUMETRIC_RECORD * AB_TILE_NODES + body->sliver_capacity * sizeof *body->slivers + body->light_capacity * sizeof *body->light +
               body->tie_capacity * sizeof *body->ties + body->line_capacity * sizeof *body->lines + body->work_capacity * sizeof *body->work +
               body->back_capacity * 16 * AB_TILE_NODES + body->tile_capacity * (sizeof(mpm_tile) + sizeof(uint64_t) + sizeof(mpm_sums)) +
               (body->birth ? body->born * 16 : 0) + (body->slot ? body->born * 4 : 0) +
               (body->domain.spec->has_force ? body->block_capacity * 128 : 0) + mpm_edges_bytes(body) + mpm_outline_bytes(body->outline) +
               mpm_damp_bytes(body) + sizeof *body;
    p->bytes_per_point = 8 * (size_t)body->rows.count + 8;
    snprintf(p->fields, sizeof p->fields, "position, velocity, next position, mass, volume, stress%s%s%s%s%s%s",
             body->rows.extent >= 0 ? ", domain extent" : "", body->rows.half >= 0 ? ", domain half sizes" : "",
             body->rows.corners >= 0 ? ", domain half sides" : "", body->rows.gradient >= 0 ? ", deformation gradient" : "",
             body->rows.affine >= 0 ? ", affine velocity" : "", body->rows.mean_stress >= 0 ? ", mean stress of its own" : "");
    const ab_class *class_ = &body->material->loaded->class_;
    for (uint32_t s = 0; s < class_->nstate; ++s) {
        const size_t used = strlen(p->fields);
        snprintf(p->fields + used, sizeof p->fields - used, ", %s", class_->state[s].name);
    }
    if (body->birth) strncat(p->fields, ", initial position", sizeof p->fields - strlen(p->fields) - 1);
    const char *outline = !body->outline ? "" : body->domain.spec->surface_points > 0.0 ? ", surface points" : ", outline";
    strncat(p->fields, outline, sizeof p->fields - strlen(p->fields) - 1);
    snprintf(p->passes, sizeof p->passes, "%s%s%s%s",
             body->update == MPM_USAVG  ? "points to grid, grid, stress and points to grid, grid, grid to points and back, grid, stress"
             : body->update == MPM_MUSL ? "points to grid, grid, grid to points and back, grid, stress"
             : body->update == MPM_USL  ? "points to grid, grid, grid to points, stress"
                                        : "points to grid, grid, stress and points to grid, grid, grid to points",
             body->load_count ? ", tractions" : "", body->domain.spec->has_force ? ", body force" : "", outline);
    if (body->edges_count) strncat(p->passes, ", edges of boundaries", sizeof p->passes - strlen(p->passes) - 1);
    if (body->f_bar) strncat(p->passes, ", averages of volume change and mean stress", sizeof p->passes - strlen(p->passes) - 1);
    if (body->order > 1) {
        const size_t used = strlen(p->passes);
        snprintf(p->passes + used, sizeof p->passes - used, ", filter of velocities %d times", body->order - 1);
    }
}
