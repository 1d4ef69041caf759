/* test_fem_trace.c: a body seen on the grid through points inside it: no mass is lost, velocities are those of the material around a node, area vectors point
 * out of the body, for elements from an eighth of a cell to eight cells, moved and turned; and following a motion gives the bits of a fresh start. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "effort.h"
#include "fem/trace.h"

static const double H = 0.25, DENSITY = 3.0;

/* A square of elements x elements bilinear elements, and so many points in each that they are nowhere further apart than half a cell. */
typedef struct square {
    double side, from[2], angle;
    int elements, per_side;
    size_t node_count;
    double *x; /* 2 a node */
    fem_inner inner;
} square;

static void place(const square *b, double u, double v, double x[2]) {
    x[0] = b->from[0] + cos(b->angle) * u - sin(b->angle) * v;
    x[1] = b->from[1] + sin(b->angle) * u + cos(b->angle) * v;
}

static square square_create(double side, int elements, const double from[2], double angle) {
    square b = {.side = side, .from = {from[0], from[1]}, .angle = angle, .elements = elements};
    const double element = side / elements;
    b.per_side = (int)fmax(2.0, ceil(element / (0.5 * H) - 1e-9));
    b.node_count = (size_t)((elements + 1) * (elements + 1));
    b.x = malloc(2 * b.node_count * sizeof *b.x);
    for (int j = 0; j <= elements; j++)
        for (int i = 0; i <= elements; i++) place(&b, i * element, j * element, b.x + 2 * (j * (elements + 1) + i));
    fem_inner *in = &b.inner;
    in->count = (size_t)(elements * elements * b.per_side * b.per_side);
    in->ld = in->count + 3;
    in->position = malloc(2 * in->ld * sizeof(double)), in->mass = malloc(in->ld * sizeof(double));
    in->volume = malloc(in->ld * sizeof(double)), in->extent = malloc(3 * in->ld * sizeof(double));
    in->start = malloc((in->count + 1) * sizeof *in->start), in->dof = malloc(4 * in->count * sizeof *in->dof);
    in->weight = malloc(4 * in->count * sizeof(double));
    size_t q = 0;
    const double small = element / b.per_side, c = cos(angle), s = sin(angle);
    for (int e = 0; e < elements * elements; e++)
        for (int p = 0; p < b.per_side * b.per_side; p++, q++) {
            const int i = e % elements, j = e / elements;
            const double xi = (p % b.per_side + 0.5) / b.per_side, eta = (p / b.per_side + 0.5) / b.per_side;
            double x[2];
            place(&b, (i + xi) * element, (j + eta) * element, x);
            in->position[q] = x[0], in->position[in->ld + q] = x[1];
            in->volume[q] = small * small, in->mass[q] = DENSITY * small * small;
            in->extent[q] = 0.25 * small * small * (c * c + s * s), in->extent[in->ld + q] = in->extent[q],
            in->extent[2 * in->ld + q] = 0.0;
            in->start[q] = 4 * q;
            for (int k = 0; k < 4; k++) {
                in->dof[4 * q + (size_t)k] = (uint32_t)((j + k / 2) * (elements + 1) + i + k % 2);
                in->weight[4 * q + (size_t)k] = (k % 2 ? xi : 1 - xi) * (k / 2 ? eta : 1 - eta);
            }
        }
    in->start[q] = 4 * q;
    return b;
}

static void square_clear(square *b) {
    fem_inner *in = &b->inner;
    free(b->x), free(in->position), free(in->mass), free(in->volume), free(in->extent), free(in->start), free(in->dof), free(in->weight);
}

static ab_scene scene(void) { return (ab_scene){.grid_cell = H}; }

/* Numbers of all nodes with mass. */
static size_t massive_nodes(const ab_node_tiles *tiles, uint32_t **nodes) {
    size_t count = 0;
    *nodes = malloc((tiles->count * AB_TILE_NODES + 1) * sizeof **nodes);
    for (size_t n = 0; n < tiles->count * AB_TILE_NODES; n++)
        if (tiles->mass[n * tiles->stride] > 0.0) (*nodes)[count++] = (uint32_t)n;
    return count;
}

static double hat(double distance) { return fmax(1.0 - fabs(distance) / H, 0.0); }

static const double FROM[3][2] = {{1.0, 2.0}, {1.0 + H * 0.41421356, 2.0 - H * 0.2679}, {-31.3, -17.77}};
static const double ANGLE[3] = {0.0, 0.5235987755982988, 2.2};

/* Calls look for every size of elements, place and angle. */
static void for_all(void (*look)(square *, fem_trace *, ab_report *)) {
    const ab_scene s = scene();
    ab_report *report = ab_report_create();
    for (int size = -3; size <= 3; size += EFFORT(1, 3))
        for (int k = 0; k < 9; k++) {
            const double element = H * pow(2.0, size);
            square b = square_create(fmax(element, 8 * H), (int)lround(fmax(8 * H / element, 1.0)), FROM[k / 3], ANGLE[k % 3]);
            fem_trace *t;
            assert_int_equal(fem_trace_create(&s, "b", 5.0, &t, report), AB_OK);
            assert_int_equal(fem_trace_update(t, &b.inner, report), AB_OK);
            look(&b, t, report);
            fem_trace_destroy(t);
            square_clear(&b);
        }
    ab_report_destroy(report);
}

static const uint32_t ALL = AB_NEED_SHARED_NODES | AB_NEED_MASS_GRADIENT | AB_NEED_AREA_VECTOR | AB_NEED_NEAR_POINTS;

static void look_at_masses(square *b, fem_trace *t, ab_report *report) {
    ab_node_tiles tiles;
    fem_trace_tiles(t, &tiles);
    assert_true(tiles.count > 0);
    double sum = 0;
    for (size_t k = 0; k < tiles.count; k++) {
        if (k) assert_true(tiles.key[k] > tiles.key[k - 1]);
        for (size_t n = 0; n < AB_TILE_NODES; n++) sum += tiles.mass[(k * AB_TILE_NODES + n) * tiles.stride];
    }
    const double whole = DENSITY * b->side * b->side;
    assert_true(fabs(sum - whole) < 1e-13 * whole);
    uint32_t *nodes;
    const size_t count = massive_nodes(&tiles, &nodes);
    ab_trace trace;
    assert_int_equal(fem_trace_nodes(t, &b->inner, nodes, count, ALL, &trace, report), AB_OK);
    assert_int_equal(trace.count, count);
    assert_string_equal(trace.body, "b");
    assert_true(trace.stiffness == 5.0 && trace.cell == H && trace.dimension == 2);
    const fem_inner *in = &b->inner;
    for (size_t k = 0; k < count; k++) {
        const double *x = trace.position;
        double mass = 0, area[2] = {0};
        size_t near = 0;
        for (size_t q = 0; q < in->count; q++) {
            const double dx = in->position[q] - x[k], dy = in->position[in->ld + q] - x[trace.ld + k];
            mass += in->mass[q] * hat(dx) * hat(dy);
            near += hat(dx) * hat(dy) > 0;
            if (fabs(dx) < H) area[0] += in->volume[q] * (dx < 0 ? 1 : -1) / H * hat(dy);
            if (fabs(dy) < H) area[1] += in->volume[q] * (dy < 0 ? 1 : -1) / H * hat(dx);
        }
        assert_true(fabs(trace.mass[k] - mass) < 1e-13 * DENSITY * H * H);
        const uint64_t tile = tiles.key[nodes[k] / AB_TILE_NODES];
        const int i = ab_tile_x(tile) * AB_TILE + (int)(nodes[k] % AB_TILE),
                  j = ab_tile_y(tile) * AB_TILE + (int)(nodes[k] % AB_TILE_NODES) / AB_TILE;
        assert_true(trace.key[k] == ab_tile_key(i, j) && fabs(x[k] - H * i) < 1e-12 && fabs(x[trace.ld + k] - H * j) < 1e-12);
        for (size_t c = 0; c < 2; c++) { /* a point on a line of the grid has two slopes */
            assert_true(fabs(trace.mass_gradient[c * trace.ld + k] - DENSITY * trace.area_vector[c * trace.ld + k]) < 1e-11);
            if (b->angle != 0.0) assert_true(fabs(trace.area_vector[c * trace.ld + k] - area[c]) < 1e-11);
        }
        if (b->angle != 0.0) assert_int_equal(trace.near_start[k + 1] - trace.near_start[k], near);
        for (size_t p = trace.near_start[k]; p < trace.near_start[k + 1]; p++) {
            assert_true(hat(trace.near_position[p] - x[k]) * hat(trace.near_position[trace.near_ld + p] - x[trace.ld + k]) > 0);
            assert_true(trace.near_extent[p] == in->extent[0] && trace.near_extent[2 * trace.near_ld + p] == 0.0);
        }
    }
    free(nodes);
}

static void test_no_mass_is_lost(void **state) {
    (void)state;
    for_all(look_at_masses);
}

/* v = a + B x at the nodes of the elements: at a node of the grid stands its average over the points around, by mass and hat. */
static void look_at_velocities(square *b, fem_trace *t, ab_report *report) {
    static const double A[2] = {0.3, -0.7}, B[2][2] = {{0.2, -1.1}, {0.9, 0.4}};
    ab_node_tiles tiles;
    fem_trace_tiles(t, &tiles);
    uint32_t *nodes;
    const size_t count = massive_nodes(&tiles, &nodes);
    ab_trace trace;
    assert_int_equal(fem_trace_nodes(t, &b->inner, nodes, count, AB_NEED_SHARED_NODES, &trace, report), AB_OK);
    assert_null(trace.near_start);
    assert_null(trace.area_vector);
    const fem_inner *in = &b->inner;
    double size = 0;
    for (int c = 0; c < 2; c++) size += fabs(b->x[c]) + b->side;
    for (size_t k = 0; k < count; k++) {
        const double x[2] = {trace.position[k], trace.position[trace.ld + k]};
        double v[2] = {0}, expected[2] = {0}, weights = 0, mass = 0;
        for (size_t s = trace.stencil_start[k]; s < trace.stencil_start[k + 1]; s++) {
            const double *y = b->x + 2 * trace.stencil_dof[s];
            weights += trace.stencil_weight[s];
            for (int c = 0; c < 2; c++) v[c] += trace.stencil_weight[s] * (A[c] + B[c][0] * y[0] + B[c][1] * y[1]);
            for (size_t r = trace.stencil_start[k]; r < s; r++) assert_int_not_equal(trace.stencil_dof[r], trace.stencil_dof[s]);
        }
        assert_true(fabs(weights - 1.0) < 1e-14);
        if (trace.mass[k] < 1e-9 * DENSITY * H * H) continue;
        for (size_t q = 0; q < in->count; q++) {
            const double y[2] = {in->position[q], in->position[in->ld + q]}, n = hat(y[0] - x[0]) * hat(y[1] - x[1]) * in->mass[q];
            mass += n;
            for (int c = 0; c < 2; c++) expected[c] += n * (A[c] + B[c][0] * y[0] + B[c][1] * y[1]);
        }
        for (int c = 0; c < 2; c++) assert_true(fabs(v[c] - expected[c] / mass) < 1e-12 * size);
    }
    free(nodes);
}

static void test_a_linear_field_of_velocity_is_kept(void **state) {
    (void)state;
    for_all(look_at_velocities);
}

/* Area vectors add up to nothing; those of the nodes nearest to one side to that side's length times its normal, but for the corners. */
static void look_at_areas(square *b, fem_trace *t, ab_report *report) {
    ab_node_tiles tiles;
    fem_trace_tiles(t, &tiles);
    uint32_t *nodes;
    const size_t count = massive_nodes(&tiles, &nodes);
    ab_trace trace;
    assert_int_equal(fem_trace_nodes(t, &b->inner, nodes, count, AB_NEED_AREA_VECTOR, &trace, report), AB_OK);
    double sum[2] = {0}, of_side[4][2] = {{0}};
    for (size_t k = 0; k < count; k++) {
        const double a[2] = {trace.area_vector[k], trace.area_vector[trace.ld + k]};
        const double dx = trace.position[k] - b->from[0], dy = trace.position[trace.ld + k] - b->from[1];
        const double u = cos(b->angle) * dx + sin(b->angle) * dy, v = cos(b->angle) * dy - sin(b->angle) * dx;
        const double depth[4] = {v, b->side - u, b->side - v, u}; /* of bottom, right, top, left */
        int side = 0;
        for (int s = 1; s < 4; s++)
            if (depth[s] < depth[side]) side = s;
        for (int c = 0; c < 2; c++) sum[c] += a[c], of_side[side][c] += a[c];
    }
    assert_true(hypot(sum[0], sum[1]) < 1e-12 * b->side);
    for (int s = 0; s < 4; s++) {
        const double turn = b->angle + (s - 1) * acos(0.0), along = of_side[s][0] * cos(turn) + of_side[s][1] * sin(turn),
                     across = of_side[s][1] * cos(turn) - of_side[s][0] * sin(turn);
        assert_true(fabs(along - b->side) < 0.15 * b->side);
        assert_true(fabs(across) < 0.1 * b->side);
    }
    free(nodes);
}

static void test_area_vectors_point_out(void **state) {
    (void)state;
    for_all(look_at_areas);
}

/* A body that moves and turns: followed, it has the bits of one that starts there; the list of tiles changes only where new ones are reached. */
static void test_following_is_starting_anew(void **state) {
    (void)state;
    const ab_scene s = scene();
    ab_report *report = ab_report_create();
    const double from[2] = {-0.3, 0.2};
    square b = square_create(8.1 * H, 9, from, 0.1);
    fem_trace *followed;
    assert_int_equal(fem_trace_create(&s, "b", 5.0, &followed, report), AB_OK);
    uint64_t version = 0;
    int lists = 0;
    for (int step = 0; step < 400; step++) {
        fem_inner *in = &b.inner;
        for (size_t q = 0; q < in->count; q++) {
            const double x = in->position[q], y = in->position[in->ld + q];
            in->position[q] = x - 0.03 * H + 0.0007 * y;
            in->position[in->ld + q] = y + 0.011 * H - 0.0007 * x;
        }
        fem_trace *fresh;
        assert_int_equal(fem_trace_update(followed, in, report), AB_OK);
        assert_int_equal(fem_trace_create(&s, "b", 5.0, &fresh, report), AB_OK);
        assert_int_equal(fem_trace_update(fresh, in, report), AB_OK);
        ab_node_tiles a, c;
        fem_trace_tiles(followed, &a);
        fem_trace_tiles(fresh, &c);
        if (a.version != version) ++lists;
        version = a.version;
        size_t at = 0;
        for (size_t k = 0; k < a.count; k++) {
            const double *mass = a.mass + k * AB_TILE_NODES * a.stride;
            if (at < c.count && c.key[at] == a.key[k]) {
                assert_memory_equal(mass, c.mass + at * AB_TILE_NODES * c.stride, AB_TILE_NODES * sizeof *mass);
                ++at;
            } else {
                for (int n = 0; n < AB_TILE_NODES; n++) assert_true(mass[n] == 0.0);
            }
        }
        assert_int_equal(at, c.count);
        fem_trace_destroy(fresh);
    }
    assert_in_range(lists, 3, 30);
    fem_trace_destroy(followed);
    square_clear(&b);
    ab_report_destroy(report);
}

/* A body without points, and one that has blown up. */
static void test_nothing_and_nowhere(void **state) {
    (void)state;
    const ab_scene s = scene(), bare = {0};
    ab_report *report = ab_report_create();
    fem_trace *t;
    assert_int_equal(fem_trace_create(&bare, "b", 5.0, &t, report), AB_FAILED);
    assert_null(t);
    assert_int_equal(fem_trace_create(&s, "b", 5.0, &t, report), AB_OK);
    fem_inner none = {0};
    ab_node_tiles tiles;
    assert_int_equal(fem_trace_update(t, &none, report), AB_OK);
    fem_trace_tiles(t, &tiles);
    assert_int_equal(tiles.count, 0);
    const double from[2] = {0, 0};
    square b = square_create(4 * H, 4, from, 0);
    assert_int_equal(fem_trace_update(t, &b.inner, report), AB_OK);
    fem_trace_tiles(t, &tiles);
    assert_int_equal(tiles.count, 1);
    b.inner.position[5] = NAN;
    assert_int_equal(fem_trace_update(t, &b.inner, report), AB_FAILED);
    b.inner.position[5] = 1e300;
    assert_int_equal(fem_trace_update(t, &b.inner, report), AB_FAILED);
    fem_trace_destroy(t);
    square_clear(&b);
    ab_report_destroy(report);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_mass_is_lost),        cmocka_unit_test(test_a_linear_field_of_velocity_is_kept),
        cmocka_unit_test(test_area_vectors_point_out), cmocka_unit_test(test_following_is_starting_anew),
        cmocka_unit_test(test_nothing_and_nowhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
