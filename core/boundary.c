/* boundary.c: boundary plugins at work. See boundary.h. */
#include "core/boundary.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/checkpoint.h"
#include "core/material.h"

static const double STILL =
    1e-10; /* of the largest velocity of an edge, or of what its impulse alone would give it: a round that changes none by more was the last */
enum { MOST_ROUNDS = 500 };

typedef struct boundary {
    const ab_boundary_spec *spec;
    size_t number; /* of the scene */
    ab_domain *domain;
    ab_dofs dofs;
    ab_service service;
    void *self;
    size_t count, ld, states; /* states: rows */
    ab_edge_list list;        /* of this step */
    ab_edges view;            /* what the plugin sees */
    double *storage;          /* all the arrays of the view that the host fills or reads, and those below */
    bool active;              /* in this step; its displacements count from its first one */
    double *held;             /* Pa, 2 rows: what it carries besides */
    double *moved;            /* m, in the last step */
    double *base;             /* m/s, 2 rows: what of the velocity no dof's velocity of now has a part in */
    double *position, *displacement, *velocity, *traction, *damping, *stiffness, *prescribed, *state0, *state1;
    double *impulse;  /* N s, 2 rows, of this step */
    double *given[2]; /* last step's over dt and area, where the next one begins */
    double *answer;   /* 4 rows: of (1 + B S)^-1, which makes an impulse of what is missing of it */
    uint8_t *flag;
    ab_boundary_totals totals;
} boundary;

struct ab_boundaries {
    const ab_scene *scene;
    boundary *list;
    size_t count;
    ab_boundary_totals *totals;
    double *taken; /* J, per body */
    double *rate2; /* 1/s2, per body: square of the frequency that springs of boundaries alone could reach */
    double *sum;   /* per dof: stiffness there, N/m */
    size_t sum_room;
    char limit[200];
};

/* ---- edges and dofs ---------------------------------------------------------------------------------------------------- */

static void velocity_of(const boundary *b, const double *velocity, size_t stride, size_t e, double v[2]) {
    const ab_edge_list *l = &b->list;
    v[0] = v[1] = 0.0;
    for (size_t k = l->start[e]; k < l->start[e + 1]; ++k)
        for (size_t c = 0; c < 2; ++c) v[c] += l->weight[k] * velocity[l->dof[k] * stride + c];
}

/* The velocity at the start and what has changed of it. */
static void velocity_now(const boundary *b, size_t e, double v[2]) {
    const ab_edge_list *l = &b->list;
    const double *answer = l->answer ? l->answer : l->weight;
    for (size_t c = 0; c < 2; ++c) v[c] = b->base[c * b->ld + e];
    for (size_t k = l->start[e]; k < l->start[e + 1]; ++k)
        for (size_t c = 0; c < 2; ++c) v[c] += answer[k] * b->dofs.velocity[l->dof[k] * b->dofs.velocity_stride + c];
}

static void push(const boundary *b, size_t e, const double j[2]) {
    const ab_edge_list *l = &b->list;
    const ab_dofs *d = &b->dofs;
    for (size_t k = l->start[e]; k < l->start[e + 1]; ++k)
        for (size_t c = 0; c < 2; ++c) {
            d->velocity[l->dof[k] * d->velocity_stride + c] += l->weight[k] * j[c] * d->inverse_mass[l->dof[k] * d->mass_stride + c];
            if (d->impulse) d->impulse[2 * (size_t)l->dof[k] + c] += l->weight[k] * j[c];
        }
}

/* What an impulse along x (y) changes of the edge's velocity along x (y), 1/kg. */
static void response_of(const boundary *b, size_t e, double s[2]) {
    const ab_edge_list *l = &b->list;
    const double *answer = l->answer ? l->answer : l->weight;
    s[0] = s[1] = 0.0;
    for (size_t k = l->start[e]; k < l->start[e + 1]; ++k)
        for (size_t c = 0; c < 2; ++c) s[c] += l->weight[k] * answer[k] * b->dofs.inverse_mass[l->dof[k] * b->dofs.mass_stride + c];
}

/* d along the normal, across it: the tensor (xx, yy, xy) times `factor`. */
static void tensor_of(const boundary *b, const double *rows, size_t e, double factor, double t[3]) {
    const double nx = b->list.normal[e], ny = b->list.normal[b->list.ld + e], across = rows[b->ld + e], along = rows[e] - across;
    t[0] = factor * (across + along * nx * nx);
    t[1] = factor * (across + along * ny * ny);
    t[2] = factor * along * nx * ny;
}

/* ---- the plugin ---------------------------------------------------------------------------------------------------------- */

static ab_status complain(const boundary *b, const ab_step *step, size_t e, const char *what, ab_report *report) {
    const char *why = b->service.message;
    return ab_report_failure(report, "boundary '%s' on '%s' (boundaries[%zu]) %s at t = %.9g s (step %ld) near (%.6g, %.6g) m: %s",
                             b->spec->loaded->class_.name, b->domain->spec->name, b->number, what, step->time, step->number, b->position[e],
                             b->position[b->ld + e], why[0] ? why : "no reason given");
}

/* From here on displacements are counted, and what the body pulls with is held. */
static void begin_to_act(boundary *b) {
    const size_t ld = b->ld;
    memset(b->displacement, 0, 2 * ld * sizeof(double));
    memset(b->moved, 0, 2 * ld * sizeof(double));
    for (size_t c = 0; c < 2; ++c) {
        memset(b->given[c], 0, ld * sizeof(double));
        for (size_t e = 0; e < b->count; ++e) b->held[c * ld + e] = b->list.own_traction ? b->list.own_traction[c * b->list.ld + e] : 0.0;
    }
}

/* Where edges are and how they move, and what the plugin makes of it. */
static ab_status ask(const ab_boundaries *all, boundary *b, const ab_step *step, ab_report *report) {
    const bool began = b->active;
    b->active =
        !(step->stage < 64 && (b->spec->absent >> step->stage & 1u)) && (!step->settling || b->spec->loaded->class_.gives & AB_GIVE_MOTION);
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
            b->traction[c * ld + e] += b->held[c * ld + e];
            if (step->settling && !isnan(b->prescribed[c * ld + e])) b->prescribed[c * ld + e] = 0.0;
        }
    return AB_OK;
}

/* ---- impulses ------------------------------------------------------------------------------------------------------------ */

static bool is_held(const boundary *b, size_t e, size_t c) {
    return (b->spec->loaded->class_.gives & AB_GIVE_MOTION) && !isnan(b->prescribed[c * b->ld + e]);
}

/* Tractions as they are at the start, less what damping is expected to take: as it took in the last step. */
static void begin_impulses(boundary *b, const ab_step *step) {
    const uint32_t gives = b->spec->loaded->class_.gives;
    const size_t ld = b->ld;
    for (size_t e = 0; e < b->count; ++e) {
        const double area = b->list.area[e];
        double j[2] = {0.0, 0.0}, s[2];
        for (size_t c = 0; c < 2; ++c) {
            if (!is_held(b, e, c)) j[c] = step->dt * area * (b->traction[c * ld + e] - b->given[c][e]);
            b->impulse[c * ld + e] = j[c];
        }
        push(b, e, j);
        if (!(gives & AB_GIVE_DAMPING)) continue;
        response_of(b, e, s);
        double t[3];
        tensor_of(b, b->damping, e, 0.5 * step->dt * area, t);
        const double xx = 1.0 + t[0] * s[0], xy = t[2] * s[1], yx = t[2] * s[0], yy = 1.0 + t[1] * s[1], det = xx * yy - xy * yx;
        b->answer[e] = yy / det, b->answer[ld + e] = -xy / det, b->answer[2 * ld + e] = -yx / det, b->answer[3 * ld + e] = xx / det;
    }
}

/* One edge's impulse comes up to what its velocity asks for. Returns by how much its velocity changes, m/s; *largest: and how large it is. */
static double relax(boundary *b, const ab_step *step, size_t e, bool motion_only, double *largest) {
    const uint32_t gives = b->spec->loaded->class_.gives;
    const size_t ld = b->ld;
    double v[2], j[2] = {0.0, 0.0}, s[2];
    velocity_now(b, e, v);
    if (!motion_only && (gives & AB_GIVE_DAMPING)) {
        double t[3];
        const double area = step->dt * b->list.area[e], change[2] = {v[0] - b->velocity[e], v[1] - b->velocity[ld + e]};
        tensor_of(b, b->damping, e, 0.5 * area, t);
        const double rest[2] = {area * b->traction[e] - t[0] * change[0] - t[2] * change[1] - b->impulse[e],
                                area * b->traction[ld + e] - t[2] * change[0] - t[1] * change[1] - b->impulse[ld + e]};
        j[0] = b->answer[e] * rest[0] + b->answer[ld + e] * rest[1];
        j[1] = b->answer[2 * ld + e] * rest[0] + b->answer[3 * ld + e] * rest[1];
    }
    response_of(b, e, s);
    for (size_t c = 0; c < 2; ++c)
        if (is_held(b, e, c)) j[c] = s[c] > 0.0 ? (b->prescribed[c * ld + e] - v[c]) / s[c] : 0.0;
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
            boundary *b = all->list + k;
            if (!b->active || !(b->spec->loaded->class_.gives & wanted)) continue;
            for (size_t e = 0; e < b->count; ++e)
                if (b->list.area[e] > 0.0) change = fmax(change, relax(b, step, e, motion_only, &largest));
        }
        if (!(change > STILL * largest)) break;
    }
}

/* Frequencies that springs can reach: the largest row sum of the edges' stiffness through the masses of their dofs bounds them (Gershgorin 1931). */
static ab_status note_springs(ab_boundaries *all, ab_report *report) {
    memset(all->rate2, 0, all->scene->body_count * sizeof *all->rate2);
    for (size_t body = 0; body < all->scene->body_count; ++body) {
        size_t most = 0;
        for (size_t k = 0; k < all->count; ++k) {
            const boundary *b = all->list + k;
            if (!b->active || b->spec->body != body || !(b->spec->loaded->class_.gives & AB_GIVE_STIFFNESS)) continue;
            for (size_t i = 0; i < b->list.start[b->count]; ++i) most = b->list.dof[i] >= most ? (size_t)b->list.dof[i] + 1 : most;
        }
        if (most == 0) continue;
        if (most > all->sum_room) {
            free(all->sum);
            all->sum = malloc(2 * most * sizeof *all->sum);
            all->sum_room = all->sum ? 2 * most : 0;
            if (!all->sum) return ab_report_failure(report, "no memory for the springs of boundaries");
        }
        double largest = 0.0;
        for (int pass = 0; pass < 3; ++pass) /* clear, add up, look */
            for (size_t k = 0; k < all->count; ++k) {
                const boundary *b = all->list + k;
                const ab_edge_list *l = &b->list;
                if (!b->active || b->spec->body != body || !(b->spec->loaded->class_.gives & AB_GIVE_STIFFNESS)) continue;
                for (size_t e = 0; e < b->count; ++e) {
                    const double stiffness = l->area[e] * fmax(b->stiffness[e], b->stiffness[b->ld + e]);
                    double row = 0.0;
                    for (size_t i = l->start[e]; i < l->start[e + 1]; ++i) {
                        const double *inverse = b->dofs.inverse_mass + l->dof[i] * b->dofs.mass_stride;
                        if (pass == 0) all->sum[l->dof[i]] = 0.0;
                        if (pass == 1) all->sum[l->dof[i]] += fabs(l->weight[i]) * stiffness;
                        if (pass == 2) row += fabs(l->weight[i]) * all->sum[l->dof[i]] * fmax(inverse[0], inverse[1]);
                    }
                    largest = fmax(largest, row);
                }
            }
        all->rate2[body] = largest;
    }
    return AB_OK;
}

/* What moves an edge must be alone with it. Nodes that a side of the grid or a support holds would have to be torn from that: none but edges at rest can have them. */
static ab_status refuse_held(const boundary *b, ab_report *report) {
    static const double NEARLY_ALL = 0.9; /* of an edge's weight */
    for (size_t e = 0; e < b->count; ++e)
        for (size_t c = 0; c < 2; ++c) {
            if (!(b->list.area[e] > 0.0) || !is_held(b, e, c) || b->prescribed[c * b->ld + e] == 0.0) continue;
            double held = 0.0, weight = 0.0;
            for (size_t i = b->list.start[e]; i < b->list.start[e + 1]; ++i) {
                const double w = fabs(b->list.weight[i]);
                weight += w;
                if (b->dofs.inverse_mass[b->list.dof[i] * b->dofs.mass_stride + c] == 0.0) held += w;
            }
            if (held > NEARLY_ALL * weight)
                return ab_report_error(
                    report, b->spec->mark,
                    "boundaries[%zu] (%s) says how '%s' moves along %c near (%.6g, %.6g) m, where a side of the grid or `fix` "
                    "holds it: take one of the two away",
                    b->number, b->spec->loaded->class_.name, b->domain->spec->name, c ? 'y' : 'x', b->position[e], b->position[b->ld + e]);
        }
    return AB_OK;
}

/* Once: two that say how the same edge moves. */
static ab_status refuse_two(const ab_boundaries *all, const boundary *b, ab_report *report) {
    static const double SAME = 1e-9; /* of an edge's size */
    for (size_t k = 0; k < b->number; ++k) {
        const boundary *o = all->list + k;
        if (!o->active || o->domain != b->domain || !(o->spec->loaded->class_.gives & AB_GIVE_MOTION)) continue;
        for (size_t e = 0; e < b->count; ++e)
            for (size_t f = 0; f < o->count; ++f) {
                const double x = b->position[e], y = b->position[b->ld + e];
                const bool along = is_held(b, e, 0) && is_held(o, f, 0), across = is_held(b, e, 1) && is_held(o, f, 1);
                if ((along || across) && hypot(o->position[f] - x, o->position[o->ld + f] - y) <= SAME * b->list.area[e])
                    return ab_report_error(
                        report, b->spec->mark,
                        "boundaries[%zu] and boundaries[%zu] both say how '%s' moves along %c near (%.6g, %.6g) m: keep one "
                        "of them there",
                        o->number, b->number, b->domain->spec->name, along ? 'x' : 'y', x, y);
            }
    }
    return AB_OK;
}

ab_status ab_boundaries_apply(ab_boundaries *all, const ab_step *step, ab_report *report) {
    bool springs = false;
    for (size_t k = 0; k < all->count; ++k) {
        const bool began = all->list[k].active;
        AB_TRY(ask(all, all->list + k, step, report));
        if (all->list[k].active && (all->list[k].spec->loaded->class_.gives & AB_GIVE_MOTION)) {
            AB_TRY(refuse_held(all->list + k, report));
            if (!began) AB_TRY(refuse_two(all, all->list + k, report));
        }
        springs = springs || (all->list[k].spec->loaded->class_.gives & AB_GIVE_STIFFNESS);
    }
    if (springs) AB_TRY(note_springs(all, report));
    for (size_t k = 0; k < all->count; ++k)
        if (all->list[k].active) begin_impulses(all->list + k, step);
    rounds(all, step, false);
    for (size_t k = 0; k < all->count; ++k) {
        boundary *b = all->list + k;
        for (size_t c = 0; b->active && c < 2; ++c)
            for (size_t e = 0; e < b->count; ++e)
                b->given[c][e] = b->list.area[e] > 0.0 && !is_held(b, e, c)
                                     ? b->traction[c * b->ld + e] - b->impulse[c * b->ld + e] / (step->dt * b->list.area[e])
                                     : 0.0;
    }
    return AB_OK;
}

void ab_boundaries_hold(ab_boundaries *all, const ab_step *step) { rounds(all, step, true); }

/* ---- the ledger ---------------------------------------------------------------------------------------------------------- */

/* Work of the step's impulses, with the velocities that the dofs have now: impulse . (old + new)/2 is what it does to their kinetic energy. */
static void book(ab_boundaries *all, boundary *b, const ab_step *step) {
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
    b->totals.work += work;
    b->totals.other = b->totals.work + b->totals.dashpot + b->totals.spring;
    all->taken[b->spec->body] -= work;
}

/* Shares of one piece of outline move as the piece does. */
static void move_together(boundary *b) {
    const size_t ld = b->ld, group = b->list.group;
    for (size_t first = 0; first < b->count; first += group)
        for (size_t c = 0; c < 2; ++c) {
            double sum = 0.0, area = 0.0;
            for (size_t e = first; e < first + group; ++e) sum += b->list.area[e] * b->moved[c * ld + e], area += b->list.area[e];
            for (size_t e = first; e < first + group; ++e) b->moved[c * ld + e] = area > 0.0 ? sum / area : 0.0;
        }
}

void ab_boundaries_settle(ab_boundaries *all, const ab_step *step) {
    for (size_t k = 0; k < all->count; ++k) {
        boundary *b = all->list + k;
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
                t->force[c] += b->impulse[c * ld + e] / step->dt;
            }
            t->moment += (b->position[e] * b->impulse[ld + e] - b->position[ld + e] * b->impulse[e]) / step->dt;
            t->area += b->list.area[e];
        }
        if (b->active && b->list.group > 1) move_together(b);
        all->totals[k] = *t;
    }
}

void ab_boundaries_remap(ab_boundaries *all, const ab_step *step) {
    for (size_t k = 0; k < all->count; ++k) {
        boundary *b = all->list + k;
        if (!b->active || !b->domain->ops->remap) continue;
        book(all, b, step);
        all->totals[k] = b->totals;
    }
    rounds(all, step, true);
}

double ab_boundaries_taken(const ab_boundaries *all, size_t body) { return all->taken[body]; }
const ab_boundary_totals *ab_boundaries_totals(const ab_boundaries *all) { return all->totals; }

/* The body alone is stable up to dt = 2/w; with springs of frequency s beside it up to 2/sqrt(w^2 + s^2), as the largest frequency of a sum is no larger. */
double ab_boundaries_critical_dt(ab_boundaries *all, size_t body, double dt, const char **limit) {
    const double rate2 = all->rate2[body];
    if (!(rate2 > 0.0)) return dt;
    const double with = 1.0 / sqrt(1.0 / (dt * dt) + 0.25 * rate2);
    if (0.25 * rate2 * dt * dt > 1.0) {
        snprintf(all->limit, sizeof all->limit, "springs of boundaries on '%.80s', %.3g 1/s on its edges", all->scene->bodies[body].name,
                 sqrt(rate2));
        *limit = all->limit;
    }
    return with;
}

/* ---- making and unmaking ------------------------------------------------------------------------------------------------- */

static ab_status make(const ab_scene *scene, ab_domain **domains, boundary *b, ab_report *report) {
    const ab_boundary_spec *spec = b->spec;
    const ab_class *class_ = &spec->loaded->class_;
    b->domain = domains[spec->body];
    if (!b->domain->ops->edges)
        return ab_report_error(report, spec->mark,
                               "boundaries[%zu]: boundary plugins do not act on bodies of method %s in this version; on '%s' use %s",
                               b->number, b->domain->ops->method, b->domain->spec->name, "loads, or fix");
    const ab_step start = {.time = 0.0};
    AB_TRY(b->domain->ops->edges(b->domain, b->number, &start, &b->list, report));
    const size_t count = b->count = b->list.count, ld = b->ld = (count + 7) / 8 * 8;
    for (uint32_t s = 0; s < class_->nstate; ++s) b->states += (size_t)ab_state_components(class_->state[s].shape);
    const size_t rows = 2 * (2 + 2 + 2 + 2 + 2 + 2 + 2 + 2 + 2 + 2 + 2 + 1) + 4 + 2 * b->states;
    double *at = b->storage = calloc(rows * ld + 8, sizeof *b->storage);
    b->flag = calloc(ld + 1, 1);
    if (!at || !b->flag) return ab_report_failure(report, "no memory for %zu edges of boundaries[%zu]", count, b->number);
    double **const pairs[] = {&b->position, &b->displacement, &b->moved,     &b->held,       &b->base,   &b->velocity,
                              &b->traction, &b->damping,      &b->stiffness, &b->prescribed, &b->impulse};
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; ++k, at += 2 * ld) *pairs[k] = at;
    for (int c = 0; c < 2; ++c, at += ld) b->given[c] = at;
    b->answer = at, at += 4 * ld;
    b->state0 = at, b->state1 = at + b->states * ld;
    size_t row = 0;
    for (uint32_t s = 0; s < class_->nstate; ++s)
        for (int c = 0; c < ab_state_components(class_->state[s].shape); ++c, ++row)
            for (size_t e = 0; e < ld; ++e) b->state0[row * ld + e] = b->state1[row * ld + e] = class_->state[s].initial;
    b->view = (ab_edges){.struct_size = sizeof b->view,
                         .dimension = 2,
                         .count = count,
                         .ld = ld,
                         .position = b->position,
                         .displacement = b->displacement,
                         .velocity = b->velocity,
                         .traction = b->traction,
                         .damping = class_->gives & AB_GIVE_DAMPING ? b->damping : NULL,
                         .stiffness = class_->gives & AB_GIVE_STIFFNESS ? b->stiffness : NULL,
                         .prescribed = class_->gives & AB_GIVE_MOTION ? b->prescribed : NULL,
                         .flag = b->flag};
    b->totals.edges = count;
    char who[96];
    snprintf(who, sizeof who, "boundary '%.30s' on '%.30s'", class_->name, scene->bodies[spec->body].name);
    ab_service_init(&b->service, who);
    b->service.guarded = spec->loaded->guarded;
    if (class_->create && class_->create(&b->service.host, spec->settings, &b->self) != 0)
        return ab_report_error(report, spec->mark, "%s refused its settings: %s", who,
                               b->service.message[0] ? b->service.message : "no reason given");
    return AB_OK;
}

ab_status ab_boundaries_create(const ab_scene *scene, ab_domain **domains, ab_boundaries **out, ab_report *report) {
    ab_boundaries *all = calloc(1, sizeof *all);
    if (!all) return ab_report_failure(report, "no memory for the boundaries");
    all->scene = scene;
    all->list = calloc(scene->boundary_count + 1, sizeof *all->list);
    all->totals = calloc(scene->boundary_count + 1, sizeof *all->totals);
    all->taken = calloc(scene->body_count + 1, sizeof *all->taken);
    all->rate2 = calloc(scene->body_count + 1, sizeof *all->rate2);
    ab_status status =
        all->list && all->totals && all->taken && all->rate2 ? AB_OK : ab_report_failure(report, "no memory for the boundaries");
    for (size_t k = 0; status == AB_OK && k < scene->boundary_count; ++k) {
        boundary *b = all->list + k;
        b->spec = scene->boundaries + k;
        b->number = k;
        all->count = k + 1;
        status = make(scene, domains, b, report);
        all->totals[k] = b->totals;
    }
    if (status != AB_OK) {
        ab_boundaries_destroy(all);
        return status;
    }
    *out = all;
    return AB_OK;
}

void ab_boundaries_destroy(ab_boundaries *all) {
    if (!all) return;
    for (size_t k = 0; k < all->count; ++k) {
        boundary *b = all->list + k;
        if (b->self && b->spec->loaded->class_.destroy) b->spec->loaded->class_.destroy(b->self);
        free(b->storage), free(b->flag);
    }
    free(all->list), free(all->totals), free(all->taken), free(all->rate2), free(all->sum), free(all);
}

/* ---- checkpoints --------------------------------------------------------------------------------------------------------- */

static bool keep_rows(ab_checkpoint *c, const char *name, double *values, size_t rows, const boundary *b) {
    return ab_keep_doubles(c, name, values, rows * b->ld);
}

static bool keep_one(boundary *b, ab_checkpoint *c) {
    size_t count = b->count;
    if (!ab_keep_size(c, "edges", &count)) return false;
    if (count != b->count) return ab_checkpoint_refuse(c, "boundaries[%zu] has %zu edges there and %zu here", b->number, count, b->count);
    ab_boundary_totals *t = &b->totals;
    return keep_rows(c, "displacement", b->displacement, 2, b) && keep_rows(c, "moved", b->moved, 2, b) &&
           keep_rows(c, "held", b->held, 2, b) && ab_keep_flags(c, "active", &b->active, 1) && keep_rows(c, "given_x", b->given[0], 1, b) &&
           keep_rows(c, "given_y", b->given[1], 1, b) && keep_rows(c, "states", b->state1, b->states, b) &&
           ab_keep_doubles(c, "force", t->force, 2) && ab_keep_doubles(c, "moment", &t->moment, 1) &&
           ab_keep_doubles(c, "impulse", t->impulse, 2) && ab_keep_doubles(c, "work", &t->work, 1) &&
           ab_keep_doubles(c, "dashpot", &t->dashpot, 1) && ab_keep_doubles(c, "spring", &t->spring, 1) &&
           ab_keep_doubles(c, "other", &t->other, 1) && ab_keep_doubles(c, "area", &t->area, 1) &&
           ab_keep_plugin(c, "plugin", &b->spec->loaded->class_, b->self);
}

void ab_boundaries_keep(ab_boundaries *all, ab_checkpoint *c) {
    bool good =
        ab_keep_doubles(c, "taken", all->taken, all->scene->body_count) && ab_keep_doubles(c, "rate2", all->rate2, all->scene->body_count);
    for (size_t k = 0; good && k < all->count; ++k) {
        ab_checkpoint_enter(c, "boundaries[%zu]", k);
        good = keep_one(all->list + k, c);
        ab_checkpoint_leave(c);
        all->totals[k] = all->list[k].totals;
    }
}
