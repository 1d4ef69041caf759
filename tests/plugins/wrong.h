/* wrong.h: a plugin that is right in everything, for tests to make wrong in one thing: define that thing, then include this.
 * Its constructor says so when it runs, which it must not in a plugin that is refused by what its file says. */
#include <math.h>
#include <stdio.h>

#include "abut_plugin.h"

#ifndef STRUCT_SIZE
#define STRUCT_SIZE sizeof(ab_plugin)
#endif
#ifndef MAJOR
#define MAJOR AB_ABI_MAJOR
#endif
#ifndef MINOR
#define MINOR AB_ABI_MINOR
#endif
#ifndef DOUBLE_SIZE
#define DOUBLE_SIZE sizeof(double)
#endif
#ifndef CLASS_SIZE
#define CLASS_SIZE sizeof(ab_class)
#endif
#ifndef OPS_SIZE
#define OPS_SIZE sizeof(ab_material_ops)
#endif
#ifndef START
#define START NULL /* of a boundary: apply */
#endif
#ifndef UPDATE
#define UPDATE update
#endif
#ifndef KIND
#define KIND AB_MATERIAL
#endif
#ifndef GIVES
#define GIVES (AB_GIVE_STRESS | AB_GIVE_WAVE_SPEED)
#endif
#ifndef CLASS_NAME
#define CLASS_NAME "wrong-class"
#endif
#ifndef PARAM
#define PARAM                                                                                                                              \
    { "E", "Pa", "Young's modulus", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN, 0, 0, INFINITY }
#endif
#ifndef PARAMS
#define PARAMS params
#endif
#ifndef PARAM_COUNT
#define PARAM_COUNT 1
#endif
#ifndef CLASSES
#define CLASSES &wrong_class
#endif
#ifndef SAVE
#define SAVE NULL
#endif
#ifndef CONSTRUCTOR
#define CONSTRUCTOR fputs("code of the wrong plugin ran\n", stderr)
#endif

extern double wrong_sink;
double wrong_sink;

static __attribute__((constructor)) void at_load(void) { CONSTRUCTOR; }

static int create(const ab_host *host, const ab_value *settings, void **self) {
    (void)host;
    wrong_sink = settings[0].real;
    *self = &wrong_sink;
    return 0;
}

static void destroy(void *self) { (void)self; }

__attribute__((unused)) static int update(void *self, ab_batch *batch) {
    (void)self;
    for (size_t i = 0; i < batch->count; i++)
        for (uint32_t c = 0; c < batch->components; c++) batch->stress1[c * batch->ld + i] = batch->stress0[c * batch->ld + i];
    for (size_t i = 0; i < batch->count && batch->wave_speed; i++) batch->wave_speed[i] = sqrt(wrong_sink / batch->density[i]);
    return 0;
}

extern const ab_param params[];
const ab_param params[] = {PARAM};
static const ab_material_ops ops = {OPS_SIZE, START, UPDATE};
extern const ab_class wrong_class;
const ab_class wrong_class = {.struct_size = CLASS_SIZE,
                              .kind = KIND,
                              .spaces = AB_PLANE_STRAIN,
                              .gives = GIVES,
                              .nparam = PARAM_COUNT,
                              .name = CLASS_NAME,
                              .help = "wrong on purpose",
                              .reference = "",
                              .param = PARAMS,
                              .create = create,
                              .destroy = destroy,
                              .ops = &ops,
                              .save = SAVE};
static const ab_class *const classes[] = {CLASSES};
#ifndef NO_DESCRIPTOR
AB_EXPORT const ab_plugin abut_plugin_v1 = {STRUCT_SIZE, MAJOR, MINOR, DOUBLE_SIZE, sizeof(size_t), sizeof classes / sizeof *classes,
                                            "wrong",     "1.0", "MIT", classes};
#endif
