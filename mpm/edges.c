/* edges.c: pieces of a body's outline that boundary plugins act on: where they are, which nodes they hang on, how they follow the material.
 *
 * An edge hangs on the nodes that a load there pulls at (mpm_kernel.carry), and its velocity is what those nodes move with, by the same weights. A traction then does
 * the same work at the nodes as at the edge, and stands where the internal force of a stress at the face stands: dashpots at the points themselves would leave a
 * layer beyond them that throws back a part (w d/c) of a wave of frequency w, d their distance from the face. A linear basis, whose loads act at its points, has its edges on
 * the hats of the points' cells for that reason. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/checkpoint.h"
#include "mpm/body.h"

enum { ROWS = AB_EDGE_ROWS + 2 }; /* and the own traction */
enum { MOST_OF_TIE = sizeof((mpm_tie *)0)->weight / sizeof(double) }; /* dofs of one node */

struct mpm_edges {
    size_t boundary; /* of the scene */
    mpm_load *pieces;
    size_t pieces_count, group; /* edges of a piece: 1, or as many as its stencil has nodes */
    bool hold;
    size_t count, ld, room;
    double *rows; /* ROWS x ld */
    size_t *start;
    uint32_t *dof; /* room of them */
    double *weight, *answer;
};

/* Of a point's mass: a node with less follows its neighbours. A point's stress is one number over its domain; what of it hangs over onto a node that only a sliver of the
 * domain reaches accelerates that node by half the domain over the sliver's width too much. */
static const double FULL = 0.5;

static ab_status no_memory(const mpm_body *body, size_t count, ab_report *report) {
    return ab_report_failure(report, "body '%s': no memory for %zu edges under boundaries", body->domain.spec->name, count);
}

static ab_status create_one(mpm_body *body, const ab_fill *fill, size_t boundary, ab_report *report) {
    const ab_boundary_spec *spec = body->scene->boundaries + boundary;
    size_t count = 0;
    for (size_t s = 0; s < fill->surface_count; ++s) count += ab_where_holds(&spec->where, fill, fill->surface + s);
    if (count == 0)
        return ab_report_error(
            report, spec->mark,
            "boundaries[%zu] meets no part of the outline of '%s'; use side: left|right|top|bottom or a place on its outline", boundary,
            body->domain.spec->name);
    struct mpm_edges *e = body->edges + body->edges_count++;
    const size_t group = spec->nodes ? (size_t)(body->kernel->nodes * body->kernel->nodes) : 1, pieces = count;
    count *= group;
    *e = (struct mpm_edges){.boundary = boundary, .group = group, .hold = spec->hold, .count = count, .ld = (count + 7) / 8 * 8};
    e->room = count * (spec->nodes ? MOST_OF_TIE : MPM_STENCIL + MPM_LIGHT_MORE);
    e->pieces = malloc(pieces * sizeof *e->pieces);
    e->rows = calloc(ROWS * e->ld, sizeof *e->rows);
    e->start = calloc(count + 1, sizeof *e->start);
    e->dof = malloc(e->room * sizeof *e->dof);
    e->weight = malloc(e->room * sizeof *e->weight);
    e->answer = malloc(e->room * sizeof *e->answer);
    if (!e->pieces || !e->rows || !e->start || !e->dof || !e->weight || !e->answer || !mpm_points_index(body) ||
        !mpm_load_pieces(fill, &spec->where, true, (uint32_t)boundary, e->pieces, &e->pieces_count))
        return no_memory(body, count, report);
    const double density = body->material->density;
    for (size_t k = 0; k < e->ld; ++k) {
        e->rows[6 * e->ld + k] = sqrt(body->modulus / density);
        e->rows[7 * e->ld + k] = sqrt(body->shear_modulus / density);
    }
    return AB_OK;
}

ab_status mpm_edges_create(mpm_body *body, const ab_fill *fill, ab_report *report) {
    const ab_scene *scene = body->scene;
    size_t count = 0;
    for (size_t k = 0; k < scene->boundary_count; ++k) count += scene->boundaries[k].body == body->domain.index;
    if (count == 0) return AB_OK;
    body->edges = calloc(count, sizeof *body->edges);
    if (!body->edges) return no_memory(body, count, report);
    for (size_t k = 0; k < scene->boundary_count; ++k)
        if (scene->boundaries[k].body == body->domain.index) AB_TRY(create_one(body, fill, k, report));
    return AB_OK;
}

/* Hats of the cell of the point under an edge where the edge is, or at the nearest place of the cell. */
static void hats(const mpm_body *body, const mpm_load *piece, mpm_reach *r) {
    const uint32_t slot = body->slot[piece->id];
    int32_t node[2][8];
    body->kernel->first(body, mpm_block(body, slot / 8), ROW_X, node);
    double s[2];
    for (int c = 0; c < 2; ++c) s[c] = fmin(fmax(piece->now[c] * body->inverse_h - node[c][slot % 8], 0.0), 1.0);
    for (int k = 0; k < 4; ++k) r->n[k] = (k % 2 ? s[0] : 1.0 - s[0]) * (k / 2 ? s[1] : 1.0 - s[1]);
}

/* Nodes of an edge and their weights, which add up to 1; light ones among them. */
static size_t nodes_of(const mpm_body *body, const mpm_load *piece, uint32_t *dof, double *weight) {
    mpm_reach r = mpm_load_reach(body, piece);
    if (!body->kernel->carry) hats(body, piece, &r);
    size_t count = 0;
    double sum = 0.0;
    for (int i = 0; i < r.count; ++i) {
        const uint32_t k = mpm_dof_of(body, r.tile, (int)r.node[i]);
        if (r.n[i] == 0.0 || !(body->own[(size_t)k * OWN_RECORD + OWN_MASS] > 0.0)) continue;
        dof[count] = k;
        weight[count++] = r.n[i];
        sum += r.n[i];
    }
    for (size_t i = 0; i < count; ++i) weight[i] /= sum;
    return count;
}

/* Dofs of an edge and their weights, which add up to 1: of a light node those that it goes by. */
static size_t stencil_of(const mpm_body *body, const mpm_load *piece, uint32_t *dof, double *weight) {
    return mpm_light_expand(body, dof, weight, nodes_of(body, piece, dof, weight));
}

/* Weights for changes of velocity: those of nodes that hardly carry mass go to the others. */
static void answers(const mpm_body *body, const uint32_t *dof, const double *weight, size_t count, double *answer) {
    double sum = 0.0;
    for (size_t i = 0; i < count; ++i) {
        answer[i] = weight[i] * fmin(body->own[(size_t)dof[i] * OWN_RECORD + OWN_MASS] / (FULL * body->point_mass), 1.0);
        sum += answer[i];
    }
    for (size_t i = 0; i < count; ++i) answer[i] = sum > 0.0 ? answer[i] / sum : weight[i];
}

/* Pa: stress of the point under a piece . normal. Between the point and the face the weight of what lies there is added, along the normal. */
static void own_traction(const mpm_body *body, const mpm_load *piece, const double n[2], double density, const double gravity[2],
                         double t[2]) {
    const uint32_t slot = body->slot[piece->id];
    const double *point = mpm_block(body, slot / 8) + slot % 8, *stress = point + 8 * ROW_STRESS;
    const double away = (piece->now[0] - point[8 * ROW_X]) * n[0] + (piece->now[1] - point[8 * (ROW_X + 1)]) * n[1];
    const double weight = body->gravity ? -density * (gravity[0] * n[0] + gravity[1] * n[1]) * away : 0.0;
    t[0] = stress[0] * n[0] + stress[24] * n[1] + weight * n[0];
    t[1] = stress[24] * n[0] + stress[8] * n[1] + weight * n[1];
}

/* Each node of a piece's stencil by itself, with its share of the area. A light one moves with those that it goes by, and hands them what it gets. */
static void share_out(const mpm_body *body, struct mpm_edges *e, size_t piece, double area) {
    uint32_t node[MPM_STENCIL];
    double share[MPM_STENCIL];
    const size_t count = nodes_of(body, e->pieces + piece, node, share);
    for (size_t g = 0; g < e->group; ++g) {
        const size_t k = piece * e->group + g, at = e->start[k];
        const bool there = g < count && share[g] > 0.0;
        e->rows[4 * e->ld + k] = there ? share[g] * area : 0.0;
        e->start[k + 1] = at;
        if (!there) continue;
        e->dof[at] = node[g], e->weight[at] = 1.0;
        e->start[k + 1] += mpm_light_expand(body, e->dof + at, e->weight + at, 1);
        memcpy(e->answer + at, e->weight + at, (e->start[k + 1] - at) * sizeof *e->answer);
    }
}

ab_status mpm_edges(ab_domain *domain, size_t boundary, const ab_step *step, ab_edge_list *list, ab_report *report) {
    (void)report;
    mpm_body *body = (mpm_body *)domain;
    struct mpm_edges *e = body->edges;
    while (e->boundary != boundary) ++e;
    const size_t ld = e->ld;
    double *x = e->rows, *normal = x + 2 * ld, *area = x + 4 * ld, *density = x + 5 * ld, *traction = x + 8 * ld;
    for (size_t p = 0; p < e->pieces_count; ++p) {
        mpm_load *piece = e->pieces + p;
        const size_t first = p * e->group, at = e->start[first];
        const uint32_t slot = body->slot[piece->id];
        for (size_t k = first; k < first + e->group; ++k) e->start[k + 1] = at, area[k] = 0.0;
        if (slot == UINT32_MAX) continue; /* gone; what is known of it stays */
        mpm_load_place(body, e->pieces, piece);
        const double half = hypot(piece->stretch[0], piece->stretch[1]), *point = mpm_block(body, slot / 8) + slot % 8;
        if (!(half > 0.0)) continue;
        const double n[2] = {piece->stretch[1] / half, -piece->stretch[0] / half}, rho = point[8 * ROW_MASS] / point[8 * ROW_VOLUME],
                     size = 2.0 * half * (body->axisymmetric ? ab_circumference(piece->now[0] + body->origin[0]) : 1.0);
        const double p_speed = sqrt(body->modulus / rho), s_speed = sqrt(body->shear_modulus / rho);
        double t[2] = {0.0, 0.0};
        if (e->hold) own_traction(body, piece, n, rho, step->gravity, t);
        for (size_t k = first; k < first + e->group; ++k) {
            for (size_t c = 0; c < 2; ++c) x[c * ld + k] = piece->now[c], normal[c * ld + k] = n[c], traction[c * ld + k] = t[c];
            density[k] = rho, x[6 * ld + k] = p_speed, x[7 * ld + k] = s_speed;
        }
        if (e->group > 1) {
            share_out(body, e, p, size);
            continue;
        }
        e->start[p + 1] = at + stencil_of(body, piece, e->dof + at, e->weight + at);
        if (e->start[p + 1] == at) continue;
        area[p] = size;
        answers(body, e->dof + at, e->weight + at, e->start[p + 1] - at, e->answer + at);
    }
    *list = ab_edge_list_of(e->rows, e->count, ld);
    list->start = e->start, list->dof = e->dof, list->weight = e->weight;
    list->answer = e->answer, list->own_traction = e->hold ? traction : NULL, list->group = e->group;
    return AB_OK;
}

void mpm_edges_follow(mpm_body *body, const ab_step *step) {
    for (size_t n = 0; n < body->edges_count; ++n)
        for (size_t k = 0; k < body->edges[n].pieces_count; ++k)
            if (body->slot[body->edges[n].pieces[k].id] != UINT32_MAX) mpm_load_follow(body, step, body->edges[n].pieces + k);
}

size_t mpm_edges_bytes(const mpm_body *body) {
    size_t bytes = 0;
    for (size_t n = 0; n < body->edges_count; ++n) {
        const struct mpm_edges *e = body->edges + n;
        bytes += sizeof *e + e->pieces_count * sizeof *e->pieces + e->count * sizeof *e->start + ROWS * e->ld * sizeof *e->rows +
                 e->room * (sizeof *e->dof + 2 * sizeof *e->weight);
    }
    return bytes;
}

/* Arms and halves, as of loads. */
bool mpm_edges_keep(mpm_body *body, ab_checkpoint *c) {
    bool good = true;
    for (size_t n = 0; good && n < body->edges_count; ++n) {
        struct mpm_edges *e = body->edges + n;
        double *shape = malloc(4 * e->pieces_count * sizeof *shape);
        if (!shape) return ab_checkpoint_refuse(c, "no memory for %zu edges", e->pieces_count);
        for (size_t k = 0; k < e->pieces_count; ++k)
            memcpy(shape + 4 * k, e->pieces[k].arm, 2 * sizeof *shape), memcpy(shape + 4 * k + 2, e->pieces[k].half, 2 * sizeof *shape);
        ab_checkpoint_enter(c, "edges_%zu", n);
        good = ab_keep_doubles(c, "pieces", shape, 4 * e->pieces_count);
        ab_checkpoint_leave(c);
        for (size_t k = 0; good && k < e->pieces_count; ++k)
            memcpy(e->pieces[k].arm, shape + 4 * k, 2 * sizeof *shape), memcpy(e->pieces[k].half, shape + 4 * k + 2, 2 * sizeof *shape);
        free(shape);
    }
    return good;
}

void mpm_edges_destroy(mpm_body *body) {
    for (size_t n = 0; n < body->edges_count; ++n) {
        struct mpm_edges *e = body->edges + n;
        free(e->pieces), free(e->rows), free(e->start), free(e->dof), free(e->weight), free(e->answer);
    }
    free(body->edges);
}
