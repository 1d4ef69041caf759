/* fake_registry.h: a registry of a few classes for tests of the scene reader, so that they need no plugin files. Include in one source only. */
#ifndef AB_FAKE_REGISTRY_H
#define AB_FAKE_REGISTRY_H

#include <math.h>
#include <string.h>

#include "core/plugin_host.h"
#include "core/suggest.h"

static const ab_param fake_elastic_params[] = {
    {"E", "Pa", "Young's modulus", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN, 0, 0, INFINITY},
    {"nu", "1", "Poisson's ratio", NULL, AB_REAL, AB_MIN_OPEN | AB_MAX_OPEN, 0, -1, 0.5},
    {"yield", "Pa", "yield stress over strain", NULL, AB_TABLE, AB_COLUMNS_2, 0, 0, 0},
    {"checks", "1", "a flag", NULL, AB_FLAG, 0, 1, 0, 0},
    {"steps", "1", "a count", NULL, AB_INTEGER, 0, 7, 1, 100},
};
static const ab_state fake_elastic_states[] = {
    {"plastic_strain", "1", "equivalent plastic strain", AB_SCALAR, AB_AVERAGE, 0},
    {"back_stress", "Pa", "centre of the yield surface", AB_SYMMETRIC, AB_AVERAGE, 0},
};
static const ab_param fake_finder_params[] = {
    {"normal", "1", "how normals are found", "mass-gradient|volume-gradient|average|stiffer", AB_CHOICE, AB_OR_DIRECTION, 2, 0, 0},
    {"gap", "1", "gap", "distance|none", AB_CHOICE, 0, 0, 0, 0},
    {"shared", "m", "declared by both", NULL, AB_REAL, 0, 1, 0, 0},
};
static const ab_param fake_response_params[] = {
    {"friction", "1", "coefficient of friction", NULL, AB_REAL, 0, 0, 0, INFINITY},
    {"shared", "m", "declared by both", NULL, AB_REAL, 0, 2, 0, 0},
};

static const ab_param fake_boundary_params[] = {
    {"a", "1", "part of rho c", NULL, AB_REAL, 0, 1, 0, 100},
};

static const ab_loaded_class fake_classes[] = {
    {.class_ = {.kind = AB_MATERIAL, .spaces = AB_PLANE_STRAIN, .nparam = 5, .nstate = 2, .name = "linear-elastic", .param = fake_elastic_params, .state = fake_elastic_states}},
    {.class_ = {.kind = AB_MATERIAL, .spaces = AB_SPACE_3D, .name = "only-3d"}},
    {.class_ = {.kind = AB_CONTACT, .spaces = AB_PLANE_STRAIN, .gives = AB_GIVE_POINTS, .needs = AB_NEED_SHARED_NODES, .nparam = 3, .name = "multi-velocity", .param = fake_finder_params}},
    {.class_ = {.kind = AB_CONTACT, .spaces = AB_PLANE_STRAIN, .gives = AB_GIVE_POINTS, .needs = AB_NEED_SURFACE, .name = "faces"}},
    {.class_ = {.kind = AB_CONTACT, .spaces = AB_PLANE_STRAIN, .gives = AB_GIVE_POINTS | AB_GIVE_IMPULSE, .nparam = 2, .name = "both", .param = fake_response_params}},
    {.class_ = {.kind = AB_CONTACT, .spaces = AB_PLANE_STRAIN, .gives = AB_GIVE_IMPULSE, .nparam = 2, .name = "coulomb", .param = fake_response_params}},
    {.class_ = {.kind = AB_BOUNDARY, .spaces = AB_PLANE_STRAIN, .gives = AB_GIVE_TRACTION | AB_GIVE_DAMPING, .nparam = 1, .name = "dashpots", .param = fake_boundary_params}},
};

const ab_loaded_class *ab_registry_find(ab_registry *registry, uint32_t kind, const char *name, ab_mark mark, ab_report *report) {
    enum { COUNT = sizeof fake_classes / sizeof fake_classes[0] };
    const char *names[COUNT];
    size_t count = 0;
    char tail[1024];
    (void)registry;
    for (size_t i = 0; i < COUNT; i++) {
        if (fake_classes[i].class_.kind != kind) continue;
        if (strcmp(fake_classes[i].class_.name, name) == 0) return &fake_classes[i];
        names[count++] = fake_classes[i].class_.name;
    }
    ab_report_error(report, mark, "there is no plugin '%.64s'%s", name, ab_suggest_tail(name, names, count, tail, sizeof tail));
    return NULL;
}

#endif
