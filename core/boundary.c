/* boundary.c: boundary plugins at work. See boundary.h. */
#include "core/boundary_inside.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double STILL =
    1e-10; /* of the largest velocity of an edge, or of what its impulse alone would give it: a round that changes none by more was the last */
enum { MOST_ROUNDS = 500 };

/* ---- edges and dofs ---------------------------------------------------------------------------------------------------- */

static void velocity_of(const ab_boundary *b, const double *velocity, size_t stride, size_t e, double v[2]) {
    const ab_edge_list *l = &b->list;
    v[0] = v[1] = 0.0;
    for (size_t k = l->start[e]; k < l->start[e + 1]; ++k)
        for (size_t c = 0; c < 2; ++c) v[c] += l->weight[k] * velocity[l->dof[k] * stride + c];
}

/* The velocity at the start and what has changed of it. */
static void velocity_now(const ab_boundary *b, size_t e, double v[2]) {
    const ab_edge_list *l = &b->list;
    const double *answer = l->answer ? l->answer : l->weight;
    for (size_t c = 0; c < 2; ++c) v[c] = b->base[c * b->ld + e];
    for (size_t k = l->start[e]; k < l->start[e + 1]; ++k)
        for (size_t c = 0; c < 2; ++c) v[c] += answer[k] * b->dofs.velocity[l->dof[k] * b->dofs.velocity_stride + c];
}

static void push(const ab_boundary *b, size_t e, const double j[2]) {
    const ab_edge_list *l = &b->list;
    const ab_dofs *d = &b->dofs;
    for (size_t k = l->start[e]; k < l->start[e + 1]; ++k)
        for (size_t c = 0; c < 2; ++c) {
            d->velocity[l->dof[k] * d->velocity_stride + c] += l->weight[k] * j[c] * d->inverse_mass[l->dof[k] * d->mass_stride + c];
            if (d->impulse) d->impulse[2 * (size_t)l->dof[k] + c] += l->weight[k] * j[c];
        }
}

/* What an impulse along x (y) changes of the edge's velocity along x (y), 1/kg. */
static void response_of(const ab_boundary *b, size_t e, double s[2]) {
    const ab_edge_list *l = &b->list;
    const double *answer = l->answer ? l->answer : l->weight;
    s[0] = s[1] = 0.0;
    for (size_t k = l->start[e]; k < l->start[e + 1]; ++k)
        for (size_t c = 0; c < 2; ++c) s[c] += l->weight[k] * answer[k] * b->dofs.inverse_mass[l->dof[k] * b->dofs.mass_stride + c];
}

/* d along the normal, across it: the tensor (xx, yy, xy) times `factor`. */
static void tensor_of(const ab_boundary *b, const double *rows, size_t e, double factor, double t[3]) {
    const double nx = b->list.normal[e], ny = b->list.normal[b->list.ld + e], across = rows[b->ld + e], along = rows[e] - across;
    t[0] = factor * (across + along * nx * nx);
    t[1] = factor * (across + along * ny * ny);
    t[2] = factor * along * nx * ny;
}

/* ---- the plugin ---------------------------------------------------------------------------------------------------------- */

static ab_status complain(const ab_boundary *b, const ab_step *step, size_t e, const char *what, ab_report *report) {
    const char *why = b->service.message;
    char line[32] = "";
    if (b->spec->mark.line > 0) snprintf(line, sizeof line, ", line %d", b->spec->mark.line);
    return ab_report_failure(report, "boundary '%s' on '%s' (boundaries[%zu]%s) %s at t = %.9g s (step %ld) near (%.6g, %.6g) m: %s",
                             b->spec->loaded->class_.name, b->domain->spec->name, b->number, line, what, step->time, step->number,
                             b->position[e], b->position[b->ld + e], why[0] ? why : "no reason given");
}

/* From here on displacements are counted, and what the body pulls with is held. */
static void begin_to_act(ab_boundary *b) {
    const size_t ld = b->ld;
    memset(b->displacement, 0, 2 * ld * sizeof(double));
    memset(b->moved, 0, 2 * ld * sizeof(double));
    for (size_t c = 0; c < 2; ++c) {
        memset(b->given[c], 0, ld * sizeof(double));
        for (size_t e = 0; e < b->count; ++e) b->held[c * ld + e] = b->list.own_traction ? b->list.own_traction[c * b->list.ld + e] : 0.0;
    }
}

/* Where edges are and how they move, and what the plugin makes of it. */
static ab_status ask(const ab_boundaries *all, ab_boundary *b, const ab_step *step, ab_report *report) {
    const bool began = b->active;
    b->active =
        !(step->stage < 64 && (b->spec->absent >> step->stage & 1u)) && (!step->settling || b->spec->loaded->class_.gives & AB_GIVE_MOTION);
    b->begins = b->active && !began;
    if (!b->active) return AB_OK;
    AB_TRY(b->domain->ops->edges(b->domain, b->number, step, &b->list, report));
    b->domain->ops->dofs(b->domain, &b->dofs);
    if (!began) begin_to_act(b);
    const uint32_t gives = b->spec->loaded->class_.gives;
    const size_t ld = b->ld, count = b->count;
    for (size_t e = 0; e < count; ++e) {
        double v[2];
        velocity_of(b, b->dofs.velocity_old, b->dofs.old_stride, e, v);
        b->base[e] = b->base[ld + e] = 0.0;
        for (size_t k = b->list.start[e]; b->list.answer && k < b->list.start[e + 1]; ++k)
            for (size_t c = 0; c < 2; ++c)
                b->base[c * ld + e] +=
                    (b->list.weight[k] - b->list.answer[k]) * b->dofs.velocity_old[b->list.dof[k] * b->dofs.old_stride + c];
        for (size_t c = 0; c < 2; ++c) {
            b->position[c * ld + e] = b->list.position[c * b->list.ld + e] + all->scene->grid_from[c];
            b->displacement[c * ld + e] += b->moved[c * ld + e];
            b->moved[c * ld + e] = 0.0;
            b->velocity[c * ld + e] = v[c];
            b->traction[c * ld + e] = 0.0;
            if (gives & AB_GIVE_DAMPING) b->damping[c * ld + e] = 0.0;
            if (gives & AB_GIVE_STIFFNESS) b->stiffness[c * ld + e] = 0.0;
            if (gives & AB_GIVE_MOTION) b->prescribed[c * ld + e] = NAN;
        }
        b->flag[e] = 0;
    }
    double *const swap = b->state0; /* states of the last step are the old ones now */
    b->state0 = b->state1, b->state1 = swap;
    ab_edges *view = &b->view;
    view->time = step->time;
    view->dt = step->dt;
    view->normal = b->list.normal;
    view->area = b->list.area;
    view->density = b->list.density;
    view->p_wave_speed = b->list.p_wave_speed;
    view->s_wave_speed = b->list.s_wave_speed;
    view->state0 = b->states ? b->state0 : NULL;
    view->state1 = b->states ? b->state1 : NULL;
    b->service.message[0] = '\0';
    const int code = b->spec->loaded->boundary.apply(b->self, view);
    for (size_t e = 0; e < count; ++e)
        if (b->flag[e]) return complain(b, step, e, "gave up", report);
    if (code != 0)
        return complain(b, step, 0, code > 0 ? "asks for a smaller step, and steps are not cut: use a smaller dt or cfl," : "gave up",
                        report);
    for (size_t e = 0; e < count; ++e) {
        if (!(b->list.area[e] > 0.0)) continue;
        for (size_t c = 0; c < 2; ++c) {
            if (!isfinite(b->traction[c * ld + e])) return complain(b, step, e, "gave a traction that is no finite number", report);
            if ((gives & AB_GIVE_DAMPING) && !(b->damping[c * ld + e] >= 0.0 && isfinite(b->damping[c * ld + e])))
                return complain(b, step, e, "gave a damping that is negative or no finite number", report);
            if ((gives & AB_GIVE_STIFFNESS) && !(b->stiffness[c * ld + e] >= 0.0 && isfinite(b->stiffness[c * ld + e])))
                return complain(b, step, e, "gave a stiffness that is negative or no finite number", report);
            if ((gives & AB_GIVE_MOTION) && isinf(b->prescribed[c * ld + e]))
                return complain(b, step, e, "prescribed a velocity that is no finite number", report);
        }
    }
    for (size_t e = 0; e < count; ++e)
        for (size_t c = 0; c < 2; ++c) {
            if (!b->list.own_force) b->traction[c * ld + e] += b->held[c * ld + e];
            if (step->settling && !isnan(b->prescribed[c * ld + e])) b->prescribed[c * ld + e] = 0.0;
        }
    return AB_OK;
}

/* ---- impulses ------------------------------------------------------------------------------------------------------------ */

/* Impulse, N s, of what an edge carries by its nodes. */
static double carried(const ab_boundary *b, size_t e, size_t c, double dt) { return b->list.own_force ? dt * b->held[c * b->ld + e] : 0.0; }

/* Tractions as they are at the start, less what damping is expected to take: as it took in the last step. */
static void begin_impulses(ab_boundary *b, const ab_step *step) {
    const uint32_t gives = b->spec->loaded->class_.gives;
    const double dt = ab_boundary_acts(step);
    const size_t ld = b->ld;
    for (size_t e = 0; e < b->count; ++e) {
        const double area = b->list.area[e];
        double j[2] = {0.0, 0.0}, s[2];
        for (size_t c = 0; c < 2; ++c) {
            if (!ab_boundary_holds(b, e, c)) {
                j[c] = dt * area * (b->traction[c * ld + e] - b->given[c][e]);
                j[c] += carried(b, e, c, dt);
            }
            b->impulse[c * ld + e] = j[c];
        }
        push(b, e, j);
        if (!(gives & AB_GIVE_DAMPING)) continue;
        response_of(b, e, s);
        double t[3];
        tensor_of(b, b->damping, e, 0.5 * dt * area, t);
        const double xx = 1.0 + t[0] * s[0], xy = t[2] * s[1], yx = t[2] * s[0], yy = 1.0 + t[1] * s[1], det = xx * yy - xy * yx;
        b->answer[e] = yy / det, b->answer[ld + e] = -xy / det, b->answer[2 * ld + e] = -yx / det, b->answer[3 * ld + e] = xx / det;
    }
}

/* One edge's impulse comes up to what its velocity asks for. Returns by how much its velocity changes, m/s; *largest: and how large it is. */
static double relax(ab_boundary *b, const ab_step *step, size_t e, bool motion_only, double *largest) {
    const uint32_t gives = b->spec->loaded->class_.gives;
    const size_t ld = b->ld;
    double v[2], j[2] = {0.0, 0.0}, s[2];
    velocity_now(b, e, v);
    if (!motion_only && (gives & AB_GIVE_DAMPING)) {
        double t[3];
        const double dt = ab_boundary_acts(step), area = dt * b->list.area[e],
                     change[2] = {v[0] - b->velocity[e], v[1] - b->velocity[ld + e]};
        tensor_of(b, b->damping, e, 0.5 * area, t);
        double rest[2] = {area * b->traction[e] - t[0] * change[0] - t[2] * change[1] - b->impulse[e],
                          area * b->traction[ld + e] - t[2] * change[0] - t[1] * change[1] - b->impulse[ld + e]};
        for (size_t c = 0; c < 2; ++c) rest[c] += carried(b, e, c, dt);
        j[0] = b->answer[e] * rest[0] + b->answer[ld + e] * rest[1];
        j[1] = b->answer[2 * ld + e] * rest[0] + b->answer[3 * ld + e] * rest[1];
    }
    response_of(b, e, s);
    for (size_t c = 0; c < 2; ++c)
        if (ab_boundary_holds(b, e, c)) j[c] = s[c] > 0.0 ? (b->prescribed[c * ld + e] - v[c]) / s[c] : 0.0;
    for (size_t c = 0; c < 2; ++c) b->impulse[c * ld + e] += j[c];
    push(b, e, j);
    *largest = fmax(*largest, fmax(fmax(fabs(v[0]), fabs(v[1])), fmax(fabs(b->velocity[e]), fabs(b->velocity[ld + e]))));
    *largest = fmax(*largest, fmax(fabs(b->impulse[e] * s[0]), fabs(b->impulse[ld + e] * s[1])));
    return fmax(fabs(j[0] * s[0]), fabs(j[1] * s[1]));
}

static void rounds(ab_boundaries *all, const ab_step *step, bool motion_only) {
    const uint32_t wanted = motion_only ? AB_GIVE_MOTION : AB_GIVE_MOTION | AB_GIVE_DAMPING;
    for (int round = 0; round < MOST_ROUNDS; ++round) {
        double change = 0.0, largest = 0.0;
        for (size_t k = 0; k < all->count; ++k) {
            ab_boundary *b = all->list + k;
            if (!b->active || !(b->spec->loaded->class_.gives & wanted)) continue;
            for (size_t e = 0; e < b->count; ++e)
                if (b->list.area[e] > 0.0) change = fmax(change, relax(b, step, e, motion_only, &largest));
        }
        if (!(change > STILL * largest)) break;
    }
}

ab_status ab_boundaries_apply(ab_boundaries *all, const ab_step *step, ab_report *report) {
    const double dt = ab_boundary_acts(step);
    bool springs = false, takes_over = false;
    for (size_t k = 0; k < all->count; ++k) {
        const bool began = all->list[k].active;
        AB_TRY(ask(all, all->list + k, step, report));
        if (all->list[k].active && (all->list[k].spec->loaded->class_.gives & AB_GIVE_MOTION)) {
            AB_TRY(ab_boundary_refuse_held(all->list + k, report));
            if (!began) AB_TRY(ab_boundary_refuse_two(all, all->list + k, report));
        }
        springs = springs || (all->list[k].spec->loaded->class_.gives & AB_GIVE_STIFFNESS);
        takes_over = takes_over || (all->list[k].begins && all->list[k].list.own_force);
    }
    if (takes_over) AB_TRY(ab_boundary_take_over(all, report));
    if (springs) AB_TRY(ab_boundary_note_springs(all, report));
    for (size_t k = 0; k < all->count; ++k)
        if (all->list[k].active) begin_impulses(all->list + k, step);
    rounds(all, step, false);
    for (size_t k = 0; k < all->count; ++k) {
        ab_boundary *b = all->list + k;
        for (size_t c = 0; b->active && c < 2; ++c)
            for (size_t e = 0; e < b->count; ++e)
                b->given[c][e] =
                    b->list.area[e] > 0.0 && !ab_boundary_holds(b, e, c)
                        ? b->traction[c * b->ld + e] - (b->impulse[c * b->ld + e] - carried(b, e, c, dt)) / (dt * b->list.area[e])
                        : 0.0;
    }
    return AB_OK;
}

void ab_boundaries_hold(ab_boundaries *all, const ab_step *step) { rounds(all, step, true); }

/* ---- the ledger ---------------------------------------------------------------------------------------------------------- */

/* Work of the step's impulses, with the velocities that the dofs have now: impulse . (old + new)/2 is what it does to their kinetic energy. */
static void book(ab_boundaries *all, ab_boundary *b, const ab_step *step) {
    const uint32_t gives = b->spec->loaded->class_.gives;
    const size_t ld = b->ld;
    double work = 0.0;
    for (size_t e = 0; e < b->count; ++e) {
        double v[2], mean[2];
        velocity_of(b, b->dofs.velocity, b->dofs.velocity_stride, e, v);
        for (size_t c = 0; c < 2; ++c) {
            mean[c] = 0.5 * (v[c] + b->velocity[c * ld + e]);
            work += b->impulse[c * ld + e] * mean[c];
        }
        double t[3];
        const double area = step->dt * b->list.area[e];
        if (gives & AB_GIVE_DAMPING) {
            tensor_of(b, b->damping, e, area, t);
            b->totals.dashpot += t[0] * mean[0] * mean[0] + 2.0 * t[2] * mean[0] * mean[1] + t[1] * mean[1] * mean[1];
        }
        if (gives & AB_GIVE_STIFFNESS) {
            const double ux = b->displacement[e], uy = b->displacement[ld + e];
            tensor_of(b, b->stiffness, e, area, t);
            b->totals.spring += (t[0] * ux + t[2] * uy) * mean[0] + (t[2] * ux + t[1] * uy) * mean[1];
        }
    }
    work *= step->dt /
            ab_boundary_acts(step); /* for the whole of a step from rest, as that of all forces: bodies book the half that is too much */
    b->totals.work += work;
    b->totals.other = b->totals.work + b->totals.dashpot + b->totals.spring;
    all->taken[b->spec->body] -= work;
}

/* Shares of one piece of outline move as the piece does. */
static void move_together(ab_boundary *b) {
    const size_t ld = b->ld, group = b->list.group;
    for (size_t first = 0; first < b->count; first += group)
        for (size_t c = 0; c < 2; ++c) {
            double sum = 0.0, area = 0.0;
            for (size_t e = first; e < first + group; ++e) sum += b->list.area[e] * b->moved[c * ld + e], area += b->list.area[e];
            for (size_t e = first; e < first + group; ++e) b->moved[c * ld + e] = area > 0.0 ? sum / area : 0.0;
        }
}

void ab_boundaries_settle(ab_boundaries *all, const ab_step *step) {
    const double dt = ab_boundary_acts(step);
    for (size_t k = 0; k < all->count; ++k) {
        ab_boundary *b = all->list + k;
        const size_t ld = b->ld;
        ab_boundary_totals *t = &b->totals;
        if (b->active && !b->domain->ops->remap) book(all, b, step);
        t->force[0] = t->force[1] = t->moment = t->area = 0.0;
        for (size_t e = 0; b->active && e < b->count; ++e) {
            double v[2];
            velocity_now(b, e, v);
            for (size_t c = 0; c < 2; ++c) {
                b->moved[c * ld + e] = step->dt * v[c];
                t->impulse[c] += b->impulse[c * ld + e];
                t->force[c] += b->impulse[c * ld + e] / dt;
            }
            t->moment += (b->position[e] * b->impulse[ld + e] - b->position[ld + e] * b->impulse[e]) / dt;
            t->area += b->list.area[e];
        }
        if (b->active && b->list.group > 1) move_together(b);
        all->totals[k] = *t;
    }
}

void ab_boundaries_remap(ab_boundaries *all, const ab_step *step) {
    for (size_t k = 0; k < all->count; ++k) {
        ab_boundary *b = all->list + k;
        if (!b->active || !b->domain->ops->remap) continue;
        book(all, b, step);
        all->totals[k] = b->totals;
    }
    rounds(all, step, true);
}

double ab_boundaries_taken(const ab_boundaries *all, size_t body) { return all->taken[body]; }
const ab_boundary_totals *ab_boundaries_totals(const ab_boundaries *all) { return all->totals; }
