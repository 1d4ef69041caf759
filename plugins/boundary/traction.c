/* traction.c: a traction on a moving surface: parts that keep their direction, parts that turn with the surface, per area as it is now or as it was. */
#include "abut_plugin.h"

#include <math.h>

#include "boundary/history.h"

enum { AREA_NOW, AREA_START };

typedef struct traction {
    const ab_host *host;
    double fixed[2], normal, tangential;
    history course;
    int area;
} traction;

static const ab_param PARAMS[] = {
    {"x", "Pa", "traction along x, whichever way the surface turns", NULL, AB_REAL, 0, 0.0, -INFINITY, INFINITY},
    {"y", "Pa", "traction along y, whichever way the surface turns", NULL, AB_REAL, 0, 0.0, -INFINITY, INFINITY},
    {"normal", "Pa", "traction along the outward normal, with which it turns; pulls where it is positive", NULL, AB_REAL, 0, 0.0, -INFINITY,
     INFINITY},
    {"tangential", "Pa",
     "traction along the surface, with which it turns: to the left as seen along the outward normal (on a top from right to left)", NULL,
     AB_REAL, 0, 0.0, -INFINITY, INFINITY},
    {"history", "s, 1",
     "pairs [t, factor] that all of them are multiplied by, t in s; straight lines between the rows, before the first and after the last "
     "row "
     "their factors; without it always 1",
     NULL, AB_TABLE, AB_COLUMNS_2 | AB_INCREASING, 0.0, -INFINITY, INFINITY},
    {"area", "1", "the area that the traction is counted by: as it is now, or as it was when the boundary began to act (as under loads)",
     "now|start", AB_CHOICE, 0, AREA_NOW, 0, 0},
};
enum { AT_X, AT_Y, AT_NORMAL, AT_TANGENTIAL, AT_HISTORY, AT_AREA };

static const ab_state STATES[] = {
    {"area_start", "m", "area of the edge when the boundary began to act (m2 of a ring)", AB_SCALAR, AB_COPY, 0.0}};

static int create(const ab_host *host, const ab_value *settings, void **self) {
    if (!settings[AT_X].given && !settings[AT_Y].given && !settings[AT_NORMAL].given && !settings[AT_TANGENTIAL].given)
        return host->message(host->context,
                             "traction needs at least one of x, y, normal, tangential, in Pa; history alone has nothing to multiply"),
               -1;
    traction *t = host->allocate(host->context, sizeof *t);
    if (!t) return -1;
    *t = (traction){.host = host,
                    .fixed = {settings[AT_X].real, settings[AT_Y].real},
                    .normal = settings[AT_NORMAL].real,
                    .tangential = settings[AT_TANGENTIAL].real,
                    .area = (int)settings[AT_AREA].integer};
    t->course = history_of(settings + AT_HISTORY);
    *self = t;
    return 0;
}

static void destroy(void *self) {
    traction *t = self;
    t->host->release(t->host->context, t);
}

static int apply(void *self, ab_edges *e) {
    const traction *t = self;
    const double factor = history_at(&t->course, e->time + 0.5 * e->dt); /* the force acts over the step */
    for (size_t i = 0; i < e->count; ++i) {
        const double n[2] = {e->normal[i], e->normal[e->ld + i]}, start = e->state0[i] > 0.0 ? e->state0[i] : e->area[i];
        const double size = t->area == AREA_START && e->area[i] > 0.0 ? factor * (start / e->area[i]) : factor;
        e->state1[i] = start;
        e->traction[i] = size * (t->fixed[0] + t->normal * n[0] - t->tangential * n[1]);
        e->traction[e->ld + i] = size * (t->fixed[1] + t->normal * n[1] + t->tangential * n[0]);
    }
    return 0;
}

static const ab_boundary_ops OPS = {sizeof OPS, apply};
static const ab_class CLASS = {
    .struct_size = sizeof CLASS,
    .kind = AB_BOUNDARY,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC, /* across a surface in space there is more than one direction */
    .needs = AB_NEED_AXES,
    .gives = AB_GIVE_TRACTION,
    .nparam = sizeof PARAMS / sizeof *PARAMS,
    .nstate = sizeof STATES / sizeof *STATES,
    .name = "traction",
    .help = "a traction on the moving surface, constant or over time, in fixed directions or turning with it",
    .reference =
        "Cauchy's traction on the current surface; by the area at the start it is the first Piola-Kirchhoff traction: Bonet and Wood 2008",
    .param = PARAMS,
    .state = STATES,
    .create = create,
    .destroy = destroy,
    .ops = &OPS,
};
static const ab_class *const CLASSES[] = {&CLASS};
const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "traction", "1.0", "MIT", CLASSES};
