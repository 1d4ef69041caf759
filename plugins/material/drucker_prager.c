/* drucker_prager.c: a cone around the hydrostatic axis, matched to the angles and the cohesion of Mohr and Coulomb,
 *     f = sqrt(J2) + eta p - xi c <= 0,     p = (xx + yy + zz)/3, tension positive,
 * that flows along the gradient of sqrt(J2) + eta' p, eta' from the dilation as eta from the friction. With t = tan phi and s = sin phi
 *     outside       eta = 6 s/(sqrt(3) (3 - s))        through the corners of triaxial compression
 *     inside        eta = 6 s/(sqrt(3) (3 + s))        through the corners of triaxial extension
 *     plane-strain  eta = 3 t/sqrt(9 + 12 t^2)         the same limit load in plane strain, where the flow is associated
 * and xi = eta/t (de Souza Neto, Peric and Owen 2008, section 6.4.4 and box 8.8; Drucker and Prager 1952). The return is in closed form:
 * to the cone along its flow, or to the apex where the cone would be passed. */
#include "soil.h"

enum { E_, NU, COHESION, FRICTION, DILATION, MATCH, RESIDUAL_COHESION, RESIDUAL_FRICTION, RESIDUAL_DILATION, SOFTENING };
enum match { OUTSIDE, INSIDE, PLANE_STRAIN };

typedef struct law {
    const ab_host *host;
    soil_elastic elastic;
    soil_softening softening;
    double cohesion, friction, dilation, cohesion_change, friction_change, dilation_change; /* Pa, tangents of the angles */
    double constant, square, linear; /* xi = 3/(sqrt(constant + square t^2) + linear t), the three matches in one form */
} law;

/* xi of t = tan(angle), and eta = xi t; outside and inside: 6 s/(sqrt(3) (3 -+ s)) = 3 t/(sqrt(3)/2 (3 sqrt(1 + t^2) -+ t)). */
SOIL_INLINE double reach(const law *l, double t) { return 3.0 / (sqrt(l->constant + l->square * t * t) + l->linear * t); }
SOIL_INLINE double steepness(const law *l, double t) { return t * reach(l, t); }

static __attribute__((noinline)) void check(const void *self, uint32_t components, const double strain[6][SOIL_LANES],
                                            const double stress[6][SOIL_LANES], soil_lanes *lanes) {
    const law l = *(const law *)self;
    soil_trial(l.elastic, components, strain, stress, lanes);
    const double(*s)[SOIL_LANES] = (const double(*)[SOIL_LANES])lanes->trial;
    for (size_t i = 0; i < SOIL_LANES; i++) {
        const double t = soil_share(l.softening, lanes->plastic[i]);
        const double c = l.cohesion + t * l.cohesion_change, tangent = l.friction + t * l.friction_change;
        const double mean = (s[0][i] + s[1][i] + s[2][i]) * (1.0 / 3.0), x = s[0][i] - mean, y = s[1][i] - mean, z = s[2][i] - mean;
        const double root = sqrt(0.5 * (x * x + y * y + z * z) + (s[3][i] * s[3][i] + s[4][i] * s[4][i] + s[5][i] * s[5][i]));
        const double limit = c * reach(&l, tangent);
        lanes->excess[i] = root + steepness(&l, tangent) * mean - limit - SOIL_ROUNDING * (fabs(mean) + limit);
    }
}

static __attribute__((noinline)) void back(const void *self, const double trial[6], double plastic, double stress[6]) {
    const law *l = self;
    const double t = soil_share(l->softening, plastic), c = l->cohesion + t * l->cohesion_change,
                 tangent = l->friction + t * l->friction_change;
    const double eta = steepness(l, tangent), flow = steepness(l, l->dilation + t * l->dilation_change), limit = c * reach(l, tangent);
    const double mean = (trial[0] + trial[1] + trial[2]) / 3;
    double deviator[6], square = 0.0;
    for (int k = 0; k < 6; k++) deviator[k] = k < 3 ? trial[k] - mean : trial[k], square += (k < 3 ? 0.5 : 1.0) * deviator[k] * deviator[k];
    const double root = sqrt(square), outside = root + eta * mean - limit;
    if (outside <= SOIL_ROUNDING * (fabs(mean) + limit)) { /* a softer surface may be out of reach */
        memcpy(stress, trial, 6 * sizeof *stress);
        return;
    }
    const double multiplier = outside / (l->elastic.mu + l->elastic.bulk * eta * flow);
    double pressed = mean - l->elastic.bulk * flow * multiplier,
           left = limit - eta * pressed; /* sqrt(J2) of the cone at that mean stress */
    if (!(root - l->elastic.mu * multiplier > 0.0) || !(left > 0.0)) pressed = eta > 0.0 ? limit / eta : pressed, left = 0.0;
    for (int k = 0; k < 6; k++) stress[k] = (k < 3 ? pressed : 0.0) + (left > 0.0 ? deviator[k] * (left / root) : 0.0);
}

/* As mc_least_softening: f falls by G + K eta eta' per multiplier; the plastic strain of a multiplier is 1/sqrt(3). */
static double least_softening(const law *l) {
    const double residual = l->cohesion + l->cohesion_change, tangent = l->friction + l->friction_change;
    const double lost = l->cohesion * reach(l, l->friction) - residual * reach(l, tangent);
    return lost / (sqrt(3.0) * (l->elastic.mu + l->elastic.bulk * steepness(l, l->friction) * steepness(l, l->dilation)));
}

static int create(const ab_host *host, const ab_value *v, void **self) {
    const soil_strength s = {.cohesion = v[COHESION].real,
                             .friction = v[FRICTION].real,
                             .dilation = v[DILATION].real,
                             .residual_cohesion = soil_residual(v[RESIDUAL_COHESION], v[COHESION]),
                             .residual_friction = soil_residual(v[RESIDUAL_FRICTION], v[FRICTION]),
                             .residual_dilation = soil_residual(v[RESIDUAL_DILATION], v[DILATION])};
    const int64_t match = v[MATCH].integer;
    const double third = sqrt(3.0) / 2;
    law made = {.host = host,
                .elastic = soil_elastic_of(v[E_].real, v[NU].real),
                .cohesion = s.cohesion,
                .friction = tan(s.friction),
                .dilation = tan(s.dilation),
                .cohesion_change = s.residual_cohesion - s.cohesion,
                .friction_change = tan(s.residual_friction) - tan(s.friction),
                .dilation_change = tan(s.residual_dilation) - tan(s.dilation),
                .constant = match == PLANE_STRAIN ? 9.0 : 6.75,
                .square = match == PLANE_STRAIN ? 12.0 : 6.75,
                .linear = match == PLANE_STRAIN ? 0.0
                          : match == OUTSIDE    ? -third
                                                : third};
    if (soil_strength_refused(host, &s)) return -1;
    if (soil_softening_read(host, v + SOFTENING, soil_softens(&s), &made.softening) != 0) return -1;
    if (soil_softens(&s) && soil_softening_refused(host, made.softening, least_softening(&made))) return -1;
    law *l = host->allocate(host->context, sizeof *l);
    if (!l) return -1;
    *l = made;
    *self = l;
    return 0;
}

static void destroy(void *self) {
    const law *made = self;
    made->host->release(made->host->context, self);
}

static int update(void *self, ab_batch *b) {
    const law *l = self;
    return soil_update(l->host, l, &l->elastic, l->softening, b, check, back);
}

static const ab_param params[] = {
    SOIL_ELASTIC_SETTINGS,
    {"cohesion", "Pa", "cohesion of Mohr and Coulomb", NULL, AB_REAL, AB_REQUIRED, 0, 0, INFINITY},
    {"friction", "rad", "angle of friction of Mohr and Coulomb, as in \"30 deg\"", NULL, AB_REAL, AB_REQUIRED | AB_MAX_OPEN, 0, 0,
     SOIL_RIGHT_ANGLE},
    {"dilation", "rad", "angle of dilation, at most the friction; 0: flow keeps the volume", NULL, AB_REAL, AB_MAX_OPEN, 0, 0,
     SOIL_RIGHT_ANGLE},
    {"match", "1",
     "where the cone meets Mohr and Coulomb: at triaxial compression (outside), triaxial extension (inside), or by its limit loads in "
     "plane strain",
     "outside|inside|plane-strain", AB_CHOICE, 0, PLANE_STRAIN, 0, 0},
    SOIL_RESIDUAL_SETTINGS,
    SOIL_SOFTENING_SETTINGS,
};
static const ab_state states[] = {SOIL_STATE};
static const ab_material_ops ops = {sizeof ops, NULL, update};
static const ab_class drucker_prager = {
    SOIL_CLASS_HEAD,
    .name = "drucker-prager",
    .help = "friction and cohesion on a round cone matched to Mohr-Coulomb, softening to residuals",
    .reference = "de Souza Neto, Peric and Owen 2008, box 8.8",
    .destroy = destroy,
    .ops = &ops,
};
static const ab_class *const classes[] = {&drucker_prager};
AB_EXPORT const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "drucker-prager", "1.0", "MIT", classes};
