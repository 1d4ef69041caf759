/* contact.c: every contact of a scene in one step: find the points, then projected Gauss-Seidel over them in a fixed order: ask the response for the
 * impulse each point wants, change both sides' dofs by the difference, until the impulses stand still. Linear momentum is kept because a
 * point takes from one side what it gives to the other. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "contact/contact.h"
#include "core/checkpoint.h"

typedef struct contact_all {
    ab_interaction face; /* first */
    const ab_scene *scene;
    contact_pair *pairs;
    size_t count;
    ab_contact_totals *totals;
    double *friction, *contact;         /* per body */
    long found_step;                    /* step whose points are at hand; -1: none */
    long answered_step;                 /* step whose dynamic stage is done */
    double critical_dt;                 /* s, of the springs in the last dynamic stage; INFINITY: none */
    const contact_pair *limit_pair;     /* whose spring that is */
    double limit_stiffness, limit_mass; /* N/m, kg */
    char limit[256];                    /* the same in words */
} contact_all;

const double *contact_history(const contact_pair *pair, bool answered) {
    const ab_points *p = &pair->points.view;
    return (answered ? p->state1 : p->state0) + (pair->points.states - HISTORY) * p->ld;
}

/* How the dynamic stage has left each point. */
static void note_history(contact_pair *pair, double dt) {
    static const double NOTHING = 1e-12; /* of an impulse: less across the normal is rounding */
    ab_points *p = &pair->points.view;
    const size_t ld = p->ld;
    contact_side side[2];
    contact_sides(pair, side);
    double *history = p->state1 + (pair->points.states - HISTORY) * ld;
    for (size_t i = 0; i < p->count; ++i) {
        double v[2];
        contact_relative_velocity(side, false, i, v);
        const double nx = p->normal[i], ny = p->normal[ld + i], jx = p->impulse[i], jy = p->impulse[ld + i];
        const double jn = jx * nx + jy * ny, jt = jy * nx - jx * ny;
        history[HISTORY_STATUS * ld + i] = jx == 0.0 && jy == 0.0          ? STATUS_FREE
                                           : fabs(jt) > NOTHING * fabs(jn) ? STATUS_BOTH
                                                                           : STATUS_NORMAL;
        history[HISTORY_NORMAL * ld + i] = v[0] * nx + v[1] * ny;
        history[HISTORY_TANGENTIAL * ld + i] = v[1] * nx - v[0] * ny;
        history[HISTORY_FORCE * ld + i] = jn / dt;
        history[HISTORY_FRICTION * ld + i] = jt / dt;
    }
}

/* What the kinematic stage needed at each point. */
static void note_strain(contact_pair *pair, double dt) {
    const ab_points *p = &pair->points.view;
    const size_t ld = p->ld;
    double *history = p->state1 + (pair->points.states - HISTORY) * ld;
    for (size_t i = 0; i < p->count; ++i) {
        const double nx = p->normal[i], ny = p->normal[ld + i], jx = p->impulse[i], jy = p->impulse[ld + i];
        history[HISTORY_STRAIN * ld + i] = (jx * nx + jy * ny) / dt;
        history[HISTORY_SHEAR * ld + i] = (jy * nx - jx * ny) / dt;
    }
}

static void begin_with(contact_points *points, const contact_side side[2], size_t i, double jn, double jt) {
    ab_points *p = &points->view;
    const size_t ld = p->ld;
    if (jn == 0.0 && jt == 0.0) return;
    const double nx = p->normal[i], ny = p->normal[ld + i], j[2] = {jn * nx - jt * ny, jn * ny + jt * nx};
    for (size_t c = 0; c < 2; ++c) p->impulse[c * ld + i] = points->applied[c * ld + i] = j[c];
    contact_push(side, i, j);
}

/* Points from surfaces begin with the forces of the last step, each stage with its own. Where more of them push than there are freedoms (the two passes say much the
 * same twice) rounds that begin at nothing would share a force out between them by their order alone, whatever the gaps are; so what one step leaves undone the next
 * goes on with. row: HISTORY_*, of the force along the normal. status: of the points, which push along no other direction; NULL: any. */
static bool begin_with_last_forces(contact_pair *pair, const contact_side side[2], double dt, size_t row, const double *status) {
    contact_points *points = &pair->points;
    ab_points *p = &points->view;
    const size_t ld = p->ld;
    const double *force = p->state0 + (points->states - HISTORY + row) * ld;
    double *shared = points->spread.wanted ? contact_spread_room(points) : NULL;
    if (points->spread.wanted && !shared) return false;
    for (size_t i = 0; i < p->count; ++i) {
        const double jn = status && status[i] == STATUS_FREE ? 0.0 : dt * force[i],
                     jt = status && status[i] != STATUS_BOTH ? 0.0 : dt * force[ld + i];
        if (shared) {
            shared[i] = jn, shared[ld + i] = jt;
            continue;
        }
        begin_with(points, side, i, jn, jt);
    }
    if (!shared) return true;
    if (!contact_spread_forces(points, side)) return false;
    for (size_t i = 0; i < p->count; ++i) begin_with(points, side, i, shared[i], shared[ld + i]);
    return true;
}

/* The impulses of the last step, against which those of this one are held (unrest) where the rounds begin at nothing. */
static void recall_begun(contact_points *points, double dt) {
    ab_points *p = &points->view;
    const double *force = p->state0 + (points->states - HISTORY + HISTORY_FORCE) * p->ld;
    for (size_t i = 0; i < p->count; ++i) {
        const double jn = dt * force[i], jt = dt * force[p->ld + i], nx = p->normal[i], ny = p->normal[p->ld + i];
        points->begun[i] = jn * nx - jt * ny;
        points->begun[p->ld + i] = jn * ny + jt * nx;
    }
}

/* Before the first round of a stage: masses, fresh impulses, relative velocities at the start. */
static ab_status prepare(contact_pair *pair, const ab_step *step, ab_stage stage, bool answered, ab_report *report) {
    contact_points *points = &pair->points;
    ab_points *p = &points->view;
    contact_side side[2];
    contact_sides(pair, side);
    if (!contact_points_prepare(points, side, stage)) return ab_report_failure(report, "no memory for %zu contact points", p->count);
    for (size_t c = 0; c < 2; ++c) {
        memset(p->impulse + c * p->ld, 0, p->count * sizeof(double));
        memset(points->applied + c * p->ld, 0, p->count * sizeof(double));
    }
    memset(p->stiffness, 0, p->count * sizeof(double));
    for (size_t i = 0; i < p->count; ++i) {
        double v[2];
        contact_relative_velocity(side, true, i, v);
        points->relative_old[i] = v[0];
        points->relative_old[p->ld + i] = v[1];
    }
    if (!points->surfaces && !(points->give > 0.0)) {
        if (points->gives && stage == AB_STAGE_DYNAMIC) recall_begun(points, step->dt);
        return AB_OK;
    }
    if (points->surfaces && points->gives && stage == AB_STAGE_DYNAMIC && !contact_light_dofs(&points->light, side))
        return ab_report_failure(report, "no memory for what %zu contact points push on", p->count);
    const bool done = stage == AB_STAGE_DYNAMIC ? begin_with_last_forces(pair, side, step->dt, HISTORY_FORCE, NULL)
                                                : begin_with_last_forces(pair, side, step->dt, HISTORY_STRAIN,
                                                                         contact_history(pair, answered) + HISTORY_STATUS * p->ld);
    for (size_t c = 0; points->gives && c < 2; ++c) memcpy(points->begun + c * p->ld, p->impulse + c * p->ld, p->count * sizeof(double));
    return done ? AB_OK : ab_report_failure(report, "no memory for %zu contact points", p->count);
}

/* Forces, work and penetration of the step just solved. The work of an impulse is impulse . (old + new relative velocity)/2, exact for what it
 * does to the dofs' kinetic energy. Friction is the part that meets slip which goes on, tangential impulse . new slip: never negative for a law that opposes
 * slip, and zero where the points stick. All the rest is contact loss: what normal impulses take, and what stopping a slip at once takes. */
static void book(contact_all *all, size_t number, const ab_step *step) {
    contact_pair *pair = all->pairs + number;
    contact_points *points = &pair->points;
    const ab_points *p = &points->view;
    ab_contact_totals *t = all->totals + number;
    const double friction_work = t->friction_work, contact_work = t->contact_work;
    *t = (ab_contact_totals){.points = p->count, .failures = pair->failures, .list = p};
    contact_side side[2];
    contact_sides(pair, side);
    const double *area = p->measure_area && !points->surfaces && contact_carried_areas(points) ? points->carried : p->area;
    double friction = 0.0, loss = 0.0, tangential = 0.0;
    for (size_t i = 0; i < p->count; ++i) {
        const double jx = p->impulse[i], jy = p->impulse[p->ld + i], nx = p->normal[i], ny = p->normal[p->ld + i];
        if (p->gap[i] < 0.0) t->penetration = fmax(t->penetration, -p->gap[i]);
        if (jx == 0.0 && jy == 0.0) continue;
        double v[2];
        contact_relative_velocity(side, false, i, v);
        const double mx = 0.5 * (v[0] + points->relative_old[i]), my = 0.5 * (v[1] + points->relative_old[p->ld + i]);
        const double jn = jx * nx + jy * ny, jt = jy * nx - jx * ny, slip = v[1] * nx - v[0] * ny;
        friction += jt * slip;
        loss += jx * mx + jy * my - jt * slip;
        t->impulse[0] += jx;
        t->impulse[1] += jy;
        t->normal_force += fabs(jn) / step->dt;
        tangential += jt / step->dt;
        t->area += area[i];
        if (area[i] > 0.0 && !points->spread.wanted) t->peak_pressure = fmax(t->peak_pressure, jn / (area[i] * step->dt));
        t->moment +=
            ((p->position[i] + all->scene->grid_from[0]) * jy - (p->position[p->ld + i] + all->scene->grid_from[1]) * jx) / step->dt;
        ++t->active;
    }
    t->friction_force = fabs(tangential);
    for (int c = 0; c < 2; ++c) t->force[c] = t->impulse[c] / step->dt;
    t->friction_work = friction_work + friction;
    t->contact_work = contact_work + loss;
    for (int k = 0; k < 2; ++k) {
        all->friction[pair->spec->body[k]] += 0.5 * friction;
        all->contact[pair->spec->body[k]] += 0.5 * loss;
    }
}

/* A spring of stiffness k between masses whose effective mass is m swings with sqrt(k/m): stable below dt = 2 sqrt(m/k). */
static void note_springs(contact_all *all) {
    all->critical_dt = INFINITY;
    for (size_t k = 0; k < all->count; ++k) {
        const contact_pair *pair = all->pairs + k;
        const ab_points *p = &pair->points.view;
        for (size_t i = 0; i < p->count; ++i) {
            if (!(p->stiffness[i] > 0.0 && p->normal_mass[i] > 0.0)) continue;
            const double dt = 2.0 * sqrt(p->normal_mass[i] / p->stiffness[i]);
            if (!(dt < all->critical_dt)) continue;
            all->critical_dt = dt;
            all->limit_pair = pair;
            all->limit_stiffness = p->stiffness[i];
            all->limit_mass = p->normal_mass[i];
        }
    }
}

static double critical_dt(const ab_interaction *face, const char **limit) {
    contact_all *all = (contact_all *)(uintptr_t)face; /* only the words, and how bodies approach, are written */
    const contact_pair *fastest = NULL;
    double least = all->critical_dt;
    for (size_t k = 0; k < all->count; ++k) {
        contact_pair *pair = all->pairs + k;
        pair->approach = contact_approach_of(pair);
        if (pair->approach.speed * least > pair->approach.way) least = pair->approach.way / pair->approach.speed, fastest = pair;
    }
    if (fastest)
        snprintf(all->limit, sizeof all->limit, "'%.80s' and '%.80s' move at %.3g m/s against each other, in cells of %.3g m", fastest->a->spec->name,
                 fastest->b->spec->name, fastest->approach.speed, fastest->cell);
    else if (all->critical_dt < INFINITY)
        snprintf(all->limit, sizeof all->limit, "spring of contact between '%.80s' and '%.80s', %.3g N/m on %.3g kg",
                 all->limit_pair->a->spec->name, all->limit_pair->b->spec->name, all->limit_stiffness, all->limit_mass);
    *limit = all->limit;
    return least;
}

static ab_status solve(ab_interaction *face, const ab_step *step, ab_stage stage, ab_report *report) {
    contact_all *all = (contact_all *)face;
    const bool answered = all->answered_step == step->number;
    if (all->found_step != step->number) {
        for (size_t k = 0; k < all->count; ++k) {
            if (all->found_step >= 0 && !contact_points_remember(&all->pairs[k].points))
                return ab_report_failure(report, "no memory for what %zu contact points remember", all->pairs[k].points.view.count);
            contact_pair *pair = all->pairs + k;
            if (ab_domain_is_rigid(pair->a) || ab_domain_is_rigid(pair->b)) pair->approach = contact_approach_of(pair); /* given motions may leap */
            AB_TRY(contact_stop_passing(all->scene, pair, &pair->approach, step, report));
            AB_TRY(contact_find(pair, step, report));
            if (step->number == 0) contact_warn_of_overlap(all->scene, all->pairs + k, report);
        }
        all->found_step = step->number;
    }
    for (size_t k = 0; k < all->count; ++k)
        if (all->pairs[k].points.view.count) AB_TRY(prepare(all->pairs + k, step, stage, answered, report));
    AB_TRY(contact_rounds(all->pairs, all->count, stage, answered, report));
    if (stage == AB_STAGE_DYNAMIC) {
        all->answered_step = step->number;
        note_springs(all);
    } else {
        for (size_t k = 0; k < all->count; ++k)
            if (all->pairs[k].points.view.count) note_strain(all->pairs + k, step->dt);
    }
    return AB_OK;
}

static void point_to_history(const contact_pair *pair, ab_contact_totals *t) {
    const size_t ld = pair->points.view.ld;
    const double *history = contact_history(pair, true);
    t->normal = history + HISTORY_FORCE * ld;
    t->tangential = history + HISTORY_FRICTION * ld;
    t->slip = history + HISTORY_TANGENTIAL * ld;
}

static void point_to_pressures(const contact_points *points, ab_contact_totals *t) {
    if (!points->spread.force) return;
    t->pressure = points->spread.force + 2 * points->view.ld;
    t->shear = points->spread.force + 3 * points->view.ld;
}

/* What the results may write of the points: the impulses are the kinematic stage's from now on. */
static void show(contact_pair *pair, ab_contact_totals *t) {
    contact_points *points = &pair->points;
    point_to_history(pair, t);
    if (!points->spread.wanted) return;
    contact_side side[2];
    contact_sides(pair, side);
    t->peak_pressure = contact_spread_pressure(points, side, t->normal, t->tangential);
    point_to_pressures(points, t);
}

static void settle(ab_interaction *face, const ab_step *step) {
    contact_all *all = (contact_all *)face;
    for (size_t k = 0; k < all->count; ++k) {
        book(all, k, step);
        note_history(all->pairs + k, step->dt);
        show(all->pairs + k, all->totals + k);
    }
}

static const ab_contact_totals *totals(const ab_interaction *face) { return ((const contact_all *)face)->totals; }

static void book_body(const ab_interaction *face, size_t body, double *friction, double *contact) {
    const contact_all *all = (const contact_all *)face;
    *friction = all->friction[body];
    *contact = all->contact[body];
}

static void keep(ab_interaction *face, ab_checkpoint *c) {
    contact_all *all = (contact_all *)face;
    size_t limit = all->limit_pair ? (size_t)(all->limit_pair - all->pairs) : 0;
    bool good = ab_keep_long(c, "found_step", &all->found_step) && ab_keep_long(c, "answered_step", &all->answered_step) &&
                ab_keep_doubles(c, "critical_dt", &all->critical_dt, 1) && ab_keep_size(c, "limit_pair", &limit) &&
                ab_keep_doubles(c, "limit_stiffness", &all->limit_stiffness, 1) && ab_keep_doubles(c, "limit_mass", &all->limit_mass, 1) &&
                ab_keep_doubles(c, "friction", all->friction, all->scene->body_count) &&
                ab_keep_doubles(c, "contact", all->contact, all->scene->body_count);
    if (good && limit >= all->count) good = ab_checkpoint_refuse(c, "the limit of contact is damaged");
    if (good) all->limit_pair = all->pairs + limit;
    for (size_t k = 0; good && k < all->count; ++k) {
        contact_pair *pair = all->pairs + k;
        ab_contact_totals *t = all->totals + k;
        ab_checkpoint_enter(c, "contact[%zu]", k);
        good = contact_keep_pair(pair, c) && contact_keep_totals(t, c) && contact_keep_spread(&pair->points, c);
        ab_checkpoint_leave(c);
        if (!good || !ab_checkpoint_loads(c) || all->found_step < 0) continue;
        t->list = &pair->points.view;
        point_to_history(pair, t);
        if (pair->points.spread.wanted) point_to_pressures(&pair->points, t);
    }
}

static void destroy(ab_interaction *face) {
    contact_all *all = (contact_all *)face;
    for (size_t k = 0; all->pairs && k < all->count; ++k) {
        contact_pair *pair = all->pairs + k;
        if (pair->finder && pair->spec->finder->class_.destroy) pair->spec->finder->class_.destroy(pair->finder);
        if (pair->responder && pair->spec->responder->class_.destroy) pair->spec->responder->class_.destroy(pair->responder);
        contact_points_destroy(&pair->points);
        contact_broad_destroy(pair->broad);
        contact_faces_destroy(pair->faces);
        free(pair->tiles), free(pair->nodes_a), free(pair->nodes_b);
    }
    free(all->pairs), free(all->totals), free(all->friction), free(all->contact), free(all);
}

/* host->reserve for finders that make more points than there are shared nodes; context is the ab_service, found again through the view. */
static int reserve(void *context, ab_points *view, size_t points_more, size_t stencil_more) {
    (void)context;
    contact_points *points = (contact_points *)view; /* view is its first member */
    const size_t stencil = points_more + stencil_more + (view->count ? view->a_start[view->count] + view->b_start[view->count] : 0);
    return contact_points_reserve(points, view->count + points_more, stencil) ? 0 : -1;
}

static ab_status create_half(contact_pair *pair, const ab_loaded_class *loaded, const ab_value *settings, ab_service *service, void **self,
                             ab_report *report) {
    char who[96];
    snprintf(who, sizeof who, "contact '%s' of '%s' and '%s'", loaded->class_.name, pair->a->spec->name, pair->b->spec->name);
    ab_service_init(service, who);
    service->guarded = loaded->guarded;
    service->host.reserve = reserve;
    if (loaded->class_.create && loaded->class_.create(&service->host, settings, self) != 0)
        return ab_report_error(report, pair->spec->mark, "%s refused its settings: %s", who,
                               service->message[0] ? service->message : "no reason given");
    return AB_OK;
}

/* Of the softer body of a pair, kg/m3; 0: it is rigid. */
static double softer_density(const ab_scene *scene, const contact_pair *pair) {
    double least = INFINITY, density = 0.0;
    for (int side = 0; side < 2; ++side) {
        const ab_domain *body = side ? pair->b : pair->a;
        const double modulus = body->ops->modulus ? body->ops->modulus(body) : INFINITY;
        if (!(modulus < least) || body->spec->material == SIZE_MAX) continue;
        least = modulus;
        density = scene->materials[body->spec->material].density;
    }
    return density;
}

/* Its places of contact stay on it as it moves: those of points drift a little against the velocities that move them. */
static bool is_mesh(const ab_domain *body) { return ab_domain_is_rigid(body) || body->ops->cells; }

static bool is_of_points(const ab_domain *body) { return body->ops->node_tiles && !is_mesh(body); }

/* A tie, or friction that is to hold fast. */
static bool lets_nothing_slip(const ab_contact_spec *spec) {
    static const double ROUGH = 10.0;
    const ab_class *law = &spec->responder->class_;
    for (uint32_t k = 0; k < law->nparam; ++k)
        if (!strcmp(law->param[k].name, "friction") && law->param[k].type == AB_REAL && spec->responder_settings[k].real >= ROUGH) return true;
    return (law->needs & AB_NEED_FIXED_PLACES) != 0;
}

/* True where a monitor shows areas of a contact, or pressures. */
static bool shows_area(const ab_scene *scene, size_t contact) {
    for (size_t k = 0; k < scene->monitor_count; ++k) {
        const ab_monitor_spec *m = scene->monitors + k;
        if (m->contact == (int)contact && (!strcmp(m->value, "length") || !strcmp(m->value, "pressure.max"))) return true;
    }
    return false;
}

ab_status contact_create(const ab_scene *scene, ab_domain **domains, ab_interaction **interaction, ab_report *report) {
    contact_all *all = calloc(1, sizeof *all);
    if (!all) return ab_report_failure(report, "no memory for the contacts");
    all->face = (ab_interaction){destroy, solve, settle, totals, book_body, critical_dt, keep};
    all->scene = scene;
    all->found_step = all->answered_step = -1;
    all->critical_dt = INFINITY;
    all->pairs = calloc(scene->contact_count + 1, sizeof *all->pairs);
    all->totals = calloc(scene->contact_count + 1, sizeof *all->totals);
    all->friction = calloc(scene->body_count + 1, sizeof *all->friction);
    all->contact = calloc(scene->body_count + 1, sizeof *all->contact);
    ab_status status =
        all->pairs && all->totals && all->friction && all->contact ? AB_OK : ab_report_failure(report, "no memory for the contacts");
    for (size_t k = 0; status == AB_OK && k < scene->contact_count; ++k) {
        contact_pair *pair = all->pairs + k;
        const ab_contact_spec *spec = scene->contacts + k;
        pair->spec = spec;
        pair->a = domains[spec->body[0]];
        pair->b = domains[spec->body[1]];
        all->count = k + 1;
        pair->points.view.struct_size = sizeof(ab_points);
        pair->points.view.dimension = 2;
        pair->points.view.density = softer_density(scene, pair);
        pair->points.view.axisymmetric = scene->space == AB_SPACE_AXISYMMETRIC;
        pair->points.view.holds = lets_nothing_slip(spec);
        pair->points.surfaces = (spec->finder->class_.needs & AB_NEED_SURFACE) != 0;
        pair->points.meshes = is_mesh(pair->a) && is_mesh(pair->b);
        pair->points.view.fixed_places = pair->points.meshes && (spec->responder->class_.needs & AB_NEED_FIXED_PLACES);
        for (int side = 1; side >= 0; --side)
            if (pair->points.surfaces && scene->bodies[spec->body[side]].surface_points > 0.0)
                pair->points.spread = (contact_spread){.wanted = true, .side = side};
        /* Where forces may be undetermined: rounds.c. Not by surface points: they are no more than the freedoms under them. */
        pair->points.gives = !pair->points.spread.wanted && (is_of_points(pair->a) || is_of_points(pair->b)) &&
                             !(spec->responder->class_.needs & AB_NEED_GAP);
        pair->points.unrest = 1.0;
        pair->points.distances = (spec->responder->class_.needs & AB_NEED_DISTANCE) != 0;
        pair->points.view.measure_area = (ab_response_needs(spec) & AB_NEED_AREA) || shows_area(scene, k);
        pair->points.states = HISTORY;
        for (uint32_t s = 0; s < spec->responder->class_.nstate; ++s)
            for (int row = spec->responder->class_.state[s].shape == AB_VECTOR ? 2 : 1; row > 0; --row, ++pair->points.states)
                if (!pair->points.surfaces && spec->responder->class_.state[s].travel == AB_SUM && pair->points.states - HISTORY < 64)
                    pair->points.sums.rows |= (uint64_t)1 << (pair->points.states - HISTORY);
        status = contact_can_find(pair, report);
        if (status == AB_OK && pair->points.surfaces) status = contact_broad_create(scene, pair, report);
        if (status == AB_OK) pair->cell = pair->broad && !(scene->grid_cell > 0.0) ? contact_broad_cell(pair->broad) : scene->grid_cell;
        if (status == AB_OK) status = create_half(pair, spec->finder, spec->finder_settings, &pair->finder_service, &pair->finder, report);
        if (status == AB_OK)
            status = create_half(pair, spec->responder, spec->responder_settings, &pair->responder_service, &pair->responder, report);
    }
    if (status != AB_OK) {
        destroy(&all->face);
        return status;
    }
    *interaction = &all->face;
    return AB_OK;
}
