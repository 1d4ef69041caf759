/* scene_setup.c: constants, damping, time, history and output of a scene. */
#include <math.h>
#include <string.h>

#include "core/scene_reader.h"
#include "core/suggest.h"

static void take_constant(ab_scene_reader *r, const ab_entry *entry) {
    char why[1200], path[AB_WHERE];
    ab_where_join(path, "constants", entry->key);
    if (!ab_formulas_name_ok(r->base.formulas, entry->key, why, sizeof why)) {
        ab_report_error(r->base.report, entry->mark, "%s: %s", path, why);
        return;
    }
    const char *text = ab_scene_word(r, entry->value, path, "a number");
    ab_number number = {0, NULL, entry->value->mark};
    if (text != NULL) {
        const ab_status status = ab_quantity_read(r->base.formulas, r->base.units, text, NULL, AB_NO_VARIABLE, &number, why, sizeof why);
        if (status == AB_FAILED) r->base.out_of_memory = true;
        if (status != AB_OK) {
            ab_report_error(r->base.report, entry->value->mark, "%s: %s", path, why);
            number.value = 1;
        }
    }
    /* known by name even when its value is wrong, so that one mistake is not said again wherever it is used */
    if (ab_formulas_define(r->base.formulas, entry->key, number.value) != AB_OK)
        ab_report_error(r->base.report, entry->mark, "%s: cannot be the name of a constant", path);
}

void ab_scene_take_constants(ab_scene_reader *r, const ab_node *node) {
    if (node == NULL) return;
    if (node->kind != AB_NODE_MAP) {
        ab_report_error(r->base.report, node->mark, "constants must be a mapping {name: number, ...}, not %s", ab_node_kind_name(node));
        return;
    }
    for (size_t i = 0; i < node->count; i++) {
        const ab_entry *entry = &node->entries[i];
        if (entry->mark.file != NULL && entry->mark.file != r->scene->path && !node->override_) {
            const char *names[AB_DOCUMENT_KEYS];
            for (size_t k = 0; k < i; k++) names[k] = node->entries[k].key;
            char tail[AB_TAIL];
            ab_report_warning(r->base.report, entry->mark, "constants.%.64s is not in the file; only another --set can use it%s",
                              entry->key, ab_suggest_tail(entry->key, names, i, tail, sizeof tail));
        }
        take_constant(r, entry);
    }
}

void ab_scene_take_damping(ab_scene_reader *r, const ab_node *node) {
    if (node == NULL) return;
    const ab_node *v[DAMPING_KEYS];
    if (!ab_section_open(&r->base, &ab_section_damping, node, "damping", v)) return;
    ab_read_number(&r->base, &ab_section_damping.keys[DAMPING_LOCAL], v[DAMPING_LOCAL], "damping", &r->scene->damping_local);
    ab_read_number(&r->base, &ab_section_damping.keys[DAMPING_UNTIL], v[DAMPING_UNTIL], "damping", &r->scene->damping_until);
}

void ab_scene_take_watchdog(ab_scene_reader *r, const ab_node *node) {
    if (node == NULL) return;
    const ab_node *v[WATCHDOG_KEYS];
    if (!ab_section_open(&r->base, &ab_section_watchdog, node, "watchdog", v)) return;
    ab_read_number(&r->base, &ab_section_watchdog.keys[WATCHDOG_ENERGY], v[WATCHDOG_ENERGY], "watchdog", &r->scene->watch_energy);
    ab_read_flag(&r->base, &ab_section_watchdog.keys[WATCHDOG_STOP], v[WATCHDOG_STOP], "watchdog", &r->scene->watch);
}

void ab_scene_take_time(ab_scene_reader *r, const ab_node *node) {
    if (node == NULL) return;
    ab_scene *scene = r->scene;
    const ab_node *v[TIME_KEYS];
    scene->mark_time = node->mark;
    if (!ab_section_open(&r->base, &ab_section_time, node, "time", v)) return;
    const ab_key *key = ab_section_time.keys;
    if (v[TIME_DT] != NULL && v[TIME_CFL] != NULL) {
        if (v[TIME_DT]->override_ == v[TIME_CFL]->override_)
            ab_report_error(r->base.report, v[TIME_CFL]->mark,
                            "time has both dt and cfl; keep one: dt is a fixed step, cfl a part of the critical one");
        else /* what --set says takes the place of the other */
            v[v[TIME_DT]->override_ ? TIME_CFL : TIME_DT] = NULL;
    }
    r->end_by_set = v[TIME_END] != NULL && v[TIME_END]->override_;
    ab_read_number(&r->base, &key[TIME_END], v[TIME_END], "time", &scene->time_end);
    if (v[TIME_DT] != NULL) {
        scene->time_cfl = 0;
        ab_read_number(&r->base, &key[TIME_DT], v[TIME_DT], "time", &scene->time_dt);
        if (scene->time_end > 0 && scene->time_dt > scene->time_end)
            ab_report_warning(r->base.report, v[TIME_DT]->mark, "time.dt %g s is longer than the whole run of %g s", scene->time_dt,
                              scene->time_end);
        if (scene->time_dt > 0 && scene->time_end / scene->time_dt > 1e12)
            ab_report_error(r->base.report, v[TIME_DT]->mark, "time.dt: %g s up to %g s would take %.3g steps; use a larger dt (abut plan tells the stable limit), or cfl", scene->time_dt,
                            scene->time_end, scene->time_end / scene->time_dt);
    } else {
        ab_read_number(&r->base, &key[TIME_CFL], v[TIME_CFL], "time", &scene->time_cfl);
        if (scene->time_cfl > 1)
            ab_report_warning(r->base.report, v[TIME_CFL]->mark, "time.cfl %g is above 1, the limit of stability", scene->time_cfl);
    }
}

void ab_scene_take_history(ab_scene_reader *r, const ab_node *node) {
    if (node == NULL) return;
    const ab_node *v[HISTORY_KEYS];
    if (!ab_section_open(&r->base, &ab_section_history, node, "history", v)) return;
    ab_read_integer(&r->base, &ab_section_history.keys[HISTORY_EVERY], v[HISTORY_EVERY], "history", &r->scene->history_every);
}

void ab_scene_take_checkpoint(ab_scene_reader *r, const ab_node *node) {
    if (node == NULL) return;
    ab_scene *scene = r->scene;
    const ab_key *key = ab_section_checkpoint.keys;
    const ab_node *v[CHECKPOINT_KEYS];
    if (!ab_section_open(&r->base, &ab_section_checkpoint, node, "checkpoint", v)) return;
    scene->has_checkpoint = true;
    if (v[CHECKPOINT_EVERY] == NULL && v[CHECKPOINT_STEPS] == NULL && v[CHECKPOINT_WALL] == NULL)
        ab_report_error(r->base.report, node->mark, "checkpoint: write every (s), steps or wall (minutes), or leave the key out");
    ab_read_number(&r->base, &key[CHECKPOINT_EVERY], v[CHECKPOINT_EVERY], "checkpoint", &scene->checkpoint_every);
    ab_read_integer(&r->base, &key[CHECKPOINT_STEPS], v[CHECKPOINT_STEPS], "checkpoint", &scene->checkpoint_steps);
    ab_read_number(&r->base, &key[CHECKPOINT_WALL], v[CHECKPOINT_WALL], "checkpoint", &scene->checkpoint_wall);
    scene->checkpoint_wall *= 60.0;
}

enum { MOST_FIELDS = 64 };

static bool field_known(ab_scene_reader *r, const ab_node *node, const char *where) {
    enum { MOST = 256 };
    if (ab_words_find(&ab_words_fields, node->text) != NULL || strcmp(node->text, "position") == 0 ||
        ab_scene_state_named(r->scene, SIZE_MAX, node->text) != NULL)
        return true;
    const char *names[MOST];
    size_t count = 0;
    for (size_t i = 0; i < ab_words_fields.count; i++) names[count++] = ab_words_fields.word[i].name;
    for (size_t m = 0; m < r->scene->material_count; m++) {
        const ab_loaded_class *model = r->scene->materials[m].loaded;
        for (uint32_t s = 0; model != NULL && s < model->class_.nstate && count < MOST; s++) names[count++] = model->class_.state[s].name;
    }
    char tail[AB_TAIL];
    ab_report_error(r->base.report, node->mark, "%s: unknown field '%.64s'%s", where, node->text,
                    ab_suggest_tail(node->text, names, count, tail, sizeof tail));
    return false;
}

static void take_fields(ab_scene_reader *r, const ab_node *node) {
    ab_scene *scene = r->scene;
    if (!ab_scene_is_list(r, node, "output.fields", "field names")) return;
    if (node->count > MOST_FIELDS) {
        ab_report_error(r->base.report, node->mark, "output.fields has %zu names, more than %d", node->count, MOST_FIELDS);
        return;
    }
    scene->output_fields = ab_reader_take(&r->base, node->count, sizeof *scene->output_fields);
    if (scene->output_fields == NULL) return;
    for (size_t i = 0; i < node->count; i++) {
        char where[AB_WHERE];
        snprintf(where, sizeof where, "output.fields[%zu]", i);
        const char *name = ab_scene_word(r, node->items[i], where, "the name of a field");
        if (name == NULL || !field_known(r, node->items[i], where)) continue;
        bool twice = false;
        for (size_t k = 0; k < scene->output_field_count; k++) twice = twice || strcmp(scene->output_fields[k], name) == 0;
        if (twice) {
            ab_report_error(r->base.report, node->items[i]->mark, "%s: field '%.64s' stands twice", where, name);
        } else if (strcmp(name, "position") != 0) { /* always written */
            scene->output_fields[scene->output_field_count] = ab_reader_text(&r->base, name);
            if (scene->output_fields[scene->output_field_count] != NULL) scene->output_field_count++;
        }
    }
}

void ab_scene_take_output(ab_scene_reader *r, const ab_node *node) {
    if (node == NULL) return;
    const ab_node *v[OUTPUT_KEYS];
    r->scene->has_output = true;
    if (!ab_section_open(&r->base, &ab_section_output, node, "output", v)) return;
    ab_read_number(&r->base, &ab_section_output.keys[OUTPUT_EVERY], v[OUTPUT_EVERY], "output", &r->scene->output_every);
    ab_read_flag(&r->base, &ab_section_output.keys[OUTPUT_CONTACT], v[OUTPUT_CONTACT], "output", &r->scene->output_contact);
    if (r->scene->output_contact && r->scene->contact_count == 0)
        ab_report_error(r->base.report, v[OUTPUT_CONTACT]->mark, "output.contact: the scene has no contact; leave it out");
    if (v[OUTPUT_FIELDS] != NULL) take_fields(r, v[OUTPUT_FIELDS]);
}
