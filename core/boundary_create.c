/* boundary_create.c: boundaries made, unmade, and kept in checkpoints. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/boundary_inside.h"
#include "core/checkpoint.h"
#include "core/material.h"

static ab_status make(const ab_scene *scene, ab_domain **domains, ab_boundary *b, ab_report *report) {
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
        ab_boundary *b = all->list + k;
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
        ab_boundary *b = all->list + k;
        if (b->self && b->spec->loaded->class_.destroy) b->spec->loaded->class_.destroy(b->self);
        free(b->storage), free(b->flag);
    }
    free(all->list), free(all->totals), free(all->taken), free(all->rate2), free(all->sum), free(all);
}

/* ---- checkpoints --------------------------------------------------------------------------------------------------------- */

static bool keep_rows(ab_checkpoint *c, const char *name, double *values, size_t rows, const ab_boundary *b) {
    return ab_keep_doubles(c, name, values, rows * b->ld);
}

static bool keep_one(ab_boundary *b, ab_checkpoint *c) {
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
