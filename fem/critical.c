/* critical.c: the critical time step, 2 over the highest frequency of any element (Irons 1970): found at the start, and again for elements whose shape has
 * changed or whose material has grown stiffer. */
#include <math.h>

#include "fem/domain.h"

static const double TRAVELLED = 0.02; /* strain after which an element is looked at again, counted along its way */

static void look(fem_body *body, size_t number) {
    double x[2 * FEM_NODES][8] __attribute__((aligned(64))), share[FEM_NODES][8] __attribute__((aligned(64)));
    fem_gather(body, number, body->x, x);
    double *frequency2 = body->frequency2 + 8 * number;
    fem_element_frequency(body->element, x, &body->elastic, body->f_bar, body->hourglass, frequency2);
    body->element->mass(x, 1.0, share);
    for (int l = 0; l < 8; ++l) { /* an element keeps its mass, whatever its volume is now */
        double volume = 0.0;
        for (int a = 0; a < body->element->nodes; ++a) volume += share[a][l];
        frequency2[l] *= volume / body->volume_start[8 * number + (size_t)l];
    }
    body->stretch[number] = 0.0;
}

void fem_critical(fem_body *body, bool all) {
    bool changed = all || body->ask_wave_speed;
#pragma omp parallel for schedule(static) num_threads(body->threads) reduction(|| : changed)
    for (size_t b = 0; b < body->blocks; ++b)
        if (all || body->stretch[b] > TRAVELLED) {
            look(body, b);
            changed = true;
        }
    if (!changed) return;
    double highest = 0.0;
    for (size_t b = 0; b < body->blocks; ++b) {
        const double stiffening = fmax(body->stiffening[b], 1.0);
        for (int l = 0; l < fem_lanes(body, b); ++l) {
            const double square = stiffening * body->frequency2[8 * b + (size_t)l];
            if (square > highest) highest = square, body->slowest_element = 8 * b + (size_t)l;
        }
    }
    body->slowest = 2.0 / sqrt(highest);
}
