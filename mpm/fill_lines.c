/* fill_lines.c: the lines of a lattice in one direction, fitted to the straight sides of the outline that run along them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mpm/fill_outline.h"

typedef struct side {
    double place, length;
} side; /* straight sides on one line */

static int by_place(const void *a, const void *b) {
    const side *p = a, *q = b;
    return (p->place > q->place) - (p->place < q->place);
}

static int by_length(const void *a, const void *b) {
    const side *p = a, *q = b;
    if (p->length != q->length) return p->length > q->length ? -1 : 1;
    return by_place(a, b);
}

/* Sides along the lines, those on one line joined, and ends of the outline: sorted by length, the two ends first. */
static size_t gather_sides(const ab_edge *edge, size_t count, int direction, double size, side *sides) {
    double low = INFINITY, high = -INFINITY;
    for (size_t e = 0; e < count; e++) {
        low = fmin(low, edge[e].from[direction]);
        high = fmax(high, edge[e].from[direction]);
    }
    size_t n = 0;
    for (size_t e = 0; e < count; e++) {
        const double away = fabs(edge[e].to[direction] - edge[e].from[direction]),
                     length = fabs(edge[e].to[!direction] - edge[e].from[!direction]);
        if (away <= 1e-9 * length && length > 0.5 * size) /* a shorter one is not worth a line of its own */
            sides[n++] = (side){0.5 * (edge[e].from[direction] + edge[e].to[direction]), length};
    }
    qsort(sides, n, sizeof *sides, by_place);
    const double same = 1e-9 * (high - low);
    size_t joined = 0;
    for (size_t k = 0; k < n; k++) {
        if (sides[k].place - low <= same || high - sides[k].place <= same) continue; /* an end, added below */
        if (joined > 0 && sides[k].place - sides[joined - 1].place <= same)
            sides[joined - 1].length += sides[k].length;
        else
            sides[joined++] = sides[k];
    }
    sides[joined++] = (side){low, INFINITY};
    sides[joined++] = (side){high, INFINITY};
    qsort(sides, joined, sizeof *sides, by_length);
    return joined;
}

/* Keeps sides that are no nearer than half a size to a longer one; returns them sorted by place. */
static size_t keep_apart(side *sides, size_t count, double size) {
    size_t kept = 2;
    for (size_t k = 2; k < count; k++) {
        const side candidate = sides[k];
        size_t a = 0, b = kept; /* first kept one above the candidate; kept ones are sorted by place */
        while (a < b) {
            const size_t middle = (a + b) / 2;
            if (sides[middle].place < candidate.place)
                a = middle + 1;
            else
                b = middle;
        }
        if (candidate.place - sides[a - 1].place < 0.5 * size || sides[a].place - candidate.place < 0.5 * size) continue;
        memmove(&sides[a + 1], &sides[a], (kept - a) * sizeof *sides);
        sides[a] = candidate;
        kept++;
    }
    return kept;
}

static bool all_fit(const side *sides, size_t count, double parts) {
    const double low = sides[0].place, length = sides[count - 1].place - low;
    for (size_t k = 1; k + 1 < count; k++) {
        const double at = (sides[k].place - low) / length * parts;
        if (fabs(at - floor(at + 0.5)) > 1e-9 * parts) return false;
    }
    return true;
}

ab_status ab_lines_create(const ab_edge *edge, size_t count, int direction, double size, uint32_t parts, ab_lines *lines,
                          ab_filler *filler) {
    *lines = (ab_lines){0};
    side *sides = malloc((count + 2) * sizeof *sides);
    if (!sides) return ab_report_failure(filler->report, "body '%s': no memory for an outline of %zu edges", filler->body, count);
    const size_t kept = keep_apart(sides, gather_sides(edge, count, direction, size, sides), size);
    const double length = sides[kept - 1].place - sides[0].place, wanted = ab_fill_parts(length, size);
    for (double more = 0; kept > 2 && more <= 0.15 * wanted; more++) { /* one spacing for all, the nearest that fits */
        double even = 0;
        if (all_fit(sides, kept, wanted + more))
            even = wanted + more;
        else if (wanted - more >= 1 && all_fit(sides, kept, wanted - more))
            even = wanted - more;
        if (even == 0) continue;
        size = length / even; /* the lines are still laid out between the sides, so that they stand on them to the last bit */
        break;
    }
    double total = 0;
    for (size_t k = 0; k + 1 < kept; k++) total += ab_fill_parts(sides[k + 1].place - sides[k].place, size) * parts;
    if (total < 2147483648.0) lines->line = malloc((size_t)(total + 1) * sizeof(double));
    if (!lines->line) {
        free(sides);
        return ab_report_failure(filler->report, "body '%s': no memory for a lattice of %.3g lines; use a larger cell or fewer per_cell",
                                 filler->body, total);
    }
    for (size_t k = 0; k + 1 < kept; k++) {
        const double low = sides[k].place, high = sides[k + 1].place, n = ab_fill_parts(high - low, size) * parts;
        for (double i = 0; i < n; i++)
            lines->line[lines->count++] = 0.5 * (low + high) + (high - low) * ((i - 0.5 * n) / n); /* mirrored about the middle */
        lines->line[lines->count - (uint32_t)n] = low;
    }
    lines->line[lines->count] = sides[kept - 1].place;
    free(sides);
    return AB_OK;
}

uint32_t ab_lines_find(const ab_lines *lines, double place) {
    uint32_t a = 0, b = lines->count - 1; /* the last line not above the place */
    while (a < b) {
        const uint32_t middle = a + (b - a + 1) / 2;
        if (lines->line[middle] <= place)
            a = middle;
        else
            b = middle - 1;
    }
    return a;
}
