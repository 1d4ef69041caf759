/* mohr_coulomb.c: soil and rock that slip on planes: cohesion, friction, dilation, a tension cut-off, and softening down to residuals.
 * The surface and the return to it are in mohr_coulomb.h. */
#include "mohr_coulomb.h"

enum { E_, NU, COHESION, FRICTION, DILATION, TENSION, RESIDUAL_COHESION, RESIDUAL_FRICTION, RESIDUAL_DILATION, SOFTENING };

static int create(const ab_host *host, const ab_value *s, void **self) {
    return mc_create(host,
                     &(mc_settings){.E = s[E_].real,
                                    .nu = s[NU].real,
                                    .strength = {.cohesion = s[COHESION].real,
                                                 .friction = s[FRICTION].real,
                                                 .dilation = s[DILATION].real,
                                                 .residual_cohesion = soil_residual(s[RESIDUAL_COHESION], s[COHESION]),
                                                 .residual_friction = soil_residual(s[RESIDUAL_FRICTION], s[FRICTION]),
                                                 .residual_dilation = soil_residual(s[RESIDUAL_DILATION], s[DILATION])},
                                    .tension = s[TENSION].given ? s[TENSION].real : INFINITY,
                                    .softening = s + SOFTENING},
                     self);
}

static const ab_param params[] = {
    SOIL_ELASTIC_SETTINGS,
    {"cohesion", "Pa", "shear strength of a plane without pressure on it", NULL, AB_REAL, AB_REQUIRED, 0, 0, INFINITY},
    {"friction", "rad", "angle of friction, as in \"30 deg\"", NULL, AB_REAL, AB_REQUIRED | AB_MAX_OPEN, 0, 0, SOIL_RIGHT_ANGLE},
    {"dilation", "rad", "angle of dilation, at most the friction; 0: slip keeps the volume", NULL, AB_REAL, AB_MAX_OPEN, 0, 0,
     SOIL_RIGHT_ANGLE},
    {"tension", "Pa", "largest tensile stress; without it the surface goes on to its apex, cohesion/tan(friction)", NULL, AB_REAL, 0,
     INFINITY, 0, INFINITY},
    SOIL_RESIDUAL_SETTINGS,
    SOIL_SOFTENING_SETTINGS,
};
static const ab_state states[] = {SOIL_STATE};
static const ab_material_ops ops = {sizeof ops, NULL, mc_update};
static const ab_class mohr_coulomb = {
    SOIL_CLASS_HEAD,
    .name = "mohr-coulomb",
    .help = "cohesion and friction on planes of slip, dilation, tension cut-off, softening to residuals",
    .reference = "Clausen, Damkilde and Andersen 2006; de Souza Neto, Peric and Owen 2008, section 8.2",
    .destroy = mc_destroy,
    .ops = &ops,
};
static const ab_class *const classes[] = {&mohr_coulomb};
AB_EXPORT const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "mohr-coulomb", "1.0", "MIT", classes};
