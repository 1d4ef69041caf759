/* doubts_springs.c: what springs will ask of the step. The step loop knows it once bodies have met and a boundary has been asked, by the masses of each node; here it is
 * estimated with the mass of half a cell or element under a face, rho h A/2. Of penalty springs the limit is up to a fifth below the estimate; of boundaries' springs it
 * may be above it by half, where elements share the spring out over more than their outermost nodes: so these are refused by a wide margin only. Penalty springs make no energy
 * at any step, but with a fixed dt that is far too long they do not have the stiffness that was asked for: bodies overlap by what their first meeting left. */
#include "core/doubts_springs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double HOPELESS =
    2; /* times the limit, of a fixed dt: somewhat above that bodies overlap by other than the spring says (tests/stability/penalty.yaml) */
static const double SLOWER = 10;   /* times as many steps: said */
static const double ENDLESS = 1e3; /* times: a spring that is a support, and no wave will ever come of it */

/* A body as springs see it. Rigid: modulus and density infinite, as nothing of it swings. */
typedef struct seen {
    double modulus, density, speed, length; /* Pa, kg/m3, m/s; m, of a cell or an element, by its own stable step */
} seen;

static seen look(const ab_schedule *s, size_t b) {
    const ab_domain *domain = s->domains[b];
    const ab_body_spec *body = s->scene->bodies + b;
    seen it = {INFINITY, INFINITY, INFINITY, INFINITY};
    if (!domain->ops->modulus || body->material >= s->scene->material_count || !isfinite(domain->ops->modulus(domain))) return it;
    const char *limit = "";
    it.modulus = domain->ops->modulus(domain);
    it.density = s->scene->materials[body->material].density;
    it.speed = sqrt(it.modulus / it.density);
    it.length = !strcmp(body->method, "material-points") ? s->scene->grid_cell : it.speed * domain->ops->critical_dt(s->domains[b], &limit);
    return it;
}

const ab_value *ab_doubt_setting(const ab_class *class_, const ab_value *values, const char *name) {
    for (uint32_t k = 0; k < class_->nparam; ++k)
        if (!strcmp(class_->param[k].name, name)) return values + k;
    return NULL;
}

/* Of the choices "a|b|c", the one that a setting has taken. */
static bool chosen(const ab_class *class_, const ab_value *values, const char *name, int64_t wanted) {
    const ab_value *value = ab_doubt_setting(class_, values, name);
    return value && value->integer == wanted;
}

/* The largest dt of the stages in which something acts, or time.dt; 0: none is written. */
typedef struct longest {
    double dt;
    bool by_cfl;   /* some stage goes by cfl, or the scene */
    char key[120]; /* whose dt it is */
} longest;

static longest longest_dt(const ab_scene *scene, uint64_t absent, bool boundary) {
    longest it = {.dt = scene->time_dt, .by_cfl = !(scene->time_dt > 0.0), .key = "time.dt"};
    if (scene->stage_count == 0) return it;
    it.dt = 0.0, it.by_cfl = false;
    for (size_t k = 0; k < scene->stage_count; ++k) {
        const ab_stage_spec *stage = scene->stages + k;
        if ((absent >> k & 1u) || (boundary && stage->made)) continue;
        if (!(stage->dt > 0.0)) it.by_cfl = true;
        if (!(stage->dt > it.dt)) continue;
        it.dt = stage->dt;
        snprintf(it.key, sizeof it.key, "dt of stage '%.64s' (line %d)", stage->name, stage->mark.line);
    }
    return it;
}

/* response penalty, stiffness_of modulus: k = stiffness M A/h on the effective mass of both faces. */
static ab_status doubt_contact(const ab_schedule *s, const ab_contact_spec *contact, ab_report *report) {
    enum { OF_MODULUS = 1 };
    const ab_class *law = &contact->responder->class_;
    if (strcmp(law->name, "penalty") || !chosen(law, contact->responder_settings, "stiffness_of", OF_MODULUS)) return AB_OK;
    const ab_value *given = ab_doubt_setting(law, contact->responder_settings, "stiffness");
    if (given == NULL) return AB_OK; /* somebody's own plugin of that name */
    const double stiffness = given->real;
    double modulus = INFINITY, cell = INFINITY, lighter = 0.0;
    for (int side = 0; side < 2; ++side) {
        const seen it = look(s, contact->body[side]);
        if (!isfinite(it.modulus)) continue;
        modulus = fmin(modulus, it.modulus);
        cell = fmin(cell, it.length);
        lighter += 2.0 / (it.density * it.length); /* 1/(mass of half a cell), per area of face */
    }
    if (!(lighter > 0.0) || !(cell > 0.0) || !isfinite(modulus)) return AB_OK;
    const double dt = 2.0 * sqrt(cell / (stiffness * modulus * lighter));
    const char *a = s->scene->bodies[contact->body[0]].name, *b = s->scene->bodies[contact->body[1]].name;
    const longest step = longest_dt(s->scene, 0, false);
    if (step.dt > HOPELESS * dt && s->scene->watch)
        return ab_report_error(
            report, contact->mark,
            "contact: where '%s' and '%s' meet, springs of stiffness %g x modulus are stable up to a dt of about %.3g s, and "
            "%s is %.4g s, %.3g times that: they would not be as stiff as that; use a dt below the limit, cfl, stiffness below "
            "%.2g, or stiffness_of: mass, which bears any dt. (watchdog: {stop: false} lets it be tried)",
            a, b, stiffness, dt, step.key, step.dt, step.dt / dt, stiffness * pow(dt / step.dt, 2));
    if (step.dt > dt)
        ab_report_warning(report, contact->mark,
                          "contact: where '%s' and '%s' meet, springs of stiffness %g x modulus are stable up to a dt of about %.3g s, and "
                          "%s is %.4g s; use a dt below that, cfl, stiffness below %.2g, or stiffness_of: mass, which bears any dt",
                          a, b, stiffness, dt, step.key, step.dt, stiffness * pow(dt / step.dt, 2));
    else if (step.by_cfl && SLOWER * dt < s->critical_dt)
        ab_report_warning(
            report, contact->mark,
            "contact: where '%s' and '%s' meet, springs of stiffness %g x modulus are stable up to a dt of about %.3g s, so the "
            "step becomes %.2g times as short; use a stiffness of up to 3, or stiffness_of: mass, which bears any dt",
            a, b, stiffness, dt, s->critical_dt / dt);
    return AB_OK;
}

/* Stiffness per area, Pa/m, of a viscoelastic boundary; 0 for others. */
static double boundary_stiffness(const ab_boundary_spec *spec, const seen *it) {
    enum { DEEKS_RANDOLPH, KELLEZI, GIVEN };
    const ab_class *law = &spec->loaded->class_;
    if (strcmp(law->name, "viscoelastic")) return 0.0;
    if (chosen(law, spec->settings, "springs", GIVEN))
        return fmax(ab_doubt_setting(law, spec->settings, "k_n")->real, ab_doubt_setting(law, spec->settings, "k_t")->real);
    const double r_b = ab_doubt_setting(law, spec->settings, "r_b")->real;
    if (chosen(law, spec->settings, "springs", KELLEZI)) return it->modulus / r_b;
    return it->modulus / (4.0 * r_b); /* G/(2 r_b), and G is at most half of the P-wave modulus */
}

static ab_status doubt_boundary(const ab_schedule *s, size_t number, ab_report *report) {
    const ab_boundary_spec *spec = s->scene->boundaries + number;
    const seen it = look(s, spec->body);
    if (!isfinite(it.modulus)) return AB_OK;
    const double stiffness = boundary_stiffness(spec, &it);
    if (!(stiffness > 0.0)) return AB_OK;
    const double own = it.length / it.speed, spring = sqrt(2.0 * it.density * it.length / stiffness); /* 2/w, w^2 = k A/(rho h A/2) */
    const double dt = 1.0 / sqrt(1.0 / (own * own) + 1.0 / (spring * spring)), slower = s->critical_dt / dt;
    const char *name = s->scene->bodies[spec->body].name;
    /* shorter for the springs, and not because the body has shorter ones of its own */
    if (!(spring < own)) return AB_OK;
    static const char REMEDY[] = "use softer springs (a larger r_b, smaller k_n and k_t), or hold the edge by `fix` or a side of the grid";
    if (slower > ENDLESS && s->scene->watch)
        return ab_report_error(
            report, spec->mark,
            "boundaries[%zu] (viscoelastic) on '%s': springs of %.3g Pa/m are stable up to a dt of about %.3g s, %.2g times "
            "as short as the body's; they are a support and no ground beyond: %s. (watchdog: {stop: false} lets it be tried)",
            number, name, stiffness, dt, slower, REMEDY);
    const longest step = longest_dt(s->scene, spec->absent, true);
    if (step.dt > dt)
        ab_report_warning(report, spec->mark,
                          "boundaries[%zu] (viscoelastic) on '%s': springs of %.3g Pa/m are stable up to a dt of about %.3g s, and %s is "
                          "%.4g s; use a dt below that, cfl, or %s",
                          number, name, stiffness, dt, step.key, step.dt, REMEDY + 4);
    else if (step.by_cfl && slower > SLOWER)
        ab_report_warning(report, spec->mark,
                          "boundaries[%zu] (viscoelastic) on '%s': springs of %.3g Pa/m are stable up to a dt of about %.3g s, so the step "
                          "becomes %.2g times as short; %s",
                          number, name, stiffness, dt, slower, REMEDY);
    return AB_OK;
}

/* The column of a free-field: as many steps for one of the run as its elements ask for, and as many elements as the side is high; plugins/boundary/free_field.c has both limits. */
static ab_status doubt_column(const ab_schedule *s, size_t number, ab_report *report) {
    static const double MOST_PARTS = 1000, MOST_ELEMENTS = 100000;
    const ab_boundary_spec *spec = s->scene->boundaries + number;
    const ab_class *law = &spec->loaded->class_;
    const ab_domain *domain = s->domains[spec->body];
    if (strcmp(law->name, "free-field")) return AB_OK;
    const char *name = s->scene->bodies[spec->body].name;
    const ab_value *bottom = ab_doubt_setting(law, spec->settings, "bottom"), *top = ab_doubt_setting(law, spec->settings, "top");
    const seen it = look(s, spec->body);
    const double spacing = ab_doubt_setting(law, spec->settings, "spacing")->real, least = it.speed * s->dt / MOST_PARTS;
    double height = 0.0;
    if (bottom->given && top->given) {
        height = top->real - bottom->real;
    } else if (!spec->where.has[1]) { /* the whole side */
        const size_t count = domain->ops->count(domain);
        double *place = malloc((2 * count + 1) * sizeof *place), low = INFINITY, high = -INFINITY;
        if (!place) return ab_report_failure(report, "no memory for the places of body '%s'", name);
        const ab_status status = domain->ops->read(domain, "position", place, report);
        for (size_t k = 0; status == AB_OK && k < count; ++k) low = fmin(low, place[2 * k + 1]), high = fmax(high, place[2 * k + 1]);
        free(place);
        AB_TRY(status);
        height = high - low;
    }
    if (isfinite(least) && spacing < least)
        return ab_report_error(
            report, spec->mark,
            "boundaries[%zu] (free-field) on '%s': with a spacing of %.3g m its column needs more than %g steps for one of "
            "the run, %.3g s; use a spacing above %.3g m, best that of the elements or cells beside the side",
            number, name, spacing, MOST_PARTS, s->dt, least);
    if (height / spacing > MOST_ELEMENTS)
        return ab_report_error(
            report, spec->mark,
            "boundaries[%zu] (free-field) on '%s': with a spacing of %.3g m its column of %.4g m has more than %g elements; "
            "use a spacing above %.3g m, best that of the elements or cells beside the side",
            number, name, spacing, height, MOST_ELEMENTS, height / MOST_ELEMENTS);
    return AB_OK;
}

ab_status ab_doubt_springs(const ab_schedule *s, ab_report *report) {
    for (size_t c = 0; c < s->scene->contact_count; ++c) AB_TRY(doubt_contact(s, s->scene->contacts + c, report));
    for (size_t k = 0; k < s->scene->boundary_count; ++k) {
        AB_TRY(doubt_boundary(s, k, report));
        AB_TRY(doubt_column(s, k, report));
    }
    return AB_OK;
}
