/* test_transfer.c: what each transfer of velocities promises, against exact answers: an affine field comes back as it is; momentum and angular momentum go to the
 * nodes and back to rounding; xpic and fmpm are what their papers define, with whole matrices; none makes energy. */
#include "one_body.h"

static const char *scene(double E, const char *basis, const char *update, const char *transfer, const char *more) {
    static char text[2000];
    snprintf(text, sizeof text,
             "abut: 1\nspace: plane-strain\ntime: {end: 1e4, dt: 1e-3}\ngrid: {from: [-5, -3], to: [15, 17], cell: 0.5}\n"
             "materials: {m: {model: linear-elastic, E: %g, nu: 0.3, density: 2}}\n"
             "bodies: {b: {method: material-points, material: m, shape: {polygon: [[4, 6.3], [7.1, 6.6], [6.2, 8.4], [4.3, 7.9]]}, basis: "
             "%s, update: %s, "
             "transfer: %s, %s}}\n",
             E, basis, update, transfer, more);
    return text;
}

typedef struct totals {
    double mass, momentum[2], angular, kinetic;
} totals;

/* Of the nodes, by their velocities at `from`. */
static totals of_nodes(const mpm_body *body, int from) {
    totals sum = {0};
    for (size_t k = 0; k < body->tile_count; k++)
        for (int n = 0; n < AB_TILE_NODES; n++) {
            double x[2];
            const double *own = node_record(body, k, n), *v = own + from, m = own[OWN_MASS];
            node_place(body, k, n, x);
            sum.mass += m;
            for (int c = 0; c < 2; c++) sum.momentum[c] += m * v[c];
            sum.angular += m * ((x[0] + body->origin[0]) * v[1] - (x[1] + body->origin[1]) * v[0]);
            sum.kinetic += 0.5 * m * (v[0] * v[0] + v[1] * v[1]);
        }
    return sum;
}

/* Of the points as they stand, their affine parts included. */
static totals of_points(const mpm_body *body) {
    totals sum = {0};
    for (size_t slot = 0; slot < body->block_count * 8; slot++) {
        if (!is_point(body, slot)) continue;
        double x[2], v[2], spin, inertia;
        const double m = *point_row(body, slot, ROW_MASS), inner = mpm_affine_inner(body, slot, &spin, &inertia);
        for (int c = 0; c < 2; c++) {
            x[c] = *point_row(body, slot, ROW_X + c) + body->origin[c];
            v[c] = *point_row(body, slot, ROW_V + c);
            sum.momentum[c] += m * v[c];
        }
        sum.mass += m;
        sum.angular += m * (x[0] * v[1] - x[1] * v[0] + spin);
        sum.kinetic += 0.5 * m * (v[0] * v[0] + v[1] * v[1] + inner);
    }
    return sum;
}

/* Points in disorder: velocities, affine parts, stresses, and places within their cells; all of size 1. */
static void shuffle(mpm_body *body, double stress, double shift) {
    for (size_t slot = 0; slot < body->block_count * 8; slot++) {
        if (!is_point(body, slot)) continue;
        for (int c = 0; c < 2; c++) {
            *point_row(body, slot, ROW_V + c) = random_between(-1, 1);
            double *x = point_row(body, slot, ROW_X + c);
            const double moved = *x + random_between(-shift, shift) * body->h, cells = moved * body->inverse_h - 0.5;
            if (cells - floor(cells) > 0.02 && cells - floor(cells) < 0.48) *x = moved;
        }
        for (int c = 0; c < 4; c++) {
            *point_row(body, slot, ROW_STRESS + c) = random_between(-stress, stress);
            if (body->rows.affine >= 0)
                *point_row(body, slot, body->rows.affine + c) = random_between(-1, 1) * (body->keeps_moment ? 0.1 : 1);
        }
    }
}

enum { BASES = 5 };
static const char *const basis[BASES] = {"gimp", "linear", "bspline2", "bspline3", "cpdi"}, *const update[] = {"musl", "usf", "usl"};

/* By the scene: it would be unstable. */
static bool refused(const char *basis_, const char *update_, const char *transfer) {
    return !strcmp(basis_, "gimp") && !strcmp(update_, "usl") && !strcmp(transfer, "tpic");
}

/* v = a + C x is what the nodes get, and what the points have after many steps in which they do not move. */
static void test_an_affine_field_comes_back_as_it_is(void **state) {
    (void)state;
    static const double c[4] = {0.3, -1.7, 0.9, 0.4}, a[2] = {0.5, -2};
    static const char *const transfer[] = {"apic", "tpic"};
    for (int b = 0; b < BASES; b++)
        for (int u = 0; u < 3; u++)
            for (int t = 0; t < 2; t++) {
                if (refused(basis[b], update[u], transfer[t])) continue;
                one_body *one = one_body_create(scene(1e-3, basis[b], update[u], transfer[t],
                                                      "velocity: [\"0.5 + 0.3*x - 1.7*y\", \"-2 + 0.9*x + 0.4*y\"], fill: {rule: gauss}"),
                                                1);
                const mpm_body *body = one->mpm;
                double worst_node = 0, worst_point = 0, worst_affine = 0;
                one->step.dt = 1e-20; /* the points stay */
                for (int s = 0; s < 100; s++) {
                    must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
                    for (size_t k = 0; k < body->tile_count; k++)
                        for (int n = 0; n < AB_TILE_NODES; n++) {
                            double x[2];
                            const double *own = node_record(body, k, n);
                            node_place(body, k, n, x);
                            if (own[OWN_MASS] < 1e-9) continue; /* of mass nothing, its velocity has no digits left */
                            for (int i = 0; i < 2; i++)
                                worst_node = fmax(worst_node, fabs(own[OWN_OLD + i] - a[i] - c[2 * i] * (x[0] + body->origin[0]) -
                                                                   c[2 * i + 1] * (x[1] + body->origin[1])));
                        }
                    one_body_step(one, NULL, NULL);
                }
                for (size_t slot = 0; slot < body->block_count * 8; slot++) {
                    if (!is_point(body, slot)) continue;
                    double d[3][8];
                    body->kernel->spreads(body, body->tiles + mpm_tile_of_block(body, (uint32_t)(slot / 8)), mpm_block(body, slot / 8), d);
                    const double x = *point_row(body, slot, ROW_X) + body->origin[0],
                                 y = *point_row(body, slot, ROW_X + 1) + body->origin[1];
                    for (int i = 0; i < 2; i++)
                        worst_point = fmax(worst_point, fabs(*point_row(body, slot, ROW_V + i) - a[i] - c[2 * i] * x - c[2 * i + 1] * y));
                    for (int k = 0; k < 4; k++) {
                        const double kept = *point_row(body, slot, body->rows.affine + k);
                        worst_affine = fmax(worst_affine, fabs((body->keeps_moment ? kept / d[k % 2][slot % 8] : kept) - c[k]));
                    }
                }
                print_message("%-8s %-4s %-4s nodes %.1e, points %.1e, slopes %.1e\n", basis[b], update[u], transfer[t], worst_node,
                              worst_point, worst_affine);
                assert_true(worst_node <= 1e-11 && worst_point <= 1e-11 && worst_affine <= 1e-10);
                one_body_destroy(one);
            }
}

/* To the nodes: momentum and angular momentum of the points, spins of their affine parts included, from any state. Apic on gimp brings both back. */
static void test_momenta_go_to_the_nodes_and_back(void **state) {
    (void)state;
    static const char *const transfer[] = {"flip", "pic", "apic", "tpic", "{xpic: 3}", "{fmpm: 3}"};
    for (int b = 0; b < BASES; b++)
        for (int u = 0; u < 3; u++)
            for (int t = 0; t < 6; t++) {
                if (refused(basis[b], update[u], transfer[t])) continue;
                one_body *one = one_body_create(scene(1e-3, basis[b], update[u], transfer[t], "velocity: [1, 0]"), 1);
                mpm_body *body = one->mpm;
                body->light_limit = 0; /* each node on its own: those that go by others are test_light_nodes.c's */
                shuffle(body, 1, b == 1 ? 0.2 : 0.1);
                const totals before = of_points(body);
                must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
                const totals old = of_nodes(body, OWN_OLD), trial = of_nodes(body, OWN_VELOCITY);
                if (one->domain->ops->early) must(one, one->domain->ops->early(one->domain, &one->step, one->report));
                const totals early = of_nodes(body, OWN_VELOCITY);
                must(one, one->domain->ops->finish(one->domain, &one->step, one->report));
                ab_energy energy;
                ab_motion motion;
                one->domain->ops->ledger(one->domain, &energy, &motion);
                const double size = 10 * before.mass, to = fabs(old.angular - before.angular) / size,
                             forces = fabs(trial.angular - old.angular) / size, first = fabs(early.angular - old.angular) / size,
                             back = fabs(motion.angular_momentum[2] - before.angular) / size;
                double linear = 0;
                for (int c = 0; c < 2; c++)
                    linear = fmax(linear, fabs(old.momentum[c] - before.momentum[c]) + fabs(motion.momentum[c] - before.momentum[c]));
                print_message("%-8s %-4s %-9s momentum %.1e, angular: to nodes %.1e, by stress %.1e %.1e, back %.1e\n", basis[b], update[u],
                              transfer[t], linear / size, to, forces, first, back);
                assert_true(linear <= 1e-12 * size && to <= 1e-14 && forces <= 1e-14);
                if (!strcmp(transfer[t], "apic")) assert_true(back <= 1e-14);
                one_body_destroy(one);
            }
}

/* A body that spins and flies through tile after tile keeps its angular momentum with apic on a smooth basis, whatever its stress does. */
static void test_apic_keeps_the_angular_momentum_of_a_free_body(void **state) {
    (void)state;
    for (int run = 0; run < 3 * BASES; run++)
        for (int t = 0; t < 2; t++) {
            const int b = run / 3, u = run % 3;
            if (!strcmp(basis[b], "linear") || (b && t)) continue;
            one_body *one = one_body_create(
                scene(1e4, basis[b], update[u], t ? "flip" : "apic", "velocity: [\"2 - 3*(y - 7)\", \"1 + 3*(x - 5)\"]"), 1);
            one->step.dt = 1e-3;
            const totals start = of_points(one->mpm);
            const uint64_t version = one->mpm->version;
            double worst = 0, momentum = 0;
            for (int s = 0; s < 2200; s++) {
                ab_energy energy;
                ab_motion motion;
                one_body_step(one, NULL, NULL);
                one->domain->ops->ledger(one->domain, &energy, &motion);
                worst = fmax(worst, fabs(motion.angular_momentum[2] - start.angular));
                momentum = fmax(momentum, fabs(motion.momentum[0] - start.momentum[0]));
            }
            print_message("%-8s %-4s %-4s angular momentum off by %.1e, momentum by %.1e\n", basis[b], update[u], t ? "flip" : "apic",
                          worst / fabs(start.angular), momentum / fabs(start.momentum[0]));
            assert_true(one->mpm->version > version + 3); /* sorted on the way */
            assert_true(momentum <= 1e-12 * fabs(start.momentum[0]));
            if (t == 0) assert_true(worst <= 1e-12 * fabs(start.angular));
            one_body_destroy(one);
        }
}

/* xpic: v_p + S a dt - (1 - S S+)^m v_p; fmpm: S sum (1 - S+ S)^k (v_old + a dt); the matrices from the basis alone. */
static void test_xpic_and_fmpm_are_what_they_are_defined_as(void **state) {
    (void)state;
    for (int b = 0; b < BASES; b++)
        for (int full = 0; full < 2; full++)
            for (int order = 1; order <= 6; order++) {
                char transfer[20];
                snprintf(transfer, sizeof transfer, "{%s: %d}", full ? "fmpm" : "xpic", order);
                one_body *one = one_body_create(scene(1e-3, basis[b], "usl", transfer, "velocity: [1, 0]"), 1);
                mpm_body *body = one->mpm;
                body->light_limit = 0; /* each node on its own: those that go by others are test_light_nodes.c's */
                shuffle(body, 1, 0.1);
                const size_t slots = body->block_count * 8, nodes = body->tile_count * AB_TILE_NODES;
                double *s = calloc(slots * nodes, sizeof *s), *v = calloc(slots, sizeof *v), *u = calloc(nodes, sizeof *u),
                       *w = calloc(nodes, sizeof *w), *p = calloc(slots, sizeof *p), *sum = calloc(nodes, sizeof *sum),
                       *expected = calloc(2 * slots, sizeof *expected);
                for (size_t slot = 0; slot < slots; slot++) {
                    mpm_stencils weights;
                    const mpm_tile *tile = body->tiles + mpm_tile_of_block(body, (uint32_t)(slot / 8));
                    const int l = (int)(slot % 8);
                    body->kernel->stencils(body, tile, mpm_block(body, slot / 8), &weights);
                    for (int j = 0; j < body->kernel->nodes; j++)
                        for (int i = 0; i < body->kernel->nodes; i++)
                            s[slot * nodes + mpm_dof_of(body, tile, weights.node[l] + j * body->kernel->patch + i)] =
                                weights.value[j * body->kernel->nodes + i][l];
                }
                must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
                for (int c = 0; c < 2; c++) {
                    for (size_t slot = 0; slot < slots; slot++) v[slot] = *point_row(body, slot, ROW_V + c);
                    for (size_t n = 0; n < nodes; n++) u[n] = sum[n] = body->own[n * OWN_RECORD + (full ? OWN_VELOCITY : OWN_OLD) + c];
                    for (int k = 1; k < order; k++) { /* u <- (1 - S+ S) u */
                        memset(p, 0, slots * sizeof *p), memset(w, 0, nodes * sizeof *w);
                        for (size_t slot = 0; slot < slots; slot++)
                            for (size_t n = 0; n < nodes; n++) p[slot] += s[slot * nodes + n] * u[n];
                        for (size_t slot = 0; slot < slots; slot++)
                            for (size_t n = 0; n < nodes; n++) w[n] += *point_row(body, slot, ROW_MASS) * s[slot * nodes + n] * p[slot];
                        for (size_t n = 0; n < nodes; n++) {
                            const double m = body->own[n * OWN_RECORD + OWN_MASS];
                            u[n] -= m > 0 ? w[n] / m : 0;
                            sum[n] += u[n];
                        }
                    }
                    if (!full) { /* (1 - S S+)^m v_p by points */
                        double *r = p;
                        memcpy(r, v, slots * sizeof *r);
                        for (int k = 0; k < order; k++) {
                            memset(w, 0, nodes * sizeof *w);
                            for (size_t slot = 0; slot < slots; slot++)
                                for (size_t n = 0; n < nodes; n++) w[n] += *point_row(body, slot, ROW_MASS) * s[slot * nodes + n] * r[slot];
                            for (size_t slot = 0; slot < slots; slot++)
                                for (size_t n = 0; n < nodes; n++) {
                                    const double m = body->own[n * OWN_RECORD + OWN_MASS];
                                    if (m > 0) r[slot] -= s[slot * nodes + n] * w[n] / m;
                                }
                        }
                    }
                    for (size_t slot = 0; slot < slots; slot++) {
                        double by_nodes = 0, gain = 0;
                        for (size_t n = 0; n < nodes; n++) {
                            const double *own = body->own + n * OWN_RECORD;
                            by_nodes += s[slot * nodes + n] * sum[n];
                            gain += s[slot * nodes + n] * (own[OWN_VELOCITY + c] - own[OWN_OLD + c]);
                        }
                        expected[2 * slot + (size_t)c] = full ? by_nodes : v[slot] + gain - p[slot];
                    }
                }
                must(one, one->domain->ops->finish(one->domain, &one->step, one->report));
                double worst = 0;
                for (size_t slot = 0; slot < slots; slot++)
                    for (int c = 0; is_point(body, slot) && c < 2; c++)
                        worst = fmax(worst, fabs(*point_row(body, slot, ROW_V + c) - expected[2 * slot + (size_t)c]));
                print_message("%-8s %s off by %.1e\n", basis[b], transfer, worst);
                assert_true(worst <= 1e-12);
                free(s), free(v), free(u), free(w), free(p), free(sum), free(expected);
                one_body_destroy(one);
            }
}

/* Without stress nothing is there but the transfer: kinetic energy, as the ledger has it, never rises, and but for flip noise is lost. */
static void test_no_transfer_makes_energy(void **state) {
    (void)state;
    static const char *const transfer[] = {"pic", "{flip: 0.9}", "apic", "tpic", "{xpic: 2}", "{xpic: 5}", "{fmpm: 2}", "{fmpm: 5}"};
    for (int b = 0; b < BASES; b++)
        for (int t = 0; t < 8; t++) {
            one_body *one = one_body_create(scene(1e-3, basis[b], "musl", transfer[t], "velocity: [1, 0]"), 1);
            shuffle(one->mpm, 0, 0.1);
            one->step.dt = 1e-12;
            double before = of_points(one->mpm).kinetic, first = before, worst = 0;
            for (int s = 0; s < 30; s++) {
                ab_energy energy;
                ab_motion motion;
                one_body_step(one, NULL, NULL);
                one->domain->ops->ledger(one->domain, &energy, &motion);
                worst = fmax(worst, energy.kinetic - before);
                before = energy.kinetic;
                assert_true(fabs(of_points(one->mpm).kinetic - energy.kinetic) <=
                            1e-8 * first); /* the ledger's is that of the points as they stand */
            }
            print_message("%-8s %-11s kinetic energy from %.3g to %.3g J, largest rise %.1e J\n", basis[b], transfer[t], first, before,
                          worst);
            assert_true(worst <= 1e-12 * first && before < 0.9 * first);
            one_body_destroy(one);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_an_affine_field_comes_back_as_it_is), cmocka_unit_test(test_momenta_go_to_the_nodes_and_back),
        cmocka_unit_test(test_apic_keeps_the_angular_momentum_of_a_free_body),
        cmocka_unit_test(test_xpic_and_fmpm_are_what_they_are_defined_as), cmocka_unit_test(test_no_transfer_makes_energy)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
