/* keep.c: what contact remembers from one step to the next: points with their histories, regions and buckets (made where bodies stood then), sums of the ledger. Old histories by
 * key and all scratch follow from the points. */
#include <stddef.h>

#include "contact/broad_phase.h"
#include "core/checkpoint.h"

static bool keep_reach(contact_reach *r, ab_checkpoint *c) {
    size_t vertices = r->vertex_count, tiles = r->tile_count, buckets = r->bucket_count,
           faces = r->bucket_count ? r->bucket_start[r->bucket_count] : 0;
    if (!ab_keep_count(c, "vertices", &vertices, 16) || !ab_keep_count(c, "tiles", &tiles, 16) ||
        !ab_keep_count(c, "buckets", &buckets, 16) || !ab_keep_count(c, "entries", &faces, 4) ||
        !ab_keep_size(c, "faces", &r->face_count) || !ab_keep_size(c, "builds", &r->builds))
        return false;
    if (ab_checkpoint_loads(c)) {
        if (!contact_reach_reserve(r, vertices, tiles, buckets, faces)) return ab_checkpoint_refuse(c, "no memory for %zu faces", faces);
        r->vertex_count = vertices, r->tile_count = tiles, r->bucket_count = buckets;
    }
    if (!ab_keep_doubles(c, "reach", &r->reach, 1) || !ab_keep_doubles(c, "margin", &r->margin, 1) ||
        !ab_keep_doubles(c, "bucket", &r->bucket, 1) || !ab_keep_struct(c, "window", &r->window) ||
        !ab_keep_doubles(c, "vertex", r->vertex, 2 * vertices) || !ab_keep_u64(c, "tile_key", r->tile_key, tiles) ||
        !ab_keep_u64(c, "tile_cells", r->tile_cells, tiles) || !ab_keep_u64(c, "bucket_key", r->bucket_key, buckets))
        return false;
    _Static_assert(sizeof(size_t) == sizeof(uint64_t), "starts are kept as they lie");
    if (!ab_keep_u64(c, "bucket_start", (uint64_t *)r->bucket_start, buckets ? buckets + 1 : 0) ||
        !ab_keep_u32(c, "bucket_face", r->bucket_face, faces))
        return false;
    bool good = !buckets || (r->bucket_start[0] == 0 && r->bucket_start[buckets] == faces);
    for (size_t k = 0; good && k < buckets; ++k) good = r->bucket_start[k] <= r->bucket_start[k + 1];
    for (size_t k = 0; good && k < faces; ++k) good = r->bucket_face[k] < r->face_count;
    return good || ab_checkpoint_refuse(c, "the faces near points are damaged");
}

static bool keep_broad(contact_broad *broad, ab_checkpoint *c) {
    bool good = ab_keep_doubles(c, "cell", &broad->cell, 1) && ab_keep_doubles(c, "length", broad->length, 2) &&
                ab_keep_doubles(c, "speed", &broad->speed, 1) && ab_keep_doubles(c, "needed", broad->needed, 2) &&
                ab_keep_doubles(c, "depth", &broad->depth, 1) && ab_keep_flags(c, "told", &broad->told, 1);
    for (int side = 0; good && side < 2; ++side) {
        ab_checkpoint_enter(c, "faces_of_%d", side);
        good = keep_reach(broad->reach + side, c);
        ab_checkpoint_leave(c);
    }
    return good;
}

/* Rows of the points' arrays, which may lie further apart than there are points. */
static bool keep_rows(ab_checkpoint *c, const char *name, double *values, size_t rows, const ab_points *p) {
    bool good = true;
    for (size_t row = 0; good && row < rows; ++row) {
        ab_checkpoint_enter(c, "%s_%zu", name, row);
        good = ab_keep_doubles(c, "row", values + row * p->ld, p->count);
        ab_checkpoint_leave(c);
    }
    return good;
}

static bool keep_points(contact_points *points, ab_checkpoint *c) {
    ab_points *p = &points->view;
    size_t count = p->count, states = points->states;
    bool there = p->key; /* not before the first step */
    if (!ab_keep_flags(c, "there", &there, 1) || !there) return ab_checkpoint_status(c) == AB_OK;
    if (!ab_keep_count(c, "points", &count, 8 * (6 + states)) || !ab_keep_size(c, "states", &states)) return false;
    if (states != points->states) return ab_checkpoint_refuse(c, "the response has %zu states there and %zu here", states, points->states);
    if (ab_checkpoint_loads(c)) {
        if (!contact_points_reserve(points, count, count)) return ab_checkpoint_refuse(c, "no memory for %zu contact points", count);
        p->count = count;
        p->a_start[0] = p->b_start[0] = 0;
        for (size_t i = 0; i < count; ++i)
            p->a_start[i + 1] = p->b_start[i + 1] = 0; /* nobody looks at the stencils of a step that is done */
    }
    return ab_keep_u64(c, "key", p->key, count) && keep_rows(c, "position", p->position, 2, p) && keep_rows(c, "normal", p->normal, 2, p) &&
           ab_keep_doubles(c, "gap", p->gap, count) && ab_keep_doubles(c, "area", p->area, count) &&
           keep_rows(c, "state", p->state1, points->states, p) && ab_keep_doubles(c, "cell", &p->cell, 1) &&
           ab_keep_doubles(c, "modulus", &p->modulus, 1) && ab_keep_doubles(c, "speed", &p->speed, 1) &&
           ab_keep_doubles(c, "unrest", &points->unrest, 1);
}

bool contact_keep_pair(contact_pair *pair, ab_checkpoint *c) {
    if (!keep_points(&pair->points, c) || !ab_keep_size(c, "failures", &pair->failures)) return false;
    if (!ab_keep_plugin(c, "finder", &pair->spec->finder->class_, pair->finder) ||
        !ab_keep_plugin(c, "responder", &pair->spec->responder->class_, pair->responder))
        return false;
    bool good = true;
    if (pair->broad) {
        ab_checkpoint_enter(c, "surfaces");
        good = keep_broad(pair->broad, c);
        ab_checkpoint_leave(c);
    }
    return good;
}

/* The numbers; places where the lists stand are found by whoever has them. */
bool contact_keep_totals(ab_contact_totals *t, ab_checkpoint *c) {
    return ab_keep_doubles(c, "impulse", t->impulse, 3) && ab_keep_doubles(c, "force", t->force, 3) &&
           ab_keep_doubles(c, "moment", &t->moment, 1) && ab_keep_doubles(c, "normal_force", &t->normal_force, 1) &&
           ab_keep_doubles(c, "friction_force", &t->friction_force, 1) && ab_keep_size(c, "points_found", &t->points) &&
           ab_keep_size(c, "active", &t->active) && ab_keep_doubles(c, "penetration", &t->penetration, 1) &&
           ab_keep_doubles(c, "friction_work", &t->friction_work, 1) && ab_keep_doubles(c, "contact_work", &t->contact_work, 1) &&
           ab_keep_size(c, "failures_so_far", &t->failures) && ab_keep_doubles(c, "peak_pressure", &t->peak_pressure, 1) &&
           ab_keep_doubles(c, "active_area", &t->area, 1);
}

/* Pressures shared out between points, which the results may still write. */
bool contact_keep_spread(contact_points *points, ab_checkpoint *c) {
    contact_spread *s = &points->spread;
    bool there = s->wanted && s->force && points->view.key;
    if (!s->wanted) return true;
    if (!ab_keep_flags(c, "shared", &there, 1) || !there) return ab_checkpoint_status(c) == AB_OK;
    if (!contact_spread_room(points)) return ab_checkpoint_refuse(c, "no memory for %zu contact points", points->view.count);
    return keep_rows(c, "pressure", s->force + 2 * points->view.ld, 2, &points->view);
}
