/* approach.c: bodies that come at each other so fast that a step would carry one through the other unseen. The step of material points is limited by their own speed, that of
 * elements and rigid bodies is not; so a pair with one of these has a limit of its own: in a step they may close half of what lies between their boxes, and a cell. */
#include <math.h>
#include <stdio.h>

#include "contact/contact.h"
#include "core/vector.h"

/* What is known of a body of points between two steps: the tiles of the grid that it was in, the velocity of its centre of mass. Points that are faster than that are held back
 * by their own limit. */
static void bounds_of_points(const ab_domain *body, double cell, ab_bounds *b) {
    ab_node_tiles tiles = {0};
    ab_energy energy;
    ab_motion motion;
    body->ops->node_tiles(body, &tiles);
    body->ops->ledger(body, &energy, &motion);
    for (int c = 0; c < 2; ++c) {
        b->low[c] = tiles.count ? INFINITY : -INFINITY, b->high[c] = -b->low[c]; /* no tiles yet: it may be anywhere */
        b->least_velocity[c] = b->most_velocity[c] = motion.mass > 0.0 ? motion.momentum[c] / motion.mass : 0.0;
    }
    const double size = cell * AB_TILE;
    for (size_t k = 0; k < tiles.count; ++k) {
        const double corner[2] = {size * ab_tile_x(tiles.key[k]), size * ab_tile_y(tiles.key[k])};
        for (int c = 0; c < 2; ++c) b->low[c] = ab_smaller(b->low[c], corner[c]), b->high[c] = ab_larger(b->high[c], corner[c] + size);
    }
}

contact_approach contact_approach_of(const contact_pair *pair) {
    const double cell = pair->cell;
    const ab_domain *const body[2] = {pair->a, pair->b};
    ab_bounds b[2];
    if (!body[0]->ops->bounds && !body[1]->ops->bounds) return (contact_approach){.way = INFINITY};
    for (int side = 0; side < 2; ++side)
        if (body[side]->ops->bounds)
            body[side]->ops->bounds(body[side], b + side);
        else
            bounds_of_points(body[side], cell, b + side);
    double speed2 = 0.0, apart2 = 0.0;
    for (int c = 0; c < 2; ++c) {
        const double most = ab_larger(b[0].most_velocity[c] - b[1].least_velocity[c], b[1].most_velocity[c] - b[0].least_velocity[c]);
        const double between = ab_larger(ab_larger(b[0].low[c] - b[1].high[c], b[1].low[c] - b[0].high[c]), 0.0);
        speed2 += most > 0.0 ? most * most : 0.0;
        if (between > 0.0) apart2 += between * between;
    }
    return (contact_approach){.speed = sqrt(speed2), .way = 0.5 * sqrt(apart2) + cell};
}

ab_status contact_stop_passing(const ab_scene *scene, const contact_pair *pair, const contact_approach *approach, const ab_step *step, ab_report *report) {
    const double cell = pair->cell;
    if (!scene->watch || !(approach->speed * step->dt > approach->way)) return AB_OK;
    return ab_report_failure(report,
                             "contact of '%s' and '%s': they move by %.3g m against each other in one step, at %.4g m/s, where %.3g m may do it no harm, and may pass through each other "
                             "unseen, at t = %.9g s (step %ld, dt %.4g s, limit %.4g s: a cell of %.4g m and half of what lies between them). Use a dt below that limit, or cfl; where "
                             "neither is meant to be so fast, look at the frames before. (watchdog: {stop: false} lets it go on)",
                             pair->a->spec->name, pair->b->spec->name, approach->speed * step->dt, approach->speed, approach->way, step->time, step->number, step->dt,
                             approach->way / approach->speed, cell);
}
