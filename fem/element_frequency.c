/* element_frequency.c: the highest frequency of eight free elements.
 *
 * Their stiffness is a sum of squares, K = R^T R: in plane strain each Gauss point gives the rows sqrt(V (lambda + mu)) tr, sqrt(V mu)
 * (exx - eyy) and sqrt(V mu) gxy. With masses in the columns, the frequencies squared are the eigenvalues of R^T R or of R R^T,
 * whichever is smaller. The largest is found by power iteration on the matrix instead of a vector: squared ten times it is the 1024th
 * power, and no starting vector can miss the mode. Rings have four rows: sqrt(V (lambda + 2/3 mu)) tr, sqrt(V mu) (exx - eyy), sqrt(V mu) gxy and
 * sqrt(V mu/3) (exx + eyy - 2 ett). */
#include <string.h>

#include "fem/element_inner.h"

enum { FREE = 2 * FEM_NODES, ROWS = 4 * FEM_GAUSS, SQUARINGS = 10 };

typedef struct squares { /* row r, column 2*a + c */
    int count, columns;
    lanes row[ROWS][FREE + 4]; /* q6: four more columns, its modes */
} squares;

/* Rows of one Gauss point from its gradients (x, y) of all columns' functions. */
static void add_point(squares *s, lanes volume, const fem_elastic *elastic, const lanes (*g)[2], bool dilatation) {
    const lanes shear = lanes_root(elastic->mu * volume), bulk = lanes_root((elastic->lambda + elastic->mu) * volume);
    lanes(*row)[FREE + 4] = s->row + s->count;
    for (int a = 0; 2 * a < s->columns; a++) {
        row[0][2 * a] = shear * g[a][0];
        row[0][2 * a + 1] = -shear * g[a][1];
        row[1][2 * a] = shear * g[a][1];
        row[1][2 * a + 1] = shear * g[a][0];
        if (!dilatation) continue;
        row[2][2 * a] = bulk * g[a][0];
        row[2][2 * a + 1] = bulk * g[a][1];
    }
    s->count += dilatation ? 3 : 2;
}

/* The same of a ring; hoop: N/r of the functions. */
static void add_ring(squares *s, lanes volume, const fem_elastic *elastic, const lanes (*g)[2], const lanes *hoop, bool dilatation) {
    const lanes bulk = lanes_root((elastic->lambda + 2.0 / 3.0 * elastic->mu) * volume), third = lanes_root((elastic->mu / 3.0) * volume);
    add_point(s, volume, elastic, g, false);
    lanes(*row)[FREE + 4] = s->row + s->count;
    for (int a = 0; 2 * a < s->columns; a++) {
        row[0][2 * a] = third * (g[a][0] - 2.0 * hoop[a]);
        row[0][2 * a + 1] = third * g[a][1];
        if (!dilatation) continue;
        row[1][2 * a] = bulk * (g[a][0] + hoop[a]);
        row[1][2 * a + 1] = bulk * g[a][1];
    }
    s->count += dilatation ? 2 : 1;
}

static fem_jacobian jacobian(int nodes, const double (*x)[8], const double (*dn)[2], int first) {
    fem_jacobian j = {.xx = {0}};
    for (int a = 0; a < nodes; a++) {
        const lanes px = lanes_load(x[2 * a] + first), py = lanes_load(x[2 * a + 1] + first);
        j.xx += dn[a][0] * px;
        j.xy += dn[a][1] * px;
        j.yx += dn[a][0] * py;
        j.yy += dn[a][1] * py;
    }
    return j;
}
/* J^-T of (xi, eta). */
static void push(fem_jacobian j, lanes r, lanes xi, lanes eta, lanes g[2]) {
    g[0] = (j.yy * xi - j.yx * eta) * r;
    g[1] = (j.xx * eta - j.xy * xi) * r;
}

/* Where the modes of q6 are measured from in a ring: fem/element_q6.c. */
static void middle_of_ring(const double (*x)[8], int first, lanes middle[2]) {
    const fem_bilinear f = fem_bilinear_of(x, NULL, first);
    const lanes third = 1.0 / (3.0 * fem_radius_centre(x, first));
    middle[0] = f.a[0] * third;
    middle[1] = f.b[0] * third;
}

/* Length of the circle at a place, m, and N/r of the nodes there. */
static lanes circumference(int nodes, const double (*x)[8], const double place[2], int first, lanes *hoop) {
    double n[FEM_NODES];
    lanes radius = {0};
    fem_shape(nodes, place[0], place[1], n);
    for (int a = 0; a < nodes; a++) radius += n[a] * lanes_load(x[2 * a] + first);
    for (int a = 0; a < nodes; a++) hoop[a] = n[a] / radius;
    return fem_circumference(radius);
}

static inline __attribute__((always_inline)) void stiffness_of(const fem_element *element, const double (*x)[8], const fem_elastic *elastic,
                                                               bool f_bar, double hourglass, int first, squares *s, const bool rings) {
    const int nodes = element->nodes;
    const bool q4 = element->strain == (rings ? fem_q4_strain_rings : fem_q4_strain),
               q4r = element->strain == (rings ? fem_q4r_strain_rings : fem_q4r_strain),
               q6 = element->strain == (rings ? fem_q6_strain_rings : fem_q6_strain),
               whole = rings && q4r; /* whole: by the mean strain over 2 x 2 points */
    f_bar = f_bar && q4;
    double dn0[FEM_NODES][2];
    fem_shape_derivatives(nodes, 0, 0, dn0);
    const fem_jacobian j0 = jacobian(nodes, x, dn0, first);
    const lanes det0 = fem_det(j0), r0 = 1.0 / det0;
    s->count = 0;
    s->columns = 2 * nodes + (q6 ? 4 : 0);
    lanes mean[FREE] = {{0}}, area = {0}, g[FEM_NODES + 2][2], hoop[FEM_NODES + 2] = {{0}}, mean_hoop[4] = {{0}}, middle[2] = {{0}};
    if (rings && q6) middle_of_ring(x, first, middle);
    const fem_element *points = whole ? fem_element_axisymmetric_of(AB_ELEMENT_Q4) : element;
    for (int q = 0; q < points->gauss; q++) {
        double place[2], weight, dn[FEM_NODES][2];
        fem_gauss(points, q, place, &weight);
        fem_shape_derivatives(nodes, place[0], place[1], dn);
        const fem_jacobian j = jacobian(nodes, x, dn, first);
        const lanes det = fem_det(j), r = 1.0 / det;
        const lanes volume = rings ? weight * det * circumference(nodes, x, place, first, hoop) : weight * det;
        for (int a = 0; a < nodes; a++) push(j, r, lanes_set(dn[a][0]), lanes_set(dn[a][1]), g[a]);
        if (q6) {
            push(j0, r, -2 * (place[0] - middle[0]), lanes_set(0), g[4]);
            push(j0, r, lanes_set(0), -2 * (place[1] - middle[1]), g[5]);
        }
        if (whole)
            for (int a = 0; a < 4; a++) mean_hoop[a] += volume * hoop[a];
        else if (rings) {
            add_ring(s, volume, elastic, g, hoop, !f_bar);
            for (int a = 0; a < nodes; a++) mean[2 * a] += volume * hoop[a];
        } else
            add_point(s, volume, elastic, g, !f_bar);
        area += volume;
        for (int a = 0; a < nodes; a++)
            for (int c = 0; c < 2; c++) mean[2 * a + c] += volume * g[a][c];
    }
    if (f_bar) {
        const lanes bulk = lanes_root((elastic->lambda + (rings ? 2.0 / 3.0 * elastic->mu : elastic->mu)) / area);
        for (int k = 0; k < s->columns; k++) s->row[s->count][k] = bulk * mean[k];
        s->count++;
    }
    if (whole) {
        const lanes inverse = 1.0 / area;
        for (int a = 0; a < 4; a++) {
            for (int c = 0; c < 2; c++) g[a][c] = inverse * mean[2 * a + c];
            hoop[a] = inverse * mean_hoop[a];
        }
        add_ring(s, area, elastic, (const lanes(*)[2])g, hoop, true);
        for (int a = 0; a < 4; a++)
            push(j0, r0, lanes_set(dn0[a][0]), lanes_set(dn0[a][1]), g[a]); /* at the centre, for the stabilisation */
    }
    if (q4r && hourglass > 0) {
        const fem_bilinear f = fem_bilinear_of(x, NULL, first);
        const fem_hourglass w = fem_hourglass_of(j0, r0, elastic, hourglass);
        const lanes slope = w.n * w.hxy / w.hxx,
                    modulus = whole ? w.modulus * fem_circumference(fem_radius_centre(x, first)) : lanes_set(w.modulus),
                    one = lanes_root(modulus * w.hxx), two = lanes_root(modulus * (w.hyy - w.n * w.hxy * slope));
        for (int a = 0; a < 4; a++) {
            const lanes gamma = (a % 2 ? -0.25 : 0.25) - f.h[0] * g[a][0] - f.h[1] * g[a][1]; /* g: of the only point, the centre */
            for (int c = 0; c < 2; c++) {
                const lanes qx = gamma * (c == 0 ? w.cosine : w.sine), qy = gamma * (c == 0 ? -w.sine : w.cosine);
                s->row[s->count][2 * a + c] = one * (qx - slope * qy);
                s->row[s->count + 1][2 * a + c] = two * qy;
            }
        }
        s->count += 2;
    }
}

static void stiffness(const fem_element *element, const double (*x)[8], const fem_elastic *elastic, bool f_bar, double hourglass, int first,
                      squares *s) {
    if (element->axisymmetric)
        stiffness_of(element, x, elastic, f_bar, hourglass, first, s, true);
    else
        stiffness_of(element, x, elastic, f_bar, hourglass, first, s, false);
}

/* a = R^T R (by columns) or R R^T (by rows), lower triangle; its size. */
static int product(const squares *s, bool by_rows, lanes (*a)[FREE + 4]) {
    const int n = by_rows ? s->count : s->columns, m = by_rows ? s->columns : s->count;
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) {
            lanes sum = {0};
            for (int k = 0; k < m; k++) sum += by_rows ? s->row[i][k] * s->row[j][k] : s->row[k][i] * s->row[k][j];
            a[i][j] = sum;
        }
    return n;
}

/* Takes the last `inner` columns out: they follow the others without force. */
static int condense(lanes (*a)[FREE + 4], int n, int inner) {
    for (int p = n - 1; p >= n - inner; p--) {
        const lanes inverse = 1.0 / a[p][p];
        for (int i = 0; i < p; i++) {
            const lanes factor = a[p][i] * inverse;
            for (int j = 0; j <= i; j++) a[i][j] -= factor * a[p][j];
        }
    }
    return n - inner;
}

/* Largest eigenvalue of a symmetric matrix without negative ones. With B = (A/s)^m of trace 1, trace(B^2) s^m lies between 0.4 of the
 * m-th power of the largest and itself, whatever the others are (16 of them at most); m = 1024 makes that 0.9 in 1000, and the middle of
 * it is returned. */
static lanes largest(lanes (*a)[FREE + 4], int n) {
    static const double MIDDLE = 1.00045;
    lanes size[SQUARINGS + 1];
    for (int step = 0; step <= SQUARINGS; step++) {
        lanes trace = {0};
        for (int i = 0; i < n; i++) trace += a[i][i];
        size[step] = trace;
        const lanes scale = 1.0 / trace;
        for (int i = 0; i < n; i++)
            for (int j = 0; j <= i; j++) a[i][j] = a[j][i] = a[i][j] * scale;
        if (step == SQUARINGS) break;
        lanes b[FREE + 4][FREE + 4];
        for (int i = 0; i < n; i++)
            for (int j = 0; j <= i; j++) {
                lanes sum = {0};
                for (int k = 0; k < n; k++) sum += a[i][k] * a[j][k];
                b[i][j] = sum;
            }
        for (int i = 0; i < n; i++) memcpy(a[i], b[i], (size_t)(i + 1) * sizeof b[i][0]);
    }
    lanes power = {0};
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) power += (i == j ? 1.0 : 2.0) * a[i][j] * a[i][j];
    for (int step = SQUARINGS; step > 0; step--) power = lanes_root(size[step] * power);
    return MIDDLE * size[0] * power;
}

static lanes frequency(const fem_element *element, const double (*x)[8], const double (*mass)[8], const fem_elastic *elastic, bool f_bar,
                       double hourglass, int first) {
    squares s;
    lanes a[FREE + 4][FREE + 4];
    stiffness(element, x, elastic, f_bar, hourglass, first, &s);
    for (int node = 0; node < element->nodes; node++) {
        const lanes scale = 1.0 / lanes_root(lanes_load(mass[node] + first));
        for (int r = 0; r < s.count; r++)
            for (int c = 0; c < 2; c++) s.row[r][2 * node + c] *= scale;
    }
    const int inner = s.columns - 2 * element->nodes;
    int n = product(&s, inner == 0 && s.count < s.columns, a);
    n = condense(a, n, inner);
    return largest(a, n);
}

void fem_element_frequency(const fem_element *element, const double (*x)[8], const fem_elastic *elastic, bool f_bar, double hourglass,
                           double frequency2[8]) {
    double mass[FEM_NODES][8];
    element->mass(x, elastic->density, mass);
    for (int first = 0; first < 8; first += LANES)
        lanes_store(frequency2 + first, frequency(element, x, (const double(*)[8])mass, elastic, f_bar, hourglass, first));
}
