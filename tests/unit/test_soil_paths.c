/* test_soil_paths.c: whole paths of Mohr and Coulomb's soils against closed forms, every step of them: elastic, the bend, what flows.
 * All begin at an isotropic pressure. */
#include "soil_bench.h"

static const double E = 1e7, NU = 0.3, START = 5e4; /* Pa */

typedef struct soil {
    const char *model;
    double c, phi, psi; /* degrees */
} soil;

static const soil SOILS[] = {{"mohr-coulomb", 1e4, 30, 10}, {"mohr-coulomb", 1e4, 30, 30}, {"mohr-coulomb", 0, 35, 0},
                             {"mohr-coulomb", 0, 35, 15},   {"mohr-coulomb", 2e3, 20, 5},  {"tresca", 2e4, 0, 0}};
enum { COUNT = sizeof SOILS / sizeof *SOILS };

static double sine(double degrees) { return sin(degrees * SOIL_DEGREE); }
static double cosine(double degrees) { return cos(degrees * SOIL_DEGREE); }

/* Axial pressure that is borne under START from the sides. */
static double strength(const soil *s) {
    const double k = (1 + sine(s->phi)) / (1 - sine(s->phi));
    return START * k + 2 * s->c * sqrt(k);
}

static soil_bench *make(const soil *s) {
    if (strcmp(s->model, "tresca") == 0) return soil_bench_make("tresca", SOIL({"E", E}, {"nu", NU}, {"cohesion", s->c}));
    return soil_bench_make("mohr-coulomb", SOIL({"E", E}, {"nu", NU}, {"cohesion", s->c}, {"friction", s->phi * SOIL_DEGREE},
                                                {"dilation", s->psi * SOIL_DEGREE}));
}

/* A point under START from all sides; strains count from there. */
static soil_point pressed(soil_bench *b, int components) {
    soil_point p = soil_point_of(b, components);
    for (int n = 0; n < 10; n++) {
        const double e = -START / 10 * (1 - 2 * NU) / E, strain[6] = {e, e, e};
        double stress[6];
        soil_point_step(&p, strain, stress, 1);
    }
    memset(p.strain, 0, sizeof p.strain);
    p.dissipated = 0;
    return p;
}

/* Squeezed along y by a = -strain under START from the sides. Triaxial: q = E a, lateral strain nu a each, to the strength; beyond,
 * all of it is plastic: the volume grows by 2 sin(psi)/(1 - sin(psi)) of it. Plane: q = E/(1 - nu^2) a, sigma_z = -START - nu q,
 * lateral nu/(1 - nu) a; beyond, (1 + sin(psi))/(1 - sin(psi)) of it. Dissipated: stress times plastic strain. */
static void squeezed(bool plane) {
    const double step = 1.7e-4;
    for (int k = 0; k < COUNT; k++)
        for (int components = 4; components <= 6; components += 2) {
            const soil *s = SOILS + k;
            soil_bench *b = make(s);
            soil_point p = pressed(b, components);
            const double modulus = plane ? E / (1 - NU * NU) : E, bears = strength(s), most = bears - START,
                         widens = (1 + sine(s->psi)) / (1 - sine(s->psi)) * (plane ? 1 : 0.5), elastic = plane ? NU / (1 - NU) : NU;
            double strain[6] = {0, -step};
            int flowed = 0;
            for (int n = 1; n <= 200; n++) {
                strain[1] = -step;
                soil_point_mixed(&p, strain, (const int[6]){1}, !plane, (const double[6]){-START}, START);
                const double a = n * step, q = fmin(modulus * a, most), before = q / modulus, plastic = a - before;
                flowed += plastic > 0;
                soil_near("axial stress", p.stress[1], -START - q, 1e-7 * bears);
                soil_near("middle stress", p.stress[2], plane ? -START - NU * q : -START, 1e-7 * bears);
                soil_near("lateral strain", p.strain[0], elastic * before + widens * plastic, 1e-7 * a + 1e-10);
                soil_near("dissipation", p.dissipated, (bears - (plane ? 1 : 2) * widens * START) * plastic, 1e-6 * bears * a + 1e-3);
            }
            assert_true(flowed > 50 && flowed < 199);
            soil_bench_close(b);
        }
}

static void test_triaxial_paths(void **state) {
    (void)state;
    squeezed(false);
}

static void test_plane_strain_paths(void **state) {
    (void)state;
    squeezed(true);
}

/* Simple shear under a pressure on the plane that stays. tau = G gamma as far as K = c cos(phi) + START sin(phi). Then, with t the
 * angle of the larger principal stress, (sigma_x - sigma_y)/2 = R cos(t), tau = R sin(t), R = K/(1 + sin(phi) cos(t)), and flow at the
 * rate l is l/2 (cos(t) + sin(psi)) along x, l sin(t) in shear. x keeps its length: (1 - nu)/(2 G) dsigma_x + l/2 (cos(t) + sin(psi))
 * = 0, so
 *     dgamma/dt = (dtau/dt)/G - sin(t) (1 - nu)/G (dsigma_x/dt)/(cos(t) + sin(psi)),   sigma_x = -START + 2 R cos(t),
 * from t = pi/2 on to cos(t) = -sin(psi), which is Davis' end (1968) and is never quite reached. */
static double slope(const soil *s, double t) {
    const double G = E / (2 * (1 + NU)), K = s->c * cosine(s->phi) + START * sine(s->phi), d = 1 + sine(s->phi) * cos(t);
    const double tau = K * (cos(t) + sine(s->phi)) / (d * d), x = -2 * K * sin(t) / (d * d);
    return tau / G - sin(t) * (1 - NU) / G * x / (cos(t) + sine(s->psi));
}

static double shear_at(const soil *s, double t) {
    enum { PIECES = 200 }; /* Simpson's rule */
    const double G = E / (2 * (1 + NU)), from = acos(0), h = (t - from) / PIECES;
    double sum = 0;
    for (int i = 0; i <= PIECES; i++) sum += (i == 0 || i == PIECES ? 1 : i % 2 ? 4 : 2) * slope(s, from + i * h);
    return (s->c * cosine(s->phi) + START * sine(s->phi)) / G + sum * h / 3;
}

/* Largest difference of the shear strain from that of the exact path where sigma_x is the same, over it; the path as far as 0.9 of the
 * way to its end. */
static double off_in_shear(const soil *s, int components, double step) {
    soil_bench *b = make(s);
    soil_point p = pressed(b, components);
    const double G = E / (2 * (1 + NU)), K = s->c * cosine(s->phi) + START * sine(s->phi);
    double strain[6] = {0}, worst = 0;
    int flowed = 0;
    for (int n = 1; n * step < 0.2; n++) {
        strain[3] = step;
        soil_point_mixed(&p, strain, (const int[6]){0, 1}, false, (const double[6]){0, -START}, START);
        const double gamma = n * step, u = (p.stress[0] + START) / (2 * K), cosine_t = u / (1 - u * sine(s->phi));
        if (G * gamma <= K) {
            soil_near("elastic shear", p.stress[3], G * gamma, 1e-7 * K);
            soil_near("nothing else", p.stress[0], -START, 1e-7 * START);
            continue;
        }
        if (cosine_t < -0.9 * sine(s->psi) || s->psi == 0) break;
        flowed++;
        const double t = acos(cosine_t);
        soil_near("strength on the way", p.stress[3], K * sin(t) / (1 + sine(s->phi) * cosine_t), 1e-7 * K);
        worst = fmax(worst, fabs(shear_at(s, t) - gamma) / gamma);
    }
    if (s->psi == 0) soil_near("without dilation that is all", p.stress[3], K, 1e-7 * K); /* cos(t) = 0 at once */
    assert_true(s->psi == 0 || flowed > 3);
    soil_bench_close(b);
    return worst;
}

static void test_simple_shear_paths(void **state) {
    (void)state;
    for (int k = 0; k < COUNT; k++)
        for (int components = 4; components <= 6; components += 2) {
            const double coarse = off_in_shear(SOILS + k, components, 4e-5), fine = off_in_shear(SOILS + k, components, 1e-5);
            if (!(coarse < 0.01 && fine <= 0.35 * coarse))
                fail_msg("soil %d: off by %g, with a quarter of the step by %g", k, coarse, fine);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_triaxial_paths),
        cmocka_unit_test(test_plane_strain_paths),
        cmocka_unit_test(test_simple_shear_paths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
