/* keep.c: what finite-element and rigid bodies are between two steps. Mesh, masses and supports come with the scene; forces of loads and supports are found anew in every
 * step. */
#include "core/checkpoint.h"
#include "fem/domain.h"
#include "fem/rigid.h"

/* Where displacements are counted from, where a stage has set it. */
static void keep_datum(fem_body *body, ab_checkpoint *c) {
    bool set = body->datum != NULL;
    if (!ab_keep_flags(c, "datum_set", &set, 1) || !set) return;
    if (!body->datum && fem_datum(&body->domain, ab_checkpoint_report(c)) != AB_OK)
        ab_checkpoint_refuse(c, "no memory for %zu nodes", body->nodes);
    else
        ab_keep_doubles(c, "datum", body->datum, 2 * body->nodes);
}

void fem_keep(ab_domain *domain, ab_checkpoint *c) {
    fem_body *body = (fem_body *)domain;
    const size_t pairs = 2 * body->nodes, blocks = body->blocks;
    size_t nodes = body->nodes, elements = body->elements, rows = (size_t)body->rows.count;
    if (!ab_keep_size(c, "nodes", &nodes) || !ab_keep_size(c, "elements", &elements) || !ab_keep_size(c, "rows", &rows)) return;
    if (nodes != body->nodes || elements != body->elements || rows != (size_t)body->rows.count) {
        ab_checkpoint_refuse(c, "body '%s' has %zu nodes and %zu elements there, and %zu and %zu here", domain->spec->name, nodes, elements,
                             body->nodes, body->elements);
        return;
    }
    const bool good = ab_keep_doubles(c, "x", body->x, pairs) && ab_keep_doubles(c, "x_start", body->x_start, pairs) &&
                      ab_keep_doubles(c, "velocity", body->velocity, pairs) && ab_keep_doubles(c, "old", body->old, pairs) &&
                      ab_keep_doubles(c, "force", body->force, pairs) &&
                      ab_keep_doubles(c, "gauss", body->gauss, blocks * (size_t)body->element->gauss * 8 * rows) &&
                      ab_keep_doubles(c, "extra", body->extra, blocks * 8 * (size_t)body->element->extra) &&
                      ab_keep_doubles(c, "element_force", body->element_force, blocks * (size_t)body->element->nodes * 16) &&
                      ab_keep_doubles(c, "stretch", body->stretch, blocks) && ab_keep_doubles(c, "stiffening", body->stiffening, blocks) &&
                      ab_keep_doubles(c, "frequency2", body->frequency2, blocks * 8) && ab_keep_doubles(c, "slowest", &body->slowest, 1) &&
                      ab_keep_size(c, "slowest_element", &body->slowest_element) && ab_keep_struct(c, "energy", &body->energy) &&
                      ab_keep_doubles(c, "ahead", &body->ahead, 1) && ab_keep_struct(c, "motion", &body->motion) &&
                      ab_keep_doubles(c, "reaction", body->reaction, 3) &&
                      ab_keep_plugin(c, "material", &body->material->loaded->class_, body->self);
    if (good && body->slowest_element >= body->elements)
        ab_checkpoint_refuse(c, "the elements of body '%s' are damaged", domain->spec->name);
    if (good && body->scene->stage_count > 0) keep_datum(body, c);
    if (good && body->trace) fem_inner_keep(body, c);
}

void rigid_keep(ab_domain *domain, ab_checkpoint *c) {
    rigid_body *body = (rigid_body *)domain;
    bool moved = body->moved;
    const double before[3] = {body->centre[0], body->centre[1], body->angle};
    const bool good = ab_keep_doubles(c, "angle", &body->angle, 1) && ab_keep_doubles(c, "cosine", &body->cosine, 1) &&
                      ab_keep_doubles(c, "sine", &body->sine, 1) && ab_keep_doubles(c, "centre", body->centre, 2) &&
                      ab_keep_doubles(c, "given", body->given, 2) && ab_keep_doubles(c, "velocity", body->velocity, 2) &&
                      ab_keep_doubles(c, "old", body->old, 2) && ab_keep_doubles(c, "spin", &body->spin, 1) &&
                      ab_keep_doubles(c, "spin_old", &body->spin_old, 1) && ab_keep_doubles(c, "reference", body->reference, 2) &&
                      ab_keep_doubles(c, "offset", body->offset, 2) && ab_keep_doubles(c, "impulse", body->impulse, 3) &&
                      ab_keep_doubles(c, "force", body->force, 3) && ab_keep_doubles(c, "weight", body->weight, 2) &&
                      ab_keep_doubles(c, "reaction", body->reaction, 3) && ab_keep_struct(c, "energy", &body->energy) &&
                      ab_keep_struct(c, "motion", &body->motion) && ab_keep_flags(c, "moved", &moved, 1);
    if (good && body->scene->stage_count > 0 && ab_keep_flags(c, "has_datum", &body->has_datum, 1))
        ab_keep_doubles(c, "datum", body->datum, 3);
    if (good && ab_checkpoint_loads(c)) /* what finders see is that of the start */
        body->moved = moved || before[0] != body->centre[0] || before[1] != body->centre[1] || before[2] != body->angle;
}
