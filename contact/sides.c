/* sides.c: what a contact point does with the degrees of freedom of the two bodies it lies between, written once for both sides and for every method: velocity,
 * impulse, effective mass. A body that turns as a whole has velocity v + spin x r, r from its centre to the point, and an impulse j changes its spin by r x j over
 * its moment of inertia. */
#include "contact/contact.h"
#include "core/vector.h"

void contact_sides(const contact_pair *pair, contact_side side[2]) {
    const ab_points *p = &pair->points.view;
    side[0] = (contact_side){.points = p, .start = p->a_start, .dof = p->a_dof, .weight = p->a_weight, .sign = 1.0};
    side[1] = (contact_side){.points = p, .start = p->b_start, .dof = p->b_dof, .weight = p->b_weight, .sign = -1.0};
    pair->a->ops->dofs(pair->a, &side[0].dofs);
    pair->b->ops->dofs(pair->b, &side[1].dofs);
}

static void arm(const contact_side *s, size_t i, double r[2]) {
    r[0] = s->points->position[i] - s->dofs.centre[0];
    r[1] = s->points->position[s->points->ld + i] - s->dofs.centre[1];
}

/* Velocity of one side's dofs at point i. Two sums, of every other dof: one would wait for each of its terms in turn, and the rounds for it. */
static void velocity_at(const contact_side *s, bool old, size_t i, double v[2]) {
    const double *velocity = old ? s->dofs.velocity_old : s->dofs.velocity, *weight = s->weight;
    const size_t stride = old ? s->dofs.old_stride : s->dofs.velocity_stride, end = s->start[i + 1];
    const uint32_t *dof = s->dof;
    double even[2] = {0.0, 0.0}, odd[2] = {0.0, 0.0};
    size_t e = s->start[i];
    for (; e + 1 < end; e += 2) {
        const double *u = velocity + dof[e] * stride, *w = velocity + dof[e + 1] * stride;
        even[0] += weight[e] * u[0];
        even[1] += weight[e] * u[1];
        odd[0] += weight[e + 1] * w[0];
        odd[1] += weight[e + 1] * w[1];
    }
    if (e < end) {
        const double *u = velocity + dof[e] * stride;
        even[0] += weight[e] * u[0];
        even[1] += weight[e] * u[1];
    }
    v[0] = even[0] + odd[0];
    v[1] = even[1] + odd[1];
    if (s->dofs.spin) {
        const double spin = old ? *s->dofs.spin_old : *s->dofs.spin;
        double r[2];
        arm(s, i, r);
        v[0] -= spin * r[1];
        v[1] += spin * r[0];
    }
}

void contact_relative_velocity(const contact_side side[2], bool old, size_t i, double v[2]) {
    double a[2], b[2];
    velocity_at(side, old, i, a);
    velocity_at(side + 1, old, i, b);
    v[0] = a[0] - b[0];
    v[1] = a[1] - b[1];
}

void contact_push(const contact_side side[2], size_t i, const double j[2]) {
    for (int k = 0; k < 2; ++k) {
        const contact_side *s = side + k;
        const double jx = s->sign * j[0], jy = s->sign * j[1], *weight = s->weight, *mass = s->dofs.inverse_mass;
        const uint32_t *dofs = s->dof;
        const size_t stride = s->dofs.velocity_stride, mass_stride = s->dofs.mass_stride, begin = s->start[i], end = s->start[i + 1];
        double *velocities = s->dofs.velocity, *impulse = s->dofs.impulse;
        for (size_t e = begin; e < end; ++e) {
            const double *inverse_mass = mass + dofs[e] * mass_stride;
            double *velocity = velocities + dofs[e] * stride;
            velocity[0] -= weight[e] * inverse_mass[0] * jx;
            velocity[1] -= weight[e] * inverse_mass[1] * jy;
        }
        for (size_t e = begin; impulse && e < end; ++e) {
            impulse[2 * (size_t)dofs[e]] -= weight[e] * jx;
            impulse[2 * (size_t)dofs[e] + 1] -= weight[e] * jy;
        }
        if (s->dofs.spin) {
            double r[2];
            arm(s, i, r);
            const double moment = jy * r[0] - jx * r[1];
            *s->dofs.spin -= moment * s->dofs.inverse_inertia;
            if (impulse) impulse[2] -= moment;
        }
    }
}

/* What is held moves nowhere: a point at a held node, but for rounding, would see a mass of 1e20 in the node beside it. */
static const double HELD = 1e-12; /* of the weights, squared; of what a dof would be if it were not held */

double contact_inverse_mass(const contact_side side[2], size_t i, const double d[2], bool *held) {
    double sum = 0.0;
    for (int k = 0; k < 2; ++k) {
        const contact_side *s = side + k;
        double of_side = 0.0, weights = 0.0, loose = 0.0;
        for (size_t e = s->start[i]; e < s->start[i + 1]; ++e) {
            const double *m = s->dofs.inverse_mass + (size_t)s->dof[e] * s->dofs.mass_stride, w2 = s->weight[e] * s->weight[e];
            const double along = d[0] * d[0] * m[0] + d[1] * d[1] * m[1];
            weights += w2;
            if (m[0] != m[1]) *held = true;
            if (!(along > HELD * ab_larger(m[0], m[1]))) continue;
            of_side += w2 * along;
            loose += w2;
        }
        if (loose > HELD * weights) sum += of_side;
        if (s->dofs.spin) {
            double r[2];
            arm(s, i, r);
            const double turned = r[0] * d[1] - r[1] * d[0];
            sum += turned * turned * s->dofs.inverse_inertia;
        }
    }
    return sum;
}

double contact_coupling(const contact_side side[2], size_t i, const double n[2], bool turns) {
    double sum = 0.0;
    for (int k = 0; k < 2; ++k) {
        const contact_side *s = side + k;
        for (size_t e = s->start[i]; !turns && e < s->start[i + 1]; ++e) {
            const double *m = s->dofs.inverse_mass + (size_t)s->dof[e] * s->dofs.mass_stride, w = s->weight[e];
            sum += w * w * n[0] * n[1] * (m[1] - m[0]);
        }
        if (s->dofs.spin) {
            double r[2];
            arm(s, i, r);
            sum += (r[0] * n[1] - r[1] * n[0]) * (r[0] * n[0] + r[1] * n[1]) * s->dofs.inverse_inertia;
        }
    }
    return sum;
}

bool contact_all_held(const contact_side side[2], size_t i, size_t c) {
    for (int k = 0; k < 2; ++k) {
        const contact_side *s = side + k;
        for (size_t e = s->start[i]; e < s->start[i + 1]; ++e)
            if (s->dofs.inverse_mass[(size_t)s->dof[e] * s->dofs.mass_stride + c] != 0.0) return false;
        if (s->dofs.spin && s->dofs.inverse_inertia != 0.0) return false;
    }
    return true;
}
