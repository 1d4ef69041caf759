/* tied.c: answers contact points so that both bodies move together: no slip, no separation, once they touch (gap <= tolerance). A point that is tied
 * stays so until its gap is half a cell: material of two bodies in tension drifts apart a little, as far as points follow the grid's velocities. */
#include "abut_plugin.h"

/* As fmax, a NaN being ignored, but inline: calls of the library's cost ten times as much. */
static inline double larger(double a, double b) { return b > a || a != a ? b : a; }

typedef struct tied {
    const ab_host *host;
    double tolerance;
} tied;

static const ab_param PARAMS[] = {
    {"tolerance", "1", "points closer than this part of a cell become tied; others may only not pass through each other", NULL, AB_REAL, 0,
     0.01, 0.0, 10.0},
};

static const ab_state STATES[] = {{"tied", "1", "1 where the point was tied in the last step", AB_SCALAR, AB_COPY, 0.0}};
static const double LET_GO = 0.5; /* of a cell */

static int create(const ab_host *host, const ab_value *settings, void **self) {
    tied *law = host->allocate(host->context, sizeof *law);
    if (!law) return -1;
    *law = (tied){host, settings[0].real};
    *self = law;
    return 0;
}

static void destroy(void *self) {
    tied *law = self;
    law->host->release(law->host->context, law);
}

static int respond(void *self, ab_points *p, size_t first, size_t count) {
    const tied *law = self;
    for (size_t i = first; i < first + count; ++i) {
        double approach = 0.0, normal_impulse = 0.0;
        for (size_t c = 0; c < p->dimension; ++c) {
            approach += p->relative_velocity[c * p->ld + i] * p->normal[c * p->ld + i];
            normal_impulse += p->impulse[c * p->ld + i] * p->normal[c * p->ld + i];
        }
        const double reach = p->state0[i] != 0.0 ? larger(law->tolerance, LET_GO) : law->tolerance;
        const int together = p->gap[i] <= reach * p->cell;
        p->state1[i] = together;
        const double wanted = normal_impulse + p->normal_mass[i] * (approach - (together ? 0.0 : larger(p->gap[i], 0.0) / p->dt));
        const double lambda = together ? wanted : larger(0.0, wanted);
        for (size_t c = 0; c < p->dimension; ++c) {
            const double n = p->normal[c * p->ld + i], v = p->relative_velocity[c * p->ld + i] - approach * n;
            const double slip = together ? p->impulse[c * p->ld + i] - normal_impulse * n + p->tangential_mass[i] * v : 0.0;
            p->impulse[c * p->ld + i] = lambda * n + slip;
        }
    }
    return 0;
}

static const ab_contact_ops OPS = {sizeof OPS, NULL, respond};
static const ab_class CLASS = {
    .struct_size = sizeof CLASS,
    .kind = AB_CONTACT,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D,
    .needs = AB_NEED_FIXED_PLACES,
    .gives = AB_GIVE_IMPULSE,
    .nparam = sizeof PARAMS / sizeof *PARAMS,
    .nstate = 1,
    .name = "tied",
    .help = "no slip and no separation once the bodies touch",
    .reference = "bilateral contact by projected Gauss-Seidel: Jean 1999",
    .param = PARAMS,
    .state = STATES,
    .create = create,
    .destroy = destroy,
    .ops = &OPS,
};
static const ab_class *const CLASSES[] = {&CLASS};
const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "tied", "1.0", "MIT", CLASSES};
