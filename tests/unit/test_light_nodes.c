/* test_light_nodes.c: nodes that go by others because they hold next to no mass, on every basis that has such: momentum and angular momentum go to the nodes and back
 * to rounding, the internal force does the work that the strain takes, uniform motion and strain are left as they are, points that touch find their own place; ties
 * of a symmetric body are symmetric; and the scheme is stable. */
#include "one_body.h"

typedef struct basis {
    const char *name, *text;
    double edge;  /* of a body, beyond a node, where points begin to reach a next node: m and */
    double point; /* so many sizes of a point */
} basis;

/* Linear: its points pass a node. GIMP, CPDI: their domains do. Quadratic B-splines: their points pass the middle of a cell. */
static const basis BASIS[] = {{"linear", "linear", 0, 0.5},
                              {"gimp", "gimp", 0, 0},
                              {"gimp fixed", "{gimp: fixed}", 0, 0},
                              {"cpdi", "cpdi", 0, 0},
                              {"bspline2", "bspline2", 0.5, 0.5}};
enum { BASES = sizeof BASIS / sizeof *BASIS };

/* A block of five by five cells, its upper edges `eps` beyond where a next node begins to be seen. */
static const char *scene(const basis *b, double eps, int per_cell, double cfl, const char *update, const char *transfer) {
    static char text[2000];
    const double low = 2 + b->edge + b->point / sqrt(per_cell) + eps;
    snprintf(text, sizeof text,
             "abut: 1\nspace: plane-strain\ntime: {end: 1e4, dt: %.17g}\ngrid: {from: [-1, -1], to: [12, 12], cell: 1}\n"
             "materials: {m: {model: linear-elastic, E: 1, nu: 0, density: 1}}\n"
             "bodies: {b: {method: material-points, material: m, shape: {box: [[%.17g, %.17g], [%.17g, %.17g]]}, basis: %s, fill: {rule: "
             "regular, per_cell: %d}, update: %s, transfer: %s}}\n",
             cfl, low, low, low + 5, low + 5, b->text, per_cell, update, transfer);
    return text;
}

static const double EPS[] = {1e-1, 1e-2, 1e-4, 1e-8, 1e-12};
enum { OFFSETS = sizeof EPS / sizeof *EPS };

static void shuffle(mpm_body *body, double stress) {
    for (size_t slot = 0; slot < body->block_count * 8; slot++) {
        if (!is_point(body, slot)) continue;
        for (int c = 0; c < 2; c++) *point_row(body, slot, ROW_V + c) = random_between(-1, 1);
        for (int c = 0; c < 4; c++) *point_row(body, slot, ROW_STRESS + c) = random_between(-stress, stress);
    }
}

typedef struct totals {
    double momentum[2], angular;
} totals;

static totals of_points(const mpm_body *body) {
    totals sum = {0};
    for (size_t slot = 0; slot < body->block_count * 8; slot++) {
        if (!is_point(body, slot)) continue;
        const double m = *point_row(body, slot, ROW_MASS), vx = *point_row(body, slot, ROW_V), vy = *point_row(body, slot, ROW_V + 1);
        double spin, inertia;
        mpm_affine_inner(body, slot, &spin, &inertia);
        sum.momentum[0] += m * vx, sum.momentum[1] += m * vy;
        sum.angular += m * (*point_row(body, slot, ROW_X) * vy - *point_row(body, slot, ROW_X + 1) * vx + spin);
    }
    return sum;
}

/* Of the degrees of freedom, each with the mass that goes by it, by which impulses are given; or, with `all`, of all nodes, each with its own. */
static totals of_nodes(const mpm_body *body, int from, bool all) {
    totals sum = {0};
    for (size_t k = 0; k < body->tile_count; k++)
        for (int n = 0; n < AB_TILE_NODES; n++) {
            double x[2];
            const double *own = node_record(body, k, n), *v = own + from, m = all ? own[OWN_MASS] : own[OWN_MASS] > 0 ? 1 / own[OWN_INVERSE] : 0;
            if (!all && mpm_light_tie_of(body, (uint32_t)(k * AB_TILE_NODES) + (uint32_t)n)) continue;
            node_place(body, k, n, x);
            sum.momentum[0] += m * v[0], sum.momentum[1] += m * v[1];
            sum.angular += m * (x[0] * v[1] - x[1] * v[0]);
        }
    return sum;
}

static double off(totals a, totals b, bool angular) {
    const double linear = fmax(fabs(a.momentum[0] - b.momentum[0]), fabs(a.momentum[1] - b.momentum[1]));
    return angular ? fmax(linear, fabs(a.angular - b.angular) / 10) : linear;
}

static const char *const UPDATE[] = {"usl", "usf", "musl", "usavg"}, *const TRANSFER[] = {"flip", "apic", "{xpic: 3}"};

static void test_momenta_are_kept(void **state) {
    (void)state;
    for (int b = 0; b < BASES; b++) {
        double worst_to = 0, worst_forces = 0, worst_back = 0;
        for (int e = 0; e < OFFSETS; e++)
            for (int u = 0; u < 4; u++)
                for (int t = 0; t < 3; t++) {
                    one_body *one = one_body_create(scene(BASIS + b, EPS[e], 4, 1e-3, UPDATE[u], TRANSFER[t]), 1);
                    mpm_body *body = one->mpm;
                    shuffle(body, 1);
                    const totals before = of_points(body);
                    must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
                    if (u == 1) must(one, one->domain->ops->early(one->domain, &one->step, one->report));
                    assert_true(body->tie_count >= 11); /* the outer row and column of 6 x 6 */
                    const bool consistent = mpm_light_mass_consistent(body);
                    worst_to = fmax(worst_to, off(of_nodes(body, OWN_OLD, consistent), before, b > 0 || t != 1)); /* apic keeps affine fields in its place */
                    worst_forces = fmax(worst_forces, off(of_nodes(body, OWN_VELOCITY, false), of_nodes(body, OWN_OLD, false), true));
                    must(one, one->domain->ops->finish(one->domain, &one->step, one->report));
                    worst_back = fmax(worst_back, off(of_points(body), before, consistent)); /* where every impulse of the step is given by the mass that it has */
                    one_body_destroy(one);
                }
        print_message("%s, momenta: to the nodes %.1e, by stress %.1e, back %.1e of 25\n", BASIS[b].name, worst_to, worst_forces,
                      worst_back);
        assert_true(worst_to < 1e-13 && worst_forces < 1e-13 && worst_back < 1e-13);
    }
}

static void test_forces_do_the_work_of_the_strain(void **state) {
    (void)state;
    for (int b = 0; b < BASES; b++)
        for (int e = 0; e < OFFSETS; e++) {
            one_body *one = one_body_create(scene(BASIS + b, EPS[e], 4, 1e-8, "usl", "flip"), 1);
            mpm_body *body = one->mpm;
            shuffle(body, 1);
            must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
            assert_true(body->tie_count >= 11);
            double work = 0, size = 0;
            for (size_t n = 0; n < body->tile_count * AB_TILE_NODES; n++) {
                double *own = body->own + n * OWN_RECORD;
                if (!(own[OWN_MASS] > 0) || mpm_light_tie_of(body, (uint32_t)n)) continue;
                for (int c = 0; c < 2; c++) {
                    const double force = (own[OWN_VELOCITY + c] - own[OWN_OLD + c]) / own[OWN_INVERSE + c] / one->step.dt;
                    own[OWN_VELOCITY + c] = random_between(-1, 1);
                    work -= one->step.dt * force * own[OWN_VELOCITY + c];
                    size += one->step.dt * fabs(force * own[OWN_VELOCITY + c]);
                }
            }
            must(one, one->domain->ops->stress(one->domain, &one->step, one->report));
            print_message("%s, eps %.0e: work %10.3e, booked %10.3e J\n", BASIS[b].name, EPS[e], work, body->last_strain);
            assert_true(fabs(body->last_strain - work) <= 1e-6 * size);
            one_body_destroy(one);
        }
}

static void test_uniform_motion_and_strain_are_left_as_they_are(void **state) {
    (void)state;
    static const double V[2] = {0.3, 0.2}, STRETCH[2][2] = {{0.4, -0.1}, {0.3, -0.2}}; /* m/s, 1/s */
    for (int b = 0; b < BASES; b++) {
        double motion = 0, strain = 0;
        for (int e = 0; e < OFFSETS; e++)
            for (int u = 0; u < 4; u++) {
                one_body *one = one_body_create(scene(BASIS + b, EPS[e], 4, 1e-3, UPDATE[u], "flip"), 1);
                mpm_body *body = one->mpm;
                for (size_t slot = 0; slot < body->block_count * 8; slot++)
                    for (int c = 0; is_point(body, slot) && c < 2; c++) *point_row(body, slot, ROW_V + c) = V[c];
                for (int s = 0; s < 3; s++) one_body_step(one, NULL, NULL);
                assert_true(body->tie_count >= 11);
                for (size_t slot = 0; slot < body->block_count * 8; slot++) {
                    if (!is_point(body, slot)) continue;
                    for (int c = 0; c < 2; c++) motion = fmax(motion, fabs(*point_row(body, slot, ROW_V + c) - V[c]));
                    for (int c = 0; c < 4; c++) motion = fmax(motion, fabs(*point_row(body, slot, ROW_STRESS + c)));
                }
                if (u == 0) { /* nodes that are free, on a field that is linear in x: all that strains the points is that */
                    must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
                    for (size_t n = 0; n < body->tile_count * AB_TILE_NODES; n++) {
                        double x[2], *own = body->own + n * OWN_RECORD;
                        if (!(own[OWN_MASS] > 0) || mpm_light_tie_of(body, (uint32_t)n)) continue;
                        node_place(body, n / AB_TILE_NODES, (int)(n % AB_TILE_NODES), x);
                        for (int c = 0; c < 2; c++) own[OWN_VELOCITY + c] = STRETCH[c][0] * x[0] + STRETCH[c][1] * x[1];
                    }
                    must(one, one->domain->ops->stress(one->domain, &one->step, one->report));
                    const double wanted[2] = {STRETCH[0][0] * one->step.dt, STRETCH[1][1] * one->step.dt}; /* E 1, nu 0 */
                    for (size_t slot = 0; slot < body->block_count * 8; slot++)
                        for (int c = 0; is_point(body, slot) && c < 2; c++)
                            strain = fmax(strain, fabs(*point_row(body, slot, ROW_STRESS + c) / wanted[c] - 1));
                }
                one_body_destroy(one);
            }
        print_message("%s: uniform motion off by %.1e m/s, uniform strain by %.1e of it\n", BASIS[b].name, motion, strain);
        assert_true(motion < 1e-14 &&
                    strain < 2e-3); /* the strain is logarithmic or nearly so: of the second order in 4e-4, with the turn */
    }
}

static void test_points_that_touch_are_where_they_are(void **state) {
    (void)state;
    for (int b = 0; b < BASES; b++)
        for (int e = 0; e < OFFSETS; e++) {
            one_body *one = one_body_create(scene(BASIS + b, EPS[e], 4, 1e-3, "musl", "flip"), 1);
            const mpm_body *body = one->mpm;
            uint64_t key[4], cells[4] = {~UINT64_C(0), ~UINT64_C(0), ~UINT64_C(0), ~UINT64_C(0)};
            for (int k = 0; k < 4; k++) key[k] = ab_tile_key(k % 2, k / 2);
            const ab_region region = {body->h, 4, key, cells};
            ab_surface s = {.struct_size = sizeof s, .dimension = 2};
            must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
            must(one, one->domain->ops->surface_points(one->domain, &region, &s, one->report));
            assert_int_equal(s.point_count, 100);
            assert_true(body->tie_count >= 11);
            for (size_t k = 0; k < s.point_count; k++) {
                double sum = 0, place[2] = {0};
                for (size_t n = s.point_start[k]; n < s.point_start[k + 1]; n++) {
                    double at[2];
                    assert_null(mpm_light_tie_of(body, s.point_dof[n]));
                    node_place(body, s.point_dof[n] / AB_TILE_NODES, (int)(s.point_dof[n] % AB_TILE_NODES), at);
                    sum += s.point_weight[n];
                    for (int c = 0; c < 2; c++) place[c] += s.point_weight[n] * at[c];
                }
                assert_true(fabs(sum - 1) < 1e-14);
                for (size_t c = 0; c < 2; c++) assert_true(fabs(place[c] - s.point_position[c * s.point_ld + k]) < 1e-13);
            }
            one_body_destroy(one);
        }
}

/* Frozen points (dt is right, but they hardly move), any velocities at first: kinetic and strain energy never come near twice what there was. */
static void test_every_step_up_to_the_limit_is_stable(void **state) {
    (void)state;
    static const int per_cell[] = {1, 4, 9, 16};
    for (int b = 0; b < BASES; b++)
        for (int n = 0; n < 4; n++)
            for (int u = 0; u < 4; u++) {
                const double share =
                    b > 0 && u == 0 ? 0.7 : 0.95; /* usl: a mode that the points do not feel is stable to 2^-1/2 of the limit */
                double most = 0;
                for (int e = -8; e < OFFSETS; e++) {
                    const double eps =
                        e < 0 ? -0.1 * e + 0.03 : EPS[e]; /* 0.13 .. 0.83, then EPS; none on a node, which rounding alone would cross */
                    one_body *one = one_body_create(scene(BASIS + b, eps, per_cell[n], 1, UPDATE[u], "flip"), 1);
                    mpm_body *body = one->mpm;
                    const char *limit;
                    one->step.dt = share * one->domain->ops->critical_dt(one->domain, &limit);
                    double first = 0;
                    for (size_t slot = 0; slot < body->block_count * 8; slot++)
                        for (int c = 0; is_point(body, slot) && c < 2; c++) {
                            const double v = 1e-14 * random_between(-1, 1);
                            *point_row(body, slot, ROW_V + c) = v;
                            first += 0.5 * *point_row(body, slot, ROW_MASS) * v * v;
                        }
                    for (int s = 0; s < 300; s++) {
                        one_body_step(one, NULL, NULL);
                        most = fmax(most, body->energy.kinetic / first);
                    }
                    one_body_destroy(one);
                }
                print_message("%s, %d a cell, %s at %.2f of the limit: kinetic energy at most %.3f of that at first\n", BASIS[b].name,
                              per_cell[n], UPDATE[u], share, most);
                assert_true(most < 2);
            }
}

/* The node that is the mirror image of one in the line x = middle (way 0), y = middle (1) or x = y (2). UINT32_MAX: the body has none there. */
static uint32_t mirrored(const mpm_body *body, uint32_t dof, int way, double middle) {
    double x[2], at[2];
    node_place(body, dof / AB_TILE_NODES, (int)(dof % AB_TILE_NODES), x);
    if (way < 2)
        x[way] = 2 * middle - x[way];
    else
        node_place(body, dof / AB_TILE_NODES, (int)(dof % AB_TILE_NODES), at), x[0] = at[1], x[1] = at[0];
    for (size_t k = 0; k < body->tile_count; k++)
        for (int n = 0; n < AB_TILE_NODES; n++) {
            node_place(body, k, n, at);
            if (fabs(at[0] - x[0]) < 1e-9 && fabs(at[1] - x[1]) < 1e-9) return (uint32_t)(k * AB_TILE_NODES) + (uint32_t)n;
        }
    return UINT32_MAX;
}

/* Bodies so thin that light nodes of two sides want the same heavy ones: whichever came first would have them. */
static void test_ties_of_a_symmetric_body_are_symmetric(void **state) {
    (void)state;
    static const char *const shape[] = {"{box: [[%.17g, %.17g], [%.17g, %.17g]]}",
                                        "{polygon: [[%5$.17g, %2$.17g], [%3$.17g, %6$.17g], [%5$.17g, %4$.17g], [%1$.17g, %6$.17g]]}"};
    int refused = 0, count = 0;
    for (int b = 0; b < BASES; b++)
        for (int kind = 0; kind < 2; kind++)
            for (int place = 0; place < 4; place++)
                for (int size = 0; size < 24; size++) {
                    const double middle[2] = {7 + 0.5 * (place % 2), 7 + 0.5 * (place / 2)}; /* on the lines x, y = 8 tiles meet */
                    const double half_x = 0.57 + 0.1234 * size;
                    const double half[2] = {half_x, size % 2 ? half_x : 0.61 + 0.0931 * ((7 * size) % 24)};
                    char outline[400], text[1500];
                    snprintf(outline, sizeof outline, shape[kind], middle[0] - half[0], middle[1] - half[1], middle[0] + half[0],
                             middle[1] + half[1], middle[0], middle[1]);
                    snprintf(
                        text, sizeof text,
                        "abut: 1\nspace: plane-strain\ntime: {end: 1, dt: 1e-3}\ngrid: {from: [0, 0], to: [16, 16], cell: 1}\n"
                        "materials: {m: {model: linear-elastic, E: 1, nu: 0, density: 1}}\n"
                        "bodies: {b: {method: material-points, material: m, shape: %s, basis: %s, fill: {rule: regular, per_cell: 16}, "
                        "transfer: flip}}\n",
                        outline, BASIS[b].text);
                    one_body *one = one_body_create(text, 1);
                    mpm_body *body = one->mpm;
                    for (size_t slot = 0; slot < body->block_count * 8;
                         slot++) { /* masses from patch to patch, so that heavy nodes have little to hand on */
                        if (!is_point(body, slot)) continue;
                        const double a = floor(fabs(*point_row(body, slot, ROW_X) - middle[0]) / 0.7137),
                                     far = floor(fabs(*point_row(body, slot, ROW_X + 1) - middle[1]) / 0.7137);
                        const double any = 43.758 * sin(12.9898 * fmin(a, far) + 78.233 * fmax(a, far) + size);
                        *point_row(body, slot, ROW_MASS) *= pow(10, -2 * (any - floor(any)));
                    }
                    must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
                    for (size_t k = 0; k < body->tie_count; k++)
                        for (int way = 0; way < (half[0] == half[1] && middle[0] == middle[1] ? 3 : 2); way++) {
                            if (body->own[(size_t)body->ties[k].dof * OWN_RECORD + OWN_MASS] < 1e-12)
                                continue; /* rounding, which may have no image */
                            const mpm_tie *t = body->ties + k,
                                          *other = mpm_light_tie_of(body, mirrored(body, t->dof, way, middle[way % 2]));
                            assert_non_null(other);
                            assert_int_equal(other->count, t->count);
                            for (int e = 0; e < t->count; e++) {
                                const uint32_t to = mirrored(body, t->to[e], way, middle[way % 2]);
                                int f = 0;
                                while (f < other->count && other->to[f] != to) f++;
                                assert_true(f < other->count && fabs(other->weight[f] - t->weight[e]) < 1e-15);
                            }
                            refused += t->count && t->weight[t->count - 1] > 0;
                            count++;
                        }
                    one_body_destroy(one);
                }
    print_message("%d ties and their images, %d of them to one node alone\n", count, refused);
    assert_true(count > 1000 && refused > 100);
}

/* A bar that vibrates as it flies slowly past the lines of the grid: nodes at its edges are light and heavy in turn. Range of the energy over what there is of
 * vibration, and the most stress across the bar (nu is 0) over that along it: a corner that went by a diagonal, or an edge that was taken for light where it ends, made 0.15. */
typedef struct noise {
    double energy, across;
    int changes; /* steps with more or fewer ties than the one before */
} noise;

static noise of_flight(const basis *b, const char *update, double cells, bool with_ties) {
    static const double LENGTH = 10, WIDTH = 3, SPEED = 0.01, STRAIN = 1e-4;
    char text[2000];
    snprintf(text, sizeof text,
             "abut: 1\nspace: plane-strain\ntime: {end: 1e5, dt: 0.3}\ngrid: {from: [0, 0], to: [50, 50], cell: 1}\n"
             "materials: {m: {model: linear-elastic, E: 1, nu: 0, density: 1}}\n"
             "bodies: {b: {method: material-points, material: m, shape: {box: [[5.1, 5.2], [15.1, 8.2]]}, basis: %s, fill: {rule: regular, "
             "per_cell: 4}, update: %s, transfer: flip}}\n",
             b->text, update);
    one_body *one = one_body_create(text, 1);
    mpm_body *body = one->mpm;
    if (!with_ties) body->light_limit = 0;
    for (size_t slot = 0; slot < body->block_count * 8; slot++)
        if (is_point(body, slot)) {
            *point_row(body, slot, ROW_V) = SPEED - STRAIN * cos(M_PI * (*point_row(body, slot, ROW_X) - 5.1) / LENGTH);
            *point_row(body, slot, ROW_V + 1) = 0.73 * SPEED;
        }
    const double flight = 0.5 * LENGTH * WIDTH * SPEED * SPEED * (1 + 0.73 * 0.73), vibration = 0.25 * LENGTH * WIDTH * STRAIN * STRAIN;
    noise n = {0};
    double low = INFINITY, high = -INFINITY, along = 0, across = 0;
    size_t ties = 0;
    for (int s = 0; s < cells / (SPEED * one->step.dt); s++) {
        one_body_step(one, NULL, NULL);
        n.changes += s > 0 && body->tie_count != ties;
        ties = body->tie_count;
        const double energy = (body->energy.kinetic - flight + body->energy.strain) / vibration;
        low = fmin(low, energy), high = fmax(high, energy);
        for (size_t slot = 0; slot < body->block_count * 8; slot++)
            if (is_point(body, slot)) {
                along = fmax(along, fabs(*point_row(body, slot, ROW_STRESS)));
                across = fmax(across, fabs(*point_row(body, slot, ROW_STRESS + 1)));
            }
    }
    one_body_destroy(one);
    n.energy = high - low, n.across = across / along;
    return n;
}

/* What node n of tile k goes by, a bit for each of the places -4..4 along x; 1 << 4, which no node goes by: it is no light one. */
static int along_the_row(const mpm_body *body, uint32_t dof) {
    const mpm_tie *t = mpm_light_tie_of(body, dof);
    if (!t) return 1 << 4;
    double at[2], x[2];
    node_place(body, dof / AB_TILE_NODES, (int)(dof % AB_TILE_NODES), at);
    int by = 0;
    for (int e = 0; e < t->count; e++) {
        node_place(body, t->to[e] / AB_TILE_NODES, (int)(t->to[e] % AB_TILE_NODES), x);
        assert_true(fabs(x[1] - at[1]) < 1e-12);
        by |= 1 << ((int)lrint(x[0] - at[0]) + 4);
    }
    return by;
}

/* A bar whose mass varies along it alone, and may be ten times that of the start. Nodes at its long edges have half of what those in the middle have: each row must have the same ties, or what
 * the bar does along itself bends it. */
static void test_ties_are_alike_in_all_rows_of_a_bar(void **state) {
    (void)state;
    int ties = 0, single = 0;
    for (int b = 1; b < BASES; b++)
        for (int run = 0; run < 400; run++) {
            char text[1500];
            const double low = 2 + BASIS[b].edge + 0.5 * BASIS[b].point;
            snprintf(text, sizeof text,
                     "abut: 1\nspace: plane-strain\ntime: {end: 1, dt: 1e-3}\ngrid: {from: [0, 0], to: [24, 8], cell: 1}\n"
                     "materials: {m: {model: linear-elastic, E: 1, nu: 0, density: 1}}\n"
                     "bodies: {b: {method: material-points, material: m, shape: {box: [[2.3, %g], [21.3, %g]]}, basis: %s, fill: {rule: regular, "
                     "per_cell: 4}, transfer: flip}}\n",
                     low, low + 3, BASIS[b].text);
            one_body *one = one_body_create(text, 1);
            mpm_body *body = one->mpm;
            double mass[34];
            for (int i = 0; i < 34; i++) mass[i] = pow(10, random_between(-4, 1));
            for (size_t slot = 0; slot < body->block_count * 8; slot++)
                if (is_point(body, slot)) *point_row(body, slot, ROW_MASS) *= mass[(int)(*point_row(body, slot, ROW_X) / 0.7137)];
            must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
            int by[4][24];
            for (size_t k = 0; k < body->tile_count; k++)
                for (int n = 0; n < AB_TILE_NODES; n++) {
                    double x[2];
                    node_place(body, k, n, x);
                    const int row = (int)lrint(x[1] - (low > 2 ? 3 : 2)), column = (int)lrint(x[0]);
                    if (row < 0 || row > (low > 2 ? 1 : 3) || column < 0 || column > 23) continue;
                    by[row][column] = along_the_row(body, (uint32_t)(k * AB_TILE_NODES) + (uint32_t)n);
                }
            for (int i = 2; i < 22; i++) {
                ties += by[0][i] != 1 << 4;
                single += by[0][i] == 1 << 3 || by[0][i] == 1 << 5;
                for (int row = 1; row < (low > 2 ? 2 : 4); row++) assert_int_equal(by[row][i], by[0][i]);
            }
            one_body_destroy(one);
        }
    print_message("%d ties, %d of them to one node\n", ties, single);
    assert_true(ties > 500 && single > 3);
}

static void test_ties_come_and_go_quietly(void **state) {
    (void)state;
    for (int b = 1; b < BASES; b++)
        for (int u = 0; u < 4; u++) {
            const noise with = of_flight(BASIS + b, UPDATE[u], 5, true), without = of_flight(BASIS + b, UPDATE[u], 5, false);
            print_message(
                "%s, %s: energy within %.2e of the vibration with ties (%d changes), %.2e without; stress across %.2e and %.2e of that "
                "along\n",
                BASIS[b].name, UPDATE[u], with.energy, with.changes, without.energy, with.across, without.across);
            assert_true(with.changes > 10 && with.energy < 1.02 * without.energy + 2e-4 && with.across < 1e-11);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_momenta_are_kept),
                                       cmocka_unit_test(test_forces_do_the_work_of_the_strain),
                                       cmocka_unit_test(test_uniform_motion_and_strain_are_left_as_they_are),
                                       cmocka_unit_test(test_points_that_touch_are_where_they_are),
                                       cmocka_unit_test(test_ties_of_a_symmetric_body_are_symmetric),
                                       cmocka_unit_test(test_ties_are_alike_in_all_rows_of_a_bar),
                                       cmocka_unit_test(test_ties_come_and_go_quietly),
                                       cmocka_unit_test(test_every_step_up_to_the_limit_is_stable)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
