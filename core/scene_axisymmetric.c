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
    double low[2], high[2];
    if (ab_body_bounds(body, low, high) && low[0] < -1e-9 * (high[0] - low[0]))
        ab_report_error(r->base.report, body->mark,
                        "body '%s' reaches to x = %.10g m, but in an axisymmetric scene x is the radius; draw the half right of the axis",
                        body->name, low[0]);
}

void ab_scene_hold_radius(ab_scene_reader *r, ab_body_spec *body) {
    if (r->scene->space != AB_SPACE_AXISYMMETRIC) return;
    ab_motion_spec *motion = &body->motion;
    const bool aside = motion->has[0] && (motion->velocity[0].expression != NULL || motion->velocity[0].value != 0.0);
    if (aside || (motion->has_spin && (motion->spin.expression != NULL || motion->spin.value != 0.0)))
        ab_report_error(
            r->base.report, aside ? motion->velocity[0].mark : motion->spin.mark,
            "bodies.%s.motion: a rigid body moves along the axis only in an axisymmetric scene; write velocity: [0, vy] and leave spin out",
            body->name);
    motion->has[0] = motion->has_spin = true; /* held at 0 */
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
    if (scene->grid_cell > 0.0 && scene->grid_from[0] > 0.0)
        for (size_t b = 0; b < scene->body_count; b++) {
            if (scene->contact_count == 0 && (scene->bodies[b].method == NULL || strcmp(scene->bodies[b].method, "material-points") == 0))
                continue;
            ab_report_error(r->base.report, scene->mark_grid,
                            "grid.from is %.10g m along x; with finite elements, rigid bodies or contact the grid of an axisymmetric scene "
                            "begins at the axis, 0 (cells "
                            "without material cost nothing)",
                            scene->grid_from[0]);
            break;
        }
}
