/* guard_find.c: find of a contact plugin under guard. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/guard.h"

static const double EXACT = 1e-9; /* of 1: sums of weights, lengths of normals */

enum { TRACE = 18, TRACES = 2 * TRACE }; /* arrays of one side beside its surface, which stay below AB_GUARDED_MOST */

typedef struct finding { /* a call of find under way: sets of arrays of either side, and of what find writes */
    ab_guard *guard;
    ab_guard_set *side[2], *surface[2], *out;
    ab_trace a, b;
    ab_surface surface_a, surface_b;
    ab_points shown;
    ab_points *real;
    size_t stencil; /* room of a_dof, b_dof */
} finding;

static bool show_trace(ab_guard_set *set, const ab_trace *t, ab_trace *inner) {
    const size_t n = t->count, d = t->dimension;
    *inner = *t;
    const size_t stencil = t->stencil_start ? t->stencil_start[n] : 0, near = t->near_start ? t->near_start[n] : 0;
    inner->ld = n, inner->near_ld = near;
    size_t k = 0;
    if (n == 0) return true; /* with surfaces alone no node is looked for */
    return ab_guard_show_rows(set, k++, "position", &inner->position, d, n, t->ld) &&
           ab_guard_show(set, k++, "stencil_start", &inner->stencil_start, (n + 1) * sizeof(size_t)) &&
           ab_guard_show(set, k++, "stencil_dof", &inner->stencil_dof, stencil * sizeof(uint32_t)) &&
           ab_guard_show(set, k++, "stencil_weight", &inner->stencil_weight, stencil * sizeof(double)) &&
           ab_guard_show(set, k++, "key", &inner->key, n * sizeof(uint64_t)) &&
           ab_guard_show_rows(set, k++, "mass", &inner->mass, 1, n, t->ld) &&
           ab_guard_show_rows(set, k++, "mass_gradient", &inner->mass_gradient, d, n, t->ld) &&
           ab_guard_show_rows(set, k++, "area_vector", &inner->area_vector, d, n, t->ld) &&
           ab_guard_show(set, k++, "near_start", &inner->near_start, (n + 1) * sizeof(size_t)) &&
           ab_guard_show_rows(set, k++, "near_position", &inner->near_position, d, near, t->near_ld) &&
           ab_guard_show_rows(set, k++, "near_extent", &inner->near_extent, d == 2 ? 3 : 6, near, t->near_ld) &&
           ab_guard_show_rows(set, k++, "density_gradient", &inner->density_gradient, d, n, t->ld) &&
           ab_guard_show_rows(set, k++, "face_normal", &inner->face_normal, d, n, t->ld) &&
           ab_guard_show_rows(set, k++, "face_distance", &inner->face_distance, 1, n, t->ld) &&
           ab_guard_show_rows(set, k++, "face_turn", &inner->face_turn, 1, n, t->ld);
}

static bool show_surface(ab_guard_set *set, const ab_surface *s, ab_surface *inner) {
    const size_t n = s->point_count, v = s->vertex_count, d = s->dimension;
    *inner = *s;
    inner->point_ld = n, inner->vertex_ld = v;
    size_t k = 0;
    return ab_guard_show_rows(set, k++, "point_position", &inner->point_position, d, n, s->point_ld) &&
           ab_guard_show_rows(set, k++, "point_extent", &inner->point_extent, d == 2 ? 3 : 6, n, s->point_ld) &&
           ab_guard_show_rows(set, k++, "point_area", &inner->point_area, 1, n, s->point_ld) &&
           ab_guard_show(set, k++, "point_key", &inner->point_key, n * sizeof(uint64_t)) &&
           ab_guard_show(set, k++, "point_start", &inner->point_start, (n + 1) * sizeof(size_t)) &&
           ab_guard_show(set, k++, "point_dof", &inner->point_dof, (s->point_start ? s->point_start[n] : 0) * sizeof(uint32_t)) &&
           ab_guard_show(set, k++, "point_weight", &inner->point_weight, (s->point_start ? s->point_start[n] : 0) * sizeof(double)) &&
           ab_guard_show(set, k++, "near_start", &inner->near_start, (n + 1) * sizeof(size_t)) &&
           ab_guard_show(set, k++, "near_face", &inner->near_face, (s->near_start ? s->near_start[n] : 0) * sizeof(uint32_t)) &&
           ab_guard_show_rows(set, k++, "vertex_position", &inner->vertex_position, d, v, s->vertex_ld) &&
           ab_guard_show(set, k++, "vertex_start", &inner->vertex_start, (v + 1) * sizeof(size_t)) &&
           ab_guard_show(set, k++, "vertex_dof", &inner->vertex_dof, (s->vertex_start ? s->vertex_start[v] : 0) * sizeof(uint32_t)) &&
           ab_guard_show(set, k++, "vertex_weight", &inner->vertex_weight, (s->vertex_start ? s->vertex_start[v] : 0) * sizeof(double)) &&
           ab_guard_show(set, k++, "face_vertex", &inner->face_vertex, 3 * s->face_count * sizeof(uint32_t)) &&
           ab_guard_show(set, k++, "face_beside", &inner->face_beside, 2 * s->face_count * sizeof(uint32_t)) &&
           ab_guard_show(set, k++, "point_vertex", &inner->point_vertex, n * sizeof(uint32_t));
}

/* Arrays that find writes, for `points` points and stencils of `stencil`; what `done` points hold already is kept. */
static bool open_out(finding *f, size_t points, size_t stencil) {
    const size_t d = f->shown.dimension, done = f->shown.count, old_ld = f->shown.ld;
    ab_guard_set *set = calloc(1, sizeof *set), *old = f->out;
    if (!set) return false;
    ab_points now = f->shown;
    now.capacity = now.ld = points;
    struct {
        const char *name;
        void *array, *old;
        size_t rows, ld, old_ld, size, keep;
    } out[] = {{"key", &now.key, f->shown.key, 1, points, old_ld, sizeof(uint64_t), done},
               {"position", &now.position, f->shown.position, d, points, old_ld, sizeof(double), done},
               {"normal", &now.normal, f->shown.normal, d, points, old_ld, sizeof(double), done},
               {"gap", &now.gap, f->shown.gap, 1, points, old_ld, sizeof(double), done},
               {"area", &now.area, f->shown.area, 1, points, old_ld, sizeof(double), done},
               {"distance", &now.distance, f->shown.distance, 1, points, old_ld, sizeof(double), done},
               {"a_start", &now.a_start, f->shown.a_start, 1, points + 1, old_ld + 1, sizeof(size_t), done + 1},
               {"b_start", &now.b_start, f->shown.b_start, 1, points + 1, old_ld + 1, sizeof(size_t), done + 1},
               {"a_dof", &now.a_dof, f->shown.a_dof, 1, stencil, f->stencil, sizeof(uint32_t), f->stencil},
               {"b_dof", &now.b_dof, f->shown.b_dof, 1, stencil, f->stencil, sizeof(uint32_t), f->stencil},
               {"a_weight", &now.a_weight, f->shown.a_weight, 1, stencil, f->stencil, sizeof(double), f->stencil},
               {"b_weight", &now.b_weight, f->shown.b_weight, 1, stencil, f->stencil, sizeof(double), f->stencil}};
    bool good = true;
    for (size_t k = 0; good && k < sizeof out / sizeof *out; k++) {
        if (!strcmp(out[k].name, "distance") && !f->real->distance) {
            now.distance = NULL;
            continue;
        }
        char *own = ab_guard_room(set, k, out[k].name, out[k].rows * out[k].ld * out[k].size, false, out[k].array);
        good = own != NULL;
        const size_t all = out[k].rows * out[k].ld * out[k].size;
        for (size_t i = 0; good && out[k].size == sizeof(double) && i + sizeof(double) <= all; i += sizeof(double)) {
            const double poison = ab_guard_poison();
            memcpy(own + i, &poison, sizeof poison);
        }
        if (good && out[k].size == sizeof(uint32_t)) memset(own, 0, all);
        for (size_t r = 0; good && old && out[k].old && r < out[k].rows; r++)
            memcpy(own + r * out[k].ld * out[k].size, (char *)out[k].old + r * out[k].old_ld * out[k].size, out[k].keep * out[k].size);
    }
    if (!good) {
        ab_guard_set_clear(set);
        free(set);
        return false;
    }
    f->shown = now;
    f->stencil = stencil;
    f->out = set;
    f->surface[1]->beside = set;
    if (!old) now.a_start[0] = now.b_start[0] = 0;
    if (old) ab_guard_set_clear(old), free(old);
    return true;
}

int ab_guard_reserve(void *context, ab_points *points, size_t points_more, size_t stencil_more) {
    ab_guard *guard = context;
    finding *f = guard->finding;
    if (!f || points != &f->shown)
        return ab_guard_break(guard, AB_PROMISE_ARRAYS, "it called host->reserve outside of find, or with other points than it was given");
    const size_t count = points->count + points_more,
                 filled = points->count ? points->a_start[points->count] + points->b_start[points->count] : 0;
    const size_t stencil = points_more + stencil_more + filled;
    if (count <= points->capacity && stencil <= f->stencil) return 0;
    return open_out(f, count > points->capacity ? count : points->capacity, stencil > f->stencil ? stencil : f->stencil) ? 0 : -1;
}

static int call_find(void *data) {
    finding *f = data;
    return f->guard->inner->contact.find(f->guard->self, &f->a, &f->b, &f->shown);
}

/* One side's stencil of point i. */
static int look_at_stencil(ab_guard *guard, const finding *f, size_t i, const char *side, const size_t *start, const double *weight) {
    double sum = 0.0;
    if (start[i + 1] < start[i] || start[i + 1] > f->stencil)
        return ab_guard_break(guard, AB_PROMISE_ARRAYS, "%s_start of point %zu goes from %zu to %zu, and there is room for %zu", side, i,
                              start[i], start[i + 1], f->stencil);
    for (size_t s = start[i]; s < start[i + 1]; s++) {
        if (!isfinite(weight[s]))
            return ab_guard_break(guard, AB_PROMISE_FINITE, "a weight of side %s of point %zu %s", side, i,
                                  ab_guard_poisoned(weight[s]) ? "was not written" : "is no finite number");
        sum += weight[s];
    }
    if (start[i + 1] > start[i] && !(fabs(sum - 1.0) <= EXACT))
        return ab_guard_break(guard, AB_PROMISE_MOMENTUM, "weights of side %s of point %zu sum to %.12g, not 1", side, i, sum);
    return 0;
}

static int look_at_points(ab_guard *guard, const finding *f) {
    const ab_points *p = &f->shown;
    if (p->count > p->capacity)
        return ab_guard_break(guard, AB_PROMISE_ARRAYS, "it says it found %zu points, and there is room for %zu", p->count, p->capacity);
    if (p->a_start[0] != 0 || p->b_start[0] != 0) return ab_guard_break(guard, AB_PROMISE_ARRAYS, "a_start[0] and b_start[0] must be 0");
    for (size_t i = 0; i < p->count; i++) {
        double square = 0.0;
        for (size_t c = 0; c < p->dimension; c++) {
            const double n = p->normal[c * p->ld + i], x = p->position[c * p->ld + i];
            if (!isfinite(n) || !isfinite(x))
                return ab_guard_break(guard, AB_PROMISE_FINITE, "normal or position of point %zu of %zu %s at t = %g s", i, p->count,
                                      ab_guard_poisoned(n) || ab_guard_poisoned(x) ? "was not written" : "is no finite number", p->time);
            square += n * n;
        }
        if (!isfinite(p->gap[i]) || !isfinite(p->area[i]) || p->area[i] < 0.0 || (p->distance && !(p->distance[i] >= 0.0)))
            return ab_guard_break(
                guard, AB_PROMISE_FINITE,
                "point %zu of %zu at (%g, %g) m from the grid's corner has gap %g m, area %g m2, distance %g m at t = %g s", i, p->count,
                p->position[i], p->position[p->ld + i], p->gap[i], p->area[i], p->distance ? p->distance[i] : 0.0, p->time);
        if (!(fabs(square - 1.0) <= EXACT))
            return ab_guard_break(guard, AB_PROMISE_MOMENTUM, "the normal of point %zu of %zu has length %.12g, not 1", i, p->count,
                                  sqrt(square));
        int code;
        if ((code = look_at_stencil(guard, f, i, "a", p->a_start, p->a_weight)) ||
            (code = look_at_stencil(guard, f, i, "b", p->b_start, p->b_weight)))
            return code;
    }
    return 0;
}

/* Into the host's arrays, which reserve makes large enough. */
static int give_points(ab_guard *guard, const finding *f) {
    const ab_points *p = &f->shown;
    ab_points *real = f->real;
    const size_t n = p->count, a = p->a_start[n], b = p->b_start[n];
    real->count = 0;
    const ab_host *host = &guard->service->host;
    if (host->reserve(host->context, real, n, a > b ? a : b) != 0) return ab_guard_no_memory(guard);
    for (size_t c = 0; c < p->dimension; c++) {
        memcpy(real->position + c * real->ld, p->position + c * p->ld, n * sizeof(double));
        memcpy(real->normal + c * real->ld, p->normal + c * p->ld, n * sizeof(double));
    }
    memcpy(real->key, p->key, n * sizeof *p->key);
    memcpy(real->gap, p->gap, n * sizeof(double));
    memcpy(real->area, p->area, n * sizeof(double));
    if (p->distance) memcpy(real->distance, p->distance, n * sizeof(double));
    memcpy(real->a_start, p->a_start, (n + 1) * sizeof(size_t)), memcpy(real->b_start, p->b_start, (n + 1) * sizeof(size_t));
    memcpy(real->a_dof, p->a_dof, a * sizeof(uint32_t)), memcpy(real->b_dof, p->b_dof, b * sizeof(uint32_t));
    memcpy(real->a_weight, p->a_weight, a * sizeof(double)), memcpy(real->b_weight, p->b_weight, b * sizeof(double));
    real->count = n;
    real->failures = p->failures;
    return 0;
}

int ab_guard_find(void *self, const ab_trace *a, const ab_trace *b, ab_points *out) {
    ab_guard *guard = self;
    finding f = {.guard = guard, .real = out, .shown = *out};
    bool good = true;
    for (int k = 0; k < 2; k++) good = (f.side[k] = ab_guard_take(guard)) && (f.surface[k] = ab_guard_take(guard)) && good;
    f.shown.capacity = f.shown.ld = f.shown.count = 0;
    if (good) f.side[0]->beside = f.side[1], f.side[1]->beside = f.surface[0], f.surface[0]->beside = f.surface[1];
    good = good && show_trace(f.side[0], a, &f.a) && show_trace(f.side[1], b, &f.b);
    if (good && a->surface) good = show_surface(f.surface[0], a->surface, &f.surface_a), f.a.surface = &f.surface_a;
    if (good && b->surface) good = show_surface(f.surface[1], b->surface, &f.surface_b), f.b.surface = &f.surface_b;
    const size_t nodes = a->count, of_a = nodes ? a->stencil_start[nodes] : 0, of_b = nodes ? b->stencil_start[nodes] : 0;
    good = good && open_out(&f, nodes, of_a > of_b ? of_a : of_b);
    /* what a response is given is not there yet */
    f.shown.relative_velocity = f.shown.normal_mass = f.shown.tangential_mass = f.shown.state0 = f.shown.relative_velocity_old = NULL;
    f.shown.impulse = f.shown.state1 = f.shown.stiffness = NULL;
    int code = good ? 0 : ab_guard_no_memory(guard);
    ab_fault fault;
    guard->finding = &f;
    const bool back = code != 0 || ab_guard_call(f.side[0], call_find, &f, &code, &fault);
    guard->finding = NULL;
    if (!back)
        code = ab_guard_break(guard, fault.promise, "%s, between '%s' and '%s' at t = %g s", fault.text, a->body, b->body, out->time);
    if (code == 0) {
        const char *before = ab_guard_underrun(f.out);
        if (before)
            code = ab_guard_break(guard, AB_PROMISE_ARRAYS, "it wrote before the start of %s, between '%s' and '%s'", before, a->body,
                                  b->body);
    }
    if (code == 0) code = look_at_points(guard, &f);
    if (code == 0) code = give_points(guard, &f);
    for (int k = 0; k < 2; k++) {
        if (f.side[k]) ab_guard_give(guard, f.side[k]);
        if (f.surface[k]) ab_guard_give(guard, f.surface[k]);
    }
    if (f.out) ab_guard_set_clear(f.out), free(f.out);
    return code;
}
