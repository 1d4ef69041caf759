/* fill_union.h: members of a union and which of them overlap. Inside the fill only. */
#ifndef AB_FILL_UNION_H
#define AB_FILL_UNION_H

#include "mpm/fill_outline.h"

typedef struct ab_member {
    const ab_shape_spec *shape; /* box, disc, ring, polygon */
    ab_outline outline;         /* of straight edges; of a disc or ring one of as many edges as `sides` says, of the same area */
    double low[2], high[2];
    size_t group; /* lowest number of a member that it overlaps, directly or through others */
} ab_member;

/* Edges of a disc or ring (outer counter-clockwise, inner clockwise): equal_area, or inscribed. sides: a multiple of 4. */
ab_status ab_outline_round(const ab_shape_spec *shape, size_t sides, bool equal_area, ab_outline *outline, const char *body,
                           ab_report *report);

/* Sets the groups. Members that only touch do not overlap. */
ab_status ab_union_group(ab_member *members, size_t count, const char *body, ab_report *report);

/* The outline of all members of a group together. */
ab_status ab_union_join(const ab_member *members, size_t count, size_t group, ab_outline *outline, const char *body, ab_report *report);

/* The outline of all members of a union, whether they overlap, touch or stand apart. */
ab_status ab_union_outline(const ab_filler *filler, const ab_shape_spec *shape, ab_outline *outline);

ab_status ab_fill_union(ab_filler *filler, const ab_shape_spec *shape);

#endif
