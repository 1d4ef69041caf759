/* mesh_gmsh.c: the mesh of a body from a Gmsh file: all quadrilaterals of its surfaces, every mistake with the ids of the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/files.h"
#include "fem/mesh_gmsh.h"
#include "fem/mesh_parts.h"

enum { QUAD4 = 3, QUAD9 = 10, QUAD8 = 16 }; /* element types of Gmsh; nodes of QUAD8 are in our order */

typedef struct from_file { /* what every check needs */
    const ab_body_spec *spec;
    const char *path;
    const fem_gmsh_file *file;
    ab_report *report;
} from_file;

static ab_mark mark_of(const from_file *f) { return f->spec->mesh.mark; }

/* "5, 6, 7 ..." */
static const char *list_ids(char *text, size_t size, const uint64_t *id, size_t count) {
    size_t used = 0;
    for (size_t k = 0; k < count && k < FEM_MOST_SAID; k++)
        used += (size_t)snprintf(text + used, size - used, "%s%llu", k == 0 ? "" : ", ", (unsigned long long)id[k]);
    if (count > FEM_MOST_SAID) snprintf(text + used, size - used, " ...");
    return text;
}

static const char *type_name(uint64_t type) {
    static const struct {
        uint64_t type;
        const char *name;
    } names[] = {{2, "triangles"},
                 {9, "triangles of 6 nodes"},
                 {QUAD9, "quadrilaterals of 9 nodes"},
                 {QUAD4, "quadrilaterals of 4 nodes"},
                 {4, "tetrahedra"},
                 {5, "hexahedra"},
                 {6, "prisms"},
                 {QUAD8, "quadrilaterals of 8 nodes"},
                 {36, "quadrilaterals of 16 nodes"}};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (names[k].type == type) return names[k].name;
    return "elements of another type";
}

static const char *gmsh_name(uint64_t type) {
    static const char *const names[] = {
        [2] = "Triangle 3",          [QUAD4] = "Quadrilateral 4", [9] = "Triangle 6",       [QUAD9] = "Quadrilateral 9",
        [QUAD8] = "Quadrilateral 8", [20] = "Triangle 9",         [21] = "Triangle 10",     [22] = "Triangle 12",
        [23] = "Triangle 15",        [36] = "Quadrilateral 16",   [37] = "Quadrilateral 25"};
    return type < sizeof names / sizeof *names && names[type] != NULL ? names[type] : "another type";
}

/* Surfaces of one type only: true for those; else a mistake that counts each type, with the first elements of all but the most frequent (of two as frequent, the
 * one that the scene wants). */
static bool check_mixture(const from_file *f) {
    const uint64_t wanted = f->spec->mesh.type >= AB_ELEMENT_Q8 ? QUAD8 : QUAD4;
    char text[1200] = "";
    size_t used = 0, kinds = 0, most = 0;
    uint64_t weight = 0;
    for (size_t k = 0; k < f->file->block_count; k++) {
        const fem_gmsh_block *block = &f->file->block[k];
        if (block->dimension != 2) continue;
        kinds++;
        const uint64_t own = 2 * block->count + (block->type == wanted);
        if (own <= weight) continue;
        weight = own;
        most = k;
    }
    if (kinds < 2) return true;
    for (size_t k = 0; k < f->file->block_count && used < sizeof text; k++) {
        const fem_gmsh_block *block = &f->file->block[k];
        if (block->dimension != 2) continue;
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%llu of %s (%llu nodes)", used > 0 ? ", " : "",
                                 (unsigned long long)block->count, gmsh_name(block->type), (unsigned long long)block->nodes);
        if (k == most || used >= sizeof text) continue;
        char ids[400];
        list_ids(ids, sizeof ids, block->id, block->count);
        used += (size_t)snprintf(text + used, sizeof text - used, ": elements %s", ids);
    }
    ab_report_error(
        f->report, mark_of(f),
        "body '%s': '%s' has elements of several types: %s; quadrilaterals of one order are needed: set Mesh.RecombineAll = 1 and "
        "Mesh.ElementOrder = 1 in Gmsh (or 2 with Mesh.SecondOrderIncomplete = 1) before meshing, and save anew",
        f->spec->name, f->path, text);
    return false;
}

/* Nothing but quadrilaterals with the nodes that the scene's type has. */
static ab_status check_types(const from_file *f, size_t *elements) {
    const bool quadratic = f->spec->mesh.type >= AB_ELEMENT_Q8;
    const char *name = f->spec->name;
    ab_status status = AB_OK;
    *elements = 0;
    if (!check_mixture(f)) return AB_BAD_INPUT;
    for (size_t k = 0; k < f->file->block_count; k++) {
        const fem_gmsh_block *block = &f->file->block[k];
        char ids[400];
        list_ids(ids, sizeof ids, block->id, block->count);
        if (block->type == (quadratic ? QUAD8 : QUAD4) && block->nodes == (quadratic ? 8 : 4))
            *elements += block->count;
        else if (block->type == QUAD4 || block->type == QUAD8)
            status =
                ab_report_error(f->report, mark_of(f), "body '%s': '%s' has %s (elements %s), but the mesh's type is one of %d nodes; %s",
                                name, f->path, type_name(block->type), ids, quadratic ? 8 : 4,
                                quadratic ? "write type: q4, q4r or q6, or save second-order elements (Mesh.ElementOrder = 2, "
                                            "Mesh.SecondOrderIncomplete = 1)"
                                          : "write type: q8 or q8r");
        else
            status = ab_report_error(
                f->report, mark_of(f), "body '%s': '%s' has %s (elements %s); quadrilaterals of 4 or 8 nodes are needed: %s", name, f->path,
                type_name(block->type), ids,
                block->dimension == 3  ? "save the surface alone"
                : block->type == QUAD9 ? "set Mesh.SecondOrderIncomplete = 1 in Gmsh"
                                       : "set Mesh.RecombineAll = 1 in Gmsh, or make the surface transfinite and recombine it");
    }
    if (status != AB_OK) return status;
    if (*elements == 0)
        return ab_report_error(
            f->report, mark_of(f),
            "body '%s': '%s' has no elements of surfaces; mesh in two dimensions before saving (and if there are physical groups, "
            "make one of the surfaces)",
            name, f->path);
    if (*elements > FEM_MOST_ELEMENTS)
        return ab_report_error(f->report, mark_of(f), "body '%s': '%s' has %zu elements, more than %d; mesh it coarser", name, f->path,
                               *elements, FEM_MOST_ELEMENTS);
    return AB_OK;
}

typedef struct entry {
    uint64_t id;
    const uint64_t *node; /* of an element; NULL: of a node */
    size_t place;
} entry;

static int by_id(const void *a, const void *b) {
    const entry *p = a, *q = b;
    if (p->id != q->id) return p->id < q->id ? -1 : 1;
    return p->place < q->place ? -1 : p->place > q->place;
}

static size_t find_id(const entry *list, size_t count, uint64_t id) {
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (list[middle].id < id)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && list[low].id == id ? low : SIZE_MAX;
}

static ab_status check_ids(const from_file *f, const entry *list, size_t count, const char *what) {
    size_t wrong = 0;
    for (size_t k = 1; k < count && wrong < FEM_MOST_SAID; k++)
        if (list[k].id == list[k - 1].id && ++wrong)
            ab_report_error(f->report, mark_of(f), "body '%s': '%s' has two %ss with the number %llu; renumber the mesh in Gmsh",
                            f->spec->name, f->path, what, (unsigned long long)list[k].id);
    return wrong > 0 ? AB_BAD_INPUT : AB_OK;
}

/* Sorted lists of nodes and elements. */
static ab_status sort_lists(const from_file *f, entry *node, entry *element, size_t elements) {
    for (size_t i = 0; i < f->file->node_count; i++) node[i] = (entry){f->file->node_id[i], NULL, i};
    size_t n = 0;
    for (size_t k = 0; k < f->file->block_count; k++) {
        const fem_gmsh_block *block = &f->file->block[k];
        for (size_t e = 0; e < block->count; e++, n++) element[n] = (entry){block->id[e], block->node + e * block->nodes, n};
    }
    qsort(node, f->file->node_count, sizeof *node, by_id);
    qsort(element, elements, sizeof *element, by_id);
    const ab_status nodes = check_ids(f, node, f->file->node_count, "node"), others = check_ids(f, element, elements, "element");
    return nodes != AB_OK ? nodes : others;
}

/* place[k]: number in the mesh of the k-th node of the list, those of elements in the order of ids; UINT32_MAX: of none. Every node of an element must exist,
 * and once. */
static ab_status number_nodes(const from_file *f, const entry *node, const entry *element, size_t elements, uint32_t *place, size_t *used) {
    const int nodes = f->spec->mesh.type >= AB_ELEMENT_Q8 ? 8 : 4;
    size_t wrong = 0;
    for (size_t i = 0; i < f->file->node_count; i++) place[i] = UINT32_MAX;
    for (size_t e = 0; e < elements && wrong < FEM_MOST_SAID; e++)
        for (int a = 0; a < nodes; a++) {
            const uint64_t id = element[e].node[a];
            const size_t k = find_id(node, f->file->node_count, id);
            bool twice = false;
            for (int b = 0; b < a; b++) twice = twice || element[e].node[b] == id;
            if (k != SIZE_MAX && !twice) {
                place[k] = 0;
                continue;
            }
            ab_report_error(f->report, mark_of(f), "body '%s': element %llu of '%s' %s node %llu%s", f->spec->name,
                            (unsigned long long)element[e].id, f->path, twice ? "has" : "names", (unsigned long long)id,
                            twice ? " twice: it has no area there; remove it or mesh that place anew" : ", which the file does not have");
            wrong++;
            break;
        }
    if (wrong > 0) return AB_BAD_INPUT;
    *used = 0;
    for (size_t i = 0; i < f->file->node_count; i++)
        if (place[i] == 0) place[i] = (uint32_t)(*used)++;
    return AB_OK;
}

/* Nodes of no element (middles of circles, say) are left out, and said. */
static void warn_of_orphans(const from_file *f, const entry *node, const uint32_t *place, size_t used) {
    uint64_t id[FEM_MOST_SAID + 1] = {0};
    size_t orphans = 0;
    char ids[400];
    if (used == f->file->node_count) return;
    for (size_t i = 0; i < f->file->node_count && orphans <= FEM_MOST_SAID; i++)
        if (place[i] == UINT32_MAX) id[orphans++] = node[i].id;
    ab_report_warning(f->report, mark_of(f), "body '%s': %zu nodes of '%s' belong to no element and are left out: %s", f->spec->name,
                      f->file->node_count - used, f->path, list_ids(ids, sizeof ids, id, orphans));
}

/* The mesh lies in the plane: one z for all. */
static ab_status place_nodes(const from_file *f, const entry *node, const uint32_t *place, fem_mesh *mesh) {
    double z = NAN, low = INFINITY, high = -INFINITY;
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < f->file->node_count; i++) {
            if (place[i] == UINT32_MAX) continue;
            const double *x = f->file->x + 3 * node[i].place;
            const unsigned long long id = node[i].id;
            if (pass == 0) {
                if (!isfinite(x[0]) || !isfinite(x[1]) || !isfinite(x[2]))
                    return ab_report_error(f->report, mark_of(f), "body '%s': node %llu of '%s' has a coordinate that is no number",
                                           f->spec->name, id, f->path);
                if (isnan(z)) z = x[2];
                low = fmin(low, fmin(x[0], x[1]));
                high = fmax(high, fmax(x[0], x[1]));
                memcpy(mesh->x + 2 * (size_t)place[i], x, 2 * sizeof *x);
                mesh->node_id[place[i]] = node[i].id;
            } else if (fabs(x[2] - z) > 1e-9 * (high - low)) {
                return ab_report_error(
                    f->report, mark_of(f),
                    "body '%s': '%s' does not lie in the plane of x and y: node %llu has z = %.10g, node %llu has z = %.10g", f->spec->name,
                    f->path, (unsigned long long)mesh->node_id[0], z, id, x[2]);
            }
        }
    return AB_OK;
}

static double turned(const fem_mesh *mesh, const uint32_t *n) { /* twice the area of the corners, positive counter-clockwise */
    const double *a = mesh->x + 2 * (size_t)n[0], *b = mesh->x + 2 * (size_t)n[1], *c = mesh->x + 2 * (size_t)n[2],
                 *d = mesh->x + 2 * (size_t)n[3];
    return (c[0] - a[0]) * (d[1] - b[1]) - (d[0] - b[0]) * (c[1] - a[1]);
}

/* A surface drawn clockwise has all its elements so: they are turned round. Some this way and some that is a mistake of the mesh. */
static ab_status orient(const from_file *f, fem_mesh *mesh) {
    static const int other[8] = {0, 3, 2, 1, 7, 6, 5, 4};
    uint64_t id[2][FEM_MOST_SAID + 1];
    size_t count[2] = {0, 0};
    for (size_t e = 0; e < mesh->element_count; e++) {
        const int way = turned(mesh, mesh->connectivity + e * (size_t)mesh->nodes) > 0 ? 0 : 1;
        if (count[way] <= FEM_MOST_SAID) id[way][count[way]] = mesh->element_id[e];
        count[way]++;
    }
    if (count[0] > 0 && count[1] > 0) {
        const int few = count[1] <= count[0] ? 1 : 0;
        char ids[400];
        return ab_report_error(
            f->report, mark_of(f),
            "body '%s': of the elements of '%s' %zu go round one way and %zu the other (%s); turn surfaces round in Gmsh (Reverse "
            "Surface) so that all agree, or mesh anew where single ones are inverted",
            f->spec->name, f->path, count[1 - few], count[few], list_ids(ids, sizeof ids, id[few], count[few]));
    }
    for (size_t e = 0; e < mesh->element_count && count[1] > 0; e++) {
        uint32_t *n = mesh->connectivity + e * (size_t)mesh->nodes, old[8];
        memcpy(old, n, (size_t)mesh->nodes * sizeof *n);
        for (int a = 0; a < mesh->nodes; a++) n[a] = old[other[a]];
    }
    return AB_OK;
}

/* A node that is the corner of one element and the middle of another hangs: the fields would gape there. */
static ab_status check_hanging(const from_file *f, const fem_mesh *mesh) {
    if (mesh->nodes != 8) return AB_OK;
    bool *corner = calloc(mesh->node_count + 1, sizeof *corner);
    if (corner == NULL) return ab_report_failure(f->report, "no memory for the mesh of body '%s'", f->spec->name);
    size_t wrong = 0;
    for (size_t e = 0; e < mesh->element_count; e++)
        for (int a = 0; a < 4; a++) corner[mesh->connectivity[8 * e + (size_t)a]] = true;
    for (size_t e = 0; e < mesh->element_count && wrong < FEM_MOST_SAID; e++)
        for (int a = 4; a < 8; a++) {
            const uint32_t n = mesh->connectivity[8 * e + (size_t)a];
            if (!corner[n]) continue;
            wrong++;
            ab_report_error(
                f->report, mark_of(f),
                "body '%s': node %llu of '%s' is the middle of a side of element %llu and the corner of another; elements must share "
                "whole sides",
                f->spec->name, fem_node_id(mesh, n), f->path, fem_element_id(mesh, e));
        }
    free(corner);
    return wrong > 0 ? AB_BAD_INPUT : AB_OK;
}

typedef struct spot {
    double x, y; /* rounded to a billionth of the mesh's size */
    uint32_t node;
} spot;

static int by_spot(const void *a, const void *b) {
    const spot *p = a, *q = b;
    if (p->x != q->x) return p->x < q->x ? -1 : 1;
    if (p->y != q->y) return p->y < q->y ? -1 : 1;
    return p->node < q->node ? -1 : p->node > q->node;
}

/* Surfaces that were meshed apart and not joined come apart in the run: more often forgotten than meant. */
static ab_status warn_of_twins(const from_file *f, const fem_mesh *mesh) {
    spot *spots = malloc((mesh->node_count + 1) * sizeof *spots);
    if (spots == NULL) return ab_report_failure(f->report, "no memory for the mesh of body '%s'", f->spec->name);
    double size = 0;
    for (size_t i = 0; i < 2 * mesh->node_count; i++) size = fmax(size, fabs(mesh->x[i] - mesh->x[i % 2]));
    for (size_t i = 0; i < mesh->node_count; i++)
        spots[i] =
            (spot){rint((mesh->x[2 * i] - mesh->x[0]) * 1e9 / size), rint((mesh->x[2 * i + 1] - mesh->x[1]) * 1e9 / size), (uint32_t)i};
    qsort(spots, mesh->node_count, sizeof *spots, by_spot);
    size_t twins = 0, first = 0;
    for (size_t i = 1; i < mesh->node_count; i++)
        if (spots[i].x == spots[i - 1].x && spots[i].y == spots[i - 1].y && twins++ == 0) first = i;
    if (twins > 0)
        ab_report_warning(
            f->report, mark_of(f),
            "body '%s': %zu nodes of '%s' lie where another lies and are not joined with it (%llu and %llu, say): the body is cut "
            "there; in Gmsh, Coherence Mesh joins them",
            f->spec->name, twins, f->path, fem_node_id(mesh, spots[first - 1].node), fem_node_id(mesh, spots[first].node));
    free(spots);
    return AB_OK;
}

static ab_status build(const from_file *f, const entry *node, const entry *element, size_t elements, const uint32_t *place, size_t used,
                       fem_mesh **result) {
    const int nodes = f->spec->mesh.type >= AB_ELEMENT_Q8 ? 8 : 4;
    fem_mesh *mesh = NULL;
    AB_TRY(fem_mesh_allocate(nodes, used, elements, f->spec->name, &mesh, f->report));
    *result = mesh;
    mesh->node_id = malloc((used + 1) * sizeof *mesh->node_id);
    mesh->element_id = malloc((elements + 1) * sizeof *mesh->element_id);
    if (mesh->node_id == NULL || mesh->element_id == NULL)
        return ab_report_failure(f->report, "no memory for the mesh of body '%s'", f->spec->name);
    AB_TRY(place_nodes(f, node, place, mesh));
    for (size_t e = 0; e < elements; e++) {
        mesh->element_id[e] = element[e].id;
        for (int a = 0; a < nodes; a++)
            mesh->connectivity[e * (size_t)nodes + (size_t)a] = place[find_id(node, f->file->node_count, element[e].node[a])];
    }
    AB_TRY(orient(f, mesh));
    AB_TRY(check_hanging(f, mesh));
    uint32_t *mate = NULL;
    AB_TRY(fem_sides_join(mesh, f->spec->name, mark_of(f), &mate, f->report)); /* elements on each other, sides of three */
    free(mate);
    return warn_of_twins(f, mesh);
}

static ab_status make(const from_file *f, fem_mesh **mesh) {
    size_t elements = 0, used = 0;
    AB_TRY(check_types(f, &elements));
    const size_t nodes = f->file->node_count;
    if (nodes >= UINT32_MAX) return ab_report_error(f->report, mark_of(f), "body '%s': '%s' has too many nodes", f->spec->name, f->path);
    entry *node = malloc((nodes + 1) * sizeof *node), *element = malloc((elements + 1) * sizeof *element);
    uint32_t *place = malloc((nodes + 1) * sizeof *place);
    ab_status status = node != NULL && element != NULL && place != NULL
                           ? sort_lists(f, node, element, elements)
                           : ab_report_failure(f->report, "no memory for the mesh of body '%s'", f->spec->name);
    if (status == AB_OK) status = number_nodes(f, node, element, elements, place, &used);
    if (status == AB_OK) {
        warn_of_orphans(f, node, place, used);
        status = build(f, node, element, elements, place, used, mesh);
    }
    free(node);
    free(element);
    free(place);
    return status;
}

ab_status fem_gmsh_mesh(const ab_body_spec *spec, const char *path, const fem_gmsh_file *file, fem_mesh **result, ab_report *report) {
    const from_file f = {spec, path, file, report};
    fem_mesh *mesh = NULL;
    const ab_status status = make(&f, &mesh);
    if (status == AB_OK)
        *result = mesh;
    else
        fem_mesh_destroy(mesh);
    return status;
}

ab_status fem_mesh_gmsh(const ab_body_spec *spec, const char *folder, fem_mesh **result, ab_report *report) {
    fem_gmsh_file file;
    char *path = spec->mesh.file[0] == '/' ? ab_path_join("", spec->mesh.file + 1) : ab_path_join(folder, spec->mesh.file);
    if (path == NULL) return ab_report_failure(report, "no memory for the mesh of body '%s'", spec->name);
    ab_status status = fem_gmsh_read(path, spec->name, spec->mesh.mark, &file, report);
    if (status == AB_OK) {
        status = fem_gmsh_mesh(spec, path, &file, result, report);
        fem_gmsh_forget(&file);
    }
    free(path);
    return status;
}
