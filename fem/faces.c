/* faces.c: which sides of elements are joined, the outer faces that are left, their chains, and sets of places on them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/mesh_parts.h"

/* ---- sides --------------------------------------------------------------------------------------------------------------------- */

typedef struct side_key {
    uint32_t high, side; /* the larger of its corners; 4*element + side */
} side_key;

static int by_place(const void *a, const void *b) {
    const side_key *p = a, *q = b;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    return p->side < q->side ? -1 : p->side > q->side;
}

/* Lists are of two to four sides, but in a file made to be hostile. */
static void sort_short(side_key *key, size_t count) {
    if (count > 32) {
        qsort(key, count, sizeof *key, by_place);
        return;
    }
    for (size_t k = 1; k < count; k++) {
        const side_key here = key[k];
        size_t at = k;
        for (; at > 0 && by_place(&key[at - 1], &here) > 0; at--) key[at] = key[at - 1];
        key[at] = here;
    }
}

static const uint32_t *element_nodes(const fem_mesh *mesh, uint32_t side) {
    return mesh->connectivity + (size_t)(side / 4) * (size_t)mesh->nodes;
}
static uint32_t first_of(const fem_mesh *mesh, uint32_t side) { return element_nodes(mesh, side)[side % 4]; }
static uint32_t last_of(const fem_mesh *mesh, uint32_t side) { return element_nodes(mesh, side)[(side + 1) % 4]; }
static uint32_t middle_of(const fem_mesh *mesh, uint32_t side) {
    return mesh->nodes == 8 ? element_nodes(mesh, side)[4 + side % 4] : FEM_NONE;
}

/* Sides with the same two corners: one is outside, two are joined, more are wrong. */
static bool join(const fem_mesh *mesh, const side_key *key, size_t count, uint32_t *mate, const char *body, ab_mark mark,
                 ab_report *report) {
    if (count == 1) return true;
    const uint32_t a = key[0].side, b = key[1].side;
    const double *x = mesh->x + 2 * (size_t)first_of(mesh, a), *y = mesh->x + 2 * (size_t)last_of(mesh, a);
    char where[160];
    snprintf(where, sizeof where, "the side from node %llu to node %llu near [%.6g, %.6g]", fem_node_id(mesh, first_of(mesh, a)),
             fem_node_id(mesh, last_of(mesh, a)), 0.5 * (x[0] + y[0]), 0.5 * (x[1] + y[1]));
    if (count > 2) {
        ab_report_error(report, mark, "body '%s': %zu elements share %s (%llu, %llu, %llu%s); two may: remove those that stand twice", body,
                        count, where, fem_element_id(mesh, a / 4), fem_element_id(mesh, b / 4), fem_element_id(mesh, key[2].side / 4),
                        count > 3 ? ", ..." : "");
        return false;
    }
    if (first_of(mesh, a) == first_of(mesh, b)) {
        ab_report_error(report, mark, "body '%s': elements %llu and %llu lie on the same side of %s, so on each other; remove one", body,
                        fem_element_id(mesh, a / 4), fem_element_id(mesh, b / 4), where);
        return false;
    }
    if (middle_of(mesh, a) != middle_of(mesh, b)) {
        ab_report_error(report, mark,
                        "body '%s': elements %llu and %llu share %s but not its middle node (%llu, %llu); join them in the mesher", body,
                        fem_element_id(mesh, a / 4), fem_element_id(mesh, b / 4), where, fem_node_id(mesh, middle_of(mesh, a)),
                        fem_node_id(mesh, middle_of(mesh, b)));
        return false;
    }
    mate[a] = b;
    mate[b] = a;
    return true;
}

/* Sides listed under the smaller of their corners, by counting; then each short list is sorted. */
ab_status fem_sides_join(const fem_mesh *mesh, const char *body, ab_mark mark, uint32_t **result, ab_report *report) {
    const size_t sides = 4 * mesh->element_count;
    uint32_t *mate = malloc((sides + 1) * sizeof *mate), *start = calloc(mesh->node_count + 2, sizeof *start);
    side_key *key = malloc((sides + 1) * sizeof *key);
    *result = NULL;
    if (mate == NULL || start == NULL || key == NULL) {
        free(mate), free(start), free(key);
        return ab_report_failure(report, "no memory for the sides of %zu elements of body '%s'", mesh->element_count, body);
    }
    for (uint32_t s = 0; s < sides; s++) {
        const uint32_t a = first_of(mesh, s), b = last_of(mesh, s);
        start[(a < b ? a : b) + 2]++;
        mate[s] = FEM_NONE;
    }
    for (size_t i = 2; i < mesh->node_count + 2; i++) start[i] += start[i - 1];
    for (uint32_t s = 0; s < sides; s++) {
        const uint32_t a = first_of(mesh, s), b = last_of(mesh, s);
        key[start[(a < b ? a : b) + 1]++] = (side_key){a < b ? b : a, s};
    }
    size_t wrong = 0;
    for (size_t i = 0; i < mesh->node_count && wrong < FEM_MOST_SAID; i++) {
        const size_t from = start[i], to = start[i + 1];
        sort_short(key + from, to - from);
        for (size_t k = from, next; k < to && wrong < FEM_MOST_SAID; k = next) {
            for (next = k + 1; next < to && key[next].high == key[k].high;) next++;
            if (!join(mesh, key + k, next - k, mate, body, mark, report)) wrong++;
        }
    }
    free(start);
    free(key);
    if (wrong > 0) {
        free(mate);
        return AB_BAD_INPUT;
    }
    *result = mate;
    return AB_OK;
}

/* ---- faces --------------------------------------------------------------------------------------------------------------------- */

void fem_faces_destroy(fem_faces *faces) {
    if (faces == NULL) return;
    free(faces->vertex);
    free(faces->beside);
    free(faces->element);
    free(faces->side);
    free(faces->node);
    free(faces->start);
    free(faces->face);
    free(faces);
}

/* The outer side that begins where an outer side ends, found by turning about that node through the elements joined there. */
static uint32_t next_outside(const uint32_t *mate, uint32_t side) {
    for (;;) {
        side = side - side % 4 + (side + 1) % 4;
        if (mate[side] == FEM_NONE) return side;
        side = mate[side];
    }
}

static void fill_faces(const fem_mesh *mesh, const uint32_t *mate, uint32_t *face_of, fem_faces *faces) {
    uint32_t f = 0;
    for (uint32_t s = 0; s < 4 * mesh->element_count; s++) {
        if (mate[s] != FEM_NONE) continue;
        faces->vertex[3 * (size_t)f] = first_of(mesh, s);
        faces->vertex[3 * (size_t)f + 1] = last_of(mesh, s);
        faces->vertex[3 * (size_t)f + 2] = middle_of(mesh, s);
        faces->element[f] = s / 4;
        faces->side[f] = (uint8_t)(s % 4);
        face_of[s] = f++;
    }
    for (f = 0; f < faces->count; f++) {
        const uint32_t next = face_of[next_outside(mate, 4 * faces->element[f] + faces->side[f])];
        faces->beside[2 * (size_t)f + 1] = next;
        faces->beside[2 * (size_t)next] = f;
    }
}

/* The nodes on faces, and the faces of each. place: of every node of the mesh, zeroed. */
static void fill_nodes(const fem_mesh *mesh, uint32_t *place, fem_faces *faces) {
    for (size_t k = 0; k < 3 * faces->count; k++)
        if (faces->vertex[k] != FEM_NONE) place[faces->vertex[k]]++;
    uint32_t n = 0, sum = 0;
    for (size_t i = 0; i < mesh->node_count; i++) {
        if (place[i] == 0) continue;
        faces->node[n] = (uint32_t)i;
        faces->start[n] = sum;
        sum += place[i];
        place[i] = faces->start[n++];
    }
    faces->node_count = n;
    faces->start[n] = sum;
    for (size_t k = 0; k < 3 * faces->count; k++)
        if (faces->vertex[k] != FEM_NONE) faces->face[place[faces->vertex[k]]++] = (uint32_t)(k / 3);
}

ab_status fem_faces_create(const fem_mesh *mesh, const char *body, fem_faces **result, ab_report *report) {
    uint32_t *mate = NULL;
    *result = NULL;
    AB_TRY(fem_sides_join(mesh, body, AB_NOWHERE, &mate, report));
    size_t count = 0;
    for (size_t s = 0; s < 4 * mesh->element_count; s++) count += mate[s] == FEM_NONE;
    fem_faces *faces = calloc(1, sizeof *faces);
    const size_t most = 4 * mesh->element_count > mesh->node_count ? 4 * mesh->element_count : mesh->node_count;
    uint32_t *spare = malloc((most + 1) * sizeof *spare);
    bool good = faces != NULL && spare != NULL;
    if (good) {
        faces->count = count;
        faces->vertex = malloc((3 * count + 1) * sizeof *faces->vertex);
        faces->beside = malloc((2 * count + 1) * sizeof *faces->beside);
        faces->element = malloc((count + 1) * sizeof *faces->element);
        faces->side = malloc((count + 1) * sizeof *faces->side);
        faces->node = malloc((3 * count + 1) * sizeof *faces->node);
        faces->start = malloc((3 * count + 1) * sizeof *faces->start);
        faces->face = malloc((3 * count + 1) * sizeof *faces->face);
        good = faces->vertex && faces->beside && faces->element && faces->side && faces->node && faces->start && faces->face;
    }
    if (good) {
        fill_faces(mesh, mate, spare, faces);
        memset(spare, 0, mesh->node_count * sizeof *spare);
        fill_nodes(mesh, spare, faces);
        *result = faces;
    } else {
        fem_faces_destroy(faces);
    }
    free(mate);
    free(spare);
    return good ? AB_OK : ab_report_failure(report, "no memory for %zu outer faces of body '%s'", count, body);
}

/* ---- where --------------------------------------------------------------------------------------------------------------------- */

static bool in_range(const ab_where *where, const fem_mesh *mesh, uint32_t node) {
    const double slack = 1e-9 * fmax(mesh->high[0] - mesh->low[0], mesh->high[1] - mesh->low[1]);
    for (int d = 0; d < 2; d++) {
        const double x = mesh->x[2 * (size_t)node + (size_t)d];
        if (where->has[d] && (x < where->range[d][0] - slack || x > where->range[d][1] + slack)) return false;
    }
    return true;
}

static bool faces_that_way(const fem_mesh *mesh, const fem_faces *faces, size_t face, int side) {
    const double *a = mesh->x + 2 * (size_t)faces->vertex[3 * face], *b = mesh->x + 2 * (size_t)faces->vertex[3 * face + 1];
    const double normal[2] = {b[1] - a[1], a[0] - b[0]}; /* outwards, the length of the chord */
    const double along = (side % 2 == 0 ? -1 : 1) * normal[side / 2], across = fabs(normal[1 - side / 2]);
    return along > across * (1 + 1e-9);
}

bool fem_where_face(const ab_where *where, const fem_mesh *mesh, const fem_faces *faces, size_t face) {
    if (where->all) return true;
    if (where->side >= 0 && !faces_that_way(mesh, faces, face, where->side)) return false;
    return in_range(where, mesh, faces->vertex[3 * face]) && in_range(where, mesh, faces->vertex[3 * face + 1]);
}

bool fem_where_node(const ab_where *where, const fem_mesh *mesh, const fem_faces *faces, uint32_t node) {
    if (where->all) return true;
    if (!in_range(where, mesh, node)) return false;
    if (where->side < 0) return true;
    size_t low = 0, high = faces->node_count;
    while (low < high) { /* first of them not below it */
        const size_t middle = low + (high - low) / 2;
        if (faces->node[middle] < node)
            low = middle + 1;
        else
            high = middle;
    }
    if (low == faces->node_count || faces->node[low] != node) return false;
    for (uint32_t k = faces->start[low]; k < faces->start[low + 1]; k++)
        if (faces_that_way(mesh, faces, faces->face[k], where->side)) return true;
    return false;
}
