/* pressure.c: a pressure on a moving surface: it stands on the edge as it lies now, against its normal, on the area that it has now. */
#include "abut_plugin.h"

#include <math.h>

#include "boundary/history.h"

typedef struct pressure {
    const ab_host *host;
    double size;
    history course;
} pressure;

static const ab_param PARAMS[] = {
    {"pressure", "Pa", "force per area as it is now, pushing the body; without it 1 Pa, so that history is in Pa", NULL, AB_REAL, 0, 1.0,
     -INFINITY, INFINITY},
    {"history", "s, 1",
     "pairs [t, factor]: the pressure over time as a multiple of `pressure`, t in s; straight lines between the rows, before the first and "
     "after the last row their factors; without it always 1",
     NULL, AB_TABLE, AB_COLUMNS_2 | AB_INCREASING, 0.0, -INFINITY, INFINITY},
};

static int create(const ab_host *host, const ab_value *settings, void **self) {
    if (!settings[0].given && !settings[1].given)
        return host->message(host->context, "pressure needs the setting pressure, in Pa, or history, pairs [t, Pa]"), -1;
    pressure *p = host->allocate(host->context, sizeof *p);
    if (!p) return -1;
    *p = (pressure){.host = host, .size = settings[0].real};
    p->course = history_of(settings + 1);
    *self = p;
    return 0;
}

static void destroy(void *self) {
    pressure *p = self;
    p->host->release(p->host->context, p);
}

static int apply(void *self, ab_edges *e) {
    const pressure *p = self;
    const double now = p->size * history_at(&p->course, e->time + 0.5 * e->dt); /* the force acts over the step */
    for (size_t c = 0; c < e->dimension; ++c)
        for (size_t i = 0; i < e->count; ++i) e->traction[c * e->ld + i] = -now * e->normal[c * e->ld + i];
    return 0;
}

static const ab_boundary_ops OPS = {sizeof OPS, apply};
static const ab_class CLASS = {
    .struct_size = sizeof CLASS,
    .kind = AB_BOUNDARY,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D,
    .gives = AB_GIVE_TRACTION,
    .nparam = sizeof PARAMS / sizeof *PARAMS,
    .name = "pressure",
    .help = "a pressure that follows the surface, constant or over time",
    .reference =
        "follower load on the current surface: Bonet and Wood 2008, Nonlinear Continuum Mechanics for Finite Element Analysis, 8.5.2",
    .param = PARAMS,
    .create = create,
    .destroy = destroy,
    .ops = &OPS,
};
static const ab_class *const CLASSES[] = {&CLASS};
const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "pressure", "1.0", "MIT", CLASSES};
