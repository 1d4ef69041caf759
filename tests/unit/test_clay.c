/* test_clay.c: modified Cam clay: isotropic lines, drained and undrained paths to the critical state against closed forms and against
 * rates integrated by Runge and Kutta, the return from random states, closed cycles, what is refused. */
#include "effort.h"
#include "soil_bench.h"

static const double KAPPA = 0.05, LAMBDA = 0.2, SLOPE = 1.0, VOID = 1.2, PRESSURE = 1e5, SHEAR = 4e6;
enum { PC, VOIDS, SLID };

static soil_bench *clay(double overconsolidation, bool constant) {
    return soil_bench_make("modified-cam-clay",
                           SOIL({"kappa", KAPPA}, {"lambda", LAMBDA}, {"M", SLOPE}, {"void_ratio", VOID}, {"pressure", PRESSURE},
                                {"overconsolidation", overconsolidation}, {constant ? "G" : "nu", constant ? SHEAR : 0.25}));
}

static double mean(const soil_point *p) { return -(p->stress[0] + p->stress[1] + p->stress[2]) / 3; }
static double deviator(const soil_point *p) {
    const double *s = p->stress, a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
    return sqrt(0.5 * (a * a + b * b + c * c) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

static void go(soil_point *p, const double strain[6], int steps) {
    double stress[6];
    for (int n = 0; n < steps; n++) soil_point_step(p, strain, stress, 1);
}

static void test_isotropic_loading_follows_both_lines_exactly(void **state) {
    (void)state;
    for (int constant = 0; constant < 2; constant++)
        for (int ratio = 1; ratio <= 4; ratio *= 2)
            for (double size = 1e-5; size < 0.1; size *= 10) {
                soil_bench *b = clay(ratio, constant);
                soil_point p = soil_point_of(b, 4);
                soil_near("start", mean(&p), PRESSURE, 1e-9);
                soil_near("wave speed", b->speed[0],
                          sqrt(((1 + VOID) * PRESSURE / KAPPA + 4.0 / 3 * (constant ? SHEAR : 0.6 * (1 + VOID) * PRESSURE / KAPPA)) / 2000),
                          1e-9);
                const int steps = (int)(0.4 / size) < 400 ? (int)(0.4 / size) : 400;
                const double v0 = 1 + VOID, total = size * steps, v1 = v0 * exp(-total), pc = ratio * PRESSURE;
                go(&p, (const double[6]){-size / 3, -size / 3, -size / 3}, steps);
                /* kappa up to pc, lambda from there on */
                const double elastic = PRESSURE * exp((v0 - v1) / KAPPA), left = v0 - v1 - KAPPA * log(ratio);
                const double wanted = elastic < pc ? elastic : pc * exp(left / LAMBDA);
                soil_near("loading", mean(&p), wanted, 1e-10 * wanted);
                soil_near("void ratio", p.state[VOIDS], v1 - 1, 1e-12);
                soil_near("preconsolidation", p.state[PC], fmax(pc, wanted), 1e-10 * wanted);
                soil_near("no shear", deviator(&p), 0, 1e-6);
                const double bulk = v1 * wanted / KAPPA;
                soil_near("wave speed", p.speed, sqrt((bulk + 4.0 / 3 * (constant ? SHEAR : 0.6 * bulk)) / 2000), constant ? 1e-7 : 1e-7);
                const double worked = p.dissipated;
                go(&p, (const double[6]){size / 6, size / 6, size / 6}, steps);
                soil_near("unloading", mean(&p), wanted * exp((v1 - v0 * exp(-total / 2)) / KAPPA), 1e-10 * wanted);
                soil_near("nothing lost on unloading", p.dissipated, worked, 0);
                go(&p, (const double[6]){-size / 6, -size / 6, -size / 6}, steps);
                soil_near("loading again", mean(&p), wanted, 1e-9 * wanted);
                soil_bench_close(b);
            }
}

/* With the volume kept, p = p0 ((M^2 + eta0^2)/(M^2 + eta^2))^(1 - kappa/lambda) from the yield point (p0, eta0) on, whatever the shape
 * of the test, up to eta = M (Roscoe and Burland 1968; Wood 1990, section 5.4). */
static void test_undrained_paths_follow_the_closed_form_to_the_critical_state(void **state) {
    (void)state;
    static const double ratios[] = {1, 1.5, 2.5, 8};
    static const double shapes[3][6] = {
        {0.5e-4, -1e-4, 0.5e-4}, {1e-4, -1e-4, 0}, {0, 0, 0, 2e-4}}; /* triaxial, plane strain, simple shear */
    const double power = 1 - KAPPA / LAMBDA;
    for (size_t r = 0; r < sizeof ratios / sizeof *ratios; r++)
        for (int shape = 0; shape < 3; shape++)
            for (int constant = 0; constant < 2; constant++) {
                soil_bench *b = clay(ratios[r], constant);
                soil_point p = soil_point_of(b, 4);
                const double eta0 = SLOPE * sqrt(ratios[r] - 1);
                double worst = 0;
                for (int n = 0; n < 10000; n++) {
                    go(&p, shapes[shape], 1);
                    const double eta = deviator(&p) / mean(&p);
                    const double path =
                        p.state[SLID] > 0 ? PRESSURE * pow((SLOPE * SLOPE + eta0 * eta0) / (SLOPE * SLOPE + eta * eta), power) : PRESSURE;
                    worst = fmax(worst, fabs(mean(&p) / path - 1));
                }
                const double end = PRESSURE * pow(ratios[r] / 2, power);
                soil_near("path", worst, 0, 2e-3); /* by the steps: 1e-4 of strain */
                soil_near("p at the critical state", mean(&p), end, 2e-3 * end);
                soil_near("q at the critical state", deviator(&p), SLOPE * end, 2e-3 * end);
                if (shape == 2) soil_near("undrained strength", p.stress[3], SLOPE * end / sqrt(3), 2e-3 * end);
                soil_near("volume", p.state[VOIDS], VOID, 1e-12);
                soil_bench_close(b);
            }
}

/* Under a constant lateral pressure dq = 3 dp: p = 3 p0/(3 - M) at the end, and the specific volume is that of the critical state line
 * there. */
static void test_drained_triaxial_ends_on_the_critical_state_line(void **state) {
    (void)state;
    for (int ratio = 1; ratio <= 9; ratio *= 3) {
        soil_bench *b = clay(ratio, true);
        soil_point p = soil_point_of(b, 6);
        double strain[6] = {0, -1e-3}, peak = 0;
        for (int n = 0; n < 2500; n++) {
            soil_point_mixed(&p, strain, (const int[6]){1}, true, (const double[6]){-PRESSURE}, PRESSURE);
            peak = fmax(peak, deviator(&p));
            soil_near("dq = 3 dp", deviator(&p), 3 * (mean(&p) - PRESSURE), 1e-6 * PRESSURE);
        }
        const double end = 3 * PRESSURE / (3 - SLOPE), pc = ratio * PRESSURE;
        const double N = 1 + VOID + KAPPA * log(1.0 / ratio) + LAMBDA * log(pc),
                     critical = N - (LAMBDA - KAPPA) * log(2) - LAMBDA * log(end);
        soil_near("q", deviator(&p), SLOPE * end, 3e-3 * end);
        soil_near("specific volume", 1 + p.state[VOIDS], critical, 3e-3);
        if (ratio == 1) assert_true(peak <= SLOPE * end * 1.003); /* no peak */
        if (ratio == 9) assert_true(peak > SLOPE * end * 1.3);    /* a peak, and softening */
        soil_bench_close(b);
    }
}

/* ---- rates, integrated independently ------------------------------------------------------------------------------------------------- */

typedef struct rates {
    double s[4], p, pc, v; /* deviator xx, yy, zz, xy */
} rates;

static rates rate(const rates *x, const double strain[4], double unit) { /* while it yields; unit: share of the strain per time */
    const double squeezed = -(strain[0] + strain[1] + strain[2]) * unit, K = x->v * x->p / KAPPA, fp = 2 * x->p - x->pc, m2 = SLOPE * SLOPE;
    double e[4], se = 0, ss = 0;
    for (int c = 0; c < 4; c++) {
        e[c] = c < 3 ? strain[c] * unit + squeezed / 3 : 0.5 * strain[3] * unit;
        se += (c < 3 ? 1 : 2) * x->s[c] * e[c], ss += (c < 3 ? 1 : 2) * x->s[c] * x->s[c];
    }
    const double above = fp * K * squeezed + 6 * SHEAR / m2 * se;
    const double below = K * fp * fp + 18 * SHEAR / (m2 * m2) * ss + x->p * x->pc * x->v * fp / (LAMBDA - KAPPA);
    const double flow = fmax(above / below, 0);
    rates d = {.p = K * (squeezed - flow * fp), .pc = x->pc * x->v / (LAMBDA - KAPPA) * flow * fp, .v = -x->v * squeezed};
    for (int c = 0; c < 4; c++) d.s[c] = 2 * SHEAR * (e[c] - flow * 3 / m2 * x->s[c]);
    return d;
}

static rates ahead(const rates *x, const rates *d, double t) {
    rates y = {.p = x->p + t * d->p, .pc = x->pc + t * d->pc, .v = x->v + t * d->v};
    for (int c = 0; c < 4; c++) y.s[c] = x->s[c] + t * d->s[c];
    return y;
}

static void runge_kutta(rates *x, const double strain[4], int steps) {
    const double h = 1.0 / steps;
    for (int n = 0; n < steps; n++) {
        const rates a = rate(x, strain, 1), xa = ahead(x, &a, h / 2), b = rate(&xa, strain, 1), xb = ahead(x, &b, h / 2);
        const rates c = rate(&xb, strain, 1), xc = ahead(x, &c, h), d = rate(&xc, strain, 1);
        const rates y1 = ahead(x, &a, h / 6), y2 = ahead(&y1, &b, h / 3), y3 = ahead(&y2, &c, h / 3);
        *x = ahead(&y3, &d, h / 6);
    }
}

static void test_any_path_converges_to_the_rates(void **state) {
    (void)state;
    static const double paths[][4] = {{0, -0.05, 0, 0}, {0.03, -0.05, 0, 0.04}, {-0.02, -0.03, -0.01, 0.08}, {-0.05, 0.02, 0, 0.05}};
    for (size_t k = 0; k < sizeof paths / sizeof *paths; k++) {
        rates x = {.p = PRESSURE, .pc = PRESSURE, .v = 1 + VOID};
        x.s[3] = 1e-6 * PRESSURE;
        runge_kutta(&x, paths[k], 20000);
        double last = INFINITY;
        for (int steps = 10; steps <= 1000; steps *= 10) {
            soil_bench *b = clay(1, true);
            soil_point p = soil_point_of(b, 4);
            double strain[6] = {0};
            for (int c = 0; c < 4; c++) strain[c] = paths[k][c] / steps;
            go(&p, strain, steps);
            double off = fabs(mean(&p) - x.p);
            for (int c = 0; c < 4; c++) off = fmax(off, fabs(p.stress[c] + (c < 3 ? mean(&p) : 0) - x.s[c]));
            off = fmax(off, fabs(p.state[PC] - x.pc)) / x.p;
            assert_true(off < 0.15 * last || off < 1e-3);
            last = off;
            soil_near("void ratio", 1 + p.state[VOIDS], x.v, 1e-9);
            soil_bench_close(b);
        }
        soil_near("stress after a thousand steps", last, 0, 1e-3);
    }
}

/* ---- closed cycles, random states, refusals ------------------------------------------------------------------------------------------ */

/* Around a loop of pressure and shear inside the surface: with a constant G there is an energy, and nothing is made or lost; with nu
 * there is none (Zytynski et al. 1978), which docs/materials.md says. */
static void test_an_elastic_loop_makes_no_energy_with_a_constant_shear_modulus(void **state) {
    (void)state;
    for (int constant = 0; constant < 2; constant++) {
        double net[2] = {0};
        for (int fine = 0; fine < 2; fine++) {
            soil_bench *b = clay(4, constant);
            soil_point p = soil_point_of(b, 4);
            const int steps = fine ? 4000 : 1000;
            const double two_pi = 6.283185307179586;
            double moved = 0, old = PRESSURE;
            for (int n = 0; n < steps; n++) {
                double strain[6] = {0}, before[6], work = 0;
                const double a = two_pi * n / steps, c = two_pi * (n + 1) / steps;
                strain[0] = strain[1] = strain[2] = -4e-3 * (sin(c) - sin(a));
                strain[3] = 8e-3 * (cos(a) - cos(c));
                memcpy(before, p.stress, sizeof before);
                go(&p, strain, 1);
                for (int k = 0; k < 4; k++) work += 0.5 * (before[k] + p.stress[k]) * strain[k];
                net[fine] += work;
                moved += fabs(work);
            }
            assert_true(p.dissipated == 0);
            soil_near("pressure after the loop", mean(&p), old, 1e-9 * old);
            net[fine] /= moved;
            soil_bench_close(b);
        }
        if (constant) {
            soil_near("energy of a loop", net[1], 0, 1e-7);
            assert_true(fabs(net[1]) < 0.1 * fabs(net[0]) + 1e-12);
        } else {
            assert_true(fabs(net[1]) > 1e-3);
        }
    }
}

static void test_clay_returns_to_its_surface_from_anywhere(void **state) {
    (void)state;
    static const double soils[][4] = {{0.05, 0.2, 1.0, 0.25}, {0.002, 0.3, 1.4, 0.45}, {0.19, 0.2, 0.5, 0}, {0.02, 0.1, 2.5, -0.5}};
    size_t plastic = 0, dry = 0, refused = 0, total = 0;
    for (size_t k = 0; k < sizeof soils / sizeof *soils; k++)
        for (int constant = 0; constant < 2; constant++)
            for (int components = 4; components <= 6; components += 2) {
                const double kappa = soils[k][0], lambda = soils[k][1], M = soils[k][2];
                soil_bench *b = soil_bench_make("modified-cam-clay", SOIL({"kappa", kappa}, {"lambda", lambda}, {"M", M},
                                                                          {constant ? "G" : "nu", constant ? 1e7 : soils[k][3]},
                                                                          {"void_ratio", 1}, {"pressure", 1e5}));
                for (int round = 0; round < EFFORT(1000, 50); round++) {
                    const size_t ld = SOIL_MOST;
                    for (size_t i = 0; i < ld; i++) {
                        const double size = pow(10, soil_uniform(-9, round % 5 == 0 ? 0.5 : -2)), pc = 1e5 * pow(10, soil_uniform(-2, 2));
                        const double p = pc * soil_uniform(0, 1) * (round % 7 ? 1 : 1e-6), q = M * sqrt(p * (pc - p)) * soil_uniform(0, 1);
                        double s[6] = {0}, square = 0;
                        const bool again = round % 4 && !b->flag[i];
                        for (int c = 0; c < components; c++)
                            s[c] = i % 9 ? soil_uniform(-1, 1) : 0, b->strain[(size_t)c * ld + i] = size * soil_uniform(-1, 1);
                        if (i % 5 == 0) b->strain[ld + i] = b->strain[2 * ld + i] = b->strain[i], b->strain[3 * ld + i] = 0;
                        const double middle = (s[0] + s[1] + s[2]) / 3;
                        for (int c = 0; c < 3; c++) s[c] -= middle;
                        for (int c = 0; c < 6; c++) square += (c < 3 ? 1.5 : 3) * s[c] * s[c];
                        for (int c = 0; c < components; c++)
                            b->stress0[(size_t)c * ld + i] =
                                again ? b->stress1[(size_t)c * ld + i] : (c < 3 ? -p : 0) + (square > 0 ? s[c] * q / sqrt(square) : 0);
                        b->state0[i] = again ? b->state1[i] : pc;
                        b->state0[ld + i] = again ? b->state1[ld + i] : soil_uniform(0.3, 3);
                        b->state0[2 * ld + i] = 0;
                    }
                    soil_bench_update(b, components, ld, ld);
                    for (size_t i = 0; i < ld; i++, total++) {
                        const double volume = b->strain[i] + b->strain[ld + i] + b->strain[2 * ld + i],
                                     v = (1 + b->state0[ld + i]) * exp(volume);
                        double s[6] = {0};
                        for (int c = 0; c < components; c++) s[c] = b->stress1[(size_t)c * ld + i];
                        for (int c = 0; c < 6; c++) assert_true(isfinite(s[c]));
                        assert_true(isfinite(b->speed[i]) && b->speed[i] > 0 && b->dissipation[i] >= 0 && isfinite(b->dissipation[i]));
                        if (b->flag[i]) {
                            refused++;
                            assert_true(v <= 1.0 + 1e-9 || (1 + b->state0[ld + i] - v) / kappa > 300); /* or p grows by exp(300): absurd */
                            continue;
                        }
                        const double p = -(s[0] + s[1] + s[2]) / 3, x = s[0] + p, y = s[1] + p, z = s[2] + p, pc = b->state1[i];
                        const double q2 = 1.5 * (x * x + y * y + z * z) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]),
                                     f = q2 / (M * M) + p * (p - pc);
                        assert_true(isfinite(pc) && pc > 0);
                        if (!(f <= 1e-10 * pc * pc)) fail_msg("outside by %g", f / pc / pc);
                        double square = 0;
                        for (int c = 0; c < components; c++)
                            square += (c < 3 ? 1 : 0.5) * b->strain[(size_t)c * ld + i] * b->strain[(size_t)c * ld + i];
                        /* A longer step goes in parts, and may come back inside. */
                        const bool at_once = sqrt(square) * (1 + b->state0[ld + i]) <= 0.0999 * kappa;
                        if (at_once && b->state1[2 * ld + i] > 0 && !(fabs(f) <= 1e-10 * pc * pc))
                            fail_msg("flowed, and is inside by %g", f / pc / pc);
                        if (!(p >= -1e-12 * pc)) fail_msg("tension %g at pc %g", -p, pc);
                        soil_near("specific volume", 1 + b->state1[ld + i], v, 1e-10 * v);
                        plastic += b->state1[2 * ld + i] > 0, dry += pc < b->state0[i] * (1 - 1e-6);
                    }
                }
                soil_bench_close(b);
            }
    assert_true(total > EFFORT(1000000, 50000) && plastic > total / 5 && dry > total / 50 && refused > 5 && refused < total / 10);
}

static void refused(const soil_setting *settings, const char *why) {
    soil_bench *b = soil_bench_open("modified-cam-clay");
    assert_true(soil_create(b, settings) < 0);
    if (!strstr(b->service.message, why)) fail_msg("'%s' does not say '%s'", b->service.message, why);
    soil_bench_close(b);
}

static void test_clay_that_cannot_be_is_refused_by_name(void **state) {
    (void)state;
    refused(SOIL({"kappa", 0.1}, {"lambda", 0.1}, {"M", 1}, {"void_ratio", 1}, {"pressure", 1}, {"nu", 0.2}), "not above kappa");
    refused(SOIL({"kappa", 0.1}, {"lambda", 0.2}, {"M", 1}, {"void_ratio", 1}, {"pressure", 1}), "give G or nu");
    refused(SOIL({"kappa", 0.1}, {"lambda", 0.2}, {"M", 1}, {"void_ratio", 1}, {"pressure", 1}, {"nu", 0.2}, {"G", 1}), "twice");
    refused(SOIL({"kappa", 0.1}, {"lambda", 0.2}, {"M", 1}, {"void_ratio", 1}, {"pressure", 1}, {"G", 0}), "above 0");
    soil_bench *b = clay(1, true);
    soil_bench_start(b, 4);
    for (int c = 0; c < 3; c++) b->strain[8 * c + 3] = -0.5;
    b->strain[6] = NAN;
    assert_true(soil_bench_update(b, 4, 8, 8) < 0);
    for (int i = 0; i < 8; i++) assert_int_equal(b->flag[i], i == 3 || i == 6);
    assert_non_null(strstr(b->service.message, "void ratio 0"));
    soil_bench_close(b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_isotropic_loading_follows_both_lines_exactly),
        cmocka_unit_test(test_undrained_paths_follow_the_closed_form_to_the_critical_state),
        cmocka_unit_test(test_drained_triaxial_ends_on_the_critical_state_line),
        cmocka_unit_test(test_any_path_converges_to_the_rates),
        cmocka_unit_test(test_an_elastic_loop_makes_no_energy_with_a_constant_shear_modulus),
        cmocka_unit_test(test_clay_returns_to_its_surface_from_anywhere),
        cmocka_unit_test(test_clay_that_cannot_be_is_refused_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
