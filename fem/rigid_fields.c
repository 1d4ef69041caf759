/* rigid_fields.c: what results and monitors see of a rigid body: the nodes of its mesh, or the vertices of its outline. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/rigid.h"

static const ab_field FIELDS[] = {
    {"id", "1", 1, ""},        {"position", "m", 2, "x y"}, {"velocity", "m s-1", 2, "x y"}, {"displacement", "m", 2, "x y"},
    {"mass", "kg m-1", 1, ""}, {"rotation", "rad", 1, ""},  {"rotation-rate", "s-1", 1, ""},
};

const ab_field *rigid_fields(const ab_domain *domain, size_t *count) {
    (void)domain;
    *count = sizeof FIELDS / sizeof *FIELDS;
    return FIELDS;
}

size_t rigid_count(const ab_domain *domain) {
    const rigid_outline *o = &((const rigid_body *)domain)->outline;
    return o->mesh ? o->mesh->node_count : o->vertex_count;
}

void rigid_cells(const ab_domain *domain, ab_cells *cells) {
    const fem_mesh *mesh = ((const rigid_body *)domain)->outline.mesh;
    *cells = (ab_cells){0};
    if (mesh) *cells = (ab_cells){.count = mesh->element_count, .nodes = mesh->nodes, .connectivity = mesh->connectivity};
}

/* The k-th place as drawn. */
static const double *drawn(const rigid_outline *o, size_t k) { return o->mesh ? o->mesh->x + 2 * k : o->vertex[k]; }

/* The place from which the displacement of a place as drawn is counted, m from the grid's corner. */
static void counted_from(const rigid_body *body, const double drawn_at[2], double from[2]) {
    const double x[2] = {drawn_at[0] - body->outline.centre[0], drawn_at[1] - body->outline.centre[1]};
    const double cosine = cos(body->datum[2]), sine = sin(body->datum[2]);
    from[0] = body->datum[0] + cosine * x[0] - sine * x[1];
    from[1] = body->datum[1] + sine * x[0] + cosine * x[1];
}

ab_status rigid_read(const ab_domain *domain, const char *field, double *values, ab_report *report) {
    const rigid_body *body = (const rigid_body *)domain;
    const rigid_outline *o = &body->outline;
    const size_t count = rigid_count(domain);
    const double *momentum = body->motion.momentum;
    enum { ID, POSITION, VELOCITY, DISPLACEMENT, MASS, ROTATION, RATE, KNOWN };
    int which = 0;
    while (which < KNOWN && strcmp(FIELDS[which].name, field)) ++which;
    if (which == KNOWN) return ab_report_failure(report, "body '%s' is rigid and has no field '%s'", domain->spec->name, field);
    for (size_t k = 0; k < count; ++k) {
        double now[2], from[2] = {0.0, 0.0};
        rigid_place(body, drawn(o, k), now);
        if (body->has_datum) counted_from(body, drawn(o, k), from);
        const double arm[2] = {now[0] - body->centre[0], now[1] - body->centre[1]};
        double *out = values + k * (size_t)FIELDS[which].components;
        switch (which) {
        case ID: out[0] = (double)k; break;
        case MASS: out[0] = body->mass / (double)count; break; /* shares that add up; they have not the body's inertia */
        case ROTATION: out[0] = body->angle; break;
        case RATE: out[0] = body->spin; break;
        default:
            for (int c = 0; c < 2; ++c)
                out[c] = which == VELOCITY   ? momentum[c] / body->mass + (c ? body->spin * arm[0] : -body->spin * arm[1])
                         : which == POSITION ? now[c] + body->origin[c]
                         : body->has_datum   ? now[c] - from[c]
                                             : now[c] + body->origin[c] - drawn(o, k)[c];
        }
    }
    return AB_OK;
}
