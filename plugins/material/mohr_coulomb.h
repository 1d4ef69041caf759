/* mohr_coulomb.h: the surface of Mohr and Coulomb with a tension cut-off, for the laws mohr-coulomb and tresca.
 *
 * With principal stresses s1 >= s2 >= s3 (tension positive), cohesion c, friction phi, dilation psi and tensile strength T
 *     f_ij = (s_i - s_j) + (s_i + s_j) sin phi - 2 c cos phi <= 0,    s_i <= T,
 * which flow along the gradients of (s_i - s_j) + (s_i + s_j) sin psi and of s_i. All are planes, so the return is linear in principal
 * stresses on each face, edge and corner (Koiter 1953; Clausen, Damkilde and Andersen 2006; de Souza Neto, Peric and Owen 2008, section
 * 8.2). Where the trial stress is sorted only the planes of 1-3, 1-2, 2-3 and of T can carry it: every way to hold on to one, two or
 * three of them is solved, and the first counts that neither pulls (a negative multiplier) nor leaves another plane violated. What
 * counts is then put onto its planes once more, so that it is there to the rounding of the stress itself and not of the trial stress. */
#ifndef AB_MOHR_COULOMB_H
#define AB_MOHR_COULOMB_H

#include "principal.h"
#include "soil.h"

typedef struct mc_strength { /* at one plastic strain */
    double sine, k;          /* sin phi; 2 c cos phi, Pa */
    double dilation;         /* sin psi */
    double tension;          /* Pa; never above the apex */
    double apex;             /* c cot phi, Pa; INFINITY without friction */
} mc_strength;

typedef struct mc_law {
    const ab_host *host;
    soil_elastic elastic;
    soil_softening softening;
    double cohesion, friction, dilation;                      /* peak: c, tan phi, tan psi */
    double cohesion_change, friction_change, dilation_change; /* residual less peak */
    double tension, tension_change;                           /* INFINITY, 0: none given */
    mc_strength peak;
} mc_law;

/* Everything at the share t of the softening; plain arithmetic, for vector code. c and tan phi are linear in t, so that the strength of
 * a plane under a given pressure falls linearly; the tensile strength falls with c. */
SOIL_INLINE void mc_at(const mc_law *l, double t, double *sine, double *k, double *tension) {
    const double c = l->cohesion + t * l->cohesion_change, tangent = l->friction + t * l->friction_change;
    const double cosine = 1.0 / sqrt(1.0 + tangent * tangent);
    *sine = tangent * cosine;
    *k = 2.0 * c * cosine;
    *tension = l->tension + t * l->tension_change;
}

static inline mc_strength mc_strength_at(const mc_law *l, double t) {
    mc_strength s;
    mc_at(l, t, &s.sine, &s.k, &s.tension);
    const double tangent = l->dilation + t * l->dilation_change;
    s.dilation = tangent / sqrt(1.0 + tangent * tangent);
    s.apex = s.sine > 0.0 ? s.k / (2.0 * s.sine) : INFINITY;
    if (!(s.tension < s.apex)) s.tension = s.apex;
    return s;
}

/* How far eight points are outside; in space every point goes to the scalar code, which finds its principal stresses. */
SOIL_INLINE void mc_excess_plane(const mc_law *law, soil_lanes *l) {
    for (size_t i = 0; i < SOIL_LANES; i++) {
        double sine, k, tension;
        mc_at(law, soil_share(law->softening, l->plastic[i]), &sine, &k, &tension);
        const double middle = 0.5 * (l->trial[0][i] + l->trial[1][i]), half = 0.5 * (l->trial[0][i] - l->trial[1][i]),
                     shear = l->trial[3][i];
        const double radius = sqrt(half * half + shear * shear), zz = l->trial[2][i];
        const double larger = middle + radius, smaller = middle - radius;
        const double s1 = larger > zz ? larger : zz, s3 = smaller < zz ? smaller : zz;
        const double slip = (s1 - s3) + (s1 + s3) * sine - k, pull = s1 - tension, worst = slip > pull ? slip : pull;
        l->excess[i] = worst - SOIL_ROUNDING * (fabs(s1) + fabs(s3) + k);
    }
}

/* ---- the return in principal stresses ------------------------------------------------------------------------------------------------ */

enum { MC_13, MC_12, MC_23, MC_T1, MC_T2, MC_T3, MC_PLANES };

typedef struct mc_planes {
    double a[MC_PLANES][3], b[MC_PLANES]; /* a . s <= b */
    double m[MC_PLANES][3];               /* elasticity times the direction of flow: what a multiplier of 1 takes off the stress */
    bool cut;                             /* there are planes of tension below the apex */
} mc_planes;

static inline void mc_planes_of(const soil_elastic *e, const mc_strength *s, mc_planes *p) {
    static const int pair[3][2] = {{0, 2}, {0, 1}, {1, 2}};
    memset(p, 0, sizeof *p);
    p->cut = s->tension < s->apex;
    for (int n = 0; n < MC_PLANES; n++) {
        double flow[3] = {0, 0, 0};
        if (n < MC_T1) {
            const int i = pair[n][0], j = pair[n][1];
            p->a[n][i] = 1.0 + s->sine, p->a[n][j] = -(1.0 - s->sine), p->b[n] = s->k;
            flow[i] = 1.0 + s->dilation, flow[j] = -(1.0 - s->dilation);
        } else {
            p->a[n][n - MC_T1] = flow[n - MC_T1] = 1.0, p->b[n] = s->tension;
        }
        const double volumetric = e->lambda * (flow[0] + flow[1] + flow[2]);
        for (int c = 0; c < 3; c++) p->m[n][c] = volumetric + e->two_mu * flow[c];
    }
}

static inline double mc_dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Solves n <= 3 equations in place; false where they are not independent. */
static inline bool mc_solve(int n, double A[3][3], double x[3]) {
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int r = k + 1; r < n; r++)
            if (fabs(A[r][k]) > fabs(A[best][k])) best = r;
        if (!(fabs(A[best][k]) > 0.0)) return false;
        for (int c = 0; c < n; c++) principal_swap(&A[k][c], &A[best][c]);
        principal_swap(&x[k], &x[best]);
        for (int r = k + 1; r < n; r++) {
            const double f = A[r][k] / A[k][k];
            for (int c = k; c < n; c++) A[r][c] -= f * A[k][c];
            x[r] -= f * x[k];
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        for (int c = k + 1; c < n; c++) x[k] -= A[k][c] * x[c];
        x[k] /= A[k][k];
    }
    return true;
}

/* Holds on to n planes: s and, in Pa, the worst of what is wrong with it: multipliers below 0, other planes violated, values out of
 * order. */
static inline double mc_hold(const mc_planes *p, double two_mu, const double trial[3], int n, const int plane[3], double s[3]) {
    double A[3][3] = {{0}}, x[3] = {0};
    for (int r = 0; r < n; r++) {
        for (int c = 0; c < n; c++) A[r][c] = mc_dot(p->a[plane[r]], p->m[plane[c]]);
        x[r] = mc_dot(p->a[plane[r]], trial) - p->b[plane[r]];
    }
    if (!mc_solve(n, A, x)) return INFINITY;
    for (int c = 0; c < 3; c++) {
        s[c] = trial[c];
        for (int r = 0; r < n; r++) s[c] -= x[r] * p->m[plane[r]][c];
    }
    double wrong = fmax(s[1] - s[0], s[2] - s[1]);
    for (int r = 0; r < n; r++) wrong = fmax(wrong, -x[r] * two_mu);
    for (int k = 0; k < (p->cut ? MC_PLANES : MC_T1); k++) wrong = fmax(wrong, mc_dot(p->a[k], s) - p->b[k]);
    return wrong == wrong ? wrong : INFINITY;
}

/* How far the trial stress is outside of the cone that returns to the apex: between the planes that the apex spans with the edges'
 * directions of return. */
static inline double mc_beside_apex(const mc_planes *p, double apex, const double trial[3]) {
    static const int pair[2][2] = {{MC_13, MC_23}, {MC_12, MC_13}};
    double wrong = -INFINITY;
    for (int n = 0; n < 2; n++) {
        const double *u = p->m[pair[n][0]], *v = p->m[pair[n][1]];
        double normal[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        const double size = sqrt(mc_dot(normal, normal)), sign = normal[0] + normal[1] + normal[2] < 0.0 ? -1.0 : 1.0;
        double along = 0.0;
        for (int c = 0; c < 3; c++) along += normal[c] * (trial[c] - apex);
        wrong = fmax(wrong, -sign * along / size);
    }
    return wrong;
}

/* Puts s, which is near the surface, on it: the smallest principal stress stands, the largest follows from the plane 1-3 or the cut-off,
 * the middle one lies between them. `pulled` of them are at the cut-off, `edge` is the one that the middle one shares its value with
 * (-1: none). */
static inline void mc_settle(const mc_strength *strength, int pulled, bool slips, int edge, double s[3]) {
    const double rise = (1.0 - strength->sine) / (1.0 + strength->sine), start = strength->k / (1.0 + strength->sine);
    if (pulled == 3) s[2] = strength->tension;
    if (pulled && slips) { /* both: the corner says what the smallest one is */
        const double fall = 1.0 - strength->sine;
        if (fall > 0.0) s[2] = ((1.0 + strength->sine) * strength->tension - strength->k) / fall;
    }
    const double slope = start + rise * s[2];
    const double largest = slope < strength->tension ? slope : strength->tension;
    if (!(largest > s[2]))
        s[2] = s[1] = s[0] = strength->tension; /* the apex, or the corner of the cut-off */
    else {
        s[0] = pulled ? strength->tension < slope ? strength->tension : slope : slips ? largest : fmin(s[0], largest);
        if (pulled > 1 || edge == 0) s[1] = s[0];
        if (edge == 2) s[1] = s[2];
        s[1] = fmin(fmax(s[1], s[2]), s[0]);
    }
}

static inline void mc_return(const soil_elastic *e, const mc_strength *strength, const double trial[3], double s[3]) {
    typedef struct way {
        int n, plane[3];
        bool cut;          /* only with planes of tension */
        int pulled, slips; /* how many stresses are at the cut-off; whether a plane of slip carries */
        int edge;
    } way;
    static const way ways[] = {
        {1, {MC_13, 0, 0}, false, 0, 1, -1},       {1, {MC_T1, 0, 0}, true, 1, 0, -1},        {2, {MC_13, MC_23, 0}, false, 0, 1, 0},
        {2, {MC_13, MC_12, 0}, false, 0, 1, 2},    {2, {MC_T1, MC_13, 0}, true, 1, 1, -1},    {2, {MC_T1, MC_T2, 0}, true, 2, 0, 0},
        {3, {MC_T1, MC_T2, MC_13}, true, 2, 1, 0}, {3, {MC_T1, MC_13, MC_23}, true, 2, 1, 0}, {3, {MC_T1, MC_13, MC_12}, true, 1, 1, 2},
        {3, {MC_T1, MC_T2, MC_T3}, true, 3, 0, 0},
    };
    enum { WAYS = sizeof ways / sizeof *ways };
    mc_planes planes;
    mc_planes_of(e, strength, &planes);
    const double enough = SOIL_ROUNDING * (fabs(trial[0]) + fabs(trial[1]) + fabs(trial[2]) + strength->k);
    double least = INFINITY, found[3] = {0, 0, 0};
    int best = -1;
    for (int w = 0; w < WAYS && !(least <= enough); w++) {
        if (ways[w].cut && !planes.cut) continue;
        const double wrong = mc_hold(&planes, e->two_mu, trial, ways[w].n, ways[w].plane, found);
        if (!(wrong < least)) continue;
        least = wrong, best = w;
        for (int c = 0; c < 3; c++) s[c] = found[c];
    }
    if (!(least <= enough) && !planes.cut && isfinite(strength->apex) && mc_beside_apex(&planes, strength->apex, trial) < least) {
        s[0] = s[1] = s[2] = strength->apex;
        return;
    }
    mc_settle(strength, ways[best].pulled, ways[best].slips, ways[best].edge, s);
}

static __attribute__((noinline)) void mc_back(const void *law, const double trial[6], double plastic, double stress[6]) {
    const mc_law *l = law;
    const mc_strength strength = l->softening.end > 0.0 ? mc_strength_at(l, soil_share(l->softening, plastic)) : l->peak;
    principal p;
    principal_of(trial, trial[4] == 0.0 && trial[5] == 0.0, &p);
    const double slip = (p.value[0] - p.value[2]) + (p.value[0] + p.value[2]) * strength.sine - strength.k;
    const double size = SOIL_ROUNDING * (fabs(p.value[0]) + fabs(p.value[2]) + strength.k);
    if (slip <= size && p.value[0] - strength.tension <= size) { /* a softer surface may be out of reach, and in space nobody has looked */
        memcpy(stress, trial, 6 * sizeof *stress);
        return;
    }
    double value[3];
    mc_return(&l->elastic, &strength, p.value, value);
    principal_join(&p, value, stress);
}

static __attribute__((noinline)) void mc_check_plane(const void *law, const double strain[6][SOIL_LANES],
                                                     const double stress[6][SOIL_LANES], soil_lanes *l) {
    const mc_law m = *(const mc_law *)law;
    soil_trial(m.elastic, 4, strain, stress, l);
    mc_excess_plane(&m, l);
}

static __attribute__((noinline)) void mc_check_space(const void *law, const double strain[6][SOIL_LANES],
                                                     const double stress[6][SOIL_LANES], soil_lanes *l) {
    const mc_law *m = law;
    soil_trial(m->elastic, 6, strain, stress, l);
    for (size_t i = 0; i < SOIL_LANES; i++) l->excess[i] = 1.0;
}

SOIL_INLINE void mc_check(const void *law, uint32_t components, const double strain[6][SOIL_LANES], const double stress[6][SOIL_LANES],
                          soil_lanes *l) {
    (components == 4 ? mc_check_plane : mc_check_space)(law, strain, stress, l);
}

static inline int mc_update(void *self, ab_batch *b) {
    const mc_law *l = self;
    return soil_update(l->host, l, &l->elastic, l->softening, b, mc_check, mc_back);
}

/* ---- making one ---------------------------------------------------------------------------------------------------------------------- */

typedef struct mc_settings {
    double E, nu;
    soil_strength strength;
    double tension; /* Pa; INFINITY: none */
    const ab_value *softening;
} mc_settings;

/* The least softening_strain that the cohesion allows. Where the face 1-3 carries, f falls by a.D.m per multiplier and the surface by the
 * loss of 2 c cos phi over the plastic strain of a multiplier, sqrt(2/3) |dev m|. */
static inline double mc_least_softening(const mc_law *l) {
    const mc_strength residual = mc_strength_at(l, 1.0), *peak = &l->peak;
    const double lost = peak->k - residual.k, sine = peak->sine, dilation = peak->dilation;
    const double falls = 4 * l->elastic.mu * (1 + sine * dilation / 3) + 4 * l->elastic.bulk * sine * dilation;
    const double plastic = 2 / sqrt(3.0) * sqrt(1 + dilation * dilation / 3);
    return lost * plastic / falls;
}

static inline int mc_create(const ab_host *host, const mc_settings *settings, void **self) {
    const soil_strength s = settings->strength;
    const double tension = settings->tension;
    mc_law made = {.host = host,
                   .elastic = soil_elastic_of(settings->E, settings->nu),
                   .cohesion = s.cohesion,
                   .friction = tan(s.friction),
                   .dilation = tan(s.dilation),
                   .cohesion_change = s.residual_cohesion - s.cohesion,
                   .friction_change = tan(s.residual_friction) - tan(s.friction),
                   .dilation_change = tan(s.residual_dilation) - tan(s.dilation),
                   .tension = tension};
    if (isfinite(tension) && s.cohesion > 0) made.tension_change = tension * (s.residual_cohesion / s.cohesion - 1);
    made.peak = mc_strength_at(&made, 0.0);
    if (soil_strength_refused(host, &s)) return -1;
    if (isfinite(tension) && tension > made.peak.apex) {
        char text[240];
        snprintf(
            text, sizeof text,
            "tension %g Pa is more than the apex of the surface, cohesion/tan(friction) = %g Pa, bears: give less, or leave it out (no "
            "cut-off)",
            tension, made.peak.apex);
        return soil_say(host, text), -1;
    }
    if (soil_softening_read(host, settings->softening, soil_softens(&s), &made.softening) != 0) return -1;
    if (soil_softens(&s) && soil_softening_refused(host, made.softening, mc_least_softening(&made))) return -1;
    mc_law *law = host->allocate(host->context, sizeof *law);
    if (!law) return -1;
    *law = made;
    *self = law;
    return 0;
}

static inline void mc_destroy(void *self) {
    const mc_law *made = self;
    made->host->release(made->host->context, self);
}

#endif
