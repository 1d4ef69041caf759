/* bounds.c: where a body of elements or a rigid body is between two steps, and how fast its parts move. */
#include <math.h>

#include "fem/domain.h"
#include "fem/rigid.h"

static const ab_bounds NOTHING = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}, {INFINITY, INFINITY}, {-INFINITY, -INFINITY}};

void fem_bounds(const ab_domain *domain, ab_bounds *bounds) {
    const fem_body *body = (const fem_body *)domain;
    ab_bounds b = NOTHING;
    for (size_t i = 0; i < body->nodes; ++i)
        for (size_t c = 0; c < 2; ++c) {
            const double x = body->x[2 * i + c], v = body->velocity[2 * i + c];
            b.low[c] = x < b.low[c] ? x : b.low[c];
            b.high[c] = x > b.high[c] ? x : b.high[c];
            b.least_velocity[c] = v < b.least_velocity[c] ? v : b.least_velocity[c];
            b.most_velocity[c] = v > b.most_velocity[c] ? v : b.most_velocity[c];
        }
    *bounds = b;
}

void rigid_bounds(const ab_domain *domain, ab_bounds *bounds) {
    const rigid_body *body = (const rigid_body *)domain;
    const rigid_outline *o = &body->outline;
    ab_bounds b = NOTHING;
    for (size_t k = 0; k < o->vertex_count; ++k) {
        double x[2];
        rigid_place(body, o->vertex[k], x);
        const double v[2] = {body->velocity[0] - body->spin * (x[1] - body->reference[1]), body->velocity[1] + body->spin * (x[0] - body->reference[0])};
        for (size_t c = 0; c < 2; ++c) {
            b.low[c] = fmin(b.low[c], x[c]);
            b.high[c] = fmax(b.high[c], x[c]);
            b.least_velocity[c] = fmin(b.least_velocity[c], v[c]);
            b.most_velocity[c] = fmax(b.most_velocity[c], v[c]);
        }
    }
    *bounds = b;
}
