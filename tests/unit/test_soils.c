/* test_soils.c: soils along triaxial, plane-strain and shear paths against closed forms; faces, edges, apex and cut-off; softening; what
 * is refused; batches. */
#include "plugins/material/principal.h"
#include "soil_bench.h"

static const double E = 1e7, NU = 0.3;

static double sine(double degrees) { return sin(degrees * SOIL_DEGREE); }
static double cosine(double degrees) { return cos(degrees * SOIL_DEGREE); }
static double passive(double degrees) { return (1 + sine(degrees)) / (1 - sine(degrees)); }

/* The axial pressure that a sample under the lateral pressure `side` bears by Mohr and Coulomb. */
static double strength(double c, double phi, double side) { return side * passive(phi) + 2 * c * sqrt(passive(phi)); }

/* ---- principal stresses -------------------------------------------------------------------------------------------------------------- */

static void test_principal_values_and_directions_make_the_tensor_again(void **state) {
    (void)state;
    for (int n = 0; n < 20000; n++) {
        const double size = pow(10, soil_uniform(-20, 20)), small = n % 5 == 0 ? 1e-14 : n % 5 == 1 ? 0 : 1;
        double s[6], back[6];
        for (int c = 0; c < 6; c++) s[c] = size * soil_uniform(-1, 1) * (c < 3 ? 1 : small);
        if (n % 7 == 0) s[1] = s[0];
        if (n % 11 == 0) s[2] = s[1] = s[0];
        if (n % 2) s[4] = s[5] = 0;
        principal p;
        principal_of(s, n % 2, &p);
        assert_true(p.value[0] >= p.value[1] && p.value[1] >= p.value[2]);
        principal_join(&p, p.value, back);
        for (int c = 0; c < 6; c++) soil_near("tensor", back[c], s[c], 4e-15 * size);
        const double trace = s[0] + s[1] + s[2];
        const double minors = s[0] * s[1] + s[1] * s[2] + s[2] * s[0] - s[3] * s[3] - s[4] * s[4] - s[5] * s[5];
        const double *v = p.value;
        soil_near("trace", v[0] + v[1] + v[2], trace, 4e-15 * size);
        soil_near("minors", v[0] * v[1] + v[1] * v[2] + v[2] * v[0], minors, 2e-14 * size * size);
        if (n % 2) continue;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                double dot = 0;
                for (int c = 0; c < 3; c++) dot += p.axis[i][c] * p.axis[j][c];
                soil_near("directions", dot, i == j, 4e-15);
            }
    }
}

/* ---- Mohr-Coulomb, Tresca, Drucker-Prager along paths -------------------------------------------------------------------------------- */

static soil_bench *mohr_coulomb(double c, double phi, double psi) {
    return soil_bench_make("mohr-coulomb",
                           SOIL({"E", E}, {"nu", NU}, {"cohesion", c}, {"friction", phi * SOIL_DEGREE}, {"dilation", psi * SOIL_DEGREE}));
}

/* Brings a point to an isotropic pressure. */
static void press(soil_point *p, double pressure) {
    for (int n = 0; n < 10; n++) {
        const double e = -pressure / 10 * (1 - 2 * NU) / E, strain[6] = {e, e, e};
        double stress[6];
        soil_point_step(p, strain, stress, 1);
    }
}

/* Squeezes along y (or stretches, with a negative step) under the lateral pressure `side`: along x, and along z too unless z keeps its
 * strain. */
static void squeeze(soil_point *p, double side, bool plane, double step, int steps) {
    double strain[6] = {0, -step, 0, 0, 0, 0};
    const int held[6] = {1};
    for (int n = 0; n < steps; n++) soil_point_mixed(p, strain, held, !plane, (const double[6]){-side}, side + 1e4);
}

static void test_triaxial_compression_and_extension_reach_the_strength_and_dilate_by_psi(void **state) {
    (void)state;
    static const double soils[][3] = {{1e4, 30, 10}, {1e4, 30, 30}, {0, 35, 0}, {0, 35, 15}, {2e4, 0, 0}};
    const double side = 5e4;
    for (size_t k = 0; k < sizeof soils / sizeof *soils; k++)
        for (int components = 4; components <= 6; components += 2) {
            const double c = soils[k][0], phi = soils[k][1], psi = soils[k][2];
            soil_bench *b = mohr_coulomb(c, phi, psi);
            soil_point p = soil_point_of(b, components);
            press(&p, side);
            squeeze(&p, side, false, 5e-4, 100);
            soil_near("compression", -p.stress[1], strength(c, phi, side), 1e-7 * side);
            const double axial = p.strain[1], volume = p.strain[0] + p.strain[1] + p.strain[2];
            squeeze(&p, side, false, 5e-4, 10); /* on the edge of two faces: each lateral strain as much as the other */
            soil_near("lateral strains", p.strain[0], p.strain[2], 1e-9);
            const double grown = p.strain[0] + p.strain[1] + p.strain[2] - volume;
            soil_near("dilation", grown, 2 * sine(psi) / (1 - sine(psi)) * (axial - p.strain[1]), 1e-8);
            soil_near("work", p.dissipated > 0, 1, 0);

            p = soil_point_of(b, components); /* extension: the lateral pressure is the larger one */
            press(&p, side);
            squeeze(&p, side, false, -5e-4, 100);
            const double axial_stress = (side - 2 * c * sqrt(passive(phi))) / passive(phi);
            soil_near("extension", -p.stress[1], axial_stress, 1e-7 * side);
            soil_bench_close(b);
        }
}

static void test_plane_strain_compression_reaches_the_strength_with_the_middle_stress_between(void **state) {
    (void)state;
    static const double soils[][3] = {{1e4, 30, 10}, {0, 35, 0}, {0, 35, 35}, {2e4, 0, 0}};
    const double side = 5e4;
    for (size_t k = 0; k < sizeof soils / sizeof *soils; k++) {
        const double c = soils[k][0], phi = soils[k][1], psi = soils[k][2];
        soil_bench *b = mohr_coulomb(c, phi, psi);
        soil_point p = soil_point_of(b, 4);
        press(&p, side);
        squeeze(&p, side, true, 5e-4, 100);
        soil_near("peak", -p.stress[1], strength(c, phi, side), 1e-7 * side);
        assert_true(p.stress[2] < -side && p.stress[2] > p.stress[1]);
        const double x = p.strain[0], y = p.strain[1];
        squeeze(&p, side, true, 5e-4, 10);
        soil_near("dilation", (p.strain[0] - x) / (y - p.strain[1]), (1 + sine(psi)) / (1 - sine(psi)), 1e-6);
        soil_bench_close(b);
    }
}

/* Simple shear under a constant pressure on the plane: at the end nothing elastic moves, x does not stretch, and by Davis (1968) the
 * strength of the plane is (c cos(phi) cos(psi) + pressure sin(phi) cos(psi))/(1 - sin(phi) sin(psi)), and it opens by tan(psi). */
static void test_simple_shear_reaches_the_strength_of_davis(void **state) {
    (void)state;
    static const double soils[][3] = {{1e4, 30, 10}, {1e4, 30, 30}, {0, 35, 0}, {0, 35, 15}, {2e4, 0, 0}};
    const double pressure = 5e4;
    for (size_t k = 0; k < sizeof soils / sizeof *soils; k++) {
        const double c = soils[k][0], phi = soils[k][1], psi = soils[k][2];
        soil_bench *b = mohr_coulomb(c, phi, psi);
        soil_point p = soil_point_of(b, 4);
        press(&p, pressure);
        double strain[6] = {0}, y = 0;
        for (int n = 0; n < 1000; n++) {
            const int held[6] = {0, 1};
            strain[3] = 5e-4;
            if (n == 900) y = p.strain[1];
            soil_point_mixed(&p, strain, held, false, (const double[6]){0, -pressure}, pressure);
        }
        const double davis = cosine(psi) * (c * cosine(phi) + pressure * sine(phi)) / (1 - sine(phi) * sine(psi));
        soil_near("strength", p.stress[3], davis, 1e-5 * pressure);
        soil_near("opens", (p.strain[1] - y) / (100 * 5e-4), tan(psi * SOIL_DEGREE), 1e-5);
        soil_bench_close(b);
    }
}

static void test_tresca_is_mohr_coulomb_without_friction(void **state) {
    (void)state;
    soil_bench *a = mohr_coulomb(1e4, 0, 0), *b = soil_bench_make("tresca", SOIL({"E", E}, {"nu", NU}, {"cohesion", 1e4}));
    for (int round = 0; round < 200; round++)
        for (int components = 4; components <= 6; components += 2) {
            for (size_t j = 0; j < 6 * SOIL_MOST; j++)
                a->strain[j] = b->strain[j] = soil_uniform(-5e-3, 5e-3),
                a->stress0[j] = b->stress0[j] = round % 2 ? a->stress1[j] : soil_uniform(-2e4, 2e4);
            assert_int_equal(soil_bench_update(a, components, SOIL_MOST, SOIL_MOST), 0);
            assert_int_equal(soil_bench_update(b, components, SOIL_MOST, SOIL_MOST), 0);
            assert_memory_equal(a->stress1, b->stress1, sizeof(double) * (size_t)components * SOIL_MOST);
            assert_memory_equal(a->state1, b->state1, sizeof(double) * SOIL_MOST);
            assert_memory_equal(a->dissipation, b->dissipation, sizeof a->dissipation);
        }
    soil_point p = soil_point_of(b, 4); /* shear alone */
    double stress[6];
    for (int n = 0; n < 100; n++) soil_point_step(&p, (const double[6]){0, 0, 0, 1e-3}, stress, 1);
    soil_near("shear strength", p.stress[3], 1e4, 1e-9 * 1e4);
    soil_near("plastic strain", p.state[0], (0.1 - 1e4 / (E / (2 * (1 + NU)))) / sqrt(3), 1e-12);
    soil_near("work", p.dissipated, 1e4 * (0.1 - 1e4 / (E / (2 * (1 + NU)))), 1e-6);
    soil_bench_close(a);
    soil_bench_close(b);
}

static void test_apex_and_cut_off_bear_no_more_tension(void **state) {
    (void)state;
    const double pull[6] = {1e-3, 1e-3, 1e-3, 0, 0, 0}, along[6] = {0, 2e-2, 0, 0, 0, 0};
    for (int psi = 0; psi <= 30; psi += 10) {
        soil_bench *b = mohr_coulomb(1e4, 30, psi);
        soil_point p = soil_point_of(b, 4);
        double stress[6];
        for (int n = 0; n < 50; n++) soil_point_step(&p, pull, stress, 1);
        for (int c = 0; c < 3; c++) soil_near("apex", p.stress[c], 1e4 / tan(30 * SOIL_DEGREE), 1e-6);
        soil_near("apex", p.stress[3], 0, 1e-9);
        soil_bench_close(b);
        b = soil_bench_make("mohr-coulomb", SOIL({"E", E}, {"nu", NU}, {"cohesion", 1e4}, {"friction", 30 * SOIL_DEGREE},
                                                 {"dilation", psi * SOIL_DEGREE}, {"tension", 3e3}));
        p = soil_point_of(b, 4);
        for (int n = 0; n < 5; n++) soil_point_step(&p, along, stress, 1);
        soil_near("cut-off along the pull", p.stress[1], 3e3, 1e-6);
        assert_true(p.stress[0] <= 3e3 * (1 + 1e-12) && p.stress[2] <= 3e3 * (1 + 1e-12));
        soil_near("work", p.dissipated, 3e3 * (p.strain[1] - 3e3 / (E * (1 - NU) / ((1 + NU) * (1 - 2 * NU)))), 3e3 * 2e-2);
        for (int n = 0; n < 50; n++) soil_point_step(&p, pull, stress, 1);
        for (int c = 0; c < 3; c++) soil_near("corner", p.stress[c], 3e3, 1e-6);
        soil_bench_close(b);
    }
}

enum { OUTSIDE, INSIDE, PLANE };

static void test_drucker_prager_meets_mohr_coulomb_where_it_is_matched(void **state) {
    (void)state;
    const double c = 1e4, side = 5e4;
    for (int phi = 0; phi <= 40; phi += 20)
        for (int match = OUTSIDE; match <= PLANE; match++)
            for (int full = 0; full < 2; full++) {
                const double psi = full ? phi : match == PLANE ? phi : phi / 4.0; /* in plane strain the match is that of associated flow */
                soil_bench *b =
                    soil_bench_make("drucker-prager", SOIL({"E", E}, {"nu", NU}, {"cohesion", c}, {"friction", phi * SOIL_DEGREE},
                                                           {"dilation", psi * SOIL_DEGREE}, {"match", match}));
                soil_point p = soil_point_of(b, 4);
                press(&p, side);
                squeeze(&p, side, match == PLANE, match == INSIDE ? -5e-4 : 1e-3, 300);
                const double wanted = match == INSIDE ? (side - 2 * c * sqrt(passive(phi))) / passive(phi) : strength(c, phi, side);
                soil_near("strength", -p.stress[1], wanted, (match == PLANE ? 1e-5 : 1e-7) * wanted + 1e-3);
                if (match == PLANE && phi > 0) { /* volume grows as by Mohr and Coulomb, too */
                    const double x = p.strain[0], y = p.strain[1];
                    squeeze(&p, side, true, 1e-3, 10);
                    soil_near("dilation", (p.strain[0] - x) / (y - p.strain[1]), passive(psi), 1e-3);
                }
                soil_bench_close(b);
            }
}

/* ---- softening ----------------------------------------------------------------------------------------------------------------------- */

static void test_softening_falls_linearly_to_the_residual(void **state) {
    (void)state;
    const double c = 1e4, rest = 2e3, end = 0.1, G = E / (2 * (1 + NU));
    soil_bench *b =
        soil_bench_make("tresca", SOIL({"E", E}, {"nu", NU}, {"cohesion", c}, {"residual_cohesion", rest}, {"softening_strain", end}));
    for (int steps = 10; steps <= 1000;
         steps *= 10) { /* the answer does not hang on the steps: the return is implicit and the law linear */
        soil_point p = soil_point_of(b, 4);
        double stress[6], work = 0;
        const double gamma = 0.3;
        for (int n = 0; n < steps; n++) {
            const double before = p.stress[3];
            soil_point_step(&p, (const double[6]){0, 0, 0, gamma / steps}, stress, 1);
            work += 0.5 * (before + stress[3]) * gamma / steps;
            /* tau = c + (rest - c) k/end with k = (gamma - tau/G)/sqrt(3) */
            const double total = gamma * (n + 1) / steps, slope = (c - rest) / (end * sqrt(3));
            const double tau = fmax((c - slope * total) / (1 - slope / G), rest);
            soil_near("shear stress", p.stress[3], fmin(tau, G * total), 1e-8 * c);
        }
        soil_near("residual", p.stress[3], rest, 1e-9 * c);
        soil_near("plastic strain", p.state[0], (gamma - rest / G) / sqrt(3), 1e-9);
        if (steps == 1000) soil_near("dissipated", p.dissipated, work - 0.5 * rest * rest / G, 1e-2 * work);
    }
    soil_bench_close(b);
    /* The work that a band takes down to its residual is the same for every thickness, with softening_slip. */
    const double slip = 0.02;
    for (double length = 0.05; length < 1; length *= 2) {
        b = soil_bench_make("tresca", SOIL({"E", 1e9}, {"nu", NU}, {"cohesion", c}, {"residual_cohesion", rest}, {"softening_slip", slip},
                                           {"length", length}));
        soil_point p = soil_point_of(b, 4);
        double stress[6];
        for (int n = 0; n < 4000; n++) soil_point_step(&p, (const double[6]){0, 0, 0, 2 * slip / length / 4000}, stress, 1);
        soil_near("work of a band", p.dissipated * length, slip * (0.5 * (c + rest) + rest), 2e-3 * slip * c);
        soil_bench_close(b);
    }
}

static void test_softening_friction_leaves_the_residual_strength(void **state) {
    (void)state;
    const double side = 5e4;
    static const char *const names[] = {"mohr-coulomb", "drucker-prager"};
    for (int n = 0; n < 2; n++) {
        soil_bench *b = soil_bench_make(names[n], SOIL({"E", E}, {"nu", NU}, {"cohesion", 1e4}, {"friction", 35 * SOIL_DEGREE},
                                                       {"dilation", 10 * SOIL_DEGREE}, {"residual_cohesion", 0},
                                                       {"residual_friction", 25 * SOIL_DEGREE}, {"residual_dilation", 0},
                                                       {"softening_strain", 0.2}, {n ? "match" : "nu", n ? OUTSIDE : NU}));
        soil_point p = soil_point_of(b, 4);
        press(&p, side);
        double peak = 0;
        for (int k = 0; k < 400; k++) {
            squeeze(&p, side, false, 1e-3, 1);
            peak = fmax(peak, -p.stress[1]);
        }
        assert_true(peak < strength(1e4, 35, side) && peak > 0.85 * strength(1e4, 35, side));
        soil_near("residual", -p.stress[1], strength(0, 25, side), 1e-7 * side);
        const double volume = p.strain[0] + p.strain[1] + p.strain[2];
        squeeze(&p, side, false, 1e-3, 10);
        soil_near("no more dilation", p.strain[0] + p.strain[1] + p.strain[2], volume, 1e-8);
        soil_bench_close(b);
    }
}

/* ---- what is refused ----------------------------------------------------------------------------------------------------------------- */

static void refused(const char *name, const soil_setting *settings, const char *why) {
    soil_bench *b = soil_bench_open(name);
    assert_true(soil_create(b, settings) < 0);
    if (!strstr(b->service.message, why)) fail_msg("'%s' does not say '%s'", b->service.message, why);
    soil_bench_close(b);
}

static void test_what_cannot_be_is_refused_by_name(void **state) {
    (void)state;
    static const char *const names[] = {"mohr-coulomb", "drucker-prager"};
    const double d = SOIL_DEGREE;
    for (int n = 0; n < 2; n++) {
        refused(names[n], SOIL({"E", E}, {"nu", NU}, {"cohesion", 1}, {"friction", 20 * d}, {"dilation", 21 * d}), "would make energy");
        refused(names[n], SOIL({"E", E}, {"nu", NU}, {"cohesion", 0}, {"friction", 0}), "neither cohesion nor friction");
        refused(names[n],
                SOIL({"E", E}, {"nu", NU}, {"cohesion", 1}, {"friction", 20 * d}, {"residual_cohesion", 2}, {"softening_strain", 1}),
                "above the cohesion");
        refused(names[n],
                SOIL({"E", E}, {"nu", NU}, {"cohesion", 1}, {"friction", 20 * d}, {"residual_friction", 21 * d}, {"softening_strain", 1}),
                "above the friction");
        refused(names[n],
                SOIL({"E", E}, {"nu", NU}, {"cohesion", 1}, {"friction", 20 * d}, {"dilation", 9 * d}, {"residual_dilation", 10 * d},
                     {"softening_strain", 1}),
                "above the dilation");
        refused(names[n],
                SOIL({"E", E}, {"nu", NU}, {"cohesion", 1}, {"friction", 20 * d}, {"dilation", 9 * d}, {"residual_friction", 8 * d},
                     {"softening_strain", 1}),
                "at the residual");
        refused(names[n],
                SOIL({"E", E}, {"nu", NU}, {"cohesion", 1e4}, {"friction", 20 * d}, {"residual_cohesion", 0}, {"softening_strain", 1e-4}),
                "faster than elasticity can unload");
    }
    refused("mohr-coulomb", SOIL({"E", E}, {"nu", NU}, {"cohesion", 0}, {"friction", 20 * d}, {"tension", 1}), "apex");
    refused("mohr-coulomb", SOIL({"E", E}, {"nu", NU}, {"cohesion", 1e4}, {"friction", 45 * d}, {"tension", 1.0001e4}), "apex");
    const soil_setting clay[] = {{"E", E}, {"nu", NU}, {"cohesion", 1e4}};
    refused("tresca", SOIL(clay[0], clay[1], clay[2], {"residual_cohesion", 1e3}), "at which plastic strain");
    refused("tresca", SOIL(clay[0], clay[1], clay[2], {"softening_strain", 1}), "no residual");
    refused("tresca",
            SOIL(clay[0], clay[1], clay[2], {"residual_cohesion", 1e3}, {"softening_strain", 1}, {"softening_slip", 1}, {"length", 1}),
            "twice");
    refused("tresca", SOIL(clay[0], clay[1], clay[2], {"residual_cohesion", 1e3}, {"softening_slip", 1}), "needs length");
    refused("tresca", SOIL(clay[0], clay[1], clay[2], {"residual_cohesion", 1e3}, {"softening_strain", 1}, {"length", 1}),
            "softening_slip, which is not given");
    refused("tresca", SOIL(clay[0], clay[1], clay[2], {"residual_cohesion", 1e3}, {"softening_strain", 0}), "above 0");
}

static void test_a_strain_that_is_not_a_number_is_flagged_and_said(void **state) {
    (void)state;
    static const char *const names[] = {"mohr-coulomb", "drucker-prager"};
    static const double bad[] = {NAN, INFINITY, -INFINITY, 1e300};
    for (int n = 0; n < 2; n++)
        for (int components = 4; components <= 6; components += 2)
            for (int k = 0; k < 4; k++) {
                soil_bench *b = soil_bench_make(names[n], SOIL({"E", E}, {"nu", NU}, {"cohesion", 1e4}, {"friction", 30 * SOIL_DEGREE}));
                b->strain[8 * (k % 4) + 5] = bad[k];
                assert_true(soil_bench_update(b, components, 8, 8) < 0);
                for (int i = 0; i < 8; i++) assert_int_equal(b->flag[i], i == 5);
                for (int c = 0; c < components; c++)
                    for (int i = 0; i < 8; i++) assert_true(b->stress1[c * 8 + i] == 0);
                assert_non_null(strstr(b->service.message, "not a number"));
                soil_bench_close(b);
            }
}

/* ---- batches ------------------------------------------------------------------------------------------------------------------------- */

/* n items at once or one by one: the same bits; old state is only read; nothing is written beside the output. */
static void test_a_batch_of_soils_is_its_items(void **state) {
    (void)state;
    enum { MC, DP, CLAY, LAWS };
    static const char *const names[LAWS] = {"mohr-coulomb", "drucker-prager", "modified-cam-clay"};
    const soil_setting *const laws[LAWS] = {SOIL({"E", E}, {"nu", NU}, {"cohesion", 1e4}, {"friction", 30 * SOIL_DEGREE},
                                                 {"dilation", 10 * SOIL_DEGREE}, {"tension", 3e3}, {"residual_cohesion", 1e3},
                                                 {"softening_strain", 0.05}),
                                            SOIL({"E", E}, {"nu", NU}, {"cohesion", 1e4}, {"friction", 30 * SOIL_DEGREE},
                                                 {"residual_friction", 20 * SOIL_DEGREE}, {"softening_strain", 0.05}, {"match", 2}),
                                            SOIL({"kappa", 0.02}, {"lambda", 0.1}, {"M", 1.1}, {"nu", 0.25}, {"void_ratio", 0.9},
                                                 {"pressure", 1e5}, {"overconsolidation", 1.3})};
    for (int law = 0; law < LAWS; law++)
        for (int components = 4; components <= 6; components += 2) {
            soil_bench *many = soil_bench_make(names[law], laws[law]), *one = soil_bench_make(names[law], laws[law]),
                       *before = malloc(sizeof *before);
            const size_t states = law == CLAY ? 3 : 1;
            for (size_t count = 1; count <= SOIL_MOST; count += count < 20 ? 1 : 7) {
                const size_t ld = count <= 8 ? 8 : SOIL_MOST;
                for (size_t j = 0; j < 6 * SOIL_MOST; j++) {
                    many->strain[j] = soil_uniform(-0.01, 0.01);
                    many->stress0[j] = (j / ld < 3 ? -1e5 : 0) + soil_uniform(-3e4, 3e4);
                    many->stress1[j] = -77;
                }
                for (size_t j = 0; j < SOIL_STATES * SOIL_MOST; j++)
                    many->state0[j] = law != CLAY   ? soil_uniform(0, 0.06)
                                      : j / ld == 0 ? soil_uniform(1e5, 2e5)
                                                    : soil_uniform(0.7, 1),
                    many->state1[j] = -77;
                for (size_t j = 0; j < SOIL_MOST; j++) many->dissipation[j] = many->speed[j] = -77;
                memcpy(before, many, sizeof *before);
                assert_int_equal(soil_bench_update(many, components, count, ld), 0);
                assert_memory_equal(before->strain, many->strain, sizeof many->strain);
                assert_memory_equal(before->stress0, many->stress0, sizeof many->stress0);
                assert_memory_equal(before->state0, many->state0, sizeof many->state0);
                for (size_t j = 0; j < 6 * SOIL_MOST; j++)
                    assert_int_equal(many->stress1[j] == -77, j % ld >= count || j / ld >= (size_t)components);
                for (size_t j = 0; j < SOIL_STATES * SOIL_MOST; j++)
                    assert_int_equal(many->state1[j] == -77, j % ld >= count || j / ld >= states);
                for (size_t j = 0; j < SOIL_MOST; j++) assert_int_equal(many->dissipation[j] == -77 && many->speed[j] == -77, j >= count);
                for (size_t i = 0; i < count; i++) {
                    for (size_t c = 0; c < (size_t)components; c++)
                        one->strain[c * 8] = many->strain[c * ld + i], one->stress0[c * 8] = many->stress0[c * ld + i];
                    for (size_t s = 0; s < states; s++) one->state0[s * 8] = many->state0[s * ld + i];
                    assert_int_equal(soil_bench_update(one, components, 1, 8), 0);
                    for (size_t c = 0; c < (size_t)components; c++)
                        assert_memory_equal(&one->stress1[c * 8], &many->stress1[c * ld + i], sizeof(double));
                    for (size_t s = 0; s < states; s++) assert_memory_equal(&one->state1[s * 8], &many->state1[s * ld + i], sizeof(double));
                    assert_memory_equal(one->dissipation, &many->dissipation[i], sizeof(double));
                    assert_memory_equal(one->speed, &many->speed[i], sizeof(double));
                }
            }
            free(before);
            soil_bench_close(many);
            soil_bench_close(one);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_principal_values_and_directions_make_the_tensor_again),
        cmocka_unit_test(test_triaxial_compression_and_extension_reach_the_strength_and_dilate_by_psi),
        cmocka_unit_test(test_plane_strain_compression_reaches_the_strength_with_the_middle_stress_between),
        cmocka_unit_test(test_simple_shear_reaches_the_strength_of_davis),
        cmocka_unit_test(test_tresca_is_mohr_coulomb_without_friction),
        cmocka_unit_test(test_apex_and_cut_off_bear_no_more_tension),
        cmocka_unit_test(test_drucker_prager_meets_mohr_coulomb_where_it_is_matched),
        cmocka_unit_test(test_softening_falls_linearly_to_the_residual),
        cmocka_unit_test(test_softening_friction_leaves_the_residual_strength),
        cmocka_unit_test(test_what_cannot_be_is_refused_by_name),
        cmocka_unit_test(test_a_strain_that_is_not_a_number_is_flagged_and_said),
        cmocka_unit_test(test_a_batch_of_soils_is_its_items),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
