/* modified_cam_clay.c: normally and lightly overconsolidated clay by the critical state: modified Cam clay (Roscoe and Burland 1968).
 *
 * Inside, with pressure p = -(xx + yy + zz)/3, q = sqrt(3/2 s:s), specific volume v = 1 + void ratio and preconsolidation pc,
 *     f = q^2/M^2 + p (p - pc) <= 0,   flow along its gradient,
 *     dv = -kappa dp/p  elastic,   dv = -(lambda - kappa) dpc/pc  plastic.
 * Both laws of volume are integrated exactly over a step: v follows the strain, v1 = v0 exp(strain), and p1 = p0 exp((v0 - v1)/kappa)
 * with nothing plastic, so that a closed path of volume ends at the pressure it began with, and the pressure is never tensile. Shear is
 * elastic with a given G (an energy exists), or with Poisson's ratio: then G = 3 (1 - 2 nu)/(2 (1 + nu)) v p/kappa, exact along a
 * straight path of strain, but no energy exists (Zytynski et al. 1978): closed paths of p and q may make or lose some.
 *
 * The return is implicit in the direction of flow, as that of Borja and Lee (1990), here with one unknown: the end is at an angle a on
 * the ellipse,
 *     p1 = pc1 (1 + cos a)/2,   q1 = M pc1/2 sin a.
 * The two laws of volume give X = ln(pc1/pc0) = kappa/lambda (ln(pt/pc0) - 2 ln cos(a/2)) for the elastic pressure pt, and the flow rule
 *     (lambda - kappa) X sin a/v = M/(6 G) cos a (2 qt - M pc1 sin a).
 * Between the angle where X = 0 (or 0, where pt > pc0) and the critical state a = pi/2 the two sides change over: the root is bracketed
 * from the start, on the wet and on the dry side, and whatever it is, the stress is on the ellipse to rounding. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "abut_plugin.h"

enum { KAPPA, LAMBDA, M_, G_, NU, VOID_RATIO, PRESSURE, OVERCONSOLIDATION };
enum { PRECONSOLIDATION_ROW, VOID_ROW, PLASTIC_ROW, ROWS };

static const double LARGEST = 1e150;     /* Pa: squares of larger stresses overflow */
static const double VANISHED = 1e-100;   /* of the first pressure: what is less than that stays there */
static const double SUBSTEP = 0.1;       /* of kappa/v: largest component of strain in one go; */
static const double MOST_SUBSTEPS = 100; /* both only hang on the strain, so that the answer is the same everywhere */

typedef struct law {
    const ab_host *host;
    double kappa, lambda, M, G, ratio; /* ratio: G over bulk modulus, where G is 0 */
    double v, pressure, preconsolidation;
} law;

typedef struct clay { /* one point */
    double deviator[6], p, pc, v, plastic, dissipation;
} clay;

static int refuse(const ab_host *host, const char *text) { return host->message(host->context, text), -1; }

static int create(const ab_host *host, const ab_value *s, void **self) {
    char text[240];
    const double kappa = s[KAPPA].real, lambda = s[LAMBDA].real, nu = s[NU].real;
    if (lambda <= kappa) {
        snprintf(text, sizeof text, "lambda %g is not above kappa %g: a clay is softer on first loading than on unloading", lambda, kappa);
        return refuse(host, text);
    }
    if (s[G_].given == s[NU].given)
        return refuse(host, s[G_].given ? "G and nu say the same thing twice: give one of them" : "give G or nu, the stiffness in shear");
    if (s[G_].given && !(s[G_].real > 0)) return refuse(host, "G must be above 0");
    law *l = host->allocate(host->context, sizeof *l);
    if (!l) return -1;
    *l = (law){.host = host,
               .kappa = kappa,
               .lambda = lambda,
               .M = s[M_].real,
               .G = s[G_].given ? s[G_].real : 0,
               .ratio = 3 * (1 - 2 * nu) / (2 * (1 + nu)),
               .v = 1 + s[VOID_RATIO].real,
               .pressure = s[PRESSURE].real,
               .preconsolidation = s[PRESSURE].real * s[OVERCONSOLIDATION].real};
    *self = l;
    return 0;
}

static void destroy(void *self) {
    const law *made = self;
    made->host->release(made->host->context, self);
}

/* (exp(x) - 1)/x */
static double grown(double x) { return fabs(x) < 1e-8 ? 1.0 + 0.5 * x : expm1(x) / x; }

typedef struct step {
    double log_ratio, q, stiff, v; /* ln(pt/pc0); qt; M/(6 G); mean specific volume */
} step;

/* Left side less right side of the flow rule at angle a. */
static double rest(const law *l, const clay *c, const step *s, double a) {
    const double X = l->kappa / l->lambda * (s->log_ratio - 2.0 * log(cos(0.5 * a)));
    return (l->lambda - l->kappa) * X * sin(a) / s->v - s->stiff * cos(a) * (2.0 * s->q - l->M * c->pc * exp(X) * sin(a));
}

/* The root between low and high by false position with halving (Illinois; Dowell and Jarratt 1971); rest is not above 0 at low, not
 * below at high. */
static double find_angle(const law *l, const clay *c, const step *s, double low, double high) {
    double at_low = rest(l, c, s, low), at_high = rest(l, c, s, high);
    if (!(at_low < 0.0)) return low;
    if (!(at_high > 0.0)) return high;
    double a = low;
    int side = 0;
    for (int n = 0; n < 120 && high - low > 1e-15; n++) {
        const double before = a;
        a = (low * at_high - high * at_low) / (at_high - at_low);
        if (!(a > low && a < high) || n % 6 == 5) a = 0.5 * (low + high);
        const double at = rest(l, c, s, a);
        if (at == 0.0 || (n > 2 && fabs(a - before) < 1e-15)) break;
        if (at < 0.0) {
            low = a, at_low = at;
            if (side < 0) at_high *= 0.5;
            side = -1;
        } else {
            high = a, at_high = at;
            if (side > 0) at_low *= 0.5;
            side = 1;
        }
    }
    return a;
}

/* One strain increment (engineering shear). False: compressed below the volume of the grains, or too large to follow. */
static bool advance(const law *l, const double strain[6], clay *c) {
    const double squeezed = -(strain[0] + strain[1] + strain[2]);
    const double mean_v = c->v * grown(-squeezed), lost = mean_v * squeezed, v = c->v - lost; /* v0 exp(-squeezed) */
    if (!(v > 1.0 && v < LARGEST)) return false;
    const double log_growth = lost / l->kappa, limited = fmin(fmax(log_growth, -600.0), 600.0);
    const double bulk = fabs(squeezed) < 1e-12 ? c->v * c->p / l->kappa : c->p * expm1(limited) / squeezed; /* mean of the elastic path */
    const double G = l->G > 0.0 ? l->G : l->ratio * bulk;
    double trial[6], square = 0.0;
    for (int k = 0; k < 6; k++) trial[k] = c->deviator[k] + (k < 3 ? 2.0 * G * (strain[k] + squeezed * (1.0 / 3.0)) : G * strain[k]);
    trial[2] = -(trial[0] + trial[1]); /* else rounding of a large step would be left as pressure */
    for (int k = 0; k < 6; k++) {
        if (!(fabs(trial[k]) < LARGEST)) return false;
        square += (k < 3 ? 1.5 : 3.0) * trial[k] * trial[k];
    }
    const double least = VANISHED * l->pressure, p = fmax(c->p * exp(limited), least), q = sqrt(square);
    c->v = v;
    if (q * q / (l->M * l->M) + p * (p - c->pc) <= 1e-14 * (c->pc * c->pc)) {
        for (int k = 0; k < 6; k++) c->deviator[k] = trial[k];
        c->p = p;
        return true;
    }
    const double half_pi = 1.5707963267948966;
    const step s = {.log_ratio = log(p / c->pc), .q = q, .stiff = l->M / (6.0 * G), .v = mean_v};
    const double neutral = p < c->pc ? 2.0 * acos(sqrt(p / c->pc)) : 0.0; /* the angle at which nothing plastic happens to the volume */
    const double a = find_angle(l, c, &s, fmin(neutral, half_pi), fmax(neutral, half_pi));
    const double X = l->kappa / l->lambda * (s.log_ratio - 2.0 * log(cos(0.5 * a)));
    const double pc = c->pc * exp(X), half = cos(0.5 * a), p1 = fmax(pc * half * half, least), q1 = 0.5 * l->M * pc * sin(a);
    if (!(pc < LARGEST && p1 < LARGEST)) return false;
    const double slid = fmax(q - q1, 0.0) / (3.0 * G), work = p1 * (l->lambda - l->kappa) * X / mean_v + q1 * slid;
    for (int k = 0; k < 6; k++) c->deviator[k] = q > 0.0 ? trial[k] * (q1 / q) : 0.0;
    c->p = p1;
    c->pc = pc;
    c->plastic += slid;
    c->dissipation += work > 0.0 ? work : 0.0; /* p pc dphi: not negative but by rounding */
    return true;
}

/* Item i of the batch; the same code for every batch, so that an item has the same bits in any. */
static __attribute__((noinline)) bool follow(const law *l, const ab_batch *b, size_t i, clay *c) {
    const size_t ld = b->ld;
    double strain[6] = {0}, square = 0.0, stress[6] = {0};
    for (uint32_t k = 0; k < b->components; k++) {
        strain[k] = b->strain_increment[k * ld + i], stress[k] = b->stress0[k * ld + i];
        if (!(fabs(stress[k]) < LARGEST) || !(fabs(strain[k]) < LARGEST)) return false;
        square += (k < 3 ? 1.0 : 0.5) * strain[k] * strain[k];
    }
    const double largest = sqrt(square); /* sqrt(e:e): the same however the axes lie, and so is the number of parts */
    const double mean = (stress[0] + stress[1] + stress[2]) / 3;
    for (int k = 0; k < 6; k++) c->deviator[k] = k < 3 ? stress[k] - mean : stress[k];
    c->p = fmax(-mean, VANISHED * l->pressure);
    c->pc = b->state0[PRECONSOLIDATION_ROW * ld + i];
    c->v = 1.0 + b->state0[VOID_ROW * ld + i];
    c->plastic = b->state0[PLASTIC_ROW * ld + i];
    c->dissipation = 0.0;
    const double parts = fmin(fmax(ceil(largest * c->v / (SUBSTEP * l->kappa)), 1.0), MOST_SUBSTEPS);
    for (int k = 0; k < 6; k++) strain[k] /= parts;
    for (int n = 0; n < (int)parts; n++)
        if (!advance(l, strain, c)) return false;
    return true;
}

static double wave_speed(const law *l, double v, double p, double density) {
    const double bulk = v * p / l->kappa;
    return sqrt((bulk + 4.0 / 3.0 * (l->G > 0.0 ? l->G : l->ratio * bulk)) / density);
}

static int update(void *self, ab_batch *b) {
    const law *l = self;
    const size_t ld = b->ld;
    int status = 0;
    for (size_t i = 0; i < b->count; i++) {
        clay c;
        if (follow(l, b, i, &c)) {
            for (uint32_t k = 0; k < 3; k++) b->stress1[k * ld + i] = c.deviator[k] - c.p;
            for (uint32_t k = 3; k < b->components; k++) b->stress1[k * ld + i] = c.deviator[k];
            b->state1[PRECONSOLIDATION_ROW * ld + i] = c.pc;
            b->state1[VOID_ROW * ld + i] = c.v - 1.0;
            b->state1[PLASTIC_ROW * ld + i] = c.plastic;
            b->dissipation[i] = c.dissipation;
        } else {
            for (uint32_t k = 0; k < b->components; k++) b->stress1[k * ld + i] = b->stress0[k * ld + i];
            for (int r = 0; r < ROWS; r++) b->state1[(size_t)r * ld + i] = b->state0[(size_t)r * ld + i];
            b->dissipation[i] = 0.0;
            b->flag[i] = 1;
            status = -1;
            l->host->message(l->host->context, "the strain increment of a step is not a number, or compresses the clay below the volume of "
                                               "its grains (void ratio 0) or to "
                                               "stresses above 1e150 Pa");
        }
        if (b->wave_speed) {
            const double mean = (b->stress1[i] + b->stress1[ld + i] + b->stress1[2 * ld + i]) / 3;
            b->wave_speed[i] = wave_speed(l, 1.0 + b->state1[VOID_ROW * ld + i], fmax(-mean, VANISHED * l->pressure), b->density[i]);
        }
    }
    return status;
}

/* Begins with the stress of stress0: the ellipse through it, larger by the overconsolidation. False: it is not under pressure. */
static bool begin_with(const law *l, ab_batch *b, size_t i) {
    double stress[6] = {0}, square = 0.0;
    for (uint32_t k = 0; k < b->components; k++) stress[k] = b->stress0[k * b->ld + i];
    const double p = -(stress[0] + stress[1] + stress[2]) / 3;
    if (!(p > VANISHED * l->pressure)) return false;
    for (int k = 0; k < 6; k++) {
        const double s = k < 3 ? stress[k] + p : stress[k];
        square += (k < 3 ? 1.5 : 3.0) * s * s;
    }
    for (uint32_t k = 0; k < b->components; k++) b->stress1[k * b->ld + i] = stress[k];
    b->state1[PRECONSOLIDATION_ROW * b->ld + i] = l->preconsolidation / l->pressure * (p + square / (l->M * l->M * p));
    b->state1[VOID_ROW * b->ld + i] = l->v - 1.0;
    b->state1[PLASTIC_ROW * b->ld + i] = 0.0;
    b->wave_speed[i] = wave_speed(l, l->v, p, b->density[i]);
    return true;
}

static int start(void *self, ab_batch *b) {
    const law *l = self;
    for (size_t i = 0; i < b->count; i++) {
        bool given = false;
        for (uint32_t k = 0; k < b->components; k++) given = given || b->stress0[k * b->ld + i] != 0.0;
        if (given && begin_with(l, b, i)) continue;
        if (given) {
            b->flag[i] = 1;
            return refuse(l->host, "the clay has no stiffness without pressure: its mean stress must be below 0; give a surcharge");
        }
        for (uint32_t k = 0; k < b->components; k++) b->stress1[k * b->ld + i] = k < 3 ? -l->pressure : 0.0;
        b->state1[PRECONSOLIDATION_ROW * b->ld + i] = l->preconsolidation;
        b->state1[VOID_ROW * b->ld + i] = l->v - 1.0;
        b->state1[PLASTIC_ROW * b->ld + i] = 0.0;
        b->wave_speed[i] = wave_speed(l, l->v, l->pressure, b->density[i]);
    }
    return 0;
}

static const ab_param params[] = {
    {"kappa", "1", "slope of unloading: void ratio over ln(pressure)", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN, 0, 0, INFINITY},
    {"lambda", "1", "slope of first loading: void ratio over ln(pressure)", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN, 0, 0, INFINITY},
    {"M", "1", "slope of the critical state, q/p; 6 sin(phi)/(3 - sin(phi)) for triaxial compression", NULL, AB_REAL,
     AB_REQUIRED | AB_MIN_OPEN, 0, 0, INFINITY},
    {"G", "Pa", "shear modulus, constant; this or nu", NULL, AB_REAL, 0, 0, 0, INFINITY},
    {"nu", "1", "Poisson's ratio, with a shear modulus in proportion to the bulk modulus; this or G", NULL, AB_REAL,
     AB_MIN_OPEN | AB_MAX_OPEN, 0, -1, 0.5},
    {"void_ratio", "1", "void ratio at the start", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN, 0, 0, INFINITY},
    {"pressure", "Pa",
     "pressure at the start, the same all around; walls or loads must bear it. Where the scene gives the stress at the start (initial), "
     "that is taken",
     NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN, 0, 0, INFINITY},
    {"overconsolidation", "1", "largest pressure that the clay has borne, over the pressure at the start", NULL, AB_REAL, 0, 1, 1,
     INFINITY},
};
static const ab_state states[] = {
    {"preconsolidation", "Pa", "size of the yield surface: pressure at which isotropic first loading goes on", AB_SCALAR, AB_AVERAGE, 0},
    {"void_ratio", "1", "volume of voids over volume of grains", AB_SCALAR, AB_AVERAGE, 0},
    {"plastic_strain", "1", "equivalent plastic strain: sqrt(2/3 e:e) of the deviator of the plastic strain, added up", AB_SCALAR,
     AB_AVERAGE, 0},
};
static const ab_material_ops ops = {sizeof ops, start, update};
static const ab_class modified_cam_clay = {
    .struct_size = sizeof(ab_class),
    .kind = AB_MATERIAL,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D,
    .needs = AB_NEED_DENSITY, /* for a wave speed that follows the pressure */
    .gives = AB_GIVE_STRESS | AB_GIVE_DISSIPATION | AB_GIVE_WAVE_SPEED,
    .nparam = sizeof params / sizeof *params,
    .nstate = ROWS,
    .name = "modified-cam-clay",
    .help = "clay by the critical state: pressure-dependent stiffness, hardening and softening with the volume",
    .reference = "Roscoe and Burland 1968; Borja and Lee 1990",
    .param = params,
    .state = states,
    .create = create,
    .destroy = destroy,
    .ops = &ops,
};
static const ab_class *const classes[] = {&modified_cam_clay};
AB_EXPORT const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "modified-cam-clay", "1.0", "MIT", classes};
