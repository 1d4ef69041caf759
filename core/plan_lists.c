/* plan_lists.c: the lists that a plan goes over. */
#include <math.h>
#include <string.h>

#include "core/plan_lists.h"

const char *ab_plan_kind_name(uint32_t kind) { return kind == AB_MATERIAL ? "material" : kind == AB_BOUNDARY ? "boundary" : "contact"; }

/* Boundary plugins in use. */
static void each_boundary_plugin(const ab_scene *scene, ab_plan_item tell, ab_text *text, size_t *number) {
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

void ab_plan_each_plugin(const ab_scene *scene, ab_plan_item tell, ab_text *text) {
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

void ab_plan_contact_needs(const ab_contact_spec *contact, char *words, size_t size) {
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

bool ab_plan_has_elements(const ab_domain *domain) { return domain->ops->cells != NULL; }

/* What a body might cost and does not. */
static void each_left_out_of_body(const ab_schedule *schedule, size_t b, ab_plan_item tell, ab_text *text, size_t *number) {
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
    if ((ab_plan_has_elements(domain) || ab_domain_is_rigid(domain)) && !contact_asks(scene, b, AB_NEED_SHARED_NODES)) {
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

void ab_plan_stage_words(const ab_stage_spec *stage, char *words, size_t size) {
    char gravity[40] = "", damping[80] = "";
    if (stage->gravity != AB_GRAVITY_KEEP)
        snprintf(gravity, sizeof gravity, ", gravity: %s", stage->gravity == AB_GRAVITY_OFF ? "off" : "ramp");
    if (stage->local > 0.0) snprintf(damping, sizeof damping, ", local damping %g", stage->local);
    snprintf(words, size, "%s%s%s%s%s%s", gravity, damping, stage->kinetic ? ", kinetic damping" : "",
             stage->has_until ? ", ends where it is at rest" : "", stage->zero_velocities ? ", velocities to zero at its end" : "",
             stage->zero_displacements ? ", displacements counted anew from its end" : "");
}

void ab_plan_initial_words(const ab_body_spec *body, char *words, size_t size) {
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

void ab_plan_each_left_out(const ab_schedule *schedule, ab_plan_item tell, ab_text *text) {
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
        known = known && (body.cells > 0 || ab_plan_has_elements(schedule->domains[b]) || ab_domain_is_rigid(schedule->domains[b]));
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

double ab_plan_steps_of(const ab_schedule *schedule) {
    const double left = schedule->scene->time_end - schedule->time;
    return (double)schedule->number + (schedule->dt > 0.0 ? ceil(left / schedule->dt - 1e-9) : 0.0);
}

ab_plan_body ab_plan_totals_of(const ab_schedule *schedule, size_t *nodes) {
    ab_plan_body sum = {0};
    *nodes = 0;
    for (size_t b = 0; b < schedule->body_count; b++) {
        ab_plan_body body;
        schedule->domains[b]->ops->plan(schedule->domains[b], &body);
        if (!ab_domain_is_rigid(schedule->domains[b])) {
            *(ab_plan_has_elements(schedule->domains[b]) ? nodes : &sum.points) += body.points;
            sum.elements += body.elements;
        }
        sum.cells += body.cells;
        sum.tiles += body.tiles;
        sum.bytes += body.bytes;
    }
    return sum;
}

double ab_plan_contact_dt(const ab_schedule *schedule, const char **limit) {
    const ab_interaction *in = schedule->interaction;
    *limit = "";
    return in && in->critical_dt ? in->critical_dt(in, limit) : INFINITY;
}
