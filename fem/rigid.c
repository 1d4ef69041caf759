/* rigid.c: a rigid body as the scheduler sees it: its table of functions, creation, ledger and plan. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fem/body.h"
#include "fem/rigid.h"

/* A body whose motion is given and that has neither material nor mass: light enough not to be seen in any sum, so that momentum over mass is still its velocity. */
static const double NO_DENSITY = 1e-9; /* kg/m3 */

void *rigid_take(rigid_body *body, size_t count, size_t size) {
    body->bytes += count * size;
    return calloc(count + 1, size);
}

static void destroy(ab_domain *domain) {
    rigid_body *body = (rigid_body *)domain;
    rigid_surface_destroy(body);
    rigid_outline_clear(&body->outline);
    free(body->loads), free(body);
}

static double critical_dt(ab_domain *domain, const char **limit) {
    (void)domain;
    *limit = "nothing: rigid bodies have no wave";
    return INFINITY;
}

static double modulus(const ab_domain *domain) {
    (void)domain;
    return INFINITY;
}

static void ledger(const ab_domain *domain, ab_energy *energy, ab_motion *motion) {
    const rigid_body *body = (const rigid_body *)domain;
    *energy = body->energy;
    *motion = body->motion;
}

/* Open between trial and finish only: velocity fields that strain other bodies move about a body that keeps its own. Its place is that of the start of the step until
 * the next one, because impulses act and are booked there. */
static void dofs(const ab_domain *domain, ab_dofs *d) {
    rigid_body *body = (rigid_body *)(uintptr_t)domain;
    const bool held = body->held[0] || body->held[1] || body->held_spin;
    *d = (ab_dofs){.velocity = body->velocity,
                   .velocity_old = body->old,
                   .inverse_mass = body->open ? body->inverse_mass : body->closed,
                   .velocity_stride = 2,
                   .old_stride = 2,
                   .mass_stride = 2,
                   .spin = &body->spin,
                   .spin_old = &body->spin_old,
                   .inverse_inertia = body->open ? body->inverse_inertia : 0.0,
                   .centre = {body->reference[0], body->reference[1]},
                   .impulse = body->open && held ? body->impulse : NULL};
}

static void reaction(const ab_domain *domain, double force[3]) { memcpy(force, ((const rigid_body *)domain)->reaction, 3 * sizeof *force); }

static void plan(const ab_domain *domain, ab_plan_body *p) {
    const rigid_body *body = (const rigid_body *)domain;
    const rigid_outline *o = &body->outline;
    *p = (ab_plan_body){0};
    p->points = rigid_count(domain);
    p->elements = o->mesh ? o->mesh->element_count : 0;
    if (body->trace) {
        ab_node_tiles tiles;
        fem_trace_tiles(body->trace, &tiles);
        p->tiles = tiles.count;
    }
    p->bytes = sizeof *body + body->bytes + o->vertex_count * 16 + o->face_count * 20 + o->point_count * 28;
    p->bytes_per_point = p->points ? p->bytes / p->points : 0;
    snprintf(p->fields, sizeof p->fields, "outline, velocity, spin%s", body->trace ? ", points along the outline" : "");
    snprintf(p->passes, sizeof p->passes, "motion%s", body->trace ? ", outline to grid" : "");
}

#define SAME_FOR_BOTH                                                                                                                      \
    .method = "rigid", .destroy = destroy, .critical_dt = critical_dt, .begin = rigid_begin, .trial = rigid_trial, .finish = rigid_finish, \
    .ledger = ledger, .node_tiles = rigid_node_tiles, .trace = rigid_trace, .dofs = dofs, .faces = rigid_faces, .bounds = rigid_bounds,    \
    .surface_points = rigid_surface_points, .modulus = modulus, .count = rigid_count, .fields = rigid_fields, .read = rigid_read,          \
    .plan = plan, .keep = rigid_keep, .rest = rigid_rest, .datum = rigid_datum, .balance = rigid_balance
static const ab_domain_ops OPS_FREE = {SAME_FOR_BOTH};
static const ab_domain_ops OPS_GIVEN = {SAME_FOR_BOTH, .reaction = reaction};
static const ab_domain_ops OPS_MESH_FREE = {SAME_FOR_BOTH, .cells = rigid_cells};
static const ab_domain_ops OPS_MESH_GIVEN = {SAME_FOR_BOTH, .cells = rigid_cells, .reaction = reaction};

/* Mass, inertia, and what they are on the grid. */
static ab_status weigh(rigid_body *body, ab_report *report) {
    const ab_body_spec *spec = body->domain.spec;
    const ab_motion_spec *m = &spec->motion;
    const rigid_outline *o = &body->outline;
    const bool has_material = spec->material < body->scene->material_count;
    const double density = has_material ? body->scene->materials[spec->material].density : NO_DENSITY;
    const bool free_ = !m->has[0] || !m->has[1] || (!m->has_spin && !m->has_inertia);
    if (free_ && !has_material && !m->has_mass)
        return ab_report_error(
            report, spec->mark,
            "body '%s': what is not given of its motion follows from forces, but its mass is not known; name a material, "
            "write motion.mass, or give velocity and spin",
            spec->name);
    const double volume = body->scene->space == AB_SPACE_AXISYMMETRIC ? ab_circumference(o->centre[0]) * o->area : o->area; /* Pappus */
    body->mass = m->has_mass ? m->mass : density * volume;
    body->inertia = m->has_inertia ? m->inertia : body->mass * o->polar / o->area;
    body->mass_density = has_material ? density : m->has_mass ? body->mass / volume : 1.0;
    body->gravity = spec->gravity && (has_material || m->has_mass);
    return AB_OK;
}

ab_status rigid_create(const ab_scene *scene, size_t index, int threads, ab_domain **domain, ab_report *report) {
    (void)threads;
    const ab_body_spec *spec = scene->bodies + index;
    const bool given = spec->motion.has[0] || spec->motion.has[1] || spec->motion.has_spin;
    rigid_body *body = calloc(1, sizeof *body);
    if (!body) return ab_report_failure(report, "no memory for body '%s'", spec->name);
    body->domain = (ab_domain){.ops = given             ? spec->has_shape ? &OPS_GIVEN : &OPS_MESH_GIVEN
                                      : spec->has_shape ? &OPS_FREE
                                                        : &OPS_MESH_FREE,
                               .spec = spec,
                               .dimension = 2,
                               .index = index};
    body->scene = scene;
    for (int c = 0; c < 2; ++c) body->origin[c] = scene->grid_cell > 0.0 ? scene->grid_from[c] : 0.0;
    ab_status status = rigid_outline_create(scene, spec, &body->outline, report);
    if (status == AB_OK) status = weigh(body, report);
    if (status == AB_OK) status = rigid_motion_create(body, report);
    if (status == AB_OK) status = rigid_surface_create(body, report);
    if (status != AB_OK) {
        destroy(&body->domain);
        return status;
    }
    *domain = &body->domain;
    return AB_OK;
}
