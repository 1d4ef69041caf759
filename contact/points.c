/* points.c: arrays of contact points: room, effective masses, history. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/contact.h"
#include "core/vector.h"

static bool resize(void *pointer, size_t old_rows, size_t rows, size_t old_ld, size_t ld, size_t size) {
    char **p = pointer;
    char *more = aligned_alloc(64, (rows * ld * size + 63) / 64 * 64);
    if (!more) return false;
    memset(more, 0, (rows * ld * size + 63) / 64 * 64);
    for (size_t r = 0; *p && r < old_rows; ++r) memcpy(more + r * ld * size, *p + r * old_ld * size, old_ld * size);
    free(*p);
    *p = more;
    return true;
}

bool contact_points_reserve(contact_points *points, size_t count, size_t stencil) {
    ab_points *v = &points->view;
    if (count > v->capacity || !v->normal) {
        const size_t old = v->capacity, n = (2 * count + 64) / 8 * 8, s = points->states;
        double *state0 = (double *)(uintptr_t)v->state0, *relative = (double *)(uintptr_t)v->relative_velocity,
               *mn = (double *)(uintptr_t)v->normal_mass, *mt = (double *)(uintptr_t)v->tangential_mass;
        if (!resize(&v->key, 1, 1, old, n, sizeof *v->key) || !resize(&v->normal, 2, 2, old, n, sizeof(double)) ||
            !resize(&v->position, 2, 2, old, n, sizeof(double)) || !resize(&v->gap, 1, 1, old, n, sizeof(double)) ||
            !resize(&v->area, 1, 1, old, n, sizeof(double)) || !resize(&v->stiffness, 1, 1, old, n, sizeof(double)) ||
            (points->distances && !resize(&v->distance, 1, 1, old, n, sizeof(double))) ||
            !resize(&relative, 2, 2, old, n, sizeof(double)) || !resize(&mn, 1, 1, old, n, sizeof(double)) ||
            !resize(&mt, 1, 1, old, n, sizeof(double)) || !resize(&v->impulse, 2, 2, old, n, sizeof(double)) ||
            !resize(&state0, s, s, old, n, sizeof(double)) || !resize(&v->state1, s, s, old, n, sizeof(double)) ||
            !resize(&points->relative_old, 2, 2, old, n, sizeof(double)) || !resize(&points->applied, 2, 2, old, n, sizeof(double)) ||
            !resize(&points->change, 2, 2, old, n, sizeof(double)) || !resize(&points->direction, 2, 2, old, n, sizeof(double)) ||
            (points->gives && !resize(&points->begun, 2, 2, old, n, sizeof(double))) ||
            !resize(&v->a_start, 1, 1, old ? old + 1 : 0, n + 1, sizeof(size_t)) ||
            !resize(&v->b_start, 1, 1, old ? old + 1 : 0, n + 1, sizeof(size_t)))
            return false;
        v->state0 = state0;
        v->relative_velocity = relative;
        v->relative_velocity_old = points->relative_old;
        v->normal_mass = mn;
        v->tangential_mass = mt;
        v->capacity = v->ld = n;
    }
    if (stencil > points->stencil_a || !v->a_dof) {
        const size_t old = points->stencil_a, n = 2 * stencil + 64;
        if (!resize(&v->a_dof, 1, 1, old, n, sizeof(uint32_t)) || !resize(&v->a_weight, 1, 1, old, n, sizeof(double))) return false;
        points->stencil_a = n;
    }
    if (stencil > points->stencil_b || !v->b_dof) {
        const size_t old = points->stencil_b, n = 2 * stencil + 64;
        if (!resize(&v->b_dof, 1, 1, old, n, sizeof(uint32_t)) || !resize(&v->b_weight, 1, 1, old, n, sizeof(double))) return false;
        points->stencil_b = n;
    }
    return true;
}

void contact_points_destroy(contact_points *points) {
    ab_points *v = &points->view;
    free(v->key), free(v->normal), free(v->position), free(v->gap), free(v->area), free(v->distance), free(v->stiffness),
        free((void *)(uintptr_t)v->relative_velocity), free((void *)(uintptr_t)v->normal_mass);
    free((void *)(uintptr_t)v->tangential_mass), free(v->impulse), free((void *)(uintptr_t)v->state0), free(v->state1),
        free(points->relative_old);
    free(points->applied), free(points->change), free(points->direction), free(points->begun), free(v->a_start), free(v->b_start);
    free(v->a_dof), free(v->a_weight), free(v->b_dof), free(v->b_weight), free(points->old_key), free(points->old_state);
    free(points->seen), free(points->carried);
    contact_sums_destroy(&points->sums);
    contact_spread_destroy(&points->spread);
    contact_light_destroy(&points->light);
}

/* Where a side of the grid holds one direction of both bodies, only the other is left: it is the normal's or the tangent's, whichever lies closer (within 60
 * degrees: the normal's). A normal that is oblique by however little would let normal and tangential answers work on the same freedom, each as if it were
 * alone, and the loop would swing for ever. Not so where a body that turns as a whole is held: its guide takes the force that an oblique face gives it. */
static void fit_normal_to_sides(ab_points *v, size_t i, const contact_side side[2]) {
    if (side[0].dofs.spin || side[1].dofs.spin) return;
    const bool x = contact_all_held(side, i, 0), y = contact_all_held(side, i, 1);
    if (x == y) return;
    double *held = v->normal + (x ? 0 : v->ld) + i, *left = v->normal + (x ? v->ld : 0) + i;
    const bool normal = fabs(*left) >= 0.5;
    *left = normal ? copysign(1.0, *left) : 0.0;
    *held = normal ? 0.0 : copysign(1.0, *held);
}

/* True when some dof serves more than one point of this pair. Stencils that are one node each, in ascending order, never do. -1: no memory. */
static int shares_dofs(contact_points *points, const size_t *start, const uint32_t *dof, size_t count) {
    bool ascending = start[count] == count;
    for (size_t k = 1; ascending && k < count; ++k) ascending = dof[k] > dof[k - 1];
    if (ascending) return 0;
    if (++points->look == 0) { /* after 2^32 looks */
        memset(points->seen, 0, points->seen_capacity * sizeof *points->seen);
        points->look = 1;
    }
    for (size_t e = 0; e < start[count]; ++e) {
        if (dof[e] >= points->seen_capacity) {
            const size_t n = 2 * (size_t)dof[e] + 64;
            uint32_t *more = realloc(points->seen, n * sizeof *more);
            if (!more) return -1;
            memset(more + points->seen_capacity, 0, (n - points->seen_capacity) * sizeof *more);
            points->seen = more;
            points->seen_capacity = n;
        }
        if (points->seen[dof[e]] == points->look) return 1;
        points->seen[dof[e]] = points->look;
    }
    return 0;
}

/* Brings the states of points that were there in the last step (same key) into state0; new ones begin at 0, but for their share of what is a sum. */
static bool recall(contact_points *points) {
    ab_points *v = &points->view;
    double *state0 = (double *)(uintptr_t)v->state0;
    uint32_t *now = points->sums.rows ? points->sums.now : NULL;
    for (size_t j = 0; now && j < points->old_count; ++j) now[j] = UINT32_MAX;
    for (size_t i = 0; i < v->count; ++i) {
        size_t low = 0, high = points->old_count;
        while (low < high) {
            const size_t middle = (low + high) / 2;
            if (points->old_key[middle] < v->key[i])
                low = middle + 1;
            else
                high = middle;
        }
        const bool known = low < points->old_count && points->old_key[low] == v->key[i];
        for (size_t s = 0; s < points->states; ++s) state0[s * v->ld + i] = known ? points->old_state[s * points->old_capacity + low] : 0.0;
        if (now && known) now[low] = (uint32_t)i;
    }
    return contact_share_sums(points);
}

typedef struct remembered {
    uint64_t key;
    uint32_t point;
} remembered;

static int compare_remembered(const void *a, const void *b) {
    const remembered *x = a, *y = b;
    return (x->key > y->key) - (x->key < y->key);
}

bool contact_points_remember(contact_points *points) {
    ab_points *v = &points->view;
    remembered *list = malloc((v->count + 1) * sizeof *list);
    points->old_count = 0;
    if (!list) return false;
    for (size_t i = 0; i < v->count; ++i) list[i] = (remembered){v->key[i], (uint32_t)i};
    qsort(list, v->count, sizeof *list, compare_remembered);
    if (v->count > points->old_capacity || !points->old_key) {
        free(points->old_key), free(points->old_state), free(points->sums.old_place), free(points->sums.now);
        points->old_capacity = v->capacity;
        points->old_key = malloc(points->old_capacity * sizeof *points->old_key);
        points->old_state = malloc(points->old_capacity * points->states * sizeof *points->old_state);
        points->sums.old_place = malloc(2 * points->old_capacity * sizeof *points->sums.old_place);
        points->sums.now = malloc(points->old_capacity * sizeof *points->sums.now);
    }
    const bool room = points->old_key && points->old_state && points->sums.old_place && points->sums.now;
    if (room) points->old_count = v->count;
    for (size_t k = 0; k < points->old_count; ++k) {
        points->old_key[k] = list[k].key;
        for (size_t c = 0; c < 2; ++c) points->sums.old_place[2 * k + c] = v->position[c * v->ld + list[k].point];
        for (size_t s = 0; s < points->states; ++s) points->old_state[s * points->old_capacity + k] = v->state1[s * v->ld + list[k].point];
    }
    free(list);
    return room;
}

/* Where an impulse along the normal changes the velocity across it, the two halves of an answer, each made as if it were alone, overshoot together: by up to
 * twice where they work on one and the same freedom (a body on a pivot, a node that a side guides along a slope), and the loop would swing for ever. Masses that
 * are smaller by 1 + c, c = |K_nt|/sqrt(K_nn K_tt), make the answers a damped iteration that never overshoots and ends at the same impulses. */
static double share_of_mass(const contact_side side[2], size_t i, const double n[2], double in, double it, bool turns, bool *held) {
    const double coupling = contact_coupling(side, i, n, turns);
    if (coupling == 0.0 || !(in > 0.0) || !(it > 0.0)) return 1.0;
    *held = true;
    return 1.0 / (1.0 + ab_smaller(1.0, fabs(coupling) / sqrt(in * it)));
}

bool contact_points_prepare(contact_points *points, const contact_side side[2], ab_stage stage) {
    ab_points *v = &points->view;
    double *mn = (double *)(uintptr_t)v->normal_mass, *mt = (double *)(uintptr_t)v->tangential_mass;
    const int shared_a = shares_dofs(points, v->a_start, v->a_dof, v->count),
              shared_b = shares_dofs(points, v->b_start, v->b_dof, v->count);
    if (shared_a < 0 || shared_b < 0) return false;
    points->shared = shared_a || shared_b;
    const bool dependent = points->surfaces || (shared_a && shared_b && stage == AB_STAGE_DYNAMIC);
    points->give = points->gives && dependent ? contact_give(points, stage) : 0.0;
    bool held = false;
    for (size_t i = 0; i < v->count; ++i) {
        if (!points->surfaces) fit_normal_to_sides(v, i, side);
        const double n[2] = {v->normal[i], v->normal[v->ld + i]}, t[2] = {-n[1], n[0]};
        const double in = contact_inverse_mass(side, i, n, &held), it = contact_inverse_mass(side, i, t, &held);
        const double share = share_of_mass(side, i, n, in, it, !points->surfaces, &held) / (1.0 + points->give);
        mn[i] = in > 0.0 ? share / in : 0.0;
        mt[i] = it > 0.0 ? share / it : 0.0;
    }
    points->held = held;
    return recall(points);
}
