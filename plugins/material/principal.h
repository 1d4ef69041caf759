/* principal.h: principal values and directions of a symmetric tensor, shared by the materials that think in principal stresses.
 *
 * Tensors are six numbers (xx, yy, zz, xy, yz, zx), in plane strain and axisymmetry with yz = zx = 0: there z is a principal direction
 * and the other two are had in closed form; in space by Jacobi's rotations (Golub and Van Loan 2013, section 8.5), which keep the
 * directions orthogonal to rounding where values coincide. */
#ifndef AB_PRINCIPAL_H
#define AB_PRINCIPAL_H

#include <math.h>
#include <stdbool.h>

typedef struct principal {
    double value[3];     /* value[0] >= value[1] >= value[2] */
    bool plane;          /* z is a principal direction */
    int place[3];        /* plane: where the larger one in the plane, the smaller one and zz stand in value */
    double cosine, sine; /* plane: of twice the angle from x to the direction of the larger one in the plane */
    double axis[3][3];   /* space: axis[k] is the unit direction of value[k] */
} principal;

static inline void principal_swap(double *a, double *b) {
    const double keep = *a;
    *a = *b;
    *b = keep;
}

static inline void principal_plane(const double s[6], principal *p) {
    const double middle = 0.5 * s[0] + 0.5 * s[1], half = 0.5 * s[0] - 0.5 * s[1], radius = hypot(half, s[3]);
    const double larger = middle + radius, smaller = middle - radius, zz = s[2];
    p->cosine = radius > 0.0 ? half / radius : 1.0;
    p->sine = radius > 0.0 ? s[3] / radius : 0.0;
    p->place[0] = zz >= larger;
    p->place[1] = 1 + (zz >= smaller);
    p->place[2] = zz >= larger ? 0 : zz >= smaller ? 1 : 2;
    p->value[p->place[0]] = larger;
    p->value[p->place[1]] = smaller;
    p->value[p->place[2]] = zz;
}

/* One rotation that makes a[i][j] zero; the rows of v turn along. */
static inline void principal_rotate(double a[3][3], double v[3][3], int i, int j) {
    if (a[i][j] == 0.0) return;
    const double theta = (a[j][j] - a[i][i]) / (2.0 * a[i][j]);
    const double t = (theta >= 0.0 ? 1.0 : -1.0) / (fabs(theta) + hypot(theta, 1.0)), c = 1.0 / sqrt(t * t + 1.0), s = t * c;
    const int k = 3 - i - j;
    const double aij = a[i][j], aki = a[k][i], akj = a[k][j];
    a[i][i] -= t * aij;
    a[j][j] += t * aij;
    a[i][j] = a[j][i] = 0.0;
    a[k][i] = a[i][k] = c * aki - s * akj;
    a[k][j] = a[j][k] = s * aki + c * akj;
    for (int c3 = 0; c3 < 3; c3++) {
        const double vi = v[i][c3], vj = v[j][c3];
        v[i][c3] = c * vi - s * vj;
        v[j][c3] = s * vi + c * vj;
    }
}

static inline void principal_space(const double s[6], principal *p) {
    double size = 0.0;
    for (int c = 0; c < 6; c++) size = fmax(size, fabs(s[c]));
    const double scale = size > 0.0 ? size : 1.0; /* so that nothing under- or overflows */
    double a[3][3] = {
        {s[0] / scale, s[3] / scale, s[5] / scale}, {s[3] / scale, s[1] / scale, s[4] / scale}, {s[5] / scale, s[4] / scale, s[2] / scale}};
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int sweep = 0; sweep < 12 && fabs(a[0][1]) + fabs(a[1][2]) + fabs(a[2][0]) > 1e-300; sweep++) {
        principal_rotate(a, v, 0, 1);
        principal_rotate(a, v, 1, 2);
        principal_rotate(a, v, 0, 2);
    }
    for (int k = 0; k < 3; k++) {
        p->value[k] = scale * a[k][k];
        for (int c = 0; c < 3; c++) p->axis[k][c] = v[k][c];
    }
    static const int pairs[3][2] = {{0, 1}, {1, 2}, {0, 1}};
    for (int n = 0; n < 3; n++) {
        const int i = pairs[n][0], j = pairs[n][1];
        if (p->value[i] >= p->value[j]) continue;
        principal_swap(&p->value[i], &p->value[j]);
        for (int c = 0; c < 3; c++) principal_swap(&p->axis[i][c], &p->axis[j][c]);
    }
}

/* Principal values, largest first, and directions of s; `plane` says that yz and zx are 0. */
static inline void principal_of(const double s[6], bool plane, principal *p) {
    p->plane = plane;
    if (plane)
        principal_plane(s, p);
    else
        principal_space(s, p);
}

/* The tensor with the directions of p and other values, in the same order of size. */
static inline void principal_join(const principal *p, const double value[3], double s[6]) {
    if (p->plane) {
        const double larger = value[p->place[0]], smaller = value[p->place[1]];
        const double middle = 0.5 * larger + 0.5 * smaller, radius = 0.5 * larger - 0.5 * smaller;
        s[0] = middle + radius * p->cosine;
        s[1] = middle - radius * p->cosine;
        s[2] = value[p->place[2]];
        s[3] = radius * p->sine;
        s[4] = s[5] = 0.0;
        return;
    }
    static const int row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};
    for (int c = 0; c < 6; c++) {
        s[c] = 0.0;
        for (int k = 0; k < 3; k++) s[c] += value[k] * (p->axis[k][row[c]] * p->axis[k][column[c]]);
    }
}

#endif
