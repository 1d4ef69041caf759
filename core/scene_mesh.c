/* scene_mesh.c: the mesh of a body: a box, a patch between four edges, or a file; and how far it reaches. */
#include <math.h>
#include <string.h>

#include "core/scene_reader.h"

enum { MOST_POINTS = 2000, MOST_ELEMENTS = 4000000 /* as of a mesh file */ };
static const double MOST_GRADING = 1e6;

static const ab_key place = {"", AB_KEY_POINT, .unit = "m", .help = ""};

static bool take_point(ab_scene_reader *r, const ab_node *node, const char *where, const char *name, double value[2]) {
    ab_key key = place;
    key.name = name;
    return ab_read_point(&r->base, &key, node, where, value);
}

static bool take_box(ab_scene_reader *r, const ab_node *node, const char *where, ab_mesh_spec *mesh) {
    if (node->kind != AB_NODE_LIST || node->count != 2) {
        ab_report_error(r->base.report, node->mark, "%s.box must be two corners [[x, y], [x, y]]", where);
        return false;
    }
    const bool low = take_point(r, node->items[0], where, "box", mesh->low), high = take_point(r, node->items[1], where, "box", mesh->high);
    if (!low || !high) return false;
    for (int d = 0; d < 2; d++)
        if (!(mesh->low[d] < mesh->high[d])) {
            ab_report_error(r->base.report, node->mark,
                            "%s.box: the second corner must lie above and to the right of the first; along %c it goes from %.10g to %.10g",
                            where, d == 0 ? 'x' : 'y', mesh->low[d], mesh->high[d]);
            return false;
        }
    return true;
}

/* {from: [x, y], to: [x, y], center: [x, y]} */
static bool take_arc(ab_scene_reader *r, const ab_node *node, const char *where, ab_edge_spec *edge) {
    const ab_node *v[ARC_KEYS];
    if (!ab_section_open(&r->base, &ab_section_arc, node, where, v)) return false;
    edge->arc = true;
    edge->count = 2;
    edge->points = ab_reader_take(&r->base, 2, sizeof *edge->points);
    if (edge->points == NULL) return false;
    const ab_key *key = ab_section_arc.keys;
    const bool from = ab_read_point(&r->base, &key[ARC_FROM], v[ARC_FROM], where, edge->points[0]);
    const bool to = ab_read_point(&r->base, &key[ARC_TO], v[ARC_TO], where, edge->points[1]);
    const bool center = ab_read_point(&r->base, &key[ARC_CENTER], v[ARC_CENTER], where, edge->center);
    if (!from || !to || !center) return false;
    double arm[2][2];
    for (int i = 0; i < 2; i++)
        for (int d = 0; d < 2; d++) arm[i][d] = edge->points[i][d] - edge->center[d];
    const double first = hypot(arm[0][0], arm[0][1]), last = hypot(arm[1][0], arm[1][1]);
    if (!(first > 0) || fabs(first - last) > 1e-6 * fmax(first, last)) {
        ab_report_error(r->base.report, node->mark,
                        "%s: from is %.10g m from the center and to is %.10g m; on a circle both are the same, above 0", where, first,
                        last);
        return false;
    }
    const double cross = arm[0][0] * arm[1][1] - arm[0][1] * arm[1][0], dot = arm[0][0] * arm[1][0] + arm[0][1] * arm[1][1];
    if (dot < 0 && fabs(cross) <= 1e-6 * first * last) {
        ab_report_error(r->base.report, node->mark,
                        "%s: half a circle has no shorter way round; cut the body into two patches there, or write the edge as points",
                        where);
        return false;
    }
    if (fabs(cross) <= 1e-12 * first * last) {
        ab_report_error(r->base.report, node->mark, "%s: from and to are the same place; an edge needs a length", where);
        return false;
    }
    return true;
}

/* A list of points, or {arc: {...}}. */
static bool take_edge(ab_scene_reader *r, const ab_node *node, const char *where, ab_edge_spec *edge) {
    char path[AB_WHERE];
    if (node->kind == AB_NODE_MAP && node->count == 1 && strcmp(node->entries[0].key, "arc") == 0)
        return take_arc(r, node->entries[0].value, ab_where_join(path, where, "arc"), edge);
    if (node->kind != AB_NODE_LIST || node->count < 2) {
        ab_report_error(
            r->base.report, node->mark,
            "%s must be a list of two points or more [[x, y], [x, y], ...], or {arc: {from: [x, y], to: [x, y], center: [x, y]}}", where);
        return false;
    }
    if (node->count > MOST_POINTS) {
        ab_report_error(r->base.report, node->mark, "%s has %zu points, more than %d", where, node->count, MOST_POINTS);
        return false;
    }
    edge->count = node->count;
    edge->points = ab_reader_take(&r->base, node->count, sizeof *edge->points);
    if (edge->points == NULL) return false;
    bool good = true;
    for (size_t i = 0; i < node->count; i++) {
        char name[32];
        snprintf(name, sizeof name, "point %zu", i);
        good = take_point(r, node->items[i], where, name, edge->points[i]) && good;
        if (good && i > 0 && edge->points[i][0] == edge->points[i - 1][0] && edge->points[i][1] == edge->points[i - 1][1]) {
            ab_report_error(r->base.report, node->items[i]->mark, "%s: point %zu is where point %zu is; leave one out", where, i, i - 1);
            good = false;
        }
    }
    return good;
}

/* Place on an edge at a part of its angle or at a point; enough to see which way round a patch goes. */
static void edge_sample(const ab_edge_spec *edge, int sample, int samples, double x[2]) {
    if (!edge->arc) {
        const size_t i = (edge->count - 1) * (size_t)sample / (size_t)samples;
        memcpy(x, edge->points[i], 2 * sizeof *x);
        return;
    }
    double angle[2];
    for (int i = 0; i < 2; i++) angle[i] = atan2(edge->points[i][1] - edge->center[1], edge->points[i][0] - edge->center[0]);
    const double turn = remainder(angle[1] - angle[0], 2 * 3.14159265358979323846), at = angle[0] + turn * sample / samples;
    const double radius = hypot(edge->points[0][0] - edge->center[0], edge->points[0][1] - edge->center[1]);
    x[0] = edge->center[0] + radius * cos(at);
    x[1] = edge->center[1] + radius * sin(at);
}

/* Where an arc comes closest to a side of its bounds: its points due east, north, west and south of the center, as far as it has them. */
static void arc_bounds(const ab_edge_spec *edge, double low[2], double high[2]) {
    double arm[2][2];
    for (int i = 0; i < 2; i++)
        for (int d = 0; d < 2; d++) arm[i][d] = edge->points[i][d] - edge->center[d];
    const double radius = hypot(arm[0][0], arm[0][1]), way = arm[0][0] * arm[1][1] - arm[0][1] * arm[1][0] > 0 ? 1 : -1;
    for (int k = 0; k < 4; k++) {
        const double out[2] = {k % 2 == 0 ? 1 - k : 0, k % 2 == 1 ? 2 - k : 0};
        const double after = way * (arm[0][0] * out[1] - arm[0][1] * out[0]), before = way * (out[0] * arm[1][1] - out[1] * arm[1][0]);
        if (after < 0 || before < 0 || out[0] * (arm[0][0] + arm[1][0]) + out[1] * (arm[0][1] + arm[1][1]) < 0) continue;
        const int d = k % 2;
        low[d] = fmin(low[d], edge->center[d] + radius * out[d]);
        high[d] = fmax(high[d], edge->center[d] + radius * out[d]);
    }
}

static bool mesh_bounds(const ab_mesh_spec *mesh, double low[2], double high[2]) {
    if (mesh->kind == AB_MESH_BOX) {
        memcpy(low, mesh->low, 2 * sizeof *low);
        memcpy(high, mesh->high, 2 * sizeof *high);
        return true;
    }
    if (mesh->kind != AB_MESH_PATCH) return false;
    for (int d = 0; d < 2; d++) low[d] = INFINITY, high[d] = -INFINITY;
    for (int e = 0; e < 4; e++) {
        const ab_edge_spec *edge = &mesh->edge[e];
        for (size_t i = 0; i < edge->count; i++)
            for (int d = 0; d < 2; d++) low[d] = fmin(low[d], edge->points[i][d]), high[d] = fmax(high[d], edge->points[i][d]);
        if (edge->arc) arc_bounds(edge, low, high);
    }
    return true;
}

bool ab_body_bounds(const ab_body_spec *body, double low[2], double high[2]) {
    return body->mesh.kind != AB_MESH_NONE ? mesh_bounds(&body->mesh, low, high) : ab_shape_bounds(&body->shape, low, high);
}

static const char *const edge_names[] = {"bottom", "right", "top", "left"};

/* Corner k of a patch is where edge `a` ends (or begins) and edge `b` does. */
static bool check_corners(ab_scene_reader *r, const ab_node *const *v, const char *where, const ab_mesh_spec *mesh) {
    static const struct {
        int a, b;
        bool a_end, b_end;
    } corner[4] = {{PATCH_BOTTOM, PATCH_LEFT, false, false},
                   {PATCH_BOTTOM, PATCH_RIGHT, true, false},
                   {PATCH_TOP, PATCH_RIGHT, true, true},
                   {PATCH_TOP, PATCH_LEFT, false, true}};
    double low[2], high[2];
    mesh_bounds(mesh, low, high);
    const double slack = 1e-9 * fmax(high[0] - low[0], high[1] - low[1]);
    bool good = true;
    for (int k = 0; k < 4; k++) {
        const ab_edge_spec *a = &mesh->edge[corner[k].a], *b = &mesh->edge[corner[k].b];
        const double *p = a->points[corner[k].a_end ? a->count - 1 : 0], *q = b->points[corner[k].b_end ? b->count - 1 : 0];
        if (hypot(p[0] - q[0], p[1] - q[1]) <= slack) continue;
        ab_report_error(
            r->base.report, v[corner[k].b]->mark,
            "%s: %s %s at [%.10g, %.10g] and %s %s at [%.10g, %.10g]; they must meet there (bottom and top go from left to right, "
            "left and right upwards)",
            where, edge_names[corner[k].a], corner[k].a_end ? "ends" : "begins", p[0], p[1], edge_names[corner[k].b],
            corner[k].b_end ? "ends" : "begins", q[0], q[1]);
        good = false;
    }
    return good;
}

/* Twice the area that the four edges enclose: positive when bottom, right, top, left go counter-clockwise. */
static double enclosed(const ab_mesh_spec *mesh, const double origin[2]) {
    double sum = 0;
    for (int e = 0; e < 4; e++) {
        const ab_edge_spec *edge = &mesh->edge[e];
        const int samples = edge->arc ? 64 : (int)edge->count - 1;
        double last[2], next[2], part = 0;
        edge_sample(edge, 0, samples, last);
        for (int k = 1; k <= samples; k++) {
            edge_sample(edge, k, samples, next);
            part += (last[0] - origin[0]) * (next[1] - origin[1]) - (last[1] - origin[1]) * (next[0] - origin[0]);
            memcpy(last, next, sizeof last);
        }
        sum += e < PATCH_TOP ? part : -part; /* top and left go against it */
    }
    return sum;
}

static bool take_patch(ab_scene_reader *r, const ab_node *node, const char *where, ab_mesh_spec *mesh) {
    const ab_node *v[PATCH_KEYS];
    char path[AB_WHERE], edge[AB_WHERE];
    ab_where_join(path, where, "patch");
    if (!ab_section_open(&r->base, &ab_section_patch, node, path, v)) return false;
    bool good = true;
    for (int e = 0; e < 4; e++) good = v[e] != NULL && take_edge(r, v[e], ab_where_join(edge, path, edge_names[e]), &mesh->edge[e]) && good;
    if (!good) return false;
    mesh->kind = AB_MESH_PATCH;
    if (!check_corners(r, v, path, mesh)) return false;
    if (!(enclosed(mesh, mesh->edge[PATCH_BOTTOM].points[0]) > 0)) {
        ab_report_error(
            r->base.report, node->mark,
            "%s: bottom, right, top and left go round clockwise, or enclose nothing; left must lie to the left of right as one looks "
            "along it, so exchange left and right",
            path);
        return false;
    }
    return true;
}

static bool take_elements(ab_scene_reader *r, const ab_node *node, const char *where, ab_mesh_spec *mesh) {
    double wanted[2];
    if (!ab_read_point(&r->base, &ab_section_mesh.keys[MESH_ELEMENTS], node, where, wanted)) return false;
    for (int d = 0; d < 2; d++) {
        if (wanted[d] != floor(wanted[d]) || wanted[d] < 1) {
            ab_report_error(r->base.report, node->mark, "%s.elements must be two whole numbers [nx, ny], 1 or more; %.10g is not", where,
                            wanted[d]);
            return false;
        }
    }
    if (wanted[0] * wanted[1] > MOST_ELEMENTS) {
        ab_report_error(r->base.report, node->mark, "%s.elements: %.10g x %.10g are %.3g elements, more than %d; take fewer, larger ones",
                        where, wanted[0], wanted[1], wanted[0] * wanted[1], MOST_ELEMENTS);
        return false;
    }
    for (int d = 0; d < 2; d++) mesh->elements[d] = (long)wanted[d];
    return true;
}

static bool take_grading(ab_scene_reader *r, const ab_node *node, const char *where, ab_mesh_spec *mesh) {
    if (!ab_read_point(&r->base, &ab_section_mesh.keys[MESH_GRADING], node, where, mesh->grading)) return false;
    for (int d = 0; d < 2; d++)
        if (!(mesh->grading[d] >= 1 / MOST_GRADING && mesh->grading[d] <= MOST_GRADING)) {
            ab_report_error(r->base.report, node->mark,
                            "%s.grading is %.10g along %c but must be between %g and %g: size of the last element over that of the first",
                            where, mesh->grading[d], d == 0 ? 'x' : 'y', 1 / MOST_GRADING, MOST_GRADING);
            return false;
        }
    return true;
}

static bool take_type(ab_scene_reader *r, const ab_node *const *v, const char *where, ab_mesh_spec *mesh) {
    static const char *const names[] = {"q4", "q4r", "q6", "q8", "q8r"}; /* in the order of ab_element_type */
    const ab_key *key = ab_section_mesh.keys;
    char *type = NULL;
    bool good = ab_read_word(&r->base, &key[MESH_TYPE], v[MESH_TYPE], where, &type);
    for (int t = 0; good && t < 5; t++)
        if (strcmp(type, names[t]) == 0) mesh->type = (ab_element_type)t;
    const bool known = good;
    good = ab_read_flag(&r->base, &key[MESH_F_BAR], v[MESH_F_BAR], where, &mesh->f_bar) && good;
    good = ab_read_number(&r->base, &key[MESH_HOURGLASS], v[MESH_HOURGLASS], where, &mesh->hourglass) && good;
    if (known && mesh->f_bar && mesh->type != AB_ELEMENT_Q4) {
        ab_report_error(r->base.report, v[MESH_F_BAR]->mark, "%s.f_bar belongs to type q4; leave it out of type %s%s", where, type,
                        mesh->type == AB_ELEMENT_Q8 ? ", or take type q8r, which does not lock" : "");
        good = false;
    }
    if (known && v[MESH_HOURGLASS] != NULL && mesh->type != AB_ELEMENT_Q4R) {
        ab_report_error(r->base.report, v[MESH_HOURGLASS]->mark,
                        "%s.hourglass belongs to type q4r; leave it out of type %s, which needs no stabilisation", where, type);
        good = false;
    }
    return good;
}

bool ab_scene_take_mesh(ab_scene_reader *r, const ab_node *node, const char *where, ab_mesh_spec *mesh) {
    const ab_node *v[MESH_KEYS];
    *mesh = (ab_mesh_spec){.mark = node->mark, .grading = {1, 1}, .hourglass = 1};
    if (!ab_section_open(&r->base, &ab_section_mesh, node, where, v)) return false;
    const int kinds = (v[MESH_BOX] != NULL) + (v[MESH_PATCH] != NULL) + (v[MESH_FILE] != NULL);
    if (kinds != 1) {
        ab_report_error(r->base.report, node->mark, "%s needs one of box, patch and file%s", where, kinds > 1 ? ", not several" : "");
        return false;
    }
    bool good = take_type(r, v, where, mesh);
    ab_mesh_kind kind = AB_MESH_FILE;
    if (v[MESH_FILE] != NULL) {
        good = ab_read_text(&r->base, &ab_section_mesh.keys[MESH_FILE], v[MESH_FILE], where, &mesh->file) && good;
        if (good && mesh->file[0] == '\0') {
            ab_report_error(r->base.report, v[MESH_FILE]->mark, "%s.file is empty; write the name of a Gmsh file", where);
            good = false;
        }
        for (int k = MESH_ELEMENTS; k <= MESH_GRADING; k++)
            if (v[k] != NULL) {
                ab_report_error(r->base.report, v[k]->mark,
                                "%s.%s belongs to box and patch; the elements of a file are as the file has them", where,
                                ab_section_mesh.keys[k].name);
                good = false;
            }
    } else {
        kind = v[MESH_BOX] != NULL ? AB_MESH_BOX : AB_MESH_PATCH;
        good = (v[MESH_BOX] != NULL ? take_box(r, v[MESH_BOX], where, mesh) : take_patch(r, v[MESH_PATCH], where, mesh)) && good;
        if (v[MESH_ELEMENTS] == NULL) {
            ab_report_error(r->base.report, node->mark, "key 'elements' is missing in %s: [nx, ny], how many along x and along y", where);
            good = false;
        } else {
            good = take_elements(r, v[MESH_ELEMENTS], where, mesh) && good;
        }
        if (v[MESH_GRADING] != NULL) good = take_grading(r, v[MESH_GRADING], where, mesh) && good;
    }
    mesh->kind = good ? kind : AB_MESH_NONE;
    return good;
}
