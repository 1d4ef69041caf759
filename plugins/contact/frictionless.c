/* frictionless.c: answers contact points by a normal impulse alone: no approach beyond the gap, free slip, free separation. */
#include "abut_plugin.h"

/* As fmax, a NaN being ignored, but inline: calls of the library's cost ten times as much. */
static inline double larger(double a, double b) { return b > a || a != a ? b : a; }

static int respond(void *self, ab_points *p, size_t first, size_t count) {
    (void)self;
    for (size_t i = first; i < first + count; ++i) {
        double approach = 0.0, normal_impulse = 0.0;
        for (size_t c = 0; c < p->dimension; ++c) {
            approach += p->relative_velocity[c * p->ld + i] * p->normal[c * p->ld + i];
            normal_impulse += p->impulse[c * p->ld + i] * p->normal[c * p->ld + i];
        }
        const double lambda = larger(0.0, normal_impulse + p->normal_mass[i] * (approach - larger(p->gap[i], 0.0) / p->dt));
        for (size_t c = 0; c < p->dimension; ++c) p->impulse[c * p->ld + i] = lambda * p->normal[c * p->ld + i];
    }
    return 0;
}

static const ab_contact_ops OPS = {sizeof OPS, NULL, respond};
static const ab_class CLASS = {
    .struct_size = sizeof CLASS,
    .kind = AB_CONTACT,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D,
    .gives = AB_GIVE_IMPULSE,
    .name = "frictionless",
    .help = "no approach beyond the gap; free slip and separation",
    .reference = "unilateral contact by projected Gauss-Seidel: Moreau 1999; Jean 1999",
    .ops = &OPS,
};
static const ab_class *const CLASSES[] = {&CLASS};
const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "frictionless", "1.0", "MIT", CLASSES};
