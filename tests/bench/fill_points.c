/* fill_points.c: the points that fill a square, as bodies get them. For study_density.py.
 *
 *     fill_points SIDE CELL RULE PER_CELL [POINTS SEED]
 *
 * prints for each point of a square from (0, 0): x y volume and its domain tensor xx yy xy; m, m2. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mpm/fill.h"

int main(int argc, char **argv) {
    if (argc != 5 && argc != 7) return fprintf(stderr, "fill_points SIDE CELL RULE PER_CELL [POINTS SEED]\n"), 2;
    const double side = atof(argv[1]);
    const ab_shape_spec shape = {.kind = AB_SHAPE_BOX, .high = {side, side}};
    const ab_fill_request request = {.rule = !strcmp(argv[3], "cvt")     ? AB_FILL_CVT
                                             : !strcmp(argv[3], "gauss") ? AB_FILL_GAUSS
                                                                         : AB_FILL_REGULAR,
                                     .cell = atof(argv[2]),
                                     .per_cell = atoi(argv[4]),
                                     .points = argc > 5 ? strtoull(argv[5], NULL, 10) : 0,
                                     .seed = argc > 6 ? strtoull(argv[6], NULL, 10) : 0};
    ab_report *report = ab_report_create();
    ab_fill *fill = NULL;
    const ab_status status = ab_fill_make(&shape, &request, "square", &fill, report);
    ab_report_print(report, stderr);
    for (size_t p = 0; status == AB_OK && p < fill->count; p++)
        printf("%.17g %.17g %.17g %.17g %.17g %.17g\n", fill->x[p], fill->y[p], fill->volume[p], fill->extent[3 * p],
               fill->extent[3 * p + 1], fill->extent[3 * p + 2]);
    ab_fill_destroy(fill);
    ab_report_destroy(report);
    return (int)status;
}
