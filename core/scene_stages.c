/* scene_stages.c: the parts of a run: how long each is, how it is damped, when it is at rest, which sides hold in it; and the one that is put before the start where
 * a body is to begin with the stress of gravity. */
#include <math.h>
#include <string.h>

#include "core/scene_reader.h"
#include "core/suggest.h"

/* Does some body ask for `initial: {stress: gravity}`? Bodies are read later, for they name stages. */
static bool asks_for_gravity(const ab_node *root, ab_mark *mark) {
    const ab_node *bodies = ab_node_find(root, "bodies");
    for (size_t b = 0; bodies != NULL && bodies->kind == AB_NODE_MAP && b < bodies->count; b++) {
        const ab_node *body = bodies->entries[b].value;
        const ab_node *initial = body->kind == AB_NODE_MAP ? ab_node_find(body, "initial") : NULL;
        const ab_node *stress = initial != NULL && initial->kind == AB_NODE_MAP ? ab_node_find(initial, "stress") : NULL;
        if (stress == NULL || stress->kind != AB_NODE_SCALAR || strcmp(stress->text, "gravity") != 0) continue;
        *mark = stress->mark;
        return true;
    }
    return false;
}

static bool is_word(ab_scene_reader *r, const ab_key *key, const ab_node *node, const char *where, const char *wanted) {
    char *word = NULL;
    return ab_read_word(&r->base, key, node, where, &word) && strcmp(word, wanted) == 0;
}

static void take_damping(ab_scene_reader *r, const ab_node *node, const char *where, ab_stage_spec *stage) {
    const ab_node *v[CALM_KEYS];
    if (!ab_section_open(&r->base, &ab_section_calm, node, where, v)) return;
    ab_read_number(&r->base, &ab_section_calm.keys[CALM_LOCAL], v[CALM_LOCAL], where, &stage->local);
    ab_read_flag(&r->base, &ab_section_calm.keys[CALM_KINETIC], v[CALM_KINETIC], where, &stage->kinetic);
}

static void take_until(ab_scene_reader *r, const ab_node *node, const char *where, ab_stage_spec *stage) {
    const ab_node *v[UNTIL_KEYS];
    if (!ab_section_open(&r->base, &ab_section_until, node, where, v)) return;
    const ab_key *key = ab_section_until.keys;
    stage->has_until = true;
    if (v[UNTIL_FORCE] == NULL && v[UNTIL_ENERGY] == NULL)
        ab_report_error(r->base.report, node->mark, "%s: write unbalanced_force: 1e-4, kinetic_energy: 1e-4, or one of them", where);
    if (v[UNTIL_FORCE] != NULL) ab_read_number(&r->base, &key[UNTIL_FORCE], v[UNTIL_FORCE], where, &stage->unbalanced);
    if (v[UNTIL_ENERGY] != NULL) ab_read_number(&r->base, &key[UNTIL_ENERGY], v[UNTIL_ENERGY], where, &stage->at_rest);
    stage->go_on = is_word(r, &key[UNTIL_MISSED], v[UNTIL_MISSED], where, "warn");
}

static void take_step(ab_scene_reader *r, const ab_node *const *v, const char *where, ab_stage_spec *stage) {
    const ab_key *key = ab_section_stage.keys;
    const bool both = v[STAGE_DT] != NULL && v[STAGE_CFL] != NULL;
    if (both && v[STAGE_DT]->override_ == v[STAGE_CFL]->override_)
        ab_report_error(r->base.report, v[STAGE_CFL]->mark,
                        "%s has both dt and cfl; keep one: dt is a fixed step, cfl a part of the critical one", where);
    stage->cfl = 0.0;
    if (v[STAGE_DT] != NULL && !(both && v[STAGE_CFL]->override_)) {
        ab_read_number(&r->base, &key[STAGE_DT], v[STAGE_DT], where, &stage->dt);
        return;
    }
    ab_read_number(&r->base, &key[STAGE_CFL], v[STAGE_CFL], where, &stage->cfl);
    if (stage->cfl > 1)
        ab_report_warning(r->base.report, v[STAGE_CFL]->mark, "%s.cfl %g is above 1, the limit of stability", where, stage->cfl);
}

/* Its end, from its end or its duration and the end of the one before. */
static void take_end(ab_scene_reader *r, const ab_node *node, const ab_node *const *v, const char *where, double before,
                     ab_stage_spec *stage) {
    const ab_key *key = ab_section_stage.keys;
    double duration = 0.0;
    stage->end = before + 1.0; /* for the rest of the checks */
    if ((v[STAGE_END] == NULL) == (v[STAGE_DURATION] == NULL)) {
        ab_report_error(r->base.report, node->mark, "%s needs one of end and duration, s%s", where,
                        v[STAGE_END] == NULL ? "" : ", not both");
        return;
    }
    if (v[STAGE_DURATION] != NULL && ab_read_number(&r->base, &key[STAGE_DURATION], v[STAGE_DURATION], where, &duration))
        stage->end = before + duration;
    if (v[STAGE_END] != NULL && ab_read_number(&r->base, &key[STAGE_END], v[STAGE_END], where, &stage->end) && !(stage->end > before)) {
        ab_report_error(r->base.report, v[STAGE_END]->mark, "%s.end is %g s, but the stage begins at %g s", where, stage->end, before);
        stage->end = before + 1.0;
    }
    if (stage->dt > 0.0 && (stage->end - before) / stage->dt > 1e12)
        ab_report_error(r->base.report, v[STAGE_DT]->mark, "%s.dt: %g s up to %g s would take %.3g steps; use a larger dt (abut plan tells the stable limit), or cfl", where, stage->dt, stage->end,
                        (stage->end - before) / stage->dt);
}

static void take_gravity(ab_scene_reader *r, const ab_node *const *v, const char *where, double before, ab_stage_spec *stage) {
    const ab_key *key = ab_section_stage.keys;
    char *word = NULL;
    if (ab_read_word(&r->base, &key[STAGE_GRAVITY], v[STAGE_GRAVITY], where, &word))
        stage->gravity = strcmp(word, "ramp") == 0 ? AB_GRAVITY_RAMP : strcmp(word, "off") == 0 ? AB_GRAVITY_OFF : AB_GRAVITY_KEEP;
    stage->ramp = 0.5 * (stage->end - before);
    if (v[STAGE_RAMP] == NULL || !ab_read_number(&r->base, &key[STAGE_RAMP], v[STAGE_RAMP], where, &stage->ramp)) return;
    if (stage->gravity != AB_GRAVITY_RAMP)
        ab_report_error(r->base.report, v[STAGE_RAMP]->mark, "%s.ramp is of gravity: ramp; leave it out, or write that", where);
    if (stage->ramp > (stage->end - before) * (1.0 + 1e-9))
        ab_report_error(r->base.report, v[STAGE_RAMP]->mark, "%s.ramp is %g s, longer than the stage of %g s", where, stage->ramp,
                        stage->end - before);
}

static void take_name(ab_scene_reader *r, const ab_node *node, const char *where, size_t number, ab_stage_spec *stage) {
    char name[80], path[AB_WHERE];
    snprintf(name, sizeof name, "stage-%zu", number + 1);
    stage->name = node == NULL ? ab_reader_text(&r->base, name) : NULL;
    if (node == NULL) return;
    const char *text = ab_scene_word(r, node, ab_where_join(path, where, "name"), "a name");
    if (text == NULL || !ab_name_ok(&r->base, "stage", text, node->mark)) return;
    for (size_t k = 0; k < number; k++)
        if (r->scene->stages[k].name != NULL && strcmp(r->scene->stages[k].name, text) == 0)
            ab_report_error(r->base.report, node->mark, "%s: there is a stage '%s' already%s", path, text,
                            r->scene->stages[k].made ? ", which initial: {stress: gravity} makes; choose another name" : "");
    stage->name = ab_reader_text(&r->base, text);
}

/* The axis of an axisymmetric scene holds in every stage. */
static void check_axis(ab_scene_reader *r, const ab_node *node, const char *where, ab_stage_spec *stage) {
    const ab_scene *scene = r->scene;
    if (scene->space != AB_SPACE_AXISYMMETRIC || scene->grid_from[0] > 0.0 || stage->side[AB_LEFT] == AB_SIDE_ROLLER) return;
    ab_report_error(r->base.report, node->mark, "%s.left: it is the axis, which holds the radial direction only; leave it out", where);
    stage->side[AB_LEFT] = AB_SIDE_ROLLER;
}

static void take_stage(ab_scene_reader *r, const ab_node *node, size_t number, ab_stage_spec *stage) {
    const ab_stage_spec *prior = number > 0 ? stage - 1 : NULL;
    const ab_scene *scene = r->scene;
    const ab_node *v[STAGE_KEYS];
    char where[AB_WHERE], path[AB_WHERE];
    const double before = prior != NULL ? prior->end : 0.0;
    snprintf(where, sizeof where, "stages[%zu]", number - (scene->stages[0].made ? 1 : 0));
    *stage = (ab_stage_spec){
        .mark = node->mark, .end = before + 1.0, .cfl = 0.25, .local_until = INFINITY, .unbalanced = INFINITY, .at_rest = INFINITY};
    memcpy(stage->side, prior != NULL ? prior->side : scene->side, sizeof stage->side);
    if (!ab_section_open(&r->base, &ab_section_stage, node, where, v)) return;
    const ab_key *key = ab_section_stage.keys;
    char *scheme = NULL;
    take_name(r, v[STAGE_NAME], where, number, stage);
    ab_read_word(&r->base, &key[STAGE_SCHEME], v[STAGE_SCHEME], where, &scheme);
    take_step(r, v, where, stage);
    take_end(r, node, v, where, before, stage);
    take_gravity(r, v, where, before, stage);
    if (v[STAGE_DAMPING] != NULL) take_damping(r, v[STAGE_DAMPING], ab_where_join(path, where, "damping"), stage);
    if (v[STAGE_UNTIL] != NULL) take_until(r, v[STAGE_UNTIL], ab_where_join(path, where, "until"), stage);
    if (v[STAGE_SIDES] != NULL) {
        ab_where_join(path, where, "sides");
        if (scene->grid_cell > 0.0)
            ab_scene_take_sides(r, v[STAGE_SIDES], path, stage->side);
        else
            ab_report_error(r->base.report, v[STAGE_SIDES]->mark, "%s: the scene has no grid; hold finite elements by fix, with stages",
                            path);
        check_axis(r, v[STAGE_SIDES], path, stage);
    }
    stage->zero_displacements = is_word(r, &key[STAGE_DISPLACEMENTS], v[STAGE_DISPLACEMENTS], where, "zero");
    stage->zero_velocities = is_word(r, &key[STAGE_VELOCITIES], v[STAGE_VELOCITIES], where, "zero");
}

/* The stage that is put before the start. Its length is known when the bodies are: core/stages.c. */
static ab_stage_spec settling(ab_scene_reader *r, ab_mark mark) {
    ab_stage_spec stage = {.name = ab_reader_text(&r->base, "gravity"),
                           .mark = mark,
                           .made = true,
                           .cfl = 0.5,
                           .gravity = AB_GRAVITY_RAMP,
                           .local = 0.7,
                           .local_until = INFINITY,
                           .has_until = true,
                           .unbalanced = 1e-4,
                           .at_rest = 1e-4,
                           .zero_displacements = true,
                           .zero_velocities = true};
    memcpy(stage.side, r->scene->side, sizeof stage.side);
    return stage;
}

void ab_scene_take_stages(ab_scene_reader *r, const ab_node *root, const ab_node *time, const ab_node *node) {
    ab_scene *scene = r->scene;
    ab_mark mark = AB_NOWHERE;
    const bool made = asks_for_gravity(root, &mark);
    if (node == NULL && time == NULL)
        ab_report_error(r->base.report, root->mark,
                        "key 'time' is missing in the scene: how long, and in which steps; write time: {end: .., "
                        "cfl: ..}, or stages (docs/stages.md)");
    if (node == NULL && !made) return;
    size_t count = 1;
    if (node != NULL) {
        const ab_node *damping = ab_node_find(root, "damping");
        if (!ab_scene_is_list(r, node, "stages", "entries - {duration: ..., ...}")) return;
        if (node->count == 0) ab_report_error(r->base.report, node->mark, "stages is empty; write at least one, or time");
        if (node->count >= AB_STAGES)
            ab_report_error(r->base.report, node->mark, "stages has %zu entries, more than %d", node->count, AB_STAGES - 1);
        if (node->count == 0 || node->count >= AB_STAGES) return;
        if (time != NULL)
            ab_report_error(r->base.report, time->mark,
                            "time and stages say the same thing twice; keep stages, each with its end and its cfl");
        if (damping != NULL)
            ab_report_error(r->base.report, damping->mark,
                            "damping is that of a scene without stages; write it into the stages: damping: {local: ..}");
        count = node->count;
    }
    scene->stages = ab_reader_take(&r->base, count + made, sizeof *scene->stages);
    if (scene->stages == NULL) return;
    scene->stage_count = count + made;
    if (made) scene->stages[0] = settling(r, mark);
    ab_stage_spec *first = scene->stages + made;
    if (node == NULL) {
        *first = (ab_stage_spec){.name = ab_reader_text(&r->base, "run"),
                                 .mark = scene->mark_time,
                                 .end = scene->time_end,
                                 .dt = scene->time_dt,
                                 .cfl = scene->time_cfl,
                                 .local = scene->damping_local,
                                 .local_until = scene->damping_until,
                                 .unbalanced = INFINITY,
                                 .at_rest = INFINITY};
        memcpy(first->side, scene->side, sizeof first->side);
        return;
    }
    for (size_t k = 0; k < count; k++) take_stage(r, node->items[k], made + k, first + k);
    scene->mark_time = node->mark;
    scene->time_end = first[count - 1].end;
    scene->time_dt = first->dt;
    scene->time_cfl = first->cfl;
    if (made) scene->stages[0].cfl = first->cfl > 0.0 ? first->cfl : scene->stages[0].cfl;
}

uint64_t ab_scene_take_absent(ab_scene_reader *r, const ab_node *node, const char *where) {
    const ab_scene *scene = r->scene;
    uint64_t present = 0;
    const bool list = node->kind == AB_NODE_LIST;
    if (scene->stage_count == 0) {
        ab_report_error(r->base.report, node->mark, "%s: the scene has no stages; write stages: in place of time:, or leave this out",
                        where);
        return 0;
    }
    for (size_t i = 0; i < (list ? node->count : 1); i++) {
        const ab_node *one = list ? node->items[i] : node;
        const char *names[AB_STAGES], *name = ab_scene_word(r, one, where, "the name of a stage or a list of names");
        char tail[AB_TAIL];
        if (name == NULL) return 0;
        bool known = false;
        for (size_t k = 0; k < scene->stage_count; k++) {
            names[k] = scene->stages[k].name != NULL ? scene->stages[k].name : "";
            if (strcmp(names[k], name) == 0) present |= (uint64_t)1 << k, known = true;
        }
        if (!known)
            ab_report_error(r->base.report, one->mark, "%s: there is no stage '%.64s'%s", where, name,
                            ab_suggest_tail(name, names, scene->stage_count, tail, sizeof tail));
    }
    return ~present;
}
