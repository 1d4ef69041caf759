/* body_fields.c: the list of what a body of points or elements can show. */
#include <stdlib.h>
#include <string.h>

#include "core/body_fields.h"

static const ab_field FIELDS[] = {
    {"id", "1", 1, ""},
    {"position", "m", 2, "x y"},
    {"velocity", "m s-1", 2, "x y"},
    {"displacement", "m", 2, "x y"},
    {"mass", "kg m-1", 1, ""},
    {"volume", "m2", 1, ""},
    {"stress", "Pa", 4, "xx yy zz xy"},
    {"deformation-gradient", "1", 4, "xx xy yx yy"},
};
enum { FIXED_FIELDS = sizeof FIELDS / sizeof *FIELDS };

ab_status ab_body_fields(const ab_class *material, const char *body, bool axisymmetric, bool displacement, bool deformation_gradient,
                         ab_field **fields, size_t *count, ab_report *report) {
    *count = 0;
    *fields = malloc((FIXED_FIELDS + material->nstate) * sizeof **fields);
    if (*fields == NULL) return ab_report_failure(report, "no memory for the list of fields of body '%s'", body);
    for (size_t f = 0; f < FIXED_FIELDS; f++) {
        ab_field field = FIELDS[f];
        if (!displacement && strcmp(field.name, "displacement") == 0) continue;
        if (!deformation_gradient && strcmp(field.name, "deformation-gradient") == 0) continue;
        if (axisymmetric && strcmp(field.name, "mass") == 0) field.unit = "kg"; /* of rings */
        if (axisymmetric && strcmp(field.name, "volume") == 0) field.unit = "m3";
        (*fields)[(*count)++] = field;
    }
    for (uint32_t s = 0; s < material->nstate; s++)
        (*fields)[(*count)++] =
            (ab_field){material->state[s].name, material->state[s].unit, ab_state_components(material->state[s].shape), ""};
    return AB_OK;
}
