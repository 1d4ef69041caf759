/* test_materials.c: the built-in materials through the interface of plugins: hand results, objectivity, the yield surface, batches. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/plugin_host.h"

enum { MOST = 40, ROWS = 9, CANARY = 64 };

typedef struct bench { /* one material and room for a batch, with a border behind every array that nobody may touch */
    ab_report *report;
    ab_registry *registry;
    const ab_loaded_class *loaded;
    ab_service service;
    void *self;
    double density[MOST], strain[ROWS * MOST + CANARY], F[ROWS * MOST + CANARY], stress0[ROWS * MOST + CANARY],
        stress1[ROWS * MOST + CANARY];
    double state0[MOST + CANARY], state1[MOST + CANARY], dissipation[MOST + CANARY], speed[MOST + CANARY];
    uint8_t flag[MOST];
    ab_batch batch;
} bench;

static char built_in[4096];
static uint64_t random_state = 1;

static double uniform(double low, double high) {
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(random_state >> 11) * 0x1p-53;
}

static bench *open_bench(const char *name) {
    bench *b = calloc(1, sizeof *b);
    b->report = ab_report_create();
    assert_int_equal(ab_registry_create(built_in, &b->registry, b->report), AB_OK);
    b->loaded = ab_registry_find(b->registry, AB_MATERIAL, name, AB_NOWHERE, b->report);
    assert_non_null(b->loaded);
    ab_service_init(&b->service, name);
    return b;
}

/* E, nu, yield, hardening, residual */
static bench *create(const char *name, const double settings[5]) {
    bench *b = open_bench(name);
    ab_value values[5] = {
        {.real = settings[0]}, {.real = settings[1]}, {.real = settings[2]}, {.real = settings[3]}, {.real = settings[4]}};
    assert_int_equal(b->loaded->class_.create(&b->service.host, values, &b->self), 0);
    return b;
}

static void close_bench(bench *b) {
    if (b->self) b->loaded->class_.destroy(b->self);
    ab_registry_destroy(b->registry);
    ab_report_destroy(b->report);
    free(b);
}

static int update(bench *b, int dimension, size_t count, size_t ld) {
    const bool needs_F = b->loaded->class_.needs & AB_NEED_DEFORMATION_GRADIENT;
    for (size_t i = 0; i < count; i++) b->density[i] = 1000.0;
    memset(b->flag, 0, sizeof b->flag);
    b->batch = (ab_batch){.struct_size = sizeof(ab_batch),
                          .dimension = (uint32_t)dimension,
                          .components = dimension == 2 ? 4 : 6,
                          .count = count,
                          .ld = ld,
                          .dt = 1e-3,
                          .density = b->density,
                          .strain_increment = b->strain,
                          .deformation_gradient = needs_F ? b->F : NULL,
                          .stress0 = b->stress0,
                          .stress1 = b->stress1,
                          .state0 = b->loaded->class_.nstate ? b->state0 : NULL,
                          .state1 = b->loaded->class_.nstate ? b->state1 : NULL,
                          .dissipation = b->loaded->class_.gives & AB_GIVE_DISSIPATION ? b->dissipation : NULL,
                          .wave_speed = b->speed,
                          .flag = b->flag};
    return b->loaded->material.update(b->self, &b->batch);
}

static void near(double value, double wanted, double scale) {
    if (!(fabs(value - wanted) <= 1e-12 * scale)) fail_msg("%.17g, wanted %.17g", value, wanted);
}

static const double elastic[5] = {1e6, 0.25, 0, 0, 0}; /* lambda = mu = 4e5 */

/* ---- linear elasticity --------------------------------------------------------------------------------------------------------------- */

static void test_linear_elastic_gives_the_hand_result(void **state) {
    (void)state;
    bench *b = create("linear-elastic", elastic);
    const double strain[6] = {1e-3, 2e-3, -5e-4, 4e-3, 1e-3, -2e-3}, trace = 2.5e-3;
    for (int dimension = 2; dimension <= 3; dimension++) {
        const int components = dimension == 2 ? 4 : 6;
        for (int c = 0; c < components; c++) b->strain[c * 8 + 3] = strain[c], b->stress0[c * 8 + 3] = 100.0 * c;
        assert_int_equal(update(b, dimension, 8, 8), 0);
        for (int c = 0; c < components; c++)
            near(b->stress1[c * 8 + 3], 100.0 * c + (c < 3 ? 4e5 * trace + 8e5 * strain[c] : 4e5 * strain[c]), 1e4);
        near(b->speed[3], sqrt(1.2e6 / 1000), 1e3);
    }
    close_bench(b);
}

/* ---- neo-Hooke ------------------------------------------------------------------------------------------------------------------------- */

static void multiply(const double *a, const double *b, double *c) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            c[3 * i + j] = 0;
            for (int k = 0; k < 3; k++) c[3 * i + j] += a[3 * i + k] * b[3 * k + j];
        }
}

static void transpose(const double *a, double *t) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) t[3 * i + j] = a[3 * j + i];
}

static void rotation(double a, double b, double c, double *R) {
    const double z[9] = {cos(a), -sin(a), 0, sin(a), cos(a), 0, 0, 0, 1}, y[9] = {cos(b), 0, sin(b), 0, 1, 0, -sin(b), 0, cos(b)};
    const double x[9] = {1, 0, 0, 0, cos(c), -sin(c), 0, sin(c), cos(c)};
    double zy[9];
    multiply(z, y, zy);
    multiply(zy, x, R);
}

/* Puts F (3 x 3) at item i of the batch and returns its stress as 3 x 3. */
static void neo_stress(bench *b, int dimension, const double *F, double *sigma) {
    static const int plane[5] = {0, 1, 3, 4, 8};
    for (int i = 0; i < 8; i++) {
        const bool own = i == 5;
        if (dimension == 2)
            for (int c = 0; c < 5; c++) b->F[c * 8 + i] = own ? F[plane[c]] : (c == 0 || c > 2);
        else
            for (int c = 0; c < 9; c++) b->F[c * 8 + i] = own ? F[c] : c % 4 == 0;
    }
    assert_int_equal(update(b, dimension, 8, 8), 0);
    const double *s = b->stress1 + 5;
    const double yz = dimension == 3 ? s[32] : 0, zx = dimension == 3 ? s[40] : 0;
    const double full[9] = {s[0], s[24], zx, s[24], s[8], yz, zx, yz, s[16]};
    memcpy(sigma, full, sizeof full);
    for (int c = 0; c < (dimension == 2 ? 4 : 6); c++) near(b->stress1[c * 8], 0, 1); /* an item at rest beside it */
}

static void test_neo_hookean_stretched_along_one_axis(void **state) {
    (void)state;
    bench *b = create("neo-hookean", elastic);
    const double lambda = 4e5, mu = 4e5;
    for (int dimension = 2; dimension <= 3; dimension++)
        for (double F = 0.05; F < 20; F *= 1.07) {
            const double stretch[9] = {F, 0, 0, 0, 1, 0, 0, 0, 1};
            double sigma[9];
            neo_stress(b, dimension, stretch, sigma);
            near(sigma[0], mu * (F - 1 / F) + lambda * log(F) / F, 1e7 / F); /* on this path sigma_xx is the first Piola-Kirchhoff stress */
            near(sigma[4], lambda * log(F) / F, 1e7 / F);
            near(sigma[8], lambda * log(F) / F, 1e7 / F);
            assert_true(b->speed[5] >=
                        F * sqrt(((lambda * (1 - log(F)) + mu) / (F * F) + mu) / (F * 1000)) * (1 - 1e-12)); /* never below the true one */
            /* The slope of the stress is the modulus that the verification problems use. */
            const double h = 1e-5 * F, up[9] = {F + h, 0, 0, 0, 1, 0, 0, 0, 1}, down[9] = {F - h, 0, 0, 0, 1, 0, 0, 0, 1};
            double high[9], low[9];
            neo_stress(b, dimension, up, high);
            neo_stress(b, dimension, down, low);
            const double slope = (high[0] - low[0]) / (2 * h), modulus = lambda * (1 - log(F)) / (F * F) + mu * (1 / (F * F) + 1);
            assert_true(fabs(slope - modulus) < 1e-6 * (fabs(modulus) + mu));
        }
    close_bench(b);
}

static void test_neo_hookean_turns_with_the_material(void **state) {
    (void)state;
    bench *b = create("neo-hookean", elastic);
    for (int trial = 0; trial < 200; trial++) {
        const int dimension = 2 + trial % 2;
        double U[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, R[9], Rt[9], F[9], sigma[9], turned[9], half[9], wanted[9];
        for (int i = 0; i < 3; i++)
            for (int j = 0; j <= i; j++)
                if (dimension == 3 || i < 2 || i == j) U[3 * i + j] += uniform(-0.3, 0.3), U[3 * j + i] = U[3 * i + j];
        rotation(uniform(-3, 3), dimension == 3 ? uniform(-3, 3) : 0, dimension == 3 ? uniform(-3, 3) : 0, R);
        transpose(R, Rt);
        multiply(R, U, F);
        neo_stress(b, dimension, U, sigma);
        neo_stress(b, dimension, F, turned);
        multiply(R, sigma, half);
        multiply(half, Rt, wanted);
        for (int c = 0; c < 9; c++) near(turned[c], wanted[c], 1e7);
        neo_stress(b, dimension, R, turned); /* a rotation alone makes no stress */
        for (int c = 0; c < 9; c++) near(turned[c], 0, 1e7);
    }
    close_bench(b);
}

static void test_neo_hookean_is_linear_elastic_at_small_strain(void **state) {
    (void)state;
    bench *b = create("neo-hookean", elastic);
    const double F[9] = {1 + 1e-8, 3e-8, 0, 1e-8, 1 - 2e-8, 2e-8, 0, 0, 1 + 4e-8};
    double sigma[9];
    neo_stress(b, 3, F, sigma);
    near(sigma[0] / 4e5, 3e-8 + 2e-8, 1e-2);
    near(sigma[1] / 4e5, 4e-8, 1e-2);
    near(sigma[5] / 4e5, 2e-8, 1e-2);
    close_bench(b);
}

static void test_a_turned_over_item_is_flagged_and_said(void **state) {
    (void)state;
    bench *b = create("neo-hookean", elastic);
    const double bad[] = {0.0, -1.0, NAN, INFINITY};
    for (size_t k = 0; k < 4; k++)
        for (int dimension = 2; dimension <= 3; dimension++) {
            for (int i = 0; i < 8; i++)
                for (int c = 0; c < 9; c++) b->F[c * 8 + i] = dimension == 2 ? (c == 0 || c > 2) : c % 4 == 0;
            b->F[6] = bad[k];
            b->service.message[0] = '\0';
            assert_true(update(b, dimension, 8, 8) < 0);
            for (int i = 0; i < 8; i++) assert_int_equal(b->flag[i], i == 6);
            assert_non_null(strstr(b->service.message, "inside out"));
            for (int i = 0; i < 8; i++)
                if (i != 6) near(b->stress1[i], 0, 1);
            if (isfinite(bad[k])) assert_true(isfinite(b->stress1[6]) && isfinite(b->speed[6]));
        }
    close_bench(b);
}

/* ---- von Mises ------------------------------------------------------------------------------------------------------------------------- */

static double mises(const bench *b, int dimension, size_t ld, size_t i) {
    const double *s = b->stress1 + i;
    const double mean = (s[0] + s[ld] + s[2 * ld]) / 3, x = s[0] - mean, y = s[ld] - mean, z = s[2 * ld] - mean;
    const double yz = dimension == 3 ? s[4 * ld] : 0, zx = dimension == 3 ? s[5 * ld] : 0;
    return sqrt(1.5 * (x * x + y * y + z * z) + 3 * (s[3 * ld] * s[3 * ld] + yz * yz + zx * zx));
}

static void test_von_mises_gives_the_hand_result_in_shear(void **state) {
    (void)state;
    const double E = 1e6, nu = 0.25, G = 4e5, yield = 1e3, H = 1e5;
    bench *b = create("von-mises", (const double[]){E, nu, yield, H, 0});
    const double gamma = 0.01, q = sqrt(3) * G * gamma, da = (q - yield) / (3 * G + H);
    b->strain[3 * 8 + 2] = gamma;
    b->strain[3 * 8 + 1] = 1e-4; /* stays elastic */
    b->strain[1 * 8 + 7] = 0.5;  /* beside it: pressure without bound */
    b->strain[0 * 8 + 7] = 0.5, b->strain[2 * 8 + 7] = 0.5;
    assert_int_equal(update(b, 2, 8, 8), 0);
    near(b->stress1[3 * 8 + 2], (yield + H * da) / sqrt(3), yield);
    near(b->state1[2], da, 1);
    near(b->dissipation[2], (yield + H * da) * da, yield);
    near(b->stress1[3 * 8 + 1], G * 1e-4, yield);
    assert_true(b->state1[1] == 0 && b->dissipation[1] == 0 && b->state1[7] == 0);
    near(b->stress1[7], (4e5 + 8e5 / 3) * 1.5, 1e6);
    near(b->speed[0], sqrt(1200.0), 1e3);
    close_bench(b);
}

static void test_von_mises_uniaxial_strain_follows_the_hand_path(void **state) {
    (void)state;
    const double K = 1e6 / 1.5, G = 4e5, yield = 1e3;
    bench *b = create("von-mises", (const double[]){1e6, 0.25, yield, 0, 0});
    double total = 0;
    for (int step = 0; step < 100; step++) {
        for (int i = 0; i < 8; i++) b->strain[i] = 1e-4;
        total += 1e-4;
        assert_int_equal(update(b, 2, 8, 8), 0);
        const double q = fmin(2 * G * total, yield); /* sigma_x - sigma_y = 2 G eps while elastic */
        near(b->stress1[4], K * total + 2 * q / 3, 1e4);
        near(b->stress1[8 + 4], K * total - q / 3, 1e4);
        near(b->state1[4], fmax(0, (2 * G * total - yield) / (3 * G)), 1);
        memcpy(b->stress0, b->stress1, sizeof b->stress0);
        memcpy(b->state0, b->state1, sizeof b->state0);
    }
    close_bench(b);
}

/* Over random paths, for hardening, ideal plasticity and softening down to a residual, also to none: on or inside the surface of the end of the
 * step to 1e-10 of its size, on it when the step flowed; dissipation as large as the work, never negative. */
static void test_von_mises_stays_on_its_surface(void **state) {
    (void)state;
    static const double laws[][5] = {{1e6, 0.25, 1e3, 1e5, 0},        {1e6, 0.25, 1e3, 0, 0},       {1e6, 0.25, 1e3, -1e5, 200},
                                     {1e6, 0.25, 1e3, -1e5, 0},       {1e6, 0.49, 1e3, -9e5, 1e-3}, {1e6, -0.5, 1e3, 1e9, 999},
                                     {1e6, 0.25, 1e3, -1.199e6, 500}, {1e6, 0.25, 1e3, -10, 1e3}};
    for (size_t k = 0; k < sizeof laws / sizeof *laws; k++)
        for (int dimension = 2; dimension <= 3; dimension++) {
            const double yield = laws[k][2], H = laws[k][3], residual = laws[k][4], G = laws[k][0] / (2 * (1 + laws[k][1]));
            const size_t ld = dimension == 2 ? 8 : MOST, count = dimension == 2 ? 8 : 37;
            bench *b = create("von-mises", laws[k]);
            size_t flowed = 0, softened = 0;
            for (int step = 0; step < 400; step++) {
                const double size = step % 7 == 0 ? 1e-2 : 1e-3;
                for (size_t j = 0; j < (dimension == 2 ? 4 : 6) * ld; j++) b->strain[j] = uniform(-size, size);
                for (size_t j = 0; j < ld && step % 3; j++) { /* little change of volume */
                    const double mean = (b->strain[j] + b->strain[ld + j] + b->strain[2 * ld + j]) / 3;
                    for (size_t c = 0; c < 3; c++) b->strain[c * ld + j] -= mean;
                }
                assert_int_equal(update(b, dimension, count, ld), 0);
                for (size_t i = 0; i < count; i++) {
                    const double line = yield + H * b->state1[i], surface = fmax(line, residual), q = mises(b, dimension, ld, i);
                    const double volume = fabs(b->stress1[i] + b->stress1[ld + i] + b->stress1[2 * ld + i]);
                    const double tolerance =
                        1e-10 * fmax(surface, yield * 1e-3) + 1e-14 * volume; /* a deviator cannot be better than its stress */
                    const double increment = b->state1[i] - b->state0[i];
                    if (!(q <= surface + tolerance)) fail_msg("law %zu: q = %.15g above %.15g", k, q, surface);
                    if (increment > 0 && !(fabs(q - surface) <= tolerance)) fail_msg("law %zu: q = %.15g, surface %.15g", k, q, surface);
                    assert_true(increment >= 0 && b->dissipation[i] >= 0);
                    near(b->dissipation[i], q * increment, 1e3 * surface + volume);
                    flowed += increment > 0, softened += H < 0 && residual > 0 && line < residual;
                    /* What was taken off the trial stress is 3 G da. */
                    double trial[6], *s = trial;
                    for (int c = 0; c < 3; c++) s[c] = b->stress0[(size_t)c * ld + i] + 2 * G * b->strain[(size_t)c * ld + i];
                    for (int c = 3; c < 6; c++)
                        s[c] = dimension == 3 || c == 3 ? b->stress0[(size_t)c * ld + i] + G * b->strain[(size_t)c * ld + i] : 0;
                    const double mean = (s[0] + s[1] + s[2]) / 3;
                    const double before =
                        sqrt(1.5 * ((s[0] - mean) * (s[0] - mean) + (s[1] - mean) * (s[1] - mean) + (s[2] - mean) * (s[2] - mean)) +
                             3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
                    if (!(fabs(before - 3 * G * increment - q) <= 1e-9 * before + tolerance))
                        fail_msg("law %zu: %.15g - 3 G da = %.15g", k, before, q);
                }
                memcpy(b->stress0, b->stress1, sizeof b->stress0);
                memcpy(b->state0, b->state1, sizeof b->state0);
            }
            assert_true(flowed > 100);
            if (H < -1e3 && residual > 0) assert_true(softened > 10);
            close_bench(b);
        }
}

static void test_von_mises_refuses_what_cannot_be_integrated(void **state) {
    (void)state;
    bench *b = open_bench("von-mises");
    ab_value values[5] = {{.real = 1e6}, {.real = 0.25}, {.real = 1e3}, {.real = -1.2e6}, {.real = 0}}; /* 3 G = 1.2e6 */
    assert_true(b->loaded->class_.create(&b->service.host, values, &b->self) < 0);
    assert_non_null(strstr(b->service.message, "-3 G"));
    values[3].real = 0, values[4].real = 1001;
    assert_true(b->loaded->class_.create(&b->service.host, values, &b->self) < 0);
    assert_non_null(strstr(b->service.message, "above yield"));
    close_bench(b);
}

/* ---- promises of every material --------------------------------------------------------------------------------------------------------- */

static void fill(bench *b, int dimension, size_t ld) {
    for (size_t j = 0; j < ROWS * MOST + CANARY; j++) {
        b->strain[j] = uniform(-0.02, 0.02);
        b->stress0[j] = uniform(-500, 500);
        const size_t c = j / ld;
        b->F[j] = (dimension == 2 ? c == 0 || c == 3 || c == 4 : c % 4 == 0) + uniform(-0.2, 0.2);
        b->stress1[j] = -77;
    }
    for (size_t j = 0; j < MOST + CANARY; j++) b->state0[j] = uniform(0, 1e-2), b->state1[j] = b->dissipation[j] = b->speed[j] = -77;
}

/* n items at once or one by one, in packed blocks or in long rows: the same bits; input untouched; nothing written beside the output. */
static void test_a_batch_is_its_items(void **state) {
    (void)state;
    static const char *const names[] = {"linear-elastic", "neo-hookean", "von-mises"};
    for (size_t k = 0; k < 3; k++)
        for (int dimension = 2; dimension <= 3; dimension++)
            for (size_t count = 1; count <= MOST; count++)
                for (int packed = 0; packed < 2; packed++) {
                    const size_t ld = packed ? count <= 8 ? 8 : count : MOST, components = dimension == 2 ? 4 : 6;
                    bench *many = create(names[k], (const double[]){1e6, 0.25, 1e3, -1e5, 300}),
                          *one = create(names[k], (const double[]){1e6, 0.25, 1e3, -1e5, 300});
                    fill(many, dimension, ld);
                    bench *before = malloc(sizeof *before);
                    memcpy(before, many, sizeof *before);
                    assert_int_equal(update(many, dimension, count, ld), 0);
                    assert_memory_equal(before->strain, many->strain, sizeof many->strain);
                    assert_memory_equal(before->F, many->F, sizeof many->F);
                    assert_memory_equal(before->stress0, many->stress0, sizeof many->stress0);
                    assert_memory_equal(before->state0, many->state0, sizeof many->state0);
                    for (size_t j = 0; j < ROWS * MOST + CANARY; j++)
                        assert_int_equal(many->stress1[j] == -77, j % ld >= count || j / ld >= components);
                    for (size_t j = 0; j < MOST + CANARY; j++) {
                        const bool mine = j < count, declared = k == 2;
                        assert_int_equal(many->state1[j] == -77, !(mine && declared));
                        assert_int_equal(many->dissipation[j] == -77, !(mine && declared));
                        assert_int_equal(many->speed[j] == -77, !mine);
                    }
                    for (size_t i = 0; i < count; i++) {
                        for (size_t c = 0; c < ROWS; c++) {
                            one->strain[c * 8] = many->strain[c * ld + i], one->F[c * 8] = many->F[c * ld + i];
                            one->stress0[c * 8] = many->stress0[c * ld + i];
                        }
                        one->state0[0] = many->state0[i];
                        assert_int_equal(update(one, dimension, 1, 8), 0);
                        for (size_t c = 0; c < components; c++)
                            assert_memory_equal(&one->stress1[c * 8], &many->stress1[c * ld + i], sizeof(double));
                        assert_memory_equal(one->speed, &many->speed[i], sizeof(double));
                        if (k == 2) assert_memory_equal(one->state1, &many->state1[i], sizeof(double));
                        if (k == 2) assert_memory_equal(one->dissipation, &many->dissipation[i], sizeof(double));
                    }
                    many->batch.wave_speed = NULL; /* steps that do not ask */
                    assert_int_equal(many->loaded->material.update(many->self, &many->batch), 0);
                    free(before);
                    close_bench(many);
                    close_bench(one);
                }
}

int main(void) {
    const char *build = getenv("ABUT_BUILD");
    snprintf(built_in, sizeof built_in, "%s/plugins", build ? build : ".");
    unsetenv("ABUT_PLUGIN_PATH");
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linear_elastic_gives_the_hand_result),
        cmocka_unit_test(test_neo_hookean_stretched_along_one_axis),
        cmocka_unit_test(test_neo_hookean_turns_with_the_material),
        cmocka_unit_test(test_neo_hookean_is_linear_elastic_at_small_strain),
        cmocka_unit_test(test_a_turned_over_item_is_flagged_and_said),
        cmocka_unit_test(test_von_mises_gives_the_hand_result_in_shear),
        cmocka_unit_test(test_von_mises_uniaxial_strain_follows_the_hand_path),
        cmocka_unit_test(test_von_mises_stays_on_its_surface),
        cmocka_unit_test(test_von_mises_refuses_what_cannot_be_integrated),
        cmocka_unit_test(test_a_batch_is_its_items),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
