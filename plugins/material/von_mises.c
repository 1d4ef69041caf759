/* von_mises.c: elastoplasticity with the yield surface of von Mises and linear isotropic hardening, or softening down to a residual.
 *
 * Radial return (Wilkins 1964; Simo and Hughes 1998, box 3.1), in closed form. q = sqrt(3/2 s:s) must not exceed
 *     sigma_y(a) = max(yield + hardening * a, residual),   a: equivalent plastic strain.
 * With the trial value q_t > sigma_y(a0) the step's increment da solves q_t - 3 G da = sigma_y(a0 + da): on the sloping branch
 * da = (q_t - sigma_y0)/(3 G + hardening), q = sigma_y0 + hardening * da; where that q falls below the residual, the softening ends inside
 * this step, and q = residual, da = (q_t - residual)/(3 G), is exact. */
#include <math.h>
#include <stdio.h>

#include "abut_plugin.h"

#if defined(__GNUC__) && !defined(__clang__)
#define ROWS_APART _Pragma("GCC ivdep") /* ld >= count: rows do not overlap, which the compiler cannot know */
#else
#define ROWS_APART
#endif

typedef struct law {
    const ab_host *host;
    double lambda, two_mu, mu;                        /* Pa */
    double yield, hardening, residual;                /* Pa */
    double slope_inverse, three_mu, three_mu_inverse; /* 1/(3 G + hardening), 3 G, 1/(3 G) */
} law;

enum { E_, NU, YIELD, HARDENING, RESIDUAL };

static int create(const ab_host *host, const ab_value *settings, void **self) {
    const double E = settings[E_].real, nu = settings[NU].real, mu = E / (2 * (1 + nu));
    const double yield = settings[YIELD].real, hardening = settings[HARDENING].real, residual = settings[RESIDUAL].real;
    char text[200] = "";
    if (hardening <= -3 * mu)
        snprintf(text, sizeof text, "hardening %g Pa softens faster than elasticity can unload: it must be above -3 G = %g Pa", hardening,
                 -3 * mu);
    else if (residual > yield)
        snprintf(text, sizeof text, "residual %g Pa is above yield %g Pa", residual, yield);
    if (text[0]) return host->message(host->context, text), -1;
    law *made = host->allocate(host->context, sizeof *made);
    if (!made) return -1;
    *made = (law){.host = host,
                  .lambda = E * nu / ((1 + nu) * (1 - 2 * nu)),
                  .two_mu = 2 * mu,
                  .mu = mu,
                  .yield = yield,
                  .hardening = hardening,
                  .residual = residual,
                  .slope_inverse = 1 / (3 * mu + hardening),
                  .three_mu = 3 * mu,
                  .three_mu_inverse = 1 / (3 * mu)};
    *self = made;
    return 0;
}

static void destroy(void *self) {
    const law *made = self;
    made->host->release(made->host->context, self);
}

/* Eight items, whose rows are ld apart. Inlined into one function per number of components and nowhere else, so that an item has the same bits
 * in any batch, however the compiler fuses products and sums. */
static inline __attribute__((always_inline)) void return_to_surface(const law l, size_t ld, size_t components,
                                                                    const double *restrict strain, const double *restrict stress0,
                                                                    const double *restrict plastic0, double *restrict stress1,
                                                                    double *restrict plastic1, double *restrict dissipation) {
    ROWS_APART
    for (size_t i = 0; i < 8; i++) {
        const double volumetric = l.lambda * (strain[i] + strain[ld + i] + strain[2 * ld + i]);
        const double xx = stress0[i] + (volumetric + l.two_mu * strain[i]);
        const double yy = stress0[ld + i] + (volumetric + l.two_mu * strain[ld + i]);
        const double zz = stress0[2 * ld + i] + (volumetric + l.two_mu * strain[2 * ld + i]);
        const double xy = stress0[3 * ld + i] + l.mu * strain[3 * ld + i];
        const double yz = components == 6 ? stress0[4 * ld + i] + l.mu * strain[4 * ld + i] : 0.0;
        const double zx = components == 6 ? stress0[5 * ld + i] + l.mu * strain[5 * ld + i] : 0.0;
        const double mean = (xx + yy + zz) * (1.0 / 3.0);
        const double sx = xx - mean, sy = yy - mean, sz = zz - mean;
        const double trial = sqrt(1.5 * (sx * sx + sy * sy + sz * sz) + 3.0 * (xy * xy + yz * yz + zx * zx));
        const double line = l.yield + l.hardening * plastic0[i];
        const double yield = line > l.residual ? line : l.residual;
        const double on_line = (trial - yield) * l.slope_inverse, line_end = yield + l.hardening * on_line;
        const int ends = line_end<l.residual, flows = trial> yield;
        const double end = ends ? l.residual : line_end;
        const double increment = flows ? (ends ? (trial - l.residual) * l.three_mu_inverse : on_line) : 0.0;
        const double ratio = flows ? end / trial : 1.0;
        stress1[i] = mean + ratio * sx;
        stress1[ld + i] = mean + ratio * sy;
        stress1[2 * ld + i] = mean + ratio * sz;
        stress1[3 * ld + i] = ratio * xy;
        if (components == 6) stress1[4 * ld + i] = ratio * yz;
        if (components == 6) stress1[5 * ld + i] = ratio * zx;
        plastic1[i] = plastic0[i] + increment;
        dissipation[i] = end * increment; /* s : d_eps_p = q da */
    }
}

typedef struct rows {
    const double *strain, *stress0, *plastic0;
    double *stress1, *plastic1, *dissipation;
} rows;

static __attribute__((noinline)) void plane(const law *l, size_t ld, const rows *r) {
    return_to_surface(*l, ld, 4, r->strain, r->stress0, r->plastic0, r->stress1, r->plastic1, r->dissipation);
}

static __attribute__((noinline)) void space(const law *l, size_t ld, const rows *r) {
    return_to_surface(*l, ld, 6, r->strain, r->stress0, r->plastic0, r->stress1, r->plastic1, r->dissipation);
}

/* Fewer than eight items from `first` on: the last one again in the lanes that are free. */
static void few(const law *l, ab_batch *b, size_t first) {
    double strain[6 * 8], stress0[6 * 8], stress1[6 * 8], plastic0[8], plastic1[8], dissipation[8];
    const size_t count = b->count - first;
    for (size_t i = 0; i < 8; i++) {
        const size_t from = first + (i < count ? i : count - 1);
        plastic0[i] = b->state0[from];
        for (size_t c = 0; c < b->components; c++)
            strain[c * 8 + i] = b->strain_increment[c * b->ld + from], stress0[c * 8 + i] = b->stress0[c * b->ld + from];
    }
    (b->components == 4 ? plane : space)(l, 8, &(rows){strain, stress0, plastic0, stress1, plastic1, dissipation});
    for (size_t i = 0; i < count; i++) {
        for (size_t c = 0; c < b->components; c++) b->stress1[c * b->ld + first + i] = stress1[c * 8 + i];
        b->state1[first + i] = plastic1[i];
        b->dissipation[first + i] = dissipation[i];
    }
}

static int update(void *self, ab_batch *b) {
    const law *l = self;
    size_t i = 0;
    for (; i + 8 <= b->count; i += 8)
        (b->components == 4 ? plane : space)(
            l, b->ld, &(rows){b->strain_increment + i, b->stress0 + i, b->state0 + i, b->stress1 + i, b->state1 + i, b->dissipation + i});
    if (i < b->count) few(l, b, i);
    if (b->wave_speed)
        for (i = 0; i < b->count; i++) b->wave_speed[i] = sqrt((l->lambda + l->two_mu) / b->density[i]);
    return 0;
}

static const ab_param params[] = {
    {"E", "Pa", "Young's modulus", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN, 0, 0, INFINITY},
    {"nu", "1", "Poisson's ratio", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN | AB_MAX_OPEN, 0, -1, 0.5},
    {"yield", "Pa", "yield stress in uniaxial tension", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN, 0, 0, INFINITY},
    {"hardening", "Pa", "slope of the yield stress over equivalent plastic strain; negative: softening, above -3 G", NULL, AB_REAL, 0, 0,
     -INFINITY, INFINITY},
    {"residual", "Pa", "yield stress never falls below it", NULL, AB_REAL, 0, 0, 0, INFINITY},
};
static const ab_state states[] = {{"plastic_strain", "1", "equivalent plastic strain", AB_SCALAR, AB_AVERAGE, 0}};
static const ab_material_ops ops = {sizeof ops, NULL, update};
static const ab_class von_mises = {
    .struct_size = sizeof(ab_class),
    .kind = AB_MATERIAL,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D,
    .gives = AB_GIVE_STRESS | AB_GIVE_DISSIPATION | AB_GIVE_WAVE_SPEED,
    .nparam = 5,
    .nstate = 1,
    .name = "von-mises",
    .help = "elastoplasticity of von Mises with linear hardening, or softening to a residual",
    .reference = "Simo and Hughes 1998, box 3.1",
    .param = params,
    .state = states,
    .create = create,
    .destroy = destroy,
    .ops = &ops,
};
static const ab_class *const classes[] = {&von_mises};
AB_EXPORT const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "von-mises", "1.0", "MIT", classes};
