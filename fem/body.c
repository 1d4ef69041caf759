/* body.c: a finite-element body as the scheduler sees it: its table of functions, from creation to ledger. */
#include "fem/body.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "fem/domain.h"

/* How often a material whose wave speed changes is asked for it, steps. */
enum { WAVE_SPEED_EVERY = 16 };

typedef struct piece { /* of memory, behind a header of one cache line */
    struct piece *next;
    size_t bytes;
} piece;
enum { HEADER = 64 };

void *fem_take(fem_body *body, size_t count, size_t size) {
    if (size && count > SIZE_MAX / 4 / size) return NULL;
    const size_t bytes = HEADER + count * size;
    piece *p = ab_memory_take(bytes);
    if (!p) return NULL;
    *p = (piece){body->pieces, bytes};
    body->pieces = p;
    body->bytes += bytes;
    return (char *)p + HEADER;
}

void fem_middle(const fem_body *body, size_t element, double place[2]) {
    const size_t nodes = (size_t)body->element->nodes;
    for (int c = 0; c < 2; ++c) {
        place[c] = body->origin[c];
        for (size_t a = 0; a < 4; ++a)
            place[c] += 0.25 * body->x_start[2 * (size_t)body->mesh->connectivity[element * nodes + a] + (size_t)c];
    }
}

static void destroy(ab_domain *domain) {
    fem_body *body = (fem_body *)domain;
    if (body->self && body->material->loaded->class_.destroy) body->material->loaded->class_.destroy(body->self);
    fem_outer_destroy(body);
    fem_inner_destroy(body);
    fem_mesh_destroy(body->mesh);
    ab_memory_give(body->loads, body->load_capacity * sizeof *body->loads);
    for (piece *p = body->pieces, *next; p; p = next) {
        next = p->next;
        ab_memory_give(p, p->bytes);
    }
    free(body->fields), free(body);
}

static double critical_dt(ab_domain *domain, const char **limit) {
    fem_body *body = (fem_body *)domain;
    snprintf(body->limit, sizeof body->limit, "element %llu of '%s', %.4g s", fem_element_number(body, body->slowest_element),
             domain->spec->name, body->slowest);
    *limit = body->limit;
    return body->slowest;
}

static ab_status begin(ab_domain *domain, const ab_step *step, ab_report *report) {
    fem_body *body = (fem_body *)domain;
    memcpy(body->old, body->velocity, 2 * body->nodes * sizeof *body->old);
    body->external_before = body->energy.external;
    fem_nodes_force(body);
    AB_TRY(fem_loads_add(body, step, report));
    AB_TRY(fem_body_force_add(body, step, report));
    return body->trace ? fem_inner_follow(body, step->number, report) : AB_OK;
}

static ab_status trial(ab_domain *domain, const ab_step *step, ab_report *report) {
    fem_body *body = (fem_body *)domain;
    fem_nodes_trial(body, step);
    if (body->held_count) {
        AB_TRY(fem_held_move(body, step->time + 0.5 * step->dt, step->settling, report));
        memset(body->impulse, 0, 2 * body->nodes * sizeof *body->impulse);
    }
    body->open = true;
    return AB_OK;
}

/* Names the first node whose velocity is no number any more, or else the fastest one, where it was at the start of the step. */
static ab_status blown_up(const fem_body *body, const ab_step *step, ab_report *report) {
    size_t worst = 0;
    double most = -1.0;
    for (size_t i = 0; i < body->nodes && most < INFINITY; ++i) {
        const double *v = body->velocity + 2 * i, size = hypot(v[0], v[1]), seen = isfinite(size) ? size : INFINITY;
        if (seen > most) most = seen, worst = i;
    }
    const double *v = body->velocity + 2 * worst, *x = body->x_start + 2 * worst;
    return ab_report_failure(report,
                             "body '%s': the kinetic energy is no finite number any more: node %zu at (%.6g, %.6g) m has the velocity (%.4g, %.4g) m/s at t = %.9g s (step %ld, "
                             "dt %.4g s, limit %.4g s); %s",
                             body->domain.spec->name, worst, x[0] + body->origin[0], x[1] + body->origin[1], v[0], v[1], step->time + step->dt, step->number, step->dt,
                             body->slowest,
                             step->dt > body->slowest ? "dt is above the limit: use a smaller one, or cfl"
                                                      : "look at what drives it: gravity, loads, given motions and their units; else use a smaller dt or a finer mesh there");
}

static ab_status finish(ab_domain *domain, const ab_step *step, ab_report *report) {
    fem_body *body = (fem_body *)domain;
    body->open = false;
    fem_held_work(body, step);
    if (step->measure) fem_nodes_balance(body, step);
    fem_nodes_finish(body, step);
    fem_loads_work(body, step);
    fem_body_force_work(body, step);
    return isfinite(body->energy.kinetic) ? AB_OK : blown_up(body, step, report);
}

static ab_status complain(const fem_body *body, fem_trouble trouble, size_t element, const ab_step *step, ab_report *report) {
    double place[2];
    fem_middle(body, element, place);
    const char *name = body->domain.spec->name;
    if (trouble == FEM_MATERIAL)
        return ab_report_failure(
            report,
            "material '%s' of body '%s' gave up at t = %.9g s in element %llu near (%.6g, %.6g) m (step %ld, dt %.4g s, limit %.4g s): %s; "
            "%s",
            body->material->name, name, step->time + step->dt, fem_element_number(body, element), place[0], place[1], step->number,
            step->dt, body->slowest, body->service.message[0] ? body->service.message : "no reason given",
            step->dt > body->slowest ? "dt is above the limit: use a smaller one, or cfl" : "a smaller dt or a finer mesh may help");
    return ab_report_failure(
        report, "body '%s': element %llu near (%.6g, %.6g) m is %s at t = %.9g s (step %ld, dt %.4g s, limit %.4g s); %s", name,
        fem_element_number(body, element), place[0], place[1],
        trouble == FEM_INVERTED ? "turned inside out" : "nearly turned inside out (watchdog: {stop: false} lets it go on)",
        step->time + step->dt, step->number, step->dt, body->slowest,
        step->dt > body->slowest ? "dt is above the limit of the mesh as it is now: use a smaller dt, or cfl"
                                 : "use a smaller dt, a finer mesh there or a stiffer material");
}

static ab_status stress(ab_domain *domain, const ab_step *step, ab_report *report) {
    fem_body *body = (fem_body *)domain;
    const ab_class *class_ = &body->material->loaded->class_;
    body->ask_wave_speed = (class_->gives & AB_GIVE_WAVE_SPEED) && (class_->needs & (AB_NEED_DEFORMATION_GRADIENT | AB_NEED_DENSITY)) &&
                           step->number % WAVE_SPEED_EVERY == 0;
    size_t culprit = 0;
    const fem_trouble trouble = fem_elements_step(body, step, &culprit);
    if (trouble != FEM_FINE) return complain(body, trouble, culprit, step, report);
    double work = 0.0, first_work = 0.0, plastic = 0.0;
    for (size_t g = 0; g < body->groups; ++g) {
        work += body->sums[g].work;
        first_work += body->sums[g].first_work;
        plastic += body->sums[g].plastic;
    }
    body->energy.strain += work - plastic;
    body->energy.plastic += plastic;
    body->ahead = work - 0.5 * first_work;
    fem_critical(body, false);
    return AB_OK;
}

/* Velocities stand in the middle of the step and stresses at its end. Strain energy at the middle is that of the beginning and half of what the old stress did:
 * central differences keep this sum exactly while a body is linear, at any dt. */
static void ledger(const ab_domain *domain, ab_energy *energy, ab_motion *motion) {
    const fem_body *body = (const fem_body *)domain;
    *energy = body->energy;
    energy->strain -= body->ahead;
    *motion = body->motion;
}

static void node_tiles(const ab_domain *domain, ab_node_tiles *tiles) {
    const fem_body *body = (const fem_body *)domain;
    *tiles = (ab_node_tiles){0};
    if (body->trace) fem_trace_tiles(body->trace, tiles);
}

static ab_status trace(ab_domain *domain, const uint32_t *nodes, size_t count, uint32_t needs, ab_trace *out, ab_report *report) {
    fem_body *body = (fem_body *)domain;
    if (!body->trace) return ab_report_failure(report, "body '%s' is asked for nodes of a grid that it is not on", domain->spec->name);
    return fem_trace_nodes(body->trace, &body->inner, nodes, count, needs, out, report);
}

static void dofs(const ab_domain *domain, ab_dofs *d) {
    const fem_body *body = (const fem_body *)domain;
    *d = (ab_dofs){.velocity = body->velocity,
                   .velocity_old = body->old,
                   .inverse_mass = body->open ? body->inverse_mass : body->closed,
                   .velocity_stride = 2,
                   .old_stride = 2,
                   .mass_stride = 2,
                   .impulse = body->open ? body->impulse : NULL};
}

static double modulus(const ab_domain *domain) {
    const fem_body *body = (const fem_body *)domain;
    return body->elastic.lambda + 2.0 * body->elastic.mu;
}

static void reaction(const ab_domain *domain, double force[3]) { memcpy(force, ((const fem_body *)domain)->reaction, 3 * sizeof *force); }

static void plan(const ab_domain *domain, ab_plan_body *p) {
    const fem_body *body = (const fem_body *)domain;
    memset(p, 0, sizeof *p);
    p->points = body->nodes;
    p->elements = body->elements;
    if (body->trace) {
        ab_node_tiles tiles;
        fem_trace_tiles(body->trace, &tiles);
        p->tiles = tiles.count;
    }
    p->bytes = body->bytes + sizeof *body;
    p->bytes_per_point = p->bytes / body->nodes;
    snprintf(p->fields, sizeof p->fields, "position, start of step, velocity, old velocity, force, mass, stress%s%s",
             body->element->extra ? ", hourglass forces" : "", body->rows.gradient >= 0 ? ", deformation gradient" : "");
    const ab_class *class_ = &body->material->loaded->class_;
    for (uint32_t s = 0; s < class_->nstate; ++s) {
        const size_t used = strlen(p->fields);
        snprintf(p->fields + used, sizeof p->fields - used, ", %s", class_->state[s].name);
    }
    if (body->trace) strncat(p->fields, ", points inside", sizeof p->fields - strlen(p->fields) - 1);
    snprintf(p->passes, sizeof p->passes, "internal force%s%s, nodes, stress", body->load_count ? ", loads" : "",
             body->trace ? ", points inside to grid" : "");
}

static const ab_domain_ops OPS = {.method = "finite-elements",
                                  .destroy = destroy,
                                  .critical_dt = critical_dt,
                                  .begin = begin,
                                  .trial = trial,
                                  .finish = finish,
                                  .stress = stress,
                                  .ledger = ledger,
                                  .node_tiles = node_tiles,
                                  .trace = trace,
                                  .dofs = dofs,
                                  .bounds = fem_bounds,
                                  .faces = fem_surface_faces,
                                  .surface_points = fem_surface_points,
                                  .modulus = modulus,
                                  .reaction = reaction,
                                  .edges = fem_edges,
                                  .cells = fem_cells,
                                  .count = fem_count,
                                  .fields = fem_fields,
                                  .read = fem_read,
                                  .plan = plan,
                                  .keep = fem_keep,
                                  .enter = fem_enter,
                                  .rest = fem_rest,
                                  .datum = fem_datum,
                                  .balance = fem_balance};

/* ---- making -------------------------------------------------------------------------------------------------------------- */

static ab_status no_memory(const fem_body *body, ab_report *report) {
    return ab_report_failure(report, "body '%s': no memory for %zu nodes and %zu elements; use fewer", body->domain.spec->name, body->nodes,
                             body->elements);
}

static ab_status take_arrays(fem_body *body, ab_report *report) {
    const size_t pairs = 2 * body->nodes, nodes = (size_t)body->element->nodes, points = (size_t)body->element->gauss;
    const struct {
        void *at;
        size_t count, size;
    } wanted[] = {
        {&body->x, pairs, sizeof(double)},
        {&body->x_start, pairs, sizeof(double)},
        {&body->velocity, pairs, sizeof(double)},
        {&body->old, pairs, sizeof(double)},
        {&body->force, pairs, sizeof(double)},
        {&body->inverse_mass, pairs, sizeof(double)},
        {&body->closed, pairs, sizeof(double)},
        {&body->mass, body->nodes, sizeof(double)},
        {&body->gather_start, body->nodes + 1, sizeof *body->gather_start},
        {&body->gather, body->elements * nodes, sizeof *body->gather},
        {&body->connectivity, body->blocks * nodes * 8, sizeof *body->connectivity},
        {&body->gauss, body->blocks * points * 8 * (size_t)body->rows.count, sizeof(double)},
        {&body->extra, body->blocks * 8 * (size_t)body->element->extra, sizeof(double)},
        {&body->element_force, body->blocks * nodes * 16, sizeof(double)},
        {&body->stretch, body->blocks, sizeof(double)},
        {&body->stiffening, body->blocks, sizeof(double)},
        {&body->volume_start, body->blocks * 8, sizeof(double)},
        {&body->frequency2, body->blocks * 8, sizeof(double)},
        {&body->sums, body->groups, sizeof *body->sums},
        {&body->node_sums, body->runs, sizeof *body->node_sums},
        {&body->given, 2 * body->domain.spec->fix_count, sizeof(double)},
        {&body->body_force, body->domain.spec->has_force ? pairs : 0, sizeof(double)},
    };
    for (size_t k = 0; k < sizeof wanted / sizeof *wanted; ++k) {
        void *array = fem_take(body, wanted[k].count, wanted[k].size);
        if (!array) return no_memory(body, report);
        memcpy(wanted[k].at, &array, sizeof array);
    }
    return AB_OK;
}

/* Elements to blocks; and for each node its places in the forces that elements leave. */
static void lay_out(fem_body *body) {
    const size_t nodes = (size_t)body->element->nodes;
    const uint32_t *mesh = body->mesh->connectivity;
    for (size_t s = 0; s < body->blocks * 8; ++s) {
        const size_t e = s < body->elements ? s : body->elements - 1;
        for (size_t a = 0; a < nodes; ++a) body->connectivity[s / 8 * 8 * nodes + 8 * a + s % 8] = mesh[e * nodes + a];
    }
    for (size_t k = 0; k < body->elements * nodes; ++k) body->gather_start[mesh[k] + 1]++;
    for (size_t i = 0; i < body->nodes; ++i) body->gather_start[i + 1] += body->gather_start[i];
    for (size_t k = 0; k < body->elements * nodes; ++k) {
        const size_t e = k / nodes, a = k % nodes;
        body->gather[body->gather_start[mesh[k]]++] = (uint32_t)(e / 8 * 16 * nodes + 16 * a + e % 8);
    }
    for (size_t i = body->nodes; i > 0; --i) body->gather_start[i] = body->gather_start[i - 1];
    body->gather_start[0] = 0;
}

bool fem_on_axis(const fem_body *body, size_t node) {
    return body->element->axisymmetric && body->mesh->x[2 * node] <= 1e-9 * (body->mesh->high[0] - body->mesh->low[0]);
}

static ab_status weigh(fem_body *body, ab_report *report) {
    const size_t nodes = (size_t)body->element->nodes;
    for (size_t b = 0; b < body->blocks; ++b) {
        double x[2 * FEM_NODES][8] __attribute__((aligned(64))), mass[FEM_NODES][8] __attribute__((aligned(64)));
        fem_gather(body, b, body->x, x);
        body->element->mass(x, body->material->density, mass);
        for (int l = 0; l < fem_lanes(body, b); ++l)
            for (size_t a = 0; a < nodes; ++a) body->mass[body->connectivity[b * 8 * nodes + 8 * a + (size_t)l]] += mass[a][l];
    }
    for (size_t i = 0; i < body->nodes; ++i) {
        if (!(body->mass[i] > 0.0))
            return ab_report_error(report, body->domain.spec->mesh.mark, "body '%s': node %llu at (%.6g, %.6g) m has no mass: %g kg",
                                   body->domain.spec->name, (unsigned long long)(body->mesh->node_id ? body->mesh->node_id[i] : i),
                                   body->mesh->x[2 * i], body->mesh->x[2 * i + 1], body->mass[i]);
        body->inverse_mass[2 * i] = body->inverse_mass[2 * i + 1] = 1.0 / body->mass[i];
        if (fem_on_axis(body, i)) body->inverse_mass[2 * i] = 0.0;
    }
    return AB_OK;
}

static char *folder_of(const char *path) {
    const char *slash = strrchr(path, '/');
    if (!slash) return strdup(".");
    return strndup(path, slash == path ? 1 : (size_t)(slash - path));
}

static bool wants_grid(const fem_body *body) {
    for (size_t k = 0; k < body->scene->contact_count; ++k) {
        const ab_contact_spec *contact = body->scene->contacts + k;
        const bool mine = contact->body[0] == body->domain.index || contact->body[1] == body->domain.index;
        if (mine && (contact->finder->class_.needs & AB_NEED_SHARED_NODES)) return true;
    }
    return false;
}

static ab_status make(fem_body *body, ab_report *report) {
    const ab_body_spec *spec = body->domain.spec;
    char *folder = folder_of(body->scene->path ? body->scene->path : "");
    if (!folder) return no_memory(body, report);
    const ab_status read = fem_mesh_create(spec, folder, &body->mesh, report);
    free(folder);
    AB_TRY(read);
    body->nodes = body->mesh->node_count;
    body->elements = body->mesh->element_count;
    body->blocks = (body->elements + 7) / 8;
    body->blocks_per_group = FEM_GAUSS / body->element->gauss;
    if (body->blocks_per_group > FEM_GROUP) body->blocks_per_group = FEM_GROUP;
    body->groups = (body->blocks + (size_t)body->blocks_per_group - 1) / (size_t)body->blocks_per_group;
    body->runs = (body->nodes + FEM_RUN - 1) / FEM_RUN;
    const size_t busy = 1 + body->groups / FEM_GROUPS_PER_THREAD; /* small bodies are slower on many threads; the answer is the same */
    if ((size_t)body->threads > busy) body->threads = (int)busy;
    AB_TRY(fem_material_create(body, report));
    AB_TRY(take_arrays(body, report));
    lay_out(body);
    for (size_t k = 0; k < 2 * body->nodes; ++k) body->x[k] = body->x_start[k] = body->mesh->x[k] - body->origin[k % 2];
    AB_TRY(weigh(body, report));
    fem_faces *faces = NULL;
    AB_TRY(fem_faces_create(body->mesh, spec->name, &faces, report));
    ab_status status = fem_loads_create(body, faces, report);
    if (status == AB_OK) status = fem_held_create(body, faces, report);
    if (status == AB_OK) status = fem_edges_create(body, faces, report);
    if (status != AB_OK) {
        fem_faces_destroy(faces);
        return status;
    }
    AB_TRY(fem_outer_create(body, faces, report));
    for (size_t i = 0; i < body->nodes; ++i)
        for (size_t c = 0; c < 2; ++c) {
            const double *x = body->mesh->x + 2 * i, v = ab_number_at(spec->velocity + c, 0.0, x[0], x[1], 0.0);
            AB_TRY(ab_number_finite(spec->velocity + c, v, 0.0, x, report, "bodies.%s.velocity[%zu]", spec->name, c));
            body->velocity[2 * i + c] = c == 0 && fem_on_axis(body, i) ? 0.0 : v;
        }
    AB_TRY(fem_held_move(body, 0.0, body->scene->stage_count > 0 && body->scene->stages[0].made, report));
    memcpy(body->old, body->velocity, 2 * body->nodes * sizeof *body->old);
    AB_TRY(fem_elements_start(body, body->outer->faces, report));
    fem_critical(body, true);
    fem_nodes_measure(body);
    if (wants_grid(body)) AB_TRY(fem_inner_create(body, report));
    return fem_fields_create(body, report);
}

ab_status fem_create(const ab_scene *scene, size_t index, int threads, ab_domain **domain, ab_report *report) {
    const ab_body_spec *spec = scene->bodies + index;
    fem_body *body = calloc(1, sizeof *body);
    if (!body) return ab_report_failure(report, "no memory for body '%s'", spec->name);
    body->domain = (ab_domain){.ops = &OPS, .spec = spec, .dimension = 2, .index = index};
    body->scene = scene;
    body->element = scene->space == AB_SPACE_AXISYMMETRIC ? fem_element_axisymmetric_of(spec->mesh.type) : fem_element_of(spec->mesh.type);
    body->f_bar = spec->mesh.f_bar;
    body->hourglass = spec->mesh.hourglass;
    body->gravity = spec->gravity;
    body->threads = threads;
    body->material = scene->materials + spec->material;
    for (int c = 0; c < 2; ++c) body->origin[c] = scene->grid_from[c];
    const ab_status status = make(body, report);
    if (status != AB_OK) {
        destroy(&body->domain);
        return status;
    }
    *domain = &body->domain;
    return AB_OK;
}
