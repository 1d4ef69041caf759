/* distance_power.c: the Coulomb answer, weaker the further a point is from the stiffer body: times 1 - (min(s, h)/h)^power, s the distance and h the cell (Ma,
 * Wang, Randolph 2014). Made for contact by velocities alone (gap: none), which acts up to two cells too early: a node that the bodies share although
 * they do not touch yet hardly pushes. */
#include "abut_plugin.h"

#include <math.h>

typedef struct distance_power {
    const ab_host *host;
    double power, friction, adhesion, shear_cap;
} distance_power;

static const ab_param PARAMS[] = {
    {"power", "1", "the higher, the closer to the cell's far end the answer fades", NULL, AB_REAL, AB_MIN_OPEN, 6.0, 0.0, 1000.0},
    {"friction", "1", "coefficient of friction", NULL, AB_REAL, 0, 0.0, 0.0, INFINITY},
    {"adhesion", "Pa", "shear stress carried without normal force while the bodies touch", NULL, AB_REAL, 0, 0.0, 0.0, INFINITY},
    {"shear_cap", "Pa", "largest shear stress (alpha s_u); 0: none", NULL, AB_REAL, 0, 0.0, 0.0, INFINITY},
};

static int create(const ab_host *host, const ab_value *settings, void **self) {
    distance_power *law = host->allocate(host->context, sizeof *law);
    if (!law) return -1;
    *law = (distance_power){host, settings[0].real, settings[1].real, settings[2].real, settings[3].real};
    *self = law;
    return 0;
}

static void destroy(void *self) {
    distance_power *law = self;
    law->host->release(law->host->context, law);
}

static const double TOUCH = 1e-3; /* of a cell: bodies no further apart touch, for adhesion */

/* lambda + m v is the impulse that would end the approach however often the answer is asked for, so a part of it is a fixed point too. */
static int respond(void *self, ab_points *p, size_t first, size_t count) {
    const distance_power *law = self;
    const size_t ld = p->ld, d = p->dimension;
    if (!p->distance)
        return law->host->message(law->host->context, "the algorithm does not say how far contact points are from the stiffer body; use "
                                                      "algorithm: multi-velocity"),
               -1;
    for (size_t i = first; i < first + count; ++i) {
        const double part = 1.0 - pow(fmin(fmax(p->distance[i], 0.0), p->cell) / p->cell, law->power);
        double approach = 0.0, old = 0.0;
        for (size_t c = 0; c < d; ++c) {
            approach += p->relative_velocity[c * ld + i] * p->normal[c * ld + i];
            old += p->impulse[c * ld + i] * p->normal[c * ld + i];
        }
        const double lambda = part * fmax(0.0, old + p->normal_mass[i] * (approach - fmax(p->gap[i], 0.0) / p->dt));
        const double area_dt = part * p->area[i] * p->dt;
        double limit = law->friction * lambda + (p->gap[i] <= TOUCH * p->cell ? law->adhesion * area_dt : 0.0);
        if (law->shear_cap > 0.0) limit = fmin(limit, law->shear_cap * area_dt);
        double slip[3] = {0}, size = 0.0; /* part of the tangential impulse that would end the slip */
        for (size_t c = 0; c < d; ++c) {
            const double n = p->normal[c * ld + i], v = p->relative_velocity[c * ld + i] - approach * n;
            slip[c] = part * (p->impulse[c * ld + i] - old * n + p->tangential_mass[i] * v);
            size += slip[c] * slip[c];
        }
        size = sqrt(size);
        const double scale = size > limit ? limit / size : 1.0;
        for (size_t c = 0; c < d; ++c) p->impulse[c * ld + i] = lambda * p->normal[c * ld + i] + scale * slip[c];
    }
    return 0;
}

static uint32_t needs_with(const ab_value *settings) { return settings[2].real > 0.0 || settings[3].real > 0.0 ? AB_NEED_AREA : 0u; }

static const ab_contact_ops OPS = {sizeof OPS, NULL, respond};
static const ab_class CLASS = {
    .struct_size = sizeof CLASS,
    .kind = AB_CONTACT,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D,
    .needs = AB_NEED_DISTANCE,
    .gives = AB_GIVE_IMPULSE,
    .nparam = sizeof PARAMS / sizeof *PARAMS,
    .name = "distance-power",
    .help = "Coulomb friction that fades with the distance from the stiffer body; for gap: none",
    .reference = "Ma, Wang, Randolph 2014, A new contact algorithm in the material point method for geotechnical simulations",
    .param = PARAMS,
    .create = create,
    .destroy = destroy,
    .ops = &OPS,
    .needs_with = needs_with,
};
static const ab_class *const CLASSES[] = {&CLASS};
const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "distance-power", "1.0", "MIT", CLASSES};
