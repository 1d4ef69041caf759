/* test_contact_surfaces.c: the host's half of contact between surfaces: near faces, and the loop on bodies of nodes and bodies that turn as a whole. */
#include "fake_surface.h"

#define near(x, y, tolerance) assert_true(fabs((x) - (y)) <= (tolerance))

static uint64_t seed = 42;
static double random_between(double low, double high) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(seed >> 11) * 0x1p-53;
}

static surface_body *box(const char *name, double x0, double y0, double x1, double y1, size_t index) {
    const double corner[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    return surface_polygon(name, corner, 4, false, index);
}

static surface_body *wheel(const char *name, size_t count, double cx, double cy, double radius, size_t index) {
    double(*corner)[2] = calloc(count, sizeof *corner);
    for (size_t k = 0; k < count; k++) {
        const double angle = 2 * 3.141592653589793 * (double)k / (double)count;
        corner[k][0] = cx + radius * cos(angle);
        corner[k][1] = cy + radius * sin(angle);
    }
    surface_body *b = surface_polygon(name, (const double(*)[2])corner, count, false, index);
    free(corner);
    return b;
}

/* ---- near faces ------------------------------------------------------------------------------------------------------------------ */

typedef struct broad_test {
    ab_report *report;
    ab_scene scene;
    ab_contact_spec spec;
    contact_pair pair;
    ab_surface a, b;
} broad_test;

static void broad_open(broad_test *t, surface_body *a, surface_body *b, double cell) {
    *t = (broad_test){.report = ab_report_create(), .scene = {.grid_cell = cell}};
    t->pair.spec = &t->spec;
    t->pair.a = &a->domain, t->pair.b = &b->domain;
    assert_int_equal(contact_broad_create(&t->scene, &t->pair, t->report), AB_OK);
}

static void broad_look(broad_test *t, double dt) { assert_int_equal(contact_surfaces(&t->pair, dt, &t->a, &t->b, t->report), AB_OK); }

static void broad_close(broad_test *t) {
    contact_broad_destroy(t->pair.broad);
    ab_report_destroy(t->report);
    surface_body_destroy((surface_body *)t->pair.a), surface_body_destroy((surface_body *)t->pair.b);
}

/* Distance of a place to a straight face. */
static double distance(const surface_body *b, size_t face, const double x[2]) {
    const size_t v = b->face[3 * face], w = b->face[3 * face + 1], ld = b->vertices;
    const double along[2] = {b->x[w] - b->x[v], b->x[ld + w] - b->x[ld + v]}, from[2] = {x[0] - b->x[v], x[1] - b->x[ld + v]};
    const double square = along[0] * along[0] + along[1] * along[1];
    const double t = square > 0 ? fmin(1, fmax(0, (from[0] * along[0] + from[1] * along[1]) / square)) : 0;
    return hypot(from[0] - t * along[0], from[1] - t * along[1]);
}

/* Every point of `points` that is nearer than `reach` to a face of b has it in its list, in ascending order and once; no list holds one further than twice that.
 * Returns how many pairs there are. */
static size_t check_lists(const ab_surface *points, const surface_body *all, const surface_body *b, double reach) {
    size_t pairs = 0;
    for (size_t k = 0; k < all->vertices; k++) {
        const double x[2] = {all->x[k], all->x[all->vertices + k]};
        size_t at = SIZE_MAX;
        for (size_t i = 0; i < points->point_count; i++)
            if (points->point_key[i] == k + 1) at = i;
        for (size_t f = 0; f < b->faces; f++) {
            const double d = distance(b, f, x);
            size_t times = 0;
            for (size_t e = at == SIZE_MAX ? 0 : points->near_start[at]; at != SIZE_MAX && e < points->near_start[at + 1]; e++) {
                times += points->near_face[e] == f;
                assert_true(e == points->near_start[at] || points->near_face[e] > points->near_face[e - 1]);
            }
            if (d <= reach) assert_int_equal(times, 1), pairs++;
            if (d > 2 * reach) assert_int_equal(times, 0);
        }
    }
    return pairs;
}

/* Without a grid and with cells of any size; the faces drift, turn and shrink meanwhile. */
static void test_lists_hold_the_faces_near_a_point(void **state) {
    (void)state;
    static const double cells[] = {0, 0.02, 0.3, 5};
    for (int c = 0; c < 4; c++)
        for (int shape = 0; shape < 3; shape++) {
            enum { CLOUD = 300 };
            surface_body *a = surface_body_create("cloud", CLOUD, 0, 0);
            for (size_t k = 0; k < CLOUD; k++) surface_body_put(a, k, random_between(-2, 2), random_between(-2, 2));
            surface_body *b = shape == 0   ? wheel("wheel", 40, 0.1, 0.2, 1, 1)
                              : shape == 1 ? box("box", -1, -0.7, 0.8, 1.1, 1)
                                           : wheel("triangle", 3, 0, 0, 1.5, 1);
            broad_test t;
            broad_open(&t, a, b, cells[c]);
            size_t pairs = 0;
            for (int step = 0; step < 40; step++) {
                broad_look(&t, 1e-3);
                const double cell = contact_broad_cell(t.pair.broad);
                double length = 0;
                for (size_t f = 0; f < b->faces; f++)
                    length += hypot(b->x[b->face[3 * f + 1]] - b->x[b->face[3 * f]],
                                    b->x[b->vertices + b->face[3 * f + 1]] - b->x[b->vertices + b->face[3 * f]]);
                if (step == 0) near(cell, cells[c] > 0 ? cells[c] : length / (double)b->faces, 1e-12);
                const double reach = 0.45 * fmin(cell, length / (double)b->faces * 0.99);
                pairs += check_lists(&t.a, a, b, reach);
                for (size_t k = 0; k < b->vertices; k++) {
                    const double x = b->x[k], y = b->x[b->vertices + k];
                    surface_body_put(b, k, 0.999 * (x * cos(0.01) - y * sin(0.01)) + 0.013,
                                     0.999 * (x * sin(0.01) + y * cos(0.01)) - 0.004);
                }
            }
            if (cells[c] == 0 || cells[c] > 0.1) assert_true(pairs > 40);
            broad_close(&t);
        }
}

/* A body of 1e2 to 1e5 faces beside as many points: pairs looked at, in all and a point, and how often regions are made while the body creeps. */
static void test_cost_is_in_proportion_to_faces_and_points(void **state) {
    (void)state;
    double per_point = 0;
    for (size_t n = 100; n <= 100000; n *= 10) {
        surface_body *a = surface_body_create("cloud", n, 0, 0), *b = wheel("wheel", n, 0, 0, 1, 1);
        for (size_t k = 0; k < n; k++) {
            const double angle = random_between(0, 6.283), radius = 1 + 6.283 / (double)n * random_between(-0.2, 0.5);
            surface_body_put(a, k, radius * cos(angle), radius * sin(angle));
        }
        broad_test t;
        broad_open(&t, a, b, 0);
        broad_look(&t, 0);
        const double visits = (double)contact_broad_visits(t.pair.broad) / (double)n;
        size_t near_ = t.a.near_start[t.a.point_count];
        assert_int_equal(t.a.point_count, n);
        const size_t builds = contact_broad_builds(t.pair.broad);
        for (int step = 0; step < 10; step++) {
            for (size_t k = 0; k < n; k++) b->x[k] += 0.01 * 6.283 / (double)n;
            broad_look(&t, 0);
        }
        assert_int_equal(contact_broad_builds(t.pair.broad), builds);
        print_message("%6zu faces and points: %.2f faces looked at a point, %.2f near, regions made %zu times\n", n, visits,
                      (double)near_ / (double)n, builds);
        if (per_point == 0) per_point = visits;
        assert_true(visits < 1.2 * per_point && visits > 0.8 * per_point && visits < 8);
        broad_close(&t);
    }
    /* one long oblique face marks a strip, not its box: points all over the box, of which few are asked for */
    enum { CLOUD = 10000 };
    surface_body *a = surface_body_create("cloud", CLOUD, 0, 0);
    for (size_t k = 0; k < CLOUD; k++) surface_body_put(a, k, random_between(0, 100), random_between(0, 100));
    const double corner[3][2] = {{0, 0}, {100, 99}, {0, 300}};
    surface_body *b = surface_polygon("slope", corner, 3, false, 1);
    broad_test t;
    broad_open(&t, a, b, 0.5);
    broad_look(&t, 0);
    print_message("slope of 140 m in cells of 0.5 m: %zu of %d points asked for, %zu looked at\n", t.a.point_count, CLOUD,
                  contact_broad_visits(t.pair.broad));
    assert_true(t.a.point_count < 700 && contact_broad_visits(t.pair.broad) < 500);
    broad_close(&t);
}

/* What a fast body may meet within a step is in the list, and the speed that says so. */
static void test_reach_grows_with_speed(void **state) {
    (void)state;
    for (int fast = 0; fast < 2; fast++) {
        surface_body *a = surface_body_create("point", 1, 0, 0), *b = box("box", 0, 0, 1, 1, 1);
        surface_body_put(a, 0, 0.5, 1 + 1.3);
        for (size_t k = 0; k < 4; k++) b->velocity[2 * k] = 7;
        a->velocity[0] = 7, a->velocity[1] = fast ? -10 : -0.1;
        broad_test t;
        broad_open(&t, a, b, 0);
        broad_look(&t, 0.1);
        if (fast) near(contact_broad_speed(t.pair.broad), 10, 1e-12);
        assert_int_equal(t.a.point_count && t.a.near_start[1] > 0, fast);
        broad_close(&t);
    }
}

/* Speeds of a run that has blown up cost no more than those of one that has not. */
static void test_no_speed_makes_regions_without_end(void **state) {
    (void)state;
    surface_body *a = wheel("rim", 1000, 0, 2.1, 1, 0), *b = wheel("wheel", 1000, 0, 0, 1, 1);
    for (size_t k = 0; k < 2000; k++) a->velocity[k] = k % 3 ? 1e300 : -1e19;
    broad_test t;
    broad_open(&t, a, b, 0);
    broad_look(&t, 1);
    broad_look(&t, 1);
    assert_true(contact_broad_visits(t.pair.broad) <= 2000 * 1000);
    broad_close(&t);
}

/* ---- the loop ---------------------------------------------------------------------------------------------------------------------- */

typedef struct balance {
    double momentum[2], angular, kinetic;
} balance;

static balance of(const surface_body *b) {
    balance s = {{0, 0}, 0, 0};
    for (size_t k = 0; k < (b->rigid ? 1 : b->vertices); k++) {
        const double m = 1 / b->inverse_mass[2 * k], *v = b->velocity + 2 * k;
        const double x = b->rigid ? b->centre[0] : b->x[k], y = b->rigid ? b->centre[1] : b->x[b->vertices + k];
        for (int c = 0; c < 2; c++) s.momentum[c] += m * v[c];
        s.angular += m * (x * v[1] - y * v[0]);
        s.kinetic += 0.5 * m * (v[0] * v[0] + v[1] * v[1]);
    }
    if (b->rigid) s.angular += b->spin / b->inverse_inertia, s.kinetic += 0.5 * b->spin * b->spin / b->inverse_inertia;
    return s;
}

static balance both(const surface_scene *s) {
    const balance a = of(s->bodies[0]), b = of(s->bodies[1]);
    return (balance){{a.momentum[0] + b.momentum[0], a.momentum[1] + b.momentum[1]}, a.angular + b.angular, a.kinetic + b.kinetic};
}

/* Momentum to 1e-12 whatever the response, angular momentum where the impulse goes through the point and its place on the face alike: without friction, and
 * with it when there is no gap between them; between rigid bodies always, as both are pushed at one place. */
static void conserve(surface_body *a, surface_body *b, const char *response, bool angular) {
    surface_scene s;
    surface_scene_create(&s, a, b, response, "friction", 0.6);
    for (int k = 0; k < 2; k++) {
        surface_body *body = s.bodies[k];
        for (size_t d = 0; d < 2 * (body->rigid ? 1 : body->vertices); d++)
            body->old[d] = body->velocity[d] = random_between(-1, 1) + (d % 2 ? (k ? 3 : -3) : 0);
        if (body->rigid) body->spin = body->spin_old = random_between(-3, 3);
    }
    const balance before = both(&s);
    surface_scene_solve(&s);
    const balance after = both(&s);
    const ab_contact_totals *t = s.interaction->totals(s.interaction);
    assert_true(t->active >= 1 && hypot(t->impulse[0], t->impulse[1]) > 0.1);
    for (int c = 0; c < 2; c++) near(after.momentum[c], before.momentum[c], 1e-12);
    if (angular) near(after.angular, before.angular, 1e-12);
    near(before.kinetic - after.kinetic, t->friction_work + t->contact_work, 1e-12 * before.kinetic);
    if (strcmp(response, "tied") != 0)
        assert_true(t->friction_work >= -1e-3 * before.kinetic); /* the rounds may end where they get no further */
    surface_scene_destroy(&s);
}

static surface_body *lower_nodes(void) {
    const double corner[7][2] = {{0, 0}, {3, 0}, {3, 1}, {2.2, 1}, {1.3, 1}, {0.6, 1}, {0, 1}};
    return surface_polygon("lower", corner, 7, false, 1);
}

static surface_body *upper_nodes(double gap) {
    const double corner[8][2] = {{0.4, 1 + gap}, {0.9, 1 + gap}, {1.4, 1 + gap}, {1.9, 1 + gap},
                                 {2.4, 1 + gap}, {2.4, 2},       {1.4, 2},       {0.4, 2}};
    return surface_polygon("upper", corner, 8, false, 0);
}

static void test_momentum_is_kept(void **state) {
    (void)state;
    for (int k = 0; k < 20; k++) {
        conserve(upper_nodes(0), lower_nodes(), "coulomb", true);
        conserve(upper_nodes(1e-3), lower_nodes(), "frictionless", true);
        conserve(upper_nodes(-1e-3), lower_nodes(), "coulomb", false);
        conserve(upper_nodes(0), lower_nodes(), "tied", true);
        surface_body *a = upper_nodes(0), *b = lower_nodes();
        surface_body_stiffen(a, 2, 0.7, 1.4, 1.5);
        conserve(a, b, "coulomb", true);
        a = upper_nodes(0), b = lower_nodes();
        surface_body_stiffen(b, 5, 3, 1.5, 0.5);
        conserve(a, b, "coulomb", true);
        a = upper_nodes(-1e-3), b = lower_nodes();
        surface_body_stiffen(a, 2, 0.7, 1.4, 1.5);
        surface_body_stiffen(b, 5, 3, 1.5, 0.5);
        conserve(a, b, "coulomb", true);
    }
}

/* A falling rod hits a fixed corner with its end: the impulse is m v/(1 + m r^2/I), and the end stands still after it. */
static void test_rod_is_turned_by_a_blow_at_its_end(void **state) {
    (void)state;
    surface_body *rod = box("rod", 0, 1, 4, 1.2, 0), *anvil = box("anvil", -1, 0, 0.25, 1, 1);
    surface_body_stiffen(rod, 3, 4, 2, 1.1);
    for (size_t k = 0; k < 8; k++) anvil->inverse_mass[k] = 0;
    rod->velocity[1] = rod->old[1] = -2;
    surface_scene s;
    surface_scene_create(&s, rod, anvil, "frictionless", "passes", 2);
    surface_scene_solve(&s);
    const double r = 2 - 0.25, impulse = 3 * 2 / (1 + 3 * r * r / 4);
    near(rod->velocity[1], -2 + impulse / 3, 1e-12);
    near(rod->spin, -impulse * r / 4, 1e-12);
    near(rod->velocity[1] - rod->spin * r, 0, 1e-12);
    near(s.interaction->totals(s.interaction)->impulse[1], -impulse, 1e-12);
    surface_scene_destroy(&s);
}

/* On a pivot normal and tangential answers work on one freedom: the loop ends, and the place that is pushed stands still. */
static void test_pivot_does_not_swing_for_ever(void **state) {
    (void)state;
    for (int arm = 0; arm < 3; arm++)
        for (int friction = 0; friction < 2; friction++) {
            surface_body *lever = box("lever", 0, 1, 4, 1.2, 0), *nail = box("nail", 3.9, 0, 6, 1, 1);
            surface_body_stiffen(lever, 3, 4, 0.5, 1 + arm);
            lever->inverse_mass[0] = lever->inverse_mass[1] = 0;
            for (size_t k = 0; k < 8; k++) nail->inverse_mass[k] = 0;
            lever->spin = lever->spin_old = -1;
            surface_scene s;
            surface_scene_create(&s, lever, nail, friction ? "coulomb" : "frictionless", "friction", 0.3);
            surface_scene_solve(&s);
            near(lever->spin, 0, 1e-12);
            const ab_contact_totals *t = s.interaction->totals(s.interaction);
            near(t->contact_work + t->friction_work, 0.5 * 4, 1e-10);
            surface_scene_destroy(&s);
        }
}

/* A node that a side guides along a slope: it may only move up, and a wedge that is pushed under it by a given speed lifts it by speed x slope. */
static void test_given_wedge_lifts_a_guided_node(void **state) {
    (void)state;
    const double tan_slope = 0.5, corner[3][2] = {{-2, -1}, {2, -1}, {-2, 1}}; /* falls to the right */
    surface_body *wedge = surface_polygon("wedge", corner, 3, false, 0), *node = surface_body_create("node", 1, 0, 1);
    surface_body_put(node, 0, 0, 0);
    node->inverse_mass[0] = 0;
    for (size_t k = 0; k < 3; k++) {
        wedge->inverse_mass[2 * k] = wedge->inverse_mass[2 * k + 1] = 0;
        wedge->velocity[2 * k] = wedge->old[2 * k] = 2;
    }
    surface_scene s;
    surface_scene_create(&s, wedge, node, "frictionless", NULL, 0);
    surface_scene_solve(&s);
    near(node->velocity[1], 2 * tan_slope, 1e-12);
    surface_scene_destroy(&s);
}

static void test_springs_limit_the_step(void **state) {
    (void)state;
    surface_body *a = upper_nodes(-0.01), *b = lower_nodes();
    a->modulus = 100, b->modulus = 400;
    for (size_t k = 0; k < 2 * b->vertices; k++) b->inverse_mass[k] = 0;
    surface_scene s;
    surface_scene_create(&s, a, b, "penalty", "stiffness_of", 1);
    const char *limit = NULL;
    assert_true(s.interaction->critical_dt(s.interaction, &limit) == INFINITY);
    surface_scene_solve(&s);
    const double cell = (3 + 1 + 0.8 + 0.9 + 0.7 + 0.6 + 1) / 7; /* the mean face of the finer body, or that of the other */
    double mean = 0;
    for (size_t f = 0; f < a->faces; f++)
        mean += hypot(a->x[a->face[3 * f + 1]] - a->x[a->face[3 * f]], a->x[8 + a->face[3 * f + 1]] - a->x[8 + a->face[3 * f]]) / 8;
    const double h = fmin(mean, cell),
                 stiffness = 0.5 * 100 / h * 0.5; /* default multiple, softer modulus; a whole node's area, shared by both passes */
    const double dt = s.interaction->critical_dt(s.interaction, &limit);
    print_message("%s: %.4g s\n", limit, dt);
    assert_true(dt < INFINITY && dt >= 2 * sqrt(1 / (2 * stiffness)) * 0.5 && dt <= 2 * sqrt(1 / (0.5 * stiffness)) * 1.5);
    assert_non_null(strstr(limit, "upper"));
    assert_non_null(strstr(limit, "lower"));
    surface_scene_destroy(&s);
}

/* Bodies side by side overlap by the warning's measure or not; a rigid one has no density to ask for. */
static void test_overlap_is_told_once(void **state) {
    (void)state;
    for (int overlap = 0; overlap < 2; overlap++) {
        surface_body *a = upper_nodes(overlap ? -0.05 : 0), *b = lower_nodes();
        surface_body_stiffen(b, 1, 1, 0, 0);
        surface_scene s;
        surface_scene_create(&s, a, b, "frictionless", NULL, 0);
        surface_scene_solve(&s);
        surface_scene_solve(&s);
        assert_int_equal(ab_report_warnings(s.plugins.report), overlap);
        surface_scene_destroy(&s);
    }
}

/* How many of the warnings so far hold these words. */
static size_t told(const surface_scene *s, const char *words) {
    size_t times = 0;
    for (size_t k = 0; ab_report_text(s->plugins.report, k); k++) times += strstr(ab_report_text(s->plugins.report, k), words) != NULL;
    return times;
}

/* A wheel of some hundred vertices drawn into a box, a thin and a round body, and into the hole of a ring: how many vertices lie inside and how deep, against a count
 * by hand. */
static void test_points_drawn_deep_inside_are_told_by_number_and_depth(void **state) {
    (void)state;
    for (int round = 0; round < 60; round++) {
        const size_t n = 3 + (size_t)random_between(0, 200);
        const double x = random_between(-1.5, 1.5), y = random_between(-1.5, 1.5), radius = random_between(0.05, 0.8);
        const bool hollow = round % 3 == 0;
        surface_body *a = wheel("wheel", n, x, y, radius, 0);
        surface_body *b = round % 3 == 1 ? box("other", -1, -0.7, 0.8, 1.1, 1) : wheel("other", 77, 0, 0, 1.2, 1);
        if (hollow) { /* the second half of the vertices runs round a hole */
            surface_body_destroy(b);
            b = surface_body_create("other", 80, 80, 1);
            for (size_t k = 0; k < 80; k++) {
                const double angle = 2 * 3.141592653589793 / 40 * (double)(k < 40 ? k : 80 - k), r = k < 40 ? 1.2 : 0.7;
                surface_body_put(b, k, r * cos(angle), r * sin(angle));
                b->face[3 * k] = (uint32_t)k, b->face[3 * k + 1] = (uint32_t)(k % 40 == 39 ? k - 39 : k + 1);
                b->face[3 * k + 2] = UINT32_MAX;
                b->beside[2 * k] = (uint32_t)(k % 40 == 0 ? k + 39 : k - 1), b->beside[2 * k + 1] = b->face[3 * k + 1];
            }
        }
        surface_scene s;
        surface_scene_create(&s, a, b, "frictionless", NULL, 0);
        size_t count[2] = {0}, close = 0;
        double deepest[2] = {0}, cell = INFINITY;
        for (int k = 0; k < 2; k++) {
            const surface_body *body = k ? b : a;
            double sum = 0;
            for (size_t f = 0; f < body->faces; f++)
                sum += hypot(body->x[body->face[3 * f + 1]] - body->x[body->face[3 * f]],
                             body->x[body->vertices + body->face[3 * f + 1]] - body->x[body->vertices + body->face[3 * f]]);
            cell = fmin(cell, sum / (double)body->faces);
        }
        for (int k = 0; k < 2; k++) {
            const surface_body *body = k ? b : a, *other = k ? a : b;
            for (size_t v = 0; v < body->vertices; v++) {
                const double t[2] = {body->x[v], body->x[body->vertices + v]};
                double nearest = INFINITY, turn = 0;
                for (size_t f = 0; f < other->faces; f++) {
                    const size_t p = other->face[3 * f], q = other->face[3 * f + 1], ld = other->vertices;
                    nearest = fmin(nearest, distance(other, f, t));
                    const double u[2] = {other->x[p] - t[0], other->x[ld + p] - t[1]}, w[2] = {other->x[q] - t[0], other->x[ld + q] - t[1]};
                    turn += atan2(u[0] * w[1] - u[1] * w[0], u[0] * w[0] + u[1] * w[1]);
                }
                if (fabs(nearest - 0.01 * cell) < 1e-9) close++;
                if (fabs(turn) < 3 || nearest <= 0.01 * cell) continue;
                count[k]++;
                deepest[k] = fmax(deepest[k], nearest);
            }
        }
        surface_scene_solve(&s);
        for (int k = 0; k < 2 && !close; k++) {
            char words[128];
            snprintf(words, sizeof words, "%zu point%s of '%s' in '%s', up to %.3g m deep", count[k], count[k] == 1 ? "" : "s",
                     k ? "other" : "wheel", k ? "wheel" : "other", deepest[k]);
            assert_int_equal(told(&s, words), count[k] > 0);
        }
        surface_scene_solve(&s);
        assert_true(ab_report_warnings(s.plugins.report) <= 1);
        surface_scene_destroy(&s);
    }
}

/* 3 m by 4 m, in faces of 1 m. */
static surface_body *metres(void) {
    const double low[14][2] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {3, 3},
                               {3, 4}, {2, 4}, {1, 4}, {0, 4}, {0, 3}, {0, 2}, {0, 1}};
    return surface_polygon("lower", low, 14, false, 1);
}

/* Pressed into each other by a tenth of a face a step, to the depth of two: they are in touch all the way, and it is told once. */
static void test_bodies_pressed_deep_stay_in_touch(void **state) {
    (void)state;
    surface_body *a = box("upper", 1.2, 4.01, 1.8, 9, 0), *b = metres();
    surface_scene s;
    surface_scene_create(&s, a, b, "frictionless", NULL, 0);
    double depth = -0.01;
    surface_scene_solve(&s);
    for (int step = 0; step < 22; step++) {
        for (size_t k = 0; k < 4; k++) a->x[4 + k] -= 0.1;
        depth += 0.1;
        s.step.time += s.step.dt;
        surface_scene_solve(&s);
        near(s.interaction->totals(s.interaction)->penetration, fmin(depth, 1.8), 1e-12); /* deeper, a side is nearer */
    }
    assert_int_equal(told(&s, "more than a face is long"), 1);
    assert_int_equal(ab_report_warnings(s.plugins.report), 1);
    surface_scene_destroy(&s);
}

/* Drawn by more than a face into each other: contact does not see it at first, is told how deep, and has hold of them in the next step. */
static void test_bodies_drawn_deep_are_held(void **state) {
    (void)state;
    surface_body *a = box("upper", 1.2, 2.8, 1.8, 9, 0), *b = metres();
    for (size_t k = 0; k < 4; k++) a->velocity[2 * k + 1] = a->old[2 * k + 1] = -1;
    surface_scene s;
    surface_scene_create(&s, a, b, "frictionless", NULL, 0);
    surface_scene_solve(&s);
    s.step.time += s.step.dt;
    surface_scene_solve(&s);
    near(s.interaction->totals(s.interaction)->penetration, 1.2, 1e-12);
    for (size_t k = 0; k < 2; k++) assert_true(surface_body_velocity(a, k)[1] > -0.8); /* they do not fall on as they did */
    assert_int_equal(ab_report_warnings(s.plugins.report), 1);
    surface_scene_destroy(&s);
}

static void test_failures_are_counted(void **state) {
    (void)state;
    const double corner[6][2] = {{0, 0}, {3, 0}, {3, 1}, {1.6, 1}, {1.6, 1}, {0, 1}};
    surface_body *a = upper_nodes(0), *b = surface_polygon("lower", corner, 6, false, 1);
    surface_scene s;
    surface_scene_create(&s, a, b, "frictionless", NULL, 0);
    surface_scene_solve(&s);
    const size_t once = s.interaction->totals(s.interaction)->failures;
    assert_true(once > 0);
    surface_scene_solve(&s);
    assert_int_equal(s.interaction->totals(s.interaction)->failures, 2 * once);
    surface_scene_destroy(&s);
}

static void test_bodies_without_faces_are_refused(void **state) {
    (void)state;
    surface_body *a = surface_body_create("sand", 1, 0, 0), *b = surface_body_create("clay", 1, 0, 1);
    surface_scene s = {.plugins = contact_plugins_open(), .bodies = {a, b}, .domains = {&a->domain, &b->domain}};
    s.contact.body[1] = 1;
    s.contact.finder = contact_class(&s.plugins, "point-to-segment");
    s.contact.responder = contact_class(&s.plugins, "frictionless");
    s.contact.finder_settings = s.finder;
    default_settings(s.contact.finder, s.finder, NULL, 0);
    s.scene = (ab_scene){.dimension = 2, .bodies = s.body, .body_count = 2, .contacts = &s.contact, .contact_count = 1};
    assert_int_equal(contact_create(&s.scene, s.domains, &s.interaction, s.plugins.report), AB_BAD_INPUT);
    assert_non_null(strstr(ab_report_text(s.plugins.report, 0), "neither 'sand' (cloud) nor 'clay' (cloud) has any"));
    s.contact.finder = contact_class(&s.plugins, "multi-velocity"); /* these have no nodes either */
    assert_int_equal(contact_create(&s.scene, s.domains, &s.interaction, s.plugins.report), AB_BAD_INPUT);
    contact_plugins_close(&s.plugins);
    surface_body_destroy(a), surface_body_destroy(b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lists_hold_the_faces_near_a_point),
        cmocka_unit_test(test_cost_is_in_proportion_to_faces_and_points),
        cmocka_unit_test(test_reach_grows_with_speed),
        cmocka_unit_test(test_no_speed_makes_regions_without_end),
        cmocka_unit_test(test_momentum_is_kept),
        cmocka_unit_test(test_rod_is_turned_by_a_blow_at_its_end),
        cmocka_unit_test(test_pivot_does_not_swing_for_ever),
        cmocka_unit_test(test_given_wedge_lifts_a_guided_node),
        cmocka_unit_test(test_springs_limit_the_step),
        cmocka_unit_test(test_overlap_is_told_once),
        cmocka_unit_test(test_points_drawn_deep_inside_are_told_by_number_and_depth),
        cmocka_unit_test(test_bodies_pressed_deep_stay_in_touch),
        cmocka_unit_test(test_bodies_drawn_deep_are_held),
        cmocka_unit_test(test_failures_are_counted),
        cmocka_unit_test(test_bodies_without_faces_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
