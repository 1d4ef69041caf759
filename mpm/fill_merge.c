/* fill_merge.c: joins slivers of cells to their neighbours, and answers whether a place lies in the body. */
#include <math.h>
#include <stdlib.h>

#include "mpm/fill_outline.h"

uint32_t ab_cells_root(const ab_cells *cells, uint32_t cell) {
    while (cells->cell[cell].root != cell) cell = cells->cell[cell].root;
    return cell;
}

static double full_area(const ab_cells *cells, const ab_cell *c) {
    const double *u = &cells->lines[0].line[c->i], *v = &cells->lines[1].line[c->j];
    return (u[1] - u[0]) * (v[1] - v[0]);
}

/* Adds the moments of a cell to those of another, about the middle of the other. */
static void join(ab_cells *cells, uint32_t from, uint32_t into) {
    const ab_cell *f = &cells->cell[from];
    ab_cell *t = &cells->cell[into];
    const double *const u = cells->lines[0].line, *const v = cells->lines[1].line;
    const double du = 0.5 * (u[f->i] + u[f->i + 1]) - 0.5 * (u[t->i] + u[t->i + 1]);
    const double dv = 0.5 * (v[f->j] + v[f->j + 1]) - 0.5 * (v[t->j] + v[t->j + 1]);
    const ab_moments *m = &f->moments;
    t->moments.uu += m->uu + 2 * du * m->u + du * du * m->area;
    t->moments.vv += m->vv + 2 * dv * m->v + dv * dv * m->area;
    t->moments.uv += m->uv + du * m->v + dv * m->u + du * dv * m->area;
    t->moments.u += m->u + du * m->area;
    t->moments.v += m->v + dv * m->area;
    t->moments.area += m->area;
    cells->cell[from].root = into;
    t->full = false;
}

static bool too_small(const ab_cells *cells, const ab_cell *c) { return c->moments.area < 0.3 * full_area(cells, c); }

/* The neighbour of another root that shares the longest side (of equal ones the fullest), or NULL. sound: one that is no sliver itself. */
static ab_cell *best_neighbour(const ab_cells *cells, const ab_cell *c, uint32_t own_root, bool sound) {
    ab_cell *const right = ab_cells_find(cells, c->i + 1, c->j), *const top = ab_cells_find(cells, c->i, c->j + 1);
    ab_cell *const neighbour[4] = {ab_cells_find(cells, c->i - 1, c->j), right, ab_cells_find(cells, c->i, c->j - 1), top};
    const double shared[4] = {c->left, right ? right->left : 0, c->bottom, top ? top->bottom : 0};
    const double size = sqrt(full_area(cells, c));
    ab_cell *best = NULL;
    double best_shared = 0, best_area = 0;
    for (int k = 0; k < 4; k++) {
        if (!neighbour[k]) continue;
        const uint32_t root = ab_cells_root(cells, (uint32_t)(neighbour[k] - cells->cell));
        const double area = cells->cell[root].moments.area;
        if (root == own_root || area <= 0 || (sound && (shared[k] <= 0 || too_small(cells, neighbour[k])))) continue;
        if (best && (shared[k] < best_shared - 1e-9 * size || (shared[k] < best_shared + 1e-9 * size && area <= best_area))) continue;
        best = neighbour[k];
        best_shared = shared[k];
        best_area = area;
    }
    return best;
}

typedef struct sliver {
    double area;
    uint32_t cell;
} sliver;

static int by_area(const void *a, const void *b) {
    const sliver *p = a, *q = b;
    if (p->area != q->area) return p->area < q->area ? -1 : 1;
    return (p->cell > q->cell) - (p->cell < q->cell);
}

ab_status ab_cells_merge(ab_cells *cells, ab_filler *filler) {
    size_t count = 0;
    for (size_t k = 0; k < cells->count; k++) count += cells->cell[k].pieces > 0 && too_small(cells, &cells->cell[k]);
    sliver *list = malloc((count + 1) * sizeof *list);
    if (!list) return ab_report_failure(filler->report, "body '%s': no memory for %zu cut cells", filler->body, count);
    count = 0;
    for (size_t k = 0; k < cells->count; k++) {
        const ab_cell *c = &cells->cell[k];
        if (c->pieces > 0 && too_small(cells, c)) list[count++] = (sliver){c->moments.area, (uint32_t)k};
    }
    qsort(list, count, sizeof *list, by_area);
    /* First each goes to a sound neighbour, on its own: two halves of a tip stay mirrored. What is left are slivers among slivers; joined they
     * may still be too small, and each turn leaves fewer of them. */
    for (bool sound = true, again = true; again;) {
        again = sound;
        for (size_t k = 0; k < count; k++) {
            const uint32_t own = ab_cells_root(cells, list[k].cell);
            if (!too_small(cells, &cells->cell[own])) continue;
            const ab_cell *neighbour = best_neighbour(cells, &cells->cell[list[k].cell], own, sound);
            if (!neighbour) continue;
            const uint32_t other = ab_cells_root(cells, (uint32_t)(neighbour - cells->cell));
            if (cells->cell[other].moments.area >= cells->cell[own].moments.area)
                join(cells, own, other);
            else
                join(cells, other, own);
            again = true;
        }
        sound = false;
    }
    free(list);
    return AB_OK;
}

/* ---- places ------------------------------------------------------------------------------------------------------------- */

/* Where a piece crosses the height v; a piece holds its lower end, not its upper one. */
static bool crosses(const ab_cut *cut, double v, double *u) {
    if ((cut->a[1] <= v) == (cut->b[1] <= v)) return false;
    *u = cut->a[0] + (v - cut->a[1]) / (cut->b[1] - cut->a[1]) * (cut->b[0] - cut->a[0]);
    return true;
}

bool ab_cells_inside(const ab_cells *cells, const double u[2]) {
    const uint32_t j = ab_lines_find(&cells->lines[1], u[1]);
    int turns = 0;
    for (size_t k = cells->cut_row[j]; k < cells->cut_row[j + 1]; k++) {
        const ab_cut *cut = &cells->cut[cells->cut_of_row[k]];
        double at;
        if (crosses(cut, u[1], &at) && at > u[0]) turns += cut->b[1] > cut->a[1] ? 1 : -1;
    }
    return turns != 0;
}

/* The longest stretch of the body within the cell at height v: its length and middle. */
static double longest_stretch(const ab_cells *cells, const ab_cell *cell, double v, double *middle) {
    const double low = cells->lines[0].line[cell->i], high = cells->lines[0].line[cell->i + 1];
    double best = 0;
    for (double from = low; from < high;) { /* from crossing to crossing */
        double to = high;
        for (size_t k = cells->cut_row[cell->j]; k < cells->cut_row[cell->j + 1]; k++) {
            double at;
            if (crosses(&cells->cut[cells->cut_of_row[k]], v, &at) && at > from) to = fmin(to, at);
        }
        if (to - from > best && ab_cells_inside(cells, (double[2]){0.5 * (from + to), v})) {
            best = to - from;
            *middle = 0.5 * (from + to);
        }
        from = to;
    }
    return best;
}

bool ab_cells_place_inside(const ab_cells *cells, const ab_cell *cell, double u[2]) {
    const double low = cells->lines[1].line[cell->j], high = cells->lines[1].line[cell->j + 1], wanted = u[1];
    double best = 0;
    for (int k = -1; k < 16; k++) {
        const double v = k < 0 ? wanted : low + (high - low) * (k + 0.5) / 16;
        if (v < low || v >= high) continue;
        double middle = 0;
        const double length = longest_stretch(cells, cell, v, &middle);
        if (length <= best) continue;
        best = length;
        u[0] = middle;
        u[1] = v;
        if (k < 0) break; /* at its own height */
    }
    return best > 0;
}
