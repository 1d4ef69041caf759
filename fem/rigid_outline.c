/* rigid_outline.c: the outline of a rigid body from its shape or mesh: vertices, faces, places that may touch others, area, centre and second moment. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/rigid.h"

/* A circle is so many parabolas, each through three places of it. They leave it by (pi/n)^4/32 = 1.2e-8 of the radius, their normals by (pi/n)^3/4 = 3.7e-6 rad.
 * As places that touch the faces of others stand so many points on it: between two of them a circle that rolls on a straight face dips by 4.7e-6 of
 * its radius. */
enum { ARCS = 128, POINTS_PER_ARC = 8 };
static const double PI = 3.14159265358979323846;

void rigid_outline_clear(rigid_outline *o) {
    free(o->vertex), free(o->face), free(o->beside), free(o->point), free(o->point_area), free(o->point_vertex);
    fem_mesh_destroy(o->mesh);
    *o = (rigid_outline){0};
}

static ab_status no_memory(const ab_body_spec *spec, ab_report *report) {
    return ab_report_failure(report, "no memory for the outline of body '%s'", spec->name);
}

static bool reserve(rigid_outline *o, size_t vertices, size_t faces, size_t points) {
    o->vertex = malloc((vertices + 1) * sizeof *o->vertex);
    o->face = malloc((3 * faces + 1) * sizeof *o->face);
    o->beside = malloc((2 * faces + 1) * sizeof *o->beside);
    o->point = malloc((points + 1) * sizeof *o->point);
    o->point_area = calloc(points + 1, sizeof *o->point_area);
    o->point_vertex = malloc((points + 1) * sizeof *o->point_vertex);
    o->vertex_count = vertices;
    o->face_count = faces;
    o->point_count = points;
    return o->vertex && o->face && o->beside && o->point && o->point_area && o->point_vertex;
}

/* Place and derivative on a face at xi in -1..1. */
static void on_face(const rigid_outline *o, size_t f, double xi, double x[2], double slope[2]) {
    const double *a = o->vertex[o->face[3 * f]], *b = o->vertex[o->face[3 * f + 1]];
    const uint32_t m = o->face[3 * f + 2];
    for (int c = 0; c < 2; ++c) {
        const double bow = m == FEM_NONE ? 0.0 : o->vertex[m][c] - 0.5 * (a[c] + b[c]);
        x[c] = 0.5 * (a[c] + b[c]) + 0.5 * (b[c] - a[c]) * xi + bow * (1.0 - xi * xi);
        slope[c] = 0.5 * (b[c] - a[c]) - 2.0 * bow * xi;
    }
}

static const double GAUSS_PLACE[4] = {-0.86113631159405257522, -0.33998104358485626480, 0.33998104358485626480, 0.86113631159405257522};
static const double GAUSS_WEIGHT[4] = {0.34785484513745385737, 0.65214515486254614263, 0.65214515486254614263, 0.34785484513745385737};

/* Area, centre and second moment by integrals along the faces (Green), exact for parabolas: the last has degree 7. */
static void measure(rigid_outline *o) {
    const double about[2] = {o->vertex[0][0], o->vertex[0][1]};
    double area = 0.0, first[2] = {0.0}, polar = 0.0;
    for (size_t f = 0; f < o->face_count; ++f)
        for (int q = 0; q < 4; ++q) {
            double x[2], d[2];
            on_face(o, f, GAUSS_PLACE[q], x, d);
            const double u = x[0] - about[0], v = x[1] - about[1], w = GAUSS_WEIGHT[q];
            area += w * 0.5 * (u * d[1] - v * d[0]);
            first[0] += w * 0.5 * u * u * d[1];
            first[1] -= w * 0.5 * v * v * d[0];
            polar += w * (u * u * u * d[1] - v * v * v * d[0]) / 3.0;
        }
    o->area = area;
    const double u = first[0] / area, v = first[1] / area;
    o->centre[0] = about[0] + u;
    o->centre[1] = about[1] + v;
    o->polar = polar - area * (u * u + v * v);
}

/* Each vertex is a point and takes half of the faces beside it (a middle vertex two thirds of its face, as in Simpson's rule). */
static void points_at_vertices(rigid_outline *o) {
    for (size_t k = 0; k < o->vertex_count; ++k) {
        memcpy(o->point[k], o->vertex[k], sizeof *o->point);
        o->point_vertex[k] = (uint32_t)k;
    }
    for (size_t f = 0; f < o->face_count; ++f) {
        const uint32_t *v = o->face + 3 * f;
        double length = 0.0;
        for (int q = 0; q < 4; ++q) {
            double x[2], d[2];
            on_face(o, f, GAUSS_PLACE[q], x, d);
            length += GAUSS_WEIGHT[q] * hypot(d[0], d[1]);
        }
        const double end = v[2] == FEM_NONE ? 0.5 : 1.0 / 6.0;
        o->point_area[v[0]] += end * length;
        o->point_area[v[1]] += end * length;
        if (v[2] != FEM_NONE) o->point_area[v[2]] += (1.0 - 2.0 * end) * length;
    }
}

static ab_status of_corners(const ab_body_spec *spec, const double (*corner)[2], size_t count, rigid_outline *o, ab_report *report) {
    if (!reserve(o, count, count, count)) return no_memory(spec, report);
    for (size_t k = 0; k < count; ++k) {
        memcpy(o->vertex[k], corner[k], sizeof *o->vertex);
        o->face[3 * k] = (uint32_t)k;
        o->face[3 * k + 1] = (uint32_t)((k + 1) % count);
        o->face[3 * k + 2] = FEM_NONE;
        o->beside[2 * k] = (uint32_t)((k + count - 1) % count);
        o->beside[2 * k + 1] = (uint32_t)((k + 1) % count);
    }
    measure(o);
    if (!(o->area > 0.0)) return ab_report_error(report, spec->shape.mark, "body '%s': its outline encloses no area", spec->name);
    points_at_vertices(o);
    return AB_OK;
}

/* One circle: vertices and faces from number `first` on, counter-clockwise, or clockwise round a hole. */
static void circle(rigid_outline *o, size_t first_face, const double centre[2], double radius, double sense) {
    const size_t first = 2 * first_face, points = ARCS * POINTS_PER_ARC, first_point = first_face * POINTS_PER_ARC;
    for (size_t k = 0; k < 2 * ARCS; ++k) {
        const double angle = sense * PI * (double)k / ARCS;
        o->vertex[first + k][0] = centre[0] + radius * cos(angle);
        o->vertex[first + k][1] = centre[1] + radius * sin(angle);
    }
    for (size_t f = 0; f < ARCS; ++f) {
        uint32_t *face = o->face + 3 * (first_face + f), *beside = o->beside + 2 * (first_face + f);
        face[0] = (uint32_t)(first + 2 * f);
        face[1] = (uint32_t)(first + (2 * f + 2) % (2 * ARCS));
        face[2] = (uint32_t)(first + 2 * f + 1);
        beside[0] = (uint32_t)(first_face + (f + ARCS - 1) % ARCS);
        beside[1] = (uint32_t)(first_face + (f + 1) % ARCS);
    }
    for (size_t k = 0; k < points; ++k) {
        const double angle = sense * 2.0 * PI * (double)k / points;
        const size_t at = first_point + k, every = POINTS_PER_ARC / 2;
        o->point[at][0] = centre[0] + radius * cos(angle);
        o->point[at][1] = centre[1] + radius * sin(angle);
        o->point_area[at] = 2.0 * PI * radius / points;
        o->point_vertex[at] = k % every ? UINT32_MAX : (uint32_t)(first + k / every);
    }
}

static ab_status of_circles(const ab_body_spec *spec, double outer, double inner, rigid_outline *o, ab_report *report) {
    const size_t rings = inner > 0.0 ? 2 : 1;
    if (!reserve(o, 2 * rings * ARCS, rings * ARCS, rings * ARCS * POINTS_PER_ARC)) return no_memory(spec, report);
    circle(o, 0, spec->shape.center, outer, 1.0);
    if (rings == 2) circle(o, ARCS, spec->shape.center, inner, -1.0);
    memcpy(o->centre, spec->shape.center, sizeof o->centre);
    o->radius = outer;
    o->inner = inner;
    o->area = PI * (outer * outer - inner * inner);
    o->polar = 0.5 * PI * (outer * outer * outer * outer - inner * inner * inner * inner);
    return AB_OK;
}

/* The folder of a scene's file, "" for the working directory. */
static char *folder_of(const char *path) {
    const char *slash = path ? strrchr(path, '/') : NULL;
    const size_t length = slash ? (size_t)(slash - path) + (slash == path) : 0;
    char *folder = malloc(length + 2);
    if (!folder) return NULL;
    memcpy(folder, length ? path : ".", length ? length : 1);
    folder[length ? length : 1] = '\0';
    return folder;
}

static ab_status of_mesh(const ab_scene *scene, const ab_body_spec *spec, rigid_outline *o, ab_report *report) {
    char *folder = folder_of(scene->path);
    if (!folder) return no_memory(spec, report);
    ab_status status = fem_mesh_create(spec, folder, &o->mesh, report);
    free(folder);
    AB_TRY(status);
    fem_faces *faces = NULL;
    AB_TRY(fem_faces_create(o->mesh, spec->name, &faces, report));
    uint32_t *place = malloc((o->mesh->node_count + 1) * sizeof *place);
    if (!place || !reserve(o, faces->node_count, faces->count, faces->node_count)) {
        status = no_memory(spec, report);
    } else {
        for (size_t k = 0; k < faces->node_count; ++k) {
            place[faces->node[k]] = (uint32_t)k;
            memcpy(o->vertex[k], o->mesh->x + 2 * (size_t)faces->node[k], sizeof *o->vertex);
        }
        for (size_t f = 0; f < 3 * faces->count; ++f) o->face[f] = faces->vertex[f] == FEM_NONE ? FEM_NONE : place[faces->vertex[f]];
        memcpy(o->beside, faces->beside, 2 * faces->count * sizeof *o->beside);
        measure(o);
        points_at_vertices(o);
    }
    free(place);
    fem_faces_destroy(faces);
    return status;
}

ab_status rigid_outline_create(const ab_scene *scene, const ab_body_spec *spec, rigid_outline *o, ab_report *report) {
    *o = (rigid_outline){0};
    const ab_shape_spec *s = &spec->shape;
    if (!spec->has_shape) return of_mesh(scene, spec, o, report);
    switch (s->kind) {
    case AB_SHAPE_BOX: {
        const double corner[4][2] = {{s->low[0], s->low[1]}, {s->high[0], s->low[1]}, {s->high[0], s->high[1]}, {s->low[0], s->high[1]}};
        return of_corners(spec, corner, 4, o, report);
    }
    case AB_SHAPE_POLYGON:
        if (s->hole_count > 0)
            return ab_report_error(
                report, s->mark,
                "body '%s': a rigid body cannot have a polygon with holes; write a mesh or a ring, or leave the holes out and give "
                "motion.mass and motion.inertia",
                spec->name);
        return of_corners(spec, (const double(*)[2])s->vertices, s->count, o, report);
    case AB_SHAPE_DISC: return of_circles(spec, s->radius, 0.0, o, report);
    case AB_SHAPE_RING: return of_circles(spec, s->radius, s->inner, o, report);
    default: /* a mesh is refused where it is read */
        return ab_report_error(
            report, s->mark,
            "body '%s': a rigid body cannot be a union of shapes; write one polygon round all of it, or a body for each part", spec->name);
    }
}
