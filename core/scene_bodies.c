/* scene_bodies.c: bodies by name: outline, points, basis, transfer, first velocities; and whether they lie in the grid. */
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

static void take_fill(ab_scene_reader *r, const ab_node *node, const char *where, ab_body_spec *body) {
    const ab_node *v[FILL_KEYS] = {NULL};
    char path[AB_WHERE];
    ab_where_join(path, where, "fill");
    body->mark_fill = node == NULL ? body->mark : node->mark;
    if (node != NULL && !ab_section_open(&r->base, &ab_section_fill, node, path, v)) return;
    char *rule = NULL;
    long per_cell = 4;
    if (ab_read_word(&r->base, &ab_section_fill.keys[FILL_RULE], v[FILL_RULE], path, &rule))
        body->fill = strcmp(rule, "gauss") == 0 ? AB_FILL_GAUSS : AB_FILL_REGULAR;
    ab_read_integer(&r->base, &ab_section_fill.keys[FILL_PER_CELL], v[FILL_PER_CELL], path, &per_cell);
    body->per_cell = (int)per_cell;
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
    if (node == NULL || node->kind != AB_NODE_MAP) {
        char *word = NULL;
        if (ab_read_word(&r->base, &ab_section_body.keys[BODY_TRANSFER], node, where, &word)) body->flip = strcmp(word, "pic") == 0 ? 0 : 1;
        return;
    }
    const ab_node *v[TRANSFER_KEYS];
    char path[AB_WHERE];
    ab_where_join(path, where, "transfer");
    if (ab_section_open(&r->base, &ab_section_transfer, node, path, v))
        ab_read_number(&r->base, &ab_section_transfer.keys[TRANSFER_FLIP], v[TRANSFER_FLIP], path, &body->flip);
}

/* The whole outline must lie in the grid. */
static void check_inside(ab_scene_reader *r, const ab_body_spec *body) {
    const ab_scene *scene = r->scene;
    double low[2], high[2];
    if (scene->grid_cells[0] == 0 || scene->grid_cells[1] == 0 || !ab_shape_bounds(&body->shape, low, high)) return;
    const double slack = 1e-9 * scene->grid_cell;
    bool inside = true, apart = false;
    for (int d = 0; d < 2; d++) {
        const double from = scene->grid_from[d] - slack - 1e-12 * fabs(scene->grid_from[d]),
                     to = scene->grid_to[d] + slack + 1e-12 * fabs(scene->grid_to[d]);
        inside = inside && low[d] >= from && high[d] <= to;
        apart = apart || high[d] <= from || low[d] >= to;
    }
    if (!inside)
        ab_report_error(r->base.report, body->shape.mark,
                        "body '%s' lies %s outside the grid: it reaches from [%.10g, %.10g] to [%.10g, %.10g] m, the grid from [%.10g, "
                        "%.10g] to [%.10g, %.10g] m; make the grid larger or move the body",
                        body->name, apart ? "wholly" : "partly", low[0], low[1], high[0], high[1], scene->grid_from[0], scene->grid_from[1],
                        scene->grid_to[0], scene->grid_to[1]);
}

static void take_body(ab_scene_reader *r, const ab_entry *entry, ab_body_spec *body) {
    char where[AB_WHERE], path[AB_WHERE];
    const ab_node *v[BODY_KEYS];
    ab_where_join(where, "bodies", entry->key);
    body->mark = entry->mark;
    ab_name_ok(&r->base, "body", entry->key, entry->mark);
    if (!ab_section_open(&r->base, &ab_section_body, entry->value, where, v)) return;
    const ab_key *key = ab_section_body.keys;
    if (v[BODY_METHOD] != NULL) ab_read_word(&r->base, &key[BODY_METHOD], v[BODY_METHOD], where, &body->method);
    if (v[BODY_MATERIAL] != NULL) take_material(r, v[BODY_MATERIAL], where, body);
    take_fill(r, v[BODY_FILL], where, body);
    take_basis(r, v[BODY_BASIS], where, body);
    take_transfer(r, v[BODY_TRANSFER], where, body);
    ab_read_word(&r->base, &key[BODY_UPDATE], v[BODY_UPDATE], where, &body->update);
    ab_read_vector(&r->base, &key[BODY_VELOCITY], v[BODY_VELOCITY], where, body->velocity);
    ab_read_flag(&r->base, &key[BODY_GRAVITY], v[BODY_GRAVITY], where, &body->gravity);
    if (v[BODY_SHAPE] != NULL && ab_scene_take_shape(r, v[BODY_SHAPE], ab_where_join(path, where, "shape"), &body->shape))
        check_inside(r, body);
    if (body->basis != NULL && body->update != NULL && strcmp(body->basis, "linear") == 0 && strcmp(body->update, "usl") == 0)
        ab_report_warning(r->base.report, v[BODY_UPDATE]->mark,
                          "%s: basis linear with update usl is unstable where a cell holds little mass; basis gimp or update musl is not",
                          where);
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
