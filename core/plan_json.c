/* plan_json.c: the plan as JSON. */
#include <math.h>
#include <string.h>

#include "core/plan_lists.h"

static void add_string(ab_text *text, const char *before, const char *string) {
    ab_text_add(text, "%s", before);
    ab_text_add_escaped(text, string);
}

static void add_number(ab_text *text, const char *before, double value) {
    ab_text_add(text, "%s", before);
    ab_text_add_number(text, value);
}

/* "a, b, c" as a list of strings. */
static void add_words(ab_text *text, const char *before, const char *words) {
    ab_text_add(text, "%s[", before);
    for (const char *word = words; *word;) {
        const char *comma = strstr(word, ", ");
        const int length = comma ? (int)(comma - word) : (int)strlen(word);
        char one[512];
        snprintf(one, sizeof one, "%.*s", length, word);
        add_string(text, word == words ? "" : ", ", one);
        word += comma ? length + 2 : length;
    }
    ab_text_add(text, "]");
}

static void json_plugin(ab_text *text, size_t number, const char *name, const char *why, const ab_loaded_class *loaded) {
    add_string(text, number ? ",\n    {\"name\": " : "\n    {\"name\": ", name);
    add_string(text, ", \"kind\": ", ab_plan_kind_name(loaded->class_.kind));
    add_string(text, ", \"for\": ", why);
    add_string(text, ", \"file\": ", loaded->path ? loaded->path : "");
    add_string(text, ", \"version\": ", loaded->plugin_version ? loaded->plugin_version : "");
    ab_text_add(text, "}");
}

static void json_left_out(ab_text *text, size_t number, const char *name, const char *why, const ab_loaded_class *loaded) {
    (void)loaded;
    char line[512];
    snprintf(line, sizeof line, "%s: %s", name, why);
    add_string(text, number ? ",\n    " : "\n    ", line);
}

void ab_plan_add_json(ab_text *text, const ab_schedule *schedule, const ab_run_options *options, double seconds_per_step) {
    const ab_scene *scene = schedule->scene;
    size_t nodes;
    const ab_plan_body sum = ab_plan_totals_of(schedule, &nodes);
    const char *limit;
    add_string(text, "{\n  \"scene\": ", scene->path);
    ab_text_add(text, ",\n  \"bodies\": [");
    for (size_t b = 0; b < schedule->body_count; b++) {
        const ab_domain *domain = schedule->domains[b];
        ab_plan_body body;
        domain->ops->plan(schedule->domains[b], &body);
        add_string(text, b ? ",\n    {\"name\": " : "\n    {\"name\": ", scene->bodies[b].name);
        add_string(text, ", \"method\": ", domain->ops->method);
        if (ab_plan_has_elements(domain))
            ab_text_add(text, ", \"nodes\": %zu, \"elements\": %zu", body.points, body.elements);
        else
            ab_text_add(text, ", \"points\": %zu", body.points);
        ab_text_add(text, ", \"cells\": %zu, \"tiles\": %zu, \"bytes\": %zu", body.cells, body.tiles, body.bytes);
        if (!ab_plan_has_elements(domain)) ab_text_add(text, ", \"bytes_per_point\": %zu", body.bytes_per_point);
        add_words(text, ", \"fields\": ", body.fields);
        add_words(text, ", \"passes\": ", body.passes);
        ab_text_add(text, "}");
    }
    if (scene->stage_count) ab_text_add(text, "],\n  \"stages\": [");
    for (size_t k = 0; k < scene->stage_count; k++) {
        const ab_stage_spec *stage = scene->stages + k;
        char words[256];
        ab_plan_stage_words(stage, words, sizeof words);
        add_string(text, k ? ",\n    {\"name\": " : "\n    {\"name\": ", stage->name);
        add_number(text, ", \"end\": ", stage->end);
        add_words(text, ", \"does\": ", words[0] ? words + 2 : "");
        ab_text_add(text, "}");
    }
    ab_text_add(text, "],\n  \"contacts\": [");
    for (size_t c = 0; c < scene->contact_count; c++) {
        const ab_contact_spec *contact = &scene->contacts[c];
        add_string(text, c ? ",\n    {\"bodies\": [" : "\n    {\"bodies\": [", scene->bodies[contact->body[0]].name);
        add_string(text, ", ", scene->bodies[contact->body[1]].name);
        add_string(text, "], \"algorithm\": ", contact->finder->class_.name);
        add_string(text, ", \"response\": ", contact->responder ? contact->responder->class_.name : contact->finder->class_.name);
        char needs[256];
        ab_plan_contact_needs(contact, needs, sizeof needs);
        add_words(text, ", \"needs\": ", needs);
        ab_text_add(text, ", \"passes\": [\"find\", \"respond\"]}");
    }
    ab_text_add(text, "],\n  \"contact_passes\": %zu,\n  \"boundary_passes\": %zu,\n  \"plugins\": [", scene->contact_count,
                scene->boundary_count);
    ab_plan_each_plugin(scene, json_plugin, text);
    ab_text_add(text, "],\n  \"not_paid_for\": [");
    ab_plan_each_left_out(schedule, json_left_out, text);
    ab_text_add(text,
                "],\n  \"points\": %zu, \"nodes\": %zu, \"elements\": %zu, \"cells\": %zu, \"tiles\": %zu, \"bytes\": %zu, \"threads\": %d",
                sum.points, nodes, sum.elements, sum.cells, sum.tiles, sum.bytes, options->threads);
    add_number(text, ",\n  \"dt\": ", schedule->dt);
    add_number(text, ", \"critical_dt\": ", schedule->critical_dt);
    add_string(text, ", \"limit\": ", schedule->limit);
    add_number(text, ", \"contact_critical_dt\": ", ab_plan_contact_dt(schedule, &limit)); /* null: none of its own, or not in touch yet */
    add_number(text, ",\n  \"steps\": ", ab_plan_steps_of(schedule));
    add_number(text, ", \"estimated_seconds\": ", seconds_per_step > 0.0 ? seconds_per_step * ab_plan_steps_of(schedule) : NAN);
    ab_text_add(text, "\n}");
}
