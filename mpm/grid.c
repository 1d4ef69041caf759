/* grid.c: what happens on the nodes: adding up the patches, trial velocities, sides, and handing velocities to the passes over points. */
#include <math.h>
#include <string.h>

#include "mpm/share.h"

/* sum[node*lanes + c]: what the nine patches around hold of this tile's own nodes. A patch reaches one node before and size - 1 - AB_TILE nodes behind its tile. The
 * tile's own patch first, then its neighbours', always in one order. */
static inline __attribute__((always_inline)) void add_some(const mpm_body *body, const mpm_tile *tile, int lanes, const int size,
                                                           double *sum) {
    const size_t doubles = 8 * (size_t)(size * size);
    if (tile->patch >= 0) {
        const double *patch = body->patches + (size_t)tile->patch * doubles;
        for (int j = 0; j < AB_TILE; ++j)
            memcpy(sum + lanes * j * AB_TILE, patch + lanes * ((j + 1) * size + 1), sizeof(double) * (size_t)(lanes * AB_TILE));
    } else
        memset(sum, 0, sizeof(double) * (size_t)lanes * AB_TILE_NODES);
    for (int s = 0; s < 9; ++s) {
        if (s == 4 || tile->around[s] < 0) continue;
        const mpm_tile *from = body->tiles + tile->around[s];
        if (from->patch < 0) continue;
        const int dx = s % 3 - 1, dy = s / 3 - 1;
        const int i0 = dx > 0 ? AB_TILE - 1 : 0, i1 = dx < 0 ? size - 1 - AB_TILE : AB_TILE;
        const int j0 = dy > 0 ? AB_TILE - 1 : 0, j1 = dy < 0 ? size - 1 - AB_TILE : AB_TILE;
        const double *patch = body->patches + (size_t)from->patch * doubles;
        for (int j = j0; j < j1; ++j) {
            const double *row = patch + lanes * ((j - dy * AB_TILE + 1) * size + i0 - dx * AB_TILE + 1);
            double *own = sum + lanes * (j * AB_TILE + i0);
            if (lanes == 8)
                for (int i = 0; i < i1 - i0; ++i) v8_store(own + 8 * i, v8_load(own + 8 * i) + v8_load(row + 8 * i));
            else
                for (int i = 0; i < i1 - i0; ++i) v2_store(own + 2 * i, v2_load(own + 2 * i) + v2_load(row + 2 * i));
        }
    }
}
static inline __attribute__((always_inline)) void add_patches(const mpm_body *body, const mpm_tile *tile, int lanes, double *sum) {
    if (body->kernel->patch == MPM_PATCH_NARROW)
        add_some(body, tile, lanes, MPM_PATCH_NARROW, sum);
    else
        add_some(body, tile, lanes, MPM_PATCH_WIDE, sum);
}

/* 1 where the sides leave the direction of this node free, 0 where they hold it. Nodes beyond a side are held like those on it. */
static void side_mask(const mpm_body *body, const mpm_tile *tile, int n, double free_[2]) {
    const ab_scene *scene = body->scene;
    const int i = tile->tx * AB_TILE + n % AB_TILE, j = tile->ty * AB_TILE + n / AB_TILE;
    const bool at[AB_SIDES] = {i <= 0, i >= scene->grid_cells[0], j <= 0, j >= scene->grid_cells[1]};
    free_[0] = free_[1] = 1.0;
    for (int s = 0; s < AB_SIDES; ++s) {
        if (!at[s]) continue;
        if (body->side[s] == AB_SIDE_FIXED) free_[0] = free_[1] = 0.0;
        if (body->side[s] == AB_SIDE_ROLLER) free_[s / 2] = 0.0;
    }
}

typedef struct trial { /* what makes trial velocities */
    double g[2], dt;
} trial;

static void assemble_tile(mpm_body *body, size_t k, void *context) {
    const trial *t = context;
    const mpm_tile *tile = body->tiles + k;
    const bool hoops = body->axisymmetric;
    double sum[8 * AB_TILE_NODES] __attribute__((aligned(64)));
    add_patches(body, tile, 8, sum);
    double *own = body->own + k * OWN_RECORD * AB_TILE_NODES;
    mpm_light_tile light = {0};
    for (int n = 0; n < AB_TILE_NODES; ++n, own += OWN_RECORD) {
        const double *s = sum + 8 * n;
        const double mass = s[NODE_MASS];
        if (!(mass > 1e-300)) {
            *(v8 *)own = v8_set(0.0);
            continue;
        }
        light.nodes |= (uint64_t)(mass < body->light_limit) << n;
        light.most = fmax(light.most, mass);
        const double inverse = 1.0 / mass;
        double free_[2] = {1.0, 1.0};
        if (tile->held) side_mask(body, tile, n, free_);
        for (int c = 0; c < 2; ++c) {
            const double old = s[NODE_MOMENTUM + c] * inverse * free_[c];
            double force = s[NODE_FORCE_X + c] + s[NODE_FORCE_Y + c] + mass * t->g[c];
            if (hoops && c == 0) force += s[NODE_HOOP];
            own[OWN_OLD + c] = old;
            own[OWN_VELOCITY + c] = (old + force * inverse * t->dt) * free_[c];
            own[OWN_INVERSE + c] = inverse * free_[c];
        }
        own[OWN_MASS] = mass;
    }
    if (body->light) body->light[k] = light;
}

void mpm_grid_assemble(mpm_body *body, const ab_step *step, bool forces) {
    trial t = {.g = {body->gravity ? step->gravity[0] : 0.0, body->gravity ? step->gravity[1] : 0.0},
               .dt = forces ? step->from_rest ? 0.5 * step->dt : step->dt : 0.0};
    mpm_each_tile(body, assemble_tile, &t);
}

static void assemble_remap_tile(mpm_body *body, size_t k, void *unused) {
    (void)unused;
    double sum[2 * AB_TILE_NODES] __attribute__((aligned(64)));
    add_patches(body, body->tiles + k, 2, sum);
    double *own = body->own + k * OWN_RECORD * AB_TILE_NODES;
    for (int n = 0; n < AB_TILE_NODES; ++n, own += OWN_RECORD) {
        own[OWN_VELOCITY] = sum[2 * n] * own[OWN_INVERSE];
        own[OWN_VELOCITY + 1] = sum[2 * n + 1] * own[OWN_INVERSE + 1];
    }
}

void mpm_grid_assemble_remap(mpm_body *body) { mpm_each_tile(body, assemble_remap_tile, NULL); }

/* Lays what `lanes` numbers per node are in the nine tiles around into a patch; nodes of tiles that are not there are 0. A record of `record` doubles per node;
 * two lanes: the first two of it; four: of the nodes' own records, the velocity and its change. */
static inline __attribute__((always_inline)) void fetch_some(const mpm_body *body, size_t number, const double *records, size_t record,
                                                             int lanes, const int size, double *patch) {
    const mpm_tile *tile = body->tiles + number;
    for (int s = 0; s < 9; ++s) {
        const int dx = s % 3 - 1, dy = s / 3 - 1;
        const int i0 = dx < 0 ? AB_TILE - 1 : 0, i1 = dx > 0 ? size - 1 - AB_TILE : AB_TILE;
        const int j0 = dy < 0 ? AB_TILE - 1 : 0, j1 = dy > 0 ? size - 1 - AB_TILE : AB_TILE;
        for (int j = j0; j < j1; ++j) {
            double *to = patch + lanes * ((j + dy * AB_TILE + 1) * size + i0 + dx * AB_TILE + 1);
            if (tile->around[s] < 0) {
                memset(to, 0, sizeof(double) * (size_t)(lanes * (i1 - i0)));
                continue;
            }
            const double *own = records + ((size_t)tile->around[s] * AB_TILE_NODES + (size_t)(j * AB_TILE + i0)) * record;
            for (int i = 0; i < i1 - i0; ++i, own += record) {
                const v2 now = v2_load(own);
                v2_store(to + lanes * i, now);
                if (lanes == 4) v2_store(to + lanes * i + 2, now - v2_load(own - OWN_VELOCITY + OWN_OLD));
            }
        }
    }
    memset(patch + lanes * size * size, 0, 8 * sizeof(double)); /* a row of four nodes may look past the last three */
}

static inline __attribute__((always_inline)) void fetch(const mpm_body *body, size_t number, const double *records, size_t record,
                                                        int lanes, double *patch) {
    if (body->kernel->patch == MPM_PATCH_NARROW)
        fetch_some(body, number, records, record, lanes, MPM_PATCH_NARROW, patch);
    else
        fetch_some(body, number, records, record, lanes, MPM_PATCH_WIDE, patch);
}

void mpm_grid_fetch_velocity(const mpm_body *body, size_t number, double *pairs) {
    fetch(body, number, body->own + OWN_VELOCITY, OWN_RECORD, 2, pairs);
}
void mpm_grid_fetch_motion(const mpm_body *body, size_t number, double *quadruples) {
    fetch(body, number, body->own + OWN_VELOCITY, OWN_RECORD, 4, quadruples);
}
void mpm_grid_fetch_filter(const mpm_body *body, size_t number, int from, double *pairs) {
    fetch(body, number, body->filter + from, FILTER_RECORD, 2, pairs);
}

void mpm_grid_fetch_volumetric(const mpm_body *body, size_t number, int from, double *pairs) {
    fetch(body, number, body->volumetric + from, VOLUMETRIC_RECORD, 2, pairs);
}

void mpm_grid_add_pairs(const mpm_body *body, size_t number, double *sum) { add_patches(body, body->tiles + number, 2, sum); }

void mpm_grid_filter_start(mpm_body *body) {
    const int from = body->full ? OWN_VELOCITY : OWN_OLD;
    for (size_t n = 0; n < body->tile_count * AB_TILE_NODES; ++n) {
        const v2 whole = v2_load(body->own + n * OWN_RECORD + from);
        v2_store(body->filter + n * FILTER_RECORD + FILTER_REST, whole);
        v2_store(body->filter + n * FILTER_RECORD + FILTER_SUM, whole - whole);
    }
}

void mpm_grid_filter_assemble(mpm_body *body) {
#pragma omp parallel for schedule(dynamic, 4) num_threads(body->threads)
    for (size_t k = 0; k < body->tile_count; ++k) {
        double back[2 * AB_TILE_NODES] __attribute__((aligned(64)));
        add_patches(body, body->tiles + k, 2, back);
        const double *own = body->own + k * OWN_RECORD * AB_TILE_NODES;
        double *filter = body->filter + k * FILTER_RECORD * AB_TILE_NODES;
        if (body->tie_count) {
            double *raw = body->back + k * 2 * AB_TILE_NODES;
            for (int n = 0; n < AB_TILE_NODES; ++n, own += OWN_RECORD)
                for (int c = 0; c < 2; ++c) raw[2 * n + c] = own[OWN_INVERSE + c] > 0.0 ? back[2 * n + c] / own[OWN_MASS] : 0.0;
            continue;
        }
        for (int n = 0; n < AB_TILE_NODES; ++n, own += OWN_RECORD, filter += FILTER_RECORD)
            for (int c = 0; c < 2; ++c) {
                filter[FILTER_REST + c] -= back[2 * n + c] * own[OWN_INVERSE + c];
                filter[FILTER_SUM + c] += filter[FILTER_REST + c];
            }
    }
    if (!body->tie_count) return;
    mpm_light_filter(body, body->back);
    for (size_t n = 0; n < body->tile_count * AB_TILE_NODES; ++n) {
        double *filter = body->filter + n * FILTER_RECORD;
        for (size_t c = 0; c < 2; ++c) {
            filter[FILTER_REST + c] -= body->back[2 * n + c];
            filter[FILTER_SUM + c] += filter[FILTER_REST + c];
        }
    }
}

static const double LIGHT = 1e-4; /* of a point's mass: a node with less is light */

/* A node with less than LIGHT of a point's mass is accelerated without bound by a finite stress; its momentum has gone to the points already, so the
 * strain may take the velocity it had before. Only USL asks for it: USF and MUSL strain with momentum over mass, an average that is bounded. */
void mpm_grid_limit_light(mpm_body *body) {
    const double limit = LIGHT * body->point_mass;
    for (size_t n = 0; n < body->tile_count * AB_TILE_NODES; ++n) {
        double *own = body->own + n * OWN_RECORD;
        if (own[OWN_MASS] > 0.0 && own[OWN_MASS] < limit)
            for (int c = 0; c < 2; ++c) own[OWN_VELOCITY + c] = own[OWN_OLD + c];
    }
}
