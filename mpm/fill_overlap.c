/* fill_overlap.c: which members of a union overlap, and the outline of those together; by GEOS (libgeos, its C interface). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mpm/fill_union.h"

#ifdef ABUT_WITH_GEOS
#include <geos_c.h>

typedef struct geos { /* a context and its last message */
    GEOSContextHandle_t handle;
    char message[256];
} geos;

static void keep_message(const char *text, void *data) {
    geos *g = data;
    snprintf(g->message, sizeof g->message, "%s", text);
}

static ab_status open_geos(geos *g, const char *body, ab_report *report) {
    g->message[0] = 0;
    g->handle = GEOS_init_r();
    if (!g->handle) return ab_report_failure(report, "body '%s': no memory to join its shapes", body);
    GEOSContext_setErrorMessageHandler_r(g->handle, keep_message, g);
    return AB_OK;
}

/* One closed chain of edges from `first` on; *next: where the one after it begins. */
static GEOSGeometry *ring_of(const geos *g, const ab_outline *outline, size_t first, size_t *next) {
    size_t end = first;
    while (end + 1 < outline->count && memcmp(outline->edge[end].to, outline->edge[end + 1].from, sizeof outline->edge[end].to) == 0) end++;
    *next = end + 1;
    const size_t count = end - first + 2;
    double *places = malloc(count * sizeof(double[2]));
    if (!places) return NULL;
    for (size_t k = 0; k < count; k++) memcpy(&places[2 * k], outline->edge[first + k % (count - 1)].from, sizeof(double[2]));
    GEOSCoordSequence *sequence = GEOSCoordSeq_copyFromBuffer_r(g->handle, places, (unsigned)count, 0, 0);
    free(places);
    return sequence ? GEOSGeom_createLinearRing_r(g->handle, sequence) : NULL;
}

/* A member as a polygon: its first chain the outside, others holes. */
static GEOSGeometry *polygon_of(const geos *g, const ab_outline *outline) {
    size_t next = 0, count = 0;
    GEOSGeometry *shell = ring_of(g, outline, 0, &next), *polygon = NULL, **hole = malloc((outline->count + 1) * sizeof *hole);
    bool good = shell && hole;
    while (good && next < outline->count) {
        hole[count] = ring_of(g, outline, next, &next);
        good = hole[count] != NULL;
        count += good;
    }
    if (good)
        polygon = GEOSGeom_createPolygon_r(g->handle, shell, count > 0 ? hole : NULL, (unsigned)count); /* takes them over */
    else {
        if (shell) GEOSGeom_destroy_r(g->handle, shell);
        for (size_t k = 0; k < count; k++) GEOSGeom_destroy_r(g->handle, hole[k]);
    }
    free(hole);
    return polygon;
}

static ab_status trouble(const geos *g, const char *body, ab_report *report) {
    return ab_report_failure(report, "body '%s': its shapes cannot be joined: %s", body, g->message[0] ? g->message : "no memory");
}

/* Sets *overlap where the two have more than a sliver in common. Round members are taken inscribed, so that touching ones do not. */
static ab_status overlap_of(const geos *g, GEOSGeometry *const *polygons, const ab_member *members, size_t a, size_t b, bool *overlap,
                            const char *body, ab_report *report) {
    GEOSGeometry *common = GEOSIntersection_r(g->handle, polygons[a], polygons[b]);
    double area = 0;
    const int good = common ? GEOSArea_r(g->handle, common, &area) : 0;
    if (common) GEOSGeom_destroy_r(g->handle, common);
    if (!good) return trouble(g, body, report);
    *overlap = area > 1e-9 * fmin(members[a].outline.area, members[b].outline.area);
    return AB_OK;
}

static ab_status group_all(const geos *g, GEOSGeometry *const *polygons, ab_member *members, size_t count, const char *body,
                           ab_report *report) {
    for (size_t a = 0; a < count; a++)
        for (size_t b = a + 1; b < count; b++) {
            if (members[a].group == members[b].group || members[a].low[0] >= members[b].high[0] ||
                members[b].low[0] >= members[a].high[0] || members[a].low[1] >= members[b].high[1] ||
                members[b].low[1] >= members[a].high[1])
                continue;
            bool overlap = false;
            AB_TRY(overlap_of(g, polygons, members, a, b, &overlap, body, report));
            if (!overlap) continue;
            const size_t p = members[a].group, q = members[b].group, low = p < q ? p : q, high = p < q ? q : p;
            for (size_t k = 0; k < count; k++)
                if (members[k].group == high) members[k].group = low;
        }
    return AB_OK;
}

ab_status ab_union_group(ab_member *members, size_t count, const char *body, ab_report *report) {
    geos g;
    AB_TRY(open_geos(&g, body, report));
    GEOSGeometry **polygons = calloc(count, sizeof *polygons);
    ab_status status = polygons ? AB_OK : trouble(&g, body, report);
    for (size_t k = 0; k < count && status == AB_OK; k++) {
        const ab_shape_spec *shape = members[k].shape;
        members[k].group = k;
        ab_outline inscribed = {0};
        if (shape->kind == AB_SHAPE_DISC || shape->kind == AB_SHAPE_RING)
            status = ab_outline_round(shape, 2048, false, &inscribed, body, report);
        if (status == AB_OK) polygons[k] = polygon_of(&g, inscribed.edge ? &inscribed : &members[k].outline);
        if (status == AB_OK && !polygons[k]) status = trouble(&g, body, report);
        ab_outline_clear(&inscribed);
    }
    if (status == AB_OK) status = group_all(&g, polygons, members, count, body, report);
    for (size_t k = 0; polygons && k < count; k++)
        if (polygons[k]) GEOSGeom_destroy_r(g.handle, polygons[k]);
    free(polygons);
    GEOS_finish_r(g.handle);
    return status;
}

/* Appends a ring of GEOS, turned so that the body is on its left. */
static bool append_ring(const geos *g, const GEOSGeometry *ring, bool hole, ab_outline *outline) {
    const GEOSCoordSequence *sequence = GEOSGeom_getCoordSeq_r(g->handle, ring);
    unsigned size = 0;
    if (!sequence || !GEOSCoordSeq_getSize_r(g->handle, sequence, &size) || size < 4) return false;
    double(*place)[2] = malloc(size * sizeof *place);
    ab_edge *edge = realloc(outline->edge, (outline->count + size) * sizeof *edge);
    if (edge) outline->edge = edge;
    if (!place || !edge || !GEOSCoordSeq_copyToBuffer_r(g->handle, sequence, &place[0][0], 0, 0)) {
        free(place);
        return false;
    }
    double area = 0;
    for (unsigned k = 0; k + 1 < size; k++)
        area += 0.5 * ((place[k][0] - place[0][0]) * (place[k + 1][1] - place[0][1]) -
                       (place[k + 1][0] - place[0][0]) * (place[k][1] - place[0][1]));
    const bool backwards = (area < 0) != hole;
    for (unsigned k = 0; k + 1 < size; k++) {
        const double *from = place[backwards ? size - 1 - k : k], *to = place[backwards ? size - 2 - k : k + 1];
        outline->edge[outline->count++] = (ab_edge){{from[0], from[1]}, {to[0], to[1]}};
    }
    outline->area += hole ? -fabs(area) : fabs(area);
    free(place);
    return true;
}

static bool append_geometry(const geos *g, const GEOSGeometry *geometry, ab_outline *outline) {
    if (GEOSGeomTypeId_r(g->handle, geometry) != GEOS_POLYGON) { /* a collection; lines and points in it have no area */
        for (int k = 0; k < GEOSGetNumGeometries_r(g->handle, geometry); k++) {
            const GEOSGeometry *part = GEOSGetGeometryN_r(g->handle, geometry, k);
            if (GEOSGeomTypeId_r(g->handle, part) == GEOS_POLYGON && !append_geometry(g, part, outline)) return false;
        }
        return true;
    }
    const GEOSGeometry *shell = GEOSGetExteriorRing_r(g->handle, geometry);
    if (!shell || !append_ring(g, shell, false, outline)) return false;
    for (int k = 0; k < GEOSGetNumInteriorRings_r(g->handle, geometry); k++)
        if (!append_ring(g, GEOSGetInteriorRingN_r(g->handle, geometry, k), true, outline)) return false;
    return true;
}

ab_status ab_union_join(const ab_member *members, size_t count, size_t group, ab_outline *outline, const char *body, ab_report *report) {
    *outline = (ab_outline){0};
    geos g;
    AB_TRY(open_geos(&g, body, report));
    GEOSGeometry **parts = calloc(count, sizeof *parts), *all = NULL, *joined = NULL;
    size_t used = 0;
    bool good = parts != NULL;
    for (size_t k = 0; k < count && good; k++) {
        if (members[k].group != group) continue;
        parts[used] = polygon_of(&g, &members[k].outline);
        good = parts[used++] != NULL;
    }
    if (good) all = GEOSGeom_createCollection_r(g.handle, GEOS_GEOMETRYCOLLECTION, parts, (unsigned)used); /* takes the parts over */
    if (all)
        joined = GEOSUnaryUnion_r(g.handle, all);
    else
        for (size_t k = 0; parts && k < used; k++)
            if (parts[k]) GEOSGeom_destroy_r(g.handle, parts[k]);
    good = joined && append_geometry(&g, joined, outline) && outline->count > 0;
    const ab_status status = good ? AB_OK : trouble(&g, body, report);
    if (!good) ab_outline_clear(outline);
    if (joined) GEOSGeom_destroy_r(g.handle, joined);
    if (all) GEOSGeom_destroy_r(g.handle, all);
    free(parts);
    GEOS_finish_r(g.handle);
    return status;
}

#else

ab_status ab_union_group(ab_member *members, size_t count, const char *body, ab_report *report) {
    (void)members;
    (void)count;
    return ab_report_failure(report, "body '%s' is a union, and this abut is built without GEOS: install libgeos-dev and build again",
                             body);
}

ab_status ab_union_join(const ab_member *members, size_t count, size_t group, ab_outline *outline, const char *body, ab_report *report) {
    (void)group;
    (void)outline;
    return ab_union_group((ab_member *)(uintptr_t)members, count, body, report);
}

#endif
