/* fill_union.c: points in a union of shapes.
 *
 * Members that only touch are filled each on its own, with its own lattice, and where they touch there is no outline. Members that overlap are first
 * joined into one outline of straight edges; a disc or ring among those becomes one of many edges and the same area. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mpm/fill_union.h"

ab_status ab_outline_round(const ab_shape_spec *shape, size_t sides, bool equal_area, ab_outline *outline, const char *body,
                           ab_report *report) {
    const double inner = shape->kind == AB_SHAPE_RING ? shape->inner : 0, turn = 2 * AB_PI / (double)sides;
    const double scale = equal_area ? sqrt(turn / sin(turn)) : 1;
    *outline = (ab_outline){.count = inner > 0 ? 2 * sides : sides, .convex = !(inner > 0)};
    outline->area = 0.5 * (double)sides * sin(turn) * scale * scale * (shape->radius - inner) * (shape->radius + inner);
    outline->edge = malloc(outline->count * sizeof *outline->edge);
    if (!outline->edge) return ab_report_failure(report, "body '%s': no memory for an outline of %zu edges", body, outline->count);
    for (size_t k = 0; k < outline->count; k++) {
        const bool hole = k >= sides;
        double *place[2] = {outline->edge[k].from, outline->edge[k].to};
        for (size_t end = 0; end < 2; end++) {
            const size_t vertex = hole ? (2 * sides - k - end) % sides : (k + end) % sides; /* a hole is walked backwards */
            const double radius = scale * (hole ? inner : shape->radius);
            place[end][0] = shape->center[0] + radius * cos(turn * (double)vertex);
            place[end][1] = shape->center[1] + radius * sin(turn * (double)vertex);
        }
    }
    return AB_OK;
}

/* ---- members ------------------------------------------------------------------------------------------------------------ */

static size_t count_members(const ab_shape_spec *shape) {
    if (shape->kind != AB_SHAPE_UNION) return 1;
    size_t count = 0;
    for (size_t k = 0; k < shape->count; k++) count += count_members(&shape->members[k]);
    return count;
}

static void list_members(const ab_shape_spec *shape, ab_member *members, size_t *count) {
    if (shape->kind != AB_SHAPE_UNION) {
        members[(*count)++] = (ab_member){.shape = shape};
        return;
    }
    for (size_t k = 0; k < shape->count; k++) list_members(&shape->members[k], members, count);
}

static ab_status outline_box(const ab_shape_spec *shape, ab_outline *outline, const char *body, ab_report *report) {
    double corner[4][2] = {
        {shape->low[0], shape->low[1]}, {shape->high[0], shape->low[1]}, {shape->high[0], shape->high[1]}, {shape->low[0], shape->high[1]}};
    const ab_shape_spec polygon = {.kind = AB_SHAPE_POLYGON, .mark = shape->mark, .vertices = corner, .count = 4};
    return ab_outline_create(&polygon, outline, body, report);
}

static ab_status outline_member(const ab_filler *filler, ab_member *m) {
    const ab_shape_spec *shape = m->shape;
    AB_TRY(ab_fill_check(filler, shape));
    if (shape->kind == AB_SHAPE_BOX)
        AB_TRY(outline_box(shape, &m->outline, filler->body, filler->report));
    else if (shape->kind == AB_SHAPE_POLYGON)
        AB_TRY(ab_outline_create(shape, &m->outline, filler->body, filler->report));
    else { /* four edges above each point, and enough for a small one to be round */
        const double edges = fmin(1e6, fmax(64, ceil(2 * AB_PI * shape->radius / filler->spacing) * 4));
        AB_TRY(ab_outline_round(shape, 4 * (size_t)ceil(edges / 4), true, &m->outline, filler->body, filler->report));
    }
    for (int k = 0; k < 2; k++) {
        m->low[k] = INFINITY;
        m->high[k] = -INFINITY;
        for (size_t e = 0; e < m->outline.count; e++) {
            m->low[k] = fmin(m->low[k], m->outline.edge[e].from[k]);
            m->high[k] = fmax(m->high[k], m->outline.edge[e].from[k]);
        }
    }
    return AB_OK;
}

/* ---- where groups touch ------------------------------------------------------------------------------------------------- */

/* What one group is bounded by, and the pieces of outline it was given. */
typedef struct boundary {
    ab_outline outline;         /* straight edges; none of a single round member */
    const ab_shape_spec *round; /* or the single round member */
    double low[2], high[2];
    size_t first_piece, end_piece;
} boundary;

static bool same_circle(const ab_shape_spec *a, double radius_a, const ab_shape_spec *b, double radius_b, double slack) {
    return radius_a > 0 && radius_b > 0 && fabs(radius_a - radius_b) <= slack &&
           hypot(a->center[0] - b->center[0], a->center[1] - b->center[1]) <= slack;
}

static double inner_radius(const ab_shape_spec *s) { return s->kind == AB_SHAPE_RING ? s->inner : 0; }

/* Whether a piece of a disc or ring lies on a circle that the other fills from the other side. */
static bool covered_by_circle(const ab_outline_piece *s, const ab_shape_spec *own, const ab_shape_spec *other, double slack) {
    const bool outer = (s->position[0] - own->center[0]) * s->normal[0] + (s->position[1] - own->center[1]) * s->normal[1] > 0;
    return outer ? same_circle(own, own->radius, other, inner_radius(other), slack)
                 : same_circle(own, inner_radius(own), other, other->radius, slack);
}

/* Takes what an edge that runs the other way covers of a straight piece; true where that leaves two parts, the second in *rest. */
static bool uncover(ab_outline_piece *s, const ab_edge *edge, double slack, ab_outline_piece *rest) {
    const double t[2] = {-s->normal[1], s->normal[0]}; /* the piece runs along t, the body on its left */
    const double dx = edge->to[0] - edge->from[0], dy = edge->to[1] - edge->from[1], length = hypot(dx, dy);
    if (dx * t[0] + dy * t[1] > -(1 - 1e-9) * length) return false;
    const double from[2] = {edge->from[0] - s->position[0], edge->from[1] - s->position[1]};
    if (fabs(from[0] * s->normal[0] + from[1] * s->normal[1]) > slack) return false;
    const double high = from[0] * t[0] + from[1] * t[1], low = high - length, half = 0.5 * s->length; /* of the edge, along t */
    if (low >= half - slack || high <= -half + slack) return false;
    const double below = fmax(0, low + half), above = fmax(0, half - high); /* lengths left on either side */
    const ab_outline_piece old = *s;
    *rest = old;
    s->length = below > slack ? below : 0;
    rest->length = above > slack ? above : 0;
    for (int k = 0; k < 2; k++) {
        s->position[k] = old.position[k] + t[k] * (0.5 * s->length - half);
        rest->position[k] = old.position[k] + t[k] * (half - 0.5 * rest->length);
    }
    if (s->length == 0) {
        *s = *rest;
        return false;
    }
    return rest->length > 0;
}

/* Removes from the pieces of group a what group b covers; parts split off are appended. */
static ab_status uncover_group(ab_filler *filler, ab_mark mark, boundary *a, const boundary *b, double slack) {
    if (a->low[0] > b->high[0] + slack || b->low[0] > a->high[0] + slack || a->low[1] > b->high[1] + slack ||
        b->low[1] > a->high[1] + slack)
        return AB_OK;
    for (size_t k = a->first_piece; k < a->end_piece; k++) {
        ab_outline_piece *s = &filler->fill->surface[k];
        if (a->round) {
            if (b->round && covered_by_circle(s, a->round, b->round, slack)) s->length = 0;
            continue;
        }
        if (s->position[0] - s->length > b->high[0] || s->position[0] + s->length < b->low[0] || s->position[1] - s->length > b->high[1] ||
            s->position[1] + s->length < b->low[1])
            continue;
        for (size_t e = 0; e < b->outline.count && filler->fill->surface[k].length > 0; e++) {
            ab_outline_piece rest;
            if (!uncover(&filler->fill->surface[k], &b->outline.edge[e], slack, &rest)) continue;
            AB_TRY(ab_filler_reserve(filler, mark, 0, 1)); /* may move the list */
            filler->fill->surface[filler->fill->surface_count++] = rest;
        }
    }
    return AB_OK;
}

/* ---- the whole ---------------------------------------------------------------------------------------------------------- */

static ab_status fill_group(ab_filler *filler, ab_mark mark, ab_member *members, size_t count, size_t group, boundary *edge) {
    size_t in_group = 0;
    for (size_t k = 0; k < count; k++) in_group += members[k].group == group;
    ab_member *single = &members[group];
    edge->first_piece = filler->fill->surface_count;
    if (in_group > 1) {
        AB_TRY(ab_union_join(members, count, group, &edge->outline, filler->body, filler->report));
        AB_TRY(ab_fill_outline(filler, mark, &edge->outline));
    } else {
        AB_TRY(ab_fill_shape(filler, single->shape));
        if (single->shape->kind == AB_SHAPE_DISC || single->shape->kind == AB_SHAPE_RING) {
            edge->round = single->shape;
        } else {
            edge->outline = single->outline;
            single->outline = (ab_outline){0};
        }
    }
    edge->end_piece = filler->fill->surface_count;
    memcpy(edge->low, single->low, sizeof edge->low);
    memcpy(edge->high, single->high, sizeof edge->high);
    for (size_t k = 0; k < count; k++)
        for (int c = 0; c < 2 && members[k].group == group; c++) {
            edge->low[c] = fmin(edge->low[c], members[k].low[c]);
            edge->high[c] = fmax(edge->high[c], members[k].high[c]);
        }
    return AB_OK;
}

static ab_status fill_groups(ab_filler *filler, ab_mark mark, ab_member *members, size_t count, boundary *edges) {
    for (size_t k = 0; k < count; k++) AB_TRY(outline_member(filler, &members[k]));
    AB_TRY(ab_union_group(members, count, filler->body, filler->report));
    size_t groups = 0;
    for (size_t k = 0; k < count; k++)
        if (members[k].group == k) AB_TRY(fill_group(filler, mark, members, count, k, &edges[groups++]));
    const double *low = filler->fill->low, *high = filler->fill->high;
    const double slack = 1e-10 * fmax(high[0] - low[0], high[1] - low[1]);
    for (size_t a = 0; a < groups; a++) {
        const size_t appended = filler->fill->surface_count;
        for (size_t b = 0; b < groups; b++) {
            if (a == b) continue;
            AB_TRY(uncover_group(filler, mark, &edges[a], &edges[b], slack));
            boundary parts = edges[a]; /* parts split off by another group may be covered by this one */
            parts.first_piece = appended;
            parts.end_piece = filler->fill->surface_count;
            AB_TRY(uncover_group(filler, mark, &parts, &edges[b], slack));
        }
    }
    size_t kept = 0;
    for (size_t k = 0; k < filler->fill->surface_count; k++)
        if (filler->fill->surface[k].length > 0) filler->fill->surface[kept++] = filler->fill->surface[k];
    filler->fill->surface_count = kept;
    return AB_OK;
}

ab_status ab_fill_union(ab_filler *filler, const ab_shape_spec *shape) {
    size_t count = count_members(shape);
    if (count == 0)
        return ab_report_error(filler->report, shape->mark, "body '%s': a union of no shapes; it needs at least one", filler->body);
    ab_member *members = calloc(count, sizeof *members);
    boundary *edges = calloc(count, sizeof *edges);
    ab_status status = AB_OK;
    if (members && edges) {
        count = 0;
        list_members(shape, members, &count);
        status = fill_groups(filler, shape->mark, members, count, edges);
        for (size_t k = 0; k < count; k++) {
            ab_outline_clear(&members[k].outline);
            ab_outline_clear(&edges[k].outline);
        }
    } else {
        status = ab_report_failure(filler->report, "body '%s': no memory for a union of %zu shapes", filler->body, count);
    }
    free(members);
    free(edges);
    return status;
}

ab_status ab_union_outline(const ab_filler *filler, const ab_shape_spec *shape, ab_outline *outline) {
    size_t count = count_members(shape);
    *outline = (ab_outline){0};
    if (count == 0)
        return ab_report_error(filler->report, shape->mark, "body '%s': a union of no shapes; it needs at least one", filler->body);
    ab_member *members = calloc(count, sizeof *members);
    if (!members) return ab_report_failure(filler->report, "body '%s': no memory for a union of %zu shapes", filler->body, count);
    ab_status status = AB_OK;
    count = 0;
    list_members(shape, members, &count);
    for (size_t k = 0; k < count && status == AB_OK; k++) status = outline_member(filler, &members[k]); /* all in group 0 */
    if (status == AB_OK) status = ab_union_join(members, count, 0, outline, filler->body, filler->report);
    for (size_t k = 0; k < count; k++) ab_outline_clear(&members[k].outline);
    free(members);
    return status;
}
