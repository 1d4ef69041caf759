/* doubts_room.c: bodies that will fly out of the grid. The centre of mass of a body that nothing touches moves by its velocity and by gravity alone, whatever the body does
 * within itself; so its box is carried along, and looked at until something that is not foreseen may touch it. */
#include "core/doubts_room.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LOOKS = 2000 };             /* of the run's time */
static const double NEAR = 2;      /* cells: how far a side of the grid, or a contact, may reach */
static const double TURNING = 0.5; /* of a body's larger side: how far it may reach beyond its box as it turns or swings */

typedef struct flight {
    bool known;                     /* nothing has touched it that is not foreseen */
    bool points;                    /* of material points: sides of the grid hold it, and it must stay within */
    bool free_to[2];                /* moves along x, y; else it stands still there */
    bool falls;                     /* gravity acts on it */
    double low[2], high[2], reach;  /* m: its box at the start, and what it may reach beyond */
    double v[2], way[2], before[2]; /* m/s, m: now, and way at the look before */
    int side;                       /* through which it leaves; -1: none so far */
    double when, beyond;            /* s; m, at most until the end */
} flight;

static bool is(const char *word, const char *wanted) { return word && !strcmp(word, wanted); }

static bool still(const ab_number *number) { return ab_number_is_constant(number) && ab_number_at(number, 0.0, 0.0, 0.0, 0.0) == 0.0; }

/* What moves it is known: no loads, forces, boundaries. */
static bool left_alone(const ab_scene *scene, size_t b) {
    for (size_t k = 0; k < scene->load_count; ++k)
        if (scene->loads[k].body == b) return false;
    for (size_t k = 0; k < scene->boundary_count; ++k)
        if (scene->boundaries[k].body == b) return false;
    return !scene->bodies[b].has_force;
}

/* What is given of a rigid body's motion: only that it stands still can be foreseen; the rest is free. */
static bool foreseen_motion(const ab_motion_spec *motion, flight *f) {
    for (int c = 0; c < 2; ++c) {
        if (!motion->has[c]) continue;
        if (!still(motion->velocity + c)) return false;
        f->free_to[c] = false;
    }
    return true;
}

static ab_status take(const ab_schedule *s, size_t b, flight *f, ab_report *report) {
    const ab_scene *scene = s->scene;
    const ab_body_spec *body = scene->bodies + b;
    const ab_domain *domain = s->domains[b];
    const ab_motion *motion = s->motion + b;
    *f = (flight){.points = is(body->method, "material-points"), .free_to = {true, true}, .falls = body->gravity, .side = -1};
    f->known = left_alone(scene, b) && domain->ops->count(domain) > 0;
    const size_t count = domain->ops->count(domain);
    double *x = malloc((2 * count + 1) * sizeof *x);
    if (!x) return ab_report_failure(report, "no memory for the places of %zu points", count);
    const ab_status status = domain->ops->read(domain, "position", x, report);
    bool even = body->fix_count == 0;
    for (int c = 0; c < 2 && status == AB_OK; ++c) {
        f->low[c] = INFINITY, f->high[c] = -INFINITY;
        for (size_t k = 0; k < count; ++k)
            f->low[c] = fmin(f->low[c], x[2 * k + (size_t)c]), f->high[c] = fmax(f->high[c], x[2 * k + (size_t)c]);
        if (motion->mass > 0.0) f->v[c] = motion->momentum[c] / motion->mass;
        even = even && ab_number_is_constant(body->velocity + c);
        if (body->fix_count > 0) f->free_to[c] = false;
    }
    free(x);
    AB_TRY(status);
    if (is(body->method, "rigid")) {
        f->known = f->known && foreseen_motion(&body->motion, f);
        even = even && body->motion.has_spin && still(&body->motion.spin);
    }
    f->known = f->known && (motion->mass > 0.0 || !(f->free_to[0] || f->free_to[1]));
    if (scene->space == AB_SPACE_AXISYMMETRIC) f->free_to[0] = false; /* hoops hold it */
    f->reach = NEAR * scene->grid_cell + (even ? 0.0 : TURNING * fmax(f->high[0] - f->low[0], f->high[1] - f->low[1]));
    return AB_OK;
}

/* Sides that hold what comes near: it stands still across a roller side, and altogether at a fixed one. */
static void held_by_sides(const ab_scene *scene, flight *f) {
    for (int side = 0; side < AB_SIDES; ++side) {
        const int c = side / 2;
        const double at = scene->grid_from[c] + (side % 2 ? scene->grid_cells[c] * scene->grid_cell : 0.0);
        const double gap = side % 2 ? at - f->high[c] - f->way[c] : f->low[c] + f->way[c] - at;
        if (gap > NEAR * scene->grid_cell || f->side >= 0) continue;
        if (scene->side[side] == AB_SIDE_ROLLER) f->free_to[c] = false;
        if (scene->side[side] == AB_SIDE_FIXED) f->free_to[0] = f->free_to[1] = false;
    }
}

static void look_at_sides(const ab_scene *scene, flight *f, double t, double dt) {
    for (int side = 0; side < AB_SIDES; ++side) {
        const int c = side / 2;
        const double at = scene->grid_from[c] + (side % 2 ? scene->grid_cells[c] * scene->grid_cell : 0.0);
        const double out = side % 2 ? f->high[c] + f->way[c] - at : at - f->low[c] - f->way[c], moved = fabs(f->way[c] - f->before[c]);
        if (!(out > 0.0)) continue;
        if (f->side < 0 && scene->side[side] == AB_SIDE_OUTFLOW) {
            f->known = false;
        } else if (f->side < 0 && scene->side[side] == AB_SIDE_FREE && moved > 0.0) {
            f->side = side;
            f->when = t - dt * fmin(1.0, out / moved);
        }
        if (f->side == side) f->beyond = fmax(f->beyond, out);
    }
}

/* Whether they may touch between the last look and this one. */
static bool near_each_other(const flight *a, const flight *b) {
    const double reach = fmax(a->reach, b->reach);
    for (int c = 0; c < 2; ++c) {
        if (fmin(a->way[c], a->before[c]) + a->low[c] - reach > fmax(b->way[c], b->before[c]) + b->high[c]) return false;
        if (fmin(b->way[c], b->before[c]) + b->low[c] - reach > fmax(a->way[c], a->before[c]) + a->high[c]) return false;
    }
    return true;
}

static void meet(const ab_scene *scene, flight *flights) {
    for (size_t k = 0; k < scene->contact_count; ++k) {
        flight *a = flights + scene->contacts[k].body[0], *b = flights + scene->contacts[k].body[1];
        if (a->known && b->known && !near_each_other(a, b)) continue;
        if (a->side < 0) a->known = false; /* where one is, nobody knows; what has left the grid has ended the run */
        if (b->side < 0) b->known = false;
    }
}

static void fly(const ab_scene *scene, flight *flights) {
    const double dt = scene->time_end / LOOKS;
    meet(scene, flights);
    for (int look = 1; look <= LOOKS; ++look) {
        double g[2];
        for (int c = 0; c < 2; ++c) g[c] = ab_number_at(scene->gravity + c, (look - 0.5) * dt, 0.0, 0.0, 0.0);
        if (!isfinite(g[0]) || !isfinite(g[1])) return;
        for (size_t b = 0; b < scene->body_count; ++b) {
            flight *f = flights + b;
            if (!f->known) continue;
            if (f->points) held_by_sides(scene, f);
            for (int c = 0; c < 2; ++c) {
                f->before[c] = f->way[c];
                if (!f->free_to[c]) continue;
                const double more = f->falls ? g[c] * dt : 0.0;
                f->way[c] += dt * (f->v[c] + 0.5 * more);
                f->v[c] += more;
            }
        }
        meet(scene, flights);
        for (size_t b = 0; b < scene->body_count; ++b)
            if (flights[b].known && flights[b].points) look_at_sides(scene, flights + b, look * dt, dt);
    }
}

ab_status ab_doubt_room(const ab_schedule *s, ab_report *report) {
    static const char *const SIDE[AB_SIDES] = {"left", "right", "bottom", "top"};
    const ab_scene *scene = s->scene;
    if (!(scene->grid_cell > 0.0) || scene->stage_count > 0 || scene->damping_local > 0.0) return AB_OK;
    flight *flights = calloc(scene->body_count, sizeof *flights);
    if (!flights) return ab_report_failure(report, "no memory for the flight of %zu bodies", scene->body_count);
    ab_status status = AB_OK;
    for (size_t b = 0; b < scene->body_count && status == AB_OK; ++b) status = take(s, b, flights + b, report);
    if (status == AB_OK) fly(scene, flights);
    for (size_t b = 0; b < scene->body_count && status == AB_OK; ++b) {
        const flight *f = flights + b;
        if (f->side < 0) continue;
        ab_report_warning(report, scene->bodies[b].mark,
                          "bodies.%s: by its speed%s it leaves the grid through its %s side at about %.4g s, before time.end, and would be "
                          "%.3g m beyond: nothing that it has a contact with is in its way; make the grid larger, hold that side (roller, "
                          "fixed), say 'outflow' there, or give it a contact",
                          scene->bodies[b].name, f->falls && !(still(scene->gravity) && still(scene->gravity + 1)) ? " and gravity" : "",
                          SIDE[f->side], f->when, f->beyond);
    }
    free(flights);
    return status;
}
