/* find.c: asks the bodies of a pair for what its finder needs, nodes they share or surfaces, and the finder for contact points. */
#include <math.h>
#include <omp.h>
#include <string.h>

#include "contact/contact.h"

enum { NODES_PER_THREAD = 32 };

static const uint32_t SETTING_NEEDS = AB_NEED_DENSITY_GRADIENT | AB_NEED_NEAREST_FACE | AB_NEED_AREA; /* what may be needed by settings */
static const uint32_t NODE_NEEDS = AB_NEED_SHARED_NODES | AB_NEED_MASS_GRADIENT | AB_NEED_AREA_VECTOR | AB_NEED_NEAR_POINTS;

ab_status contact_complain(const contact_pair *pair, const ab_service *service, const char *what, int code, ab_report *report) {
    return ab_report_failure(report, "contact of '%s' and '%s': %s returned %d and gave %s%s", pair->a->spec->name, pair->b->spec->name,
                             what, code, service->message[0] ? "the reason: " : "no reason", service->message);
}

/* True where the finder was told to leave the gap at 0: its setting `gap`, a word, is `none`. */
static bool leaves_out_gap(const ab_contact_spec *spec) {
    const ab_class *class_ = &spec->finder->class_;
    for (uint32_t k = 0; k < class_->nparam; ++k) {
        if (strcmp(class_->param[k].name, "gap") || class_->param[k].type != AB_CHOICE || spec->finder_settings[k].integer < 0) continue;
        const char *word = class_->param[k].choices;
        for (int64_t skip = spec->finder_settings[k].integer; skip > 0 && word; --skip)
            word = strchr(word, '|') ? strchr(word, '|') + 1 : NULL;
        return word && !strncmp(word, "none", 4) && (word[4] == '\0' || word[4] == '|');
    }
    return false;
}

static bool has_mesh(const ab_domain *body) { return ab_domain_is_rigid(body) || body->ops->cells; }

ab_status contact_can_find(const contact_pair *pair, ab_report *report) {
    const ab_loaded_class *finder = pair->spec->finder;
    const ab_domain_ops *a = pair->a->ops, *b = pair->b->ops;
    for (int side = 0; side < 2; ++side) {
        const ab_domain *body = side ? pair->b : pair->a;
        if ((finder->class_.needs & NODE_NEEDS) && !(body->ops->node_tiles && body->ops->trace))
            return ab_report_error(
                report, pair->spec->mark,
                "contact by '%s' looks at nodes of the grid, and body '%s' (%s) is not seen there; use another algorithm, "
                "such as point-to-segment",
                finder->class_.name, body->spec->name, body->ops->method);
    }
    const uint32_t more =
        (ab_contact_needs(pair->spec) & ~finder->class_.needs) | (ab_response_needs(pair->spec) & ~pair->spec->responder->class_.needs);
    if (more & ~SETTING_NEEDS)
        return ab_report_error(
            report, pair->spec->mark,
            "contact by '%s' and '%s' needs 0x%x with these settings, and only 0x%x may hang on them; declare the rest in the class",
            finder->class_.name, pair->spec->responder->class_.name, more, SETTING_NEEDS);
    if ((ab_contact_needs(pair->spec) & AB_NEED_NEAREST_FACE) && !(has_mesh(pair->a) || has_mesh(pair->b)))
        return ab_report_error(
            report, pair->spec->mark,
            "normal: faces takes the normal of a body's faces (finite-elements, rigid), and neither '%s' (%s) nor '%s' (%s) has any; "
            "use another normal, such as average",
            pair->a->spec->name, a->method, pair->b->spec->name, b->method);
    if ((finder->class_.needs & AB_NEED_SURFACE) && !((a->faces && b->surface_points) || (b->faces && a->surface_points)))
        return ab_report_error(
            report, pair->spec->mark,
            "contact by '%s' needs a body with faces (finite-elements, rigid), and neither '%s' (%s) nor '%s' (%s) has any; "
            "use another algorithm, such as multi-velocity",
            finder->class_.name, pair->a->spec->name, a->method, pair->b->spec->name, b->method);
    if ((pair->spec->responder->class_.needs & AB_NEED_GAP) && leaves_out_gap(pair->spec))
        return ab_report_error(
            report, pair->spec->mark,
            "response '%s' pushes by how far '%s' and '%s' overlap, which '%s' does not measure with gap: none; leave gap out",
            pair->spec->responder->class_.name, pair->a->spec->name, pair->b->spec->name, finder->class_.name);
    return AB_OK;
}

static double modulus(const ab_domain *body) { return body->ops->modulus ? body->ops->modulus(body) : INFINITY; }

static ab_status trace_nodes(contact_pair *pair, uint32_t needs, ab_trace *a, ab_trace *b, ab_report *report) {
    AB_TRY(contact_shared_nodes(pair, report));
    if (pair->node_count == 0) return AB_OK;
    ab_status of_a = AB_OK, of_b = AB_OK; /* two bodies, two threads where there are two and the work is worth it */
#pragma omp parallel sections num_threads(2) if (pair->node_count >= NODES_PER_THREAD && omp_get_max_threads() > 1)
    {
#pragma omp section
        of_a = pair->a->ops->trace(pair->a, pair->nodes_a, pair->node_count, needs, a, report);
#pragma omp section
        of_b = pair->b->ops->trace(pair->b, pair->nodes_b, pair->node_count, needs, b, report);
    }
    AB_TRY(of_a);
    return of_b;
}

/* What a trace says of a body without nodes. */
static void describe(ab_trace *trace, const ab_domain *body, double cell) {
    if (trace->struct_size) return;
    *trace = (ab_trace){.struct_size = sizeof *trace, .dimension = 2, .body = body->spec->name, .stiffness = modulus(body), .cell = cell};
}

/* Lengths in the plane become areas of rings: 2 pi r; about the axis that of the disc which a length from there sweeps. */
static void make_rings(ab_points *p) {
    for (size_t i = 0; i < p->count; ++i) p->area[i] *= ab_circumference(fmax(p->position[i], 0.5 * p->area[i]));
}

ab_status contact_find(contact_pair *pair, const ab_step *step, ab_report *report) {
    contact_points *points = &pair->points;
    ab_points *p = &points->view;
    const uint32_t needs = ab_contact_needs(pair->spec);
    ab_trace a = {0}, b = {0};
    ab_surface surface_a = {0}, surface_b = {0};
    p->count = 0;
    pair->node_count = 0;
    size_t stencil = 0;
    if (needs & NODE_NEEDS) {
        AB_TRY(trace_nodes(pair, needs, &a, &b, report));
        if ((needs & AB_NEED_NEAREST_FACE) && pair->node_count) AB_TRY(contact_nearest_faces(pair, &a, &b, report));
        if (a.stencil_start)
            stencil = a.stencil_start[a.count] > b.stencil_start[b.count] ? a.stencil_start[a.count] : b.stencil_start[b.count];
    }
    if (!contact_points_reserve(points, pair->node_count, stencil))
        return ab_report_failure(report, "no memory for %zu contact points", pair->node_count);
    p->time = step->time;
    p->dt = step->dt;
    p->cell = a.cell;
    p->failures = 0;
    p->speed = 0.0;
    p->modulus = fmin(modulus(pair->a), modulus(pair->b));
    p->a_start[0] = p->b_start[0] = 0;
    if (needs & AB_NEED_SURFACE) {
        AB_TRY(contact_surfaces(pair, step->dt, &surface_a, &surface_b, report));
        p->cell = contact_broad_cell(pair->broad);
        p->speed = contact_broad_speed(pair->broad);
        describe(&a, pair->a, p->cell);
        describe(&b, pair->b, p->cell);
        a.surface = &surface_a;
        b.surface = &surface_b;
    } else if (pair->node_count == 0) {
        return AB_OK;
    }
    const int code = pair->spec->finder->contact.find(pair->finder, &a, &b, p);
    if (code != 0) return contact_complain(pair, &pair->finder_service, "find", code, report);
    pair->failures += p->failures;
    if (p->axisymmetric) make_rings(p);
    if (needs & AB_NEED_SURFACE) contact_watch_depth(pair, report);
    return AB_OK;
}
