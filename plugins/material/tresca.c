/* tresca.c: undrained clay: the largest shear stress is the undrained strength, whatever the pressure; the surface of mohr_coulomb.h
 * without friction. */
#include "mohr_coulomb.h"

enum { E_, NU, COHESION, TENSION, RESIDUAL_COHESION, SOFTENING };

static int create(const ab_host *host, const ab_value *s, void **self) {
    return mc_create(
        host,
        &(mc_settings){.E = s[E_].real,
                       .nu = s[NU].real,
                       .strength = {.cohesion = s[COHESION].real, .residual_cohesion = soil_residual(s[RESIDUAL_COHESION], s[COHESION])},
                       .tension = s[TENSION].given ? s[TENSION].real : INFINITY,
                       .softening = s + SOFTENING},
        self);
}

static const ab_param params[] = {
    SOIL_ELASTIC_SETTINGS,
    {"cohesion", "Pa", "undrained strength: the largest shear stress, half the strength in uniaxial compression", NULL, AB_REAL,
     AB_REQUIRED | AB_MIN_OPEN, 0, 0, INFINITY},
    {"tension", "Pa", "largest tensile stress; without it tension has no limit of its own", NULL, AB_REAL, 0, INFINITY, 0, INFINITY},
    {"residual_cohesion", "Pa", "strength after softening (remoulded); without it the strength stays", NULL, AB_REAL, 0, INFINITY, 0,
     INFINITY},
    SOIL_SOFTENING_SETTINGS,
};
static const ab_state states[] = {SOIL_STATE};
static const ab_material_ops ops = {sizeof ops, NULL, mc_update};
static const ab_class tresca = {
    SOIL_CLASS_HEAD,
    .name = "tresca",
    .help = "undrained clay: a largest shear stress, whatever the pressure; softening to a residual",
    .reference = "de Souza Neto, Peric and Owen 2008, section 8.1",
    .destroy = mc_destroy,
    .ops = &ops,
};
static const ab_class *const classes[] = {&tresca};
AB_EXPORT const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "tresca", "1.0", "MIT", classes};
