/* rounds.c: projected Gauss-Seidel over the contact points of all pairs in a fixed order: each point in turn is asked for the impulse it wants, and both sides' dofs
 * feel the difference, until the impulses stand still. Where points share dofs the rounds are sped up as nonlinear conjugate gradients
 * (Silcowitz, Niebe, Erleben 2009): after a round a part of the last direction is added, and the next round puts right what that has broken. The last word
 * always has a plain round, so every impulse is one that the response asked for.
 *
 * More points may push than there are freedoms to push on (two material points over a cell, nodes of two meshes face to face). Their conditions then contradict each
 * other by what the gaps differ, and impulses go on moving from one to the other for ever while velocities stand still: the rounds end there, too.
 *
 * Where one of the bodies is of points and the other shows faces, which forces bear a load is next to undetermined (points of either body against faces of the other are
 * several for each freedom of the grid): 1e4 rounds do not find them, and what a few find depends on the order of the points. There each point gives way to the change of its
 * impulse since the last step, j - j0, by the part `give` of its own inverse mass: (v - give/m (j - j0)).n <= gap/dt, and so across it. That is a step of the proximal point
 * method (Rockafellar 1976): it has one answer, which tens of rounds find to a part GIVEN whatever the order, and leaves alone what is at rest. In other words, a spring
 * of stiffness m/(give dt^2) under each point, integrated implicitly (regularised constraints: Lacoursiere 2007). With some six points on a freedom the bodies overlap by about
 * give/6 (c dt/h)^2 of what the cell beside the face is compressed by.
 *
 * On shared nodes the same is so where nodes of both bodies go by others (light nodes; elements larger than cells). The three nodes of a column which two faces cross
 * have two freedoms: v1 + v3 = 2 v2 relative to each other. Any share of the load between them holds the bodies apart, but each slips at a limit of its own, and which share
 * a few rounds found turned with the order of the nodes. These give way, too, in the dynamic stage; the kinematic one asks for velocities alone, which are one and the same.
 *
 * Forces that are next to undetermined then go to rest as slowly as the points give way: blocks that touch by their outlines crept for 1e6 steps. So the less impulses change
 * from step to step the less points give way: what they begin with is nearly right, and the rounds need not find the rest from nothing. */
#include <math.h>
#include <string.h>

#include "contact/contact.h"
#include "core/vector.h"

enum { MOST_ROUNDS = 400, PATIENCE = 6, MOST_PATIENCE = 60, PLAIN = 8 }; /* the first rounds are often enough */
/* Change of an impulse against the largest one of the stage. The kinematic stage's impulses move nothing: they put right what the remap has made of the velocities
 * at contact points, and what they leave undone is a part of that. */
static const double STANDSTILL[] = {[AB_STAGE_DYNAMIC] = 1e-13, [AB_STAGE_KINEMATIC] = 1e-9};
static const double PROGRESS = 0.9; /* PATIENCE rounds must bring the change down to this part of what it was */
/* Meshes that are held together share one motion along their seam, which takes many rounds to find, and what is left of the rest does work: MOST_PATIENCE then. (Points
 * that are held would stiffen the seam to one straight line if they were held exactly: several for each freedom of the grid.) */
static const double LITTLE_PROGRESS = 0.99;

/* STANDSTILL of points that give way; and how far they do. Less needs more rounds, more makes bodies overlap by more. The kinematic stage moves nothing and may give more, but
 * not much: with ten times as much as in the dynamic stage it lags behind so far that blocks at rest begin to rock by themselves. */
static const double GIVEN[] = {1e-12, 1e-9}; /* at shared nodes; on surfaces */
static const double GIVE[] = {[AB_STAGE_DYNAMIC] = 0.1, [AB_STAGE_KINEMATIC] = 0.2};

/* They give way in full where an impulse changes by 1/CALM of the largest one in a step, and by LEAST_GIVE of that at rest. */
static const double CALM = 1e4, LEAST_GIVE = 1e-3;

double contact_give(const contact_points *points, ab_stage stage) {
    return GIVE[stage] * ab_smaller(1.0, ab_larger(LEAST_GIVE, CALM * points->unrest));
}

static void note_unrest(contact_points *points) {
    const ab_points *p = &points->view;
    double change2 = 0.0, largest2 = 0.0;
    for (size_t i = 0; i < p->count; ++i) {
        const double jx = p->impulse[i], jy = p->impulse[p->ld + i], dx = jx - points->begun[i], dy = jy - points->begun[p->ld + i];
        change2 = ab_larger(change2, dx * dx + dy * dy);
        largest2 = ab_larger(largest2, jx * jx + jy * jy);
    }
    points->unrest = largest2 > 0.0 ? sqrt(change2 / largest2) : 1.0;
}

typedef struct progress {
    bool pulls; /* some point between meshes pulls */
    double change2, largest2,
        square; /* N2 s2: squares of the largest change of an impulse in a round and of the largest impulse, sum of squared changes */
} progress;

/* In the kinematic stage the conditions are equalities: points that pushed in the dynamic stage keep the relative velocity it left them with along the
 * normal, and across it where they pushed across it, whether they stuck or slipped. So the impulses do the same work on the velocities that strain the bodies as on
 * those that move them. Else a slip that the remap has made smaller or turned round lets stress that bears the friction store what friction should take; and
 * with the inequality again noise that separates would pass and noise that approaches would not. Both pump energy into the strain. `history`: rows of HISTORY_*. */
static void keep_relative_velocity(contact_pair *pair, size_t first, size_t count, const double *history) {
    ab_points *p = &pair->points.view;
    const size_t ld = p->ld;
    for (size_t i = first; i < first + count; ++i) {
        const int status = (int)history[HISTORY_STATUS * ld + i];
        if (status == STATUS_FREE) {
            p->impulse[i] = p->impulse[ld + i] = 0.0;
            continue;
        }
        const double nx = p->normal[i], ny = p->normal[ld + i], vx = p->relative_velocity[i], vy = p->relative_velocity[ld + i];
        const double jn = p->normal_mass[i] * (vx * nx + vy * ny - history[HISTORY_NORMAL * ld + i]);
        const double jt = status == STATUS_BOTH ? p->tangential_mass[i] * (vy * nx - vx * ny - history[HISTORY_TANGENTIAL * ld + i]) : 0.0;
        p->impulse[i] += jn * nx - jt * ny;
        p->impulse[ld + i] += jn * ny + jt * nx;
    }
}

/* What a point gives way to the change of its impulse since the last step, taken from the relative velocity that the response sees. */
static void give_way(const contact_points *points, size_t i, double v[2]) {
    const ab_points *p = &points->view;
    const double part = points->give / (1.0 + points->give), nx = p->normal[i], ny = p->normal[p->ld + i];
    const double jx = p->impulse[i] - points->begun[i], jy = p->impulse[p->ld + i] - points->begun[p->ld + i];
    const double un = p->normal_mass[i] > 0.0 ? part * (jx * nx + jy * ny) / p->normal_mass[i] : 0.0;
    const double ut = p->tangential_mass[i] > 0.0 ? part * (jy * nx - jx * ny) / p->tangential_mass[i] : 0.0;
    v[0] -= un * nx - ut * ny;
    v[1] -= un * ny + ut * nx;
}

/* What point i wants beyond what its dofs have felt. */
static void apply(contact_pair *pair, const contact_side side[2], size_t i, progress *so_far) {
    const ab_points *p = &pair->points.view;
    double j[2];
    for (size_t c = 0; c < 2; ++c) {
        const size_t k = c * p->ld + i;
        j[c] = p->impulse[k] - pair->points.applied[k];
        pair->points.applied[k] = p->impulse[k];
        pair->points.change[k] = j[c];
    }
    const double jx = p->impulse[i], jy = p->impulse[p->ld + i];
    so_far->pulls = so_far->pulls || (pair->points.meshes && jx * p->normal[i] + jy * p->normal[p->ld + i] < 0.0);
    so_far->largest2 = ab_larger(so_far->largest2, jx * jx + jy * jy);
    if (j[0] == 0.0 && j[1] == 0.0) return;
    const double square = j[0] * j[0] + j[1] * j[1];
    so_far->change2 = ab_larger(so_far->change2, square);
    so_far->square += square;
    contact_push(side, i, j);
}

/* One round over a pair's points. history: NULL in the dynamic stage. */
static ab_status round_over(contact_pair *pair, const contact_side side[2], const double *history, progress *so_far, ab_report *report) {
    contact_points *points = &pair->points;
    ab_points *p = &points->view;
    double *relative = (double *)(uintptr_t)p->relative_velocity;
    const size_t batch = points->shared ? 1 : p->count;
    const ab_contact_ops *ops = &pair->spec->responder->contact;
    for (size_t first = 0; first < p->count; first += batch) {
        for (size_t i = first; i < first + batch; ++i) {
            double v[2];
            contact_relative_velocity(side, false, i, v);
            if (points->give > 0.0) give_way(points, i, v);
            relative[i] = v[0];
            relative[p->ld + i] = v[1];
        }
        if (history)
            keep_relative_velocity(pair, first, batch, history);
        else {
            const int code = ops->respond(pair->responder, p, first, batch);
            if (code != 0) return contact_complain(pair, &pair->responder_service, "respond", code, report);
        }
        for (size_t i = first; i < first + batch; ++i) apply(pair, side, i, so_far);
    }
    return AB_OK;
}

/* After a round: `part` of the last direction on top of it. direction becomes part * direction + what the round has changed. */
static void go_on(contact_pair *pair, const contact_side side[2], double part) {
    contact_points *points = &pair->points;
    const ab_points *p = &points->view;
    const size_t ld = p->ld;
    for (size_t i = 0; i < p->count; ++i) {
        double *dx = points->direction + i, *dy = dx + ld;
        if (part == 0.0) {
            *dx = points->change[i];
            *dy = points->change[ld + i];
            continue;
        }
        const double j[2] = {part * *dx, part * *dy};
        *dx = j[0] + points->change[i];
        *dy = j[1] + points->change[ld + i];
        if (j[0] == 0.0 && j[1] == 0.0) continue;
        for (size_t c = 0; c < 2; ++c) p->impulse[c * ld + i] += j[c], points->applied[c * ld + i] = p->impulse[c * ld + i];
        contact_push(side, i, j);
    }
}

ab_status contact_rounds(contact_pair *pairs, size_t count, ab_stage stage, bool answered, ab_report *report) {
    size_t active = 0;
    bool again = false, holds = false, give = true, gives = false, surfaces = false; /* all give way; some do; some are of surfaces */
    for (size_t k = 0; k < count; ++k) {
        if (!pairs[k].points.view.count) continue;
        ++active;
        give = give && pairs[k].points.give > 0.0;
        gives = gives || pairs[k].points.give > 0.0;
        surfaces = surfaces || pairs[k].points.surfaces;
        again = again || pairs[k].points.shared || pairs[k].points.held;
        holds = holds || (stage == AB_STAGE_DYNAMIC && pairs[k].points.view.fixed_places);
    }
    again = again || active > 1;
    const double enough = give ? GIVEN[surfaces] : STANDSTILL[stage];
    double square = 0.0, least = INFINITY;
    int since = 0; /* rounds since the change was that small */
    for (int round = 0; active && round < (again ? MOST_ROUNDS : 1); ++round) {
        progress so_far = {0};
        for (size_t k = 0; k < count; ++k) {
            contact_pair *pair = pairs + k;
            const ab_points *p = &pair->points.view;
            if (!p->count) continue;
            contact_side side[2];
            contact_sides(pair, side);
            const double *history = stage == AB_STAGE_KINEMATIC ? contact_history(pair, answered) : NULL;
            AB_TRY(round_over(pair, side, history, &so_far, report));
        }
        const double change = sqrt(so_far.change2), largest = sqrt(so_far.largest2);
        holds = holds || (stage == AB_STAGE_DYNAMIC && so_far.pulls);
        if (change < (holds || gives ? LITTLE_PROGRESS : PROGRESS) * least) least = change, since = 0;
        if (!again || change <= enough * largest || ++since > (holds || gives ? MOST_PATIENCE : PATIENCE))
            break;
        const double part = round > PLAIN && so_far.square < square ? so_far.square / square : 0.0;
        square = so_far.square;
        for (size_t k = 0; k < count && round >= PLAIN && round + 1 < MOST_ROUNDS; ++k) {
            if (!pairs[k].points.view.count) continue;
            contact_side side[2];
            contact_sides(pairs + k, side);
            go_on(pairs + k, side, part);
        }
    }
    for (size_t k = 0; stage == AB_STAGE_DYNAMIC && k < count; ++k)
        if (pairs[k].points.gives) note_unrest(&pairs[k].points);
    return AB_OK;
}
