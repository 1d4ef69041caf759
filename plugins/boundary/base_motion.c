/* base_motion.c: the ground shakes: a recorded velocity or acceleration as the motion of a rigid base, or as a wave that comes up through ground below that also takes
 * waves away (compliant base: Joyner and Chen 1975; Mejia and Dawson 2006). */
#include "abut_plugin.h"

#include "boundary/dashpots.h"
#include "boundary/ground_record.h"

static const ab_param PARAMS[] = {RECORD_PARAMS};

static int create(const ab_host *host, const ab_value *settings, void **self) {
    *self = record_open(host, settings, 1);
    return *self ? 0 : -1;
}

static void destroy(void *self) {
    ground_record *b = self;
    b->host->release(b->host->context, b);
}

static int apply(void *self, ab_edges *e) {
    const ground_record *b = self;
    double v[MOST];
    if (b->base == RIGID) {
        record_motion(b, e->time + e->dt, v);
        for (size_t c = 0; c < e->dimension; ++c)
            for (size_t i = 0; i < e->count; ++i) e->prescribed[c * e->ld + i] = v[c];
        return 0;
    }
    /* the wave that comes up has the stress rho c v_in, the one that goes down v - v_in: together rho c (2 v_in - v) */
    record_motion(b, e->time + 0.5 * e->dt, v);
    for (size_t c = 0; c < MOST; ++c) v[c] *= 2;
    for (size_t i = 0; i < e->count; ++i) {
        const double rho = b->density > 0 ? b->density : e->density[i];
        const edge_resistance r = {.damping = {rho * (b->p_speed > 0 ? b->p_speed : e->p_wave_speed[i]),
                                               rho * (b->s_speed > 0 ? b->s_speed : e->s_wave_speed[i])}};
        edge_resist(&r, e, i, v);
    }
    return 0;
}

static const ab_boundary_ops OPS = {sizeof OPS, apply};
static const ab_class CLASS = {
    .struct_size = sizeof CLASS,
    .kind = AB_BOUNDARY,
    .spaces = AB_PLANE_STRAIN | AB_SPACE_3D,
    .gives = AB_GIVE_TRACTION | AB_GIVE_DAMPING | AB_GIVE_MOTION,
    .nparam = sizeof PARAMS / sizeof *PARAMS,
    .name = "base-motion",
    .help = "shakes a base with a record: a rigid base, or a wave from below that leaves again",
    .reference = "Joyner and Chen 1975, Bull. Seism. Soc. Am. 65, 1315-1336; Mejia and Dawson 2006, 4th FLAC Symp., 04-10; dashpots: "
                 "Lysmer and Kuhlemeyer 1969; baseline: Boore 2001, Bull. Seism. Soc. Am. 91, 1199-1211",
    .param = PARAMS,
    .create = create,
    .destroy = destroy,
    .ops = &OPS,
};
static const ab_class *const CLASSES[] = {&CLASS};
AB_EXPORT const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "base-motion", "1.0", "MIT", CLASSES};
