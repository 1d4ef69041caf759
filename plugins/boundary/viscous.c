/* viscous.c: dashpots that take up waves at the end of the model: the traction that an endless medium would answer a plane wave with.
 *
 * t = -a rho c_p v_n n - b rho c_s v_t (Lysmer and Kuhlemeyer 1969). With a = b = 1 a P or S wave that meets the boundary at a right angle leaves nothing behind. */
#include "abut_plugin.h"

enum { NORMAL, TANGENTIAL, SETTINGS };

typedef struct viscous {
    ab_host host;
    double normal, tangential; /* a, b */
} viscous;

static int create(const ab_host *host, const ab_value *settings, void **self) {
    viscous *v = host->allocate(host->context, sizeof *v);
    if (!v) {
        host->message(host->context, "no memory for the dashpots");
        return -1;
    }
    *v = (viscous){*host, settings[NORMAL].real, settings[TANGENTIAL].real};
    *self = v;
    return 0;
}

static void destroy(void *self) {
    viscous *v = self;
    v->host.release(v->host.context, v);
}

static int apply(void *self, ab_edges *e) {
    const viscous *v = self;
    for (size_t i = 0; i < e->count; ++i) {
        const double normal = v->normal * e->density[i] * e->p_wave_speed[i], across = v->tangential * e->density[i] * e->s_wave_speed[i];
        double outward = 0.0; /* velocity along the normal, m/s */
        for (size_t c = 0; c < e->dimension; ++c) outward += e->velocity[c * e->ld + i] * e->normal[c * e->ld + i];
        for (size_t c = 0; c < e->dimension; ++c)
            e->traction[c * e->ld + i] = -across * e->velocity[c * e->ld + i] - (normal - across) * outward * e->normal[c * e->ld + i];
        e->damping[i] = normal;
        e->damping[e->ld + i] = across;
    }
    return 0;
}

static const ab_param PARAMS[SETTINGS] = {
    [NORMAL] = {.name = "a",
                .unit = "1",
                .help = "part of rho c_p against the velocity along the normal",
                .type = AB_REAL,
                .initial = 1.0,
                .min = 0.0,
                .max = 100.0},
    [TANGENTIAL] = {.name = "b",
                    .unit = "1",
                    .help = "part of rho c_s against the velocity across it",
                    .type = AB_REAL,
                    .initial = 1.0,
                    .min = 0.0,
                    .max = 100.0},
};
static const ab_boundary_ops OPS = {sizeof OPS, apply};
static const ab_class CLASS = {
    .struct_size = sizeof CLASS,
    .kind = AB_BOUNDARY,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D,
    .gives = AB_GIVE_TRACTION | AB_GIVE_DAMPING,
    .nparam = SETTINGS,
    .name = "viscous",
    .help = "dashpots that take up plane waves at right angles",
    .reference = "Lysmer and Kuhlemeyer 1969",
    .param = PARAMS,
    .create = create,
    .destroy = destroy,
    .ops = &OPS,
};
static const ab_class *const CLASSES[] = {&CLASS};
const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "viscous", "1.0", "MIT", CLASSES};
