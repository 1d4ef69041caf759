/* nearest_face.c: for a finder that asks for it, the face of a body nearest to each of the nodes it shares with another: where it lies and which way is out. Each
 * face is held against the nodes within REACH of it, found by their place on the grid, so that the cost goes with the faces near the contact. */
#include <math.h>
#include <stdlib.h>

#include "contact/contact.h"
#include "core/vector.h"

static const double REACH = 2.0;    /* cells: no node that both bodies have mass at is further from the surface of either */
static const double AT_END = 1e-9;  /* of half a face: a place as near to its end is the vertex */
static const double NO_TURN = 1e-6; /* rad */
enum { SAMPLES = 8, STEPS = 8 };    /* of the way along a bent face; of Newton's method */

typedef struct contact_place { /* a node, by its place on the grid */
    uint64_t key;
    uint32_t node;
} contact_place;

struct contact_faces {
    contact_place *places; /* ascending */
    double *normal[2], *distance[2], *turn[2], *square;
    size_t capacity;
};

void contact_faces_destroy(struct contact_faces *f) {
    if (!f) return;
    for (int side = 0; side < 2; ++side) free(f->normal[side]), free(f->distance[side]), free(f->turn[side]);
    free(f->places), free(f->square), free(f);
}

static bool reserve(struct contact_faces *f, size_t ld) {
    if (ld <= f->capacity) return true;
    f->capacity = 0;
    free(f->places), free(f->square);
    f->places = malloc(ld * sizeof *f->places);
    f->square = malloc(ld * sizeof *f->square);
    bool good = f->places && f->square;
    for (int side = 0; side < 2; ++side) {
        free(f->normal[side]), free(f->distance[side]), free(f->turn[side]);
        f->normal[side] = malloc(2 * ld * sizeof(double));
        f->distance[side] = malloc(ld * sizeof(double));
        f->turn[side] = malloc(ld * sizeof(double));
        good = good && f->normal[side] && f->distance[side] && f->turn[side];
    }
    if (good) f->capacity = ld;
    return good;
}

static int compare_places(const void *a, const void *b) {
    const contact_place *x = a, *y = b;
    return (x->key > y->key) - (x->key < y->key);
}

typedef struct face { /* r(xi) = middle + xi half + (1 - xi^2) bow, -1 <= xi <= 1 */
    double middle[2], half[2], bow[2];
    bool bent;
} face;

static face face_of(const ab_surface *s, size_t number) {
    const uint32_t *v = s->face_vertex + 3 * number;
    face f = {.bent = v[2] != UINT32_MAX};
    for (size_t c = 0; c < 2; ++c) {
        const double *x = s->vertex_position + c * s->vertex_ld;
        f.middle[c] = 0.5 * (x[v[0]] + x[v[1]]);
        f.half[c] = 0.5 * (x[v[1]] - x[v[0]]);
        f.bow[c] = f.bent ? x[v[2]] - f.middle[c] : 0.0;
    }
    return f;
}

/* Unit normal at xi, outwards: right of the way along the face. */
static void normal_at(const face *f, double xi, double n[2]) {
    const double slope[2] = {f->half[0] - 2.0 * xi * f->bow[0], f->half[1] - 2.0 * xi * f->bow[1]}, length = hypot(slope[0], slope[1]);
    n[0] = length > 0.0 ? slope[1] / length : 0.0;
    n[1] = length > 0.0 ? -slope[0] / length : 0.0;
}

static double square_to(const face *f, const double x[2], double xi, double r[2]) {
    for (int c = 0; c < 2; ++c) r[c] = x[c] - f->middle[c] - xi * f->half[c] - (1.0 - xi * xi) * f->bow[c];
    return r[0] * r[0] + r[1] * r[1];
}

static double within(double xi) { return ab_larger(-1.0, ab_smaller(1.0, xi)); }

/* Where a face is nearest to x: straight in closed form, bent by Newton's method from the best of some places along it. */
static double nearest_on(const face *f, const double x[2]) {
    const double square = f->half[0] * f->half[0] + f->half[1] * f->half[1];
    if (!f->bent) return square > 0.0 ? within(((x[0] - f->middle[0]) * f->half[0] + (x[1] - f->middle[1]) * f->half[1]) / square) : 0.0;
    double best = 0.0, least = INFINITY, r[2];
    for (int k = 0; k <= SAMPLES; ++k) {
        const double xi = 2.0 * k / SAMPLES - 1.0, far = square_to(f, x, xi, r);
        if (far < least) least = far, best = xi;
    }
    for (int k = 0; k < STEPS; ++k) { /* r'.(x - r) = 0 */
        square_to(f, x, best, r);
        const double slope[2] = {f->half[0] - 2.0 * best * f->bow[0], f->half[1] - 2.0 * best * f->bow[1]};
        const double value = slope[0] * r[0] + slope[1] * r[1],
                     change = -2.0 * (f->bow[0] * r[0] + f->bow[1] * r[1]) - slope[0] * slope[0] - slope[1] * slope[1];
        if (!(change < 0.0)) break;
        best = within(best - value / change);
    }
    return best;
}

/* Takes the place at xi of a face as that of a node if no nearer one was found before. */
static void consider(const ab_surface *s, size_t number, const face *f, const double x[2], size_t node, size_t ld, double *square,
                     double *normal, double *distance, double *turn) {
    double xi = nearest_on(f, x), r[2], n[2];
    if (1.0 - fabs(xi) <= AT_END) xi = xi > 0.0 ? 1.0 : -1.0;
    const double far = square_to(f, x, xi, r);
    if (!(far < square[node])) return;
    square[node] = far;
    normal_at(f, xi, n);
    turn[node] = 0.0;
    distance[node] = sqrt(far);
    const uint32_t beside = fabs(xi) == 1.0 && s->face_beside ? s->face_beside[2 * number + (xi > 0.0)] : UINT32_MAX;
    if (beside == UINT32_MAX) {
        if (r[0] * n[0] + r[1] * n[1] < 0.0) distance[node] = -distance[node];
    } else {
        const face other = face_of(s, beside);
        double m[2];
        normal_at(&other, -xi, m);
        const double angle = fabs(atan2(n[0] * m[1] - n[1] * m[0], n[0] * m[0] + n[1] * m[1]));
        for (int c = 0; c < 2; ++c) n[c] += m[c]; /* outside is where the mean of both normals points (Baerentzen and Aanaes 2005) */
        const bool inside = r[0] * n[0] + r[1] * n[1] < 0.0;
        if (inside) distance[node] = -distance[node];
        if (angle > NO_TURN) {
            turn[node] = angle;
            if (distance[node] != 0.0)
                for (int c = 0; c < 2; ++c) n[c] = r[c] / distance[node];
        }
    }
    const double length = hypot(n[0], n[1]);
    for (size_t c = 0; c < 2; ++c) normal[c * ld + node] = length > 0.0 ? n[c] / length : 0.0;
}

static void look_from(struct contact_faces *all, const ab_surface *s, const ab_trace *t, double *normal, double *distance, double *turn) {
    const double h = t->cell;
    for (size_t k = 0; k < t->count; ++k) {
        all->square[k] = REACH * REACH * h * h;
        normal[k] = normal[t->ld + k] = turn[k] = 0.0;
        distance[k] = INFINITY;
    }
    int32_t least[2] = {INT32_MAX, INT32_MAX}, most[2] = {INT32_MIN, INT32_MIN}; /* nodes */
    for (size_t k = 0; k < t->count; ++k) {
        const int32_t at[2] = {ab_tile_x(t->key[k]), ab_tile_y(t->key[k])};
        for (int c = 0; c < 2; ++c) {
            if (at[c] < least[c]) least[c] = at[c];
            if (at[c] > most[c]) most[c] = at[c];
        }
    }
    for (size_t number = 0; number < s->face_count; ++number) {
        const face f = face_of(s, number);
        int32_t from[2], to[2];
        bool near = true;
        for (int c = 0; c < 2; ++c) {
            const double extent = fabs(f.half[c]) + fabs(f.bow[c]) + REACH * h;
            const double low = ab_larger(ceil((f.middle[c] - extent) / h), least[c]),
                         high = ab_smaller(floor((f.middle[c] + extent) / h), most[c]);
            near = near && low <= high;
            from[c] = near ? (int32_t)low : 0;
            to[c] = near ? (int32_t)high : 0;
        }
        for (int32_t j = from[1]; near && j <= to[1]; ++j) {
            const uint64_t first = ab_tile_key(from[0], j), last = ab_tile_key(to[0], j);
            size_t low = 0, high = t->count;
            while (low < high) {
                const size_t middle = (low + high) / 2;
                if (all->places[middle].key < first)
                    low = middle + 1;
                else
                    high = middle;
            }
            for (; low < t->count && all->places[low].key <= last; ++low) {
                const uint32_t node = all->places[low].node;
                const double x[2] = {t->position[node], t->position[t->ld + node]};
                consider(s, number, &f, x, node, t->ld, all->square, normal, distance, turn);
            }
        }
    }
}

ab_status contact_nearest_faces(contact_pair *pair, ab_trace *a, ab_trace *b, ab_report *report) {
    if (!pair->faces) pair->faces = calloc(1, sizeof *pair->faces);
    struct contact_faces *f = pair->faces;
    if (!f || !reserve(f, a->ld > b->ld ? a->ld : b->ld))
        return ab_report_failure(report, "no memory for the faces near nodes shared by '%s' and '%s'", pair->a->spec->name,
                                 pair->b->spec->name);
    for (size_t k = 0; k < a->count; ++k) f->places[k] = (contact_place){a->key[k], (uint32_t)k};
    qsort(f->places, a->count, sizeof *f->places, compare_places);
    for (int side = 0; side < 2; ++side) {
        ab_domain *body = side ? pair->b : pair->a;
        ab_trace *t = side ? b : a;
        ab_surface surface = {.struct_size = sizeof surface, .dimension = 2};
        if (!body->ops->faces) continue;
        AB_TRY(body->ops->faces(body, &surface, report));
        if (!surface.face_count) continue;
        look_from(f, &surface, t, f->normal[side], f->distance[side], f->turn[side]);
        t->face_normal = f->normal[side];
        t->face_distance = f->distance[side];
        t->face_turn = f->turn[side];
    }
    return AB_OK;
}
