/* density.h: the slope of a body's density at a grid node, as contact finders see it. Densities at the centres c of the 2^d cells that meet at the node are
 * rho_c = sum_p m_p prod_k B(x_c - x_p), B the quadratic B-spline of the cell's size; the plane that fits them best by least squares has as its slope along k the mean over the
 * other directions of the differences along k. The centres form a box, so that this is the same in three dimensions. */
#ifndef AB_DENSITY_H
#define AB_DENSITY_H

#include <math.h>

/* Quadratic B-spline of unit width and unit integral, u in cells from its middle. */
static inline double ab_density_spline(double u) {
    const double a = fabs(u), b = 1.5 - a;
    return a < 0.5 ? 0.75 - u * u : b > 0.0 ? 0.5 * b * b : 0.0;
}

/* What a point s cells from the node along one direction (point less node) adds: to the difference of the two centres there, upper less lower, and to their mean. */
static inline void ab_density_pair(double s, double *difference, double *mean) {
    const double upper = ab_density_spline(s - 0.5), lower = ab_density_spline(s + 0.5);
    *difference = upper - lower;
    *mean = 0.5 * (upper + lower);
}

#endif
