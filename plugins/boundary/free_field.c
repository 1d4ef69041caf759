/* free_field.c: a side of ground that shakes. Beside it stands a column of the same ground, as wide as the world: what waves travelling up and down do there is
 * what the side would feel if the ground went on. The side gets the stress of the column, and dashpots on the difference of the velocities take away what the
 * structure sends out. Where the body moves as its free field does, the dashpots do nothing and the column's stress is that of the ground beyond the side:
 * exact for waves that travel vertically.
 *
 * The column: elements of `spacing` with masses at their ends, steps of the host (cut where the column needs shorter ones) and central differences, as a linear
 * quadrilateral with lumped masses does it: beside such a mesh with horizontal rows of that height both move alike to rounding. It is linear elastic, with the density
 * and wave speeds of the edges beside it when it began. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "abut_plugin.h"

#include "boundary/dashpots.h"
#include "boundary/ground_record.h"

enum { MOST_ELEMENTS = 100000, MOST_PARTS = 1000 };

typedef struct level {   /* a node of the column and the element above it */
    double velocity[2];  /* m/s, along x and along y */
    double shear, axial; /* Pa, xy and yy, of the element */
} level;

typedef struct element { /* what does not change */
    double density, p_modulus, s_modulus;
} element;

typedef struct place { /* of an edge beside the column */
    uint64_t element;
    double share; /* of the upper node */
} place;

typedef struct column {
    const ab_host *host;
    double a, b, spacing, bottom, top;
    int has_bottom, has_top;
    ground_record *record;
    /* made when the first edges come */
    uint64_t edges, elements;
    double foot, height; /* m: of the column's foot, of an element */
    double time;         /* s: of `now` */
    element *ground;
    level *now, *next; /* at the start and at the end of the step; elements + 1 */
    place *where;
} column;

static const ab_param PARAMS[] = {
    RECORD_PARAMS,
    {"spacing", "m", "height of the column's elements; best that of the elements or cells beside the side", NULL, AB_REAL,
     AB_REQUIRED | AB_MIN_OPEN, 1.0, 0.0, INFINITY},
    {"bottom", "m", "height y of the column's foot; without it the foot of the side, taken to be upright", NULL, AB_REAL, 0, 0.0, -INFINITY,
     INFINITY},
    {"top", "m", "height y of the ground's surface; without it the top of the side, taken to be upright", NULL, AB_REAL, 0, 0.0, -INFINITY,
     INFINITY},
    {"a", "1", "of the dashpot along the normal, a rho c_p", NULL, AB_REAL, 0, 1.0, 0.0, INFINITY},
    {"b", "1", "of the dashpot across the normal, b rho c_s", NULL, AB_REAL, 0, 1.0, 0.0, INFINITY},
};
enum { AT_SPACING = RECORD_SETTINGS, AT_BOTTOM, AT_TOP, AT_A, AT_B };

static int fail(const ab_host *host, const char *why) { return host->message(host->context, why), -1; }

static int create(const ab_host *host, const ab_value *settings, void **self) {
    if (settings[AT_BOTTOM].given && settings[AT_TOP].given && !(settings[AT_TOP].real > settings[AT_BOTTOM].real))
        return fail(host, "top is not above bottom");
    column *k = host->allocate(host->context, sizeof *k);
    if (!k) return -1;
    *k = (column){.host = host,
                  .a = settings[AT_A].real,
                  .b = settings[AT_B].real,
                  .spacing = settings[AT_SPACING].real,
                  .bottom = settings[AT_BOTTOM].real,
                  .top = settings[AT_TOP].real,
                  .has_bottom = (int)settings[AT_BOTTOM].given,
                  .has_top = (int)settings[AT_TOP].given,
                  .record = record_open(host, settings, 0)};
    if (!k->record) {
        host->release(host->context, k);
        return -1;
    }
    *self = k;
    return 0;
}

static void forget(column *k) {
    const ab_host *host = k->host;
    if (k->ground) host->release(host->context, k->ground);
    if (k->now) host->release(host->context, k->now);
    if (k->next) host->release(host->context, k->next);
    if (k->where) host->release(host->context, k->where);
    k->ground = NULL, k->now = k->next = NULL, k->where = NULL;
    k->edges = k->elements = 0;
}

static void destroy(void *self) {
    column *k = self;
    forget(k);
    k->host->release(k->host->context, k->record);
    k->host->release(k->host->context, k);
}

static int take(column *k, uint64_t elements, uint64_t edges) {
    const ab_host *host = k->host;
    k->ground = host->allocate(host->context, elements * sizeof *k->ground);
    k->now = host->allocate(host->context, (elements + 1) * sizeof *k->now);
    k->next = host->allocate(host->context, (elements + 1) * sizeof *k->next);
    k->where = host->allocate(host->context, (edges ? edges : 1) * sizeof *k->where);
    if (!k->ground || !k->now || !k->next || !k->where) return fail(host, "no memory for the free-field column; use a larger spacing");
    k->elements = elements;
    k->edges = edges;
    return 0;
}

/* Where the side begins and ends: its area is its height, and its middle that of its edges. */
static void find_side(const ab_edges *e, double *bottom, double *top) {
    double area = 0.0, moment = 0.0, low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < e->count; ++i) {
        const double y = e->position[e->ld + i];
        area += e->area[i];
        moment += e->area[i] * y;
        low = fmin(low, y), high = fmax(high, y);
    }
    const double middle = area > 0.0 ? moment / area : 0.5 * (low + high);
    *bottom = fmin(middle - 0.5 * area, low);
    *top = fmax(middle + 0.5 * area, high);
}

static const double LEANING = 0.5; /* of a side that is upright still: the normal's part along y */

static int build(column *k, const ab_edges *e) {
    double bottom = 0.0, top = 0.0;
    forget(k);
    find_side(e, &bottom, &top);
    if (k->has_bottom) bottom = k->bottom;
    if (k->has_top) top = k->top;
    const double wanted = (top - bottom) / k->spacing;
    for (size_t i = 0; i < e->count; ++i)
        if (e->area[i] > 0.0 && fabs(e->normal[e->ld + i]) > LEANING)
            return fail(k->host, "free-field stands beside upright sides, and this one looks up or down; name an upright one in `where`");
    if (!(wanted > 0.0) || !isfinite(wanted))
        return fail(k->host, "the side has no height: free-field stands beside upright sides; or write bottom and top");
    if (wanted > MOST_ELEMENTS) return fail(k->host, "more than 100000 elements in the free-field column; use a larger spacing");
    const uint64_t elements = (uint64_t)fmax(1.0, floor(wanted + 0.5));
    if (take(k, elements, e->count) != 0) return -1;
    k->foot = bottom;
    k->height = (top - bottom) / (double)elements;
    k->time = e->time;
    for (uint64_t n = 0; n < elements; ++n) { /* its ground is that of the nearest edge */
        const double y = bottom + ((double)n + 0.5) * k->height;
        size_t best = 0;
        double least = INFINITY;
        for (size_t i = 0; i < e->count; ++i) {
            const double away = fabs(e->position[e->ld + i] - y);
            if (away < least) least = away, best = i;
        }
        const double rho = e->density[best], cp = e->p_wave_speed[best], cs = e->s_wave_speed[best];
        k->ground[n] = (element){rho, rho * cp * cp, rho * cs * cs};
    }
    for (size_t i = 0; i < e->count; ++i) {
        const double at = fmin(fmax((e->position[e->ld + i] - bottom) / k->height, 0.0), (double)elements);
        const uint64_t n = (uint64_t)fmin(floor(at), (double)elements - 1.0);
        k->where[i] = (place){n, at - (double)n};
    }
    return 0;
}

/* One step of the column, from `from` to `to`. */
static void advance(const column *k, double time, double dt, const level *from, level *to) {
    const uint64_t n = k->elements;
    const double h = k->height;
    const ground_record *r = k->record;
    double base[MOST]; /* velocity of a rigid base at the end of the step, of the wave from below in its middle */
    record_motion(r, r->base == RIGID ? time + dt : time + 0.5 * dt, base);
    for (uint64_t i = 0; i <= n; ++i) {
        const element *below = i > 0 ? k->ground + i - 1 : NULL, *above = i < n ? k->ground + i : NULL;
        const double mass = 0.5 * h * ((below ? below->density : 0.0) + (above ? above->density : 0.0));
        const double force[2] = {(above ? from[i].shear : 0.0) - (below ? from[i - 1].shear : 0.0),
                                 (above ? from[i].axial : 0.0) - (below ? from[i - 1].axial : 0.0)};
        for (int c = 0; c < 2; ++c) {
            const double old = from[i].velocity[c];
            if (below)
                to[i].velocity[c] = old + dt * force[c] / mass;
            else if (r->base == RIGID)
                to[i].velocity[c] = base[c];
            else { /* dashpot of the ground below on the mean velocity of the step, and the stress of the wave that comes up */
                const double own = sqrt((c == 0 ? above->s_modulus : above->p_modulus) / above->density),
                             speed = c == 0 ? r->s_speed : r->p_speed;
                const double z = (r->density > 0.0 ? r->density : above->density) * (speed > 0.0 ? speed : own);
                const double half = 0.5 * dt * z / mass;
                to[i].velocity[c] = (old * (1.0 - half) + dt / mass * (force[c] + 2.0 * z * base[c])) / (1.0 + half);
            }
        }
    }
    for (uint64_t i = 0; i < n; ++i) {
        to[i].shear = from[i].shear + dt * k->ground[i].s_modulus * (to[i + 1].velocity[0] - to[i].velocity[0]) / h;
        to[i].axial = from[i].axial + dt * k->ground[i].p_modulus * (to[i + 1].velocity[1] - to[i].velocity[1]) / h;
    }
    to[n].shear = to[n].axial = 0.0;
}

static int step(column *k, double time, double dt) {
    double fastest = 0.0;
    for (uint64_t i = 0; i < k->elements; ++i) fastest = fmax(fastest, sqrt(k->ground[i].p_modulus / k->ground[i].density));
    const double parts = fmax(1.0, ceil(dt * fastest / k->height * (1.0 - 1e-9)));
    if (!(parts <= MOST_PARTS))
        return fail(k->host, "the free-field column needs more than 1000 steps for one of the run; use a larger spacing");
    const double part = dt / parts;
    memcpy(k->next, k->now, (k->elements + 1) * sizeof *k->now);
    for (long p = 0; p < (long)parts; ++p) advance(k, time + (double)p * part, part, k->next, k->next);
    return 0;
}

/* The stress that an edge stands in: that of its element; at a node half of both, as its face reaches into both. */
static level stress_at(const column *k, const place *at) {
    static const double NODE = 1e-6; /* of an element */
    const level *here = k->now + at->element;
    const level *other = at->share < NODE && at->element > 0                       ? here - 1
                         : at->share > 1.0 - NODE && at->element + 1 < k->elements ? here + 1
                                                                                   : here;
    return (level){.shear = 0.5 * (here->shear + other->shear), .axial = 0.5 * (here->axial + other->axial)};
}

static int apply(void *self, ab_edges *e) {
    column *k = self;
    if (e->count == 0) return 0;
    if (k->edges != e->count) {
        if (build(k, e) != 0) return -1;
    } else if (e->time != k->time) { /* the host may ask again for the same step */
        level *old = k->now;
        k->now = k->next;
        k->next = old;
        k->time = e->time;
    }
    if (step(k, e->time, e->dt) != 0) return -1;
    for (size_t i = 0; i < e->count; ++i) {
        const place *at = k->where + i;
        const level stress = stress_at(k, at);
        const element *ground = k->ground + at->element;
        const double lateral = ground->p_modulus > 0.0 ? stress.axial * (1.0 - 2.0 * ground->s_modulus / ground->p_modulus) : 0.0;
        const double n[2] = {e->normal[i], e->normal[e->ld + i]};
        double far[3] = {0.0, 0.0, 0.0};
        for (int c = 0; c < 2; ++c) { /* the mean of the step, which is where the host takes the dashpots */
            const level *a = k->now + at->element, *b = k->next + at->element;
            far[c] = 0.5 * ((1.0 - at->share) * (a[0].velocity[c] + b[0].velocity[c]) + at->share * (a[1].velocity[c] + b[1].velocity[c]));
        }
        e->traction[i] += lateral * n[0] + stress.shear * n[1];
        e->traction[e->ld + i] += stress.shear * n[0] + stress.axial * n[1];
        const edge_resistance r = edge_dashpots(e, i, k->a, k->b);
        edge_resist(&r, e, i, far);
    }
    return 0;
}

/* ---- checkpoints --------------------------------------------------------------------------------------------------------- */

static int save(void *self, const ab_stream *stream) {
    column *k = self;
    const uint64_t size[2] = {k->edges, k->elements};
    const double numbers[3] = {k->foot, k->height, k->time};
    if (stream->write(stream->context, size, sizeof size) != 0) return -1;
    if (k->edges == 0) return 0;
    return stream->write(stream->context, numbers, sizeof numbers) != 0 ||
                   stream->write(stream->context, k->ground, k->elements * sizeof *k->ground) != 0 ||
                   stream->write(stream->context, k->now, (k->elements + 1) * sizeof *k->now) != 0 ||
                   stream->write(stream->context, k->next, (k->elements + 1) * sizeof *k->next) != 0 ||
                   stream->write(stream->context, k->where, k->edges * sizeof *k->where) != 0
               ? -1
               : 0;
}

static int load(void *self, const ab_stream *stream) {
    column *k = self;
    uint64_t size[2] = {0, 0};
    double numbers[3] = {0.0, 0.0, 0.0};
    forget(k);
    if (stream->read(stream->context, size, sizeof size) != 0) return -1;
    if (size[0] == 0) return 0;
    if (size[0] > UINT32_MAX || size[1] == 0 || size[1] > MOST_ELEMENTS) return fail(k->host, "the free-field column is damaged");
    if (take(k, size[1], size[0]) != 0) return -1;
    if (stream->read(stream->context, numbers, sizeof numbers) != 0 ||
        stream->read(stream->context, k->ground, k->elements * sizeof *k->ground) != 0 ||
        stream->read(stream->context, k->now, (k->elements + 1) * sizeof *k->now) != 0 ||
        stream->read(stream->context, k->next, (k->elements + 1) * sizeof *k->next) != 0 ||
        stream->read(stream->context, k->where, k->edges * sizeof *k->where) != 0)
        return -1;
    for (uint64_t i = 0; i < k->edges; ++i)
        if (k->where[i].element >= k->elements) return fail(k->host, "the free-field column is damaged");
    k->foot = numbers[0], k->height = numbers[1], k->time = numbers[2];
    return 0;
}

static const ab_boundary_ops OPS = {sizeof OPS, apply};
static const ab_class CLASS = {
    .struct_size = sizeof CLASS,
    .kind = AB_BOUNDARY,
    .spaces = AB_PLANE_STRAIN,
    .needs = AB_NEED_WHOLE_SIDE | AB_NEED_AXES,
    .gives = AB_GIVE_TRACTION | AB_GIVE_DAMPING,
    .nparam = sizeof PARAMS / sizeof *PARAMS,
    .name = "free-field",
    .help = "an upright side of shaken ground: a column of it beside the side, and dashpots on the difference",
    .reference = "Zienkiewicz, Bicanic and Shen 1989, in Advances in Computational Nonlinear Mechanics 109-138; compliant base: Joyner and "
                 "Chen 1975, Bull. "
                 "Seism. Soc. Am. 65 1315-1336",
    .param = PARAMS,
    .create = create,
    .destroy = destroy,
    .ops = &OPS,
    .save = save,
    .load = load,
};
static const ab_class *const CLASSES[] = {&CLASS};
const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "free-field", "1.0", "MIT", CLASSES};
