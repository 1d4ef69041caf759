/* fill_extent.c: fits the extents of points under the outline, so that a point's half size towards it is its distance from it.
 *
 * The extent of a cut cell comes from its second moments, and for a skew or rounded corner sqrt(n.A.n) is not quite the distance d of the
 * outline. Stretching A along n by d / sqrt(n.A.n) makes it so and keeps A positive. Two sides far from parallel are met both at once (A written in the
 * basis dual to their normals, rows and columns scaled); more sides than two are approached in turns, none exactly. */
#include <math.h>
#include <stdlib.h>

#include "mpm/fill_outline.h"

typedef struct facing { double n[2], distance, length; } facing; /* pieces with one normal */

static double half_size(const double a[3], const double n[2])
{
    return sqrt(fmax(0, n[0] * n[0] * a[0] + n[1] * n[1] * a[1] + 2 * n[0] * n[1] * a[2]));
}

/* A <- S A S, S = 1 + (ratio - 1) n n. */
static void stretch(double a[3], const double n[2], double ratio)
{
    const double f = ratio - 1, an[2] = {a[0] * n[0] + a[2] * n[1], a[2] * n[0] + a[1] * n[1]};
    const double nan = n[0] * an[0] + n[1] * an[1];
    a[0] += 2 * f * an[0] * n[0] + f * f * nan * n[0] * n[0];
    a[1] += 2 * f * an[1] * n[1] + f * f * nan * n[1] * n[1];
    a[2] += f * (an[0] * n[1] + an[1] * n[0]) + f * f * nan * n[0] * n[1];
}

/* Meets two sides at once: b_ij = n_i.A.n_j scaled to the distances, then A = sum b_ij m_i m_j with m dual to n. */
static void fit_two(double a[3], const facing *f, const facing *g)
{
    const double *n = f->n, *k = g->n, sine = n[0] * k[1] - n[1] * k[0];
    const double m[2] = {k[1] / sine, -k[0] / sine}, l[2] = {-n[1] / sine, n[0] / sine}; /* m.n = 1, m.k = 0, l.n = 0, l.k = 1 */
    const double mixed = a[0] * n[0] * k[0] + a[1] * n[1] * k[1] + a[2] * (n[0] * k[1] + n[1] * k[0]);
    const double nn = f->distance * f->distance, kk = g->distance * g->distance;
    const double nk = mixed * f->distance / half_size(a, n) * g->distance / half_size(a, k);
    a[0] = nn * m[0] * m[0] + kk * l[0] * l[0] + 2 * nk * m[0] * l[0];
    a[1] = nn * m[1] * m[1] + kk * l[1] * l[1] + 2 * nk * m[1] * l[1];
    a[2] = nn * m[0] * m[1] + kk * l[0] * l[1] + nk * (m[0] * l[1] + m[1] * l[0]);
}

static void fit(double a[3], facing *f, size_t count)
{
    size_t used = 0;
    double longest = 0;
    for (size_t k = 0; k < count; k++) { /* a side that the point stands hardly inside of (a notch) has no say; opposite ones share one */
        const double now = half_size(a, f[k].n);
        if (!(f[k].distance > 0.25 * now) || f[k].distance > 4 * now) continue;
        size_t same = 0;
        while (same < used && fabs(f[same].n[0] * f[k].n[1] - f[same].n[1] * f[k].n[0]) > 1e-9) same++;
        if (same == used) f[used++] = f[k];
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
    for (int turn = 0; turn < (used > 1 ? 16 : 1); turn++)
        for (size_t k = 0; k < used; k++) {
            const double ratio = f[k].distance / half_size(a, f[k].n);
            stretch(a, f[k].n, used > 1 ? pow(ratio, 0.5 * f[k].length / longest) : ratio);
        }
}

typedef struct owned { uint32_t point; uint32_t piece; } owned;

static int by_point(const void *a, const void *b)
{
    const owned *p = a, *q = b;
    if (p->point != q->point) return p->point < q->point ? -1 : 1;
    return (p->piece > q->piece) - (p->piece < q->piece);
}

ab_status ab_fill_fit_extents(ab_filler *filler, size_t first_piece)
{
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
            const ab_surface *s = &fill->surface[list[k].piece];
            sides[used++] = (facing){.n = {s->normal[0], s->normal[1]},
                                     .distance = (s->position[0] - fill->x[p]) * s->normal[0] + (s->position[1] - fill->y[p]) * s->normal[1],
                                     .length = s->length};
        }
        fit(&fill->extent[3 * (size_t)p], sides, used);
    }
    free(list);
    free(sides);
    return AB_OK;
}
