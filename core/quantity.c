/* quantity.c: decides whether a text is a plain number, a formula, or either with a unit behind it. */
#include "core/quantity.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MOST_SPLITS = 24, MOST_LOOKED = 400 };

/* Characters of a decimal number at the front: [+-] digits [. digits] [e [+-] digits]; 0 when there is none. */
static size_t number_length(const char *text) {
    const char *c = text;
    if (*c == '+' || *c == '-') c++;
    size_t whole = strspn(c, "0123456789"), fraction = 0;
    c += whole;
    if (*c == '.') {
        fraction = strspn(c + 1, "0123456789");
        c += 1 + fraction;
    }
    if (whole + fraction == 0) return 0;
    if (*c == 'e' || *c == 'E') {
        const char *power = c + 1;
        if (*power == '+' || *power == '-') power++;
        const size_t digits = strspn(power, "0123456789");
        if (digits > 0) c = power + digits;
    }
    return (size_t)(c - text);
}

static bool is_word(const char *text, const char *word) {
    if (*text == '+' || *text == '-') text++;
    if (*text == '.') text++;
    return strcasecmp(text, word) == 0;
}

/* Overflow and leading zeros of a number of `length` characters. */
static ab_literal checked(const char *text, size_t length, double *value, char *why, size_t size) {
    char digits[400];
    if (length >= sizeof digits) {
        snprintf(why, size, "a number of %zu characters", length);
        return AB_LITERAL_REFUSED;
    }
    memcpy(digits, text, length);
    digits[length] = '\0';
    const char *first = digits + (digits[0] == '+' || digits[0] == '-');
    if (first[0] == '0' && isdigit((unsigned char)first[1])) {
        snprintf(why, size, "'%s' begins with 0, which some programs read as octal; leave the leading zeros out", digits);
        return AB_LITERAL_REFUSED;
    }
    *value = strtod(digits, NULL); /* the program never leaves the "C" locale */
    if (!isfinite(*value)) {
        snprintf(why, size, "'%.64s' is too large for a number (overflow)", digits);
        return AB_LITERAL_REFUSED;
    }
    return AB_LITERAL_NUMBER;
}

ab_literal ab_literal_read(const char *text, double *value, char *why, size_t why_size) {
    if (is_word(text, "inf") || is_word(text, "infinity") || is_word(text, "nan")) {
        snprintf(why, why_size, "'%s' is not a finite number", text);
        return AB_LITERAL_REFUSED;
    }
    const char *c = text + (*text == '+' || *text == '-');
    if (c[0] == '0' && (c[1] == 'x' || c[1] == 'X' || c[1] == 'o' || c[1] == 'b')) {
        snprintf(why, why_size, "'%.64s' is not decimal; write the number in decimal", text);
        return AB_LITERAL_REFUSED;
    }
    if (isdigit((unsigned char)*c) && strchr(c, '_') != NULL && c[strspn(c, "0123456789_.")] == '\0') {
        snprintf(why, why_size, "'%.64s' has '_' between its digits; leave it out", text);
        return AB_LITERAL_REFUSED;
    }
    const size_t length = number_length(text);
    if (length == 0 || text[length] != '\0') return AB_LITERAL_NONE;
    return checked(text, length, value, why, why_size);
}

static bool may_begin_unit(const char *text) { return isalpha((unsigned char)*text) || *text == '%' || (unsigned char)*text >= 0x80; }

/* number->value and ->expression times a unit. */
static ab_status with_unit(ab_units *units, const char *unit, const char *wanted, ab_number *number, char *why, size_t size) {
    double factor = 1;
    AB_TRY(ab_units_factor(units, unit, wanted, &factor, why, size));
    const double value = number->value * factor;
    if (!isfinite(value)) {
        snprintf(why, size, "the value is too large once it is converted to SI");
        return AB_BAD_INPUT;
    }
    number->value = value;
    return AB_OK;
}

/* "FORMULA UNIT": the first blank where both halves can be read. AB_MISSED: no such place. */
static ab_status split_formula(ab_formulas *formulas, ab_units *units, const char *text, const char *unit, unsigned variables,
                               ab_number *number, char *why, size_t size) {
    char left[AB_FORMULA_TEXT + 1], reason[512];
    if (strlen(text) > AB_FORMULA_TEXT || ab_formulas_exhausted(formulas)) return AB_MISSED;
    int tried = 0, looked = 0;
    for (const char *c = text; *c != '\0' && tried < MOST_SPLITS && looked < MOST_LOOKED; c++) {
        if (*c != ' ' || c == text) continue;
        const char *rest = c + strspn(c, " ");
        if (!may_begin_unit(rest) || ++looked > MOST_LOOKED || !ab_units_known(units, rest)) continue;
        memcpy(left, text, (size_t)(c - text));
        left[c - text] = '\0';
        tried++;
        const ab_status status = ab_formulas_compile(formulas, left, variables, number, reason, sizeof reason);
        if (status == AB_FAILED) {
            snprintf(why, size, "%s", reason);
            return status;
        }
        if (status == AB_OK) return with_unit(units, rest, unit, number, why, size);
    }
    return AB_MISSED;
}

ab_status ab_quantity_read(ab_formulas *formulas, ab_units *units, const char *text, const char *unit, unsigned variables,
                           ab_number *number, char *why, size_t why_size) {
    char trimmed[AB_FORMULA_TEXT + 1];
    text += strspn(text, " \t\n");
    size_t length = strlen(text);
    while (length > 0 && strchr(" \t\n", text[length - 1]) != NULL) length--;
    number->expression = NULL;
    number->value = 0;
    if (length == 0) {
        snprintf(why, why_size, "the value is empty; write a number");
        return AB_BAD_INPUT;
    }
    if (length > AB_FORMULA_TEXT) {
        snprintf(why, why_size, "a value of %zu characters; the longest allowed is %d", length, AB_FORMULA_TEXT);
        return AB_BAD_INPUT;
    }
    for (size_t i = 0; i < length; i++) trimmed[i] = text[i] == '\n' || text[i] == '\t' ? ' ' : text[i];
    trimmed[length] = '\0';
    const ab_literal literal = ab_literal_read(trimmed, &number->value, why, why_size);
    if (literal != AB_LITERAL_NONE) return literal == AB_LITERAL_NUMBER ? AB_OK : AB_BAD_INPUT;
    const size_t digits = number_length(trimmed);
    const char *rest = trimmed + digits + strspn(trimmed + digits, " ");
    if (digits > 0 && trimmed[digits] == ' ' && may_begin_unit(rest)) { /* "20 MPa" */
        if (checked(trimmed, digits, &number->value, why, why_size) != AB_LITERAL_NUMBER) return AB_BAD_INPUT;
        return with_unit(units, rest, unit, number, why, why_size);
    }
    const ab_status status = ab_formulas_compile(formulas, trimmed, variables, number, why, why_size);
    if (status != AB_BAD_INPUT) return status;
    if (digits > 0 && may_begin_unit(trimmed + digits) && ab_units_known(units, trimmed + digits)) {
        snprintf(why, why_size, "'%.64s': leave a blank between the number and its unit, as in \"%.*s %.32s\"", trimmed,
                 (int)(digits < 32 ? digits : 32), trimmed, trimmed + digits);
        return AB_BAD_INPUT;
    }
    ab_number split = {0, NULL, AB_NOWHERE};
    char reason[512];
    const ab_status other = split_formula(formulas, units, trimmed, unit, variables, &split, reason, sizeof reason);
    if (other == AB_MISSED) return status; /* the first reason stands */
    if (other == AB_OK) {
        number->value = split.value;
        number->expression = split.expression;
    } else {
        snprintf(why, why_size, "%s", reason);
    }
    return other;
}
