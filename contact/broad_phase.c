/* broad_phase.c: the surfaces of both bodies of a pair: each is asked for its faces, the other for its points near them, and every point gets the faces within
 * reach. */
#include "contact/broad_phase.h"

#include <math.h>
#include <stdlib.h>

#include "core/vector.h"

static const double FINEST = 1e-6; /* of the length of all faces: no finer cells */
static const double INWARD = 0.5;  /* of a typical face: how deep inside, beyond half its size, a point still finds its face */
static const double AHEAD = 0.25;  /* of a typical face: the same, beyond what the bodies overlapped in the last step */
/* Cells that a body may leap in a step and still be seen in time: regions cost its square times the faces. */
static const double LEAST_LEAP = 4.0, MOST_LEAP = 64.0, LEAP_COST = 2e6;

void contact_broad_destroy(contact_broad *broad) {
    if (!broad) return;
    for (int side = 0; side < 2; ++side) contact_reach_destroy(broad->reach + side);
    free(broad);
}

double contact_broad_cell(const contact_broad *broad) { return broad->cell; }
double contact_broad_speed(const contact_broad *broad) { return broad->speed; }
double contact_broad_face(const contact_broad *broad) { return ab_larger(broad->length[0], broad->length[1]); }
void contact_broad_note_depth(contact_broad *broad, double depth) { broad->depth = depth; }

bool contact_broad_tell(contact_broad *broad) {
    const bool first = !broad->told;
    broad->told = true;
    return first;
}

size_t contact_broad_visits(const contact_broad *broad) { return broad->reach[0].visits + broad->reach[1].visits; }
size_t contact_broad_builds(const contact_broad *broad) { return broad->reach[0].builds + broad->reach[1].builds; }

/* Sizes that do not change any more: a cell of the grid or the mean length of the finer body's faces, and a typical face of each. */
static bool measure(contact_broad *broad, const ab_surface surface[2]) {
    double mean[2] = {INFINITY, INFINITY}, all = 0.0;
    for (int side = 0; side < 2; ++side) {
        const ab_surface *s = surface + side;
        double sum = 0.0;
        size_t count = 0;
        for (size_t f = 0; f < s->face_count; ++f) {
            const uint32_t *v = s->face_vertex + 3 * f;
            const double length = hypot(s->vertex_position[v[1]] - s->vertex_position[v[0]],
                                        s->vertex_position[s->vertex_ld + v[1]] - s->vertex_position[s->vertex_ld + v[0]]);
            if (!(length > 0.0 && length < INFINITY)) continue;
            sum += length;
            ++count;
        }
        if (count) mean[side] = sum / (double)count;
        all += sum;
    }
    const double finer = ab_larger(ab_smaller(mean[0], mean[1]), FINEST * all);
    if (!(finer < INFINITY)) return false;
    broad->cell = broad->grid_cell > 0.0 ? broad->grid_cell : finer;
    for (int side = 0; side < 2; ++side)
        broad->needed[side] = broad->length[side] = ab_larger(ab_smaller(broad->cell, mean[side]), FINEST * all);
    return true;
}

/* Both bodies' faces; the rest of a surface is left empty. */
static ab_status ask_for_faces(const contact_pair *pair, ab_surface surface[2], ab_report *report) {
    ab_domain *const body[2] = {pair->a, pair->b};
    for (int side = 0; side < 2; ++side) {
        surface[side] = (ab_surface){.struct_size = sizeof *surface, .dimension = 2};
        if (body[side]->ops->faces) AB_TRY(body[side]->ops->faces(body[side], surface + side, report));
    }
    return AB_OK;
}

static ab_status no_length(const contact_pair *pair, ab_report *report) {
    return ab_report_failure(report, "contact of '%s' and '%s': no face of either body has a length", pair->a->spec->name, pair->b->spec->name);
}

ab_status contact_broad_create(const ab_scene *scene, contact_pair *pair, ab_report *report) {
    pair->broad = calloc(1, sizeof *pair->broad);
    if (!pair->broad)
        return ab_report_failure(report, "no memory for the contact of '%s' and '%s'", pair->a->spec->name, pair->b->spec->name);
    pair->broad->grid_cell = scene->grid_cell;
    if (scene->grid_cell > 0.0) return AB_OK; /* points have no faces before the first step */
    ab_surface surface[2];
    AB_TRY(ask_for_faces(pair, surface, report));
    return measure(pair->broad, surface) ? AB_OK : no_length(pair, report);
}

static void widen(contact_box *box, const double x[2]) {
    for (int d = 0; d < 2; ++d) {
        box->low[d] = ab_smaller(box->low[d], x[d]);
        box->high[d] = ab_larger(box->high[d], x[d]);
    }
}

static const contact_box NOTHING = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}},
                         EVERYTHING = {{-INFINITY, -INFINITY}, {INFINITY, INFINITY}};

/* Where the points of a body can be: between its vertices, or in the tiles that hold its mass. */
static contact_box bounds(const contact_broad *broad, const ab_domain *body, const ab_surface *s) {
    contact_box box = NOTHING;
    if (s->vertex_count) {
        for (size_t v = 0; v < s->vertex_count; ++v)
            widen(&box, (const double[2]){s->vertex_position[v], s->vertex_position[s->vertex_ld + v]});
        return box;
    }
    if (!body->ops->node_tiles || !(broad->grid_cell > 0.0)) return EVERYTHING;
    ab_node_tiles tiles = {0};
    body->ops->node_tiles(body, &tiles);
    for (size_t k = 0; k < tiles.count; ++k)
        for (int corner = 0; corner < 2; ++corner)
            widen(&box, (const double[2]){broad->grid_cell * AB_TILE * (ab_tile_x(tiles.key[k]) + corner),
                                          broad->grid_cell * AB_TILE * (ab_tile_y(tiles.key[k]) + corner)});
    return box;
}

/* Velocities on a surface: of the points that are listed, or of the vertices where none is. */
static contact_box velocities(const ab_domain *body, const ab_surface *s) {
    ab_dofs dofs;
    body->ops->dofs(body, &dofs);
    const bool points = s->point_count > 0;
    const size_t count = points ? s->point_count : s->vertex_count, ld = points ? s->point_ld : s->vertex_ld;
    const double *x = points ? s->point_position : s->vertex_position, *weight = points ? s->point_weight : s->vertex_weight;
    const size_t *start = points ? s->point_start : s->vertex_start;
    const uint32_t *dof = points ? s->point_dof : s->vertex_dof;
    contact_box box = NOTHING;
    for (size_t i = 0; i < count; ++i) {
        double v[2] = {0.0, 0.0};
        for (size_t e = start[i]; e < start[i + 1]; ++e)
            for (size_t c = 0; c < 2; ++c) v[c] += weight[e] * dofs.velocity[dof[e] * dofs.velocity_stride + c];
        if (dofs.spin) {
            v[0] -= *dofs.spin * (x[ld + i] - dofs.centre[1]);
            v[1] += *dofs.spin * (x[i] - dofs.centre[0]);
        }
        widen(&box, v);
    }
    return box;
}

static double largest_difference(const contact_box *a, const contact_box *b) {
    double square = 0.0;
    for (int c = 0; c < 2; ++c) {
        const double most = ab_larger(a->high[c] - b->low[c], b->high[c] - a->low[c]);
        if (most > 0.0) square += most * most;
    }
    return sqrt(square);
}

static double largest_half(const ab_surface *s) {
    double most = 0.0;
    for (size_t i = 0; i < s->point_count; ++i) most = ab_larger(most, s->point_extent[i] + s->point_extent[s->point_ld + i]);
    return sqrt(most);
}

/* Points of both bodies near the other's faces, and how far a point has to look beyond its half size: 2 dt times the largest relative speed (the step is still
 * to change velocities), and inwards a part of a face or, where the bodies were deeper in each other than that, so far that they stay in touch. */
static ab_status ask_for_points(contact_pair *pair, double dt, ab_surface surface[2], double distance[2], ab_report *report) {
    enum { TRIES = 3 };
    contact_broad *broad = pair->broad;
    ab_domain *const body[2] = {pair->a, pair->b};
    const contact_box box[2] = {bounds(broad, pair->a, surface), bounds(broad, pair->b, surface + 1)};
    double *needed = broad->needed;
    for (int attempt = 0; attempt < TRIES; ++attempt) {
        for (int side = 0; side < 2; ++side) {
            contact_reach *reach = broad->reach + side;
            ab_surface *points = surface + 1 - side;
            points->point_count = 0;
            if (!surface[side].face_count || !body[1 - side]->ops->surface_points) continue;
            if (!contact_reach_update(reach, surface + side, broad->cell, broad->length[side], needed[side], box + 1 - side))
                return ab_report_failure(report, "no memory for %zu faces of '%s'", surface[side].face_count, body[side]->spec->name);
            const ab_region region = {broad->cell, reach->tile_count, reach->tile_key, reach->tile_cells};
            if (region.count) AB_TRY(body[1 - side]->ops->surface_points(body[1 - side], &region, points, report));
        }
        const contact_box velocity_a = velocities(pair->a, surface), velocity_b = velocities(pair->b, surface + 1);
        const bool any = surface[0].point_count || surface[1].point_count;
        broad->speed = any ? largest_difference(&velocity_a, &velocity_b) : pair->approach.speed;
        bool enough = true;
        for (int side = 0; side < 2; ++side) {
            const double most = ab_larger(LEAST_LEAP, ab_smaller(MOST_LEAP, sqrt(LEAP_COST / (1.0 + (double)surface[side].face_count))));
            const double inward = ab_larger(INWARD * broad->length[side], broad->depth + AHEAD * broad->length[side]);
            distance[side] = ab_smaller(2.0 * dt * broad->speed, most * broad->cell) + ab_smaller(inward, most * broad->cell);
            needed[side] = distance[side] + largest_half(surface + 1 - side);
            enough = enough && (!surface[1 - side].point_count || needed[side] <= broad->reach[side].reach);
        }
        if (enough) return AB_OK;
    }
    return AB_OK;
}

ab_status contact_surfaces(contact_pair *pair, double dt, ab_surface *a, ab_surface *b, ab_report *report) {
    contact_broad *broad = pair->broad;
    ab_surface surface[2];
    ab_domain *const body[2] = {pair->a, pair->b};
    AB_TRY(ask_for_faces(pair, surface, report));
    broad->reach[0].visits = broad->reach[1].visits = 0;
    if (broad->cell == 0.0 && !measure(broad, surface)) return no_length(pair, report);
    double distance[2];
    AB_TRY(ask_for_points(pair, dt, surface, distance, report));
    for (int side = 0; side < 2; ++side)
        if (!contact_reach_list(broad->reach + side, surface + side, surface + 1 - side, distance[side]))
            return ab_report_failure(report, "no memory for the faces of '%s' near %zu points of '%s'", body[side]->spec->name,
                                     surface[1 - side].point_count, body[1 - side]->spec->name);
    *a = surface[0];
    *b = surface[1];
    return AB_OK;
}
