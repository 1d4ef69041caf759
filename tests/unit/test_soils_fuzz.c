/* test_soils_fuzz.c: soils from random states by random steps, a million times: never outside of the surface by more than 1e-10 of the
 * stress there, on it where something plastic happened, the flow where the flow rule allows it, nothing dissipated that is negative, and
 * no answer that is not a number.
 *
 * The scale of every tolerance is the larger of the stress that is left and of what the soil bears without pressure (2 c cos phi): not
 * the trial stress, which may be larger by many orders. Steps of strain go from 1e-9 to 1e6. */
#include "plugins/material/principal.h"
#include "soil_bench.h"

typedef struct soil_case {
    const char *name;
    double E, nu, c, phi, psi, T, residual_c, residual_phi, residual_psi, softening; /* degrees; negative: not given */
    int match;
} soil_case;

static const soil_case cases[] = {
    {"mohr-coulomb", 1e7, 0.3, 1e4, 30, 10, -1, -1, -1, -1, -1, 0},
    {"mohr-coulomb", 1e7, 0.3, 1e4, 30, 30, -1, -1, -1, -1, -1, 0},
    {"mohr-coulomb", 1e7, 0.3, 1e4, 30, 0, -1, -1, -1, -1, -1, 0},
    {"mohr-coulomb", 1e7, 0.0, 0, 35, 0, -1, -1, -1, -1, -1, 0},
    {"mohr-coulomb", 1e7, 0.49, 0, 35, 35, -1, -1, -1, -1, -1, 0},
    {"mohr-coulomb", 1e7, 0.3, 1e4, 0, 0, -1, -1, -1, -1, -1, 0},
    {"mohr-coulomb", 1e7, 0.3, 1e4, 1e-7, 0, -1, -1, -1, -1, -1, 0},
    {"mohr-coulomb", 1e7, 0.3, 1e-3, 60, 60, -1, -1, -1, -1, -1, 0},
    {"mohr-coulomb", 1e7, 0.3, 1e4, 89, 80, -1, -1, -1, -1, -1, 0},
    {"mohr-coulomb", 1e7, 0.3, 1e4, 30, 10, 3e3, -1, -1, -1, -1, 0},
    {"mohr-coulomb", 1e7, -0.4, 1e4, 30, 30, 3e3, -1, -1, -1, -1, 0},
    {"mohr-coulomb", 1e7, 0.3, 1e4, 30, 0, 0, -1, -1, -1, -1, 0},
    {"mohr-coulomb", 1e7, 0.3, 1e4, 30, 0, 1.73205e4, -1, -1, -1, -1, 0}, /* just below the apex */
    {"mohr-coulomb", 1e7, 0.3, 1e4, 30, 10, -1, 1e3, 20, 0, 0.05, 0},
    {"mohr-coulomb", 1e7, 0.3, 1e4, 30, 10, 3e3, 0, 25, 5, 0.05, 0},
    {"mohr-coulomb", 1e7, 0.3, 0, 40, 10, -1, -1, 30, 0, 0.2, 0},
    {"tresca", 1e7, 0.3, 1e4, 0, 0, -1, -1, -1, -1, -1, 0},
    {"tresca", 1e7, 0.499, 1e4, 0, 0, 2e3, -1, -1, -1, -1, 0},
    {"tresca", 1e7, 0.3, 1e4, 0, 0, -1, 1e3, -1, -1, 0.02, 0},
    {"drucker-prager", 1e7, 0.3, 1e4, 30, 10, -1, -1, -1, -1, -1, 0},
    {"drucker-prager", 1e7, 0.3, 1e4, 30, 30, -1, -1, -1, -1, -1, 1},
    {"drucker-prager", 1e7, 0.3, 1e4, 30, 0, -1, -1, -1, -1, -1, 2},
    {"drucker-prager", 1e7, 0.3, 0, 40, 40, -1, -1, -1, -1, -1, 0},
    {"drucker-prager", 1e7, 0.3, 1e4, 0, 0, -1, -1, -1, -1, -1, 2},
    {"drucker-prager", 1e7, 0.3, 1e4, 30, 10, -1, 1e3, 20, 5, 0.05, 2},
};
enum { CASES = sizeof cases / sizeof *cases };

static soil_bench *make(const soil_case *k) {
    soil_setting s[16];
    int n = 0;
    s[n++] = (soil_setting){"E", k->E}, s[n++] = (soil_setting){"nu", k->nu}, s[n++] = (soil_setting){"cohesion", k->c};
    if (strcmp(k->name, "tresca") != 0) {
        s[n++] = (soil_setting){"friction", k->phi * SOIL_DEGREE}, s[n++] = (soil_setting){"dilation", k->psi * SOIL_DEGREE};
        if (k->residual_phi >= 0) s[n++] = (soil_setting){"residual_friction", k->residual_phi * SOIL_DEGREE};
        if (k->residual_psi >= 0) s[n++] = (soil_setting){"residual_dilation", k->residual_psi * SOIL_DEGREE};
    }
    if (k->T >= 0) s[n++] = (soil_setting){"tension", k->T};
    if (k->residual_c >= 0) s[n++] = (soil_setting){"residual_cohesion", k->residual_c};
    if (k->softening >= 0) s[n++] = (soil_setting){"softening_strain", k->softening};
    if (strcmp(k->name, "drucker-prager") == 0) s[n++] = (soil_setting){"match", k->match};
    s[n] = (soil_setting){NULL, 0};
    return soil_bench_make(k->name, s);
}

typedef struct surface { /* at one plastic strain; the formulas of docs/materials.md, written once more */
    double c, phi, psi, T, scale;
} surface;

static surface surface_of(const soil_case *k, double plastic) {
    const double share = k->softening > 0 ? fmin(plastic / k->softening, 1) : 0;
    const double rc = k->residual_c >= 0 ? k->residual_c : k->c, rphi = k->residual_phi >= 0 ? k->residual_phi : k->phi;
    const double rpsi = k->residual_psi >= 0 ? k->residual_psi : k->psi;
    surface s = {.c = k->c + share * (rc - k->c)};
    s.phi = atan((1 - share) * tan(k->phi * SOIL_DEGREE) + share * tan(rphi * SOIL_DEGREE));
    s.psi = atan((1 - share) * tan(k->psi * SOIL_DEGREE) + share * tan(rpsi * SOIL_DEGREE));
    s.T = k->T >= 0 ? k->T * (k->c > 0 ? s.c / k->c : 1) : INFINITY;
    s.scale = 2 * s.c * cos(s.phi);
    return s;
}

/* How far outside, in Pa; every pair of principal stresses and every one against the cut-off. */
static double outside(const soil_case *k, const surface *f, const double sorted[3]) {
    if (strcmp(k->name, "drucker-prager") == 0) {
        const double p = (sorted[0] + sorted[1] + sorted[2]) / 3, a = sorted[0] - p, b = sorted[1] - p, c = sorted[2] - p;
        const double s = sin(f->phi), t = tan(f->phi);
        const double eta = k->match == 2 ? 3 * t / sqrt(9 + 12 * t * t) : 6 * s / (sqrt(3) * (3 + (k->match ? s : -s)));
        const double xi = k->match == 2 ? 3 / sqrt(9 + 12 * t * t) : 6 * cos(f->phi) / (sqrt(3) * (3 + (k->match ? s : -s)));
        return sqrt(0.5 * (a * a + b * b + c * c)) + eta * p - xi * f->c;
    }
    const double slip = (sorted[0] - sorted[2]) + (sorted[0] + sorted[2]) * sin(f->phi) - 2 * f->c * cos(f->phi);
    return fmax(slip, sorted[0] - f->T);
}

/* Whether the plastic strain is one that the faces which the stress lies on allow: no other stress that is inside of all their
 * potentials would take more work from it (von Mises 1928, for the potential in place of the surface). In the principal directions of
 * the trial stress. */
static void flow_is_allowed(const soil_case *k, const surface *f, const double s[3], const double plastic[3], double size) {
    const double scale = fmax(f->scale, fmax(fabs(s[0]), fabs(s[2]))), flow = fabs(plastic[0]) + fabs(plastic[1]) + fabs(plastic[2]);
    for (int n = 0; n < 12; n++) {
        double d[3], length = 0;
        for (int c = 0; c < 3; c++) d[c] = soil_uniform(-1, 1), length = fmax(length, fabs(d[c]));
        if (n % 3 == 0) d[0] = d[1] = d[2] = soil_uniform(-1, 1);               /* at an apex there may be no other */
        int allowed = !(s[0] - s[2] <= 1e-8 * scale && d[0] + d[1] + d[2] > 0); /* without dilation the apex takes any volume */
        for (int i = 0; i < 3; i++) {
            if (s[i] - f->T >= -1e-8 * scale && d[i] > 0) allowed = 0;
            for (int j = 0; j < 3; j++)
                if (i != j && (s[i] - s[j]) + (s[i] + s[j]) * sin(f->phi) - f->scale >= -1e-8 * scale &&
                    (d[i] - d[j]) + (d[i] + d[j]) * sin(f->psi) > 0)
                    allowed = 0;
        }
        if (!allowed) continue;
        const double work = d[0] * plastic[0] + d[1] * plastic[1] + d[2] * plastic[2];
        if (!(work <= 1e-7 * flow + 1e-13 * size))
            fail_msg("%s c %g phi %g psi %g T %g: stress %.6g %.6g %.6g does not flow by %.6g %.6g %.6g (direction %.3g %.3g %.3g)",
                     k->name, k->c, k->phi, k->psi, k->T, s[0], s[1], s[2], plastic[0], plastic[1], plastic[2], d[0], d[1], d[2]);
    }
}

typedef struct tally {
    size_t elastic, plastic, ordered[3], apex; /* faces; edges with the first two, the last two equal; all equal */
} tally;

static void one(const soil_case *k, const soil_bench *b, int components, size_t i, size_t ld, tally *t) {
    double trial[6] = {0}, stress[6] = {0}, size = 0;
    const double G = k->E / (2 * (1 + k->nu)), K = k->E / (3 * (1 - 2 * k->nu)), lambda = K - 2 * G / 3;
    const double volume = b->strain[i] + b->strain[ld + i] + b->strain[2 * ld + i];
    for (int c = 0; c < components; c++) {
        const size_t at = (size_t)c * ld + i;
        trial[c] = b->stress0[at] + (c < 3 ? lambda * volume + 2 * G * b->strain[at] : G * b->strain[at]);
        stress[c] = b->stress1[at];
        size = fmax(size, fabs(trial[c]));
        if (!isfinite(stress[c])) fail_msg("%s: a stress is %g", k->name, stress[c]);
    }
    const double kappa = b->state1[i], gained = kappa - b->state0[i], dissipation = b->dissipation[i];
    assert_true(isfinite(kappa) && isfinite(dissipation) && gained >= 0 && dissipation >= 0);
    const surface f = surface_of(k, kappa);
    principal p, q;
    principal_of(stress, components == 4, &p);
    const double scale = fmax(f.scale, fmax(fabs(p.value[0]), fabs(p.value[2]))), off = outside(k, &f, p.value);
    if (!(off <= 1e-10 * scale))
        fail_msg("%s c %g phi %g psi %g T %g: outside by %g of %g after a trial of %g", k->name, k->c, k->phi, k->psi, k->T, off, scale,
                 size);
    int moved = 0;
    for (int c = 0; c < components; c++) moved |= fabs(trial[c] - stress[c]) > 1e-9 * size + 1e-9 * scale;
    if (!moved) {
        t->elastic++;
        return;
    }
    t->plastic++;
    if (!(off >= -1e-10 * scale))
        fail_msg("%s c %g phi %g T %g: flowed, and is inside by %g of %g", k->name, k->c, k->phi, k->T, off, scale);
    t->ordered[p.value[0] - p.value[1] <= 1e-9 * scale ? 1 : p.value[1] - p.value[2] <= 1e-9 * scale ? 2 : 0]++;
    t->apex += p.value[0] - p.value[2] <= 1e-9 * scale;
    /* Plastic strain in the directions of the trial stress, which the return keeps. */
    principal_of(trial, components == 4, &q);
    double plastic[3], lost = 0, work = 0, dev = 0;
    for (int c = 0; c < 3; c++) lost += q.value[c] - p.value[c];
    for (int c = 0; c < 3; c++)
        plastic[c] = (q.value[c] - p.value[c] - lost / 3) / (2 * G) + lost / (9 * K), work += p.value[c] * plastic[c];
    for (int c = 0; c < 3; c++) dev += (plastic[c] - lost / (9 * K)) * (plastic[c] - lost / (9 * K));
    const double rounding = 1e-13 * (size + scale) / G;
    soil_near("dissipation", dissipation, work, 1e-9 * fabs(work) + scale * rounding);
    soil_near("plastic strain", gained, sqrt(2.0 / 3 * dev), 1e-9 * sqrt(dev) + 1e-12 * kappa + rounding);
    if (strcmp(k->name, "drucker-prager") != 0) flow_is_allowed(k, &f, p.value, plastic, (size + scale) / G);
}

/* Fills item i: a state from an earlier step or a random one, also special ones (all principal stresses equal, two equal, none), and a
 * step of any size. */
static void fill(const soil_case *k, soil_bench *b, int components, size_t i, size_t ld, int again) {
    const double G = k->E / (2 * (1 + k->nu)), strength = k->c > 0 ? k->c : 1e3;
    const double size = pow(10, soil_uniform(0, 1) < 0.9 ? soil_uniform(-9, 0) : soil_uniform(0, 6)),
                 stress = strength * pow(10, soil_uniform(-3, 3));
    const int kind = (int)soil_uniform(0, 8);
    for (int c = 0; c < components; c++) {
        const size_t at = (size_t)c * ld + i;
        b->strain[at] = size * soil_uniform(-1, 1);
        if (again)
            b->stress0[at] = b->stress1[at];
        else
            b->stress0[at] = kind == 0  ? 0
                             : c < 3    ? stress * soil_uniform(-1, kind > 5 ? -0.9 : 0.3)
                             : kind < 3 ? 0
                                        : 0.3 * stress * soil_uniform(-1, 1);
    }
    if (!again && kind == 1) b->stress0[ld + i] = b->stress0[2 * ld + i] = b->stress0[i]; /* one point of the axis */
    if (!again && kind == 2) b->stress0[ld + i] = b->stress0[i];
    if (kind == 3) b->strain[ld + i] = b->strain[2 * ld + i] = b->strain[i], b->strain[3 * ld + i] = 0; /* towards or away from the apex */
    if (kind == 4) b->strain[ld + i] = b->strain[i], b->strain[3 * ld + i] = 0;                         /* triaxial */
    if (kind == 5) b->strain[2 * ld + i] = 0;                                                           /* plane strain */
    if (kind == 6 && components == 6) b->strain[4 * ld + i] = b->strain[5 * ld + i] = 0;
    b->state0[i] = again ? b->state1[i] : k->softening > 0 ? soil_uniform(0, 1.3) * k->softening : 0;
    if (!again && kind == 7) { /* the trial stress of equal principal stresses, whatever stood before */
        for (int c = 0; c < components; c++) b->strain[(size_t)c * ld + i] = c < 3 ? 0 : -b->stress0[(size_t)c * ld + i] / G;
        for (int c = 0; c < 3; c++) b->stress0[(size_t)c * ld + i] = stress * (c == 0 ? 1 : -1);
    }
}

static void test_soils_return_to_their_surface_a_million_times(void **state) {
    (void)state;
    const char *text = getenv("SOIL_FUZZ_ROUNDS");
    const int rounds = text ? atoi(text) : 340; /* 25 laws x 2 spaces x 64 points: above a million */
    size_t total = 0;
    for (int n = 0; n < CASES; n++)
        for (int components = 4; components <= 6; components += 2) {
            soil_bench *b = make(&cases[n]);
            tally t = {0};
            const int my_rounds = components == 4 ? rounds + rounds / 2 : rounds / 2;
            for (int round = 0; round < my_rounds; round++) {
                for (size_t i = 0; i < SOIL_MOST; i++) fill(&cases[n], b, components, i, SOIL_MOST, round % 4 != 0);
                if (soil_bench_update(b, components, SOIL_MOST, SOIL_MOST) != 0) fail_msg("case %d gave up: %s", n, b->service.message);
                for (size_t i = 0; i < SOIL_MOST; i++) one(&cases[n], b, components, i, SOIL_MOST, &t);
                total += SOIL_MOST;
            }
            if (text)
                printf("case %d (%s) %d: %zu elastic, %zu plastic: faces %zu, edges %zu %zu, apex %zu\n", n, cases[n].name, components,
                       t.elastic, t.plastic, t.ordered[0], t.ordered[1], t.ordered[2], t.apex);
            assert_true(t.elastic > 100 && t.plastic > 400);
            soil_bench_close(b);
        }
    assert_true(text || total > 1000000);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_soils_return_to_their_surface_a_million_times),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
