/* scene_axisymmetric.c: what a scene about an axis asks for: no place left of it, nothing that would tear it open, and what is not there yet said by name. */
#include <math.h>
#include <string.h>

#include "core/scene_reader.h"

uint32_t ab_scene_space(const ab_scene *scene, const char **name) {
    const bool rings = scene->space == AB_SPACE_AXISYMMETRIC;
    *name = rings ? "axisymmetric scenes" : "plane strain";
    return rings ? AB_AXISYMMETRIC : AB_PLANE_STRAIN;
}

void ab_scene_take_axis(ab_scene_reader *r, ab_mark mark) {
    ab_scene *scene = r->scene;
    if (scene->space != AB_SPACE_AXISYMMETRIC) return;
    double *from = &scene->grid_from[0];
    if (fabs(*from) < 1e-9 * scene->grid_cell) *from = 0.0;
    if (*from < 0.0) {
        ab_report_error(r->base.report, mark,
                        "grid.from is %.10g m along x, but in an axisymmetric scene x is the radius; begin at 0, the axis, or right of it",
                        *from);
        return;
    }
    if (*from > 0.0) return;
    ab_side_kind *side = &scene->side[AB_LEFT];
    if (*side == AB_SIDE_FREE) *side = AB_SIDE_ROLLER;
    if (*side != AB_SIDE_ROLLER)
        ab_report_error(
            r->base.report, mark,
            "grid.sides.left: %s, but it is the axis, which holds the radial direction only; write roller, or leave the side out",
            *side == AB_SIDE_FIXED ? "fixed" : "outflow");
}

static void check_body(ab_scene_reader *r, const ab_body_spec *body) {
    const ab_scene *scene = r->scene;
    double low[2], high[2];
    if (ab_body_bounds(body, low, high) && low[0] < -1e-9 * (high[0] - low[0]))
        ab_report_error(r->base.report, body->mark,
                        "body '%s' reaches to x = %.10g m, but in an axisymmetric scene x is the radius; draw the half right of the axis",
                        body->name, low[0]);
    if (body->method != NULL && strcmp(body->method, "finite-elements") == 0 && scene->grid_cell > 0.0 && scene->grid_from[0] > 0.0)
        ab_report_error(
            r->base.report, body->mark,
            "body '%s' of finite elements: the grid of an axisymmetric scene must begin at the axis then; write grid.from: [0, %.10g]",
            body->name, scene->grid_from[1]);
    if (body->method != NULL && strcmp(body->method, "rigid") == 0)
        ab_report_error(r->base.report, body->mark,
                        "body '%s': method %s is not there yet in axisymmetric scenes; use material-points or finite-elements", body->name,
                        body->method);
    if (body->basis != NULL && strcmp(body->basis, "cpdi") == 0)
        ab_report_error(r->base.report, body->mark,
                        "bodies.%s.basis: cpdi is not there yet in axisymmetric scenes; use gimp, linear, bspline2 or bspline3",
                        body->name);
}

void ab_scene_check_axisymmetric(ab_scene_reader *r) {
    const ab_scene *scene = r->scene;
    if (scene->space != AB_SPACE_AXISYMMETRIC) return;
    const ab_number *g = &scene->gravity[0];
    if (g->expression != NULL || g->value != 0.0)
        ab_report_error(r->base.report, g->mark,
                        "gravity along x would point away from the axis on all sides of it; write [0, g] in an axisymmetric scene, and "
                        "body_force for a force "
                        "along the radius");
    for (size_t b = 0; b < scene->body_count; b++) check_body(r, &scene->bodies[b]);
    for (size_t c = 0; c < scene->contact_count; c++)
        ab_report_error(r->base.report, scene->contacts[c].mark, "contact[%zu]: contact is not there yet in axisymmetric scenes", c);
}
