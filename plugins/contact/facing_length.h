/* facing_length.h: the area of a contact point: how much of its own body's surface it stands for lies over the other body, and how much of that it shares with the
 * points of the other pass. All lengths are measured along the tangent of the contact point. For finders in this folder. */
#ifndef FACING_LENGTH_H
#define FACING_LENGTH_H

#include "surface_hits.h"

static const double LEAST_PART =
    1e-3; /* of what a point stands for: one that touches is never without an area, or a spring would let it through */

typedef struct facing { /* one side of the pair */
    const ab_surface *surface;
    const uint32_t *around; /* per vertex: the face that ends there, the face that begins */
    const uint8_t *met;     /* per vertex: it is a contact point itself */
    uint8_t *taken;         /* per face, bit k: what its vertex k stands for is carried by the vertex beside it */
    int along;              /* there are contact points that are no vertices: they stand all along the faces */
} facing;

typedef struct frame { /* of one contact point: t runs as its own body's faces do, against those of the other */
    double from[2], n[2], t[2];
} frame;

static double along_frame(const frame *f, const double x[2]) { return f->t[0] * (x[0] - f->from[0]) + f->t[1] * (x[1] - f->from[1]); }
static double across_frame(const frame *f, const double x[2]) { return f->n[0] * (x[0] - f->from[0]) + f->n[1] * (x[1] - f->from[1]); }

static void place_of_vertex(const ab_surface *s, uint32_t v, double x[2]) {
    x[0] = s->vertex_position[v];
    x[1] = s->vertex_position[s->vertex_ld + v];
}

/* A place on the other surface is shared where the vertex that stands for it is a contact point, or another in its stead. */
static double part_left(const facing *other, uint32_t face, uint32_t k) {
    const int shared = other->along || other->met[other->surface->face_vertex[3 * (size_t)face + k]] || other->taken[face] >> k & 1;
    return shared ? 0.5 : 1.0;
}

/* How much of low..high lies over a face, less what is shared. A vertex stands for as much of a face as a uniform pressure gives it: 1/2, 1/2 or 1/6, 4/6, 1/6. */
static double over_face(const facing *other, const frame *f, uint32_t face, const curve *c, double low, double high) {
    static const double limit[2][4] = {{-1.0, 0.0, 1.0}, {-1.0, -2.0 / 3.0, 2.0 / 3.0, 1.0}};
    static const uint32_t stands[2][3] = {{0, 1}, {0, 2, 1}};
    double x[2], length = 0.0;
    place_of(c, -1.0, x);
    double above = along_frame(f, x);
    for (int k = 0; k < 2 + c->bent; ++k) {
        place_of(c, limit[c->bent][k + 1], x);
        const double below = along_frame(f, x), piece = smaller(high, above) - larger(low, below);
        if (piece > 0.0) length += piece * part_left(other, face, stands[c->bent][k]);
        above = below;
    }
    return length;
}

/* Goes along the other surface from a face to one side (end 0: up the tangent, end 1: down) until it is past high, or low, and adds what of low..high lies over
 * it; the first face goes with end 0. A concave corner does not end it. Returns 1 where it ends before, at `place`: open, or at a corner beyond which it looks
 * elsewhere. */
static int go_along(const facing *other, const frame *f, uint32_t face, int end, double low, double high, double *length, double place[2]) {
    const ab_surface *s = other->surface;
    curve c, next;
    if (!curve_of(s, face, &c)) return 0;
    for (size_t hops = 0; hops <= s->face_count; ++hops) {
        if (hops || end == 0) *length += over_face(other, f, face, &c, low, high);
        place_of(&c, end ? 1.0 : -1.0, place);
        const double u = along_frame(f, place);
        if (end ? u <= low : u >= high) return 0;
        const uint32_t neighbour = beside(s, face, end, &next);
        double here[2], there[2];
        if (neighbour == UINT32_MAX || !normal_at(&next, end ? -1.0 : 1.0, there)) return 1;
        if (!(dot(there, f->n) > CAN_MEET)) {
            const int known = normal_at(&c, end ? 1.0 : -1.0, here);
            if (!known || (end ? cross(here, there) : cross(there, here)) >= 0.0) return 1;
            *length += larger(0.0, end ? smaller(u, high) - low : high - larger(u, low)) * part_left(other, face, end ? 1 : 0);
            return 0;
        }
        face = neighbour;
        c = next;
    }
    return 0;
}

/* Which vertex of face `around[side]` vertex v is, and which is beside it there. */
static void roles(const ab_surface *s, uint32_t face, uint32_t v, int side, uint32_t *own, uint32_t *neighbour) {
    const uint32_t *of = s->face_vertex + 3 * (size_t)face;
    const int bent = of[2] != UINT32_MAX;
    *own = bent && of[2] == v ? 2 : side == 0 ? 1 : 0;
    *neighbour = *own == 2 || !bent ? (side == 0 ? 0 : 1) : 2;
}

/* A vertex that is no contact point because it lies beyond the other body: what it stands for up to that body's end, if the surfaces are within reach of each
 * other there, is carried by the contact point beside it. */
static void take_over(const facing *own, const facing *other, const frame *f, uint32_t v, uint32_t face, double reach) {
    double at[2], unused = 0.0;
    place_of_vertex(own->surface, v, at);
    const double u = along_frame(f, at), height = across_frame(f, at);
    for (int side = 0; side < 2; ++side) {
        const uint32_t mine = own->around[2 * (size_t)v + (size_t)side];
        if (mine == UINT32_MAX) continue;
        uint32_t role, next;
        roles(own->surface, mine, v, side, &role, &next);
        const uint32_t w = own->surface->face_vertex[3 * (size_t)mine + next];
        if (own->met[w]) continue;
        double there[2], end[2];
        place_of_vertex(own->surface, w, there);
        const double u_there = along_frame(f, there);
        if (side == 0 ? !(u_there < u) : !(u_there > u)) continue; /* that face looks elsewhere */
        if (!go_along(other, f, face, 1 - side, smaller(u, u_there), larger(u, u_there), &unused, end)) continue;
        const double part = (along_frame(f, end) - u) / (u_there - u),
                     gap = height + part * (across_frame(f, there) - height) - across_frame(f, end);
        if (part >= 0.0 && gap <= reach) own->taken[mine] |= (uint8_t)(1u << next);
    }
}

/* From where to where a vertex stands for its own surface, with what it takes over; *all: without, along the faces. A face that looks elsewhere does not count. */
static void own_length(const facing *own, const frame *f, uint32_t v, double *low, double *high, double *all) {
    double x[2];
    place_of_vertex(own->surface, v, x);
    *low = *high = along_frame(f, x);
    *all = 0.0;
    for (int side = 0; side < 2; ++side) {
        const uint32_t face = own->around[2 * (size_t)v + (size_t)side];
        curve c;
        if (face == UINT32_MAX || !curve_of(own->surface, face, &c)) continue;
        uint32_t role, next;
        roles(own->surface, face, v, side, &role, &next);
        const int taken = own->taken[face] >> next & 1;
        const double to = !c.bent ? (taken ? 1.0 : 0.0) : role == 2 ? (taken ? 1.0 : 2.0 / 3.0) : taken ? 2.0 / 3.0 : -2.0 / 3.0;
        place_of(&c, side == 0 ? -to : to, x);
        if (side == 0)
            *low = smaller(*low, along_frame(f, x));
        else
            *high = larger(*high, along_frame(f, x));
        *all += c.length * (!c.bent ? 0.5 : role == 2 ? 1.0 / 3.0 : 1.0 / 6.0);
    }
}

/* What of low..high lies over the other surface, which is met on `face`, less what is shared. */
static double facing_length(const facing *other, const frame *f, uint32_t face, double low, double high) {
    double length = 0.0, unused[2];
    go_along(other, f, face, 0, low, high, &length, unused);
    go_along(other, f, face, 1, low, high, &length, unused);
    return length;
}

#endif
