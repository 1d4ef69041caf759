/* outline.c: the faces of a material-point body: loops of vertices along its outline, which move with the velocities of the grid as the points do.
 *
 * A vertex hangs on the four nodes of its cell by hat functions. Nodes that hardly carry mass have velocities of no meaning (a finite stress on next to no
 * mass): their weight fades with their mass, and the others take it over. What a finder learns of a vertex' velocity is what moves it.
 *
 * Nothing holds such a vertex to its place on the body, and over many turns it would creep along the outline (by 0.15 of a cell a turn, and the corners with it).
 * So each has arms from the points under it, which stretch and turn as those points' domains do, and is drawn to where they end: the faster, the faster the
 * material deforms, so that bodies that move without deforming move their faces exactly.
 *
 * And the faster, the more the vertex goes another way than its arms' ends. A body with fewer rows of points than rows of nodes (one point a cell; a thickness of less than two cells
 * with two a cell) has velocities of nodes that no point sees. Forces that are out of balance there move nothing but such a vertex, and as strain is taken
 * from velocities mapped back from points (musl, usavg, usf), nothing ever balances them: outlines at rest ran away from their points, by cells in 1e3 steps. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "mpm/body.h"
#include "mpm/outline.h"

enum { NODES = 4 };
static const double SPACING = 0.5;                   /* of a cell, between vertices */
static const double SHORTEST = 0.125, LONGEST = 1.0; /* of a cell; faces that get shorter or longer are joined or divided */
static const double DRAWN = 3.0; /* times the displacement gradient of a step: share by which a vertex nears its arm's end */
static const double HELD =
    100.0; /* times the way that it goes beyond its arm's end in a step, in cells: it stands off by 1/HELD of a cell for that at most */
static const double FULL = 0.1; /* of a point's mass: nodes with less fade */

void mpm_outline_destroy(struct mpm_outline *o) {
    if (!o) return;
    mpm_loops_clear(&o->loops);
    mpm_touching_destroy(o->touching);
    free(o->position), free(o->start), free(o->dof), free(o->weight), free(o->vertex), free(o->beside), free(o);
}

size_t mpm_outline_bytes(const struct mpm_outline *o) {
    return o ? sizeof *o + o->loops.capacity * 81 + o->capacity * (16 + 8 + 20) + o->room * 12 + mpm_touching_bytes(o->touching) : 0;
}

/* What a finder may see of surface points: themselves, or the outline between them near nodes of the grid. */
static const uint32_t SEES_SURFACE_POINTS = AB_NEED_SURFACE | AB_NEED_NEAR_POINTS;

/* A finder that sees neither would let bodies touch elsewhere than asked for. */
static ab_status check_finders(const mpm_body *body, ab_report *report) {
    const ab_scene *scene = body->scene;
    const ab_body_spec *spec = body->domain.spec;
    for (size_t k = 0; k < scene->contact_count && spec->surface_points > 0.0; ++k) {
        const ab_contact_spec *contact = scene->contacts + k;
        if (contact->body[0] != body->domain.index && contact->body[1] != body->domain.index) continue;
        if (!(contact->finder->class_.needs & SEES_SURFACE_POINTS))
            return ab_report_error(report, contact->mark,
                                   "contact by '%s' looks at the nodes of the grid and not at the surface points of body '%s'; use "
                                   "point-to-segment or multi-velocity, or leave surface: points out of the body",
                                   contact->finder->class_.name, spec->name);
    }
    return AB_OK;
}

/* Faces are wanted where a finder looks at surfaces and the other body is made of points too; any other body brings faces of its own. Vertices that touch are wanted
 * wherever it does. */
static bool wants_faces(const mpm_body *body) {
    const ab_scene *scene = body->scene;
    for (size_t k = 0; k < scene->contact_count; ++k) {
        const ab_contact_spec *contact = scene->contacts + k;
        const size_t own = body->domain.index;
        const uint32_t needs = contact->finder->class_.needs;
        if (contact->body[0] != own && contact->body[1] != own) continue;
        if (body->domain.spec->surface_points > 0.0 && (needs & SEES_SURFACE_POINTS)) return true;
        if (!(needs & AB_NEED_SURFACE)) continue;
        const size_t other = contact->body[contact->body[0] == own];
        if (!strcmp(scene->bodies[other].method, body->domain.ops->method)) return true;
    }
    return false;
}

ab_status mpm_outline_create(mpm_body *body, const ab_fill *fill, ab_report *report) {
    AB_TRY(check_finders(body, report));
    if (!wants_faces(body)) return AB_OK;
    body->outline = calloc(1, sizeof *body->outline);
    if (!body->outline) return ab_report_failure(report, "body '%s': no memory for its outline", body->domain.spec->name);
    mpm_loops *loops = &body->outline->loops;
    if (!mpm_points_index(body)) return ab_report_failure(report, "body '%s': no memory for its outline", body->domain.spec->name);
    const double spacing = body->domain.spec->surface_points;
    AB_TRY(mpm_loops_create(fill, (spacing > 0.0 ? spacing : SPACING) * body->h, !(spacing > 0.0), body->domain.spec->name, loops, report));
    for (size_t k = 0; k < loops->count; ++k)
        for (size_t c = 0; c < 2; ++c) loops->x[2 * k + c] -= body->origin[c];
    return spacing > 0.0 ? mpm_touching_create(body, fill, report) : AB_OK;
}

static bool reserve(struct mpm_outline *o) {
    const size_t count = o->loops.count;
    if (count <= o->capacity) return true;
    const size_t n = (count + count / 2 + 8) / 8 * 8;
    if (!ab_memory_resize(&o->position, 2 * n, sizeof(double)) || !ab_memory_resize(&o->start, n + 1, sizeof *o->start) ||
        !ab_memory_resize(&o->vertex, 3 * n, sizeof *o->vertex) || !ab_memory_resize(&o->beside, 2 * n, sizeof *o->beside))
        return false;
    o->capacity = o->ld = n;
    return true;
}

static bool reserve_stencil(struct mpm_outline *o, size_t nodes) {
    if (nodes <= o->room) return true;
    if (!ab_memory_resize(&o->dof, 2 * nodes, sizeof *o->dof) || !ab_memory_resize(&o->weight, 2 * nodes, sizeof(double))) return false;
    o->room = 2 * nodes;
    return true;
}

/* The nodes of a vertex and their weights, which add up to 1; their number, 0 where no node around has mass. */
static int stencil_of(const mpm_body *body, const double x[2], uint32_t dof[NODES], double weight[NODES]) {
    const double cell[2] = {floor(x[0] * body->inverse_h), floor(x[1] * body->inverse_h)};
    const double s = x[0] * body->inverse_h - cell[0], t = x[1] * body->inverse_h - cell[1];
    const double hat[NODES] = {(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t};
    int count = 0;
    double sum = 0.0;
    for (int n = 0; n < NODES; ++n) {
        const int32_t i = (int32_t)cell[0] + n % 2, j = (int32_t)cell[1] + n / 2;
        const int32_t tx = (i - (i & (AB_TILE - 1))) / AB_TILE, ty = (j - (j & (AB_TILE - 1))) / AB_TILE;
        const long tile = mpm_tile_find(body->keys, body->tile_count, ab_tile_key(tx, ty));
        if (tile < 0) continue;
        const uint32_t k = (uint32_t)tile * AB_TILE_NODES + (uint32_t)((j & (AB_TILE - 1)) * AB_TILE + (i & (AB_TILE - 1)));
        const double mass = body->own[(size_t)k * OWN_RECORD + OWN_MASS];
        const double w = hat[n] * fmin(mass / (FULL * body->point_mass), 1.0);
        if (!(w > 0.0)) continue;
        dof[count] = k;
        weight[count++] = w;
        sum += w;
    }
    for (int n = 0; n < count; ++n) weight[n] /= sum;
    return count;
}

static ab_status lost(const mpm_body *body, const double x[2], ab_report *report) {
    return ab_report_failure(report,
                             "body '%s': its outline has lost its points near (%.6g, %.6g) m; faces of material points need a body that "
                             "stays in one piece: use a smaller dt, or an algorithm that needs no faces (multi-velocity)",
                             body->domain.spec->name, x[0] + body->origin[0], x[1] + body->origin[1]);
}

/* Adds up how far the points of a vertex went in this step, m; returns how many are left. */
static int moved_by(const mpm_body *body, const uint32_t id[2], double by[2]) {
    int found = 0;
    for (int e = 0; e < (id[1] == id[0] ? 1 : 2); ++e) {
        const uint32_t slot = body->slot[id[e]];
        if (slot == UINT32_MAX) continue;
        const double *point = mpm_block(body, slot / 8) + slot % 8;
        for (int c = 0; c < 2; ++c) by[c] += point[8 * (ROW_NEXT + c)] - point[8 * (ROW_X + c)];
        ++found;
    }
    return found;
}

ab_status mpm_outline_move(mpm_body *body, const ab_step *step, ab_report *report) {
    struct mpm_outline *o = body->outline;
    if (!o || o->touching) return AB_OK;
    mpm_loops *loops = &o->loops;
    for (size_t k = 0; k < loops->count; ++k) {
        uint32_t dof[NODES];
        double weight[NODES], v[2] = {0.0, 0.0};
        const int count = stencil_of(body, loops->x + 2 * k, dof, weight);
        if (count == 0) return lost(body, loops->x + 2 * k, report);
        for (int n = 0; n < count; ++n)
            for (size_t c = 0; c < 2; ++c) v[c] += weight[n] * body->own[(size_t)dof[n] * OWN_RECORD + OWN_VELOCITY + c];
        double by[2] = {0.0, 0.0};
        const int points = moved_by(body, loops->point + 2 * k, by);
        for (size_t c = 0; c < 2; ++c) {
            loops->x[2 * k + c] += step->dt * v[c];
            loops->slip[2 * k + c] = points ? step->dt * v[c] - by[c] / points : 0.0;
        }
    }
    return mpm_loops_even(loops, SHORTEST * body->h, LONGEST * body->h, body->domain.spec->name, report);
}

/* Displacement gradient of the step at a point, H_ij = dt dv_i/dx_j, from the velocities that the nodes have now. */
static void gradient_at(const mpm_body *body, uint32_t slot, double dt, double gradient[2][2]) {
    const mpm_tile *tile = body->tiles + mpm_tile_of_block(body, slot / 8);
    const int l = (int)(slot % 8), nodes = body->kernel->nodes;
    mpm_stencils w;
    body->kernel->stencils(body, tile, mpm_block(body, slot / 8), &w);
    for (int c = 0; c < 2; ++c) gradient[c][0] = gradient[c][1] = 0.0;
    for (int j = 0; j < nodes; ++j)
        for (int i = 0; i < nodes; ++i) {
            const double *own = body->own + (size_t)mpm_dof_of(body, tile, w.node[l] + j * body->kernel->patch + i) * OWN_RECORD;
            const double gx = dt * w.gx[j * nodes + i][l], gy = dt * w.gy[j * nodes + i][l];
            for (int c = 0; c < 2; ++c) {
                gradient[c][0] += gx * own[OWN_VELOCITY + c];
                gradient[c][1] += gy * own[OWN_VELOCITY + c];
            }
        }
}

/* Stretches the arm from a point to a vertex. Adds its end to end[2], how far that went beyond the point to turned[2] and the size of the gradient to *size; false where
 * the point has left through a side of the grid. */
static bool follow_point(const mpm_body *body, uint32_t id, double dt, double arm[2], double end[2], double turned[2], double *size) {
    const uint32_t slot = body->slot[id];
    if (slot == UINT32_MAX) return false;
    double g[2][2];
    gradient_at(body, slot, dt, g);
    const double old[2] = {arm[0], arm[1]}, *point = mpm_block(body, slot / 8) + slot % 8;
    double square = 0.0;
    for (int c = 0; c < 2; ++c) {
        const double change = g[c][0] * old[0] + g[c][1] * old[1];
        arm[c] += change;
        turned[c] += change;
        end[c] += point[8 * (ROW_NEXT + c)] + arm[c];
        square += g[c][0] * g[c][0] + g[c][1] * g[c][1];
    }
    *size += sqrt(square);
    return true;
}

void mpm_outline_follow(mpm_body *body, const ab_step *step) {
    if (!body->outline || body->outline->touching) return;
    mpm_loops *loops = &body->outline->loops;
    for (size_t k = 0; k < loops->count; ++k) {
        const uint32_t *id = loops->point + 2 * k;
        double *arm = loops->arm + 4 * k, *x = loops->x + 2 * k, end[2] = {0.0, 0.0}, turned[2] = {0.0, 0.0}, size = 0.0;
        int found = follow_point(body, id[0], step->dt, arm, end, turned, &size);
        if (id[1] == id[0])
            arm[2] = arm[0], arm[3] = arm[1];
        else
            found += follow_point(body, id[1], step->dt, arm + 2, end, turned, &size);
        if (!found) continue;
        const double *slip = loops->slip + 2 * k,
                     beyond = hypot(slip[0] - turned[0] / found, slip[1] - turned[1] / found) * body->inverse_h;
        const double share = fmin(DRAWN * size / found + HELD * beyond, 1.0);
        for (int c = 0; c < 2; ++c) x[c] += share * (end[c] / found - x[c]);
    }
}

ab_status mpm_faces(ab_domain *domain, ab_surface *surface, ab_report *report) {
    mpm_body *body = (mpm_body *)domain;
    struct mpm_outline *o = body->outline;
    surface->vertex_count = surface->face_count = 0;
    if (!o) return AB_OK;
    const mpm_loops *loops = &o->loops;
    if (!reserve(o)) return ab_report_failure(report, "body '%s': no memory for %zu faces", domain->spec->name, loops->count);
    const size_t most = MPM_LIGHT_MORE + (o->touching ? mpm_touching_most_nodes() : NODES);
    if (o->touching && !mpm_touching_place(body, true)) return lost(body, loops->x, report);
    o->start[0] = 0;
    for (size_t k = 0; k < loops->count; ++k) {
        const double *x = loops->x + 2 * k;
        const size_t at = o->start[k];
        if (!reserve_stencil(o, at + most))
            return ab_report_failure(report, "body '%s': no memory for %zu faces", domain->spec->name, loops->count);
        size_t count = o->touching ? mpm_touching_stencil(body, k, o->dof + at, o->weight + at)
                                   : (size_t)stencil_of(body, x, o->dof + at, o->weight + at);
        count = mpm_light_expand(body, o->dof + at, o->weight + at, count);
        if (count == 0) return lost(body, x, report);
        o->start[k + 1] = at + count;
        o->position[k] = x[0];
        o->position[o->ld + k] = x[1];
        o->vertex[3 * k] = (uint32_t)k;
        o->vertex[3 * k + 1] = loops->next[k];
        o->vertex[3 * k + 2] = UINT32_MAX;
        o->beside[2 * k] = loops->prior[k]; /* face k begins at vertex k */
        o->beside[2 * k + 1] = loops->next[k];
    }
    surface->vertex_count = surface->face_count = loops->count;
    surface->vertex_ld = o->ld;
    surface->vertex_position = o->position;
    surface->vertex_start = o->start;
    surface->vertex_dof = o->dof;
    surface->vertex_weight = o->weight;
    surface->face_vertex = o->vertex;
    surface->face_beside = o->beside;
    return AB_OK;
}
