/* summary.c: summary.json: what ran, what it cost, what it conserved, what was expected of it. Numbers that do not exist are null. */
#include <math.h>
#include <stdlib.h>

#include "core/files.h"
#include "core/results_inner.h"

static void key(ab_text *text, const char *name, bool first) { ab_text_add(text, "%s\n  \"%s\": ", first ? "" : ",", name); }

static void number(ab_text *text, const char *before, double value) {
    ab_text_add(text, "%s", before);
    ab_text_add_number(text, value);
}

static void energy(ab_text *text, const ab_energy *e, const ab_scene *scene) {
    ab_text_add(text, "{");
    for (size_t term = 0; term < ab_term_shown(scene); term++) {
        ab_text_add(text, "%s\"%s\": ", term > 0 ? ", " : "", ab_term_name(term));
        ab_text_add_number(text, ab_term_value(e, term));
    }
    ab_text_add(text, "}");
}

static void ledger(ab_text *text, const ab_results *results, const ab_state_view *view) {
    const ab_scene *scene = view->scene;
    const double moved = ab_results_moved(results, view);
    ab_energy start = {0};
    for (size_t b = 0; b < scene->body_count; b++) {
        const ab_energy *e = &results->energy_start[b];
        start.kinetic += e->kinetic, start.strain += e->strain, start.potential += e->potential, start.plastic += e->plastic;
        start.friction += e->friction, start.contact += e->contact, start.boundary += e->boundary, start.damping += e->damping;
        start.external += e->external, start.outflow += e->outflow;
    }
    ab_text_add(text, "{\n    \"unit\": \"J\",\n    \"start\": ");
    energy(text, &start, scene);
    ab_text_add(text, ",\n    \"end\": ");
    energy(text, &view->total, scene);
    number(text, ",\n    \"remainder\": ", view->remainder);
    number(text, ",\n    \"largest_moved\": ", moved);
    number(text, ",\n    \"remainder_relative\": ", ab_results_remainder(results, view));
    ab_text_add(text, ",\n    \"bodies\": {");
    for (size_t b = 0; b < scene->body_count; b++) {
        ab_text_add(text, "%s\n      ", b > 0 ? "," : "");
        ab_text_add_escaped(text, scene->bodies[b].name);
        ab_text_add(text, ": ");
        energy(text, &view->energy[b], scene);
    }
    ab_text_add(text, "}\n  }");
}

static void motion(ab_text *text, const ab_motion *bodies, const ab_scene *scene) {
    double sum[4] = {0};
    for (size_t b = 0; b < scene->body_count; b++) {
        sum[0] += bodies[b].mass;
        sum[1] += bodies[b].momentum[0];
        sum[2] += bodies[b].momentum[1];
        sum[3] += bodies[b].angular_momentum[2];
    }
    number(text, "{\"mass\": ", sum[0]);
    number(text, ", \"momentum\": [", sum[1]);
    number(text, ", ", sum[2]);
    number(text, "], \"angular_momentum\": ", sum[3]);
    ab_text_add(text, "}");
}

/* The last step, and what it came to over the run. */
static void contacts(ab_text *text, const ab_results *results, const ab_state_view *view) {
    const ab_scene *scene = view->scene;
    ab_text_add(text, "[");
    for (size_t k = 0; k < scene->contact_count; k++) {
        const ab_contact_totals *c = &view->contacts[k];
        ab_text_add(text, "%s\n    {\"bodies\": [", k > 0 ? "," : "");
        ab_text_add_escaped(text, scene->bodies[scene->contacts[k].body[0]].name);
        ab_text_add(text, ", ");
        ab_text_add_escaped(text, scene->bodies[scene->contacts[k].body[1]].name);
        const ab_contact_sums *sums = &results->contacts[k];
        const double span = view->time > 0 ? view->time : 1;
        number(text, "], \"impulse\": [", sums->impulse[0]);
        number(text, ", ", sums->impulse[1]);
        number(text, "], \"mean_normal_force\": ", sums->normal / span);
        number(text, ", \"mean_friction_force\": ", sums->friction / span);
        number(text, ", \"peak_normal_force\": ", sums->peak);
        number(text, ", \"deepest_penetration\": ", sums->deepest);
        number(text, ", \"force\": [", c->force[0]);
        number(text, ", ", c->force[1]);
        number(text, "], \"moment\": ", c->moment);
        number(text, ", \"normal_force\": ", c->normal_force);
        number(text, ", \"friction_force\": ", c->friction_force);
        ab_text_add(text, ", \"points\": %zu, \"active\": %zu", c->points, c->active);
        number(text, ", \"penetration\": ", c->penetration);
        number(text, ", \"friction_work\": ", c->friction_work);
        number(text, ", \"contact_work\": ", c->contact_work);
        ab_text_add(text, ", \"failures\": %zu}", c->failures);
    }
    ab_text_add(text, "]");
}

static void expects(ab_text *text, const ab_results *results) {
    const ab_scene *scene = results->scene;
    ab_text_add(text, "[");
    for (size_t e = 0; e < results->expect_count; e++) {
        const ab_expect_spec *spec = results->expects[e].spec;
        const ab_outcome outcome = ab_expect_end(&results->expects[e]);
        ab_text_add(text, "%s\n    {\"name\": ", e > 0 ? "," : "");
        ab_text_add_escaped(text, spec->name);
        ab_text_add(text, ", \"%s\": ", spec->monitor != SIZE_MAX ? "monitor" : "column");
        ab_text_add_escaped(text, spec->monitor != SIZE_MAX ? scene->monitors[spec->monitor].name : spec->column);
        ab_text_add(text, ", \"norm\": ");
        ab_text_add_escaped(text, spec->norm != NULL ? spec->norm : "final");
        number(text, ", \"value\": ", outcome.value);
        number(text, ", \"reference\": ", outcome.reference);
        number(text, ", \"error\": ", outcome.error);
        number(text, ", \"tolerance\": ", outcome.tolerance);
        ab_text_add(text, ", \"pass\": %s", outcome.pass ? "true" : "false");
        if (!isfinite(outcome.error))
            ab_text_add(text, ", \"text\": \"%s\"", results->expects[e].samples == 0 ? "no sample in the window" : "not a number");
        ab_text_add(text, "}");
    }
    ab_text_add(text, "]");
}

static void columns(ab_text *text, const ab_results *results) {
    const ab_scene *scene = results->scene;
    char name[320];
    ab_text_add(text, "[");
    for (size_t c = 0; c < ab_column_count(scene); c++) {
        ab_column_name(scene, c, name, sizeof name);
        ab_text_add(text, "%s\n    {\"name\": ", c > 0 ? "," : "");
        ab_text_add_escaped(text, name);
        ab_text_add(text, ", \"unit\": \"%s\"}", ab_column_unit(scene, c));
    }
    for (size_t m = 0; m < scene->monitor_count; m++) {
        ab_text_add(text, ",\n    {\"name\": ");
        ab_text_add_escaped(text, scene->monitors[m].name);
        ab_text_add(text, ", \"value\": ");
        ab_text_add_escaped(text, scene->monitors[m].value);
        ab_text_add(text, ", \"unit\": ");
        ab_text_add_escaped(text, ab_monitor_unit(results->monitors, m));
        ab_text_add(text, "}");
    }
    ab_text_add(text, "]");
}

static void cost(ab_text *text, const ab_run_facts *facts) {
    number(text, ",\n  \"wall_seconds\": ", facts->wall_seconds);
    number(text, ",\n  \"cpu_seconds\": ", facts->cpu_seconds);
    ab_text_add(text, ",\n  \"steps\": %ld,\n  \"points\": %zu,\n  \"nodes\": %zu,\n  \"elements\": %zu,\n  \"rigid_bodies\": %zu",
                facts->steps, facts->points, facts->nodes, facts->elements, facts->rigid);
    number(text, ",\n  \"point_steps_per_second\": ", facts->point_steps_per_second);
    number(text, ",\n  \"element_steps_per_second\": ", facts->element_steps_per_second);
    ab_text_add(text, ",\n  \"peak_bytes\": %zu,\n  \"bytes_per_point\": %zu,\n  \"threads\": %d", facts->peak_bytes,
                facts->bytes_per_point, facts->threads);
    ab_text_add(text, ",\n  \"phase_seconds\": {");
    for (int phase = 0, shown = 0; phase < 8; phase++) {
        if (facts->phase_names[phase] == NULL) continue;
        ab_text_add(text, "%s", shown++ > 0 ? ", " : "");
        ab_text_add_escaped(text, facts->phase_names[phase]);
        number(text, ": ", facts->phase_seconds[phase]);
    }
    ab_text_add(text, "}");
}

ab_status ab_summary_write(const ab_results *results, const ab_state_view *view, const ab_run_facts *facts, ab_report *report) {
    const ab_scene *scene = results->scene;
    ab_text text = {0};
    ab_text_add(&text, "{");
    key(&text, "version", true);
    ab_text_add_escaped(&text, facts->version);
    key(&text, "scene", false);
    ab_text_add_escaped(&text, scene->path);
    key(&text, "title", false);
    ab_text_add_escaped(&text, scene->title);
    key(&text, "outcome", false);
    ab_text_add_escaped(&text, facts->outcome);
    key(&text, "plan", false);
    ab_text_add(&text, "%s", facts->plan_json != NULL ? facts->plan_json : "null");
    cost(&text, facts);
    key(&text, "time", false);
    ab_text_add_number(&text, view->time);
    key(&text, "dt", false);
    number(&text, "{\"value\": ", view->dt);
    ab_text_add(&text, ", \"limit\": ");
    ab_text_add_escaped(&text, view->limit);
    ab_text_add(&text, "}");
    if (scene->stage_count > 0) {
        key(&text, "stage", false);
        ab_text_add_escaped(&text, scene->stages[view->stage].name);
    }
    key(&text, "frames", false);
    ab_text_add(&text, "%zu", ab_frames_count(results->frames));
    key(&text, "ledger", false);
    ledger(&text, results, view);
    key(&text, "motion", false);
    ab_text_add(&text, "{\n    \"start\": ");
    motion(&text, results->motion_start, scene);
    ab_text_add(&text, ",\n    \"end\": ");
    motion(&text, view->motion, scene);
    ab_text_add(&text, "\n  }");
    key(&text, "contacts", false);
    contacts(&text, results, view);
    key(&text, "expects", false);
    expects(&text, results);
    key(&text, "columns", false);
    columns(&text, results);
    ab_text_add(&text, "\n}\n");
    return ab_text_write(&text, results->folder, "summary.json", report);
}
