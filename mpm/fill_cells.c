/* fill_cells.c: cuts an outline by a lattice: the exact area, first and second moments of the body in every cell, and the lengths of the
 * cell's sides that lie in it.
 *
 * Every piece of outline takes away (going up) or adds (going down) the strip between itself and infinity on its right: Green's theorem, cell by
 * cell. In its own cell that is a polynomial along the piece; to every cell further right in the row it adds the same full-width strip, so a running sum
 * along the row does for all of them. Nothing is asked of the outline but that it closes: it may be concave, have holes, run along lines and
 * through corners. Cells that it does not touch cost nothing. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mpm/fill_outline.h"

void ab_cells_clear(ab_cells *cells) {
    free(cells->lines[0].line);
    free(cells->lines[1].line);
    free(cells->cell);
    free(cells->row);
    free(cells->cut);
    free(cells->cut_row);
    free(cells->cut_of_row);
    *cells = (ab_cells){0};
}

/* ---- edges to pieces ---------------------------------------------------------------------------------------------------- */

/* Moves a vertex onto a line that it misses by rounding alone. */
static void nudge(double u[2], const ab_lines lines[2]) {
    for (int k = 0; k < 2; k++) {
        const double *line = lines[k].line;
        const uint32_t cell = ab_lines_find(&lines[k], u[k]);
        const double slack = 1e-14 * (line[lines[k].count] - line[0]);
        for (uint32_t side = cell; side <= cell + 1; side++)
            if (fabs(u[k] - line[side]) <= slack) u[k] = line[side];
    }
}

/* Walks an edge from line to line; counts the pieces, and writes them where `cut` is given. */
static size_t walk(const ab_edge *edge, uint32_t number, const ab_lines lines[2], ab_cut *cut) {
    uint32_t next[2] = {0, 0}; /* line to cross next */
    double delta[2];
    for (int k = 0; k < 2; k++) {
        delta[k] = edge->to[k] - edge->from[k];
        next[k] = ab_lines_find(&lines[k], edge->from[k]);
        if (delta[k] > 0)
            next[k] += edge->from[k] >= lines[k].line[next[k]];
        else if (delta[k] < 0 && edge->from[k] <= lines[k].line[next[k]])
            next[k] -= 1; /* wraps below line 0: nothing left to cross */
    }
    size_t count = 0;
    double at[2] = {edge->from[0], edge->from[1]};
    for (bool last = false; !last;) {
        double t[2] = {2, 2}, to[2] = {edge->to[0], edge->to[1]};
        for (int k = 0; k < 2; k++) {
            if (next[k] > lines[k].count) continue;
            const double line = lines[k].line[next[k]];
            if (delta[k] > 0 ? line < edge->to[k] : delta[k] < 0 && line > edge->to[k]) t[k] = (line - edge->from[k]) / delta[k];
        }
        const double step = fmin(t[0], t[1]);
        last = step > 1;
        for (int k = 0; k < 2 && !last; k++) {
            if (t[k] <= step + 1e-15) {
                to[k] = lines[k].line[next[k]];
                next[k] += delta[k] > 0 ? 1 : -1u;
            } else {
                to[k] = edge->from[k] + step * delta[k];
            }
        }
        if (to[0] == at[0] && to[1] == at[1]) continue;
        if (cut) cut[count] = (ab_cut){.edge = number, .a = {at[0], at[1]}, .b = {to[0], to[1]}};
        count++;
        at[0] = to[0];
        at[1] = to[1];
    }
    return count;
}

/* The cell a piece belongs to: the one on its inner side. */
static void own_cell(const ab_cut *cut, const ab_lines lines[2], uint32_t *i, uint32_t *j) {
    const double du = cut->b[0] - cut->a[0], dv = cut->b[1] - cut->a[1], length = hypot(du, dv);
    const double inwards = 1e-9 * fmin((lines[0].line[lines[0].count] - lines[0].line[0]) / lines[0].count,
                                       (lines[1].line[lines[1].count] - lines[1].line[0]) / lines[1].count);
    *i = ab_lines_find(&lines[0], 0.5 * (cut->a[0] + cut->b[0]) - inwards * dv / length);
    *j = ab_lines_find(&lines[1], 0.5 * (cut->a[1] + cut->b[1]) + inwards * du / length);
}

/* ---- the list of cells -------------------------------------------------------------------------------------------------- */

static int by_key(const void *a, const void *b) {
    const uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return (p > q) - (p < q);
}

/* Lists the cells of all pieces and their neighbours. key: room for 5 per piece. */
static size_t list_cells(const ab_cells *cells, uint64_t *key) {
    size_t n = 0;
    uint32_t last_i = UINT32_MAX, last_j = UINT32_MAX;
    for (size_t c = 0; c < cells->cut_count; c++) {
        uint32_t i, j;
        own_cell(&cells->cut[c], cells->lines, &i, &j);
        if (i == last_i && j == last_j) continue;
        last_i = i;
        last_j = j;
        key[n++] = (uint64_t)j << 32 | i;
        if (i > 0) key[n++] = (uint64_t)j << 32 | (i - 1);
        if (i + 1 < cells->lines[0].count) key[n++] = (uint64_t)j << 32 | (i + 1);
        if (j > 0) key[n++] = (uint64_t)(j - 1) << 32 | i;
        if (j + 1 < cells->lines[1].count) key[n++] = (uint64_t)(j + 1) << 32 | i;
    }
    qsort(key, n, sizeof *key, by_key);
    size_t unique = 0;
    for (size_t k = 0; k < n; k++)
        if (k == 0 || key[k] != key[k - 1]) key[unique++] = key[k];
    return unique;
}

ab_cell *ab_cells_find(const ab_cells *cells, uint32_t i, uint32_t j) {
    if (i >= cells->lines[0].count || j >= cells->lines[1].count) return NULL;
    size_t a = cells->row[j], b = cells->row[j + 1];
    while (a < b) {
        const size_t middle = (a + b) / 2;
        if (cells->cell[middle].i < i)
            a = middle + 1;
        else
            b = middle;
    }
    return a < cells->row[j + 1] && cells->cell[a].i == i ? &cells->cell[a] : NULL;
}

/* ---- moments ------------------------------------------------------------------------------------------------------------ */

/* Adds what a piece takes from or gives to its own cell, and to the running sums. Integrals of cubics along it: two Gauss points are exact. */
static void add_piece(ab_cell *cell, const ab_cut *cut, const ab_lines lines[2]) {
    const double *u = &lines[0].line[cell->i], *v = &lines[1].line[cell->j];
    const double middle_u = 0.5 * (u[0] + u[1]), middle_v = 0.5 * (v[0] + v[1]), a = 0.5 * (u[1] - u[0]);
    const double du = cut->b[0] - cut->a[0], dv = cut->b[1] - cut->a[1], gauss = 0.28867513459481288;
    for (int q = -1; q <= 1; q += 2) {
        const double x = 0.5 * (cut->a[0] + cut->b[0]) - middle_u + q * gauss * du,
                     y = 0.5 * (cut->a[1] + cut->b[1]) - middle_v + q * gauss * dv;
        const double w = -0.5 * dv;
        cell->moments.area += w * (a - x);
        cell->moments.u += w * 0.5 * (a - x) * (a + x);
        cell->moments.v += w * (a - x) * y;
        cell->moments.uu += w * (a * a * a - x * x * x) / 3;
        cell->moments.uv += w * 0.5 * (a - x) * (a + x) * y;
        cell->moments.vv += w * (a - x) * y * y;
        cell->cover[0] += w;
        cell->cover[1] += w * y;
        cell->cover[2] += w * y * y;
    }
    cell->across += du;
    cell->pieces++;
}

/* Running sums along the rows: what lies left of each cell. */
static void sum_rows(ab_cells *cells) {
    for (uint32_t j = 0; j < cells->lines[1].count; j++) {
        const double height = cells->lines[1].line[j + 1] - cells->lines[1].line[j];
        double cover[3] = {0, 0, 0};
        for (size_t k = cells->row[j]; k < cells->row[j + 1]; k++) {
            ab_cell *c = &cells->cell[k];
            const double width = cells->lines[0].line[c->i + 1] - cells->lines[0].line[c->i];
            ab_moments *m = &c->moments;
            c->left = cover[0];
            m->area += cover[0] * width;
            m->v += cover[1] * width;
            m->vv += cover[2] * width;
            m->uu += cover[0] * width * width * width / 12;
            for (int q = 0; q < 3; q++) cover[q] += c->cover[q];
            c->inside_after = cover[0] > 0.5 * height;
            const double full = width * height;
            c->full = fabs(m->area - full) < 1e-13 * full;
            if (c->full) *m = (ab_moments){full, 0, 0, full * width * width / 12, 0, full * height * height / 12};
        }
    }
}

/* Running sums along the columns: how much of each cell's bottom lies in the body. order: room for a number per cell. */
static void sum_columns(ab_cells *cells, uint64_t *order) {
    for (size_t k = 0; k < cells->count; k++)
        order[k] = (uint64_t)cells->cell[k].i << 32 | k; /* by column; cells are in order of rows already */
    qsort(order, cells->count, sizeof *order, by_key);
    double across = 0;
    for (size_t k = 0; k < cells->count; k++) {
        ab_cell *c = &cells->cell[order[k] & UINT32_MAX];
        if (k == 0 || order[k] >> 32 != order[k - 1] >> 32) across = 0;
        c->bottom = across;
        across += c->across;
    }
}

/* Lists pieces by row, for questions about places. */
static void sort_pieces(ab_cells *cells) {
    const uint32_t rows = cells->lines[1].count;
    memset(cells->cut_row, 0, (rows + 1) * sizeof *cells->cut_row);
    for (size_t c = 0; c < cells->cut_count; c++) cells->cut_row[cells->cell[cells->cut[c].cell].j + 1]++;
    for (uint32_t j = 0; j < rows; j++) cells->cut_row[j + 1] += cells->cut_row[j];
    for (size_t c = cells->cut_count; c-- > 0;) /* from the back: the starts move down to where each row begins */
        cells->cut_of_row[--cells->cut_row[cells->cell[cells->cut[c].cell].j + 1]] = (uint32_t)c;
    memmove(&cells->cut_row[0], &cells->cut_row[1], rows * sizeof *cells->cut_row);
    cells->cut_row[rows] = cells->cut_count;
}

ab_status ab_cells_create(ab_edge *edge, size_t count, ab_lines lines[2], ab_cells *cells, ab_filler *filler) {
    *cells = (ab_cells){.lines = {lines[0], lines[1]}};
    size_t pieces = 0;
    for (size_t e = 0; e < count; e++) {
        nudge(edge[e].from, lines);
        nudge(edge[e].to, lines);
        pieces += walk(&edge[e], 0, lines, NULL);
    }
    cells->cut = malloc(pieces * sizeof *cells->cut);
    uint64_t *key = malloc(5 * pieces * sizeof *key);
    cells->row = malloc((lines[1].count + (size_t)1) * sizeof *cells->row);
    cells->cut_row = malloc((lines[1].count + (size_t)1) * sizeof *cells->cut_row);
    cells->cut_of_row = malloc(pieces * sizeof *cells->cut_of_row);
    if (pieces < UINT32_MAX / 5 && cells->cut && key && cells->row && cells->cut_row && cells->cut_of_row) {
        for (size_t e = 0; e < count; e++) cells->cut_count += walk(&edge[e], (uint32_t)e, lines, &cells->cut[cells->cut_count]);
        cells->count = list_cells(cells, key);
        cells->cell = calloc(cells->count, sizeof *cells->cell);
    }
    if (!cells->cell) {
        free(key);
        ab_cells_clear(cells);
        return ab_report_failure(filler->report, "body '%s': no memory for %zu pieces of its outline; use a larger cell or fewer per_cell",
                                 filler->body, pieces);
    }
    uint32_t rows = 0;
    for (size_t k = 0; k < cells->count; k++) {
        cells->cell[k].i = (uint32_t)key[k];
        cells->cell[k].j = (uint32_t)(key[k] >> 32);
        cells->cell[k].root = (uint32_t)k;
        while (rows <= cells->cell[k].j) cells->row[rows++] = k;
    }
    while (rows <= lines[1].count) cells->row[rows++] = cells->count;
    for (size_t c = 0; c < cells->cut_count; c++) {
        uint32_t i, j;
        own_cell(&cells->cut[c], cells->lines, &i, &j);
        ab_cell *cell = ab_cells_find(cells, i, j);
        cells->cut[c].cell = (uint32_t)(cell - cells->cell);
        add_piece(cell, &cells->cut[c], cells->lines);
    }
    sum_rows(cells);
    sum_columns(cells, key);
    sort_pieces(cells);
    free(key);
    return AB_OK;
}
