/* body_force.c: a force per mass that is a field, on the points of a body: m_p b(x_p, X_p, t) at the nodes as a point's weight is, and its work.
 *
 * b is taken at the places and at the time of the start of the step, where the stresses are, too: so the scheme stays of second order in time (leap-frog) where
 * the body starts without acceleration. Formulas are evaluated on one thread (a parser has a state), what follows on all. */
#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "mpm/body.h"

ab_status mpm_body_force_find(mpm_body *body, const ab_step *step, ab_report *report) {
    const ab_body_spec *spec = body->domain.spec;
    if (!spec->has_force) return AB_OK;
    if (!ab_memory_grow((void **)&body->body_force, &body->body_force_capacity, body->block_count, 16 * sizeof *body->body_force))
        return ab_report_failure(report, "body '%s': no memory for the body force of %zu points", spec->name, body->points);
    for (size_t slot = 0; slot < body->block_count * 8; ++slot) {
        double *force = body->body_force + 16 * (slot / 8) + slot % 8;
        const uint64_t id = body->ids[slot];
        force[0] = force[8] = 0.0;
        if (id == UINT64_MAX) continue;
        const double *point = mpm_block(body, slot / 8) + slot % 8;
        double now[2], start[2] = {0.0, 0.0};
        for (int c = 0; c < 2; ++c) {
            now[c] = point[8 * (ROW_X + c)] + body->origin[c];
            if (body->birth) start[c] = body->birth[2 * id + (size_t)c] + body->origin[c];
        }
        for (int c = 0; c < 2; ++c) {
            const double b = ab_number_of(spec->force + c, step->time, now, start);
            AB_TRY(ab_number_finite(spec->force + c, b, step->time, now, report, "bodies.%s.body_force[%d]", spec->name, c));
            force[8 * c] = point[8 * ROW_MASS] * b;
        }
    }
    return AB_OK;
}

void mpm_body_force_scatter(mpm_body *body) {
    if (!body->body_force) return;
#pragma omp parallel for schedule(dynamic, 1) num_threads(body->threads)
    for (size_t k = 0; k < body->tile_count; ++k) {
        const mpm_tile *tile = body->tiles + k;
        if (tile->patch < 0) continue;
        double *patch = body->patches + (size_t)tile->patch * mpm_patch_doubles(body);
        const int nodes = body->kernel->nodes, width = body->kernel->patch;
        for (uint32_t b = tile->first; b < tile->first + tile->blocks; ++b) {
            mpm_stencils w;
            body->kernel->stencils(body, tile, mpm_block(body, b), &w);
            const double *force = body->body_force + 16 * (size_t)b;
            for (int l = 0; l < 8; ++l)
                for (int j = 0; j < nodes; ++j)
                    for (int i = 0; i < nodes; ++i) {
                        const double n = w.value[j * nodes + i][l];
                        double *node = patch + 8 * (w.node[l] + j * width + i) + NODE_FORCE_X;
                        for (int c = 0; c < 2; ++c) node[c] += n * force[8 * c + l];
                    }
        }
    }
}

void mpm_body_force_work(mpm_body *body, const ab_step *step) {
    if (!body->body_force) return;
#pragma omp parallel for schedule(dynamic, 1) num_threads(body->threads)
    for (size_t k = 0; k < body->tile_count; ++k) {
        const mpm_tile *tile = body->tiles + k;
        if (tile->patch < 0) continue;
        double motion[4 * MPM_PATCH_MOST + 8] __attribute__((aligned(64))); /* velocity, and its change in this step */
        mpm_grid_fetch_motion(body, k, motion);
        const int nodes = body->kernel->nodes, width = body->kernel->patch;
        double work = 0.0;
        for (uint32_t b = tile->first; b < tile->first + tile->blocks; ++b) {
            mpm_stencils w;
            body->kernel->stencils(body, tile, mpm_block(body, b), &w);
            const double *force = body->body_force + 16 * (size_t)b;
            for (int l = 0; l < 8; ++l)
                for (int j = 0; j < nodes; ++j)
                    for (int i = 0; i < nodes; ++i) {
                        const double *node = motion + 4 * (w.node[l] + j * width + i), n = w.value[j * nodes + i][l];
                        for (int c = 0; c < 2; ++c) work += n * force[8 * c + l] * (node[c] - 0.5 * node[2 + c]);
                    }
        }
        body->sums[k].external = work;
    }
    for (size_t k = 0; k < body->tile_count; ++k)
        if (body->tiles[k].patch >= 0) body->energy.external += step->dt * body->sums[k].external;
}

double mpm_body_force_size(const mpm_body *body) {
    double size = 0.0;
    for (size_t slot = 0; body->body_force && slot < body->block_count * 8; ++slot) {
        const double *force = body->body_force + 16 * (slot / 8) + slot % 8;
        size += hypot(force[0], force[8]);
    }
    return size;
}

size_t mpm_body_force_bytes(const mpm_body *body) { return body->body_force_capacity * 16 * sizeof *body->body_force; }

void mpm_body_force_destroy(mpm_body *body) { ab_memory_give(body->body_force, mpm_body_force_bytes(body)); }
