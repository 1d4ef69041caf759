/* units.c: UDUNITS-2 behind two functions, quiet and without offsets. */
#include "core/units.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <udunits2.h>

enum { LONGEST_UNIT = 60, MOST_CONVERSIONS = 50000 }; /* the latter: a hostile file must not take hours */

struct ab_units {
    ut_system *system;
    bool tried;
    long conversions;
};

ab_units *ab_units_create(void) { return calloc(1, sizeof(ab_units)); }

void ab_units_destroy(ab_units *units) {
    if (units == NULL) return;
    if (units->system != NULL) ut_free_system(units->system);
    free(units);
}

static bool open_system(ab_units *units) {
    if (!units->tried) {
        units->tried = true;
        ut_set_error_message_handler(ut_ignore);
        units->system = ut_read_xml(NULL);
        ut_unit *degree = units->system == NULL ? NULL : ut_parse(units->system, "degree", UT_ASCII);
        if (degree != NULL) { /* the usual short form is not in the database */
            ut_map_name_to_unit("deg", UT_ASCII, degree);
            ut_free(degree);
        }
    }
    return units->system != NULL;
}

/* The unit, or NULL. Only letters, digits and signs that units are made of reach the parser: no dates, no offsets. */
static ut_unit *parsed(ab_units *units, const char *text) {
    const size_t length = strlen(text);
    if (length == 0 || length > LONGEST_UNIT || strchr(text, '@') != NULL) return NULL;
    static const char *const refused[] = {" since ", " after ", " from ", " ref "};
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++)
        if (strstr(text, refused[i]) != NULL) return NULL;
    return ut_parse(units->system, text, UT_UTF8);
}

/* True when the unit measures an angle: it comes down to a power of the radian. */
static bool is_angle(const ut_unit *unit) {
    char text[200];
    const int length = ut_format(unit, text, sizeof text - 1, UT_ASCII | UT_DEFINITION);
    if (length < 0 || (size_t)length >= sizeof text - 1) return false;
    text[length] = '\0';
    return strstr(text, "rad") != NULL;
}

static bool compatible(const ut_unit *unit, const ut_unit *wanted) {
    if (!ut_are_convertible(unit, wanted)) return false;
    return !ut_is_dimensionless(wanted) || is_angle(unit) == is_angle(wanted); /* 30 deg is not the pure number 0.52 */
}

static ab_status convert(const ut_unit *unit, const ut_unit *wanted, const char *text, double *factor, char *why, size_t size) {
    cv_converter *converter = ut_get_converter((ut_unit *)(size_t)unit, (ut_unit *)(size_t)wanted);
    if (converter == NULL) {
        snprintf(why, size, "unit '%s' cannot be converted", text);
        return AB_BAD_INPUT;
    }
    const double zero = cv_convert_double(converter, 0), one = cv_convert_double(converter, 1), two = cv_convert_double(converter, 2);
    cv_free(converter);
    if (zero != 0 || !isfinite(one) || one == 0 || fabs(two - 2 * one) > 1e-9 * fabs(two)) {
        snprintf(why, size, "unit '%s' is not a plain multiple of an SI unit (it has an offset or a logarithm)", text);
        return AB_BAD_INPUT;
    }
    *factor = one;
    return AB_OK;
}

/* The product of base units with the unit's dimension: its definition without the number in front. */
static ut_unit *base_of(ab_units *units, const ut_unit *unit) {
    char text[200];
    const int length = ut_format(unit, text, sizeof text - 1, UT_ASCII | UT_DEFINITION);
    if (length < 0 || (size_t)length >= sizeof text - 1) return NULL;
    text[length] = '\0';
    const char *rest = text;
    char *end = NULL;
    strtod(text, &end);
    if (end != text) rest = end + strspn(end, " ");
    return ut_parse(units->system, *rest == '\0' ? "1" : rest, UT_ASCII);
}

ab_status ab_units_factor(ab_units *units, const char *unit, const char *wanted, double *factor, char *why, size_t why_size) {
    *factor = 1;
    if (wanted != NULL && strcmp(unit, wanted) == 0) return AB_OK;
    if (!open_system(units)) {
        snprintf(why, why_size,
                 "the unit database of UDUNITS-2 cannot be read (package libudunits2-data); write the value in SI without a unit");
        return AB_BAD_INPUT;
    }
    if (++units->conversions > MOST_CONVERSIONS) {
        snprintf(why, why_size, "more than %d values with units; write this one in SI", MOST_CONVERSIONS);
        return AB_BAD_INPUT;
    }
    ut_unit *from = parsed(units, unit);
    if (from == NULL) {
        snprintf(why, why_size, "unknown unit '%.*s'; units are written as in \"20 MPa\", \"10 mm\", \"1800 kg m-3\"", LONGEST_UNIT, unit);
        return AB_BAD_INPUT;
    }
    ut_unit *to = wanted == NULL ? base_of(units, from) : ut_parse(units->system, wanted, UT_UTF8);
    ab_status status = AB_BAD_INPUT;
    if (to == NULL) {
        snprintf(why, why_size, "unit '%s' cannot be converted", wanted == NULL ? unit : wanted);
    } else if (!compatible(from, to)) {
        if (strcmp(wanted == NULL ? "" : wanted, "1") == 0)
            snprintf(why, why_size, "the unit '%s' has a dimension, but a pure number (unit 1) is needed", unit);
        else
            snprintf(why, why_size, "the unit '%s' does not have the dimension of '%s'", unit, wanted == NULL ? "" : wanted);
    } else {
        status = convert(from, to, unit, factor, why, why_size);
    }
    if (to != NULL) ut_free(to);
    ut_free(from);
    return status;
}

bool ab_units_known(ab_units *units, const char *unit) {
    if (!open_system(units)) return false;
    ut_unit *found = parsed(units, unit);
    if (found != NULL) ut_free(found);
    return found != NULL;
}
