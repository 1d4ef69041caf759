/* multi_velocity.c: finds contact points on the grid nodes that two bodies share (multi-velocity field: Bardenhagen et al. 2000, Huang et al. 2011), with a
 * collinear normal and, unless it is switched off, the gap between the two bodies' material along it. */
#include "abut_plugin.h"

#include <math.h>
#include <string.h>

#include "closest_approach.h"
#include "node_area.h"
#include "node_normals.h"
#include "place_of_impulse.h"

static const double CORNER = 0.866; /* cosine between two normals that lean by more than a face does */

enum {
    NORMAL_AVERAGE,
    NORMAL_MASS_GRADIENT,
    NORMAL_VOLUME_GRADIENT,
    NORMAL_STIFFER,
    NORMAL_DENSITY_GRADIENT,
    NORMAL_GEOMETRIC,
    NORMAL_REGRESSION,
    NORMAL_CONVEX,
    NORMAL_FACES
};
enum { GAP_DISTANCE, GAP_NONE, GAP_REGRESSION };
enum { NODES_PER_THREAD = 32, NODES_AT_ONCE = 4 }; /* a thread is worth its waking up from so many on */

typedef struct multi_velocity {
    const ab_host *host;
    int64_t normal; /* -1: fixed direction */
    double direction[3];
    int gap; /* GAP_* */
    node_areas areas;
    double corner_cosine; /* of the angle beyond which the corner rule looks at two normals */
} multi_velocity;

static const ab_param PARAMS[] = {
    {"normal", "1",
     "normal of a shared node: average of both bodies' (with the corner rule), from the gradient of mass, of volume or of density, the "
     "stiffer body's, from the cells "
     "that hold points, the plane that separates the points, the flat or convex body's against a concave one, the nearest face's, "
     "or a direction out of the first body",
     "average|mass-gradient|volume-gradient|stiffer|density-gradient|geometric|regression|convex|faces", AB_CHOICE, AB_OR_DIRECTION,
     NORMAL_AVERAGE, 0, 0},
    {"gap", "1",
     "distance: contact acts when the material of the bodies meets; none: as soon as they share a node (velocities only, the classical "
     "form: early and lossy); regression: as distance, between the points' sides along the normal of the plane that separates them",
     "distance|none|regression", AB_CHOICE, 0, 0, 0, 0},
    {"corner_angle", "rad",
     "corner rule of `average`: where the two bodies' normals disagree by more than this, the direction of closest approach of their "
     "material is taken",
     NULL, AB_REAL, 0, 1e-6, 0.0, 3.2},
};

static int create(const ab_host *host, const ab_value *settings, void **self) {
    multi_velocity *mv = host->allocate(host->context, sizeof *mv);
    if (!mv) return -1;
    mv->host = host;
    mv->normal = settings[0].integer;
    if (mv->normal < 0) memcpy(mv->direction, settings[0].table, sizeof mv->direction);
    mv->gap = (int)settings[1].integer;
    mv->corner_cosine = cos(settings[2].real);
    *self = mv;
    return 0;
}

static void destroy(void *self) {
    multi_velocity *mv = self;
    node_areas_release(mv->host, &mv->areas);
    mv->host->release(mv->host->context, mv);
}

static double unit(double *v, uint32_t dimension) {
    double square = 0.0;
    for (uint32_t c = 0; c < dimension; ++c) square += v[c] * v[c];
    const double length = sqrt(square);
    if (length > 0.0)
        for (uint32_t c = 0; c < dimension; ++c) v[c] /= length;
    return length;
}

/* How far the material of a body reaches along +-n from the node: the largest of sign n.(x - x_i) + half size, over the points beside the node (within half
 * a cell across the normal); over all points near it where none is. */
static double reach(const ab_trace *t, size_t i, const double n[3], double sign) {
    const uint32_t d = t->dimension;
    const size_t ld = t->near_ld;
    double beside = -INFINITY, all = -INFINITY;
    for (size_t k = t->near_start[i]; k < t->near_start[i + 1]; ++k) {
        double along = 0.0, square = 0.0;
        for (uint32_t c = 0; c < d; ++c) {
            const double r = t->near_position[c * ld + k] - t->position[c * t->ld + i];
            along += r * n[c];
            square += r * r;
        }
        const double far = sign * along + half_size(t, k, n);
        const double across2 = square - along * along;
        if (far > all) all = far;
        if (across2 <= 0.25 * t->cell * t->cell && far > beside) beside = far;
    }
    return beside > -INFINITY ? beside : all;
}

/* Distance of the two bodies' material along n at shared node i, m; negative: they overlap. */
static double distance(const ab_trace *a, const ab_trace *b, size_t i, const double n[3]) {
    return -reach(a, i, n, 1.0) - reach(b, i, n, -1.0);
}

/* The same between all points near the node: how far a plane with normal n keeps them apart. */
static double separated(const ab_trace *a, const ab_trace *b, size_t i, const double n[3]) {
    double gap = 0.0;
    for (int side = 0; side < 2; ++side) {
        const ab_trace *t = side ? b : a;
        double far = -INFINITY;
        for (size_t k = t->near_start[i]; k < t->near_start[i + 1]; ++k) {
            double along = 0.0;
            for (uint32_t c = 0; c < t->dimension; ++c) along += (t->near_position[c * t->near_ld + k] - t->position[c * t->ld + i]) * n[c];
            far = larger(far, (side ? -along : along) + half_size(t, k, n));
        }
        gap -= far;
    }
    return gap;
}

/* From node i to the nearest material of a body: the least distance to the domains of the points near it, each taken as a box that lies along n. */
static double distance_to(const ab_trace *t, size_t i, const double n[3]) {
    const uint32_t d = t->dimension;
    double least = INFINITY;
    for (size_t k = t->near_start[i]; k < t->near_start[i + 1]; ++k) {
        double r[3] = {0}, along = 0.0;
        for (uint32_t c = 0; c < d; ++c) {
            r[c] = t->near_position[c * t->near_ld + k] - t->position[c * t->ld + i];
            along += r[c] * n[c];
        }
        for (uint32_t c = 0; c < d; ++c) r[c] -= along * n[c];
        const double across = unit(r, d);
        least = smaller(
            least, hypot(larger(fabs(along) - half_size(t, k, n), 0.0), across > 0.0 ? larger(across - half_size(t, k, r), 0.0) : 0.0));
    }
    return least;
}

/* The average of both normals. Where they disagree one of them is no normal: an edge, a body that only just reaches the node, the far surface of a body
 * one cell thin. There the gradient of the share of mass, m_b grad m_a - m_a grad m_b, begins (what both have in common, as the sides of two flush
 * bars or a wall beside them, cancels in it), and in two dimensions the direction of closest approach ends, from that guess or either normal. */
static void average_normal(const multi_velocity *mv, const ab_trace *a, const ab_trace *b, size_t i, const double na[3], const double nb[3],
                           double n[3]) {
    const uint32_t d = a->dimension;
    double cosine = 0.0;
    for (uint32_t c = 0; c < d; ++c) {
        cosine -= na[c] * nb[c];
        n[c] = na[c] - nb[c];
    }
    if (cosine >= mv->corner_cosine) {
        if (d == 2) mend_chance(a, b, i, n);
        return;
    }
    for (uint32_t c = 0; c < d; ++c) n[c] = b->mass[i] * a->mass_gradient[c * a->ld + i] - a->mass[i] * b->mass_gradient[c * b->ld + i];
    const double guess[3][2] = {{n[0], n[1]}, {na[0], na[1]}, {-nb[0], -nb[1]}};
    if (d == 2) closest_approach(a, b, i, guess, cosine < CORNER, n);
}

/* The normal that the setting names, out of a, where it is not `average`; false where it has no answer. na, nb: unit, out of each. */
static int named_normal(const multi_velocity *mv, const ab_trace *a, const ab_trace *b, size_t i, const double na[3], const double nb[3],
                        double n[3]) {
    const uint32_t d = a->dimension;
    double guess[3] = {0};
    n[0] = n[1] = n[2] = 0.0;
    switch (mv->normal) {
    case NORMAL_MASS_GRADIENT:
        for (uint32_t c = 0; c < d; ++c) n[c] = a->mass_gradient[c * a->ld + i] - b->mass_gradient[c * b->ld + i];
        break;
    case NORMAL_VOLUME_GRADIENT:
        for (uint32_t c = 0; c < d; ++c) n[c] = a->area_vector[c * a->ld + i] - b->area_vector[c * b->ld + i];
        break;
    case NORMAL_STIFFER:
        for (uint32_t c = 0; c < d; ++c) n[c] = a->stiffness >= b->stiffness ? na[c] : -nb[c];
        break;
    case NORMAL_DENSITY_GRADIENT: return density_normal(a, b, i, n);
    case NORMAL_GEOMETRIC: return geometric_normal(a, b, i, n);
    case NORMAL_REGRESSION:
        for (uint32_t c = 0; c < d; ++c) guess[c] = na[c] - nb[c];
        unit(guess, d);
        return regression_normal(a, b, i, guess, n);
    case NORMAL_CONVEX:
        average_normal(mv, a, b, i, na, nb, guess);
        return unit(guess, d) > 0.0 && convex_normal(a, b, i, guess, na, nb, CORNER, n);
    case NORMAL_FACES: /* beside a corner a node may be nearest to the side that does not touch */
        if (!face_normal(a, b, i, n)) return 0;
        average_normal(mv, a, b, i, na, nb, guess);
        unit(guess, d);
        return normals_dot(n, guess, d) >= CORNER;
    default: memcpy(n, mv->direction, sizeof mv->direction);
    }
    return unit(n, d) > 0.0;
}

/* Distance of the two bodies' material at shared node i, m. A normal from one gradient alone may lean where a body ends; the distance along it would then be
 * that of nothing. So it is measured along the best direction known, and only a direction given by hand is taken at its word. */
static double node_gap(const multi_velocity *mv, const ab_trace *a, const ab_trace *b, size_t i, const double n[3]) {
    if (mv->gap == GAP_REGRESSION) {
        double plane[3];
        if (mv->normal == NORMAL_REGRESSION) return separated(a, b, i, n);
        return separated(a, b, i, regression_normal(a, b, i, n, plane) ? plane : n);
    }
    if (mv->normal < 0 || mv->normal == NORMAL_AVERAGE) return distance(a, b, i, n);
    double na[3] = {0}, nb[3] = {0}, along[3] = {0};
    for (uint32_t c = 0; c < a->dimension; ++c) {
        na[c] = a->area_vector[c * a->ld + i];
        nb[c] = b->area_vector[c * b->ld + i];
    }
    unit(na, a->dimension);
    unit(nb, a->dimension);
    average_normal(mv, a, b, i, na, nb, along);
    return distance(a, b, i, unit(along, a->dimension) > 0.0 ? along : n);
}

/* Of a cell's face, of a cell's face, a cosine, of the other's mass. */
static const double LEAST_AREA = 1e-3, LEAST_PAST = 1e-8, ALIGNED = 0.99, LIGHT = 1e-4;

/* A body that only just reaches a node has no say in its normal, and none in contact at corners. But a face along a line of the grid that has passed it by eps of a cell leaves
 * eps of its area at the nodes beyond, and eps squared of mass. Left out, such a node is a free one, flies off with the stress of the points behind the face, and
 * strains them by it: bodies at rest creep into each other. Where such nodes go by their neighbours (mpm/light_nodes.c) they show no face here; those of bodies about an axis do.
 * True where the face of the light body t has passed the node: n out of it, l its area over that of a cell's face. */
static int just_past(const ab_trace *t, const ab_trace *other, size_t i, const double n[3], double l) {
    if (!(l > LEAST_PAST && l <= LEAST_AREA && t->mass[i] < LIGHT * other->mass[i])) return 0;
    for (uint32_t c = 0; c < t->dimension; ++c)
        if (fabs(n[c]) > ALIGNED) return 1;
    return 0;
}

/* The normal at shared node i, out of a; false where there is no contact to speak of. *area: tributary, m2. */
static int node_normal(const multi_velocity *mv, const ab_trace *a, const ab_trace *b, size_t i, double n[3], double *area) {
    const uint32_t d = a->dimension;
    double na[3] = {0}, nb[3] = {0}, va[3] = {0}, vb[3] = {0};
    for (uint32_t c = 0; c < d; ++c) {
        va[c] = na[c] = a->area_vector[c * a->ld + i];
        vb[c] = nb[c] = b->area_vector[c * b->ld + i];
    }
    const double la = unit(na, d), lb = unit(nb, d);
    double face = 1.0;
    for (uint32_t c = 1; c < d; ++c) face *= a->cell;
    const int past = just_past(a, b, i, na, la / face) || just_past(b, a, i, nb, lb / face);
    const double least = (past ? LEAST_PAST : LEAST_AREA) * face;
    if (!(smaller(la, lb) > least)) return 0; /* one of them has no face here, whatever the normal is */
    n[0] = n[1] = n[2] = 0.0;
    if (mv->normal == NORMAL_AVERAGE || !named_normal(mv, a, b, i, na, nb, n)) {
        average_normal(mv, a, b, i, na, nb, n);
        if (!(unit(n, d) > 0.0)) return 0;
    }
    double along_a = 0.0, along_b = 0.0;
    for (uint32_t c = 0; c < d; ++c) {
        along_a += va[c] * n[c];
        along_b -= vb[c] * n[c];
    }
    /* Less: one body only just reaches the node, and has no say there. But of two bodies in one cell, thinner than it, both area vectors may point the same way:
     * then the larger says that there is a face, though not how much of it is shared. */
    const double less = smaller(along_a, along_b), more = larger(along_a, along_b);
    double alike = 0.0;
    for (uint32_t c = 0; c < d; ++c) alike += va[c] * vb[c];
    *area = larger(less, 0.0);
    return less > least || (alike > 0.0 && more > least);
}

static const double NO_CONTACT = -1.0; /* in place of an area */

/* Normal, gap, area and place of node i, at i of the list, whether or not it will stand there. */
static void look_at_node(const multi_velocity *mv, const ab_trace *a, const ab_trace *b, size_t i, ab_points *out) {
    double normal[3], area = 0.0, place[3];
    out->area[i] = NO_CONTACT;
    if (!node_normal(mv, a, b, i, normal, &area)) return;
    out->area[i] = area;
    out->gap[i] = mv->gap != GAP_NONE ? node_gap(mv, a, b, i, normal) : 0.0;
    place_of_impulse(a, b, i, normal, place);
    for (uint32_t c = 0; c < a->dimension; ++c) {
        out->normal[c * out->ld + i] = normal[c];
        out->position[c * out->ld + i] = a->position[c * a->ld + i] + place[c];
    }
    if (out->distance) out->distance[i] = distance_to(a->stiffness >= b->stiffness ? a : b, i, normal);
}

static int find(void *self, const ab_trace *a, const ab_trace *b, ab_points *out) {
    multi_velocity *mv = self;
    const int measure = out->measure_area && a->dimension == 2;
    if (measure && !node_areas_reserve(mv->host, &mv->areas, a->count)) return -1;
    if (a->count > out->capacity &&
        mv->host->reserve(mv->host->context, out, a->count, a->stencil_start[a->count] + b->stencil_start[b->count]) != 0)
        return -1;
    const uint32_t d = a->dimension;
    size_t n = 0;
    out->a_start[0] = out->b_start[0] = 0;
#pragma omp parallel for schedule(dynamic, NODES_AT_ONCE) if (a->count >= NODES_PER_THREAD)
    for (size_t i = 0; i < a->count; ++i) look_at_node(mv, a, b, i, out);
    for (size_t i = 0; i < a->count; ++i) {
        if (out->area[i] == NO_CONTACT) continue;
        size_t sa = out->a_start[n], sb = out->b_start[n];
        for (size_t s = a->stencil_start[i]; s < a->stencil_start[i + 1]; ++s, ++sa) {
            out->a_dof[sa] = a->stencil_dof[s];
            out->a_weight[sa] = a->stencil_weight[s];
        }
        for (size_t s = b->stencil_start[i]; s < b->stencil_start[i + 1]; ++s, ++sb) {
            out->b_dof[sb] = b->stencil_dof[s];
            out->b_weight[sb] = b->stencil_weight[s];
        }
        for (uint32_t c = 0; c < d; ++c) { /* those that stand move together: n <= i */
            out->normal[c * out->ld + n] = out->normal[c * out->ld + i];
            out->position[c * out->ld + n] = out->position[c * out->ld + i];
        }
        out->gap[n] = out->gap[i];
        if (out->distance) out->distance[n] = out->distance[i];
        out->area[n] = out->area[i];
        if (measure) mv->areas.node[n] = (uint32_t)i;
        out->key[n] = a->key[i];
        ++n;
        out->a_start[n] = sa;
        out->b_start[n] = sb;
    }
    out->count = n;
    if (measure) node_areas_share(&mv->areas, a, b, out);
    return 0;
}

static uint32_t needs_with(const ab_value *settings) {
    return settings[0].integer == NORMAL_DENSITY_GRADIENT ? AB_NEED_DENSITY_GRADIENT
           : settings[0].integer == NORMAL_FACES          ? AB_NEED_NEAREST_FACE
                                                          : 0u;
}

static const ab_contact_ops OPS = {sizeof OPS, find, NULL};
static const ab_class CLASS = {
    .struct_size = sizeof CLASS,
    .kind = AB_CONTACT,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D,
    .needs = AB_NEED_SHARED_NODES | AB_NEED_MASS_GRADIENT | AB_NEED_AREA_VECTOR | AB_NEED_NEAR_POINTS,
    .gives = AB_GIVE_POINTS,
    .nparam = sizeof PARAMS / sizeof *PARAMS,
    .name = "multi-velocity",
    .help = "contact points on the grid nodes that two bodies share, with gap",
    .reference = "Bardenhagen, Brackbill, Sulsky 2000; Huang et al. 2011; the gap is that between the faces of the nearest material points",
    .param = PARAMS,
    .create = create,
    .destroy = destroy,
    .ops = &OPS,
    .needs_with = needs_with,
};
static const ab_class *const CLASSES[] = {&CLASS};
const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "multi-velocity", "1.0", "MIT", CLASSES};
