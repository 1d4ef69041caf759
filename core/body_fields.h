/* body_fields.h: the list of what a body of points or elements can show, the same for every method. */
#ifndef AB_BODY_FIELDS_H
#define AB_BODY_FIELDS_H

#include "core/domain.h"
#include "core/material.h"

/* The fixed fields, then the material's states; *fields is the caller's to free. Left out: what the body does not keep. */
ab_status ab_body_fields(const ab_class *material, const char *body, bool axisymmetric, bool displacement, bool deformation_gradient,
                         ab_field **fields, size_t *count, ab_report *report);

#endif
