/* loads.c: tractions and pressures on the outer faces, forces at nodes, and nodes whose velocity is given. A traction acts on the initial length of a face and keeps
 * its direction, as on material points; a pressure acts on the face as it lies now. Nodes get the integrals of their basis functions along the face. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "fem/domain.h"

/* ---- loads --------------------------------------------------------------------------------------------------------------- */

const double FEM_FACE_PLACE[FEM_FACE_PLACES] = {-0.7745966692414834, 0.0, 0.7745966692414834};
const double FEM_FACE_WEIGHT[FEM_FACE_PLACES] = {5.0 / 9, 8.0 / 9, 5.0 / 9};

fem_face_point fem_face_point_on(const double *pairs, const uint32_t node[3], double s) {
    const bool bent = node[2] != FEM_NONE;
    fem_face_point p = {.n = {0.5 * (1.0 - s), 0.5 * (1.0 + s), 0.0}};
    double d[3] = {-0.5, 0.5, 0.0};
    if (bent) {
        p = (fem_face_point){.n = {0.5 * s * (s - 1.0), 0.5 * s * (s + 1.0), 1.0 - s * s}};
        d[0] = s - 0.5, d[1] = s + 0.5, d[2] = -2.0 * s;
    }
    for (int k = 0; k < (bent ? 3 : 2); ++k)
        for (size_t c = 0; c < 2; ++c) {
            p.place[c] += p.n[k] * pairs[2 * (size_t)node[k] + c];
            p.run[c] += d[k] * pairs[2 * (size_t)node[k] + c];
        }
    return p;
}

/* Integrals of the basis functions along a face as it is drawn, m (of rings over the face, m2); the two of a linear one are the same to the last bit. */
static void face_shares(const double *pairs, const uint32_t node[3], bool rings, double share[3]) {
    share[0] = share[1] = share[2] = 0.0;
    for (int q = 0; q < FEM_FACE_PLACES; ++q) {
        const fem_face_point p = fem_face_point_on(pairs, node, FEM_FACE_PLACE[q]);
        const double length = FEM_FACE_WEIGHT[q] * hypot(p.run[0], p.run[1]) * (rings ? ab_circumference(p.place[0]) : 1.0);
        for (int k = 0; k < 3; ++k) share[k] += p.n[k] * length;
    }
    if (node[2] == FEM_NONE && !rings) share[0] = share[1] = 0.5 * (share[0] + share[1]);
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

/* The longest diagonal of the elements at a node, m. */
static double reach_of(const fem_mesh *mesh, uint32_t node) {
    double longest = 0.0;
    const size_t nodes = (size_t)mesh->nodes;
    for (size_t k = 0; k < nodes * mesh->element_count; ++k) {
        if (mesh->connectivity[k] != node) continue;
        const uint32_t *corner = mesh->connectivity + k / nodes * nodes;
        for (int a = 0; a < 2; ++a) {
            const double *from = mesh->x + 2 * (size_t)corner[a], *to = mesh->x + 2 * (size_t)corner[a + 2];
            longest = fmax(longest, hypot(to[0] - from[0], to[1] - from[1]));
        }
    }
    return longest;
}

/* A force acts on a node; one that is drawn beside the body is more often a slip than meant. */
static void warn_far(const fem_body *body, uint32_t spec, uint32_t node, ab_report *report) {
    const ab_load_spec *load = body->scene->loads + spec;
    const double *x = body->mesh->x + 2 * (size_t)node, far = hypot(x[0] - load->at[0], x[1] - load->at[1]);
    if (far > reach_of(body->mesh, node))
        ab_report_warning(
            report, load->mark,
            "loads[%u].at: (%g, %g) m is %.4g m from the nearest node of '%s', more than the size of an element; the force acts on that "
            "node, at (%.6g, %.6g) m",
            spec, load->at[0], load->at[1], far, body->domain.spec->name, x[0], x[1]);
}

static ab_status add_load(fem_body *body, const fem_load *load, ab_report *report) {
    if (!ab_memory_grow((void **)&body->loads, &body->load_capacity, body->load_count + 1, sizeof *body->loads))
        return ab_report_failure(report, "body '%s': no memory for its loads", body->domain.spec->name);
    body->loads[body->load_count++] = *load;
    return AB_OK;
}

static ab_status spread(fem_body *body, const fem_faces *faces, uint32_t spec, ab_report *report) {
    const ab_load_spec *load = body->scene->loads + spec;
    if (load->point) {
        const fem_load one = {.node = {nearest_node(body->mesh, load->at), FEM_NONE, FEM_NONE}, .spec = spec, .share = {1.0, 0.0, 0.0}};
        warn_far(body, spec, one.node[0], report);
        return add_load(body, &one, report);
    }
    const size_t before = body->load_count;
    for (size_t f = 0; f < faces->count; ++f) {
        if (!fem_where_face(&load->where, body->mesh, faces, f)) continue;
        fem_load one = {.spec = spec};
        memcpy(one.node, faces->vertex + 3 * f, sizeof one.node);
        face_shares(body->mesh->x, one.node, body->element->axisymmetric, one.share);
        AB_TRY(add_load(body, &one, report));
    }
    if (body->load_count > before) return AB_OK;
    return ab_report_error(report, load->mark,
                           "loads[%u] meets no outer face of '%s'; use side: left|right|top|bottom or a place on its outline", spec,
                           body->domain.spec->name);
}

ab_status fem_loads_create(fem_body *body, const fem_faces *faces, ab_report *report) {
    for (size_t k = 0; k < body->scene->load_count; ++k)
        if (body->scene->loads[k].body == body->domain.index) AB_TRY(spread(body, faces, (uint32_t)k, report));
    return AB_OK;
}

/* A pressure, or a traction that depends on the place: force = integral of N (-p n or t) along the face. */
static ab_status integrate(const fem_body *body, const ab_load_spec *spec, double time, fem_load *load, ab_report *report) {
    memset(load->force, 0, sizeof load->force);
    for (int q = 0; q < FEM_FACE_PLACES; ++q) {
        const fem_face_point start = fem_face_point_on(body->mesh->x, load->node, FEM_FACE_PLACE[q]);
        const double x = start.place[0], y = start.place[1];
        double per_run[2]; /* N: force along a unit of -1 .. 1 */
        if (spec->press) {
            const fem_face_point now = fem_face_point_on(body->x, load->node, FEM_FACE_PLACE[q]);
            const double p = ab_number_at(&spec->pressure, time, x, y, 0.0);
            AB_TRY(ab_number_finite(&spec->pressure, p, time, start.place, report, "loads[%u].pressure", load->spec));
            const double round = body->element->axisymmetric ? ab_circumference(now.place[0]) : 1.0;
            per_run[0] = -p * now.run[1] * round, per_run[1] = p * now.run[0] * round; /* the body is on the left of a face */
        } else {
            for (int c = 0; c < 2; ++c) {
                const double t = ab_number_at(spec->traction + c, time, x, y, 0.0);
                AB_TRY(ab_number_finite(spec->traction + c, t, time, start.place, report, "loads[%u].traction[%d]", load->spec, c));
                per_run[c] = hypot(start.run[0], start.run[1]) * t * (body->element->axisymmetric ? ab_circumference(x) : 1.0);
            }
        }
        for (int k = 0; k < 3; ++k)
            for (int c = 0; c < 2; ++c) load->force[k][c] += FEM_FACE_WEIGHT[q] * start.n[k] * per_run[c];
    }
    return AB_OK;
}

static bool uniform(const ab_load_spec *spec) {
    if (spec->point) return true;
    const unsigned used = ab_number_variables(spec->traction) | ab_number_variables(spec->traction + 1);
    return !spec->press && !(used & AB_VARIABLES_XY);
}

ab_status fem_loads_add(fem_body *body, const ab_step *step, ab_report *report) {
    const double time = step->time + 0.5 * step->dt;
    double force[2] = {0.0, 0.0};
    bool same = false;
    for (size_t k = 0; k < body->load_count; ++k) {
        fem_load *load = body->loads + k;
        const ab_load_spec *spec = body->scene->loads + load->spec;
        if (spec->absent >> step->stage & 1) {
            memset(load->force, 0, sizeof load->force);
            continue;
        }
        if (k == 0 || load->spec != load[-1].spec) {
            same = uniform(spec);
            for (int c = 0; c < 2 && same; ++c) {
                const ab_number *number = (spec->point ? spec->force : spec->traction) + c;
                force[c] = ab_number_at(number, time, 0.0, 0.0, 0.0);
                AB_TRY(ab_number_finite(number, force[c], time, NULL, report, "loads[%u].%s[%d]", load->spec,
                                        spec->point ? "force" : "traction", c));
            }
        }
        if (same)
            for (int a = 0; a < 3; ++a)
                for (int c = 0; c < 2; ++c) load->force[a][c] = load->share[a] * force[c];
        else
            AB_TRY(integrate(body, spec, time, load, report));
        for (int a = 0; a < 3 && load->node[a] != FEM_NONE; ++a)
            for (size_t c = 0; c < 2; ++c) body->force[2 * (size_t)load->node[a] + c] += load->force[a][c];
    }
    return AB_OK;
}

void fem_loads_work(fem_body *body, const ab_step *step) {
    for (size_t k = 0; k < body->load_count; ++k) {
        const fem_load *load = body->loads + k;
        for (int a = 0; a < 3 && load->node[a] != FEM_NONE; ++a)
            for (size_t c = 0; c < 2; ++c) {
                const size_t d = 2 * (size_t)load->node[a] + c;
                body->energy.external += step->dt * load->force[a][c] * 0.5 * (body->velocity[d] + body->old[d]);
            }
    }
}

/* ---- nodes whose velocity is given --------------------------------------------------------------------------------------- */

/* Whether two formulas give the node that stood at `place` the same velocity all the time; looked at here and there in the run. */
static bool same_velocity(const ab_number *a, const ab_number *b, double end, const double place[2]) {
    enum { LOOKS = 8 };
    for (int k = 0; k < LOOKS; ++k) {
        const double t = end * k / LOOKS * 0.987;
        if (ab_number_of(a, t, place, place) != ab_number_of(b, t, place, place)) return false;
    }
    return true;
}

/* Warns, once an entry, where it takes the place of an earlier one that says something else: in one direction, at nodes of both. */
static void warn_conflict(const fem_body *body, size_t entry, const uint32_t *fix, const fem_faces *faces, ab_report *report) {
    const ab_body_spec *spec = body->domain.spec;
    const ab_fix_spec *last = spec->fix + entry;
    size_t other = SIZE_MAX, node = 0, many = 0;
    int direction = 0;
    for (size_t d = 0; d < 2 * body->nodes; ++d) {
        const size_t before = fix[d] ? fix[d] - 1 : SIZE_MAX;
        if (before == SIZE_MAX || !last->has[d % 2] || (other != SIZE_MAX && before != other)) continue;
        if (!fem_where_node(&last->where, body->mesh, faces, (uint32_t)(d / 2))) continue;
        if (!~(last->absent | spec->fix[before].absent)) continue; /* never both */
        if (before != other &&
            same_velocity(spec->fix[before].velocity + d % 2, last->velocity + d % 2, body->scene->time_end, body->mesh->x + 2 * (d / 2)))
            continue;
        if (other == SIZE_MAX) other = before, node = d / 2, direction = (int)(d % 2);
        many += (int)(d % 2) == direction;
    }
    if (other == SIZE_MAX) return;
    char line[32] = "";
    if (spec->fix[other].where.mark.line > 0) snprintf(line, sizeof line, " (line %d)", spec->fix[other].where.mark.line);
    ab_report_warning(
        report, last->where.mark,
        "bodies.%s.fix[%zu] gives %zu node%s another velocity along %c than fix[%zu]%s, the first at (%.6g, %.6g) m; the last entry "
        "holds, fix[%zu]: leave the node out of one of them, or write null for that direction",
        spec->name, entry, many, many == 1 ? "" : "s", direction ? 'y' : 'x', other, line, body->mesh->x[2 * node],
        body->mesh->x[2 * node + 1], entry);
}

static void hold(fem_body *body, size_t d, uint32_t fix) {
    body->held[body->held_count++] = (fem_held){.node = (uint32_t)(d / 2), .component = (uint32_t)(d % 2), .fix = fix};
    body->inverse_mass[d] = 0.0;
}

/* True where not all of them hold in all stages. */
static bool differs(const ab_body_spec *spec) {
    for (size_t f = 0; f < spec->fix_count; ++f)
        if (spec->fix[f].absent) return true;
    return false;
}

ab_status fem_held_choose(fem_body *body, const fem_faces *faces, size_t stage, ab_report *report) {
    const ab_body_spec *spec = body->domain.spec;
    if (!differs(spec)) return AB_OK;
    uint32_t *fix = ab_memory_take(2 * body->nodes * sizeof *fix); /* as in fem_held_create */
    if (!fix) return ab_report_failure(report, "body '%s': no memory for the nodes it is fixed at", spec->name);
    for (size_t k = 0; k < body->held_count; ++k) {
        const size_t i = body->held[k].node;
        body->inverse_mass[2 * i + body->held[k].component] =
            body->held[k].component == 0 && fem_on_axis(body, i) ? 0.0 : 1.0 / body->mass[i];
    }
    for (size_t f = 0; f < spec->fix_count; ++f)
        for (size_t i = 0; !(spec->fix[f].absent >> stage & 1) && i < body->nodes; ++i)
            if (fem_where_node(&spec->fix[f].where, body->mesh, faces, (uint32_t)i))
                for (size_t c = 0; c < 2; ++c)
                    if (spec->fix[f].has[c]) fix[2 * i + c] = (uint32_t)f + 1;
    body->held_count = 0;
    for (size_t d = 0; d < 2 * body->nodes; ++d)
        if (fix[d]) hold(body, d, fix[d] - 1);
    ab_memory_give(fix, 2 * body->nodes * sizeof *fix);
    return AB_OK;
}

ab_status fem_held_create(fem_body *body, const fem_faces *faces, ab_report *report) {
    const ab_body_spec *spec = body->domain.spec;
    uint32_t *fix = ab_memory_take(2 * body->nodes *
                                   sizeof *fix); /* of each direction: one more than its entry, the last that says something; 0: free */
    if (!fix) return ab_report_failure(report, "body '%s': no memory for the nodes it is fixed at", spec->name);
    ab_status status = AB_OK;
    for (size_t f = 0; f < spec->fix_count; ++f) {
        bool met = false;
        if (f > 0) warn_conflict(body, f, fix, faces, report);
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
            if (fix[d]) hold(body, d, fix[d] - 1);
    }
    ab_memory_give(fix, 2 * body->nodes * sizeof *fix);
    return status == AB_OK && differs(spec) ? fem_held_choose(body, faces, 0, report) : status;
}

static bool differs_by_place(const ab_number *number) { return ab_number_variables(number) & AB_VARIABLES_START; }

ab_status fem_held_move(fem_body *body, double time, bool settling, ab_report *report) {
    const ab_body_spec *spec = body->domain.spec;
    for (size_t f = 0; f < 2 * spec->fix_count; ++f)
        if (spec->fix[f / 2].has[f % 2] && !differs_by_place(spec->fix[f / 2].velocity + f % 2)) {
            const ab_number *number = spec->fix[f / 2].velocity + f % 2;
            body->given[f] = settling ? 0.0 : ab_number_at(number, time, 0.0, 0.0, 0.0);
            AB_TRY(
                ab_number_finite(number, body->given[f], time, NULL, report, "bodies.%s.fix[%zu].velocity[%zu]", spec->name, f / 2, f % 2));
        }
    for (size_t k = 0; k < body->held_count; ++k) {
        const fem_held *held = body->held + k;
        const ab_number *number = spec->fix[held->fix].velocity + held->component;
        double *velocity = body->velocity + 2 * (size_t)held->node + held->component;
        *velocity = body->given[2 * (size_t)held->fix + held->component];
        if (!differs_by_place(number)) continue;
        const double *start = body->mesh->x + 2 * (size_t)held->node;
        *velocity = settling ? 0.0 : ab_number_of(number, time, start, start);
        AB_TRY(ab_number_finite(number, *velocity, time, start, report, "bodies.%s.fix[%u].velocity[%u]", spec->name, held->fix,
                                held->component));
    }
    return AB_OK;
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
