/* rigid_step.c: the motion of a rigid body: velocity and spin from forces or as given, place and angle from them, and the ledger of it.
 *
 * All impulses of a step act on the body as it lies at the start of the step, and their work is impulse times the mean of old and new velocity there: so the kinetic
 * energy changes by the sum of what is booked, and momentum and angular momentum by the impulses, to rounding. What the given part of the motion needs
 * is found last, as what is left over. */
#include <math.h>
#include <stdlib.h>

#include "fem/rigid.h"

static const double SAME_PLACE = 1e-12, RIGID_FIELD = 1e-9; /* of the body's size; of the largest speed */

static double formula(const ab_number *number, double time) { return ab_number_at(number, time, 0.0, 0.0, 0.0); }

/* A component of the given velocity, m/s, or (2) the given spin, 1/s; none while the scene settles. */
static ab_status motion_at(const rigid_body *body, int component, double time, bool settling, double *value, ab_report *report) {
    const ab_body_spec *spec = body->domain.spec;
    const ab_number *number = component < 2 ? spec->motion.velocity + component : &spec->motion.spin;
    static const char *const NAME[3] = {"velocity[0]", "velocity[1]", "spin"};
    *value = settling ? 0.0 : formula(number, time);
    return ab_number_finite(number, *value, time, NULL, report, "bodies.%s.motion.%s", spec->name, NAME[component]);
}

/* Half the diagonal of the vertices' box about the centre, m. */
static double size_of(const rigid_outline *o) {
    double far = 0.0;
    for (size_t k = 0; k < o->vertex_count; ++k) far = fmax(far, hypot(o->vertex[k][0] - o->centre[0], o->vertex[k][1] - o->centre[1]));
    return far;
}

static void velocity_of_mass(const rigid_body *body, const double offset[2], double v[2]) {
    v[0] = body->velocity[0] - body->spin * offset[1];
    v[1] = body->velocity[1] + body->spin * offset[0];
}

static double kinetic(const rigid_body *body, const double offset[2]) {
    double v[2];
    velocity_of_mass(body, offset, v);
    return 0.5 * body->mass * (v[0] * v[0] + v[1] * v[1]) + 0.5 * body->inertia * body->spin * body->spin;
}

/* Where it is measured from the scene's origin, with its velocity; offset: from the reference to the centre of mass as it is now. */
static void measure(rigid_body *body, const double offset[2]) {
    ab_motion *m = &body->motion;
    double v[2];
    velocity_of_mass(body, offset, v);
    m->mass = body->mass;
    for (int c = 0; c < 2; ++c) {
        m->centre[c] = body->centre[c] + body->origin[c];
        m->momentum[c] = body->mass * v[c];
    }
    m->angular_momentum[2] = body->inertia * body->spin + m->centre[0] * m->momentum[1] - m->centre[1] * m->momentum[0];
    body->energy.kinetic = kinetic(body, offset);
}

/* ---- start ---------------------------------------------------------------------------------------------------------------- */

/* Velocity at the reference and spin of the body's `velocity`, which must be that of a body that keeps its shape. */
static ab_status start_velocity(rigid_body *body, const double at[2], ab_report *report) {
    const ab_body_spec *spec = body->domain.spec;
    const double size = size_of(&body->outline);
    double v[2], beside[4][2], fastest = 0.0;
    static const double DIRECTION[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (int c = 0; c < 2; ++c) v[c] = ab_number_at(spec->velocity + c, 0.0, at[0], at[1], 0.0);
    for (int d = 0; d < 4; ++d)
        for (int c = 0; c < 2; ++c)
            beside[d][c] = ab_number_at(spec->velocity + c, 0.0, at[0] + size * DIRECTION[d][0], at[1] + size * DIRECTION[d][1], 0.0);
    const double spin = (beside[0][1] - beside[1][1] - beside[2][0] + beside[3][0]) / (4.0 * size);
    double worst = 0.0, where[2] = {0.0};
    for (size_t k = 0; k < body->outline.vertex_count; ++k) {
        const double *x = body->outline.vertex[k];
        double u[2], difference = 0.0;
        for (int c = 0; c < 2; ++c) {
            u[c] = ab_number_at(spec->velocity + c, 0.0, x[0], x[1], 0.0);
            difference += fabs(u[c] - v[c] - (c ? spin * (x[0] - at[0]) : -spin * (x[1] - at[1])));
        }
        fastest = fmax(fastest, hypot(u[0], u[1]));
        if (difference > worst || isnan(difference)) worst = difference, where[0] = x[0], where[1] = x[1];
    }
    if (!(worst <= RIGID_FIELD * fmax(fastest, hypot(v[0], v[1]))) || !isfinite(spin))
        return ab_report_error(report, spec->velocity[0].mark.line ? spec->velocity[0].mark : spec->mark,
                               "body '%s': its velocity is not that of a rigid body: at (%g, %g) m it differs by %.3g m/s; a rigid body "
                               "starts with [vx - w*(y - y0), vy + w*(x - x0)], vx, vy and the spin w being numbers",
                               spec->name, where[0], where[1], worst);
    for (int c = 0; c < 2; ++c) body->velocity[c] = v[c];
    body->spin = spin;
    return AB_OK;
}

static ab_status find_loads(rigid_body *body, ab_report *report) {
    const ab_scene *scene = body->scene;
    body->loads = malloc((scene->load_count + 1) * sizeof *body->loads);
    if (!body->loads) return ab_report_failure(report, "no memory for the loads of body '%s'", body->domain.spec->name);
    for (size_t k = 0; k < scene->load_count; ++k) {
        if (scene->loads[k].body != body->domain.index) continue;
        if (!scene->loads[k].point)
            return ab_report_error(report, scene->loads[k].mark,
                                   "loads[%zu]: '%s' is rigid and takes forces, not tractions; write at: [x, y], force: [fx, fy]", k,
                                   body->domain.spec->name);
        body->loads[body->load_count++] = (uint32_t)k;
    }
    return AB_OK;
}

ab_status rigid_motion_create(rigid_body *body, ab_report *report) {
    const ab_body_spec *spec = body->domain.spec;
    const ab_motion_spec *m = &spec->motion;
    const rigid_outline *o = &body->outline;
    for (int c = 0; c < 2; ++c) body->held[c] = m->has[c];
    body->held_spin = m->has_spin;
    if (m->has_center)
        for (int c = 0; c < 2; ++c) body->arm[c] = o->centre[c] - m->center[c];
    const double arm = hypot(body->arm[0], body->arm[1]);
    if (arm <= SAME_PLACE * size_of(o)) body->arm[0] = body->arm[1] = 0.0;
    const bool apart = body->arm[0] != 0.0 || body->arm[1] != 0.0;
    if (m->has_center && !m->has[0] && !m->has[1])
        return ab_report_error(report, spec->mark,
                               "body '%s': motion.center is the place that motion.velocity is of, and no velocity is given; add velocity: "
                               "[vx, vy], or leave center out",
                               spec->name);
    if (apart && !m->has_spin && m->has[0] != m->has[1])
        return ab_report_error(
            report, spec->mark,
            "body '%s': one direction of a place that is not the centre of mass is given while the body turns freely, which "
            "is not possible; give both directions (a hinge), or the spin, or leave motion.center out",
            spec->name);
    body->hinged = apart && !m->has_spin;
    body->cosine = 1.0;
    double reference[2];
    for (int c = 0; c < 2; ++c) {
        body->centre[c] = o->centre[c] - body->origin[c];
        body->given[c] = body->centre[c] - body->arm[c];
        body->offset[c] = body->hinged ? body->arm[c] : 0.0;
        reference[c] = o->centre[c] - body->offset[c];
        body->reference[c] = body->centre[c] - body->offset[c];
    }
    AB_TRY(start_velocity(body, reference, report));
    const bool settling = body->scene->stage_count > 0 && body->scene->stages[0].made;
    if (body->held_spin) AB_TRY(motion_at(body, 2, 0.0, settling, &body->spin, report));
    for (int c = 0; c < 2; ++c)
        if (body->held[c]) {
            AB_TRY(motion_at(body, c, 0.0, settling, body->velocity + c, report));
            if (!body->hinged) body->velocity[c] += c ? body->spin * body->arm[0] : -body->spin * body->arm[1];
        }
    AB_TRY(find_loads(body, report));
    measure(body, body->offset);
    return AB_OK;
}

/* ---- one step ------------------------------------------------------------------------------------------------------------- */

/* Place of a load from the reference, and the force there. */
static void load_of(const rigid_body *body, size_t k, const ab_step *step, double arm[2], double force[2]) {
    const ab_load_spec *load = body->scene->loads + body->loads[k];
    rigid_place(body, load->at, arm);
    for (int c = 0; c < 2; ++c) {
        arm[c] -= body->reference[c];
        force[c] = load->absent >> step->stage & 1 ? 0.0 : formula(load->force + c, step->time + 0.5 * step->dt);
    }
}

ab_status rigid_begin(ab_domain *domain, const ab_step *step, ab_report *report) {
    rigid_body *body = (rigid_body *)domain;
    for (int c = 0; c < 2; ++c) {
        body->old[c] = body->velocity[c];
        body->offset[c] = 0.0;
        body->weight[c] = body->gravity ? body->mass * step->gravity[c] : 0.0;
        body->force[c] = body->weight[c];
    }
    if (body->hinged) rigid_turn(body, body->arm, body->offset);
    for (int c = 0; c < 2; ++c) body->reference[c] = body->centre[c] - body->offset[c];
    body->spin_old = body->spin;
    body->impulse[0] = body->impulse[1] = body->impulse[2] = 0.0;
    body->force[2] = body->offset[0] * body->weight[1] - body->offset[1] * body->weight[0];
    for (size_t k = 0; k < body->load_count; ++k) {
        double arm[2], force[2];
        load_of(body, k, step, arm, force);
        for (int c = 0; c < 2; ++c) {
            AB_TRY(ab_number_finite(body->scene->loads[body->loads[k]].force + c, force[c], step->time + 0.5 * step->dt, NULL, report,
                                    "loads[%u].force[%d]", body->loads[k], c));
            body->force[c] += force[c];
        }
        body->force[2] += arm[0] * force[1] - arm[1] * force[0];
    }
    return rigid_surface_follow(body, report);
}

ab_status rigid_trial(ab_domain *domain, const ab_step *step, ab_report *report) {
    rigid_body *body = (rigid_body *)domain;
    const double middle = step->time + 0.5 * step->dt, dt = step->dt;
    const double *r = body->offset;
    if (body->held_spin) AB_TRY(motion_at(body, 2, middle, step->settling, &body->spin, report));
    const double turned = body->angle + dt * body->spin, c1 = cos(turned), s1 = sin(turned);
    for (int c = 0; c < 2; ++c) {
        if (!body->held[c]) {
            body->velocity[c] = body->old[c] + dt * body->force[c] / body->mass;
            continue;
        }
        AB_TRY(motion_at(body, c, middle, step->settling, body->velocity + c, report));
        if (body->hinged || (body->arm[0] == 0.0 && body->arm[1] == 0.0)) continue;
        /* the centre of mass goes straight to where the given place and angle put it */
        const double arm = c ? s1 * body->arm[0] + c1 * body->arm[1] : c1 * body->arm[0] - s1 * body->arm[1];
        body->velocity[c] += (body->given[c] + arm - body->centre[c]) / dt;
    }
    const double inertia = body->inertia + body->mass * (r[0] * r[0] + r[1] * r[1]);
    if (!body->held_spin) {
        const double jolt = r[0] * (body->velocity[1] - body->old[1]) - r[1] * (body->velocity[0] - body->old[0]);
        body->spin = body->spin_old + (dt * body->force[2] - (body->hinged ? body->mass * jolt : 0.0)) / inertia;
    }
    if (!isfinite(body->velocity[0]) || !isfinite(body->velocity[1]) || !isfinite(body->spin))
        return ab_report_failure(
            report,
            "body '%s': its velocity (%g, %g) m/s, spin %g 1/s is no finite number at t = %.9g s (step %ld); look at the "
            "formulas of its motion and of the forces on it, and at dt",
            domain->spec->name, body->velocity[0], body->velocity[1], body->spin, middle, step->number);
    for (int c = 0; c < 2; ++c) body->inverse_mass[c] = body->held[c] ? 0.0 : 1.0 / body->mass;
    body->inverse_inertia = body->held_spin ? 0.0 : 1.0 / inertia;
    body->open = true;
    return AB_OK;
}

/* Local damping of one freedom, as of every node: against the velocity, in proportion to its change. Returns the new velocity. */
static double damped(double old, double now, double factor, double mass, double *taken) {
    const double change = -copysign(fmin(factor * fabs(now - old), fabs(now)), now);
    *taken -= mass * change * 0.5 * (old + now + change);
    return now + change;
}

/* Work of gravity, loads and the given motion in this step; what that motion needed. */
static void book(rigid_body *body, const ab_step *step) {
    const double dt = step->dt, *r = body->offset;
    const double spin = 0.5 * (body->spin + body->spin_old);
    double mean[2], change[2];
    for (int c = 0; c < 2; ++c) mean[c] = 0.5 * (body->velocity[c] + body->old[c]);
    const double of_mass[2] = {mean[0] - spin * r[1], mean[1] + spin * r[0]};
    change[0] = body->velocity[0] - body->old[0] - (body->spin - body->spin_old) * r[1];
    change[1] = body->velocity[1] - body->old[1] + (body->spin - body->spin_old) * r[0];
    for (int c = 0; c < 2; ++c) body->energy.potential -= dt * body->weight[c] * of_mass[c];
    for (size_t k = 0; k < body->load_count; ++k) {
        double arm[2], force[2];
        load_of(body, k, step, arm, force);
        body->energy.external += dt * (force[0] * (mean[0] - spin * arm[1]) + force[1] * (mean[1] + spin * arm[0]));
    }
    double *reaction = body->reaction;
    for (int c = 0; c < 2; ++c) {
        reaction[c] = body->held[c] ? body->mass * change[c] / dt - body->impulse[c] / dt - body->force[c] : 0.0;
        body->energy.external += dt * reaction[c] * mean[c];
    }
    reaction[2] = body->held_spin ? (body->inertia * (body->spin - body->spin_old) - body->impulse[2]) / dt - body->force[2] : 0.0;
    body->energy.external += dt * reaction[2] * spin;
}

/* A hinge also turns the momentum of the body with it, which is no impulse of the step; it works where the hinge moves. */
static void book_turning(rigid_body *body, const ab_step *step, const double after[2]) {
    const double before = kinetic(body, body->offset);
    for (int c = 0; c < 2; ++c) {
        const double turned = after[!c] - body->offset[!c];
        body->reaction[c] += body->mass * (c ? body->spin : -body->spin) * turned / step->dt;
    }
    body->energy.external += kinetic(body, after) - before;
}

/* Forces alone; moments have another unit, and a body whose force is balanced and whose moment is not moves soon enough to be told by its kinetic energy. */
static void look_at_balance(rigid_body *body, const ab_step *step) {
    double out[2], from_outside[2];
    for (int c = 0; c < 2; ++c) {
        out[c] = body->held[c] ? 0.0 : body->mass * (body->velocity[c] - body->old[c]) / step->dt;
        from_outside[c] = body->held[c] ? 0.0 : body->force[c];
    }
    body->unbalanced = hypot(out[0], out[1]);
    body->applied = hypot(from_outside[0], from_outside[1]);
}

void rigid_balance(const ab_domain *domain, double *unbalanced, double *applied) {
    *unbalanced = ((const rigid_body *)domain)->unbalanced;
    *applied = ((const rigid_body *)domain)->applied;
}

void rigid_rest(ab_domain *domain, const ab_step *step) {
    rigid_body *body = (rigid_body *)domain;
    const double before = body->energy.kinetic;
    double offset[2] = {0.0, 0.0}, v[2];
    if (body->hinged) rigid_turn(body, body->arm, offset);
    velocity_of_mass(body, offset, v);
    const double weight = 0.5 * step->dt * (body->weight[0] * v[0] + body->weight[1] * v[1]); /* as of points: mpm/stages.c */
    for (int c = 0; c < 2; ++c)
        if (!body->held[c]) body->velocity[c] = 0.0;
    if (!body->held_spin) body->spin = 0.0;
    measure(body, offset);
    body->energy.damping += before - body->energy.kinetic + weight;
    body->energy.potential -= weight;
}

ab_status rigid_datum(ab_domain *domain, ab_report *report) {
    (void)report;
    rigid_body *body = (rigid_body *)domain;
    body->has_datum = true;
    body->datum[0] = body->centre[0], body->datum[1] = body->centre[1], body->datum[2] = body->angle;
    return AB_OK;
}

ab_status rigid_finish(ab_domain *domain, const ab_step *step, ab_report *report) {
    rigid_body *body = (rigid_body *)domain;
    const double dt = step->dt;
    body->open = false;
    if (step->measure) look_at_balance(body, step);
    if (step->damping > 0.0) {
        const double *r = body->offset, inertia = body->inertia + body->mass * (r[0] * r[0] + r[1] * r[1]);
        for (int c = 0; c < 2; ++c)
            if (!body->held[c])
                body->velocity[c] = damped(body->old[c], body->velocity[c], step->damping, body->mass, &body->energy.damping);
        if (!body->held_spin) body->spin = damped(body->spin_old, body->spin, step->damping, inertia, &body->energy.damping);
    }
    book(body, step);
    double offset[2] = {0.0, 0.0}, arm[2];
    const double before[3] = {body->centre[0], body->centre[1], body->angle};
    body->angle += dt * body->spin;
    body->cosine = cos(body->angle);
    body->sine = sin(body->angle);
    rigid_turn(body, body->arm, arm);
    for (int c = 0; c < 2; ++c) {
        const bool apart = body->arm[0] != 0.0 || body->arm[1] != 0.0;
        if (body->held[c] && apart) {
            if (!step->settling) body->given[c] += dt * formula(domain->spec->motion.velocity + c, step->time + 0.5 * dt);
            body->centre[c] = body->given[c] + arm[c];
        } else {
            body->centre[c] += dt * body->velocity[c];
        }
    }
    if (body->hinged) {
        offset[0] = arm[0], offset[1] = arm[1];
        book_turning(body, step, offset);
    }
    body->reaction[2] +=
        (body->reference[0] + body->origin[0]) * body->reaction[1] - (body->reference[1] + body->origin[1]) * body->reaction[0];
    body->moved = body->moved || before[0] != body->centre[0] || before[1] != body->centre[1] || before[2] != body->angle;
    measure(body, offset);
    if (!isfinite(body->energy.kinetic) || !isfinite(body->centre[0]) || !isfinite(body->centre[1]))
        return ab_report_failure(
            report,
            "body '%s': its place or velocity is no finite number any more at t = %.9g s (step %ld): the run has blown "
            "up; use a smaller dt",
            domain->spec->name, step->time + dt, step->number);
    return AB_OK;
}
