/* fill_polygon.c: points in an outline of straight edges: one in every cell of a lattice fitted to it, at the centroid of what the body fills.
 *
 * regular: cells of about the spacing. gauss: cells of about the grid's, with Gauss points where they are whole; those that the outline cuts are
 * divided and filled as regular. A cell that is filled less than 0.3 goes with its neighbour. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mpm/fill_outline.h"

typedef struct coarse {
    uint64_t key;
    uint32_t first;
    bool broken;
} coarse; /* a cell of the undivided lattice near the outline; first: its Gauss points */

typedef struct job { /* an outline being filled */
    ab_filler *filler;
    const ab_outline *outline;
    ab_frame frame;
    ab_cells cells;
    uint32_t parts; /* cells of the divided lattice in one of the undivided */
    bool gauss;
    ab_gauss rule[2];
    coarse *coarse; /* gauss: ordered by key */
    size_t coarse_count;
    uint32_t *point; /* of each listed cell that is a root */
} job;

static int by_key(const void *a, const void *b) {
    const coarse *p = a, *q = b;
    return (p->key > q->key) - (p->key < q->key);
}

static uint64_t coarse_key(const job *w, uint32_t i, uint32_t j) { return (uint64_t)(j / w->parts) << 32 | (i / w->parts); }

static coarse *find_coarse(const job *w, uint32_t i, uint32_t j) {
    if (w->coarse_count == 0) return NULL;
    const coarse wanted = {.key = coarse_key(w, i, j)};
    return bsearch(&wanted, w->coarse, w->coarse_count, sizeof wanted, by_key);
}

/* Coarse cells that the outline comes near; broken where a part of one is not full, or has been given a sliver. */
static ab_status list_coarse(job *w, ab_mark mark) {
    int more, fewer;
    AB_TRY(ab_gauss_factors(w->filler, mark, &more, &fewer));
    double side[2];
    for (int k = 0; k < 2; k++) side[k] = w->cells.lines[k].line[w->cells.lines[k].count] - w->cells.lines[k].line[0];
    const int longer = side[1] > side[0] * (1 + 1e-9);
    ab_gauss_rule(more, &w->rule[longer]);
    ab_gauss_rule(fewer, &w->rule[!longer]);
    w->coarse = malloc(w->cells.count * sizeof *w->coarse);
    if (!w->coarse) return ab_report_failure(w->filler->report, "body '%s': no memory for %zu cut cells", w->filler->body, w->cells.count);
    for (size_t k = 0; k < w->cells.count; k++) {
        const ab_cell *c = &w->cells.cell[k];
        w->coarse[k] = (coarse){.key = coarse_key(w, c->i, c->j), .broken = !c->full || c->root != k};
    }
    qsort(w->coarse, w->cells.count, sizeof *w->coarse, by_key);
    for (size_t k = 0; k < w->cells.count; k++) {
        if (w->coarse_count > 0 && w->coarse[w->coarse_count - 1].key == w->coarse[k].key)
            w->coarse[w->coarse_count - 1].broken |= w->coarse[k].broken;
        else
            w->coarse[w->coarse_count++] = w->coarse[k];
    }
    return AB_OK;
}

/* ---- points ------------------------------------------------------------------------------------------------------------- */

/* A point at a place in the frame, with an extent in the frame. */
static uint32_t add_point(const job *w, const double u[2], double volume, double uu, double vv, double uv) {
    const double c = w->frame.c, s = w->frame.s;
    double x[2];
    ab_frame_out(&w->frame, u, x);
    return ab_filler_point(w->filler, x[0], x[1], volume, c * c * uu - 2 * c * s * uv + s * s * vv,
                           s * s * uu + 2 * c * s * uv + c * c * vv, c * s * (uu - vv) + (c * c - s * s) * uv);
}

static uint32_t add_gauss_points(const job *w, uint32_t i, uint32_t j) {
    const double *u = &w->cells.lines[0].line[i], *v = &w->cells.lines[1].line[j];
    const double width = u[w->parts] - u[0], height = v[w->parts] - v[0];
    const uint32_t first = (uint32_t)w->filler->fill->count;
    for (int r = 0; r < w->rule[1].count; r++)
        for (int q = 0; q < w->rule[0].count; q++) {
            const double half_u = width * w->rule[0].half[q], half_v = height * w->rule[1].half[r];
            const double at[2] = {0.5 * (u[0] + u[w->parts]) + width * (w->rule[0].place[q] - 0.5),
                                  0.5 * (v[0] + v[w->parts]) + height * (w->rule[1].place[r] - 0.5)};
            add_point(w, at, width * height * w->rule[0].weight[q] * w->rule[1].weight[r], half_u * half_u, half_v * half_v, 0);
        }
    return first;
}

/* The point of a full cell that the outline does not touch, or the Gauss points of the coarse cell that it begins. */
static uint32_t add_full(const job *w, uint32_t i, uint32_t j) {
    if (w->gauss) {
        coarse *near = find_coarse(w, i, j);
        if (!near || !near->broken) {
            if (i % w->parts != 0 || j % w->parts != 0) return UINT32_MAX;
            const uint32_t first = add_gauss_points(w, i, j);
            if (near) near->first = first;
            return first;
        }
    }
    const double *u = &w->cells.lines[0].line[i], *v = &w->cells.lines[1].line[j];
    const double width = u[1] - u[0], height = v[1] - v[0];
    return add_point(w, (double[2]){0.5 * (u[0] + u[1]), 0.5 * (v[0] + v[1])}, width * height, 0.25 * width * width, 0.25 * height * height,
                     0);
}

/* The point of a cell that the outline cuts, with what was merged into it. */
static uint32_t add_cut(const job *w, const ab_cell *cell) {
    const ab_moments *m = &cell->moments;
    const double *u = &w->cells.lines[0].line[cell->i], *v = &w->cells.lines[1].line[cell->j];
    const double mean[2] = {m->u / m->area, m->v / m->area};
    double at[2] = {0.5 * (u[0] + u[1]) + mean[0], 0.5 * (v[0] + v[1]) + mean[1]};
    /* the centroid of a piece of a concave body may lie outside of it; the nearest thing to it is the middle of a stretch of body there */
    if (!w->outline->convex && !ab_cells_inside(&w->cells, at)) ab_cells_place_inside(&w->cells, cell, at);
    /* a full cell has a^2/3 of second moment: three times that is its half size squared */
    return add_point(w, at, m->area, 3 * (m->uu / m->area - mean[0] * mean[0]), 3 * (m->vv / m->area - mean[1] * mean[1]),
                     3 * (m->uv / m->area - mean[0] * mean[1]));
}

static ab_status add_points(const job *w, ab_mark mark) {
    const ab_cells *cells = &w->cells;
    const double per_cell = w->gauss ? (double)w->rule[0].count * w->rule[1].count : 1;
    for (uint32_t j = 0; j < cells->lines[1].count; j++) {
        double wanted = 0;
        for (size_t k = cells->row[j]; k < cells->row[j + 1]; k++)
            wanted += 1 + (cells->cell[k].inside_after && k + 1 < cells->row[j + 1] ? cells->cell[k + 1].i - cells->cell[k].i - 1 : 0);
        AB_TRY(ab_filler_reserve(w->filler, mark, wanted * per_cell, 0));
        for (size_t k = cells->row[j]; k < cells->row[j + 1]; k++) {
            const ab_cell *c = &cells->cell[k];
            const double *u = &cells->lines[0].line[c->i], *v = &cells->lines[1].line[c->j];
            const double full = (u[1] - u[0]) * (v[1] - v[0]);
            if (c->root == k && c->full)
                w->point[k] = add_full(w, c->i, j);
            else if (c->root == k && c->moments.area > 1e-12 * full)
                w->point[k] = add_cut(w, c);
            if (!c->inside_after || k + 1 == cells->row[j + 1]) continue;
            for (uint32_t i = c->i + 1; i < cells->cell[k + 1].i; i++) add_full(w, i, j);
        }
    }
    return AB_OK;
}

/* ---- pieces of outline -------------------------------------------------------------------------------------------------- */

typedef struct run {
    uint32_t edge, point;
    double a[2], b[2];
} run; /* pieces of one edge above one point, joined as they come */

static ab_status flush(const job *w, ab_mark mark, run *piece) {
    const double length = hypot(piece->b[0] - piece->a[0], piece->b[1] - piece->a[1]);
    if (piece->point == UINT32_MAX || length == 0) return AB_OK;
    AB_TRY(ab_filler_reserve(w->filler, mark, 0, 1));
    const ab_edge *edge = &w->outline->edge[piece->edge];
    const double dx = edge->to[0] - edge->from[0], dy = edge->to[1] - edge->from[1], whole = hypot(dx, dy);
    double x[2];
    ab_frame_out(&w->frame, (double[2]){0.5 * (piece->a[0] + piece->b[0]), 0.5 * (piece->a[1] + piece->b[1])}, x);
    ab_filler_piece(w->filler, piece->point, x[0], x[1], dy / whole, -dx / whole, length);
    return AB_OK;
}

static ab_status lengthen(const job *w, ab_mark mark, run *piece, uint32_t edge, uint32_t point, const double a[2], const double b[2]) {
    if (piece->edge != edge || piece->point != point) {
        AB_TRY(flush(w, mark, piece));
        *piece = (run){edge, point, {a[0], a[1]}, {0, 0}};
    }
    memcpy(piece->b, b, sizeof piece->b);
    return AB_OK;
}

/* A piece along the side of a whole coarse cell: each Gauss point next to it has its share. */
static ab_status share_piece(const job *w, ab_mark mark, run *piece, const ab_cut *cut, const ab_cell *cell, uint32_t first) {
    const double delta[2] = {cut->b[0] - cut->a[0], cut->b[1] - cut->a[1]};
    const int along = fabs(delta[1]) > fabs(delta[0]);
    const bool up = delta[along] > 0;
    const ab_gauss *rule = &w->rule[along];
    const uint32_t begin = (along ? cell->j : cell->i) / w->parts * w->parts;
    const double *line = &w->cells.lines[along].line[begin], size = line[w->parts] - line[0];
    /* the body is on the left: going right along the bottom, left along the top, up along the right side, down along the left one */
    const int across = (along == 0) == up ? 0 : w->rule[!along].count - 1;
    double at[2] = {cut->a[0], cut->a[1]};
    for (int k = 0; k < rule->count; k++) {
        const int q = up ? k : rule->count - 1 - k;
        double end = line[0] + size * rule->share[up ? q + 1 : q];
        if (k + 1 == rule->count || (up ? end > cut->b[along] : end < cut->b[along])) end = cut->b[along];
        if (up ? end <= at[along] : end >= at[along]) continue;
        double to[2] = {cut->b[0], cut->b[1]};
        to[along] = end;
        to[!along] = cut->a[!along] + (end - cut->a[along]) / delta[along] * delta[!along];
        const int column = along ? across : q, row = along ? q : across;
        AB_TRY(lengthen(w, mark, piece, cut->edge, first + (uint32_t)(row * w->rule[0].count + column), at, to));
        memcpy(at, to, sizeof at);
    }
    return AB_OK;
}

static ab_status add_pieces(const job *w, ab_mark mark) {
    run piece = {.point = UINT32_MAX};
    for (size_t k = 0; k < w->cells.cut_count; k++) {
        const ab_cut *cut = &w->cells.cut[k];
        const ab_cell *cell = &w->cells.cell[cut->cell];
        const coarse *near = w->gauss ? find_coarse(w, cell->i, cell->j) : NULL;
        if (near && !near->broken)
            AB_TRY(share_piece(w, mark, &piece, cut, cell, near->first));
        else
            AB_TRY(lengthen(w, mark, &piece, cut->edge, w->point[ab_cells_root(&w->cells, cut->cell)], cut->a, cut->b));
    }
    return flush(w, mark, &piece);
}

/* ---- the whole ---------------------------------------------------------------------------------------------------------- */

static ab_status lay_lattice(job *w) {
    const size_t count = w->outline->count;
    ab_edge *edge = malloc(count * sizeof *edge);
    if (!edge) return ab_report_failure(w->filler->report, "body '%s': no memory for an outline of %zu edges", w->filler->body, count);
    for (size_t e = 0; e < count; e++) {
        ab_frame_in(&w->frame, w->outline->edge[e].from, edge[e].from);
        ab_frame_in(&w->frame, w->outline->edge[e].to, edge[e].to);
    }
    const double size = w->gauss ? w->filler->cell : w->filler->spacing;
    ab_lines lines[2] = {{0}, {0}};
    ab_status status = AB_OK;
    for (int k = 0; k < 2 && status == AB_OK; k++) status = ab_lines_create(edge, count, k, size, w->parts, &lines[k], w->filler);
    if (status == AB_OK)
        status = ab_cells_create(edge, count, lines, &w->cells, w->filler);
    else
        for (int k = 0; k < 2; k++) free(lines[k].line);
    free(edge);
    return status;
}

static ab_status fill_lattice(job *w, ab_mark mark) {
    AB_TRY(ab_cells_merge(&w->cells, w->filler));
    w->point = malloc(w->cells.count * sizeof *w->point);
    if (!w->point) return ab_report_failure(w->filler->report, "body '%s': no memory for %zu cut cells", w->filler->body, w->cells.count);
    memset(w->point, 0xff, w->cells.count * sizeof *w->point);
    if (w->gauss) AB_TRY(list_coarse(w, mark));
    const size_t first_piece = w->filler->fill->surface_count;
    AB_TRY(add_points(w, mark));
    AB_TRY(add_pieces(w, mark));
    return ab_fill_fit_extents(w->filler, first_piece);
}

ab_status ab_fill_outline(ab_filler *filler, ab_mark mark, const ab_outline *outline) {
    const double share = filler->spacing * filler->spacing;
    AB_TRY(ab_filler_reserve(filler, mark, outline->area / share, 0));
    if (outline->area < 0.5 * share)
        ab_report_warning(filler->report, mark,
                          "body '%s': its outline holds %g m2, less than half of the %g m2 of a point; use a smaller cell or more per_cell",
                          filler->body, outline->area, share);
    for (size_t e = 0; e < outline->count; e++) ab_filler_bound(filler, outline->edge[e].from[0], outline->edge[e].from[1]);
    job w = {.filler = filler, .outline = outline, .frame = ab_outline_frame(outline), .gauss = filler->rule == AB_FILL_GAUSS};
    w.parts = w.gauss ? (uint32_t)ab_fill_parts(filler->cell, filler->spacing) : 1;
    ab_status status = lay_lattice(&w);
    if (status == AB_OK) status = fill_lattice(&w, mark);
    ab_cells_clear(&w.cells);
    free(w.coarse);
    free(w.point);
    return status;
}
