/* quantity.h: the text of one value -> a number in SI: "3.25", "2*mu", "20 MPa", "2*mu MPa", "-9.81*(t<1 ? t : 1)". */
#ifndef AB_QUANTITY_H
#define AB_QUANTITY_H

#include "core/expression.h"
#include "core/units.h"

/* unit: SI unit wanted, as UDUNITS reads it; "1" for a pure number; NULL for any dimension. variables: enum ab_variables.
 * On AB_BAD_INPUT `why` has cause and remedy without the place. number->mark is left alone. */
ab_status ab_quantity_read(ab_formulas *formulas, ab_units *units, const char *text, const char *unit, unsigned variables,
                           ab_number *number, char *why, size_t why_size);

typedef enum ab_literal { AB_LITERAL_NONE, AB_LITERAL_NUMBER, AB_LITERAL_REFUSED } ab_literal;
/* Reads a plain decimal number, all of the text. Refused: forms that look like a number but are read differently by different programs
 * (0x10, 1_000, 010, inf, nan) and overflow; `why` says so. */
ab_literal ab_literal_read(const char *text, double *value, char *why, size_t why_size);

#endif
