/* scene.c: from a file to a scene: document, overrides, then section by section; every mistake is collected before anything is refused. */
#include "core/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/scene_reader.h"
#include "core/suggest.h"

static void take_top(ab_scene_reader *r, const ab_node *root) {
    ab_scene *scene = r->scene;
    const ab_node *v[TOP_KEYS];
    if (!ab_section_open(&r->base, &ab_section_top, root, "", v)) return;
    const ab_key *key = ab_section_top.keys;
    ab_scene_take_constants(r, v[TOP_CONSTANTS]); /* first: every other number may use them */
    long version = 1;
    if (v[TOP_ABUT] != NULL && ab_read_integer(&r->base, &key[TOP_ABUT], v[TOP_ABUT], "", &version) && version != 1)
        ab_report_error(r->base.report, v[TOP_ABUT]->mark, "abut: %ld: this program reads version 1 of the scene format", version);
    char *space = NULL;
    ab_read_text(&r->base, &key[TOP_TITLE], v[TOP_TITLE], "", &scene->title);
    ab_read_word(&r->base, &key[TOP_SPACE], v[TOP_SPACE], "", &space);
    if (space != NULL && strcmp(space, "axisymmetric") == 0) scene->space = AB_SPACE_AXISYMMETRIC;
    ab_read_vector(&r->base, &key[TOP_GRAVITY], v[TOP_GRAVITY], "", scene->gravity);
    if (v[TOP_GRAVITY] != NULL) scene->mark_gravity = v[TOP_GRAVITY]->mark;
    ab_scene_take_damping(r, v[TOP_DAMPING]);
    ab_scene_take_watchdog(r, v[TOP_WATCHDOG]);
    ab_scene_take_time(r, v[TOP_TIME]);
    ab_scene_take_grid(r, v[TOP_GRID]);
    ab_scene_take_stages(r, root, v[TOP_TIME], v[TOP_STAGES]);
    ab_scene_take_materials(r, v[TOP_MATERIALS]);
    ab_scene_take_bodies(r, v[TOP_BODIES]);
    ab_scene_take_contacts(r, v[TOP_CONTACT]);
    ab_scene_check_grid(r, root);
    ab_scene_check_axisymmetric(r);
    ab_scene_check_initial(r);
    ab_scene_take_loads(r, v[TOP_LOADS]);
    ab_scene_take_boundaries(r, v[TOP_BOUNDARIES]);
    ab_scene_take_monitors(r, v[TOP_MONITORS]);
    ab_scene_take_history(r, v[TOP_HISTORY]);
    ab_scene_take_output(r, v[TOP_OUTPUT]);
    ab_scene_take_checkpoint(r, v[TOP_CHECKPOINT]);
    ab_scene_take_expects(r, v[TOP_EXPECT]);
    ab_scene_take_trade(r, v[TOP_TRADE]);
    ab_scene_take_extremes(r, v[TOP_EXTREMES]);
    ab_scene_take_checked(r, v[TOP_CHECKED]); /* last: everything else reads what the plugins themselves declare */
}

static void set_defaults(ab_scene *scene) {
    scene->space = AB_SPACE_PLANE_STRAIN;
    scene->dimension = 2;
    scene->damping_until = INFINITY;
    scene->watch = true;
    scene->watch_energy = 0.5;
    scene->time_cfl = 0.5;
    scene->history_every = 1;
    scene->has_history = true;
}

/* The scene's own memory, formulas and units. */
static ab_status prepare(ab_scene **made, ab_document *document, ab_scene_reader *r, ab_report *report) {
    ab_scene *scene = calloc(1, sizeof *scene);
    struct ab_scene_private *own = calloc(1, sizeof *own);
    if (scene == NULL || own == NULL) {
        free(scene);
        free(own);
        ab_document_destroy(document);
        return ab_report_failure(report, "no memory left while reading the scene");
    }
    scene->private_ = own;
    own->document = document;
    own->arena = ab_arena_create();
    own->formulas = ab_formulas_create();
    own->units = ab_units_create();
    if (own->arena == NULL || own->formulas == NULL || own->units == NULL) {
        ab_scene_destroy(scene);
        return ab_report_failure(report, "no memory left while reading the scene");
    }
    *r = (ab_scene_reader){
        .base = {.arena = own->arena, .formulas = own->formulas, .units = own->units, .report = report, .scene_path = document->path},
        .scene = scene};
    set_defaults(scene);
    scene->path = document->path;
    *made = scene;
    return AB_OK;
}

ab_status ab_scene_read(const char *path, const ab_override *overrides, size_t override_count, ab_registry *registry, ab_scene **scene,
                        ab_report *report) {
    *scene = NULL;
    const size_t errors = ab_report_errors(report);
    ab_document *document = NULL;
    AB_TRY(ab_document_read(path, &document, report));
    ab_scene *made = NULL;
    ab_scene_reader r;
    AB_TRY(prepare(&made, document, &r, report));
    r.registry = registry;
    ab_status status = AB_OK;
    for (size_t i = 0; i < override_count && status != AB_FAILED; i++)
        status = ab_document_set(document, overrides[i].path, overrides[i].value, report);
    if (status != AB_FAILED) {
        take_top(&r, document->root);
        made->files = r.base.files;
        status = ab_report_errors(report) > errors ? AB_BAD_INPUT : AB_OK;
    }
    if (r.base.out_of_memory) status = ab_report_failure(report, "no memory left while reading the scene");
    if (status != AB_OK) {
        ab_scene_destroy(made);
        return status;
    }
    *scene = made;
    return AB_OK;
}

void ab_scene_destroy(ab_scene *scene) {
    if (scene == NULL) return;
    struct ab_scene_private *own = scene->private_;
    ab_formulas_destroy(own->formulas);
    ab_units_destroy(own->units);
    ab_arena_destroy(own->arena);
    ab_document_destroy(own->document);
    free(own);
    free(scene);
}

int ab_scene_body_named(ab_scene_reader *reader, const char *name, ab_mark mark, const char *where) {
    const ab_scene *scene = reader->scene;
    for (size_t i = 0; i < scene->body_count; i++)
        if (strcmp(scene->bodies[i].name, name) == 0) return (int)i;
    const char *names[AB_DOCUMENT_KEYS];
    for (size_t i = 0; i < scene->body_count; i++) names[i] = scene->bodies[i].name;
    char tail[AB_TAIL];
    ab_report_error(reader->base.report, mark, "%s: there is no body '%.64s'%s", where, name,
                    ab_suggest_tail(name, names, scene->body_count, tail, sizeof tail));
    return -1;
}

const ab_state *ab_scene_state_named(const ab_scene *scene, size_t body, const char *name) {
    for (size_t b = 0; b < scene->body_count; b++) {
        if (body != SIZE_MAX && b != body) continue;
        const size_t m = scene->bodies[b].material;
        if (scene->bodies[b].method != NULL && strcmp(scene->bodies[b].method, "rigid") == 0) continue; /* nothing strains */
        if (m >= scene->material_count || scene->materials[m].loaded == NULL) continue;
        const ab_class *model = &scene->materials[m].loaded->class_;
        for (uint32_t s = 0; s < model->nstate; s++)
            if (strcmp(model->state[s].name, name) == 0) return &model->state[s];
    }
    return NULL;
}

bool ab_scene_is_list(ab_scene_reader *reader, const ab_node *node, const char *where, const char *of) {
    if (node->kind == AB_NODE_LIST) return true;
    ab_report_error(reader->base.report, node->mark, "%s must be a list of %s, not %s", where, of, ab_node_kind_name(node));
    return false;
}

const char *ab_scene_word(ab_scene_reader *reader, const ab_node *node, const char *where, const char *wanted) {
    if (node->kind == AB_NODE_SCALAR && !ab_node_is_null(node)) return node->text;
    ab_report_error(reader->base.report, node->mark, "%s must be %s, not %s", where, wanted, ab_node_kind_name(node));
    return NULL;
}
