/* test_basis.c: what every basis promises wherever a point stands, at walls, in corners and between walls a few cells apart: weights add up to 1 and reproduce places,
 * gradients are their slopes, no weight is negative, and nodes beyond a side that holds nodes get nothing from a spline. */
#include "effort.h"
#include "one_body.h"

static const char *const bases[] = {"linear", "gimp", "bspline2", "bspline3", "cpdi"};
enum {
    BASES = sizeof bases / sizeof *bases,
    CPDI = BASES - 1 /* the one without a value at every place: gradients are means over domains */
};
static const double CELL = 0.5;

/* A grid of so many cells with the sides left, right, bottom, top. */
static one_body *grid_of(const char *basis, int across, int up, const char *const side[4]) {
    char text[2000];
    snprintf(
        text, sizeof text,
        "abut: 1\nspace: plane-strain\ntime: {end: 1e4, dt: 0.002}\n"
        "grid: {from: [-5, -3], to: [%g, %g], cell: %g, sides: {left: %s, right: %s, bottom: %s, top: %s}}\n"
        "materials: {m: {model: linear-elastic, E: 1000, nu: 0.3, density: 1}}\n"
        "bodies: {b: {method: material-points, material: m, basis: %s, shape: {box: [[-4.9, -2.9], [-4.6, -2.6]]}, fill: {rule: regular, "
        "per_cell: 100}}}\n",
        across * CELL - 5, up * CELL - 3, CELL, side[0], side[1], side[2], side[3], basis);
    return one_body_create(text, 1);
}

/* A place along one direction, in cells, of one of several kinds. */
static double place_on(int cells, int kind, double reach) {
    switch (kind % 6) {
    case 0: return random_between(0, cells);
    case 1: return random_between(0, 1) < 0.5 ? 0 : cells;
    case 2: return floor(random_between(0, cells + 1));
    case 3: return fmin(floor(random_between(0, 2 * cells)) / 2 + 0.5 * (random_between(0, 1) < 0.5), cells);
    case 4: {
        const double near =
            floor(random_between(0, 2 * cells + 1)) / 2 + pow(10, random_between(-16, -1)) * (random_between(0, 1) < 0.5 ? -1 : 1);
        return fmin(fmax(near, 0), cells);
    }
    default: return random_between(0, 1) < 0.5 ? random_between(0, fmin(reach, cells)) : cells - random_between(0, fmin(reach, cells));
    }
}

static void put(mpm_body *body, double *block, int l, const double cells[2], double half) {
    for (int c = 0; c < 2; c++) {
        block[8 * (ROW_X + c) + l] = cells[c] * body->h;
        if (!body->kernel->domains) continue;
        block[8 * (body->rows.half + c) + l] = half * body->h;
        block[8 * (body->rows.inverse_half + c) + l] = 1 / (half * body->h);
    }
    if (!body->kernel->convected) return;
    double *r =
        block + 8 * body->rows.corners + l; /* some box, or any parallelogram up to long and thin ones that stick out of the stencil */
    const double turn = random_between(0, 6.28), shear = random_between(0, 1) < 0.3 ? random_between(-6, 6) : 0, size = half * body->h,
                 cosine = shear == 0 && turn < 2 ? 1 : cos(turn), sine = shear == 0 && turn < 2 ? 0 : sin(turn),
                 flat = turn < 4 ? 1 : turn - 2;
    r[0] = size * flat * cosine, r[8] = size * flat * sine;
    r[16] = size * (shear * cosine - sine / flat), r[24] = size * (shear * sine + cosine / flat);
}

static int tile_of(int node) { return (int)floor((double)node / AB_TILE); }

typedef struct worst {
    double sum, place, slope, linear, lowest, outside;
} worst;

/* One point: everything in cells. */
static void look(const mpm_body *body, const mpm_tile *tile, const mpm_stencils *s, int l, const double cells[2], const bool holds[4],
                 worst *w) {
    const int nodes = body->kernel->nodes, patch = body->kernel->patch;
    assert_true(s->node[l] >= 0 && s->node[l] % patch + nodes <= patch && s->node[l] / patch + nodes <= patch);
    double sum = 0, place[2] = {0}, slope[2] = {0}, linear[2][2] = {{0}};
    for (int k = 0; k < nodes * nodes; k++) {
        const int at = s->node[l] + k / nodes * patch + k % nodes;
        const int node[2] = {tile->tx * AB_TILE + at % patch - 1, tile->ty * AB_TILE + at / patch - 1};
        const double n = s->value[k][l], g[2] = {s->gx[k][l] * body->h, s->gy[k][l] * body->h};
        sum += n;
        w->lowest = fmin(w->lowest, n);
        for (int c = 0; c < 2; c++) {
            place[c] += n * (node[c] - cells[c]);
            slope[c] += g[c];
            for (int d = 0; d < 2; d++) linear[c][d] += g[c] * (node[d] - cells[d]);
            if ((holds[2 * c] && node[c] < 0) || (holds[2 * c + 1] && node[c] > body->scene->grid_cells[c]))
                w->outside = fmax(w->outside, fabs(n) + fabs(g[0]) + fabs(g[1]));
        }
    }
    w->sum = fmax(w->sum, fabs(sum - 1));
    for (int c = 0; c < 2; c++) {
        w->place = fmax(w->place, fabs(place[c]));
        w->slope = fmax(w->slope, fabs(slope[c]));
        for (int d = 0; d < 2; d++) w->linear = fmax(w->linear, fabs(linear[c][d] - (c == d)));
    }
}

static void test_weights_add_up_and_reproduce_places_everywhere(void **state) {
    (void)state;
    static const int size[][2] = {{40, 40}, {9, 17}, {3, 40}, {2, 3}, {1, 2}, {1, 1}, {1, 40}};
    static const char *const sides[][4] = {{"roller", "roller", "fixed", "roller"},
                                           {"roller", "free", "free", "fixed"},
                                           {"free", "free", "free", "free"},
                                           {"fixed", "roller", "roller", "outflow"}};
    for (int b = 0; b < BASES; b++) {
        worst w = {0};
        for (int run = 0; run < 28; run++) {
            const int *cells = size[run / 4];
            const char *const *side = sides[run % 4];
            bool holds[4];
            for (int s = 0; s < 4; s++) holds[s] = !strcmp(side[s], "roller") || !strcmp(side[s], "fixed");
            one_body *one = grid_of(bases[b], cells[0], cells[1], side);
            mpm_body *body = one->mpm;
            double *block = mpm_block(body, 0);
            for (int round = 0; round < EFFORT(3000, 300); round++) {
                double at[8][2];
                int32_t first[2][8], before[2][8], behind[2][8];
                for (int l = 0; l < 8; l++) {
                    for (int c = 0; c < 2; c++) at[l][c] = place_on(cells[c], round + c * (l + round / 6), 2);
                    put(body, block, l, at[l], random_between(0, 1) < 0.3 ? 0.5 : random_between(0.05, 0.5));
                    for (int c = 0; c < 2; c++) at[l][c] = block[8 * (ROW_X + c) + l] * body->inverse_h;
                }
                body->kernel->first(body, block, ROW_X, first);
                for (int way = 0; way < 2; way++) { /* by rounding a point may have another first node in its tile than in the grid */
                    for (int l = 0; l < 8; l++)
                        for (int c = 0; c < 2; c++) block[8 * (ROW_NEXT + c) + l] = (at[l][c] + (way ? 1e-9 : -1e-9)) * body->h;
                    body->kernel->first(body, block, ROW_NEXT, way ? behind : before);
                }
                for (int drift = -1; drift <= 1; drift++) { /* points may have drifted out of their tile by a cell */
                    mpm_tile tile = {.tx = tile_of(first[0][0] + drift), .ty = tile_of(first[1][0] - drift)};
                    mpm_stencils s;
                    body->kernel->stencils(body, &tile, block, &s);
                    for (int l = 0; l < 8; l++) {
                        const int i = tile.tx * AB_TILE, j = tile.ty * AB_TILE;
                        if (before[0][l] >= i - 1 && before[1][l] >= j - 1 && behind[0][l] <= i + AB_TILE && behind[1][l] <= j + AB_TILE)
                            look(body, &tile, &s, l, at[l], holds, &w);
                    }
                }
            }
            one_body_destroy(one);
        }
        print_message("%-8s sum N - 1: %.1e, sum N x - x: %.1e h, sum G: %.1e/h, sum G x - 1: %.1e, least N: %.1e, beyond sides: %.1e\n",
                      bases[b], w.sum, w.place, w.slope, w.linear, w.lowest, w.outside);
        assert_true(w.sum <= 1e-13 && w.place <= 1e-13 && w.slope <= 1e-13 && w.linear <= 1e-13 && w.lowest >= (b < 2 ? -1e-16 : 0));
        if (b >= 2 && b != CPDI) assert_true(w.outside == 0);
    }
}

/* A gradient is the slope of its value: differences over a small distance that keeps the stencil. */
static void test_gradients_are_slopes(void **state) {
    (void)state;
    static const char *const side[] = {"roller", "fixed", "fixed", "free"};
    for (int b = 0; b < CPDI; b++) {
        double most = 0;
        for (int size = 1; size <= 4; size++) {
            one_body *one = grid_of(bases[b], size, 3, side);
            mpm_body *body = one->mpm;
            double *block = mpm_block(body, 0);
            const double small = 1e-5;
            for (int round = 0; round < EFFORT(2000, 200); round++) {
                const double middle[2] = {random_between(small, size - small), random_between(small, 3 - small)},
                             half = random_between(0.1, 0.5);
                static const int step[5][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}};
                int32_t first[2][8];
                bool same = true;
                for (int l = 0; l < 8; l++) {
                    const int *by = step[l < 5 ? l : 0];
                    put(body, block, l, (const double[]){middle[0] + by[0] * small, middle[1] + by[1] * small}, half);
                }
                body->kernel->first(body, block, ROW_X, first);
                for (int l = 1; l < 5; l++) same = same && first[0][l] == first[0][0] && first[1][l] == first[1][0];
                if (!same) continue;
                const mpm_tile tile = {.tx = tile_of(first[0][0]), .ty = tile_of(first[1][0])};
                mpm_stencils s;
                body->kernel->stencils(body, &tile, block, &s);
                for (int k = 0; k < body->kernel->nodes * body->kernel->nodes; k++) {
                    most = fmax(most, fabs((s.value[k][2] - s.value[k][1]) / (2 * small) - s.gx[k][0] * body->h));
                    most = fmax(most, fabs((s.value[k][4] - s.value[k][3]) / (2 * small) - s.gy[k][0] * body->h));
                }
            }
            one_body_destroy(one);
        }
        print_message("%-8s gradients apart from differences by %.1e/h\n", bases[b], most);
        assert_true(most < (b == 1 ? 2e-4 : 1e-9)); /* gimp has corners of its own within a stencil */
    }
}

/* Interior: h^2/4 and h^2/3, which apic counts on; at a side that holds nodes it falls to 0. */
static void test_splines_have_their_spread(void **state) {
    (void)state;
    static const char *const side[] = {"roller", "free", "fixed", "free"};
    for (int b = 2; b < CPDI; b++) {
        one_body *one = grid_of(bases[b], 40, 40, side);
        mpm_body *body = one->mpm;
        double *block = mpm_block(body, 0), d[3][8], most = 0;
        const double inside = b == 2 ? 1.0 / 4 : 1.0 / 3, band = b == 2 ? 0.5 : 1;
        for (int round = 0; round < EFFORT(2000, 200); round++) {
            for (int l = 0; l < 8; l++) put(body, block, l, (const double[]){random_between(0, 7), random_between(0, 7)}, 0);
            mpm_tile tile = {.tx = 0, .ty = 0};
            body->kernel->spreads(body, &tile, block, d);
            for (int l = 0; l < 8; l++)
                for (int c = 0; c < 2; c++) {
                    const double x = block[8 * (ROW_X + c) + l] * body->inverse_h, spread = d[c][l] / (body->h * body->h);
                    if (x >= band)
                        most = fmax(most, fabs(spread - inside));
                    else
                        assert_true(spread >= 0 && spread <= inside + 1e-13);
                }
        }
        print_message("%-8s D off by %.1e h2 inside\n", bases[b], most);
        assert_true(most <= 1e-13);
        put(body, block, 0, (const double[]){0, 0}, 0);
        mpm_tile tile = {.tx = 0, .ty = 0};
        body->kernel->spreads(body, &tile, block, d);
        assert_true(d[0][0] >= 0 && d[0][0] < 1e-13 && d[1][0] < 1e-13);
        one_body_destroy(one);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_weights_add_up_and_reproduce_places_everywhere),
        cmocka_unit_test(test_gradients_are_slopes),
        cmocka_unit_test(test_splines_have_their_spread),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
