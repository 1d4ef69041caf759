/* loads.c: tractions on the outer faces, forces at nodes, and nodes whose velocity is given. A traction acts on the initial length of a face and keeps its direction,
 * as on material points; its share for a node is the integral of the node's basis function along the face. */
#include <math.h>

#include "core/memory.h"
#include "fem/domain.h"

/* ---- loads --------------------------------------------------------------------------------------------------------------- */

/* Integrals of the two or three basis functions along a face, m: first, last, middle. */
static void face_shares(const fem_mesh *mesh, const uint32_t *vertex, double share[3]) {
    static const double PLACE[3] = {-0.7745966692414834, 0.0, 0.7745966692414834}, WEIGHT[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
    const double *a = mesh->x + 2 * (size_t)vertex[0], *b = mesh->x + 2 * (size_t)vertex[1];
    share[0] = share[1] = share[2] = 0.0;
    if (vertex[2] == FEM_NONE) {
        share[0] = share[1] = 0.5 * hypot(b[0] - a[0], b[1] - a[1]);
        return;
    }
    const double *m = mesh->x + 2 * (size_t)vertex[2];
    for (int q = 0; q < 3; ++q) {
        const double s = PLACE[q], n[3] = {0.5 * s * (s - 1.0), 0.5 * s * (s + 1.0), 1.0 - s * s}, d[3] = {s - 0.5, s + 0.5, -2.0 * s};
        const double tx = d[0] * a[0] + d[1] * b[0] + d[2] * m[0], ty = d[0] * a[1] + d[1] * b[1] + d[2] * m[1];
        for (int k = 0; k < 3; ++k) share[k] += WEIGHT[q] * n[k] * hypot(tx, ty);
    }
}

static uint32_t nearest_node(const fem_mesh *mesh, const double at[2]) {
    uint32_t best = 0;
    double least = INFINITY;
    for (size_t i = 0; i < mesh->node_count; ++i) {
        const double d = hypot(mesh->x[2 * i] - at[0], mesh->x[2 * i + 1] - at[1]);
        if (d < least) least = d, best = (uint32_t)i;
    }
    return best;
}

/* One load's shares go to `share`, a number per node. False: it meets nothing. */
static bool spread(const fem_body *body, const fem_faces *faces, const ab_load_spec *load, double *share) {
    for (size_t i = 0; i < body->nodes; ++i) share[i] = 0.0;
    if (load->point) {
        share[nearest_node(body->mesh, load->at)] = 1.0;
        return true;
    }
    bool met = false;
    for (size_t f = 0; f < faces->count; ++f) {
        if (!fem_where_face(&load->where, body->mesh, faces, f)) continue;
        met = true;
        double part[3];
        face_shares(body->mesh, faces->vertex + 3 * f, part);
        for (int k = 0; k < 3; ++k)
            if (faces->vertex[3 * f + (size_t)k] != FEM_NONE) share[faces->vertex[3 * f + (size_t)k]] += part[k];
    }
    return met;
}

ab_status fem_loads_create(fem_body *body, const fem_faces *faces, ab_report *report) {
    const ab_scene *scene = body->scene;
    double *share = ab_memory_take(body->nodes * sizeof *share);
    ab_status status = share ? AB_OK : ab_report_failure(report, "body '%s': no memory for its loads", body->domain.spec->name);
    size_t capacity = 0;
    for (size_t k = 0; status == AB_OK && k < scene->load_count; ++k) {
        const ab_load_spec *load = scene->loads + k;
        if (load->body != body->domain.index) continue;
        if (!spread(body, faces, load, share)) {
            status = ab_report_error(report, load->mark,
                                     "loads[%zu] meets no outer face of '%s'; use side: left|right|top|bottom or a place on its outline", k,
                                     body->domain.spec->name);
            break;
        }
        for (size_t i = 0; i < body->nodes; ++i) {
            if (share[i] == 0.0) continue;
            if (!ab_memory_grow((void **)&body->loads, &capacity, body->load_count + 1, sizeof *body->loads)) {
                status = ab_report_failure(report, "body '%s': no memory for its loads", body->domain.spec->name);
                break;
            }
            body->loads[body->load_count++] = (fem_load){(uint32_t)i, (uint32_t)k, share[i]};
        }
    }
    body->load_capacity = capacity;
    ab_memory_give(share, body->nodes * sizeof *share);
    return status;
}

static void load_force(const fem_body *body, uint32_t spec, double time, double force[2]) {
    const ab_load_spec *load = body->scene->loads + spec;
    for (int c = 0; c < 2; ++c) force[c] = ab_number_at((load->point ? load->force : load->traction) + c, time, 0.0, 0.0, 0.0);
}

void fem_loads_add(fem_body *body, const ab_step *step) {
    double force[2] = {0.0, 0.0};
    for (size_t k = 0; k < body->load_count; ++k) {
        const fem_load *load = body->loads + k;
        if (k == 0 || load->spec != load[-1].spec) load_force(body, load->spec, step->time + 0.5 * step->dt, force);
        for (size_t c = 0; c < 2; ++c) body->force[2 * (size_t)load->node + c] += load->weight * force[c];
    }
}

void fem_loads_work(fem_body *body, const ab_step *step) {
    double force[2] = {0.0, 0.0};
    for (size_t k = 0; k < body->load_count; ++k) {
        const fem_load *load = body->loads + k;
        if (k == 0 || load->spec != load[-1].spec) load_force(body, load->spec, step->time + 0.5 * step->dt, force);
        for (size_t c = 0; c < 2; ++c) {
            const size_t d = 2 * (size_t)load->node + c;
            body->energy.external += step->dt * load->weight * force[c] * 0.5 * (body->velocity[d] + body->old[d]);
        }
    }
}

/* ---- nodes whose velocity is given --------------------------------------------------------------------------------------- */

ab_status fem_held_create(fem_body *body, const fem_faces *faces, ab_report *report) {
    const ab_body_spec *spec = body->domain.spec;
    uint32_t *fix = ab_memory_take(2 * body->nodes *
                                   sizeof *fix); /* of each direction: one more than its entry, the last that says something; 0: free */
    if (!fix) return ab_report_failure(report, "body '%s': no memory for the nodes it is fixed at", spec->name);
    ab_status status = AB_OK;
    for (size_t f = 0; f < spec->fix_count; ++f) {
        bool met = false;
        for (size_t i = 0; i < body->nodes; ++i) {
            if (!fem_where_node(&spec->fix[f].where, body->mesh, faces, (uint32_t)i)) continue;
            met = true;
            for (size_t c = 0; c < 2; ++c)
                if (spec->fix[f].has[c]) fix[2 * i + c] = (uint32_t)f + 1;
        }
        if (!met)
            status = ab_report_error(report, spec->fix[f].where.mark,
                                     "bodies.%s.fix[%zu] meets no node of the mesh; use side: left|right|top|bottom, or x or y of nodes",
                                     spec->name, f);
    }
    size_t count = 0;
    for (size_t d = 0; d < 2 * body->nodes; ++d) count += fix[d] != 0;
    if (status == AB_OK && count) {
        body->held = fem_take(body, count, sizeof *body->held);
        body->impulse = fem_take(body, 2 * body->nodes, sizeof *body->impulse);
        if (!body->held || !body->impulse) status = ab_report_failure(report, "body '%s': no memory for %zu supports", spec->name, count);
        for (size_t d = 0; status == AB_OK && d < 2 * body->nodes; ++d)
            if (fix[d]) {
                body->held[body->held_count++] = (fem_held){.node = (uint32_t)(d / 2), .component = (uint32_t)(d % 2), .fix = fix[d] - 1};
                body->inverse_mass[d] = 0.0;
            }
    }
    ab_memory_give(fix, 2 * body->nodes * sizeof *fix);
    return status;
}

void fem_held_move(fem_body *body, double time) {
    const ab_body_spec *spec = body->domain.spec;
    for (size_t f = 0; f < 2 * spec->fix_count; ++f)
        if (spec->fix[f / 2].has[f % 2]) body->given[f] = ab_number_at(spec->fix[f / 2].velocity + f % 2, time, 0.0, 0.0, 0.0);
    for (size_t k = 0; k < body->held_count; ++k) {
        const fem_held *held = body->held + k;
        body->velocity[2 * (size_t)held->node + held->component] = body->given[2 * (size_t)held->fix + held->component];
    }
}

/* What the support gives is what the node gains beyond elements, loads, weight and contact; its work is exact for the node's kinetic energy. */
void fem_held_work(fem_body *body, const ab_step *step) {
    for (int c = 0; c < 3; ++c) body->reaction[c] = 0.0;
    for (size_t k = 0; k < body->held_count; ++k) {
        const fem_held *held = body->held + k;
        const size_t i = held->node, d = 2 * i + held->component;
        const double v = body->velocity[d], old = body->old[d];
        const double impulse = body->mass[i] * (v - old) - step->dt * body->force[d] - body->impulse[d], force = impulse / step->dt;
        body->energy.external += impulse * 0.5 * (v + old);
        body->reaction[held->component] += force;
        const double x = body->x[2 * i] + body->origin[0], y = body->x[2 * i + 1] + body->origin[1];
        body->reaction[2] += held->component == 0 ? -y * force : x * force;
    }
}
