/* loads.c: tractions and pressures on a body's outline. A traction acts on the outline's initial length and keeps its direction, a pressure on the outline as
 * it lies now: each piece stretches and turns with the point under it, and meets its neighbours half-way.
 *
 * How a piece of outline pulls at the nodes is the basis' own (mpm_kernel.carry): such that a traction balances the internal force of a uniform stress. Mapped from
 * the middle of the point under it, it would leave a layer of wrong stress. A linear basis knows points only. */
#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "mpm/body.h"
#include "mpm/outline.h"

/* Neighbours among the pieces under one pressure; load[s]: 1 + place in the list of piece s. An outline that does not close has none. */
static bool join_pieces(const ab_fill *fill, const uint32_t *load, mpm_load *list) {
    uint32_t *following = malloc((fill->surface_count + 1) * sizeof *following);
    const ab_status status = following ? mpm_pieces_chain(fill, following) : AB_FAILED;
    for (size_t s = 0; s < fill->surface_count && status == AB_OK; ++s) {
        if (!load[s] || !load[following[s]]) continue;
        list[load[s] - 1].next = load[following[s]] - 1;
        list[load[following[s]] - 1].prior = load[s] - 1;
    }
    free(following);
    return status != AB_FAILED;
}

bool mpm_load_pieces(const ab_fill *fill, const ab_where *where, bool join, uint32_t spec, mpm_load *list, size_t *count) {
    uint32_t *load = calloc(fill->surface_count + 1, sizeof *load);
    if (!load) return false;
    for (size_t s = 0; s < fill->surface_count; ++s) {
        const ab_outline_piece *piece = fill->surface + s;
        if (!ab_where_holds(where, fill, piece)) continue;
        const double half = 0.5 * piece->length;
        list[(*count)++] = (mpm_load){.id = piece->point,
                                      .spec = spec,
                                      .length = piece->length,
                                      .arm = {piece->position[0] - fill->x[piece->point], piece->position[1] - fill->y[piece->point]},
                                      .half = {-half * piece->normal[1], half * piece->normal[0]},
                                      .place = {piece->position[0], piece->position[1]},
                                      .prior = UINT32_MAX,
                                      .next = UINT32_MAX};
        load[s] = (uint32_t)*count;
    }
    const bool good = !join || join_pieces(fill, load, list);
    free(load);
    return good;
}

ab_status mpm_loads_create(mpm_body *body, const ab_fill *fill, ab_report *report) {
    const ab_scene *scene = body->scene;
    size_t count = 0;
    for (size_t k = 0; k < scene->load_count; ++k) {
        if (scene->loads[k].body != body->domain.index) continue;
        const size_t before = count;
        for (size_t s = 0; s < fill->surface_count; ++s) count += ab_where_holds(&scene->loads[k].where, fill, fill->surface + s);
        if (count == before)
            return ab_report_error(
                report, scene->loads[k].mark,
                "loads[%zu] meets no part of the outline of '%s'; use side: left|right|top|bottom or a place on its outline", k,
                body->domain.spec->name);
    }
    if (count == 0) return AB_OK;
    body->loads = malloc(count * sizeof *body->loads);
    bool good = body->loads && mpm_points_index(body);
    for (size_t k = 0; k < scene->load_count && good; ++k)
        if (scene->loads[k].body == body->domain.index)
            good = mpm_load_pieces(fill, &scene->loads[k].where, scene->loads[k].press, (uint32_t)k, body->loads, &body->load_count);
    return good ? AB_OK : ab_report_failure(report, "body '%s': no memory for %zu loaded points", body->domain.spec->name, count);
}

mpm_reach mpm_load_reach(const mpm_body *body, const mpm_load *load) {
    const uint32_t slot = body->slot[load->id];
    mpm_reach r = {.count = 0};
    r.tile = body->tiles + mpm_tile_of_block(body, slot / 8);
    mpm_stencils w;
    const double *block = mpm_block(body, slot / 8);
    body->kernel->stencils(body, r.tile, block, &w);
    const int l = (int)(slot % 8), nodes = body->kernel->nodes;
    if (body->kernel->carry)
        body->kernel->carry(body, r.tile, block, l, load, r.n);
    else
        for (int k = 0; k < nodes * nodes; ++k) r.n[k] = w.value[k][l];
    for (; r.count < nodes * nodes; ++r.count) {
        r.g[r.count][0] = w.gx[r.count][l];
        r.g[r.count][1] = w.gy[r.count][l];
        r.node[r.count] = (size_t)(w.node[l] + r.count / nodes * body->kernel->patch + r.count % nodes);
    }
    return r;
}

/* Where a piece is by the point under it. */
static void own_place(const mpm_body *body, const mpm_load *load, double middle[2]) {
    const uint32_t slot = body->slot[load->id];
    const double *point = mpm_block(body, slot / 8) + slot % 8;
    for (int c = 0; c < 2; ++c) middle[c] = point[8 * (ROW_X + c)] + load->arm[c];
}

/* The end of a piece (sign 1) or its beginning (-1): half-way between what its point and that of its neighbour say. So pieces under a pressure hang together,
 * and all around a body it has neither sum nor moment, however the points differ. */
static void end_of(const mpm_body *body, const mpm_load *list, const mpm_load *load, uint32_t neighbour, double sign, double end[2]) {
    own_place(body, load, end);
    for (int c = 0; c < 2; ++c) end[c] += sign * load->half[c];
    if (neighbour == UINT32_MAX || body->slot[list[neighbour].id] == UINT32_MAX) return;
    const mpm_load *other = list + neighbour;
    double theirs[2];
    own_place(body, other, theirs);
    for (int c = 0; c < 2; ++c) end[c] = 0.5 * (end[c] + theirs[c] - sign * other->half[c]);
}

void mpm_load_place(const mpm_body *body, const mpm_load *list, mpm_load *load) {
    double from[2], to[2];
    end_of(body, list, load, load->prior, -1.0, from);
    end_of(body, list, load, load->next, 1.0, to);
    for (int c = 0; c < 2; ++c) {
        load->now[c] = 0.5 * (from[c] + to[c]);
        load->stretch[c] = 0.5 * (to[c] - from[c]);
    }
}

static void find_force(const mpm_body *body, double time, mpm_load *load) {
    const ab_load_spec *spec = body->scene->loads + load->spec;
    const double x = load->place[0], y = load->place[1];
    if (spec->press) {
        mpm_load_place(body, body->loads, load);
        const double p = ab_number_at(&spec->pressure, time, x, y, 0.0);
        const double round = body->axisymmetric ? ab_circumference(load->now[0] + body->origin[0]) : 1.0; /* exact for a cone, too */
        load->force[0] = -2.0 * p * load->stretch[1] * round;
        load->force[1] = 2.0 * p * load->stretch[0] * round;
    } else {
        own_place(body, load, load->now);
        for (int c = 0; c < 2; ++c) {
            load->stretch[c] = load->half[c];
            load->force[c] = load->length * ab_number_at(spec->traction + c, time, x, y, 0.0);
            if (body->axisymmetric) load->force[c] *= ab_circumference(load->place[0]);
        }
    }
}

void mpm_loads_scatter(mpm_body *body, const ab_step *step) {
    for (size_t k = 0; k < body->load_count; ++k) {
        mpm_load *load = body->loads + k;
        if (body->slot[load->id] == UINT32_MAX) continue;
        find_force(body, step->time + 0.5 * step->dt, load);
        if (body->scene->loads[load->spec].absent >> step->stage & 1) load->force[0] = load->force[1] = 0.0;
        const mpm_reach r = mpm_load_reach(body, load);
        double *patch = body->patches + (size_t)r.tile->patch * mpm_patch_doubles(body);
        for (int i = 0; i < r.count; ++i)
            for (int c = 0; c < 2; ++c) patch[8 * r.node[i] + NODE_FORCE_X + (size_t)c] += r.n[i] * load->force[c];
    }
}

double mpm_loads_size(const mpm_body *body) {
    double size = 0.0;
    for (size_t k = 0; k < body->load_count; ++k)
        if (body->slot[body->loads[k].id] != UINT32_MAX) size += hypot(body->loads[k].force[0], body->loads[k].force[1]);
    return size;
}

void mpm_loads_work(mpm_body *body, const ab_step *step) {
    for (size_t k = 0; k < body->load_count; ++k) {
        const mpm_load *load = body->loads + k;
        if (body->slot[load->id] == UINT32_MAX) continue;
        const mpm_reach r = mpm_load_reach(body, load);
        for (int i = 0; i < r.count; ++i) {
            const double *own = body->own + (size_t)mpm_dof_of(body, r.tile, (int)r.node[i]) * OWN_RECORD;
            for (int c = 0; c < 2; ++c)
                body->energy.external += step->dt * r.n[i] * load->force[c] * 0.5 * (own[OWN_VELOCITY + c] + own[OWN_OLD + c]);
        }
    }
}

void mpm_load_follow(const mpm_body *body, const ab_step *step, mpm_load *load) {
    const mpm_reach r = mpm_load_reach(body, load);
    double arm[2] = {load->arm[0], load->arm[1]}, half[2] = {load->half[0], load->half[1]};
    for (int i = 0; i < r.count; ++i) {
        const double *own = body->own + (size_t)mpm_dof_of(body, r.tile, (int)r.node[i]) * OWN_RECORD;
        const double along_arm = step->dt * (r.g[i][0] * load->arm[0] + r.g[i][1] * load->arm[1]);
        const double along_half = step->dt * (r.g[i][0] * load->half[0] + r.g[i][1] * load->half[1]);
        for (int c = 0; c < 2; ++c) {
            arm[c] += along_arm * own[OWN_VELOCITY + c];
            half[c] += along_half * own[OWN_VELOCITY + c];
        }
    }
    for (int c = 0; c < 2; ++c) load->arm[c] = arm[c], load->half[c] = half[c];
}

/* Arms stretch and turn as the domains of their points do; domains of fixed size have fixed arms, but under a pressure. */
void mpm_loads_follow(mpm_body *body, const ab_step *step) {
    for (size_t k = 0; k < body->load_count; ++k) {
        mpm_load *load = body->loads + k;
        if (body->slot[load->id] == UINT32_MAX || !(body->contiguous || body->scene->loads[load->spec].press)) continue;
        mpm_load_follow(body, step, load);
    }
}
