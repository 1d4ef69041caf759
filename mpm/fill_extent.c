/* fill_extent.c: fits the extents of points under the outline, so that a point's half size towards it is its distance from it.
 *
 * The extent of a cut cell comes from its second moments, and for a skew or rounded corner sqrt(n.A.n) is not quite the distance d of the
 * outline. Stretching A along n by d / sqrt(n.A.n) makes it so and keeps A positive. Two sides far from parallel are met both at once (A written in the
 * basis dual to their normals, rows and columns scaled); three fix A where that leaves it positive; otherwise all are approached in turns, none exactly. */
#include <math.h>
#include <stdlib.h>

#include "mpm/fill_outline.h"

typedef struct facing {
    double n[2], distance, length;
} facing; /* pieces with one normal */

static double half_size(const double a[3], const double n[2]) {
    return sqrt(fmax(0, n[0] * n[0] * a[0] + n[1] * n[1] * a[1] + 2 * n[0] * n[1] * a[2]));
}

/* A <- S A S, S = 1 + (ratio - 1) n n. */
static void stretch(double a[3], const double n[2], double ratio) {
    const double f = ratio - 1, an[2] = {a[0] * n[0] + a[2] * n[1], a[2] * n[0] + a[1] * n[1]};
    const double nan = n[0] * an[0] + n[1] * an[1];
    a[0] += 2 * f * an[0] * n[0] + f * f * nan * n[0] * n[0];
    a[1] += 2 * f * an[1] * n[1] + f * f * nan * n[1] * n[1];
    a[2] += f * (an[0] * n[1] + an[1] * n[0]) + f * f * nan * n[0] * n[1];
}

/* Meets two sides at once: b_ij = n_i.A.n_j scaled to the distances, then A = sum b_ij m_i m_j with m dual to n. */
static void fit_two(double a[3], const facing *f, const facing *g) {
    const double *n = f->n, *k = g->n, sine = n[0] * k[1] - n[1] * k[0];
    const double m[2] = {k[1] / sine, -k[0] / sine}, l[2] = {-n[1] / sine, n[0] / sine}; /* m.n = 1, m.k = 0, l.n = 0, l.k = 1 */
    const double mixed = a[0] * n[0] * k[0] + a[1] * n[1] * k[1] + a[2] * (n[0] * k[1] + n[1] * k[0]);
    const double nn = f->distance * f->distance, kk = g->distance * g->distance;
    const double nk = mixed * f->distance / half_size(a, n) * g->distance / half_size(a, k);
    a[0] = nn * m[0] * m[0] + kk * l[0] * l[0] + 2 * nk * m[0] * l[0];
    a[1] = nn * m[1] * m[1] + kk * l[1] * l[1] + 2 * nk * m[1] * l[1];
    a[2] = nn * m[0] * m[1] + kk * l[0] * l[1] + nk * (m[0] * l[1] + m[1] * l[0]);
}

/* Meets three sides at once where there is such an A and it is no wilder than the old one. */
static bool fit_three(double a[3], const facing f[3]) {
    double m[3][4]; /* n.A.n = d^2, Cramer's rule */
    for (int k = 0; k < 3; k++) {
        const double *n = f[k].n;
        m[k][0] = n[0] * n[0];
        m[k][1] = n[1] * n[1];
        m[k][2] = 2 * n[0] * n[1];
        m[k][3] = f[k].distance * f[k].distance;
    }
    double det[4]; /* of all columns, and with the right side in place of column 0, 1, 2 */
    for (int c = 0; c < 4; c++) {
        const int p = c == 1 ? 3 : 0, q = c == 2 ? 3 : 1, r = c == 3 ? 3 : 2;
        det[c] = m[0][p] * (m[1][q] * m[2][r] - m[1][r] * m[2][q]) - m[0][q] * (m[1][p] * m[2][r] - m[1][r] * m[2][p]) +
                 m[0][r] * (m[1][p] * m[2][q] - m[1][q] * m[2][p]);
    }
    if (fabs(det[0]) < 0.05) return false;
    const double b[3] = {det[1] / det[0], det[2] / det[0], det[3] / det[0]};
    const double old = a[0] * a[1] - a[2] * a[2], new = b[0] * b[1] - b[2] * b[2], most = 4 * (a[0] + a[1]);
    if (!(b[0] > 0 && b[1] > 0 && new > old / 16 && b[0] + b[1] < most)) return false;
    for (int c = 0; c < 3; c++) a[c] = b[c];
    return true;
}

static void fit(double a[3], facing *f, size_t count) {
    size_t used = 0;
    double longest = 0;
    for (size_t k = 0; k < count;
         k++) { /* opposite sides share one distance; in a notch the point may stand beyond a side, and keeps some size */
        const double now = half_size(a, f[k].n);
        f[k].distance = fmin(fmax(f[k].distance, 0.3 * now), 3 * now);
        size_t same = 0;
        while (same < used && fabs(f[same].n[0] * f[k].n[1] - f[same].n[1] * f[k].n[0]) > 1e-9) same++;
        if (same == used)
            f[used++] = f[k];
        else {
            const double length = f[same].length + f[k].length;
            f[same].distance = (f[same].distance * f[same].length + f[k].distance * f[k].length) / length;
            f[same].length = length;
        }
    }
    for (size_t k = 0; k < used; k++) longest = fmax(longest, f[k].length);
    if (used == 2 && fabs(f[0].n[0] * f[1].n[1] - f[0].n[1] * f[1].n[0]) > 0.5) {
        fit_two(a, &f[0], &f[1]);
        return;
    }
    if (used == 3 && fit_three(a, f)) return;
    for (int turn = 0; turn < (used > 1 ? 16 : 1); turn++)
        for (size_t k = 0; k < used; k++) {
            const double ratio = f[k].distance / half_size(a, f[k].n);
            stretch(a, f[k].n, used > 1 ? pow(ratio, 0.5 * f[k].length / longest) : ratio);
        }
}

typedef struct owned {
    uint32_t point;
    uint32_t piece;
} owned;

static int by_point(const void *a, const void *b) {
    const owned *p = a, *q = b;
    if (p->point != q->point) return p->point < q->point ? -1 : 1;
    return (p->piece > q->piece) - (p->piece < q->piece);
}

ab_status ab_fill_fit_extents(ab_filler *filler, size_t first_piece) {
    const ab_fill *fill = filler->fill;
    const size_t count = fill->surface_count - first_piece;
    owned *list = malloc((count + 1) * sizeof *list);
    facing *sides = malloc((count + 1) * sizeof *sides);
    if (!list || !sides) {
        free(list);
        free(sides);
        return ab_report_failure(filler->report, "body '%s': no memory for %zu pieces of outline", filler->body, count);
    }
    for (size_t k = 0; k < count; k++) list[k] = (owned){fill->surface[first_piece + k].point, (uint32_t)(first_piece + k)};
    qsort(list, count, sizeof *list, by_point);
    for (size_t k = 0; k < count;) {
        const uint32_t p = list[k].point;
        size_t used = 0;
        for (; k < count && list[k].point == p; k++) {
            const ab_outline_piece *s = &fill->surface[list[k].piece];
            sides[used++] =
                (facing){.n = {s->normal[0], s->normal[1]},
                         .distance = (s->position[0] - fill->x[p]) * s->normal[0] + (s->position[1] - fill->y[p]) * s->normal[1],
                         .length = s->length};
        }
        fit(&fill->extent[3 * (size_t)p], sides, used);
    }
    free(list);
    free(sides);
    return AB_OK;
}
