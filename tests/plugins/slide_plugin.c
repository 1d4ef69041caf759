/* slide_plugin.c: sides that move along x as they will and not along y, so that a shear wave can travel up a column of points. For test_boundary_points.py. */
#include "abut_plugin.h"

static int apply(void *self, ab_edges *e) {
    (void)self;
    for (size_t i = 0; i < e->count; ++i) e->prescribed[e->ld + i] = 0.0; /* along x it stays free */
    return 0;
}

static const ab_boundary_ops OPS = {sizeof OPS, apply};
static const ab_class CLASS = {
    .struct_size = sizeof CLASS,
    .kind = AB_BOUNDARY,
    .spaces = AB_PLANE_STRAIN,
    .needs = AB_NEED_AXES,
    .gives = AB_GIVE_MOTION,
    .name = "slide-plugin",
    .help = "no motion along y",
    .reference = "none",
    .ops = &OPS,
};
static const ab_class *const CLASSES[] = {&CLASS};
const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "slide-plugin", "1.0", "MIT", CLASSES};
