/* expect.h: holds a series of values against what the scene expects of it. The series is seen once, a sample a step, and not kept.
 *
 * A sample is (t, y, r): r is the reference at t. Norms, over the samples in the window [from, to]:
 *   final            y at the last sample against r there
 *   max              the largest |y - r|; value and reference are those of the worst sample
 *   l2               sqrt of the time average of (y - r)^2; value and reference are the root mean squares of y and r
 * and numbers drawn from the series, held against r at the last sample:
 *   mean             time average (trapezoidal rule)
 *   peak, min, range the largest, the smallest, their difference
 *   time-of-peak     t of the first sample that has the peak
 *   first-above      first t at which y > level, last-above the last; linear between samples
 *   duration         from first-above to last-above; 0 where y never is above
 *   integral         of y over t (trapezoidal rule); `impulse` says the same of a force
 *   slope            of the straight line closest to the samples (least squares)
 * Error: |value - reference| (max, l2: the norm of y - r) divided by `scale` where given, else by the reference's own size (max: the largest |r|;
 * l2: root mean square of r), else, where that is 0, by nothing: the error is absolute. NaN anywhere in the window, or no sample in it, is a miss. */
#ifndef AB_EXPECT_H
#define AB_EXPECT_H

#include "core/scene.h"

typedef enum ab_norm {
    AB_NORM_FINAL,
    AB_NORM_MAX,
    AB_NORM_L2,
    AB_NORM_MEAN,
    AB_NORM_PEAK,
    AB_NORM_MIN,
    AB_NORM_RANGE,
    AB_NORM_TIME_OF_PEAK,
    AB_NORM_FIRST_ABOVE,
    AB_NORM_LAST_ABOVE,
    AB_NORM_DURATION,
    AB_NORM_INTEGRAL,
    AB_NORM_SLOPE,
    AB_NORMS
} ab_norm;

typedef struct ab_expect { /* running sums */
    const ab_expect_spec *spec;
    ab_norm norm;
    size_t samples;
    bool broken;                               /* a value or a reference was not a number */
    double first_time, time, value, reference; /* of the first sample; of the last one */
    double worst, worst_value, worst_reference, largest_reference;
    double peak, peak_time, least;
    double integral, square_error, square_value, square_reference; /* integrals over time */
    double first_above, last_above;
    double origin, sum_t, sum_y, sum_tt, sum_ty; /* least squares, t and y relative to the first sample */
} ab_expect;

typedef struct ab_outcome {
    double value, reference, error, tolerance;
    bool pass;
} ab_outcome;

/* False where there is no norm of that name. */
bool ab_norm_find(const char *name, ab_norm *norm);
ab_status ab_expect_begin(ab_expect *expect, const ab_expect_spec *spec, ab_report *report);
/* True where a sample at this time matters; dt is the step, for rounding at the ends of the window. */
bool ab_expect_wants(const ab_expect *expect, double time, double dt);
/* True where the run has ended at this time and the sample is still needed (`final` leaves out the early ones: they cost a reading of points). */
bool ab_expect_wants_last(const ab_expect *expect, double time);
void ab_expect_sample(ab_expect *expect, double time, double value);
ab_outcome ab_expect_end(const ab_expect *expect);

#endif
