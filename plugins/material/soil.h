/* soil.h: what the elastoplastic soils have in common: the elastic trial, the pass over a batch, softening, and what is booked as
 * dissipated.
 *
 * A law says by `excess` how far a trial stress is outside of its surface, for eight points at once and without branches, and by `back`
 * takes one trial stress back, in scalar code that is the same whatever stands beside the point. So points that stay elastic cost a few
 * vector operations, and an item has the same bits in any batch.
 *
 * Plastic strain is what the trial stress lost, C : (trial - stress), whatever face, edge or apex took it: its deviatoric part is
 * counted in `plastic_strain` (the rate is sqrt(2/3 e:e)), and stress : plastic strain is dissipated (de Souza Neto, Peric and Owen
 * 2008, chapters 7 and 8). */
#ifndef AB_SOIL_H
#define AB_SOIL_H

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "abut_plugin.h"

#define SOIL_INLINE static inline __attribute__((always_inline))

enum { SOIL_LANES = 8 };
#define SOIL_RIGHT_ANGLE 1.5707963267948966 /* rad */
static const double SOIL_LARGEST = 1e150;   /* Pa: products of larger stresses overflow */
static const double SOIL_ROUNDING = 1e-14;  /* of the stress: closer than that to a surface is on it */

typedef struct soil_elastic {
    double lambda, two_mu, mu, bulk; /* Pa */
} soil_elastic;

static inline soil_elastic soil_elastic_of(double E, double nu) {
    return (soil_elastic){
        .lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), .two_mu = E / (1 + nu), .mu = E / (2 * (1 + nu)), .bulk = E / (3 * (1 - 2 * nu))};
}

/* The first two settings of every law with constant moduli. */
#define SOIL_ELASTIC_SETTINGS                                                                                                              \
    {"E", "Pa", "Young's modulus", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN, 0, 0, INFINITY}, {                                            \
        "nu", "1", "Poisson's ratio", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN | AB_MAX_OPEN, 0, -1, 0.5                                   \
    }

/* ---- strengths: at the peak and at the residual -------------------------------------------------------------------------------------- */

typedef struct soil_strength {
    double cohesion, friction, dilation;                            /* Pa, rad, rad */
    double residual_cohesion, residual_friction, residual_dilation; /* those of the peak where there is none */
} soil_strength;

static inline void soil_say(const ab_host *host, const char *text) { host->message(host->context, text); }

/* What no soil can be; says why. */
static inline bool soil_strength_refused(const ab_host *host, const soil_strength *s) {
    const double degrees = 90 / SOIL_RIGHT_ANGLE;
    char text[300] = "";
    if (s->residual_cohesion > s->cohesion)
        snprintf(text, sizeof text, "residual_cohesion %g Pa is above the cohesion %g Pa: softening only goes down", s->residual_cohesion,
                 s->cohesion);
    else if (s->residual_friction > s->friction)
        snprintf(text, sizeof text, "residual_friction %g deg is above the friction %g deg: softening only goes down",
                 s->residual_friction * degrees, s->friction * degrees);
    else if (s->dilation > s->friction)
        snprintf(text, sizeof text,
                 "dilation %g deg is above the friction %g deg: such a soil would make energy; give a dilation of at most the friction",
                 s->dilation * degrees, s->friction * degrees);
    else if (s->residual_dilation > s->dilation)
        snprintf(text, sizeof text, "residual_dilation %g deg is above the dilation %g deg: softening only goes down",
                 s->residual_dilation * degrees, s->dilation * degrees);
    else if (s->residual_dilation > s->residual_friction)
        snprintf(
            text, sizeof text,
            "at the residual the dilation of %g deg would be above the friction of %g deg, and make energy; give a residual_dilation of "
            "at most that",
            s->residual_dilation * degrees, s->residual_friction * degrees);
    else if (s->cohesion == 0 && s->friction == 0)
        snprintf(text, sizeof text, "neither cohesion nor friction: such a soil bears no shear at all; give one of them");
    if (text[0]) soil_say(host, text);
    return text[0] != '\0';
}

static inline bool soil_softens(const soil_strength *s) {
    return s->residual_cohesion < s->cohesion || s->residual_friction < s->friction || s->residual_dilation < s->dilation;
}

/* The value where it is given, else the peak. */
static inline double soil_residual(ab_value residual, ab_value peak) { return residual.given ? residual.real : peak.real; }

/* ---- softening ----------------------------------------------------------------------------------------------------------------------- */

/* Strength falls linearly over the equivalent plastic strain and stays at its residual from `end` on; end = 0: no softening. */
typedef struct soil_softening {
    double end, per_end;
} soil_softening;

/* Residual strengths of laws with cohesion and friction. */
#define SOIL_RESIDUAL_SETTINGS                                                                                                             \
    {"residual_cohesion", "Pa", "cohesion after softening; without it the cohesion stays", NULL, AB_REAL, 0, INFINITY, 0, INFINITY},       \
        {"residual_friction", "rad", "friction after softening; without it the friction stays", NULL, AB_REAL, 0, SOIL_RIGHT_ANGLE, 0,     \
         SOIL_RIGHT_ANGLE},                                                                                                                \
    {                                                                                                                                      \
        "residual_dilation", "rad", "dilation after softening; without it the dilation stays", NULL, AB_REAL, 0, SOIL_RIGHT_ANGLE, 0,      \
            SOIL_RIGHT_ANGLE                                                                                                               \
    }

/* What the classes of all soils with a fixed strength have in common; `params`, `states` and `create` are the file's own. */
#define SOIL_CLASS_HEAD                                                                                                                    \
    .struct_size = sizeof(ab_class), .kind = AB_MATERIAL, .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D,                       \
    .gives = AB_GIVE_STRESS | AB_GIVE_DISSIPATION | AB_GIVE_WAVE_SPEED, .nparam = sizeof params / sizeof *params, .nstate = 1,             \
    .param = params, .state = states, .create = create

#define SOIL_SOFTENING_SETTINGS                                                                                                            \
    {"softening_strain", "1", "equivalent plastic strain at which the residuals are reached", NULL, AB_REAL, 0, INFINITY, 0, INFINITY},    \
        {"softening_slip",                                                                                                                 \
         "m",                                                                                                                              \
         "instead of softening_strain: slip along a shear band at which the residuals are reached; needs length",                          \
         NULL,                                                                                                                             \
         AB_REAL,                                                                                                                          \
         0,                                                                                                                                \
         INFINITY,                                                                                                                         \
         0,                                                                                                                                \
         INFINITY},                                                                                                                        \
    {                                                                                                                                      \
        "length", "m", "thickness of a shear band as the mesh resolves it, about two cells; with softening_slip", NULL, AB_REAL, 0, 0, 0,  \
            INFINITY                                                                                                                       \
    }
enum { SOIL_SOFTENING_STRAIN, SOIL_SOFTENING_SLIP, SOIL_SOFTENING_LENGTH };

/* Reads the three settings from `s` on. `softens`: some residual is below its peak. Returns 0, or -1 with a message. In simple shear
 * over a band of thickness `length` the equivalent plastic strain of a slip is slip/(sqrt(3) length): with it the work that the band
 * takes does not hang on the mesh. */
static inline int soil_softening_read(const ab_host *host, const ab_value *s, bool softens, soil_softening *made) {
    const bool strain = s[SOIL_SOFTENING_STRAIN].given, slip = s[SOIL_SOFTENING_SLIP].given, length = s[SOIL_SOFTENING_LENGTH].given;
    *made = (soil_softening){0, 0};
    const char *why = NULL;
    if (!softens && (strain || slip || length))
        why = "softening_strain, softening_slip and length say how fast strength falls, and no residual is given: give a residual below "
              "its peak, or leave them out";
    else if (softens && !strain && !slip)
        why = "a residual is given, and not at which plastic strain it is reached: give softening_strain, or softening_slip with length";
    else if (strain && slip)
        why = "softening_strain and softening_slip say the same thing twice: give one of them";
    else if (slip != length)
        why = slip ? "softening_slip needs length, the thickness of a shear band as the mesh resolves it (about two cells)"
                   : "length goes with softening_slip, which is not given";
    else if ((strain && !(s[SOIL_SOFTENING_STRAIN].real > 0)) ||
             (slip && !(s[SOIL_SOFTENING_SLIP].real > 0 && s[SOIL_SOFTENING_LENGTH].real > 0)))
        why = "softening_strain, softening_slip and length must be above 0: strength cannot fall at once";
    if (why) return soil_say(host, why), -1;
    if (!softens) return 0;
    const double end = strain ? s[SOIL_SOFTENING_STRAIN].real : s[SOIL_SOFTENING_SLIP].real / (sqrt(3.0) * s[SOIL_SOFTENING_LENGTH].real);
    *made = (soil_softening){end, 1 / end};
    return 0;
}

/* Softening faster than elasticity can unload makes the stress of a strain ambiguous; `least` is the end that it must be above. */
static inline bool soil_softening_refused(const ab_host *host, soil_softening s, double least) {
    char text[300];
    if (s.end > least) return false;
    snprintf(text, sizeof text,
             "the strength falls to its residual within a plastic strain of %g, faster than elasticity can unload: it must be above %g (a "
             "longer softening_strain or softening_slip, a smaller length, or a stiffer soil)",
             s.end, least);
    return soil_say(host, text), true;
}

SOIL_INLINE double soil_share(soil_softening s, double plastic) { /* 0 at the peak, 1 at the residual */
    const double share = plastic * s.per_end;
    return share < 1.0 ? share : 1.0;
}

/* ---- the return of one point --------------------------------------------------------------------------------------------------------- */

typedef struct soil_answer {
    double stress[6], plastic; /* plastic: of the step */
    double dissipation;        /* J/m3 */
} soil_answer;

/* Plastic strain and dissipation of a return from `trial` to answer->stress. */
static inline void soil_account(const soil_elastic *e, const double trial[6], soil_answer *answer) {
    const double *s = answer->stress;
    const double mean_trial = (trial[0] + trial[1] + trial[2]) / 3, mean = (s[0] + s[1] + s[2]) / 3;
    double square = 0.0, work = 0.0;
    for (int c = 0; c < 6; c++) {
        const double lost = c < 3 ? (trial[c] - mean_trial) - (s[c] - mean) : trial[c] - s[c], twice = c < 3 ? 1.0 : 2.0;
        square += twice * lost * lost;
        work += twice * (c < 3 ? s[c] - mean : s[c]) * lost;
    }
    answer->plastic = sqrt(2.0 / 3.0 * square) / e->two_mu;
    const double dissipation = work / e->two_mu + mean * (mean_trial - mean) / e->bulk;
    answer->dissipation = dissipation > 0.0 ? dissipation : 0.0; /* it is, but for rounding where nothing is dissipated (at an apex) */
}

/* Takes `trial` back to the surface that belongs to the plastic strain `hardness`; fills stress alone. */
typedef void (*soil_back)(const void *law, const double trial[6], double hardness, double stress[6]);

SOIL_INLINE double soil_try(const void *law, const soil_elastic *e, soil_back back, const double trial[6], double hardness,
                            soil_answer *answer) {
    back(law, trial, hardness, answer->stress);
    soil_account(e, trial, answer);
    return answer->plastic;
}

/* The plastic strain at the end of the step, implicitly: p = p0 + (what a return to the surface of p takes). The difference of both
 * sides is not negative at p0; either it is not at the end of the softening, where the answer is then exact, or there is a root between,
 * found by false position with halving (Illinois; Dowell and Jarratt 1971). The stress is on the surface of the p that is returned. */
SOIL_INLINE double soil_soften(const void *law, const soil_elastic *e, soil_softening s, soil_back back, const double trial[6],
                               double plastic0, soil_answer *answer) {
    if (plastic0 >= s.end) return plastic0 + soil_try(law, e, back, trial, plastic0, answer);
    double low = plastic0, high = s.end, at_low = soil_try(law, e, back, trial, low, answer);
    if (at_low == 0.0) return plastic0;
    double at_high = plastic0 + soil_try(law, e, back, trial, high, answer) - high;
    if (at_high >= 0.0) return at_high + high;
    double point = low;
    int side = 0;
    for (int n = 0; n < 100; n++) {
        point = (low * at_high - high * at_low) / (at_high - at_low);
        if (!(point > low && point < high)) point = 0.5 * (low + high);
        if (n % 8 == 7) point = 0.5 * (low + high);
        const double flow = soil_try(law, e, back, trial, point, answer), rest = plastic0 + flow - point;
        if (fabs(rest) <= 1e-13 * flow || !(point > low && point < high)) break;
        if (rest > 0.0) {
            low = point, at_low = rest;
            if (side > 0) at_high *= 0.5;
            side = 1;
        } else {
            high = point, at_high = rest;
            if (side < 0) at_low *= 0.5;
            side = -1;
        }
    }
    return point;
}

/* ---- the pass over a batch ----------------------------------------------------------------------------------------------------------- */

typedef struct soil_lanes { /* eight points */
    double trial[6][SOIL_LANES], plastic[SOIL_LANES], excess[SOIL_LANES];
} soil_lanes;

/* Copies up to eight items, the last one again in lanes that are free: what is computed from them is then the same code in every batch. */
static inline void soil_load(const ab_batch *b, size_t first, double strain[6][SOIL_LANES], double stress[6][SOIL_LANES], soil_lanes *l) {
    const size_t count = b->count - first < SOIL_LANES ? b->count - first : SOIL_LANES;
    if (count == SOIL_LANES) {
        for (uint32_t c = 0; c < b->components; c++) {
            memcpy(strain[c], b->strain_increment + c * b->ld + first, sizeof strain[c]);
            memcpy(stress[c], b->stress0 + c * b->ld + first, sizeof stress[c]);
        }
        memcpy(l->plastic, b->state0 + first, sizeof l->plastic);
        return;
    }
    for (uint32_t c = 0; c < b->components; c++)
        for (size_t i = 0; i < SOIL_LANES; i++) {
            const size_t from = c * b->ld + first + (i < count ? i : count - 1);
            strain[c][i] = b->strain_increment[from];
            stress[c][i] = b->stress0[from];
        }
    for (size_t i = 0; i < SOIL_LANES; i++) l->plastic[i] = b->state0[first + (i < count ? i : count - 1)];
}

/* Elastic trial of eight points; rows beyond the components become 0. */
SOIL_INLINE void soil_trial(soil_elastic e, uint32_t components, const double strain[restrict 6][SOIL_LANES],
                            const double stress[restrict 6][SOIL_LANES], soil_lanes *restrict l) {
    for (size_t i = 0; i < SOIL_LANES; i++) {
        const double volumetric = e.lambda * (strain[0][i] + strain[1][i] + strain[2][i]);
        for (int c = 0; c < 3; c++) l->trial[c][i] = stress[c][i] + (volumetric + e.two_mu * strain[c][i]);
        l->trial[3][i] = stress[3][i] + e.mu * strain[3][i];
        for (int c = 4; c < 6; c++) l->trial[c][i] = components == 6 ? stress[c][i] + e.mu * strain[c][i] : 0.0;
    }
}

/* Writes item i of the batch. */
static inline void soil_store(const ab_batch *b, size_t i, const double stress[6], double plastic, double dissipation) {
    for (uint32_t c = 0; c < b->components; c++) b->stress1[c * b->ld + i] = stress[c];
    b->state1[i] = plastic;
    b->dissipation[i] = dissipation;
}

static inline bool soil_is_finite(const double trial[6]) {
    for (int c = 0; c < 6; c++)
        if (!(fabs(trial[c]) < SOIL_LARGEST)) return false; /* NaN is not, either */
    return true;
}

/* Writes the items from `first` on where all of them stay elastic, which most do most of the time; else false. */
static inline bool soil_store_elastic(const ab_batch *b, size_t first, const soil_lanes *l) {
    const size_t count = b->count - first < SOIL_LANES ? b->count - first : SOIL_LANES;
    long yields = 0;
    for (size_t i = 0; i < SOIL_LANES; i++) {
        double size = 0.0;
        for (int c = 0; c < 6; c++) size += fabs(l->trial[c][i]);
        yields += !(l->excess[i] <= 0.0 && size < SOIL_LARGEST);
    }
    if (yields) return false;
    for (uint32_t c = 0; c < b->components; c++) memcpy(b->stress1 + c * b->ld + first, l->trial[c], count * sizeof(double));
    memcpy(b->state1 + first, l->plastic, count * sizeof(double));
    memset(b->dissipation + first, 0, count * sizeof(double));
    return true;
}

/* Not a number, or so large that the next products overflow: the item keeps what it had, and is flagged. */
static inline void soil_refuse(const ab_host *host, const ab_batch *b, size_t i) {
    double stress[6];
    for (uint32_t c = 0; c < b->components; c++) stress[c] = b->stress0[c * b->ld + i];
    soil_store(b, i, stress, b->state0[i], 0.0);
    b->flag[i] = 1;
    soil_say(host, "the strain increment of a step is not a number, or larger than any material can follow");
}

/* `check` fills l->trial and l->excess (a positive one, or NaN, yields) from strain and stress. */
SOIL_INLINE int soil_update(const ab_host *host, const void *law, const soil_elastic *e, soil_softening s, ab_batch *b,
                            void (*check)(const void *law, uint32_t components, const double strain[6][SOIL_LANES],
                                          const double stress[6][SOIL_LANES], soil_lanes *l),
                            soil_back back) {
    double strain[6][SOIL_LANES], stress[6][SOIL_LANES];
    soil_lanes l;
    int status = 0;
    for (size_t first = 0; first < b->count; first += SOIL_LANES) {
        soil_load(b, first, strain, stress, &l);
        check(law, b->components, (const double(*)[SOIL_LANES])strain, (const double(*)[SOIL_LANES])stress, &l);
        if (soil_store_elastic(b, first, &l)) continue;
        for (size_t i = 0; i < SOIL_LANES && first + i < b->count; i++) {
            double trial[6];
            for (int c = 0; c < 6; c++) trial[c] = l.trial[c][i];
            if (!soil_is_finite(trial)) {
                soil_refuse(host, b, first + i), status = -1;
                continue;
            }
            if (l.excess[i] <= 0.0) {
                soil_store(b, first + i, trial, l.plastic[i], 0.0);
                continue;
            }
            soil_answer answer;
            double plastic;
            if (s.end > 0.0)
                plastic = soil_soften(law, e, s, back, trial, l.plastic[i], &answer);
            else
                plastic = l.plastic[i] + soil_try(law, e, back, trial, 0.0, &answer);
            soil_store(b, first + i, answer.stress, plastic, answer.dissipation);
        }
    }
    if (b->wave_speed)
        for (size_t i = 0; i < b->count; i++) b->wave_speed[i] = sqrt((e->lambda + e->two_mu) / b->density[i]);
    return status;
}

#define SOIL_STATE                                                                                                                         \
    {                                                                                                                                      \
        "plastic_strain", "1", "equivalent plastic strain: sqrt(2/3 e:e) of the deviator of the plastic strain, added up", AB_SCALAR,      \
            AB_AVERAGE, 0                                                                                                                  \
    }

#endif
