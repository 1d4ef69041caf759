/* test_point_to_segment.c: the finder alone, on surfaces that are drawn here: closest places against a search by force, corners, sides. Areas: test_facing_length.c. */
#include "effort.h"
#include "finder_bench.h"

/* ---- closest places ------------------------------------------------------------------------------------------------------------- */

static uint64_t seed = 20240607;
static double random_between(double low, double high) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(seed >> 11) * 0x1p-53;
}

/* A closed outline, star-shaped about the origin and not convex. */
static surface_body *random_outline(bool quadratic) {
    enum { CORNERS = 16 };
    double corner[CORNERS][2];
    for (int k = 0; k < CORNERS; k++) {
        const double angle = 2 * 3.141592653589793 * (k + random_between(-0.3, 0.3)) / CORNERS,
                     radius = quadratic ? random_between(0.8, 1.2) : random_between(0.5, 1.5);
        corner[k][0] = radius * cos(angle);
        corner[k][1] = radius * sin(angle);
    }
    return surface_polygon("outline", (const double(*)[2])corner, CORNERS, quadratic, 1);
}

static void place_on(const surface_body *b, size_t face, double xi, double r[2]) {
    const uint32_t *v = b->face + 3 * face;
    for (size_t c = 0; c < 2; c++) {
        const double *x = b->x + c * b->vertices;
        r[c] = v[2] == UINT32_MAX ? 0.5 * (1 - xi) * x[v[0]] + 0.5 * (1 + xi) * x[v[1]]
                                  : 0.5 * xi * (xi - 1) * x[v[0]] + 0.5 * xi * (xi + 1) * x[v[1]] + (1 - xi * xi) * x[v[2]];
    }
}

static double distance_at(const surface_body *b, size_t face, double xi, const double t[2]) {
    double r[2];
    place_on(b, face, xi, r);
    return hypot(t[0] - r[0], t[1] - r[1]);
}

/* Samples, and between those beside every least one thirds of thirds. */
static double distance_to_face(const surface_body *b, size_t face, const double t[2]) {
    enum { SAMPLES = 40 };
    double d[SAMPLES + 1], best = INFINITY;
    for (int k = 0; k <= SAMPLES; k++) d[k] = distance_at(b, face, -1 + 2.0 * k / SAMPLES, t);
    for (int k = 0; k <= SAMPLES; k++) {
        if ((k && d[k - 1] < d[k]) || (k < SAMPLES && d[k + 1] < d[k])) continue;
        double low = fmax(-1, -1 + 2.0 * (k - 1) / SAMPLES), high = fmin(1, -1 + 2.0 * (k + 1) / SAMPLES);
        for (int third = 0; third < 60; third++) {
            const double one = low + (high - low) / 3, two = high - (high - low) / 3;
            if (distance_at(b, face, one, t) < distance_at(b, face, two, t))
                high = two;
            else
                low = one;
        }
        best = fmin(best, fmin(d[k], distance_at(b, face, 0.5 * (low + high), t)));
    }
    return best;
}

/* Inside by the winding of a fine polygon. */
static bool is_inside(const surface_body *b, const double t[2]) {
    enum { PIECES = 64 };
    bool inside = false;
    for (size_t f = 0; f < b->faces; f++)
        for (int k = 0; k < (b->face[3 * f + 2] == UINT32_MAX ? 1 : PIECES); k++) {
            const int pieces = b->face[3 * f + 2] == UINT32_MAX ? 1 : PIECES;
            double p[2], q[2];
            place_on(b, f, -1 + 2.0 * k / pieces, p);
            place_on(b, f, -1 + 2.0 * (k + 1) / pieces, q);
            if ((p[1] > t[1]) != (q[1] > t[1]) && t[0] < p[0] + (t[1] - p[1]) / (q[1] - p[1]) * (q[0] - p[0])) inside = !inside;
        }
    return inside;
}

static void closest(bool quadratic) {
    enum { OUTLINES = EFFORT(40, 10), PLACES = 1000 };
    finder f;
    finder_open(&f, NULL, 0);
    double worst = 0;
    size_t outside = 0, inside = 0, corners = 0;
    for (int o = 0; o < OUTLINES; o++) {
        surface_body *b = random_outline(quadratic);
        for (int k = 0; k < PLACES; k += POINTS_MOST) {
            double place[POINTS_MOST][2];
            for (int i = 0; i < POINTS_MOST; i++)
                for (int c = 0; c < 2; c++) place[i][c] = random_between(-1.7, 1.7);
            surface_body *a = cloud((const double(*)[2])place, POINTS_MOST, 0);
            const size_t count = look(&f, a, b, 10);
            const ab_points *p = &f.points.view;
            assert_int_equal(p->failures, 0);
            for (int i = 0; i < POINTS_MOST; i++) {
                double distance = INFINITY;
                for (size_t face = 0; face < b->faces; face++) distance = fmin(distance, distance_to_face(b, face, place[i]));
                const bool in = is_inside(b, place[i]);
                if (quadratic && distance < 1e-3) continue; /* the polygon does not know */
                size_t hits = 0, least = 0;
                for (size_t n = 0; n < count; n++)
                    if (p->a_dof[p->a_start[n]] == (uint32_t)i && (!hits++ || p->gap[n] < p->gap[least])) least = n;
                assert_true(hits > 0);
                double expected = in ? -distance : distance;
                if (in) { /* behind a concave corner two faces answer, each with the distance along its normal, which is less */
                    double negative = 0;
                    for (size_t n = 0; n < count; n++)
                        if (p->a_dof[p->a_start[n]] == (uint32_t)i && p->gap[n] < 0) negative = fmin(negative, p->gap[n]);
                    const double r[2] = {place[i][0] - p->position[least], place[i][1] - p->position[p->ld + least]};
                    if (fabs(hypot(r[0], r[1]) - distance) <= 1e-9 && negative > expected + 1e-9) {
                        corners++;
                        continue;
                    }
                    inside++;
                    worst = fmax(worst, fabs(negative - expected));
                } else {
                    outside++;
                    worst = fmax(worst, fabs(p->gap[least] - expected));
                    /* out of a into b: towards the place */
                    const double r[2] = {p->position[least] - place[i][0], p->position[p->ld + least] - place[i][1]};
                    near(r[0] * nx(&f, least) + r[1] * ny(&f, least), distance, 1e-7);
                }
            }
            surface_body_destroy(a);
        }
        surface_body_destroy(b);
    }
    print_message("%s faces: %zu places outside, %zu inside, %zu behind concave corners; worst distance off by %.1e\n",
                  quadratic ? "quadratic" : "straight", outside, inside, corners, worst);
    assert_true(outside + inside + corners > 9 * OUTLINES * PLACES / 10 && inside > OUTLINES * PLACES / 10);
    assert_true(corners < inside / 2);
    assert_true(worst <= 1e-7);
    finder_close(&f);
}

static void test_straight_faces_closest_place_is_that_of_a_search(void **state) {
    (void)state;
    closest(false);
}
static void test_quadratic_faces_closest_place_is_that_of_a_search(void **state) {
    (void)state;
    closest(true);
}

/* Straight faces, by formula and by iteration: every number the same. */
static void test_iteration_on_straight_faces_gives_the_same_bits(void **state) {
    (void)state;
    finder closed, newton;
    finder_open(&closed, "projection", 0);
    finder_open(&newton, "projection", 1);
    size_t total = 0;
    for (int o = 0; o < 50; o++) {
        surface_body *b = random_outline(false);
        double place[POINTS_MOST][2];
        for (int i = 0; i < POINTS_MOST; i++) {
            const uint32_t v = (uint32_t)random_between(0, 16),
                           w = (v + 1) % 16; /* half of them where it is close: on vertices, on edges */
            const double share = i % 8 == 1 ? 1e-15 : i % 8 == 3 ? 1 - 1e-15 : random_between(0, 1);
            for (int c = 0; c < 2; c++) {
                const double *x = b->x + (size_t)c * b->vertices;
                place[i][c] = i % 2 ? x[v] + share * (x[w] - x[v]) : random_between(-1.7, 1.7);
                if (i % 4 == 3) place[i][c] = nextafter(place[i][c], random_between(-1, 1) > 0 ? 9 : -9);
            }
        }
        surface_body *a = cloud((const double(*)[2])place, POINTS_MOST, 0.02);
        const size_t count = look(&closed, a, b, 10);
        assert_int_equal(look(&newton, a, b, 10), count);
        const ab_points *p = &closed.points.view, *q = &newton.points.view;
        for (size_t i = 0; i < count; i++) {
            assert_true(p->key[i] == q->key[i] && p->gap[i] == q->gap[i] && p->normal[i] == q->normal[i]);
            assert_true(p->normal[p->ld + i] == q->normal[q->ld + i] && p->position[i] == q->position[i] && p->area[i] == q->area[i]);
            assert_true(p->b_start[i + 1] == q->b_start[i + 1]);
        }
        for (size_t s = 0; s < p->b_start[count]; s++) assert_true(p->b_dof[s] == q->b_dof[s] && p->b_weight[s] == q->b_weight[s]);
        total += count;
        surface_body_destroy(a), surface_body_destroy(b);
    }
    assert_true(total > 2000);
    finder_close(&closed), finder_close(&newton);
}

/* ---- normals and corners -------------------------------------------------------------------------------------------------------- */

static void test_normal_points_out_of_a_whatever_the_pass_and_the_depth(void **state) {
    (void)state;
    finder f;
    finder_open(&f, NULL, 0);
    for (int depth = -1; depth <= 1; depth++) {
        const double place[1][2] = {{0.3, 1 - 0.01 * depth}};
        surface_body *above = cloud(place, 1, 0), *below = box("below", 0, 0, 1, 1);
        assert_int_equal(look(&f, above, below, 0.1), 1);
        near(ny(&f, 0), -1, 0);
        near(gap(&f, 0), -0.01 * depth, 1e-15);
        near(f.points.view.position[f.points.view.ld], 1, 1e-15);
        assert_int_equal(look(&f, below, above, 0.1), 1); /* the second pass alone: the cloud has no faces */
        near(ny(&f, 0), 1, 0);
        near(gap(&f, 0), -0.01 * depth, 1e-15);
        surface_body_destroy(above), surface_body_destroy(below);
    }
    finder_close(&f);
}

static void test_convex_vertex(void **state) {
    (void)state;
    finder f;
    finder_open(&f, NULL, 0);
    surface_body *b = box("box", 0, 0, 1, 1);
    const double place[4][2] = {{1.03, 1.04}, {1, 1}, {1 + 1e-15, 1 + 1e-15}, {1.001, 0.7}};
    surface_body *a = cloud(place, 4, 0);
    assert_int_equal(look(&f, a, b, 0.1), 4);
    near(gap(&f, 0), 0.05, 1e-15);
    near(nx(&f, 0), -0.6, 1e-13);
    near(ny(&f, 0), -0.8, 1e-13);
    for (size_t i = 1; i < 3; i++) { /* at the vertex to rounding: the average of both faces */
        near(gap(&f, i), 0, 1e-14);
        near(nx(&f, i), -sqrt(0.5), 1e-15);
        near(ny(&f, i), -sqrt(0.5), 1e-15);
    }
    near(nx(&f, 3), -1, 0);
    surface_body_destroy(a);
    /* from outside round the corner and, with half a size of 0.1, always 0.1 nearer: gap and normal turn without a jump */
    for (int k = 0; k <= 1000; k++) {
        const double angle = 1.5707963267948966 * k / 1000, at[1][2] = {{1 + 0.2 * cos(angle), 1 + 0.2 * sin(angle)}};
        a = cloud(at, 1, 0.1);
        assert_int_equal(look(&f, a, b, 0.2), 1);
        near(gap(&f, 0), 0.1, 1e-12);
        near(nx(&f, 0), -cos(angle), 1e-8);
        surface_body_destroy(a);
    }
    surface_body_destroy(b);
    finder_close(&f);
}

/* An L with its inner corner at (1, 1): outside above (1.., 1) and right of (1, 1..). */
static surface_body *ell(void) {
    const double corner[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    return surface_polygon("ell", corner, 6, false, 1);
}

static void test_concave_corner_touches_twice(void **state) {
    (void)state;
    finder f;
    finder_open(&f, NULL, 0);
    surface_body *b = ell();
    for (double ex = -1e-3; ex <= 1e-3; ex += 1e-3)
        for (double ey = -1e-3; ey <= 1e-3; ey += 1e-3)
            for (double size = 1; size >= 1e-14; size *= 1e-3) {
                const double place[1][2] = {{1 + ex * size, 1 + ey * size}};
                surface_body *a = cloud(place, 1, 0);
                assert_int_equal(look(&f, a, b, 0.1), 2);
                const size_t x = fabs(nx(&f, 0)) > 0.5 ? 0 : 1, y = 1 - x;
                near(nx(&f, x), -1, 1e-15);
                near(ny(&f, y), -1, 1e-15);
                near(gap(&f, x), place[0][0] - 1, 1e-15);
                near(gap(&f, y), place[0][1] - 1, 1e-15);
                surface_body_destroy(a);
            }
    surface_body_destroy(b);
    finder_close(&f);
}

/* A history belongs to a place: a point that slides into a corner keeps the key of the face it came along, whichever is nearer then. */
static void test_keys_stay_with_the_face(void **state) {
    (void)state;
    finder f;
    finder_open(&f, NULL, 0);
    surface_body *b = ell();
    uint64_t floor_key = 0, wall_key = 0;
    for (int k = 0; k <= 40; k++) {
        const double place[1][2] = {{1.2 - 0.01 * k * (k < 20) - 0.2 * (k >= 20), 1.0001 + 0.01 * (k > 20 ? k - 20 : 0)}};
        surface_body *a = cloud(place, 1, 0);
        const size_t count = look(&f, a, b, 0.05);
        for (size_t i = 0; i < count; i++) {
            uint64_t *key = ny(&f, i) < -0.5 ? &floor_key : &wall_key;
            if (*key == 0) *key = f.points.view.key[i];
            assert_true(*key == f.points.view.key[i]);
        }
        surface_body_destroy(a);
    }
    assert_true(floor_key && wall_key && floor_key != wall_key);
    surface_body_destroy(b);
    finder_close(&f);
}

static void test_inside_finds_the_nearest_face_alone(void **state) {
    (void)state;
    finder f;
    finder_open(&f, NULL, 0);
    surface_body *b = box("box", 0, 0, 1, 1);
    const double place[3][2] = {{0.98, 0.95}, {0.95, 0.98}, {0.02, 0.5}};
    surface_body *a = cloud(place, 3, 0);
    assert_int_equal(look(&f, a, b, 0.1), 3);
    const double expected[3][3] = {{-1, 0, -0.02}, {0, -1, -0.02}, {1, 0, -0.02}};
    for (size_t i = 0; i < 3; i++) {
        near(nx(&f, i), expected[i][0], 1e-15);
        near(ny(&f, i), expected[i][1], 1e-15);
        near(gap(&f, i), expected[i][2], 1e-15);
    }
    surface_body_destroy(a), surface_body_destroy(b);
    finder_close(&f);
}

/* A node of a block that was pressed more than half through a thin plate still belongs to the side it came from. */
static void test_thin_body_keeps_the_side(void **state) {
    (void)state;
    finder f;
    finder_open(&f, "passes", 1);
    surface_body *plate = box("plate", -1, 0, 2, 0.01);
    const double corner[8][2] = {{0, 0.003}, {0.25, 0.003}, {0.5, 0.003}, {0.75, 0.003}, {1, 0.003}, {1, 1}, {0.5, 1}, {0, 1}};
    surface_body *block = surface_polygon("block", corner, 8, false, 0);
    assert_int_equal(look(&f, block, plate, 0.1), 5);
    for (size_t i = 0; i < 5; i++) {
        near(ny(&f, i), -1, 1e-15);
        near(gap(&f, i), -0.007, 1e-15);
    }
    /* and a thin block on a thin plate does not see the plate's far side */
    surface_body *sheet = box("sheet", 0, 0.01, 1, 0.02);
    assert_int_equal(look(&f, sheet, plate, 0.1), 2);
    for (size_t i = 0; i < 2; i++) near(gap(&f, i), 0, 1e-15);
    surface_body_destroy(plate), surface_body_destroy(block), surface_body_destroy(sheet);
    finder_close(&f);
}

/* Equal blocks on each other meet face to face, with corner on corner to rounding and a little beside it. */
static void test_equal_corners_meet_face_to_face(void **state) {
    (void)state;
    static const double off[] = {0, 1e-15, -1e-15, 1e-12, -1e-12};
    finder f;
    finder_open(&f, NULL, 0);
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 5; j++) {
            surface_body *lower = box("lower", 0, 0, 1, 1), *upper = box("upper", off[i], 1 + off[j], 1 + off[i], 2);
            assert_int_equal(look(&f, upper, lower, 0.1), 4);
            for (size_t k = 0; k < 4; k++) {
                near(nx(&f, k), 0, 1e-11);
                near(ny(&f, k), -1, 1e-11);
                near(gap(&f, k), off[j], 1e-15);
            }
            surface_body_destroy(lower), surface_body_destroy(upper);
        }
    finder_close(&f);
}

/* A round body of parabolas above a face, turned by any angle: the gap is that of its lowest place, not of its lowest node. */
static void test_round_body_touches_between_its_nodes(void **state) {
    (void)state;
    enum { NODES = 32, ANGLES = 200, SAMPLES = 4000 };
    finder f;
    finder_open(&f, NULL, 0);
    surface_body *plane = box("plane", -5, -1, 5, 0);
    double worst = 0, nodes = 0;
    for (int k = 0; k < ANGLES; k++) {
        double corner[NODES][2], lowest = INFINITY, node = INFINITY;
        for (int n = 0; n < NODES; n++) {
            const double angle = 2 * 3.141592653589793 * (n / (double)NODES + k / (double)ANGLES);
            corner[n][0] = cos(angle);
            corner[n][1] = 1.001 + sin(angle);
            node = fmin(node, corner[n][1]);
        }
        surface_body *wheel = surface_polygon("wheel", (const double(*)[2])corner, NODES, true, 0);
        for (size_t face = 0; face < wheel->faces; face++)
            for (int sample = 0; sample <= SAMPLES; sample++) {
                double r[2];
                place_on(wheel, face, -1 + 2.0 * sample / SAMPLES, r);
                lowest = fmin(lowest, r[1]);
            }
        const size_t count = look(&f, wheel, plane, 0.05);
        double least = INFINITY;
        for (size_t i = 0; i < count; i++) {
            least = fmin(least, gap(&f, i));
            near(ny(&f, i), -1, 1e-15);
        }
        worst = fmax(worst, fabs(least - lowest));
        nodes = fmax(nodes, node - lowest);
        surface_body_destroy(wheel);
    }
    print_message("lowest place off by %.1e, lowest node by %.1e\n", worst, nodes);
    assert_true(worst <= 1e-7 && nodes > 1e-3); /* of the samples: (1/4000)^2 */
    surface_body_destroy(plane);
    finder_close(&f);
}

/* ---- what is wrong ------------------------------------------------------------------------------------------------------------------ */

static void test_faces_without_length_are_passed_over_and_counted(void **state) {
    (void)state;
    finder f;
    finder_open(&f, NULL, 0);
    const double corner[7][2] = {{0, 0}, {1, 0}, {1, 1}, {1, 1}, {0.5, 1}, {0.5, 1}, {0, 1}};
    surface_body *b = surface_polygon("box", corner, 7, false, 1);
    const double place[4][2] = {{1.03, 1.04}, {0.5, 1.01}, {0.2, 1.01}, {0.5, 0.99}};
    surface_body *a = cloud(place, 4, 0);
    assert_int_equal(look(&f, a, b, 0.1), 4);
    assert_int_equal(f.points.view.failures, 8);
    near(gap(&f, 0), 0.05, 1e-15); /* the vertex knows the faces on either side of the one without length */
    near(gap(&f, 1), 0.01, 1e-15);
    near(gap(&f, 2), 0.01, 1e-15);
    near(gap(&f, 3), -0.01, 1e-15);
    surface_body_destroy(a), surface_body_destroy(b);
    finder_close(&f);
}

static void test_never_a_number_that_is_none(void **state) {
    (void)state;
    static const double odd[] = {0, -0.0, 1e-320, 1e-160, 1e160, 1e300, -1e300, INFINITY, NAN, 1, 0.5};
    enum { ODD = sizeof odd / sizeof *odd };
    finder f;
    finder_open(&f, NULL, 0);
    for (int k = 0; k < 20000; k++) {
        double corner[8][2];
        for (int v = 0; v < 8; v++)
            for (int c = 0; c < 2; c++)
                corner[v][c] =
                    random_between(0, 1) < 0.7 ? (v % 4 == 1 || v % 4 == 2 ? 1 : 0) * (c == 0 || v % 4) : odd[(int)random_between(0, ODD)];
        surface_body *b = surface_polygon("odd", (const double(*)[2])corner, 8, k % 2, 1);
        double place[8][2];
        for (int v = 0; v < 8; v++)
            for (int c = 0; c < 2; c++) place[v][c] = odd[(int)random_between(0, ODD)];
        surface_body *a = cloud((const double(*)[2])place, 8, 0.1);
        memset(b->area, 0, b->vertices * sizeof *b->area);
        look(&f, a, b, 10); /* looks at every number */
        surface_body_destroy(a), surface_body_destroy(b);
    }
    finder_close(&f);
}

static void test_a_pass_without_faces_is_refused(void **state) {
    (void)state;
    finder f;
    finder_open(&f, "passes", 1);
    const double place[1][2] = {{0, 0}};
    surface_body *a = box("box", 0, 0, 1, 1), *b = cloud(place, 1, 0);
    const size_t start[5] = {0};
    const uint32_t none[1] = {0};
    ab_surface sa = {.struct_size = sizeof sa, .dimension = 2}, sb = sa;
    surface_body_faces(&a->domain, &sa, NULL);
    sa.near_start = sb.near_start = start;
    sa.near_face = sb.near_face = none;
    const ab_trace ta = {.body = "box", .surface = &sa}, tb = {.body = "sand", .surface = &sb};
    assert_true(f.class_->contact.find(f.self, &ta, &tb, &f.points.view) < 0);
    assert_string_equal(f.service.message, "passes: first wants faces of 'sand', which has none; write passes: second");
    surface_body_destroy(a), surface_body_destroy(b);
    finder_close(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_straight_faces_closest_place_is_that_of_a_search),
        cmocka_unit_test(test_quadratic_faces_closest_place_is_that_of_a_search),
        cmocka_unit_test(test_iteration_on_straight_faces_gives_the_same_bits),
        cmocka_unit_test(test_normal_points_out_of_a_whatever_the_pass_and_the_depth),
        cmocka_unit_test(test_convex_vertex),
        cmocka_unit_test(test_concave_corner_touches_twice),
        cmocka_unit_test(test_keys_stay_with_the_face),
        cmocka_unit_test(test_inside_finds_the_nearest_face_alone),
        cmocka_unit_test(test_thin_body_keeps_the_side),
        cmocka_unit_test(test_equal_corners_meet_face_to_face),
        cmocka_unit_test(test_round_body_touches_between_its_nodes),
        cmocka_unit_test(test_faces_without_length_are_passed_over_and_counted),
        cmocka_unit_test(test_never_a_number_that_is_none),
        cmocka_unit_test(test_a_pass_without_faces_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
