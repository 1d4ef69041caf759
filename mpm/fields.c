/* fields.c: what a material-point body can show: fields in order of id, for results and monitors. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/body_fields.h"
#include "mpm/body.h"

ab_status mpm_fields_create(mpm_body *body, ab_report *report) {
    return ab_body_fields(&body->material->loaded->class_, body->domain.spec->name, body->axisymmetric, body->birth != NULL,
                          body->rows.gradient >= 0, &body->fields, &body->field_count, report);
}

const ab_field *mpm_fields(const ab_domain *domain, size_t *count) {
    const mpm_body *body = (const mpm_body *)domain;
    *count = body->field_count;
    return body->fields;
}

size_t mpm_count(const ab_domain *domain) { return ((const mpm_body *)domain)->points; }

/* First row of a field that stands in the blocks as it is; -1 for one that does not. */
static int row_of(const mpm_body *body, const char *field) {
    if (!strcmp(field, "velocity")) return ROW_V;
    if (!strcmp(field, "mass")) return ROW_MASS;
    if (!strcmp(field, "volume")) return ROW_VOLUME;
    if (!strcmp(field, "stress")) return ROW_STRESS;
    if (!strcmp(field, "deformation-gradient")) return body->rows.gradient;
    const ab_class *class_ = &body->material->loaded->class_;
    int row = body->rows.state;
    for (uint32_t s = 0; s < class_->nstate; ++s) {
        if (!strcmp(field, class_->state[s].name)) return row;
        row += ab_state_components(class_->state[s].shape);
    }
    return -1;
}

ab_status mpm_read(const ab_domain *domain, const char *field, double *values, ab_report *report) {
    const mpm_body *body = (const mpm_body *)domain;
    int components = 0;
    for (size_t f = 0; f < body->field_count; ++f)
        if (!strcmp(field, body->fields[f].name)) components = body->fields[f].components;
    if (!components) return ab_report_failure(report, "body '%s' has no field '%s'", domain->spec->name, field);
    /* ids have holes where points left: rank[id] counts those before */
    uint32_t *rank = malloc((body->born + 1) * sizeof *rank);
    if (!rank) return ab_report_failure(report, "no memory to read field '%s' of body '%s'", field, domain->spec->name);
    memset(rank, 0, (body->born + 1) * sizeof *rank);
    for (size_t slot = 0; slot < body->block_count * 8; ++slot)
        if (body->ids[slot] != UINT64_MAX) rank[body->ids[slot] + 1] = 1;
    for (size_t id = 0; id < body->born; ++id) rank[id + 1] += rank[id];
    const bool is_id = !strcmp(field, "id"), is_position = !strcmp(field, "position"), is_displacement = !strcmp(field, "displacement");
    const int row = is_id || is_position || is_displacement ? ROW_X : row_of(body, field);
    for (size_t slot = 0; slot < body->block_count * 8; ++slot) {
        const uint64_t id = body->ids[slot];
        if (id == UINT64_MAX) continue;
        const double *at = mpm_block(body, slot / 8) + 8 * row + slot % 8;
        double *out = values + (size_t)rank[id] * (size_t)components;
        for (int c = 0; c < components; ++c) out[c] = is_id ? (double)id : at[8 * c];
        if (is_position)
            for (int c = 0; c < 2; ++c) out[c] += body->origin[c];
        if (is_displacement)
            for (int c = 0; c < 2; ++c) out[c] -= (body->datum ? body->datum : body->birth)[2 * id + (size_t)c];
    }
    free(rank);
    return AB_OK;
}
