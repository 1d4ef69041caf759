/* fill_lattice.c: points in a box: a lattice whose spacings divide the sides, or Gauss points in cells that do; and the Gauss rules. */
#include <math.h>

#include "mpm/fill_parts.h"

void ab_gauss_rule(int count, ab_gauss *rule) {
    rule->count = count;
    for (int i = 0; 2 * i < count; i++) { /* roots of the Legendre polynomial by Newton, from Tricomi's guess */
        double x = cos(AB_PI * (i + 0.75) / (count + 0.5)), slope = 1;
        for (int step = 0; step < 100; step++) {
            double before = 1, value = x;
            for (int k = 2; k <= count; k++) {
                const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
                before = value;
                value = next;
            }
            slope = count * (x * value - before) / (x * x - 1);
            const double change = value / slope;
            x -= change;
            if (fabs(change) < 1e-15) break;
        }
        if (2 * i + 1 == count) x = 0;
        rule->place[i] = 0.5 * (1 - x);
        rule->place[count - 1 - i] = 0.5 * (1 + x);
        rule->weight[i] = rule->weight[count - 1 - i] = 1 / ((1 - x * x) * slope * slope);
    }
    double sum = 0;
    for (int i = 0; i < count; i++) sum += rule->weight[i];
    rule->share[0] = 0;
    for (int i = 0; i < count; i++) {
        rule->weight[i] /= sum;
        rule->share[i + 1] = i + 1 < count ? rule->share[i] + rule->weight[i] : 1;
        rule->half[i] = 0.5 * rule->weight[i];
    }
    rule->half[0] = rule->half[count - 1] = rule->place[0];
}

ab_status ab_gauss_factors(const ab_filler *filler, ab_mark mark, int *more, int *fewer) {
    *fewer = 1;
    for (int k = 2; (long)k * k <= filler->per_cell; k++)
        if (filler->per_cell % k == 0) *fewer = k;
    *more = filler->per_cell / *fewer;
    if (*more > AB_GAUSS_MOST)
        return ab_report_error(filler->report, mark,
                               "body '%s': gauss points, %d in each cell, would stand %d x %d; choose a number with two factors up to %d",
                               filler->body, filler->per_cell, *more, *fewer, AB_GAUSS_MOST);
    if (*more > 2 * *fewer)
        ab_report_warning(filler->report, mark,
                          "body '%s': gauss points, %d in each cell, stand %d x %d; a number with closer factors (4, 6, 9, 12, 16) "
                          "resolves both directions",
                          filler->body, filler->per_cell, *more, *fewer);
    return AB_OK;
}

/* The lattice in each direction: cells of `size` and a rule in each. */
typedef struct axis {
    double low, high, size;
    double cells;
    ab_gauss rule;
} axis;

/* Place of point q of cell i, exactly mirrored about the middle of the side. */
static double place(const axis *a, size_t i, int q) {
    return 0.5 * (a->low + a->high) + a->size * ((double)i - 0.5 * a->cells + a->rule.place[q]);
}

/* Middle of the share of the side that point q of cell i stands for. */
static double middle(const axis *a, size_t i, int q) {
    return 0.5 * (a->low + a->high) + a->size * ((double)i - 0.5 * a->cells + 0.5 * (a->rule.share[q] + a->rule.share[q + 1]));
}

ab_status ab_fill_box(ab_filler *filler, const ab_shape_spec *shape) {
    axis a[2];
    for (int k = 0; k < 2; k++) {
        a[k].low = shape->low[k];
        a[k].high = shape->high[k];
    }
    const double side[2] = {a[0].high - a[0].low, a[1].high - a[1].low};
    int points[2] = {1, 1};
    if (filler->rule == AB_FILL_GAUSS) { /* more of them along the longer side */
        const int longer = side[1] > side[0] * (1 + 1e-9);
        AB_TRY(ab_gauss_factors(filler, shape->mark, &points[longer], &points[!longer]));
    }
    for (int k = 0; k < 2; k++) {
        a[k].cells = ab_fill_parts(side[k], filler->rule == AB_FILL_GAUSS ? filler->cell : filler->spacing);
        a[k].size = side[k] / a[k].cells;
        ab_gauss_rule(points[k], &a[k].rule);
        if (side[k] < 0.5 * filler->spacing)
            ab_report_warning(filler->report, shape->mark,
                              "body '%s': its box is %g m in %c, less than half of the %g m between points, and has a single row of them; "
                              "use a smaller cell or more per_cell",
                              filler->body, side[k], "xy"[k], filler -> spacing);
    }
    const double across = a[0].cells * points[0], along = a[1].cells * points[1];
    AB_TRY(ab_filler_reserve(filler, shape->mark, across * along, 2 * (across + along)));
    ab_filler_bound(filler, a[0].low, a[1].low);
    ab_filler_bound(filler, a[0].high, a[1].high);

    const size_t cells[2] = {(size_t)a[0].cells, (size_t)a[1].cells};
    for (size_t j = 0; j < cells[1]; j++)
        for (int r = 0; r < points[1]; r++) {
            const double y = place(&a[1], j, r), half_y = a[1].size * a[1].rule.half[r], length_y = a[1].size * a[1].rule.weight[r];
            const bool bottom = j == 0 && r == 0, top = j == cells[1] - 1 && r == points[1] - 1;
            for (size_t i = 0; i < cells[0]; i++)
                for (int q = 0; q < points[0]; q++) {
                    const double half_x = a[0].size * a[0].rule.half[q], length_x = a[0].size * a[0].rule.weight[q];
                    const uint32_t p =
                        ab_filler_point(filler, place(&a[0], i, q), y, length_x * length_y, half_x * half_x, half_y * half_y, 0);
                    if (bottom) ab_filler_piece(filler, p, middle(&a[0], i, q), a[1].low, 0, -1, length_x);
                    if (top) ab_filler_piece(filler, p, middle(&a[0], i, q), a[1].high, 0, 1, length_x);
                    if (i == 0 && q == 0) ab_filler_piece(filler, p, a[0].low, middle(&a[1], j, r), -1, 0, length_y);
                    if (i == cells[0] - 1 && q == points[0] - 1) ab_filler_piece(filler, p, a[0].high, middle(&a[1], j, r), 1, 0, length_y);
                }
        }
    return AB_OK;
}
