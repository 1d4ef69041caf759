/* scene_shape.c: outlines of bodies, and sets of places on them. */
#include <math.h>
#include <string.h>

#include "core/scene_reader.h"

enum { MOST_CORNERS = 2000, MOST_MEMBERS = 1000 };
static const double LEAST_SIZE = 1e-30; /* m; its fourth power, as in moments of inertia, is still far from the smallest number */
static const double LEAST_PART = 1e-12; /* of the coordinates: smaller sizes are lost in their rounding */

static bool refuse(ab_scene_reader *r, ab_mark mark, const char *where, const char *why) {
    ab_report_error(r->base.report, mark, "%s: %s", where, why);
    return false;
}

static bool large_enough(ab_scene_reader *r, ab_mark mark, const char *where, const char *what, double size, const double at[2]) {
    const double away = fmax(fabs(at[0]), fabs(at[1]));
    if (size >= LEAST_SIZE && size >= LEAST_PART * away) return true;
    ab_report_error(r->base.report, mark,
                    "%s: %s is %.3g m, too small to compute with, %.3g m from the origin; write %.3g m or more there, or check the unit",
                    where, what, size, away, fmax(LEAST_SIZE, LEAST_PART * away));
    return false;
}

static bool take_box(ab_scene_reader *r, const ab_node *node, const char *where, ab_shape_spec *shape) {
    const ab_key corner = {"box", AB_KEY_POINT, .unit = "m", .help = ""};
    char path[AB_WHERE];
    ab_where_join(path, where, "box");
    if (node->kind != AB_NODE_LIST || node->count != 2) return refuse(r, node->mark, path, "must be two corners [[x, y], [x, y]]");
    const bool low = ab_read_point(&r->base, &corner, node->items[0], where, shape->low);
    const bool high = ab_read_point(&r->base, &corner, node->items[1], where, shape->high);
    if (!low || !high) return false;
    for (int d = 0; d < 2; d++)
        if (!(shape->low[d] < shape->high[d])) {
            ab_report_error(r->base.report, node->mark,
                            "%s: the second corner must lie above and to the right of the first; along %c it goes from %.10g to %.10g",
                            path, d == 0 ? 'x' : 'y', shape->low[d], shape->high[d]);
            return false;
        }
    return large_enough(r, node->mark, path, "the shorter side", fmin(shape->high[0] - shape->low[0], shape->high[1] - shape->low[1]),
                        shape->high);
}

static bool take_round(ab_scene_reader *r, const ab_section *section, const ab_node *node, const char *where, ab_shape_spec *shape) {
    char path[AB_WHERE];
    const ab_node *v[ROUND_KEYS] = {NULL, NULL, NULL};
    ab_where_join(path, where, section->title);
    if (!ab_section_open(&r->base, section, node, path, v)) return false;
    const ab_key *key = section->keys;
    const bool center = ab_read_point(&r->base, &key[ROUND_CENTER], v[ROUND_CENTER], path, shape->center);
    const bool radius = ab_read_number(&r->base, &key[ROUND_RADIUS], v[ROUND_RADIUS], path, &shape->radius);
    if (radius && !large_enough(r, v[ROUND_RADIUS]->mark, path, "the radius", shape->radius, shape->center)) return false;
    if (section->count <= ROUND_INNER) return center && radius;
    const bool inner = ab_read_number(&r->base, &key[ROUND_INNER], v[ROUND_INNER], path, &shape->inner);
    if (radius && inner && !(shape->inner < shape->radius)) {
        ab_report_error(r->base.report, v[ROUND_INNER]->mark, "%s: inner radius %.10g m is not less than radius %.10g m", path,
                        shape->inner, shape->radius);
        return false;
    }
    if (radius && inner && !large_enough(r, v[ROUND_INNER]->mark, path, "the wall", shape->radius - shape->inner, shape->center))
        return false;
    return center && radius && inner;
}

static double turn(const double a[2], const double b[2], const double c[2]) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static bool between(const double a[2], const double b[2], const double p[2]) { /* p on the line through a and b: within the piece? */
    return fmin(a[0], b[0]) <= p[0] && p[0] <= fmax(a[0], b[0]) && fmin(a[1], b[1]) <= p[1] && p[1] <= fmax(a[1], b[1]);
}

static bool meet(const double a[2], const double b[2], const double c[2], const double d[2]) {
    const double c_side = turn(a, b, c), d_side = turn(a, b, d), a_side = turn(c, d, a), b_side = turn(c, d, b);
    if (((c_side > 0 && d_side < 0) || (c_side < 0 && d_side > 0)) && ((a_side > 0 && b_side < 0) || (a_side < 0 && b_side > 0)))
        return true;
    return (c_side == 0 && between(a, b, c)) || (d_side == 0 && between(a, b, d)) || (a_side == 0 && between(c, d, a)) ||
           (b_side == 0 && between(c, d, b));
}

/* Pieces that are not neighbours may not meet; neighbours may not fold back on each other. */
static bool crosses_itself(const ab_shape_spec *shape, size_t *first, size_t *second) {
    const size_t n = shape->count;
    for (size_t i = 0; i < n; i++) {
        const double *a = shape->vertices[i], *b = shape->vertices[(i + 1) % n];
        for (size_t j = i + 1; j < n; j++) {
            const double *c = shape->vertices[j], *d = shape->vertices[(j + 1) % n];
            const bool next = j == i + 1, previous = (j + 1) % n == i;
            bool bad;
            if (next)
                bad = turn(a, b, d) == 0 && (b[0] - a[0]) * (d[0] - b[0]) + (b[1] - a[1]) * (d[1] - b[1]) < 0;
            else if (previous)
                bad = turn(c, d, b) == 0 && (d[0] - c[0]) * (b[0] - d[0]) + (d[1] - c[1]) * (b[1] - d[1]) < 0;
            else
                bad = meet(a, b, c, d);
            if (bad) {
                *first = i;
                *second = j;
                return true;
            }
        }
    }
    return false;
}

/* Corners of a polygon or hole; path: its own place, where: that of the list it stands in. */
static bool take_corners(ab_scene_reader *r, const ab_node *node, const char *where, const char *path, ab_shape_spec *shape) {
    const ab_key corner = {"polygon", AB_KEY_POINT, .unit = "m", .help = ""};
    if (node->kind != AB_NODE_LIST || node->count < 3)
        return refuse(r, node->mark, path, "needs a list of three corners or more [[x, y], [x, y], [x, y], ...]");
    if (node->count > MOST_CORNERS) {
        ab_report_error(r->base.report, node->mark, "%s has %zu corners, more than %d", path, node->count, MOST_CORNERS);
        return false;
    }
    shape->vertices = ab_reader_take(&r->base, node->count, sizeof *shape->vertices);
    if (shape->vertices == NULL) return false;
    bool good = true;
    for (size_t i = 0; i < node->count; i++) good = ab_read_point(&r->base, &corner, node->items[i], where, shape->vertices[i]) && good;
    if (!good) return false;
    size_t count = node->count;
    if (count > 3 && memcmp(shape->vertices[0], shape->vertices[count - 1], sizeof shape->vertices[0]) == 0)
        count--; /* closed by repeating the first corner */
    shape->count = count;
    double area = 0, size = 0;
    for (size_t i = 0; i < count; i++) {
        const double *a = shape->vertices[i], *b = shape->vertices[(i + 1) % count];
        size = fmax(size, fmax(fabs(a[0] - b[0]), fabs(a[1] - b[1])));
        if (a[0] == b[0] && a[1] == b[1]) {
            ab_report_error(r->base.report, node->items[i]->mark, "%s: corner %zu stands twice", path, i);
            return false;
        }
        area += 0.5 * ((a[0] - shape->vertices[0][0]) * (b[1] - shape->vertices[0][1]) -
                       (b[0] - shape->vertices[0][0]) * (a[1] - shape->vertices[0][1]));
    }
    if (!large_enough(r, node->mark, path, "the longest piece", size, shape->vertices[0])) return false;
    size_t first, second;
    if (crosses_itself(shape, &first, &second)) {
        ab_report_error(r->base.report, node->mark, "%s: the outline meets itself: the piece from corner %zu and the piece from corner %zu",
                        path, first, second);
        return false;
    }
    if (area == 0) return refuse(r, node->mark, path, "the corners lie on one line");
    for (size_t i = 0; area < 0 && i < count / 2; i++) { /* kept counter-clockwise */
        double spare[2];
        memcpy(spare, shape->vertices[i], sizeof spare);
        memcpy(shape->vertices[i], shape->vertices[count - 1 - i], sizeof spare);
        memcpy(shape->vertices[count - 1 - i], spare, sizeof spare);
    }
    return true;
}

/* The other polygons may neither meet nor hold one of this one's corners; `outer`: they must hold them all. */
static bool apart(ab_scene_reader *r, ab_mark mark, const char *path, size_t number, const ab_shape_spec *hole, const ab_shape_spec *other,
                  bool outer, size_t other_number) {
    bool inside = false;
    const double *p = hole->vertices[0];
    for (size_t j = 0; j < other->count; j++) {
        const double *c = other->vertices[j], *d = other->vertices[(j + 1) % other->count];
        for (size_t i = 0; i < hole->count; i++)
            if (meet(hole->vertices[i], hole->vertices[(i + 1) % hole->count], c, d)) {
                if (outer)
                    ab_report_error(r->base.report, mark,
                                    "%s[%zu]: its piece from corner %zu meets the outline's piece from corner %zu; a hole must leave some "
                                    "body round it",
                                    path, number, i, j);
                else
                    ab_report_error(
                        r->base.report, mark,
                        "%s[%zu]: its piece from corner %zu meets the piece from corner %zu of %s[%zu]; draw holes that meet as one", path,
                        number, i, j, path, other_number);
                return false;
            }
        if ((c[1] <= p[1]) != (d[1] <= p[1]) && c[0] + (p[1] - c[1]) / (d[1] - c[1]) * (d[0] - c[0]) > p[0]) inside = !inside;
    }
    if (inside == outer) return true;
    if (outer)
        ab_report_error(r->base.report, mark, "%s[%zu] lies outside of the polygon, and leaves nothing empty; leave it out", path, number);
    else
        ab_report_error(r->base.report, mark, "%s[%zu] lies inside of %s[%zu], where nothing is left to cut; leave it out", path, number,
                        path, other_number);
    return false;
}

static bool take_holes(ab_scene_reader *r, const ab_node *node, const char *where, ab_shape_spec *shape) {
    char path[AB_WHERE];
    ab_where_join(path, where, "holes");
    if (node->kind != AB_NODE_LIST || node->count == 0)
        return refuse(r, node->mark, path, "must be a list of polygons [[[x, y], [x, y], [x, y], ...], ...]");
    if (node->count > MOST_MEMBERS) return refuse(r, node->mark, path, "has more than 1000 polygons");
    shape->holes = ab_reader_take(&r->base, node->count, sizeof *shape->holes);
    if (shape->holes == NULL) return false;
    bool good = true;
    for (size_t i = 0; i < node->count; i++) {
        char name[AB_WHERE];
        snprintf(name, sizeof name, "%.150s[%zu]", path, i);
        shape->holes[i].kind = AB_SHAPE_POLYGON;
        shape->holes[i].mark = node->items[i]->mark;
        good = take_corners(r, node->items[i], name, name, &shape->holes[i]) && good;
    }
    for (size_t i = 0; i < node->count && good; i++) {
        good = apart(r, node->items[i]->mark, path, i, &shape->holes[i], shape, true, 0);
        for (size_t j = 0; j < node->count && good; j++)
            if (j != i) good = apart(r, node->items[i]->mark, path, i, &shape->holes[i], &shape->holes[j], false, j);
    }
    shape->hole_count = good ? node->count : 0;
    return good;
}

static bool take_polygon(ab_scene_reader *r, const ab_node *node, const ab_node *holes, const char *where, ab_shape_spec *shape) {
    char path[AB_WHERE];
    const bool good = take_corners(r, node, where, ab_where_join(path, where, "polygon"), shape);
    return good && (holes == NULL || take_holes(r, holes, where, shape));
}

static bool take_union(ab_scene_reader *r, const ab_node *node, const char *where, ab_shape_spec *shape) {
    char path[AB_WHERE];
    ab_where_join(path, where, "union");
    if (node->kind != AB_NODE_LIST || node->count == 0) return refuse(r, node->mark, path, "must be a list of shapes");
    if (node->count > MOST_MEMBERS) return refuse(r, node->mark, path, "has more than 1000 shapes");
    shape->members = ab_reader_take(&r->base, node->count, sizeof *shape->members);
    if (shape->members == NULL) return false;
    shape->count = node->count;
    bool good = true;
    for (size_t i = 0; i < node->count; i++) {
        char member[AB_WHERE];
        snprintf(member, sizeof member, "%.150s[%zu]", path, i);
        good = ab_scene_take_shape(r, node->items[i], member, &shape->members[i]) && good;
        if (good && shape->members[i].kind == AB_SHAPE_MESH)
            good = refuse(r, node->items[i]->mark, member, "a mesh stands alone; put all elements into one mesh");
    }
    return good;
}

bool ab_scene_take_shape(ab_scene_reader *r, const ab_node *node, const char *where, ab_shape_spec *shape) {
    const ab_node *v[SHAPE_KEYS];
    shape->mark = node->mark;
    if (!ab_section_open(&r->base, &ab_section_shape, node, where, v)) return false;
    size_t given = 0;
    for (int k = 0; k < SHAPE_KEYS; k++) given += v[k] != NULL && k != SHAPE_HOLES;
    if (v[SHAPE_HOLES] != NULL && v[SHAPE_POLYGON] == NULL)
        return refuse(r, v[SHAPE_HOLES]->mark, where, "holes stand beside a polygon; a disc with a round hole is a ring");
    if (given != 1) {
        if (node->count == 0 || given > 1)
            refuse(r, node->mark, where,
                   "one of box, disc, ring, polygon, union and mesh is needed; several shapes are {union: [{...}, {...}]}");
        return false;
    }
    bool good = false;
    if (v[SHAPE_BOX] != NULL) {
        good = take_box(r, v[SHAPE_BOX], where, shape);
        shape->kind = AB_SHAPE_BOX;
    } else if (v[SHAPE_DISC] != NULL) {
        good = take_round(r, &ab_section_disc, v[SHAPE_DISC], where, shape);
        shape->kind = AB_SHAPE_DISC;
    } else if (v[SHAPE_RING] != NULL) {
        good = take_round(r, &ab_section_ring, v[SHAPE_RING], where, shape);
        shape->kind = AB_SHAPE_RING;
    } else if (v[SHAPE_POLYGON] != NULL) {
        good = take_polygon(r, v[SHAPE_POLYGON], v[SHAPE_HOLES], where, shape);
        shape->kind = AB_SHAPE_POLYGON;
    } else if (v[SHAPE_UNION] != NULL) {
        good = take_union(r, v[SHAPE_UNION], where, shape);
        shape->kind = AB_SHAPE_UNION;
    } else if (v[SHAPE_MESH] != NULL) { /* read by whoever has a body for it */
        good = true;
        shape->kind = AB_SHAPE_MESH;
    }
    if (!good) shape->kind = 0;
    return good;
}

bool ab_shape_bounds(const ab_shape_spec *shape, double low[2], double high[2]) {
    if (shape->kind == 0) return false;
    if (shape->kind == AB_SHAPE_BOX) {
        memcpy(low, shape->low, 2 * sizeof *low);
        memcpy(high, shape->high, 2 * sizeof *high);
        return true;
    }
    for (int d = 0; d < 2; d++) {
        low[d] = shape->center[d] - shape->radius;
        high[d] = shape->center[d] + shape->radius;
        if (shape->kind == AB_SHAPE_POLYGON || shape->kind == AB_SHAPE_UNION) {
            low[d] = INFINITY;
            high[d] = -INFINITY;
        }
    }
    for (size_t i = 0; i < shape->count; i++) {
        double from[2], to[2];
        if (shape->kind == AB_SHAPE_POLYGON) {
            memcpy(from, shape->vertices[i], sizeof from);
            memcpy(to, shape->vertices[i], sizeof to);
        } else if (!ab_shape_bounds(&shape->members[i], from, to)) {
            return false;
        }
        for (int d = 0; d < 2; d++) {
            low[d] = fmin(low[d], from[d]);
            high[d] = fmax(high[d], to[d]);
        }
    }
    return true;
}

static bool take_range(ab_scene_reader *r, const ab_node *node, const ab_key *key, const char *where, double range[2]) {
    char path[AB_WHERE];
    if (node->kind != AB_NODE_LIST) {
        if (!ab_read_number(&r->base, key, node, where, &range[0])) return false;
        range[1] = range[0];
        return true;
    }
    if (!ab_read_point(&r->base, key, node, where, range)) return false;
    if (range[0] <= range[1]) return true;
    ab_report_error(r->base.report, node->mark, "%s: the range goes from %.10g down to %.10g; write the smaller one first",
                    ab_where_join(path, where, key->name), range[0], range[1]);
    return false;
}

bool ab_scene_take_where(ab_scene_reader *r, const ab_node *node, const char *where, ab_where *set) {
    const ab_node *v[WHERE_KEYS];
    *set = (ab_where){.side = -1, .mark = node->mark};
    if (!ab_section_open(&r->base, &ab_section_where, node, where, v)) return false;
    const ab_key *key = ab_section_where.keys;
    bool good = true;
    if (v[WHERE_ALL] != NULL) {
        good = ab_read_flag(&r->base, &key[WHERE_ALL], v[WHERE_ALL], where, &set->all);
        if (good && !set->all) good = refuse(r, v[WHERE_ALL]->mark, where, "all: false says nothing; leave it out");
        if (good && node->count > 1) good = refuse(r, node->mark, where, "all: true stands alone");
    }
    char *side = NULL;
    if (v[WHERE_SIDE] != NULL) {
        good = ab_read_word(&r->base, &key[WHERE_SIDE], v[WHERE_SIDE], where, &side) && good;
        for (int s = 0; side != NULL && s < AB_SIDES; s++)
            if (strcmp(side, ab_section_sides.keys[s].name) == 0) set->side = s;
    }
    for (int d = 0; d < 2; d++) {
        if (v[WHERE_X + d] == NULL) continue;
        set->has[d] = take_range(r, v[WHERE_X + d], &key[WHERE_X + d], where, set->range[d]);
        good = good && set->has[d];
    }
    if (node->count == 0) good = refuse(r, node->mark, where, "says nothing; write {all: true}, {side: top}, {x: 0} or {y: [0, 1]}");
    return good;
}
