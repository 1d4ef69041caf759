/* node_area.h: how much of the face that two bodies share belongs to each contact point on shared nodes, two dimensions. For finders in this folder.
 *
 * A body's area vector at a node, sum_p V_p G_ip, is the node's share of its face; but points that stand differently give two bodies that touch different shares at one
 * node, and nodes that only one of them reaches are not seen at all. The smaller of both shares, node by node, adds up to too little, by up to a half. So the face is
 * measured itself: it lies across the normal half way between the bodies, as far as points of both lie beside it. Its length is handed to the nodes around each piece by the hat
 * functions of the grid, which add up to 1 (over the contact points among them), and then, across the face, to contact points in proportion to the harmonic mean of both bodies'
 * shares there: a basis that reaches further spreads it further, and a node that one body hardly reaches gets next to nothing, as that body's points would not feel what acts
 * there (a vane in clay lost a hundredth of its torque so). Neither step loses anything: areas of contact points add up to the length, if neighbouring nodes see the same face. So each looks along the mean normal of its neighbours, at all points that may cover what its hat function sees, and contact points that are open beside
 * shut ones, as those whose normal leans over the corner of a body, hand their part on to these. */
#ifndef NODE_AREA_H
#define NODE_AREA_H

#include <math.h>
#include <stdint.h>

#include "abut_plugin.h"
#include "closest_approach.h"

enum { AREA_PIECES = 12, AREA_REACH = 2, AREA_WIDE = 2 * AREA_REACH + 1 }; /* pieces of a face to either side of the node; nodes */
static const double AREA_PIECE = 0.125;                                    /* of a cell */
static const double AREA_DEPTH = 0.5; /* of a cell: points whose sides are deeper below the furthest one are no part of the face */

typedef struct node_areas { /* nodes by their place on the grid, and what was found at each */
    uint32_t *table;        /* number + 1 of the node that hashes there, 0: none; a power of two */
    size_t slots;
    int32_t *place;  /* 2 per node: in cells */
    double *share;   /* per node: harmonic mean of both shares; negative where there is no contact point */
    uint32_t *node;  /* per contact point; */
    uint32_t *point; /* per node: its contact point */
    size_t capacity;
} node_areas;

static inline void node_areas_release(const ab_host *host, node_areas *w) {
    host->release(host->context, w->table), host->release(host->context, w->place), host->release(host->context, w->share);
    host->release(host->context, w->node), host->release(host->context, w->point);
    *w = (node_areas){0};
}

/* Room for `count` nodes. 0: no memory. */
static int node_areas_reserve(const ab_host *host, node_areas *w, size_t count) {
    if (count <= w->capacity) return 1;
    node_areas_release(host, w);
    const size_t n = 2 * count + 32;
    size_t slots = 64;
    while (slots < 2 * n) slots *= 2;
    w->table = host->allocate(host->context, slots * sizeof *w->table);
    w->place = host->allocate(host->context, 2 * n * sizeof *w->place);
    w->share = host->allocate(host->context, n * sizeof *w->share);
    w->node = host->allocate(host->context, n * sizeof *w->node);
    w->point = host->allocate(host->context, n * sizeof *w->point);
    if (!w->table || !w->place || !w->share || !w->node || !w->point) return 0;
    w->slots = slots;
    w->capacity = n;
    return 1;
}

static size_t node_areas_hash(const node_areas *w, int32_t x, int32_t y) {
    const uint64_t mixed = ((uint64_t)(uint32_t)x * 0x9e3779b1u) ^ ((uint64_t)(uint32_t)y * 0x85ebca77u);
    return (size_t)(mixed ^ mixed >> 15) & (w->slots - 1);
}

/* Number + 1 of the node there, 0: none is shared. */
static uint32_t node_areas_at(const node_areas *w, int32_t x, int32_t y) {
    for (size_t slot = node_areas_hash(w, x, y); w->table[slot]; slot = (slot + 1) & (w->slots - 1)) {
        const int32_t *at = w->place + 2 * (size_t)(w->table[slot] - 1);
        if (at[0] == x && at[1] == y) return w->table[slot];
    }
    return 0;
}

/* The contact points around node i, by node: number + 1 of the node, 0 where there is none. */
static void node_areas_around(const node_areas *w, size_t i, uint32_t around[AREA_WIDE * AREA_WIDE]) {
    const int32_t *at = w->place + 2 * i;
    for (int y = 0; y < AREA_WIDE; ++y)
        for (int x = 0; x < AREA_WIDE; ++x) {
            const uint32_t found = node_areas_at(w, at[0] + x - AREA_REACH, at[1] + y - AREA_REACH);
            around[y * AREA_WIDE + x] = found && w->share[found - 1] >= 0.0 ? found : 0;
        }
}

static const double AREA_BESIDE = 0.25; /* of a cell: how far a body reaches is what its points beside the node say; */
static const double AREA_SLOPE = 0.5;   /* m/m: those further aside count for so much less, as the normal may lean */
static const double AREA_OPEN = 0.02; /* of a cell: a contact point that is further open than one beside it that touches carries nothing */

typedef struct
    face_cover { /* of one body, along the face from the node, in pieces: the stretch of each that its points lie beside, 0 to 1 */
    double low[2 * AREA_PIECES], high[2 * AREA_PIECES];
    double reach; /* m, along the direction towards the other body, from the node */
} face_cover;

/* True where only points in the cells that meet at a node are listed for it, not all that cover what its hat function sees: linear shape functions. */
static int lists_end_at_cells(const ab_trace *t) {
    const double *x = t->near_position, *y = x + t->near_ld;
    for (size_t i = 0; i < t->count; ++i)
        for (size_t k = t->near_start[i]; k < t->near_start[i + 1]; ++k)
            if (fabs(x[k] - t->position[i]) > t->cell || fabs(y[k] - t->position[t->ld + i]) > t->cell) return 0;
    return 1;
}

/* The nodes whose lists hold all points that may cover the face at node i, itself first. */
static int lists_around(const node_areas *w, size_t i, int wide, size_t list[9]) {
    int count = 1;
    list[0] = i;
    if (!wide) return count;
    const int32_t *at = w->place + 2 * i;
    for (int32_t k = 0; k < 9; ++k) {
        const uint32_t found = k == 4 ? 0 : node_areas_at(w, at[0] + k % 3 - 1, at[1] + k / 3 - 1);
        if (found) list[count++] = found - 1;
    }
    return count;
}

/* n: towards the other body. */
static void face_cover_of(const ab_trace *t, size_t i, const size_t *list, int lists, const double n[2], face_cover *cover) {
    const double *x = t->near_position, *y = x + t->near_ld, *xx = t->near_extent, *yy = xx + t->near_ld, *xy = yy + t->near_ld;
    const double px = t->position[i], py = t->position[t->ld + i], inverse = 1.0 / (AREA_PIECE * t->cell);
    const double nn[3] = {n[0] * n[0], n[1] * n[1], 2.0 * n[0] * n[1]};
    cover->reach = -INFINITY;
    for (int l = 0; l < lists; ++l)
        for (size_t k = t->near_start[list[l]]; k < t->near_start[list[l] + 1]; ++k) {
            const double rx = x[k] - px, ry = y[k] - py, aside = larger(fabs(ry * n[0] - rx * n[1]) - AREA_BESIDE * t->cell, 0.0);
            cover->reach = larger(cover->reach, rx * n[0] + ry * n[1] + sqrt(larger(nn[0] * xx[k] + nn[1] * yy[k] + nn[2] * xy[k], 0.0)) -
                                                    AREA_SLOPE * aside);
        }
    for (int q = 0; q < 2 * AREA_PIECES; ++q) cover->low[q] = 1.0, cover->high[q] = 0.0;
    for (int l = 0; l < lists; ++l)
        for (size_t k = t->near_start[list[l]]; k < t->near_start[list[l] + 1]; ++k) {
            const double rx = x[k] - px, ry = y[k] - py, depth = cover->reach - AREA_DEPTH * t->cell - (rx * n[0] + ry * n[1]);
            const double along2 = nn[0] * xx[k] + nn[1] * yy[k] + nn[2] * xy[k];
            if (depth > 0.0 && depth * depth > along2) continue;
            const double half = sqrt(larger(nn[1] * xx[k] + nn[0] * yy[k] - nn[2] * xy[k], 0.0)), s = ry * n[0] - rx * n[1];
            const double from = larger((s - half) * inverse + AREA_PIECES, 0.0),
                         to = smaller((s + half) * inverse + AREA_PIECES, 2 * AREA_PIECES - 1e-9);
            for (int q = (int)from; q <= (int)to && from < to; ++q) {
                cover->low[q] = smaller(cover->low[q], larger(from - q, 0.0));
                cover->high[q] = larger(cover->high[q], smaller(to - q, 1.0));
            }
        }
}

/* What the hat function of node i takes of the face there, m; of two or more contact points around a piece each takes its part. */
static double face_length(const node_areas *w, const ab_trace *a, const ab_trace *b, size_t i, const int wide[2], const double n[2],
                          const uint32_t around[AREA_WIDE * AREA_WIDE]) {
    face_cover of_a, of_b;
    size_t list[9];
    int lists = lists_around(w, i, wide[0], list);
    face_cover_of(a, i, list, lists, n, &of_a);
    lists = lists_around(w, i, wide[1], list);
    face_cover_of(b, i, list, lists, (const double[2]){-n[0], -n[1]}, &of_b);
    const double inverse = 1.0 / a->cell, across = 0.5 * (of_a.reach - of_b.reach) * inverse; /* half way between both */
    double sum = 0.0;
    for (int q = 0; q < 2 * AREA_PIECES; ++q) {
        const int r = 2 * AREA_PIECES - 1 - q; /* b looks the other way */
        const double covered = smaller(of_a.high[q], 1.0 - of_b.low[r]) - larger(of_a.low[q], 1.0 - of_b.high[r]);
        if (!(covered > 0.0)) continue;
        const double s = AREA_PIECE * (q + 0.5 - AREA_PIECES), x = across * n[0] - s * n[1], y = across * n[1] + s * n[0];
        if (!(fabs(x) < 1.0 && fabs(y) < 1.0)) continue;
        const int dx = x < 0.0 ? -1 : 1, dy = y < 0.0 ? -1 : 1, middle = AREA_REACH * AREA_WIDE + AREA_REACH;
        const double u = fabs(x), v = fabs(y), own = (1.0 - u) * (1.0 - v);
        double all = own;
        if (around[middle + dx]) all += u * (1.0 - v);
        if (around[middle + dy * AREA_WIDE]) all += (1.0 - u) * v;
        if (around[middle + dy * AREA_WIDE + dx]) all += u * v;
        sum += covered * own / all;
    }
    return sum * AREA_PIECE * a->cell;
}

/* How far the contact point of each node is shut, 1 to 0: next to one that touches an open one has no part in the face. At the ends of a face there are such, where
 * the normal leans over the corner of a body. */
static void shut_around(const node_areas *w, const ab_points *out, double cell, const uint32_t around[AREA_WIDE * AREA_WIDE],
                        double shut[AREA_WIDE * AREA_WIDE]) {
    double least = INFINITY;
    for (int at = 0; at < AREA_WIDE * AREA_WIDE; ++at)
        if (around[at]) least = smaller(least, out->gap[w->point[around[at] - 1]]);
    for (int at = 0; at < AREA_WIDE * AREA_WIDE; ++at)
        shut[at] =
            around[at] ? larger(1.0 - larger(out->gap[w->point[around[at] - 1]] - larger(least, 0.0), 0.0) / (AREA_OPEN * cell), 0.0) : 0.0;
}

/* The normal of the face around node i: that of the contact points there and beside it, each as much as it has of the face. */
static void face_normal_around(const node_areas *w, const ab_points *out, size_t own, const uint32_t around[AREA_WIDE * AREA_WIDE],
                               const double shut[AREA_WIDE * AREA_WIDE], double n[2]) {
    n[0] = n[1] = 0.0;
    for (int y = AREA_REACH - 1; y <= AREA_REACH + 1; ++y)
        for (int x = AREA_REACH - 1; x <= AREA_REACH + 1; ++x) {
            const uint32_t found = around[y * AREA_WIDE + x];
            if (!found) continue;
            const size_t k = w->point[found - 1];
            for (size_t c = 0; c < 2; ++c) n[c] += shut[y * AREA_WIDE + x] * w->share[found - 1] * out->normal[c * out->ld + k];
        }
    const double length = sqrt(n[0] * n[0] + n[1] * n[1]);
    for (size_t c = 0; c < 2; ++c) n[c] = length > 0.0 ? n[c] / length : out->normal[c * out->ld + own];
}

/* Areas of all contact points; w->node says of which node each is. */
static void node_areas_share(node_areas *w, const ab_trace *a, const ab_trace *b, ab_points *out) {
    for (size_t slot = 0; slot < w->slots; ++slot) w->table[slot] = 0;
    for (size_t i = 0; i < a->count; ++i) {
        int32_t *x = w->place + 2 * i;
        for (size_t c = 0; c < 2; ++c) x[c] = (int32_t)rint(a->position[c * a->ld + i] / a->cell);
        size_t slot = node_areas_hash(w, x[0], x[1]);
        while (w->table[slot]) slot = (slot + 1) & (w->slots - 1);
        w->table[slot] = (uint32_t)i + 1;
        w->share[i] = -1.0;
    }
    for (size_t k = 0; k < out->count; ++k) {
        const size_t i = w->node[k];
        double of_a = 0.0, of_b = 0.0;
        for (size_t c = 0; c < 2; ++c) {
            of_a += out->normal[c * out->ld + k] * a->area_vector[c * a->ld + i];
            of_b -= out->normal[c * out->ld + k] * b->area_vector[c * b->ld + i];
        }
        /* in a body thinner than a cell the area vector may point the wrong way */
        w->share[i] = of_a > 0.0 && of_b > 0.0 ? 2.0 * of_a * of_b / (of_a + of_b) : larger(0.5 * (of_a + of_b), 0.0);
        w->point[i] = (uint32_t)k;
        out->area[k] = 0.0;
    }
    const int wide[2] = {lists_end_at_cells(a), lists_end_at_cells(b)};
    for (size_t k = 0; k < out->count; ++k) {
        const size_t i = w->node[k];
        double n[2];
        uint32_t around[AREA_WIDE * AREA_WIDE];
        node_areas_around(w, i, around);
        double shut[AREA_WIDE * AREA_WIDE];
        shut_around(w, out, a->cell, around, shut);
        face_normal_around(w, out, k, around, shut, n);
        const double length = face_length(w, a, b, i, wide, n, around);
        if (!(length > 0.0)) continue;
        double weight[AREA_WIDE * AREA_WIDE], sum = 0.0;
        for (int at = 0; at < AREA_WIDE * AREA_WIDE; ++at) {
            const double along = (at % AREA_WIDE - AREA_REACH) * n[1] - (at / AREA_WIDE - AREA_REACH) * n[0];
            weight[at] = around[at] ? larger(1.0 - fabs(along), 0.0) * w->share[around[at] - 1] * shut[at] : 0.0;
            sum += weight[at];
        }
        if (!(sum > 0.0)) {
            out->area[k] += length;
            continue;
        }
        for (int at = 0; at < AREA_WIDE * AREA_WIDE; ++at)
            if (weight[at] > 0.0) out->area[w->point[around[at] - 1]] += length * weight[at] / sum;
    }
}

#endif
