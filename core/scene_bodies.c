/* scene_bodies.c: bodies by name: their method, and outline, points, basis, transfer, first velocities. */
#include <math.h>
#include <string.h>

#include "core/scene_reader.h"
#include "core/suggest.h"

static void take_material(ab_scene_reader *r, const ab_node *node, const char *where, ab_body_spec *body) {
    const ab_scene *scene = r->scene;
    char path[AB_WHERE], tail[AB_TAIL];
    const char *names[AB_DOCUMENT_KEYS], *name = ab_scene_word(r, node, ab_where_join(path, where, "material"), "the name of a material");
    if (name == NULL) return;
    for (size_t m = 0; m < scene->material_count; m++) {
        names[m] = scene->materials[m].name;
        if (strcmp(names[m], name) == 0) body->material = m;
    }
    if (body->material == SIZE_MAX)
        ab_report_error(r->base.report, node->mark, "%s: there is no material '%.64s'%s", path, name,
                        ab_suggest_tail(name, names, scene->material_count, tail, sizeof tail));
}

/* A key of another rule is refused; where --set has chosen the rule, it is left out with a warning. */
static void leave_out(ab_scene_reader *r, const ab_node *node, const ab_node *rule_node, const char *where, const char *name,
                      const char *whose, const char *rule) {
    if (rule_node != NULL && rule_node->override_ && !node->override_)
        ab_report_warning(r->base.report, node->mark, "%s.%s belongs to rule %s, not to %s, which --set chose; it is left out", where, name,
                          whose, rule);
    else
        ab_report_error(r->base.report, node->mark, "%s.%s belongs to rule %s; with rule %s write per_cell, or leave it out", where, name,
                        whose, rule);
}

static void take_fill(ab_scene_reader *r, const ab_node *node, const char *where, ab_body_spec *body) {
    const ab_node *v[FILL_KEYS] = {NULL};
    char path[AB_WHERE];
    ab_where_join(path, where, "fill");
    body->mark_fill = node == NULL ? body->mark : node->mark;
    if (node != NULL && !ab_section_open(&r->base, &ab_section_fill, node, path, v)) return;
    const ab_key *key = ab_section_fill.keys;
    char *rule = NULL;
    long per_cell = 4;
    const bool known = ab_read_word(&r->base, &key[FILL_RULE], v[FILL_RULE], path, &rule);
    if (known) body->fill = strcmp(rule, "gauss") == 0 ? AB_FILL_GAUSS : strcmp(rule, "cvt") == 0 ? AB_FILL_CVT : AB_FILL_REGULAR;
    ab_read_integer(&r->base, &key[FILL_PER_CELL], v[FILL_PER_CELL], path, &per_cell);
    body->per_cell = (int)per_cell;
    ab_read_integer(&r->base, &key[FILL_POINTS], v[FILL_POINTS], path, &body->points);
    ab_read_integer(&r->base, &key[FILL_SEED], v[FILL_SEED], path, &body->seed);
    ab_read_number(&r->base, &key[FILL_TOLERANCE], v[FILL_TOLERANCE], path, &body->fill_tolerance);
    ab_read_integer(&r->base, &key[FILL_ITERATIONS], v[FILL_ITERATIONS], path, &body->fill_rounds);
    if (!known) return;
    if (body->shape.kind == AB_SHAPE_MESH) { /* no lattice to choose */
        const long side = lround(sqrt((double)per_cell));
        if (v[FILL_RULE] != NULL && body->fill != AB_FILL_GAUSS)
            ab_report_error(
                r->base.report, v[FILL_RULE]->mark,
                "%s.rule is %s, but a mesh is filled by the Gauss points of its elements; write gauss, or draw the outline as a polygon",
                path, rule);
        body->fill = AB_FILL_GAUSS;
        rule = ab_reader_text(&r->base, "gauss");
        if (side * side != per_cell || side > 64)
            ab_report_error(r->base.report, v[FILL_PER_CELL]->mark,
                            "%s.per_cell is %ld: in each element of a mesh stand 1, 4, 9, 16 or another square up to 4096", path, per_cell);
    }
    for (int k = FILL_POINTS; k <= FILL_ITERATIONS && body->fill != AB_FILL_CVT; k++)
        if (v[k] != NULL) leave_out(r, v[k], v[FILL_RULE], path, key[k].name, "cvt", rule);
    if (v[FILL_POINTS] != NULL && v[FILL_PER_CELL] != NULL && body->fill == AB_FILL_CVT) {
        if (v[FILL_POINTS]->override_ == v[FILL_PER_CELL]->override_)
            ab_report_error(r->base.report, v[FILL_POINTS]->mark,
                            "%s has both points and per_cell; keep one: points are all of the body, per_cell those of a cell", path);
        else if (v[FILL_PER_CELL]->override_) /* what --set says takes the place of the other */
            body->points = 0;
    }
}

static void take_basis(ab_scene_reader *r, const ab_node *node, const char *where, ab_body_spec *body) {
    body->contiguous = true;
    if (node == NULL || node->kind != AB_NODE_MAP) {
        ab_read_word(&r->base, &ab_section_body.keys[BODY_BASIS], node, where, &body->basis);
        return;
    }
    const ab_node *v[BASIS_KEYS];
    char path[AB_WHERE], *word = NULL;
    ab_where_join(path, where, "basis");
    body->basis = ab_reader_text(&r->base, "gimp");
    if (ab_section_open(&r->base, &ab_section_basis, node, path, v) && v[BASIS_GIMP] != NULL &&
        ab_read_word(&r->base, &ab_section_basis.keys[BASIS_GIMP], v[BASIS_GIMP], path, &word))
        body->contiguous = strcmp(word, "contiguous") == 0;
}

static void take_transfer(ab_scene_reader *r, const ab_node *node, const char *where, ab_body_spec *body) {
    body->flip = 1;
    char path[AB_WHERE];
    ab_where_join(path, where, "transfer");
    if (node == NULL || node->kind != AB_NODE_MAP) {
        char *word = NULL;
        if (node != NULL && node->kind == AB_NODE_SCALAR && (strcmp(node->text, "xpic") == 0 || strcmp(node->text, "fmpm") == 0)) {
            ab_report_error(r->base.report, node->mark, "%s: '%s' needs its order; write {%s: 2}", path, node->text, node->text);
            return;
        }
        if (!ab_read_word(&r->base, &ab_section_body.keys[BODY_TRANSFER], node, where, &word)) return;
        if (strcmp(word, "apic") == 0) body->transfer = AB_TRANSFER_APIC;
        if (strcmp(word, "tpic") == 0) body->transfer = AB_TRANSFER_TPIC;
        body->flip = strcmp(word, "flip") == 0 ? 1 : 0;
        return;
    }
    const ab_node *v[TRANSFER_KEYS];
    const ab_key *key = ab_section_transfer.keys;
    const size_t mistakes = ab_report_errors(r->base.report);
    if (!ab_section_open(&r->base, &ab_section_transfer, node, path, v)) return;
    int given = 0;
    for (int k = 0; k < TRANSFER_KEYS; k++) given += v[k] != NULL;
    if (given != 1 && ab_report_errors(r->base.report) == mistakes)
        ab_report_error(r->base.report, node->mark, "%s needs one of flip, xpic and fmpm, not %d of them", path, given);
    long order = 1;
    if (v[TRANSFER_FLIP] != NULL) ab_read_number(&r->base, key + TRANSFER_FLIP, v[TRANSFER_FLIP], path, &body->flip);
    for (int k = TRANSFER_XPIC; k <= TRANSFER_FMPM; k++)
        if (v[k] != NULL && ab_read_integer(&r->base, key + k, v[k], path, &order))
            body->transfer = k == TRANSFER_XPIC ? AB_TRANSFER_XPIC : AB_TRANSFER_FMPM;
    body->order = (int)order;
}

static void take_surface(ab_scene_reader *r, const ab_node *node, const char *where, ab_body_spec *body) {
    static const double SPACING = 1.0; /* cells, where none is given */
    char path[AB_WHERE], *word = NULL;
    if (node == NULL || node->kind != AB_NODE_MAP) {
        if (ab_read_word(&r->base, &ab_section_body.keys[BODY_SURFACE], node, where, &word))
            body->surface_points = strcmp(word, "points") == 0 ? SPACING : 0.0;
        return;
    }
    const ab_node *v[SURFACE_KEYS];
    ab_where_join(path, where, "surface");
    if (ab_section_open(&r->base, &ab_section_surface, node, path, v) && v[SURFACE_POINTS] != NULL)
        ab_read_number(&r->base, &ab_section_surface.keys[SURFACE_POINTS], v[SURFACE_POINTS], path, &body->surface_points);
}

enum { POINTS = 1, ELEMENTS = 2, RIGID = 4 };
static const struct {
    const char *name;
    unsigned bit;
} methods[] = {{"material-points", POINTS}, {"finite-elements", ELEMENTS}, {"rigid", RIGID}};
enum { METHODS = sizeof methods / sizeof *methods };

static const unsigned belongs[BODY_KEYS] = {
    [BODY_METHOD] = POINTS | ELEMENTS | RIGID,
    [BODY_MATERIAL] = POINTS | ELEMENTS | RIGID,
    [BODY_SHAPE] = POINTS | RIGID,
    [BODY_FILL] = POINTS,
    [BODY_BASIS] = POINTS,
    [BODY_TRANSFER] = POINTS,
    [BODY_UPDATE] = POINTS,
    [BODY_F_BAR] = POINTS,
    [BODY_SURFACE] = POINTS,
    [BODY_VELOCITY] = POINTS | ELEMENTS | RIGID,
    [BODY_INITIAL] = POINTS | ELEMENTS,
    [BODY_GRAVITY] = POINTS | ELEMENTS | RIGID,
    [BODY_FORCE] = POINTS | ELEMENTS,
    [BODY_MESH] = ELEMENTS | RIGID,
    [BODY_FIX] = ELEMENTS,
    [BODY_MOTION] = RIGID,
};

/* Keys of other methods are refused; where --set has chosen the method, those of the file are left out with a warning. */
static void sort_keys(ab_scene_reader *r, const ab_node **v, const char *where, unsigned method, const char *name) {
    for (int k = 0; k < BODY_KEYS; k++) {
        if (v[k] == NULL || (belongs[k] & method)) continue;
        char whose[80] = "";
        for (int m = 0; m < METHODS; m++)
            if (belongs[k] & methods[m].bit)
                snprintf(whose + strlen(whose), sizeof whose - strlen(whose), "%s%s", whose[0] == '\0' ? "" : " and ", methods[m].name);
        if (v[BODY_METHOD]->override_ && !v[k]->override_)
            ab_report_warning(r->base.report, v[k]->mark, "%s.%s belongs to method %s, not to %s, which --set chose; it is left out", where,
                              ab_section_body.keys[k].name, whose, name);
        else
            ab_report_error(r->base.report, v[k]->mark, "%s.%s belongs to method %s; leave it out of a body of method %s", where,
                            ab_section_body.keys[k].name, whose, name);
        v[k] = NULL;
    }
}

static void missing(ab_scene_reader *r, ab_mark mark, const char *where, const char *key, const char *method, const char *form) {
    ab_report_error(r->base.report, mark, "key '%s' is missing in %s: method %s needs it, %s", key, where, method, form);
}

static void take_points(ab_scene_reader *r, const ab_node *const *v, const char *where, ab_body_spec *body) {
    take_fill(r, v[BODY_FILL], where, body);
    take_basis(r, v[BODY_BASIS], where, body);
    take_transfer(r, v[BODY_TRANSFER], where, body);
    take_surface(r, v[BODY_SURFACE], where, body);
    ab_read_word(&r->base, &ab_section_body.keys[BODY_UPDATE], v[BODY_UPDATE], where, &body->update);
    char *cells = NULL;
    if (ab_read_word(&r->base, &ab_section_body.keys[BODY_F_BAR], v[BODY_F_BAR], where, &cells))
        body->f_bar = strcmp(cells, "cell") == 0 ? AB_F_BAR_CELL : strcmp(cells, "patch") == 0 ? AB_F_BAR_PATCH : AB_F_BAR_NONE;
    if (body->basis != NULL && body->update != NULL && body->transfer == AB_TRANSFER_TPIC && strcmp(body->basis, "gimp") == 0 &&
        strcmp(body->update, "usl") == 0) /* slopes at the edge of the body feed the strain that makes them: a bar blows up at any dt */
        ab_report_error(
            r->base.report, v[BODY_UPDATE]->mark,
            "%s: transfer tpic with update usl on basis gimp is unstable at the edge of a body; use update musl or usf, or transfer apic",
            where);
}

/* A mesh that points fill. */
static void take_shape_mesh(ab_scene_reader *r, const ab_node *node, const char *where, unsigned method, ab_body_spec *body) {
    char path[AB_WHERE];
    const ab_node *mesh = ab_node_find(node, "mesh");
    ab_where_join(path, where, "mesh");
    body->has_shape = method == POINTS && ab_scene_take_mesh(r, mesh, path, &body->mesh);
    if (method != POINTS)
        ab_report_error(r->base.report, mesh->mark, "%s: a rigid body has its mesh in place of a shape; write mesh: beside method:", path);
    for (int k = MESH_F_BAR; k <= MESH_HOURGLASS && mesh->kind == AB_NODE_MAP; k++)
        if (ab_node_find(mesh, ab_section_mesh.keys[k].name) != NULL)
            ab_report_error(r->base.report, mesh->mark,
                            "%s.%s belongs to finite elements; points only take places and volumes from a mesh, leave it out", path,
                            ab_section_mesh.keys[k].name);
}

/* Where the body is at the start: by method a shape, a mesh, or one of them. */
static void take_outline(ab_scene_reader *r, const ab_node *const *v, const char *where, unsigned method, ab_mark mark,
                         ab_body_spec *body) {
    char path[AB_WHERE];
    if (method == RIGID && (v[BODY_SHAPE] != NULL) == (v[BODY_MESH] != NULL)) {
        ab_report_error(r->base.report, v[BODY_SHAPE] != NULL ? v[BODY_MESH]->mark : mark, "%s needs one of shape and mesh%s", where,
                        v[BODY_SHAPE] != NULL ? ", not both" : ": {box: [[x, y], [x, y]]}, say");
        return;
    }
    if (method == POINTS && v[BODY_SHAPE] == NULL) missing(r, mark, where, "shape", body->method, "{box: [[x, y], [x, y]]}, say");
    if (method == ELEMENTS && v[BODY_MESH] == NULL)
        missing(r, mark, where, "mesh", body->method, "{box: [[x, y], [x, y]], elements: [nx, ny]}, say");
    if (v[BODY_SHAPE] != NULL) body->has_shape = ab_scene_take_shape(r, v[BODY_SHAPE], ab_where_join(path, where, "shape"), &body->shape);
    if (body->has_shape && body->shape.kind == AB_SHAPE_MESH) take_shape_mesh(r, v[BODY_SHAPE], path, method, body);
    if (v[BODY_MESH] != NULL) ab_scene_take_mesh(r, v[BODY_MESH], ab_where_join(path, where, "mesh"), &body->mesh);
}

static void take_body(ab_scene_reader *r, const ab_entry *entry, ab_body_spec *body) {
    char where[AB_WHERE], path[AB_WHERE];
    const ab_node *v[BODY_KEYS];
    ab_where_join(where, "bodies", entry->key);
    body->mark = entry->mark;
    ab_name_ok(&r->base, "body", entry->key, entry->mark);
    if (!ab_section_open(&r->base, &ab_section_body, entry->value, where, v)) return;
    const ab_key *key = ab_section_body.keys;
    unsigned method = 0;
    if (v[BODY_METHOD] != NULL && ab_read_word(&r->base, &key[BODY_METHOD], v[BODY_METHOD], where, &body->method))
        for (int m = 0; m < METHODS; m++)
            if (strcmp(body->method, methods[m].name) == 0) method = methods[m].bit;
    if (method != 0) sort_keys(r, v, where, method, body->method);
    const ab_mark mark = entry->value->mark;
    if (v[BODY_MATERIAL] != NULL)
        take_material(r, v[BODY_MATERIAL], where, body);
    else if (method != 0 && method != RIGID)
        missing(r, mark, where, "material", body->method, "the name of one of the materials");
    ab_read_vector(&r->base, &key[BODY_VELOCITY], v[BODY_VELOCITY], where, body->velocity);
    ab_read_flag(&r->base, &key[BODY_GRAVITY], v[BODY_GRAVITY], where, &body->gravity);
    if (v[BODY_FORCE] != NULL && ab_read_vector(&r->base, &key[BODY_FORCE], v[BODY_FORCE], where, body->force)) /* zeros are none */
        body->has_force = body->force[0].expression != NULL || body->force[1].expression != NULL || body->force[0].value != 0 ||
                          body->force[1].value != 0;
    if (method != 0) take_outline(r, v, where, method, mark, body);
    if (method == POINTS) take_points(r, v, where, body);
    if (v[BODY_INITIAL] != NULL) ab_scene_take_initial(r, v[BODY_INITIAL], ab_where_join(path, where, "initial"), body);
    if (v[BODY_FIX] != NULL) ab_scene_take_fix(r, v[BODY_FIX], ab_where_join(path, where, "fix"), body);
    if (v[BODY_MOTION] != NULL) ab_scene_take_motion(r, v[BODY_MOTION], ab_where_join(path, where, "motion"), body);
    if (method == RIGID) ab_scene_hold_radius(r, body);
    if (method == RIGID && v[BODY_MATERIAL] == NULL) ab_scene_check_mass(r, body, where);
}

void ab_scene_take_bodies(ab_scene_reader *r, const ab_node *node) {
    if (node == NULL) return;
    ab_scene *scene = r->scene;
    if (node->kind != AB_NODE_MAP || node->count == 0) {
        ab_report_error(r->base.report, node->mark,
                        "bodies must be a mapping {name: {method: ..., material: ..., shape: ...}, ...}, not %s",
                        node->kind == AB_NODE_MAP ? "an empty one" : ab_node_kind_name(node));
        return;
    }
    scene->bodies = ab_reader_take(&r->base, node->count, sizeof *scene->bodies);
    if (scene->bodies == NULL) return;
    for (size_t i = 0; i < node->count; i++) { /* names first: they are looked up even where a body has mistakes */
        scene->bodies[i].name = ab_reader_text(&r->base, node->entries[i].key);
        if (scene->bodies[i].name == NULL) return;
        scene->bodies[i].material = SIZE_MAX;
        scene->bodies[i].gravity = true;
    }
    scene->body_count = node->count;
    for (size_t i = 0; i < node->count; i++) take_body(r, &node->entries[i], &scene->bodies[i]);
}
