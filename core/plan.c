/* plan.c: writes the plan as JSON and as text. Both go over the same four lists: bodies, contacts, plugins, and what is left out. */
#define _GNU_SOURCE
#include "core/plan.h"

#include <math.h>
#include <string.h>
#include <time.h>

#include "core/doubts.h"

/* ---- the lists ------------------------------------------------------------------------------------------------------------------- */

/* Receives one item of a list: a name and what there is to say of it. */
typedef void (*item)(ab_text *text, size_t number, const char *name, const char *what, const ab_loaded_class *loaded);

static const char *kind_name(uint32_t kind) { return kind == AB_MATERIAL ? "material" : kind == AB_BOUNDARY ? "boundary" : "contact"; }

/* Boundary plugins in use. */
static void each_boundary_plugin(const ab_scene *scene, item tell, ab_text *text, size_t *number) {
    char why[256];
    for (size_t k = 0; k < scene->boundary_count; k++) {
        const ab_boundary_spec *boundary = &scene->boundaries[k];
        bool known = false;
        for (size_t i = 0; i < k; i++) known = known || scene->boundaries[i].loaded == boundary->loaded;
        if (known) continue;
        snprintf(why, sizeof why, "boundary of body '%s'", scene->bodies[boundary->body].name);
        tell(text, (*number)++, boundary->loaded->class_.name, why, boundary->loaded);
    }
}

/* Each plugin class in use once, with the first reason for it. */
static void each_plugin(const ab_scene *scene, item tell, ab_text *text) {
    size_t number = 0;
    char why[256];
    for (size_t m = 0; m < scene->material_count; m++) {
        const ab_material_spec *material = &scene->materials[m];
        bool known = false;
        for (size_t k = 0; k < m; k++) known = known || scene->materials[k].loaded == material->loaded;
        if (known) continue;
        const char *body = NULL;
        for (size_t b = 0; !body && b < scene->body_count; b++)
            if (scene->bodies[b].material < scene->material_count && scene->materials[scene->bodies[b].material].loaded == material->loaded)
                body = scene->bodies[b].name;
        snprintf(why, sizeof why, body ? "material of body '%s'" : "material '%s', which no body has", body ? body : material->name);
        tell(text, number++, material->loaded->class_.name, why, material->loaded);
    }
    for (size_t c = 0; c < 2 * scene->contact_count; c++) {
        const ab_contact_spec *contact = &scene->contacts[c / 2];
        const ab_loaded_class *loaded = c % 2 ? contact->responder : contact->finder;
        bool known = !loaded;
        for (size_t k = 0; k < c; k++)
            known = known || loaded == (k % 2 ? scene->contacts[k / 2].responder : scene->contacts[k / 2].finder);
        if (known) continue;
        snprintf(why, sizeof why, "%s of '%s' and '%s'", c % 2 ? "response to contact" : "finds the contact",
                 scene->bodies[contact->body[0]].name, scene->bodies[contact->body[1]].name);
        tell(text, number++, loaded->class_.name, why, loaded);
    }
    each_boundary_plugin(scene, tell, text, &number);
}

/* What a class of contact looks at: for finders what they see of a body, for responses what they are told of a contact point. */
static const struct {
    uint32_t need;
    const char *name;
} CONTACT_NEEDS[] = {{AB_NEED_SHARED_NODES, "nodes of the grid that both have mass at"},
                     {AB_NEED_MASS_GRADIENT, "mass gradients"},
                     {AB_NEED_AREA_VECTOR, "area vectors"},
                     {AB_NEED_NEAR_POINTS, "points near them"},
                     {AB_NEED_SURFACE, "points and faces of the outlines"},
                     {AB_NEED_DISTANCE, "distances from the stiffer body"},
                     {AB_NEED_DENSITY_GRADIENT, "density gradients"},
                     {AB_NEED_NEAREST_FACE, "nearest faces"},
                     {AB_NEED_AREA, "length of the face"}};
enum { CONTACT_NEED_COUNT = sizeof CONTACT_NEEDS / sizeof *CONTACT_NEEDS };

/* "a, b, c" of what a contact's finder and response need. */
static void contact_needs(const ab_contact_spec *contact, char *words, size_t size) {
    const uint32_t needs = ab_contact_needs(contact) | (contact->responder ? ab_response_needs(contact) : 0);
    words[0] = '\0';
    for (size_t k = 0; k < CONTACT_NEED_COUNT; k++) {
        const size_t used = strlen(words);
        if (needs & CONTACT_NEEDS[k].need) snprintf(words + used, size - used, "%s%s", used ? ", " : "", CONTACT_NEEDS[k].name);
    }
}

/* Whether a contact of body b (of any body: SIZE_MAX) needs that. */
static bool contact_asks(const ab_scene *scene, size_t b, uint32_t need) {
    for (size_t c = 0; c < scene->contact_count; c++) {
        const ab_contact_spec *contact = &scene->contacts[c];
        if ((b == SIZE_MAX || contact->body[0] == b || contact->body[1] == b) && contact->finder->class_.needs & need) return true;
    }
    return false;
}

static bool has_elements(const ab_domain *domain) { return domain->ops->cells != NULL; }

/* What a body might cost and does not. */
static void each_left_out_of_body(const ab_schedule *schedule, size_t b, item tell, ab_text *text, size_t *number) {
    const ab_scene *scene = schedule->scene;
    const ab_domain *domain = schedule->domains[b];
    const char *name = scene->bodies[b].name;
    char what[256];
    if (ab_domain_is_rigid(domain)) {
        snprintf(what, sizeof what, "'%s' is rigid: no strain, no stress, no material call", name);
        tell(text, (*number)++, "stress", what, NULL);
    } else if (scene->bodies[b].material < scene->material_count) {
        const ab_loaded_class *loaded = scene->materials[scene->bodies[b].material].loaded;
        if (loaded->class_.nstate == 0) {
            snprintf(what, sizeof what, "%s of '%s' keeps none: no state arrays", loaded->class_.name, name);
            tell(text, (*number)++, "state", what, NULL);
        }
        if (!(loaded->class_.needs & AB_NEED_DEFORMATION_GRADIENT)) {
            snprintf(what, sizeof what, "%s of '%s' does not need it", loaded->class_.name, name);
            tell(text, (*number)++, "deformation gradient", what, NULL);
        }
    }
    if ((has_elements(domain) || ab_domain_is_rigid(domain)) && !contact_asks(scene, b, AB_NEED_SHARED_NODES)) {
        snprintf(what, sizeof what, "no contact looks for '%s' on the grid: no points %s", name,
                 ab_domain_is_rigid(domain) ? "along its outline" : "inside its elements");
        tell(text, (*number)++, "points on the grid", what, NULL);
    }
}

static bool surface_points(const ab_scene *scene) {
    for (size_t b = 0; b < scene->body_count; ++b)
        if (scene->bodies[b].surface_points > 0.0) return true;
    return false;
}

static bool damps(const ab_scene *scene) {
    for (size_t k = 0; k < scene->stage_count; k++)
        if (scene->stages[k].local > 0.0 || scene->stages[k].kinetic) return true;
    return scene->damping_local > 0.0;
}

/* "gravity (ramp), local damping 0.7, until at rest, then displacements from zero" */
static void stage_words(const ab_stage_spec *stage, char *words, size_t size) {
    char gravity[40] = "", damping[80] = "";
    if (stage->gravity != AB_GRAVITY_KEEP)
        snprintf(gravity, sizeof gravity, ", gravity: %s", stage->gravity == AB_GRAVITY_OFF ? "off" : "ramp");
    if (stage->local > 0.0) snprintf(damping, sizeof damping, ", local damping %g", stage->local);
    snprintf(words, size, "%s%s%s%s%s%s", gravity, damping, stage->kinetic ? ", kinetic damping" : "",
             stage->has_until ? ", ends where it is at rest" : "", stage->zero_velocities ? ", velocities to zero at its end" : "",
             stage->zero_displacements ? ", displacements counted anew from its end" : "");
}

/* Where K0 is from, for bodies that begin with it. */
static void initial_words(const ab_body_spec *body, char *words, size_t size) {
    const ab_initial_spec *initial = &body->initial;
    words[0] = '\0';
    if (initial->kind == AB_INITIAL_K0) {
        snprintf(words, size, "begins with K0 = %.4g (%s)", initial->k0, initial->rule ? initial->rule : "");
        const size_t used = strlen(words);
        if (initial->surcharge != 0.0) snprintf(words + used, size - used, " under %g Pa", initial->surcharge);
    }
    if (initial->kind == AB_INITIAL_STRESS) snprintf(words, size, "begins with the stress of the scene");
    if (initial->kind == AB_INITIAL_GRAVITY) snprintf(words, size, "begins with the stress of gravity, by a stage before t = 0");
}

/* What a scene might cost and this one does not. */
static void each_left_out(const ab_schedule *schedule, item tell, ab_text *text) {
    const ab_scene *scene = schedule->scene;
    size_t number = 0;
    char what[256];
    if (!scene->contact_count)
        tell(text, number++, "contact",
             scene->body_count < 2 ? "there is one body: no contact pass, no contact plugin"
                                   : "no contact is asked for: no contact pass, no contact plugin",
             NULL);
    else if (!contact_asks(scene, SIZE_MAX, AB_NEED_SURFACE) && !surface_points(scene))
        tell(text, number++, "outlines", "no contact asks for the points and faces of outlines", NULL);
    if (!scene->boundary_count) tell(text, number++, "boundaries", "no side asks for a boundary plugin: no boundary pass", NULL);
    if (scene->space == AB_SPACE_PLANE_STRAIN)
        tell(text, number++, "third dimension", "plane strain: no third component of velocity and force, no yz and zx of stress", NULL);
    else
        tell(text, number++, "torsion",
             "axisymmetric: no velocity about the axis, no yz and zx of stress; plane strain runs passes without hoops", NULL);
    double cells = 0.0;
    bool known = true;
    for (size_t b = 0; b < schedule->body_count; b++) {
        ab_plan_body body;
        schedule->domains[b]->ops->plan(schedule->domains[b], &body);
        each_left_out_of_body(schedule, b, tell, text, &number);
        cells += (double)body.cells;
        known = known && (body.cells > 0 || has_elements(schedule->domains[b]) || ab_domain_is_rigid(schedule->domains[b]));
    }
    const double all = (double)scene->grid_cells[0] * scene->grid_cells[1];
    if (scene->grid_cell > 0.0 && known && all > cells) {
        snprintf(what, sizeof what, "%.0f of %.0f cells of the grid hold no material: no memory, no time", all - cells, all);
        tell(text, number++, "empty grid", what, NULL);
    }
    if (scene->grid_cell == 0.0) tell(text, number++, "grid", "no body and no contact looks at one", NULL);
    if (!damps(scene)) tell(text, number++, "damping", "none is asked for", NULL);
    if (!scene->load_count) tell(text, number++, "loads", "no traction is asked for: no surface pass", NULL);
    if (!scene->has_checkpoint)
        tell(text, number++, "checkpoints", "none is asked for: the state is saved only where a signal or the watchdog stops the run",
             NULL);
    if (!scene->output_field_count) tell(text, number++, "output", "no field is asked for: nothing but places is written", NULL);
}

static double steps_of(const ab_schedule *schedule) {
    const double left = schedule->scene->time_end - schedule->time;
    return (double)schedule->number + (schedule->dt > 0.0 ? ceil(left / schedule->dt - 1e-9) : 0.0);
}

/* points: of clouds; *nodes: of meshes; those of rigid bodies, which no step goes over, left out. */
static ab_plan_body totals_of(const ab_schedule *schedule, size_t *nodes) {
    ab_plan_body sum = {0};
    *nodes = 0;
    for (size_t b = 0; b < schedule->body_count; b++) {
        ab_plan_body body;
        schedule->domains[b]->ops->plan(schedule->domains[b], &body);
        if (!ab_domain_is_rigid(schedule->domains[b])) {
            *(has_elements(schedule->domains[b]) ? nodes : &sum.points) += body.points;
            sum.elements += body.elements;
        }
        sum.cells += body.cells;
        sum.tiles += body.tiles;
        sum.bytes += body.bytes;
    }
    return sum;
}

/* ---- JSON ------------------------------------------------------------------------------------------------------------------------ */

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
    add_string(text, ", \"kind\": ", kind_name(loaded->class_.kind));
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

/* dt at which a spring of contact is neutrally stable, as far as any is in touch; INFINITY: none. */
static double contact_dt(const ab_schedule *schedule, const char **limit) {
    const ab_interaction *in = schedule->interaction;
    *limit = "";
    return in && in->critical_dt ? in->critical_dt(in, limit) : INFINITY;
}

void ab_plan_add_json(ab_text *text, const ab_schedule *schedule, const ab_run_options *options, double seconds_per_step) {
    const ab_scene *scene = schedule->scene;
    size_t nodes;
    const ab_plan_body sum = totals_of(schedule, &nodes);
    const char *limit;
    add_string(text, "{\n  \"scene\": ", scene->path);
    ab_text_add(text, ",\n  \"bodies\": [");
    for (size_t b = 0; b < schedule->body_count; b++) {
        const ab_domain *domain = schedule->domains[b];
        ab_plan_body body;
        domain->ops->plan(schedule->domains[b], &body);
        add_string(text, b ? ",\n    {\"name\": " : "\n    {\"name\": ", scene->bodies[b].name);
        add_string(text, ", \"method\": ", domain->ops->method);
        if (has_elements(domain))
            ab_text_add(text, ", \"nodes\": %zu, \"elements\": %zu", body.points, body.elements);
        else
            ab_text_add(text, ", \"points\": %zu", body.points);
        ab_text_add(text, ", \"cells\": %zu, \"tiles\": %zu, \"bytes\": %zu", body.cells, body.tiles, body.bytes);
        if (!has_elements(domain)) ab_text_add(text, ", \"bytes_per_point\": %zu", body.bytes_per_point);
        add_words(text, ", \"fields\": ", body.fields);
        add_words(text, ", \"passes\": ", body.passes);
        ab_text_add(text, "}");
    }
    if (scene->stage_count) ab_text_add(text, "],\n  \"stages\": [");
    for (size_t k = 0; k < scene->stage_count; k++) {
        const ab_stage_spec *stage = scene->stages + k;
        char words[256];
        stage_words(stage, words, sizeof words);
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
        contact_needs(contact, needs, sizeof needs);
        add_words(text, ", \"needs\": ", needs);
        ab_text_add(text, ", \"passes\": [\"find\", \"respond\"]}");
    }
    ab_text_add(text, "],\n  \"contact_passes\": %zu,\n  \"boundary_passes\": %zu,\n  \"plugins\": [", scene->contact_count,
                scene->boundary_count);
    each_plugin(scene, json_plugin, text);
    ab_text_add(text, "],\n  \"not_paid_for\": [");
    each_left_out(schedule, json_left_out, text);
    ab_text_add(text,
                "],\n  \"points\": %zu, \"nodes\": %zu, \"elements\": %zu, \"cells\": %zu, \"tiles\": %zu, \"bytes\": %zu, \"threads\": %d",
                sum.points, nodes, sum.elements, sum.cells, sum.tiles, sum.bytes, options->threads);
    add_number(text, ",\n  \"dt\": ", schedule->dt);
    add_number(text, ", \"critical_dt\": ", schedule->critical_dt);
    add_string(text, ", \"limit\": ", schedule->limit);
    add_number(text, ", \"contact_critical_dt\": ", contact_dt(schedule, &limit)); /* null: none of its own, or not in touch yet */
    add_number(text, ",\n  \"steps\": ", steps_of(schedule));
    add_number(text, ", \"estimated_seconds\": ", seconds_per_step > 0.0 ? seconds_per_step * steps_of(schedule) : NAN);
    ab_text_add(text, "\n}");
}

/* ---- text ------------------------------------------------------------------------------------------------------------------------ */

static void text_plugin(ab_text *text, size_t number, const char *name, const char *why, const ab_loaded_class *loaded) {
    (void)number;
    ab_text_add(text, "  %s %s %s: %s%s\n    %s\n", kind_name(loaded->class_.kind), name,
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
    const ab_plan_body sum = totals_of(schedule, &nodes);
    const char *limit;
    if (scene->title && scene->title[0]) ab_text_add(text, "%s\n\n", scene->title);
    ab_text_add(text, "Bodies\n");
    for (size_t b = 0; b < schedule->body_count; b++) {
        const ab_domain *domain = schedule->domains[b];
        ab_plan_body body;
        domain->ops->plan(schedule->domains[b], &body);
        ab_text_add(text, "  %s: %s, ", scene->bodies[b].name, domain->ops->method);
        if (has_elements(domain)) {
            ab_text_add(text, "%zu nodes in %zu element%s, ", body.points, body.elements, body.elements == 1 ? "" : "s");
        } else if (ab_domain_is_rigid(domain)) {
            ab_text_add(text, "%zu point%s on the outline, ", body.points, body.points == 1 ? "" : "s");
        } else {
            ab_text_add(text, "%zu point%s in %zu cell%s (%zu tile%s), %zu bytes a point, ", body.points, body.points == 1 ? "" : "s",
                        body.cells, body.cells == 1 ? "" : "s", body.tiles, body.tiles == 1 ? "" : "s", body.bytes_per_point);
        }
        if (body.tiles && (has_elements(domain) || ab_domain_is_rigid(domain)))
            ab_text_add(text, "seen on the grid (%zu tiles), ", body.tiles);
        add_bytes(text, body.bytes);
        ab_text_add(text, " in all\n    fields: %s\n    each step: %s\n", body.fields, body.passes);
        char begins[160];
        initial_words(scene->bodies + b, begins, sizeof begins);
        if (begins[0]) ab_text_add(text, "    %s\n", begins);
    }
    if (scene->contact_count) ab_text_add(text, "\nContacts\n");
    for (size_t c = 0; c < scene->contact_count; c++) {
        const ab_contact_spec *contact = &scene->contacts[c];
        char needs[256];
        contact_needs(contact, needs, sizeof needs);
        ab_text_add(text, "  %s and %s: each step: find (%s), respond (%s)%s\n", scene->bodies[contact->body[0]].name,
                    scene->bodies[contact->body[1]].name, contact->finder->class_.name,
                    contact->responder ? contact->responder->class_.name : contact->finder->class_.name,
                    contact->finder->class_.needs & AB_NEED_SHARED_NODES ? ", where their tiles meet" : "");
        if (needs[0]) ab_text_add(text, "    needs: %s\n", needs);
    }
    if (scene->stage_count) ab_text_add(text, "\nStages\n");
    for (size_t k = 0; k < scene->stage_count; k++) {
        char words[256];
        stage_words(scene->stages + k, words, sizeof words);
        ab_text_add(text, "  %s: to t = %g s%s\n", scene->stages[k].name, scene->stages[k].end, words);
    }
    ab_text_add(text, "\nPlugins\n");
    each_plugin(scene, text_plugin, text);
    ab_text_add(text, "\nNot paid for\n");
    each_left_out(schedule, text_left_out, text);
    ab_text_add(text, "\nCost\n  ");
    if (sum.points) ab_text_add(text, "%zu point%s, ", sum.points, sum.points == 1 ? "" : "s");
    if (nodes) ab_text_add(text, "%zu nodes, %zu elements, ", nodes, sum.elements);
    add_bytes(text, sum.bytes);
    ab_text_add(text, ", %d thread%s\n  dt %.4g s; ", options->threads, options->threads == 1 ? "" : "s", schedule->dt);
    if (isfinite(schedule->critical_dt))
        ab_text_add(text, "the stable limit is %.4g s: %s\n", schedule->critical_dt, schedule->limit);
    else
        ab_text_add(text, "there is no stable limit: rigid bodies have no waves\n");
    const double spring = contact_dt(schedule, &limit);
    if (isfinite(spring)) ab_text_add(text, "  contact alone allows %.4g s: %s\n", spring, limit);
    ab_text_add(text, "  %.0f steps", steps_of(schedule));
    if (seconds_per_step > 0.0) {
        ab_text_add(text, ", about ");
        add_seconds(text, seconds_per_step * steps_of(schedule));
    }
    ab_text_add(text, "\n");
    if (schedule->scene->has_checkpoint) {
        ab_text_add(text, "  a checkpoint has at most about ");
        add_bytes(text, sum.bytes);
        ab_text_add(text, "; two are kept\n");
    }
}

/* ---- abut plan --------------------------------------------------------------------------------------------------------------------- */

static double now(void) {
    struct timespec clock;
    clock_gettime(CLOCK_MONOTONIC, &clock);
    return (double)clock.tv_sec + 1e-9 * (double)clock.tv_nsec;
}

/* Steps a little: one step warms up, then as many as fit in a fifth of a second, at most 200. A step that fails only ends the estimate: the run
 * will say what is wrong. */
static double measure(ab_schedule *schedule, ab_report *report) {
    const double end = schedule->scene->time_end;
    double begin = 0.0, spent = 0.0;
    int steps = -1;
    while (schedule->time < end && steps < 200 && spent < 0.2) {
        if (ab_schedule_step(schedule, report) != AB_OK) return 0.0;
        if (++steps == 0) begin = now();
        spent = now() - begin;
    }
    return steps > 0 ? spent / steps : 0.0;
}

ab_status ab_plan_print(const ab_scene *scene, const ab_run_options *options, bool json, FILE *stream, ab_report *report) {
    ab_schedule *schedule = NULL;
    AB_TRY(ab_schedule_create(scene, options, &schedule, report));
    const ab_status doubts = ab_doubts(schedule, report);
    if (doubts != AB_OK) ab_schedule_destroy(schedule);
    AB_TRY(doubts);
    ab_report *first_steps = ab_report_create(); /* their mistakes belong to the run */
    const double seconds_per_step = first_steps ? measure(schedule, first_steps) : 0.0;
    ab_report_destroy(first_steps);
    ab_schedule_destroy(schedule);
    AB_TRY(ab_schedule_create(scene, options, &schedule, report)); /* as it is at the start, not where measuring left it */
    ab_text text = {0};
    (json ? ab_plan_add_json : ab_plan_add_text)(&text, schedule, options, seconds_per_step);
    ab_schedule_destroy(schedule);
    ab_status status = AB_OK;
    if (text.failed)
        status = ab_report_failure(report, "no memory for the plan");
    else
        fprintf(stream, json ? "%s\n" : "%s", text.bytes);
    ab_text_clear(&text);
    return status;
}
