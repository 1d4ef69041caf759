/* plan.c: what a scene needs, said before it runs, and what it will not pay for. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/scheduler.h"

enum { TRIAL_STEPS = 5 };

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

typedef struct plan_facts {
    const ab_scene *scene;
    ab_plan_body *bodies;
    size_t points, bytes;
    double dt, critical, steps, seconds;
    const char *limit;
} plan_facts;

static void text(FILE *s, const char *t)
{
    fputc('"', s);
    for (; *t; ++t) {
        if (*t == '"' || *t == '\\') fprintf(s, "\\%c", *t);
        else if ((unsigned char)*t < 0x20) fprintf(s, "\\u%04x", (unsigned char)*t);
        else fputc(*t, s);
    }
    fputc('"', s);
}

/* "a, b, c" as a list of texts. */
static void list(FILE *s, const char *words)
{
    fputc('[', s);
    while (*words) {
        const char *end = strstr(words, ", ");
        const size_t n = end ? (size_t)(end - words) : strlen(words);
        fprintf(s, "\"%.*s\"%s", (int)n, words, end ? ", " : "");
        words += n + (end ? 2 : 0);
    }
    fputc(']', s);
}

static bool material_keeps_state(const ab_scene *scene)
{
    for (size_t b = 0; b < scene->body_count; ++b)
        if (scene->materials[scene->bodies[b].material].loaded->class_.nstate) return true;
    return false;
}

/* What this scene does not pay for; one line each. Returns how many. */
static size_t unpaid(const ab_scene *scene, const char *lines[8])
{
    size_t n = 0;
    if (!scene->contact_count) lines[n++] = "no contact: no search, no contact plugin loaded, no sizes of points kept for gaps";
    lines[n++] = "no boundary plugin: no boundary pass";
    if (!material_keeps_state(scene)) lines[n++] = "no material keeps state: no state arrays";
    if (!scene->load_count) lines[n++] = "no tractions: no pass over loaded points";
    if (!(scene->damping_local > 0.0)) lines[n++] = "no damping: no damping forces kept";
    lines[n++] = "plane strain: no third component of velocity, two shear stresses fewer";
    lines[n++] = "empty grid: tiles stand only where material is";
    if (!scene->output_field_count) lines[n++] = "no output fields asked for: frames hold positions only";
    return n;
}

static void print_json(const plan_facts *f, FILE *s)
{
    const ab_scene *scene = f->scene;
    fprintf(s, "{\n  \"scene\": "), text(s, scene->path);
    fprintf(s, ",\n  \"bodies\": [");
    for (size_t b = 0; b < scene->body_count; ++b) {
        const ab_plan_body *p = f->bodies + b;
        fprintf(s, "%s\n    {\"name\": ", b ? "," : ""), text(s, scene->bodies[b].name);
        fprintf(s, ", \"points\": %zu, \"cells\": %zu, \"tiles\": %zu, \"bytes\": %zu, \"bytes_per_point\": %zu, \"fields\": ", p->points, p->cells, p->tiles, p->bytes, p->bytes_per_point);
        list(s, p->fields);
        fprintf(s, ", \"passes\": "), list(s, p->passes), fprintf(s, "}");
    }
    fprintf(s, "\n  ],\n  \"contact_passes\": %zu,\n  \"boundary_passes\": 0,\n  \"plugins\": [", scene->contact_count);
    const char *comma = "";
    for (size_t m = 0; m < scene->material_count; ++m, comma = ",") {
        fprintf(s, "%s\n    {\"kind\": \"material\", \"name\": ", comma), text(s, scene->materials[m].loaded->class_.name);
        fprintf(s, ", \"for\": "), text(s, scene->materials[m].name), fprintf(s, ", \"file\": "), text(s, scene->materials[m].loaded->path), fprintf(s, "}");
    }
    for (size_t c = 0; c < scene->contact_count; ++c) {
        const ab_loaded_class *both[2] = {scene->contacts[c].finder, scene->contacts[c].responder};
        for (int k = 0; k < 2; ++k, comma = ",") {
            fprintf(s, "%s\n    {\"kind\": \"contact\", \"name\": ", comma), text(s, both[k]->class_.name);
            fprintf(s, ", \"for\": \"contact[%zu] %s\", \"file\": ", c, k ? "response" : "algorithm"), text(s, both[k]->path), fprintf(s, "}");
        }
    }
    fprintf(s, "\n  ],\n  \"points\": %zu,\n  \"bytes\": %zu,\n  \"dt\": %.17g,\n  \"critical_dt\": %.17g,\n  \"limit\": ", f->points, f->bytes, f->dt, f->critical), text(s, f->limit);
    fprintf(s, ",\n  \"steps\": %.0f,\n  \"estimated_seconds\": %.6g,\n  \"not_paid_for\": [", f->steps, f->seconds);
    const char *lines[8];
    const size_t n = unpaid(scene, lines);
    for (size_t k = 0; k < n; ++k) fprintf(s, "%s\n    ", k ? "," : ""), text(s, lines[k]);
    fprintf(s, "\n  ]\n}\n");
}

static void print_text(const plan_facts *f, FILE *s)
{
    const ab_scene *scene = f->scene;
    fprintf(s, "%s\n", scene->title && scene->title[0] ? scene->title : scene->path);
    for (size_t b = 0; b < scene->body_count; ++b) {
        const ab_plan_body *p = f->bodies + b;
        const ab_material_spec *m = scene->materials + scene->bodies[b].material;
        fprintf(s, "\nbody '%s': %s, %zu points in %zu cells (%zu tiles of %d x %d nodes), %.3g MB, %zu bytes a point\n", scene->bodies[b].name, scene->bodies[b].method, p->points, p->cells,
                p->tiles, AB_TILE, AB_TILE, 1e-6 * (double)p->bytes, p->bytes_per_point);
        fprintf(s, "  fields: %s\n  passes: %s\n", p->fields, p->passes);
        fprintf(s, "  plugin: material '%s' (%s), because body '%s' is made of '%s'\n          %s\n", m->loaded->class_.name, m->loaded->plugin_version, scene->bodies[b].name, m->name,
                m->loaded->path);
    }
    for (size_t c = 0; c < scene->contact_count; ++c) {
        const ab_contact_spec *k = scene->contacts + c;
        fprintf(s, "\ncontact[%zu]: '%s' and '%s', only while tiles of both overlap\n", c, scene->bodies[k->body[0]].name, scene->bodies[k->body[1]].name);
        fprintf(s, "  plugin: contact '%s' (%s) finds points\n          %s\n", k->finder->class_.name, k->finder->plugin_version, k->finder->path);
        fprintf(s, "  plugin: contact '%s' (%s) answers them\n          %s\n", k->responder->class_.name, k->responder->plugin_version, k->responder->path);
    }
    fprintf(s, "\n%zu points, %.3g MB\n", f->points, 1e-6 * (double)f->bytes);
    fprintf(s, "dt %.6g s (%.3g of the critical %.6g s: %s)\n", f->dt, f->dt / f->critical, f->critical, f->limit);
    fprintf(s, "%.0f steps to t = %.6g s; about %.3g s of computing, from %d steps just made\n\nnot paid for:\n", f->steps, scene->time_end, f->seconds, TRIAL_STEPS);
    const char *lines[8];
    const size_t n = unpaid(scene, lines);
    for (size_t k = 0; k < n; ++k) fprintf(s, "  %s\n", lines[k]);
}

ab_status ab_plan_print(const ab_scene *scene, const ab_run_options *options, bool json, FILE *stream, ab_report *report)
{
    ab_schedule *schedule = NULL;
    AB_TRY(ab_schedule_create(scene, options, &schedule, report));
    plan_facts f = {.scene = scene, .bodies = calloc(scene->body_count + 1, sizeof *f.bodies)};
    if (!f.bodies) {
        ab_schedule_destroy(schedule);
        return ab_report_failure(report, "no memory for the plan");
    }
    for (size_t b = 0; b < scene->body_count; ++b) {
        schedule->domains[b]->ops->plan(schedule->domains[b], f.bodies + b);
        f.points += f.bodies[b].points;
        f.bytes += f.bodies[b].bytes;
    }
    ab_status status = AB_OK;
    double begin = now(), first = 0.0;
    int made = 0;
    for (; status == AB_OK && made < TRIAL_STEPS && schedule->time < scene->time_end; ++made) {
        status = ab_schedule_step(schedule, report);
        if (made == 0) { /* the first step sets out from nothing: not typical */
            first = now() - begin;
            f.dt = schedule->dt;
            f.critical = schedule->critical_dt;
            f.limit = schedule->limit;
            begin = now();
        }
    }
    const double per_step = made > 1 ? (now() - begin) / (made - 1) : first;
    f.steps = f.dt > 0.0 ? ceil(scene->time_end / f.dt - 1e-9) : 0.0;
    f.seconds = per_step * f.steps;
    if (!f.limit) f.limit = "";
    if (status == AB_OK) {
        if (json) print_json(&f, stream);
        else print_text(&f, stream);
    }
    free(f.bodies);
    ab_schedule_destroy(schedule);
    return status;
}
