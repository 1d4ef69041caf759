/* coulomb.c: answers contact points with Coulomb friction: no approach beyond the gap, no slip below the limit
 * friction * normal impulse + adhesion * area * dt, never more than shear_cap * area * dt. Bodies that overlap are left so, unless `recovery` says in how
 * many steps they have to part.
 *
 * With kinetic_friction the limit of a point depends on whether it slipped in the last step, not on what the rounds of this step have tried so far: in each round the
 * law is then that of one coefficient, and the rounds end as they do with one. A point that sticks gives way at the static limit, carries that for the rest of the
 * step and the kinetic one from the next step on; it sticks again when the kinetic one is enough to hold it. Were the impulse to fall in the round in which
 * a point gives way, the first of many points that hold a body together would see all of the load, give way, and the others after it. */
#include "abut_plugin.h"

#include <math.h>

/* As fmax and fmin, a NaN being ignored, but inline: calls of the library's cost ten times as much. */
static inline double larger(double a, double b) { return b > a || a != a ? b : a; }
static inline double smaller(double a, double b) { return b < a || a != a ? b : a; }

typedef struct coulomb {
    const ab_host *host;
    double friction, kinetic, adhesion, shear_cap, tensile_strength, recovery;
    int weakens; /* kinetic < friction */
} coulomb;

static const ab_param PARAMS[] = {
    {"friction", "1", "coefficient of friction", NULL, AB_REAL, 0, 0.0, 0.0, INFINITY},
    {"adhesion", "Pa", "shear stress carried without normal force while the bodies touch", NULL, AB_REAL, 0, 0.0, 0.0, INFINITY},
    {"shear_cap", "Pa", "largest shear stress (alpha s_u); 0: none", NULL, AB_REAL, 0, 0.0, 0.0, INFINITY},
    {"tensile_strength", "Pa", "tension carried while the bodies touch; needs adhesion", NULL, AB_REAL, 0, 0.0, 0.0, INFINITY},
    {"kinetic_friction", "1",
     "coefficient of friction of a point that slips, at most friction, which then is that of a point that sticks; without it: the same as "
     "friction",
     NULL, AB_REAL, 0, INFINITY, 0.0, INFINITY},
    {"recovery", "1",
     "steps in which bodies that overlap are pushed apart again, by 2e-4 of a cell in a step at most (what that takes is booked as contact "
     "loss < 0); 0: never",
     NULL, AB_REAL, 0, 0.0, 0.0, INFINITY},
};

static const ab_state STATES[] = {
    {"slips", "1", "1 where the point slipped in the last step (kept with kinetic_friction)", AB_SCALAR, AB_COPY, 0.0},
};

static int create(const ab_host *host, const ab_value *settings, void **self) {
    if (settings[3].real > 0.0 && !(settings[1].real > 0.0)) return host->message(host->context, "tensile_strength needs adhesion > 0"), -1;
    if (settings[4].given && settings[4].real > settings[0].real)
        return host->message(host->context, "kinetic_friction is above friction, which is the static coefficient; it must not be"), -1;
    coulomb *law = host->allocate(host->context, sizeof *law);
    if (!law) return -1;
    const double kinetic = smaller(settings[4].real, settings[0].real);
    *law = (coulomb){host,
                     settings[0].real,
                     kinetic,
                     settings[1].real,
                     settings[2].real,
                     settings[3].real,
                     settings[5].real,
                     kinetic < settings[0].real};
    *self = law;
    return 0;
}

static void destroy(void *self) {
    coulomb *law = self;
    law->host->release(law->host->context, law);
}

static const double TOUCH =
    1e-3; /* of a cell: bodies no further apart touch, for adhesion and tension; gaps are no better known than this */
static const double AT_ONCE =
    2e-4; /* of a cell: no more of an overlap is taken back in a step, as it pushes with the speed that this needs */
static const double AT_LIMIT = 1e-5; /* of the limit: less beyond it is no slip, but what the rounds over many points have left undecided */

static int respond(void *self, ab_points *p, size_t first, size_t count) {
    const coulomb *law = self;
    const size_t ld = p->ld, d = p->dimension;
    for (size_t i = first; i < first + count; ++i) {
        double approach = 0.0, normal_impulse = 0.0;
        for (size_t c = 0; c < d; ++c) {
            approach += p->relative_velocity[c * ld + i] * p->normal[c * ld + i];
            normal_impulse += p->impulse[c * ld + i] * p->normal[c * ld + i];
        }
        const double gap = p->gap[i], area_dt = p->area[i] * p->dt;
        const int touching = gap <= TOUCH * p->cell;
        const double tension = touching ? law->tensile_strength * area_dt : 0.0;
        const double leave = gap >= 0.0            ? gap / p->dt
                             : law->recovery > 0.0 ? -smaller(-gap / larger(law->recovery, 1.0), AT_ONCE * p->cell) / p->dt
                                                   : 0.0;
        /* A push ends approach beyond the gap; a pull ends separation and no more: what is open stays open, or closing it would make energy. */
        double lambda = larger(0.0, normal_impulse + p->normal_mass[i] * (approach - leave));
        if (lambda == 0.0 && tension > 0.0) lambda = larger(-tension, smaller(0.0, normal_impulse + p->normal_mass[i] * approach));
        const double friction = law->weakens && p->state0[i] > 0.5 ? law->kinetic : law->friction;
        double limit = friction * larger(lambda, 0.0) + (touching ? law->adhesion * area_dt : 0.0);
        if (law->shear_cap > 0.0) limit = smaller(limit, law->shear_cap * area_dt);
        double slip[3] = {0}, size = 0.0, left = 0.0; /* tangential impulse that would end the slip; square of the slip that is left */
        for (size_t c = 0; c < d; ++c) {
            const double v = p->relative_velocity[c * ld + i] - approach * p->normal[c * ld + i];
            slip[c] = p->impulse[c * ld + i] - normal_impulse * p->normal[c * ld + i] + p->tangential_mass[i] * v;
            size += slip[c] * slip[c];
            left += v * v;
        }
        size = sqrt(size);
        const double scale = size > limit ? limit / size : 1.0;
        if (law->weakens)
            p->state1[i] = size > limit * (1.0 + AT_LIMIT) && p->tangential_mass[i] * sqrt(left) > limit * AT_LIMIT ? 1.0 : 0.0;
        for (size_t c = 0; c < d; ++c) p->impulse[c * ld + i] = lambda * p->normal[c * ld + i] + scale * slip[c];
    }
    return 0;
}

static uint32_t needs_with(const ab_value *settings) {
    return settings[1].real > 0.0 || settings[2].real > 0.0 || settings[3].real > 0.0 ? AB_NEED_AREA : 0u;
}

static const ab_contact_ops OPS = {sizeof OPS, NULL, respond};
static const ab_class CLASS = {
    .struct_size = sizeof CLASS,
    .kind = AB_CONTACT,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D,
    .gives = AB_GIVE_IMPULSE,
    .nparam = sizeof PARAMS / sizeof *PARAMS,
    .nstate = sizeof STATES / sizeof *STATES,
    .name = "coulomb",
    .help = "no approach beyond the gap; Coulomb friction, static and kinetic, with adhesion and a shear cap",
    .reference = "projected Gauss-Seidel over contact points: Moreau 1999; Jean 1999. Friction between material points: Bardenhagen, "
                 "Brackbill, Sulsky 2000",
    .param = PARAMS,
    .state = STATES,
    .create = create,
    .destroy = destroy,
    .ops = &OPS,
    .needs_with = needs_with,
};
static const ab_class *const CLASSES[] = {&CLASS};
const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "coulomb", "1.0", "MIT", CLASSES};
