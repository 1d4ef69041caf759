/* fill_cvt.c: a centroidal Voronoi tessellation (Du, Faber and Gunzburger 1999): generators spread over the body move to the centroids of their cells until they stand
 * there (Lloyd 1982). Each round starts a little beyond where the last one ended (Nesterov's momentum, taken away when it points uphill: O'Donoghue and Candes
 * 2015); what is sought is the same as with plain rounds.
 *
 * They start from Halton's points (bases 2 and 3), moved by two random numbers of the seed (Cranley and Patterson 1976): from points wholly at random it takes two
 * to three times the rounds to even out the masses. The numbers are SplitMix64's (Steele, Lea and Flood 2014): the same on any machine. Cells do not
 * depend on each other and all sums run in one fixed order, so that the points are the same for any number of threads. */
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "mpm/fill_cvt.h"
#include "mpm/fill_union.h"

static const double FARTHEST = 0.25;     /* distances between points: more momentum than that could carry a point across a gap */
static const double SAME_HEIGHT = 1e-10; /* distances between points */
enum { MOST_POINTS = 1000000 };

/* SplitMix64: number `number` of a seed. */
static uint64_t random_bits(uint64_t seed, uint64_t number) {
    uint64_t z = seed + (number + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/* The k-th number of van der Corput's sequence in a base. */
static double radical_inverse(uint64_t k, uint64_t base) {
    double value = 0, part = 1;
    for (; k > 0; k /= base) value += (part /= (double)base) * (double)(k % base);
    return value;
}

/* The next place in the body; `drawn` counts them. */
static void next_place(const ab_cvt *cvt, uint64_t *drawn, double x[2]) {
    double r[2];
    for (uint64_t k = 0; k < 2; k++) {
        const double shift = (double)(random_bits(cvt->filler->seed, k) >> 11) * 0x1p-53;
        const double sum = shift + radical_inverse(*drawn, k ? 3 : 2);
        r[k] = sum - floor(sum);
    }
    ++*drawn;
    ab_interior_place(&cvt->interior, r, x);
}

/* ---- the outline ---------------------------------------------------------------------------------------------------------- */

/* A disc or ring as one of as many edges as make its outline round, four above each point, and of exactly its area. */
static ab_status take_round(ab_cvt *cvt, const ab_shape_spec *shape) {
    const double inner = shape->kind == AB_SHAPE_RING ? shape->inner : 0, area = AB_PI * (shape->radius - inner) * (shape->radius + inner);
    const double points =
        cvt->filler->points > 0 ? (double)cvt->filler->points : fmax(1, area / (cvt->filler->spacing * cvt->filler->spacing));
    const double wanted = fmin(1e6, fmax(64, 4 * 2 * AB_PI * shape->radius / sqrt(area / points)));
    const size_t sides = 4 * (size_t)ceil(wanted / 4);
    AB_TRY(ab_outline_round(shape, sides, true, &cvt->outline, cvt->filler->body, cvt->filler->report));
    for (size_t k = 0; k * sides < cvt->outline.count; k++) {
        ab_round *r = &cvt->round[cvt->round_count++];
        *r = (ab_round){.first = k * sides, .count = sides, .radius = k ? inner : shape->radius, .hole = k > 0};
        memcpy(r->center, shape->center, sizeof r->center);
        if (k) continue;
        for (int side = -1; side <= 1; side += 2)
            ab_filler_bound(cvt->filler, shape->center[0] + side * shape->radius, shape->center[1] + side * shape->radius);
    }
    return AB_OK;
}

static ab_status take_outline(ab_cvt *cvt, const ab_shape_spec *shape) {
    ab_filler *filler = cvt->filler;
    switch (shape->kind) {
    case AB_SHAPE_BOX: {
        double corner[4][2] = {{shape->low[0], shape->low[1]},
                               {shape->high[0], shape->low[1]},
                               {shape->high[0], shape->high[1]},
                               {shape->low[0], shape->high[1]}};
        const ab_shape_spec polygon = {.kind = AB_SHAPE_POLYGON, .mark = shape->mark, .vertices = corner, .count = 4};
        AB_TRY(ab_outline_create(&polygon, &cvt->outline, filler->body, filler->report));
        break;
    }
    case AB_SHAPE_DISC:
    case AB_SHAPE_RING: return take_round(cvt, shape);
    case AB_SHAPE_POLYGON: AB_TRY(ab_outline_create(shape, &cvt->outline, filler->body, filler->report)); break;
    case AB_SHAPE_UNION: AB_TRY(ab_union_outline(filler, shape, &cvt->outline)); break;
    case AB_SHAPE_MESH: return AB_BAD_INPUT; /* refused before */
    }
    for (size_t e = 0; e < cvt->outline.count; e++) ab_filler_bound(filler, cvt->outline.edge[e].from[0], cvt->outline.edge[e].from[1]);
    return AB_OK;
}

static ab_status count_points(ab_cvt *cvt) {
    ab_filler *filler = cvt->filler;
    const double area = cvt->outline.area,
                 wanted = filler->points > 0 ? (double)filler->points : fmax(1, floor(area / (filler->spacing * filler->spacing) + 0.5));
    if (!(wanted <= MOST_POINTS))
        return ab_report_error(filler->report, cvt->mark,
                               "body '%s': rule cvt would place %.3g points, more than the %d it can; use rule regular, %s", filler->body,
                               wanted, MOST_POINTS, filler->points > 0 ? "or fewer points" : "a larger cell or fewer per_cell");
    cvt->count = (size_t)wanted;
    cvt->spacing = sqrt(area / wanted);
    if (cvt->spacing > 2 * filler->cell)
        ab_report_warning(filler->report, cvt->mark,
                          "body '%s': %zu points in %g m2 stand %.3g m apart, more than two cells of %g m, and leave cells between them "
                          "empty; use points: %.0f or more, or a larger cell",
                          filler->body, cvt->count, area, cvt->spacing, filler->cell, ceil(area / (filler->cell * filler->cell)));
    return AB_OK;
}

static int by_value(const void *a, const void *b) {
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Heights of vertices that differ by rounding alone become one: no trapezoid shall be so low that it has no area. */
static bool level_heights(ab_edge *edge, size_t count) {
    double *height = malloc((2 * count + 2) * sizeof *height);
    if (!height) return false;
    for (size_t e = 0; e < count; e++) height[e] = edge[e].from[1];
    qsort(height, count, sizeof *height, by_value);
    double *const level = height + count + 1; /* that each height becomes */
    for (size_t k = 0; k < count; k++) level[k] = k > 0 && height[k] - level[k - 1] < SAME_HEIGHT ? level[k - 1] : height[k];
    for (size_t e = 0; e < 2 * count; e++) {
        double *y = e % 2 ? &edge[e / 2].to[1] : &edge[e / 2].from[1];
        const double *found = bsearch(y, height, count, sizeof *height, by_value);
        if (found) *y = level[found - height];
    }
    free(height);
    return true;
}

/* The outline in its own units, and room for everything. */
static ab_status prepare(ab_cvt *cvt) {
    const ab_filler *filler = cvt->filler;
    const double *low = filler->fill->low, *high = filler->fill->high;
    for (int k = 0; k < 2; k++) cvt->middle[k] = 0.5 * (low[k] + high[k]);
    cvt->edge = malloc(cvt->outline.count * sizeof *cvt->edge);
    cvt->x = malloc(cvt->count * sizeof *cvt->x);
    cvt->threads = cvt->count < 1000 ? 1 : filler->threads > 0 ? filler->threads : 1;
    cvt->work = calloc((size_t)cvt->threads, sizeof *cvt->work);
    if (!cvt->edge || !cvt->x || !cvt->work)
        return ab_report_failure(filler->report, "body '%s': no memory for %zu points", filler->body, cvt->count);
    for (size_t e = 0; e < cvt->outline.count; e++)
        for (int k = 0; k < 2; k++) {
            cvt->edge[e].from[k] = (cvt->outline.edge[e].from[k] - cvt->middle[k]) / cvt->spacing;
            cvt->edge[e].to[k] = (cvt->outline.edge[e].to[k] - cvt->middle[k]) / cvt->spacing;
        }
    if (!level_heights(cvt->edge, cvt->outline.count))
        return ab_report_failure(filler->report, "body '%s': no memory for %zu points", filler->body, cvt->count);
    AB_TRY(ab_interior_create(cvt->edge, cvt->outline.count, (double)cvt->count, &cvt->interior, filler->body, filler->report));
    return ab_voronoi_create(&cvt->interior, cvt->count, &cvt->voronoi, filler->body, filler->report);
}

/* ---- Lloyd's iteration ---------------------------------------------------------------------------------------------------- */

/* Where each generator's cell has its centroid, and the area of it; 0: none. */
static ab_status centroids(ab_cvt *cvt, double (*to)[2], double *area) {
    ab_voronoi_sort(&cvt->voronoi, (const double(*)[2])cvt->x);
#pragma omp parallel for schedule(dynamic, 64) num_threads(cvt->threads)
    for (size_t i = 0; i < cvt->count; i++) {
        ab_cell_work *w = &cvt->work[omp_get_thread_num()];
        ab_voronoi_cell(&cvt->voronoi, i, w);
        area[i] = w->cell.count > 0 ? w->moments.area : 0;
        if (area[i] > 0) ab_voronoi_centroid(&cvt->voronoi, i, w, to[i]);
    }
    for (int t = 0; t < cvt->threads; t++)
        if (cvt->work[t].no_memory)
            return ab_report_failure(cvt->filler->report, "body '%s': no memory for the cells of its points", cvt->filler->body);
    return AB_OK;
}

/* to: room for the places of this round, before: those of the round before. On return cvt->x is where the cells were last made. */
static ab_status iterate(ab_cvt *cvt, double (*to)[2], double (*before)[2], double *area, uint64_t *drawn) {
    const ab_filler *filler = cvt->filler;
    double momentum = 1, largest = INFINITY; /* Nesterov's t */
    for (int round = 0;; round++) {
        AB_TRY(centroids(cvt, to, area));
        double uphill = 0;
        size_t lost = 0;
        largest = 0;
        for (size_t i = 0; i < cvt->count; i++) {
            if (!(area[i] > 0)) { /* two at one place, or one that rounding put outside */
                next_place(cvt, drawn, to[i]);
                lost++;
            }
            largest = fmax(largest, hypot(to[i][0] - cvt->x[i][0], to[i][1] - cvt->x[i][1]));
            if (round > 0)
                uphill += area[i] *
                          ((cvt->x[i][0] - to[i][0]) * (to[i][0] - before[i][0]) + (cvt->x[i][1] - to[i][1]) * (to[i][1] - before[i][1]));
        }
        if (lost == 0 && largest <= filler->tolerance) return AB_OK;
        if (lost == 0 && round >= filler->iterations) break;
        if (round >= filler->iterations + 100)
            return ab_report_failure(filler->report, "body '%s': %zu of its %zu points have no room; use fewer points", filler->body, lost,
                                     cvt->count);
        ab_report_progress(filler->report,
                           fmax((double)round / filler->iterations, 1 - log(largest / filler->tolerance) / log(1 / filler->tolerance)),
                           "filling '%s' with %zu points: round %d, largest move %.2g of their distance, wanted %.2g", filler->body,
                           cvt->count, round + 1, largest, filler->tolerance);
        if (uphill > 0 || round == 0 || lost > 0) momentum = 1;
        const double next = 0.5 * (1 + sqrt(1 + 4 * momentum * momentum)), beta = (momentum - 1) / next;
        momentum = next;
        for (size_t i = 0; i < cvt->count; i++) {
            double push[2] = {0, 0};
            for (int k = 0; k < 2 && round > 0; k++) push[k] = beta * (to[i][k] - before[i][k]);
            memcpy(before[i], to[i], sizeof to[i]);
            const double x[2] = {to[i][0] + push[0], to[i][1] + push[1]};
            memcpy(cvt->x[i], hypot(push[0], push[1]) <= FARTHEST && ab_interior_holds(&cvt->interior, x) ? x : to[i], sizeof to[i]);
        }
    }
    ab_report_warning(
        filler->report, cvt->mark,
        "body '%s': after %d round%s its points still move by up to %.2g of their distance, not %.2g as wanted; they are used "
        "as they are (raise iterations or tolerance)",
        filler->body, filler->iterations, filler->iterations == 1 ? "" : "s", largest, filler->tolerance);
    return AB_OK;
}

static ab_status settle(ab_cvt *cvt) {
    const ab_filler *filler = cvt->filler;
    uint64_t drawn = 0;
    double(*to)[2] = malloc(cvt->count * sizeof *to), (*before)[2] = malloc(cvt->count * sizeof *before),
    *area = malloc(cvt->count * sizeof *area);
    for (size_t i = 0; i < cvt->count && to; i++) next_place(cvt, &drawn, to[i]);
    if (to) { /* neighbours in space are neighbours in memory */
        ab_voronoi_sort(&cvt->voronoi, (const double(*)[2])to);
        for (size_t i = 0; i < cvt->count; i++) memcpy(cvt->x[i], to[cvt->voronoi.list[i]], sizeof cvt->x[i]);
    }
    const ab_status status = to && before && area
                                 ? iterate(cvt, to, before, area, &drawn)
                                 : ab_report_failure(filler->report, "body '%s': no memory for %zu points", filler->body, cvt->count);
    free(to);
    free(before);
    free(area);
    return status;
}

ab_status ab_fill_cvt(ab_filler *filler, const ab_shape_spec *shape) {
    ab_cvt cvt = {.filler = filler, .mark = shape->mark};
    ab_status status = take_outline(&cvt, shape);
    if (status == AB_OK) status = count_points(&cvt);
    if (status == AB_OK) status = prepare(&cvt);
    if (status == AB_OK) status = settle(&cvt);
    if (status == AB_OK) status = ab_cvt_finish(&cvt);
    for (int t = 0; cvt.work && t < cvt.threads; t++) ab_cell_work_clear(&cvt.work[t]);
    free(cvt.work);
    free(cvt.edge);
    free(cvt.x);
    ab_voronoi_clear(&cvt.voronoi);
    ab_interior_clear(&cvt.interior);
    ab_outline_clear(&cvt.outline);
    return status;
}
