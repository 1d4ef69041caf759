/* linear_elastic.c: isotropic linear elasticity in rate form: the increment of stress is D : the increment of strain, on a stress that the
 * host has already turned with the material. */
#include <math.h>

#include "abut_plugin.h"

typedef struct law {
    const ab_host *host;
    double lambda, mu; /* Pa */
} law;

static int create(const ab_host *host, const ab_value *settings, void **self) {
    const double E = settings[0].real, nu = settings[1].real;
    law *made = host->allocate(host->context, sizeof *made);
    if (!made) return -1;
    *made = (law){.host = host, .lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), .mu = E / (2 * (1 + nu))};
    *self = made;
    return 0;
}

static void destroy(void *self) {
    const law *made = self;
    made->host->release(made->host->context, self);
}

/* Every sum has one product, so that however the compiler fuses them, one item has the bits it has among many. */
static inline void stress(double lambda, double two_mu, double mu, size_t count, size_t ld, const double *restrict strain,
                          const double *restrict stress0, double *restrict stress1) {
    for (size_t i = 0; i < count; i++) {
        const double volume = strain[i] + strain[ld + i] + strain[2 * ld + i];
        stress1[i] = stress0[i] + lambda * volume + two_mu * strain[i];
        stress1[ld + i] = stress0[ld + i] + lambda * volume + two_mu * strain[ld + i];
        stress1[2 * ld + i] = stress0[2 * ld + i] + lambda * volume + two_mu * strain[2 * ld + i];
        stress1[3 * ld + i] = stress0[3 * ld + i] + mu * strain[3 * ld + i];
    }
}

static int update(void *self, ab_batch *b) {
    const law *l = self;
    const double *strain = b->strain_increment;
    if (b->count == 8 && b->ld == 8)
        stress(l->lambda, 2 * l->mu, l->mu, 8, 8, strain, b->stress0, b->stress1); /* constants make vector code */
    else
        stress(l->lambda, 2 * l->mu, l->mu, b->count, b->ld, strain, b->stress0, b->stress1);
    for (size_t c = 4; c < b->components; c++)
        for (size_t i = 0; i < b->count; i++) b->stress1[c * b->ld + i] = b->stress0[c * b->ld + i] + l->mu * strain[c * b->ld + i];
    if (b->wave_speed)
        for (size_t i = 0; i < b->count; i++) b->wave_speed[i] = sqrt((l->lambda + 2 * l->mu) / b->density[i]);
    return 0;
}

static const ab_param params[] = {
    {"E", "Pa", "Young's modulus", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN, 0, 0, INFINITY},
    {"nu", "1", "Poisson's ratio", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN | AB_MAX_OPEN, 0, -1, 0.5},
};
static const ab_material_ops ops = {sizeof ops, NULL, update};
static const ab_class linear_elastic = {
    .struct_size = sizeof(ab_class),
    .kind = AB_MATERIAL,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D,
    .gives = AB_GIVE_STRESS | AB_GIVE_WAVE_SPEED,
    .nparam = 2,
    .name = "linear-elastic",
    .help = "isotropic linear elasticity, small strain, any rotation",
    .reference = "Hughes and Winget 1980 (rate form)",
    .param = params,
    .create = create,
    .destroy = destroy,
    .ops = &ops,
};
static const ab_class *const classes[] = {&linear_elastic};
AB_EXPORT const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "linear-elastic", "1.0", "MIT", classes};
