/* columns.c: the fixed columns of history.csv and what stands in them. */
#include "core/columns.h"

#include <string.h>

static const struct {
    const char *name;
    size_t offset;
} terms[AB_TERMS] = {
    {"kinetic", offsetof(ab_energy, kinetic)},   {"strain", offsetof(ab_energy, strain)},     {"potential", offsetof(ab_energy, potential)},
    {"plastic", offsetof(ab_energy, plastic)},   {"friction", offsetof(ab_energy, friction)}, {"contact", offsetof(ab_energy, contact)},
    {"boundary", offsetof(ab_energy, boundary)}, {"damping", offsetof(ab_energy, damping)},   {"external", offsetof(ab_energy, external)},
    {"outflow", offsetof(ab_energy, outflow)},
};

const char *ab_term_name(size_t term) { return terms[term].name; }

double ab_term_value(const ab_energy *energy, size_t term) {
    double value;
    memcpy(&value, (const char *)energy + terms[term].offset, sizeof value);
    return value;
}

size_t ab_term_shown(const ab_scene *scene) {
    for (size_t k = 0; k < scene->stage_count; k++)
        for (int side = 0; side < AB_SIDES; side++)
            if (scene->stages[k].side[side] == AB_SIDE_OUTFLOW) return AB_TERMS;
    for (int side = 0; side < AB_SIDES; side++)
        if (scene->side[side] == AB_SIDE_OUTFLOW) return AB_TERMS;
    return AB_TERMS - 1;
}

double ab_energy_balance(const ab_energy *e) {
    return e->kinetic + e->strain + e->potential + e->plastic + e->friction + e->contact + e->boundary + e->damping + e->outflow -
           e->external;
}

/* t, step, dt, where there are stages their number | terms, remainder | terms of each body */
static size_t before(const ab_scene *scene) { return scene->stage_count > 0 ? 4 : 3; }

size_t ab_column_count(const ab_scene *scene) {
    return before(scene) + ab_term_shown(scene) + 1 + scene->body_count * ab_term_shown(scene);
}

void ab_column_name(const ab_scene *scene, size_t column, char *name, size_t size) {
    static const char *const first[] = {"t", "step", "dt", "stage"};
    const size_t shown = ab_term_shown(scene), ledger = column - before(scene);
    if (column < before(scene))
        snprintf(name, size, "%s", first[column]);
    else if (ledger < shown)
        snprintf(name, size, "%s", terms[ledger].name);
    else if (ledger == shown)
        snprintf(name, size, "remainder");
    else
        snprintf(name, size, "%.256s.%s", scene->bodies[(ledger - shown - 1) / shown].name, terms[(ledger - shown - 1) % shown].name);
}

const char *ab_column_unit(const ab_scene *scene, size_t column) { return column >= before(scene) ? "J" : column % 2 == 1 ? "1" : "s"; }

double ab_column_value(const ab_state_view *view, size_t column) {
    const size_t first = before(view->scene), shown = ab_term_shown(view->scene), ledger = column - first;
    if (column < first)
        return column == 0 ? view->time : column == 1 ? (double)view->step : column == 2 ? view->dt : (double)view->stage + 1;
    if (ledger < shown) return ab_term_value(&view->total, ledger);
    if (ledger == shown) return view->remainder;
    return ab_term_value(&view->energy[(ledger - shown - 1) / shown], (ledger - shown - 1) % shown);
}

size_t ab_column_find(const ab_scene *scene, const char *wanted) {
    char name[320];
    const size_t count = ab_column_count(scene);
    for (size_t column = 0; column < count; column++) {
        ab_column_name(scene, column, name, sizeof name);
        if (strcmp(name, wanted) == 0) return column;
    }
    return SIZE_MAX;
}
