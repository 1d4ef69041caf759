/* test_stability_limits.c: the longest stable step of a row of equal points, worst over where it stands on the grid, with the kernels' own weights: the figures that
 * `cfl` is counted from. Points are frozen; on the nodes M a = -K u with M lumped, K = sum V E G G^T, so dt = 2/omega, omega^2 the largest eigenvalue of M^-1 K. */
#include "one_body.h"

static one_body *grid_of(const char *basis) {
    char text[2000];
    snprintf(text, sizeof text,
             "abut: 1\nspace: plane-strain\ntime: {end: 1, dt: 0.002}\ngrid: {from: [0, 0], to: [60, 30], cell: 1}\n"
             "materials: {m: {model: linear-elastic, E: 1, nu: 0, density: 1}}\n"
             "bodies: {b: {method: material-points, material: m, basis: %s, shape: {box: [[1, 1], [2, 2]]}}}\n",
             basis);
    return one_body_create(text, 1);
}

enum { CELLS = 12, NODES = CELLS + 8, FIRST = 16 /* node */, OFFSETS = 200 };

typedef struct row {
    double mass[NODES], stiffness[NODES][NODES];
} row;

/* A row of CELLS cells with so many points each, its end `offset` cells behind node FIRST + 4. E = rho = h = 1. */
static void assemble(mpm_body *body, int per_direction, double offset, row *r) {
    memset(r, 0, sizeof *r);
    double *block = mpm_block(body, 0);
    const double width = 1.0 / per_direction;
    const int nodes = body->kernel->nodes, patch = body->kernel->patch;
    for (int p = 0; p < CELLS * per_direction; p++) {
        for (int l = 0; l < 8; l++) {
            block[8 * ROW_X + l] = FIRST + 4 + offset + (p + 0.5) * width;
            block[8 * (ROW_X + 1) + l] = 12.25;
            for (int c = 0; c < 2 && body->kernel->domains; c++) {
                block[8 * (body->rows.half + c) + l] = 0.5 * width;
                block[8 * (body->rows.inverse_half + c) + l] = 2 / width;
            }
            for (int c = 0; c < 2 && body->kernel->convected; c++) block[8 * (body->rows.corners + 3 * c) + l] = 0.5 * width;
        }
        int32_t first[2][8];
        body->kernel->first(body, block, ROW_X, first);
        const mpm_tile tile = {.tx = first[0][0] / AB_TILE, .ty = first[1][0] / AB_TILE};
        mpm_stencils s;
        body->kernel->stencils(body, &tile, block, &s);
        double n[4] = {0}, g[4] = {0};
        for (int k = 0; k < nodes * nodes; k++) n[k % nodes] += s.value[k][0], g[k % nodes] += s.gx[k][0];
        const int from = tile.tx * AB_TILE + s.node[0] % patch - 1 - FIRST;
        for (int a = 0; a < nodes; a++) {
            r->mass[from + a] += width * n[a];
            for (int b = 0; b < nodes; b++) r->stiffness[from + a][from + b] += width * g[a] * g[b];
        }
    }
}

/* True where lambda - M^-1/2 K M^-1/2 has a Cholesky factor: no eigenvalue is above lambda. */
static bool above_all(const row *r, double lambda) {
    double l[NODES][NODES] = {{0}};
    for (int i = 0; i < NODES; i++) {
        if (!(r->mass[i] > 0)) {
            l[i][i] = 1;
            continue;
        }
        for (int j = 0; j <= i; j++) {
            if (!(r->mass[j] > 0)) continue;
            double a = (i == j ? lambda : 0) - r->stiffness[i][j] / sqrt(r->mass[i] * r->mass[j]);
            for (int k = 0; k < j; k++) a -= l[i][k] * l[j][k];
            if (i == j && !(a > 0)) return false;
            l[i][j] = i == j ? sqrt(a) : a / l[j][j];
        }
    }
    return true;
}

static double limit(mpm_body *body, int per_direction, double offset) {
    row r;
    assemble(body, per_direction, offset, &r);
    double low = 0, high = 1;
    while (!above_all(&r, high)) low = high, high *= 4;
    while (high - low > 1e-7 * high) {
        const double middle = 0.5 * (low + high);
        *(above_all(&r, middle) ? &high : &low) = middle;
    }
    return 2 / sqrt(high);
}

static double worst(mpm_body *body, int per_direction) {
    double least = INFINITY;
    for (int k = 0; k < OFFSETS; k++) least = fmin(least, limit(body, per_direction, (double)k / OFFSETS + 1e-9));
    return least;
}

static void test_limits_of_smooth_bases(void **state) {
    (void)state;
    static const struct {
        const char *basis;
        double two, four;
    } known[] = {{"gimp", 0.803, 0.664}, {"bspline2", 0.954, 1.023}, {"bspline3", 1.472, 1.496}, {"cpdi", 0.908, 0.689}};
    for (int b = 0; b < 4; b++) {
        one_body *one = grid_of(known[b].basis);
        double found[9];
        print_message("%-8s dt c/h with 1 .. 8 points per direction:", known[b].basis);
        for (int n = 1; n <= 8; n++) print_message(" %.4f", found[n] = worst(one->mpm, n));
        print_message("\n");
        assert_true(fabs(found[2] - known[b].two) <= 5.1e-4 && fabs(found[4] - known[b].four) <= 5.1e-4);
        for (int n = 1; n <= 8; n++) { /* what the program steps by */
            const double own = one->mpm->kernel->courant[n - 1];
            assert_true(own <= found[n] + 5.1e-4 && own >= 0.9 * found[n]);
        }
        one_body_destroy(one);
    }
}

/* A point a little behind a node pulls at the next one with all its stress, which has next to no mass. */
static void test_linear_basis_has_no_limit(void **state) {
    (void)state;
    one_body *one = grid_of("linear");
    for (int k = 1; k <= 12; k++) {
        const double eps = pow(10, -k), offset = 0.25 + eps, found = limit(one->mpm, 2, offset);
        print_message("last point %.0e behind a node: dt c/h = %.3e = %.4f sqrt(eps)\n", eps, found, found / sqrt(eps));
        if (k >= 3) assert_true(fabs(found / sqrt(eps) - 2) < 2e-2);
        if (k >= 5) assert_true(fabs(found / sqrt(eps) - 2) < (k > 10 ? 1e-2 : 1e-3)); /* 1e-12 of a cell is near rounding */
    }
    one_body_destroy(one);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_limits_of_smooth_bases), cmocka_unit_test(test_linear_basis_has_no_limit)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
