/* overlap.c: bodies that are drawn, or pressed, into each other: what the user is told, and how deep the next look has to reach. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "contact/contact.h"
#include "core/vector.h"

static const double DEEP = 0.01, CROWDED = 1.1; /* of a cell, of a cell's volume: less is no overlap to speak of */
static const double FULL = 1.02;                /* of a cell's volume: what bodies side by side fill, as the points in elements have it */

/* ---- points of one body inside the outline of the other ------------------------------------------------------------------------------ */

enum { MOST_ROWS = 1024 };

typedef struct segment { /* a straight face, or half of a bent one */
    double from[2], to[2];
} segment;

typedef struct outline { /* all faces of a body, and which of them run through each of `rows` rows of equal height */
    segment *segments;
    size_t count, rows;
    size_t *start;
    uint32_t *in_row;
    double low, height; /* of the rows, m */
} outline;

typedef struct inside { /* points of one body that lie in the other */
    size_t count;
    double deepest; /* m */
} inside;

static void outline_clear(outline *o) { free(o->segments), free(o->start), free(o->in_row); }

static size_t row_of(const outline *o, double y) {
    const double row = (y - o->low) / o->height;
    return row > 0.0 ? (size_t)ab_smaller(row, (double)(o->rows - 1)) : 0;
}

static void rows_of(const outline *o, const segment *s, size_t *first, size_t *last) {
    *first = row_of(o, ab_smaller(s->from[1], s->to[1]));
    *last = row_of(o, ab_larger(s->from[1], s->to[1]));
}

/* False: no memory, or a face that is nowhere. */
static bool outline_of(const ab_surface *s, outline *o) {
    o->segments = malloc((2 * s->face_count + 1) * sizeof *o->segments);
    if (!o->segments) return false;
    double low = INFINITY, high = -INFINITY;
    for (size_t f = 0; f < s->face_count; ++f) {
        const uint32_t *v = s->face_vertex + 3 * f, chain[3] = {v[0], v[2], v[1]};
        for (int k = 0; k < 2; ++k) {
            const uint32_t begin = chain[k] == UINT32_MAX ? v[0] : chain[k], end = chain[k + 1] == UINT32_MAX ? v[1] : chain[k + 1];
            if (v[2] == UINT32_MAX && k == 1) continue;
            segment *e = o->segments + o->count++;
            for (size_t d = 0; d < 2; ++d) {
                e->from[d] = s->vertex_position[d * s->vertex_ld + begin];
                e->to[d] = s->vertex_position[d * s->vertex_ld + end];
                if (!isfinite(e->from[d] + e->to[d])) return false;
            }
            low = ab_smaller(low, ab_smaller(e->from[1], e->to[1]));
            high = ab_larger(high, ab_larger(e->from[1], e->to[1]));
        }
    }
    if (!(high > low)) return false;
    o->rows = o->count < MOST_ROWS ? o->count : MOST_ROWS;
    o->low = low;
    o->height = (high - low) / (double)o->rows;
    o->start = calloc(o->rows + 2, sizeof *o->start);
    if (!o->start) return false;
    size_t first, last;
    for (size_t k = 0; k < o->count; ++k)
        for (rows_of(o, o->segments + k, &first, &last); first <= last; ++first) ++o->start[first + 2];
    for (size_t r = 2; r < o->rows + 2; ++r) o->start[r] += o->start[r - 1];
    o->in_row = malloc((o->start[o->rows + 1] + 1) * sizeof *o->in_row);
    if (!o->in_row) return false;
    for (size_t k = 0; k < o->count; ++k)
        for (rows_of(o, o->segments + k, &first, &last); first <= last; ++first) o->in_row[o->start[first + 1]++] = (uint32_t)k;
    return true;
}

/* A ray to the right crosses an odd number of faces. */
static bool is_inside(const outline *o, const double x[2]) {
    if (!(x[1] >= o->low && x[1] <= o->low + o->height * (double)o->rows)) return false;
    const size_t row = row_of(o, x[1]);
    bool odd = false;
    for (size_t k = o->start[row]; k < o->start[row + 1]; ++k) {
        const segment *s = o->segments + o->in_row[k];
        if ((s->from[1] > x[1]) == (s->to[1] > x[1])) continue;
        odd ^= x[0] < s->from[0] + (x[1] - s->from[1]) / (s->to[1] - s->from[1]) * (s->to[0] - s->from[0]);
    }
    return odd;
}

static double distance_to(const segment *s, const double x[2]) {
    const double along[2] = {s->to[0] - s->from[0], s->to[1] - s->from[1]}, from[2] = {x[0] - s->from[0], x[1] - s->from[1]};
    const double square = along[0] * along[0] + along[1] * along[1];
    const double t = square > 0.0 ? ab_smaller(1.0, ab_larger(0.0, (from[0] * along[0] + from[1] * along[1]) / square)) : 0.0;
    return hypot(from[0] - t * along[0], from[1] - t * along[1]);
}

/* Depth of a place inside: looks at rows further and further away until none can be nearer, or until the answer no longer matters: it is `slight` or less, or more
 * than that and no deeper than `known`. */
static double depth_of(const outline *o, const double x[2], double slight, double known) {
    const size_t row = row_of(o, x[1]);
    double nearest = INFINITY;
    for (size_t away = 0; away < o->rows; ++away) {
        const double beyond = ((double)away - 1.0) * o->height; /* rows from here on are further than this */
        if (nearest <= slight || nearest <= beyond || (beyond > slight && nearest <= known)) break;
        for (int side = 0; side < (away ? 2 : 1); ++side) {
            if (side ? away > row : row + away >= o->rows) continue;
            const size_t r = side ? row - away : row + away;
            for (size_t k = o->start[r]; k < o->start[r + 1]; ++k)
                nearest = ab_smaller(nearest, distance_to(o->segments + o->in_row[k], x));
        }
    }
    return nearest;
}

/* Places of a body: its points or nodes, or where it cannot say the vertices of its faces, from the grid's corner; two components each. NULL: none, or no memory. */
static double *places_of(const ab_scene *scene, const ab_domain *body, const ab_surface *s, size_t *count, ab_report *report) {
    const bool read = body->ops->read && body->ops->count;
    *count = read ? body->ops->count(body) : s->vertex_count;
    double *x = malloc((2 * *count + 1) * sizeof *x);
    if (!x) return NULL;
    if (read && body->ops->read(body, "position", x, report) != AB_OK) {
        free(x);
        return NULL;
    }
    for (size_t i = 0; i < *count; ++i)
        for (size_t d = 0; d < 2; ++d) x[2 * i + d] = read ? x[2 * i + d] - scene->grid_from[d] : s->vertex_position[d * s->vertex_ld + i];
    return x;
}

/* Points of `body` deeper than `slight` in the faces of another. */
static inside look_inside(const ab_scene *scene, const ab_domain *body, const ab_surface *own, const ab_surface *faces, double slight,
                          ab_report *report) {
    inside found = {0};
    outline o = {0};
    size_t count = 0;
    double *x = faces->face_count ? places_of(scene, body, own, &count, report) : NULL;
    if (x && outline_of(faces, &o))
        for (size_t i = 0; i < count; ++i) {
            if (!is_inside(&o, x + 2 * i)) continue;
            const double depth = depth_of(&o, x + 2 * i, slight, found.deepest);
            if (!(depth > slight)) continue;
            ++found.count;
            found.deepest = ab_larger(found.deepest, depth);
        }
    outline_clear(&o);
    free(x);
    return found;
}

/* ---- what the user is told --------------------------------------------------------------------------------------------------------------- */

/* Around nodes of the grid both bodies together take more room than there is. */
static double most_crowded(const ab_scene *scene, const contact_pair *pair) {
    const size_t material_a = pair->a->spec->material, material_b = pair->b->spec->material;
    if (!pair->node_count || material_a == SIZE_MAX || material_b == SIZE_MAX) return 0.0; /* a rigid body may have no density */
    ab_node_tiles a, b;
    pair->a->ops->node_tiles(pair->a, &a);
    pair->b->ops->node_tiles(pair->b, &b);
    const double density_a = scene->materials[material_a].density, density_b = scene->materials[material_b].density;
    double most = 0.0;
    for (size_t k = 0; k < pair->node_count; ++k) {
        double room = a.mass[pair->nodes_a[k] * a.stride] / density_a + b.mass[pair->nodes_b[k] * b.stride] / density_b;
        if (pair->points.view.axisymmetric) { /* volumes of rings; on the axis there is half of one only */
            const int column = ab_tile_x(a.key[pair->nodes_a[k] / AB_TILE_NODES]) * AB_TILE + (int)(pair->nodes_a[k] % AB_TILE);
            room = column > 0 ? room / ab_circumference(column * scene->grid_cell) : 0.0;
        }
        most = ab_larger(most, room);
    }
    return most;
}

/* The deepest penetration, m, 0 or more; *which: of that point, if there is one. */
static double deepest_of(const ab_points *p, size_t *which) {
    double deepest = 0.0;
    *which = 0;
    for (size_t i = 0; i < p->count; ++i)
        if (-p->gap[i] > deepest) deepest = -p->gap[i], *which = i;
    return deepest;
}

static double deepest_point(const ab_points *p) {
    size_t which;
    return deepest_of(p, &which);
}

/* With surfaces every point of a body is looked for in the other, however deep: contact itself only sees those near a face. */
static bool warn_of_points_inside(const ab_scene *scene, const contact_pair *pair, ab_report *report) {
    ab_domain *const body[2] = {pair->a, pair->b};
    ab_surface surface[2] = {{.struct_size = sizeof *surface, .dimension = 2}, {.struct_size = sizeof *surface, .dimension = 2}};
    for (int k = 0; k < 2; ++k)
        if (body[k]->ops->faces && body[k]->ops->faces(body[k], surface + k, report) != AB_OK) return false;
    char text[2][256] = {"", ""};
    bool any = false;
    double deepest = 0.0;
    for (int k = 0; k < 2; ++k) {
        const inside found = look_inside(scene, body[k], surface + k, surface + 1 - k, DEEP * contact_broad_cell(pair->broad), report);
        if (!found.count) continue;
        snprintf(text[k], sizeof text[k], "%s%zu point%s of '%.80s' in '%.80s', up to %.3g m deep", any ? ", and " : "", found.count,
                 found.count == 1 ? "" : "s", body[k]->spec->name, body[1 - k]->spec->name, found.deepest);
        any = true;
        deepest = ab_larger(deepest, found.deepest);
    }
    if (!any) return false;
    contact_broad_note_depth(pair->broad, deepest); /* from the next step on contact has hold of them */
    const bool deep = 2.0 * deepest > contact_broad_face(pair->broad);
    if (deep) contact_broad_tell(pair->broad);
    ab_report_warning(
        report, pair->spec->mark,
        "bodies '%s' and '%s' overlap at the start, %s%s, and stay so: contact does not push them apart%s; draw them side by side",
        pair->a->spec->name, pair->b->spec->name, text[0], text[1],
        deep ? ", and what has come past the middle of a body may fall out behind" : "");
    return true;
}

void contact_warn_of_overlap(const ab_scene *scene, const contact_pair *pair, ab_report *report) {
    const double h = pair->points.view.cell;
    if (pair->broad && warn_of_points_inside(scene, pair, report)) return;
    const ab_points *p = &pair->points.view;
    size_t which;
    const double deepest = deepest_of(p, &which), crowded = most_crowded(scene, pair);
    if (deepest <= DEEP * h && crowded <= CROWDED * h * h) return;
    if (!pair->broad && crowded > 0.0 && crowded <= FULL * h * h) { /* nowhere is there more of them than there is room for */
        ab_report_warning(report, pair->spec->mark,
                          "bodies '%s' and '%s' fit into each other near (%.6g, %.6g) m, by a corner in a corner or one thinner than two "
                          "cells between two parts "
                          "of the other: '%s' sees them %.3g m deep in each other there, and cannot tell on which side each is; use "
                          "point-to-segment, or a "
                          "smaller cell. (If they are drawn into each other, draw them side by side: contact does not push them apart)",
                          pair->a->spec->name, pair->b->spec->name, p->position[which] + scene->grid_from[0],
                          p->position[p->ld + which] + scene->grid_from[1], pair->spec->finder->class_.name, deepest);
        return;
    }
    ab_report_warning(report, pair->spec->mark,
                      "bodies '%s' and '%s' overlap at the start, and stay so: contact does not push them apart; draw them side by side",
                      pair->a->spec->name, pair->b->spec->name);
}

void contact_watch_depth(contact_pair *pair, ab_report *report) {
    const ab_points *p = &pair->points.view;
    const double depth = deepest_point(p), face = contact_broad_face(pair->broad);
    contact_broad_note_depth(pair->broad, depth);
    if (!(depth > face && p->time > 0.0) || !contact_broad_tell(pair->broad)) return;
    ab_report_warning(
        report, pair->spec->mark,
        "at %.6g s bodies '%s' and '%s' are %.3g m deep in each other, more than a face is long (%.3g m): contact follows them, but no "
        "longer knows for certain which face a point came through; use stiffer springs, a smaller dt, recovery, or faces as long as "
        "the overlap that is meant",
        p->time, pair->a->spec->name, pair->b->spec->name, depth, face);
}
