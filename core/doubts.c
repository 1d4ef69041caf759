/* doubts.c: combinations that are known not to work, each with where it is known from. */
#include "core/doubts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/doubts_room.h"
#include "core/doubts_springs.h"
#include "core/doubts_weight.h"

static const double HOPELESS =
    3; /* of the limit: limits are of the worst places of points, others bear up to 2.2 of it (tests/stability/dt.yaml) */
/* What of a body's velocity is rounding grows with flip, by this in a cell and dt over its limit at most, wherever it flies in time with its vibrations: measured over
 * speeds of 0.03 to 2 c and cfl 0.3 to 0.9 (docs/extremes_hold.md). */
static const double GROWTH = 0.1, GROWTH_SPLINE = 0.015;
static const double GROWN = 25; /* e^25 times rounding, 1e-5 of the speed: no farther */
static const double FAR_LINEAR =
    10; /* cells: where vibrations have grown on the linear basis, at cfl 0.5 and above (tests/stability/light_nodes.yaml) */
static const double BEHIND = 0.01;    /* cells: a point no farther from a node line crosses it with the first vibrations */
static const double SPLINE_CFL = 0.6; /* bspline3 with usl */
static const double INCOMPRESSIBLE =
    0.49; /* Poisson's ratio from where on volume locks low-order bodies, and waves are 4 times as fast as at 0.3 */

static bool is(const char *word, const char *wanted) { return word && !strcmp(word, wanted); }

/* m/s, of the centre of mass at the start, or what moves the fastest part where that is known. */
static double speed_of(const ab_schedule *s, size_t b) {
    const ab_motion *motion = s->motion + b;
    return motion->mass > 0.0 ? hypot(motion->momentum[0], motion->momentum[1]) / motion->mass : 0.0;
}

static bool flips_off_balance(const ab_body_spec *body) {
    return body->transfer == AB_TRANSFER_FLIP && body->flip == 1.0 && (is(body->update, "musl") || is(body->update, "usf"));
}

static ab_status doubt_flight(const ab_schedule *s, size_t b, ab_report *report) {
    const ab_body_spec *body = s->scene->bodies + b;
    if (!flips_off_balance(body)) return AB_OK;
    const bool linear = is(body->basis, "linear"), spline = is(body->basis, "bspline2") || is(body->basis, "bspline3");
    const double cells = speed_of(s, b) * s->scene->time_end / s->scene->grid_cell;
    const double part = s->scene->time_dt > 0.0 ? s->scene->time_dt / s->critical_dt : s->scene->time_cfl;
    const double most = GROWN / ((spline ? GROWTH_SPLINE : GROWTH) * part);
    static const char REMEDY[] = "use update usavg, transfer apic or {flip: 0.99}, or update usl";
    if (cells > most && s->scene->watch)
        return ab_report_error(
            report, body->mark,
            "bodies.%s: it flies through about %.3g cells with transfer flip, update %s on basis %s, which may make energy "
            "out of rounding from some %.2g cells on, at this dt; %s. (watchdog: {stop: false} lets it be tried)",
            body->name, cells, body->update, body->basis, most, REMEDY);
    if (linear && cells > FAR_LINEAR)
        ab_report_warning(
            report, body->mark,
            "bodies.%s: it flies through about %.3g cells with transfer flip, update %s on basis %s, which makes energy of its "
            "vibrations from some %g cells on; %s",
            body->name, cells, body->update, body->basis, FAR_LINEAR, REMEDY);
    return AB_OK;
}

/* usf on the linear basis: what strains a point as it crosses a node is not what its stress then works on, by up to a quarter of a bar's energy in three periods
 * (tests/stability/point_past_node.yaml). */
static ab_status doubt_crossing(const ab_schedule *s, size_t b, ab_report *report) {
    const ab_body_spec *body = s->scene->bodies + b;
    if (!s->scene->watch || !flips_off_balance(body) || !is(body->basis, "linear") || !is(body->update, "usf")) return AB_OK;
    const ab_domain *domain = s->domains[b];
    const size_t count = domain->ops->count(domain);
    double *x = malloc((2 * count + 1) * sizeof *x);
    if (!x) return ab_report_failure(report, "no memory for the places of %zu points", count);
    ab_status status = domain->ops->read(domain, "position", x, report);
    for (size_t k = 0; k < 2 * count && status == AB_OK; ++k) {
        const double cells = (x[k] - s->scene->grid_from[k % 2]) / s->scene->grid_cell, past = cells - rint(cells);
        if (fabs(past) >= BEHIND) continue;
        status =
            ab_report_error(report, body->mark,
                            "bodies.%s: a point at (%.9g, %.9g) m stands %.2g of a cell from a line of nodes, and makes energy with update "
                            "usf on basis linear as it crosses it; use update usavg or musl, or move the grid. (watchdog: {stop: false} "
                            "lets it be tried)",
                            body->name, x[k - k % 2], x[k - k % 2 + 1], fabs(past));
    }
    free(x);
    return status;
}

static void doubt_poisson(const ab_schedule *s, size_t b, ab_report *report) {
    const ab_body_spec *body = s->scene->bodies + b;
    if (body->material >= s->scene->material_count || body->f_bar != AB_F_BAR_NONE || body->mesh.f_bar) return;
    const ab_material_spec *material = s->scene->materials + body->material;
    for (uint32_t k = 0; material->loaded && k < material->loaded->class_.nparam; ++k) {
        const double nu = material->settings[k].real;
        if (strcmp(material->loaded->class_.param[k].name, "nu") || !(nu > INCOMPRESSIBLE && nu < 0.5)) continue;
        const double faster = sqrt((1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) / ((1.0 - 0.3) / (1.3 * 0.4)));
        ab_report_warning(report, body->mark,
                          "bodies.%s: nu = %.6g of material '%s' makes waves %.3g times as fast as nu = 0.3 would, and the step as much "
                          "smaller, and volume that hardly changes locks the body; use f_bar: patch, or a smaller nu",
                          body->name, nu, material->name, faster);
    }
}

static ab_status check_first_step(const ab_schedule *s, size_t b, ab_report *report) {
    const ab_body_spec *body = s->scene->bodies + b;
    if (!is(body->method, "material-points") || !(s->scene->time_dt > 0.0) || !s->scene->watch) return AB_OK;
    const double cells = speed_of(s, b) * s->scene->time_dt / s->scene->grid_cell;
    if (!(cells > 1.0)) return AB_OK;
    return ab_report_error(
        report, s->scene->mark_time,
        "time.dt: body '%s' moves %.3g cells in the first step, at %.4g m/s; points must not pass a cell in a step: use a dt "
        "below %.3g s, or cfl",
        body->name, cells, speed_of(s, b), s->critical_dt > 0.0 ? s->critical_dt : s->scene->grid_cell / speed_of(s, b));
}

enum { FEW = 9 }; /* points: a body of one cell, with up to nine */

/* The choice `word` of a setting that has choices "a|b|c". */
static bool chooses(const ab_param *param, const ab_value *value, const char *word) {
    const char *text = param->choices;
    for (int64_t k = 0; text && k < value->integer; ++k) text = strchr(text, '|') ? strchr(text, '|') + 1 : NULL;
    return text && value->integer >= 0 && !strncmp(text, word, strlen(word)) && (text[strlen(word)] == '|' || !text[strlen(word)]);
}

/* A single point has no face: nodes beside it see it at an angle, and shared nodes would push it along what it lies on (tests/stability/small_bodies.yaml). The face of a rigid body
 * says better; that of a mesh gives way and leans, by up to a quarter of a cell where it is as soft as the body; with domains that are convected the faces are left for the average
 * where both disagree. */
static ab_status doubt_single_point(const ab_schedule *s, const ab_contact_spec *contact, ab_report *report) {
    const ab_class *finder = &contact->finder->class_;
    if (!is(finder->name, "multi-velocity") || !s->scene->watch) return AB_OK;
    bool faces = false;
    for (uint32_t k = 0; k < finder->nparam; ++k) {
        if (!is(finder->param[k].name, "normal")) continue;
        if (contact->finder_settings[k].integer < 0) return AB_OK; /* a direction */
        faces = chooses(finder->param + k, contact->finder_settings + k, "faces");
    }
    for (int side = 0; side < 2; ++side) {
        const ab_body_spec *body = s->scene->bodies + contact->body[side];
        const ab_domain *domain = s->domains[contact->body[side]];
        if (!is(body->method, "material-points")) continue;
        const bool mended =
            is(s->scene->bodies[contact->body[1 - side]].method, "rigid") && !is(body->basis, "cpdi"); /* by normal: faces */
        if (faces && mended) continue;
        const size_t count = domain->ops->count(domain);
        const char *remedy = mended ? "normal: faces, algorithm point-to-segment" : "algorithm point-to-segment";
        if (count > 1 && count <= FEW)
            ab_report_warning(report, contact->mark,
                              "contact: body '%s' is %zu material points: the normals that algorithm multi-velocity finds for so few lean "
                              "beside their corners, and may push it along what it lands on by a tenth of a cell; use %s, a "
                              "direction as normal (out of the first body), or more points",
                              body->name, count, remedy);
        if (count > 1) continue;
        return ab_report_error(
            report, contact->mark,
            "contact: body '%s' is a single material point, which shows no face to algorithm multi-velocity and would be pushed "
            "along what it lies on; use %s, a direction as normal (out of the first body), or more points. "
            "(watchdog: {stop: false} lets it be tried)",
            body->name, remedy);
    }
    return AB_OK;
}

/* Centres of points against faces, both ways: faces move with their own points, which stand elsewhere (tests/stability/test_friction_tied.sh). */
static void doubt_rough(const ab_schedule *s, const ab_contact_spec *contact, ab_report *report) {
    static const double ROUGH = 10; /* friction that is to hold fast */
    const ab_class *finder = &contact->finder->class_;
    if (!is(finder->name, "point-to-segment")) return;
    for (int side = 0; side < 2; ++side) {
        const ab_body_spec *body = s->scene->bodies + contact->body[side];
        if (!is(body->method, "material-points") || body->surface_points) return;
    }
    const ab_value *touching = ab_doubt_setting(finder, contact->finder_settings, "touching"),
                   *passes = ab_doubt_setting(finder, contact->finder_settings, "passes"),
                   *friction = ab_doubt_setting(&contact->responder->class_, contact->responder_settings, "friction");
    enum { CENTRE = 1 };
    if (!touching || touching->integer != CENTRE || !passes || passes->integer || !friction || !(friction->real >= ROUGH)) return;
    ab_report_warning(
        report, contact->mark,
        "contact: friction %g is to hold '%s' and '%s' together, but where the centres of points touch (touching: centre) the two "
        "passes ask for different motions, and it gives way by up to 3 %% of what it holds; use touching: auto or outline, or passes: "
        "first",
        friction->real, s->scene->bodies[contact->body[0]].name, s->scene->bodies[contact->body[1]].name);
}

/* A fixed dt or a cfl, of the scene or of a stage, against the limit of the bodies; `before` and `behind` the key: whose it is. */
static ab_status doubt_dt(const ab_schedule *s, double dt, double cfl, ab_mark mark, const char *before, const char *behind,
                          ab_report *report) {
    if (dt > HOPELESS * s->critical_dt && s->scene->watch)
        return ab_report_error(
            report, mark,
            "%sdt%s %.4g s is %.3g times the stable limit %.4g s (%s): nothing could come of it; use dt below the limit, "
            "or cfl. (watchdog: {stop: false} lets it be tried)",
            before, behind, dt, dt / s->critical_dt, s->critical_dt, s->limit);
    if (cfl > HOPELESS && s->scene->watch)
        return ab_report_error(
            report, mark,
            "%scfl%s %g is so many times the stable limit: nothing could come of it; use a cfl below 1. (watchdog: {stop: "
            "false} lets it be tried)",
            before, behind, cfl);
    if (dt > s->critical_dt)
        ab_report_warning(report, mark, "dt%s %.4g s is above the stable limit %.4g s (%s); use dt below it or cfl", behind, dt,
                          s->critical_dt, s->limit);
    return AB_OK;
}

/* bspline3 with usl bears less than a cfl of 1. */
static void doubt_spline(const ab_body_spec *body, double cfl, ab_mark mark, const char *key, ab_report *report) {
    if (is(body->basis, "bspline3") && is(body->update, "usl") && cfl > SPLINE_CFL)
        ab_report_warning(report, mark,
                          "%s %g: basis bspline3 with update usl (body '%s') is stable up to about %g; use that, or update musl", key, cfl,
                          body->name, SPLINE_CFL);
}

ab_status ab_doubts(const ab_schedule *s, ab_report *report) {
    const ab_scene *scene = s->scene;
    for (size_t b = 0; b < s->body_count; ++b) {
        const ab_body_spec *body = scene->bodies + b;
        AB_TRY(check_first_step(s, b, report));
        AB_TRY(doubt_flight(s, b, report));
        AB_TRY(doubt_crossing(s, b, report));
        AB_TRY(ab_doubt_weight(s, b, report));
        doubt_poisson(s, b, report);
        if (scene->stage_count == 0) doubt_spline(body, scene->time_cfl, scene->mark_time, "time.cfl", report);
        for (size_t k = 0; k < scene->stage_count; ++k) {
            char key[120];
            snprintf(key, sizeof key, "cfl of stage '%.64s'", scene->stages[k].name);
            doubt_spline(body, scene->stages[k].cfl, scene->stages[k].mark, key, report);
        }
    }
    AB_TRY(ab_doubt_room(s, report));
    for (size_t c = 0; c < scene->contact_count; ++c) AB_TRY(doubt_single_point(s, scene->contacts + c, report));
    for (size_t c = 0; c < scene->contact_count; ++c) doubt_rough(s, scene->contacts + c, report);
    AB_TRY(ab_doubt_springs(s, report));
    if (scene->stage_count == 0) return doubt_dt(s, scene->time_dt, scene->time_cfl, scene->mark_time, "time.", "", report);
    for (size_t k = 0; k < scene->stage_count; ++k) {
        const ab_stage_spec *stage = scene->stages + k;
        char of[120];
        snprintf(of, sizeof of, " of stage '%.64s'", stage->name);
        AB_TRY(doubt_dt(s, stage->dt, stage->cfl, stage->mark, "", of, report));
    }
    return AB_OK;
}
