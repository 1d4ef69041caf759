/* plan_text.c: the plan as text, for people. */
#include <math.h>
#include <string.h>

#include "core/plan_lists.h"

static void text_plugin(ab_text *text, size_t number, const char *name, const char *why, const ab_loaded_class *loaded) {
    (void)number;
    ab_text_add(text, "  %s %s %s: %s%s\n    %s\n", ab_plan_kind_name(loaded->class_.kind), name,
                loaded->plugin_version ? loaded->plugin_version : "", why,
                loaded->guarded ? "; every call under guard (checked: true)" : "", loaded->path ? loaded->path : "");
}

static void text_left_out(ab_text *text, size_t number, const char *name, const char *why, const ab_loaded_class *loaded) {
    (void)number;
    (void)loaded;
    ab_text_add(text, "  %-21s %s\n", name, why);
}

static void add_bytes(ab_text *text, size_t bytes) {
    const double kib = (double)bytes / 1024.0;
    if (kib < 1024.0)
        ab_text_add(text, "%.0f KiB", kib);
    else if (kib < 1024.0 * 1024.0)
        ab_text_add(text, "%.1f MiB", kib / 1024.0);
    else
        ab_text_add(text, "%.1f GiB", kib / (1024.0 * 1024.0));
}

static void add_seconds(ab_text *text, double seconds) {
    if (seconds < 120.0)
        ab_text_add(text, "%.2g s", seconds);
    else if (seconds < 7200.0)
        ab_text_add(text, "%.0f min", seconds / 60.0);
    else
        ab_text_add(text, "%.1f h", seconds / 3600.0);
}

void ab_plan_add_text(ab_text *text, const ab_schedule *schedule, const ab_run_options *options, double seconds_per_step) {
    const ab_scene *scene = schedule->scene;
    size_t nodes;
    const ab_plan_body sum = ab_plan_totals_of(schedule, &nodes);
    const char *limit;
    if (scene->title && scene->title[0]) ab_text_add(text, "%s\n\n", scene->title);
    ab_text_add(text, "Bodies\n");
    for (size_t b = 0; b < schedule->body_count; b++) {
        const ab_domain *domain = schedule->domains[b];
        ab_plan_body body;
        domain->ops->plan(schedule->domains[b], &body);
        ab_text_add(text, "  %s: %s, ", scene->bodies[b].name, domain->ops->method);
        if (ab_plan_has_elements(domain)) {
            ab_text_add(text, "%zu nodes in %zu element%s, ", body.points, body.elements, body.elements == 1 ? "" : "s");
        } else if (ab_domain_is_rigid(domain)) {
            ab_text_add(text, "%zu point%s on the outline, ", body.points, body.points == 1 ? "" : "s");
        } else {
            ab_text_add(text, "%zu point%s in %zu cell%s (%zu tile%s), %zu bytes a point, ", body.points, body.points == 1 ? "" : "s",
                        body.cells, body.cells == 1 ? "" : "s", body.tiles, body.tiles == 1 ? "" : "s", body.bytes_per_point);
        }
        if (body.tiles && (ab_plan_has_elements(domain) || ab_domain_is_rigid(domain)))
            ab_text_add(text, "seen on the grid (%zu tiles), ", body.tiles);
        add_bytes(text, body.bytes);
        ab_text_add(text, " in all\n    fields: %s\n    each step: %s\n", body.fields, body.passes);
        char begins[160];
        ab_plan_initial_words(scene->bodies + b, begins, sizeof begins);
        if (begins[0]) ab_text_add(text, "    %s\n", begins);
    }
    if (scene->contact_count) ab_text_add(text, "\nContacts\n");
    for (size_t c = 0; c < scene->contact_count; c++) {
        const ab_contact_spec *contact = &scene->contacts[c];
        char needs[256];
        ab_plan_contact_needs(contact, needs, sizeof needs);
        ab_text_add(text, "  %s and %s: each step: find (%s), respond (%s)%s\n", scene->bodies[contact->body[0]].name,
                    scene->bodies[contact->body[1]].name, contact->finder->class_.name,
                    contact->responder ? contact->responder->class_.name : contact->finder->class_.name,
                    contact->finder->class_.needs & AB_NEED_SHARED_NODES ? ", where their tiles meet" : "");
        if (needs[0]) ab_text_add(text, "    needs: %s\n", needs);
    }
    if (scene->stage_count) ab_text_add(text, "\nStages\n");
    for (size_t k = 0; k < scene->stage_count; k++) {
        char words[256];
        ab_plan_stage_words(scene->stages + k, words, sizeof words);
        ab_text_add(text, "  %s: to t = %g s%s\n", scene->stages[k].name, scene->stages[k].end, words);
    }
    ab_text_add(text, "\nPlugins\n");
    ab_plan_each_plugin(scene, text_plugin, text);
    ab_text_add(text, "\nNot paid for\n");
    ab_plan_each_left_out(schedule, text_left_out, text);
    ab_text_add(text, "\nCost\n  ");
    if (sum.points) ab_text_add(text, "%zu point%s, ", sum.points, sum.points == 1 ? "" : "s");
    if (nodes) ab_text_add(text, "%zu nodes, %zu elements, ", nodes, sum.elements);
    add_bytes(text, sum.bytes);
    ab_text_add(text, ", %d thread%s\n  dt %.4g s; ", options->threads, options->threads == 1 ? "" : "s", schedule->dt);
    if (isfinite(schedule->critical_dt))
        ab_text_add(text, "the stable limit is %.4g s: %s\n", schedule->critical_dt, schedule->limit);
    else
        ab_text_add(text, "there is no stable limit: rigid bodies have no waves\n");
    const double spring = ab_plan_contact_dt(schedule, &limit);
    if (isfinite(spring)) ab_text_add(text, "  contact alone allows %.4g s: %s\n", spring, limit);
    ab_text_add(text, "  %.0f steps", ab_plan_steps_of(schedule));
    if (seconds_per_step > 0.0) {
        ab_text_add(text, ", about ");
        add_seconds(text, seconds_per_step * ab_plan_steps_of(schedule));
    }
    ab_text_add(text, "\n");
    if (schedule->scene->has_checkpoint) {
        ab_text_add(text, "  a checkpoint has at most about ");
        add_bytes(text, sum.bytes);
        ab_text_add(text, "; two are kept\n");
    }
}
