/* broad_phase.h: which faces may touch which points: cells along faces. Inside contact/ only. */
#ifndef AB_CONTACT_BROAD_PHASE_H
#define AB_CONTACT_BROAD_PHASE_H

#include "contact/contact.h"

typedef struct contact_box {
    double low[2], high[2];
} contact_box;

/* Where points of the other body may touch the faces of one: cells to ask that body for points in, and buckets that say which faces are near a place. Both are
 * made for faces where they stood then, wider by a margin, and serve until a vertex has moved by more than it. */
typedef struct contact_reach {
    double reach;       /* m: every place nearer than this to a face finds it, as long as no vertex has moved by more than the margin */
    double margin;      /* m */
    double bucket;      /* m, size of a bucket */
    contact_box window; /* m: only here; the other body's bounds, and a margin */
    size_t vertex_count, face_count, vertex_capacity;
    double *vertex; /* m, 2 rows of vertex_count: where vertices stood */
    size_t tile_count, tile_capacity;
    uint64_t *tile_key, *tile_cells; /* the region */
    size_t bucket_count, bucket_capacity;
    uint64_t *bucket_key; /* ascending */
    size_t *bucket_start; /* bucket_count + 1 */
    uint32_t *bucket_face;
    size_t bucket_face_capacity;
    size_t near_capacity, point_capacity;
    size_t *near_start; /* faces near the points that were given */
    uint32_t *near_face;
    size_t visits, builds;
    struct contact_mark *marks; /* scratch */
    size_t mark_count, mark_capacity;
} contact_reach;

struct contact_broad {
    double grid_cell, cell; /* m; grid_cell 0: there is no grid; cell 0: not known yet */
    double length[2];       /* m, of a typical face of a and of b, no more than a cell */
    double speed;           /* m/s */
    double needed[2];       /* m, reach of the last step */
    double depth;           /* m, by which the bodies overlapped in the last step */
    bool told;              /* that they are deep in each other */
    contact_reach reach[2]; /* of the faces of a and of b */
};

void contact_reach_destroy(contact_reach *);
/* Room for lists of these lengths as they are kept in a checkpoint; false: no memory. */
bool contact_reach_reserve(contact_reach *, size_t vertices, size_t tiles, size_t buckets, size_t faces);
/* Makes region and buckets anew where they no longer serve. cell: of the region, m; length: of a typical face, no more than a cell; needed: the reach wanted now, m.
 * other: bounds of the other body. False: no memory. */
bool contact_reach_update(contact_reach *, const ab_surface *faces, double cell, double length, double needed, const contact_box *other);
/* Lists for every point of `points` the faces no further from it than its half size and `distance`, ascending, into points->near_*. */
bool contact_reach_list(contact_reach *, const ab_surface *faces, ab_surface *points, double distance);

#endif
