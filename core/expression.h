/* expression.h: numbers that may be formulas, by muParser. Variables are fixed when a formula is compiled. */
#ifndef AB_EXPRESSION_H
#define AB_EXPRESSION_H

#include "core/report.h"

typedef struct ab_expression ab_expression;

/* A number in a scene: a constant, or a formula of t, or of x and y. Evaluate on one thread only. */
typedef struct ab_number {
    double value;              /* the constant; for a formula its factor to SI (1 unless a unit stands behind it) */
    ab_expression *expression; /* NULL for a constant; owned by the scene */
    ab_mark mark;
} ab_number;

/* Value at time t (s) and place x, y, z (m). A formula that does not know a variable ignores it. NaN is possible: callers that cannot
 * live with it check. */
double ab_number_at(const ab_number *number, double t, double x, double y, double z);
/* The same for what has moved: now at x, y, at the start at X, Y (m, as drawn). */
double ab_number_of(const ab_number *number, double t, const double now[2], const double start[2]);
/* A value just found that is no finite number stops the run, with the name of the formula (printf), the time, the place (m, as drawn; NULL: none)
 * and the value. At t = 0, before the first step, it is a mistake in the scene: AB_BAD_INPUT at its mark; later AB_FAILED. */
ab_status ab_number_finite(const ab_number *number, double value, double t, const double place[2], ab_report *report, const char *name, ...)
    __attribute__((format(printf, 6, 7)));
static inline bool ab_number_is_constant(const ab_number *number) { return number->expression == NULL; }

/* Variables that a formula may use. */
enum ab_variables {
    AB_NO_VARIABLE = 0,
    AB_VARIABLE_T = 1,
    AB_VARIABLE_X = 2,
    AB_VARIABLE_Y = 4,
    AB_VARIABLES_XY = 6,
    AB_VARIABLES_TXY = 7,
    AB_VARIABLES_START = 48,   /* X, Y: the place at the start */
    AB_VARIABLES_T_START = 49, /* of what is followed from its start */
    AB_VARIABLES_MOTION = 55   /* t, x, y, X, Y */
};
/* Those that this one uses. */
unsigned ab_number_variables(const ab_number *number);

enum ab_formula_limits {
    AB_FORMULA_TEXT = 2000,
    AB_FORMULA_NAME = 64,
    AB_FORMULA_CONSTANTS = 256,
    AB_FORMULA_COUNT = 1000,
    AB_FORMULA_WORK = 2000000
};

/* The constants of a scene and every formula compiled with them. pi and e are there from the start. */
typedef struct ab_formulas ab_formulas;

ab_formulas *ab_formulas_create(void); /* NULL: no memory */
void ab_formulas_destroy(ab_formulas *formulas);

/* True when AB_FORMULA_WORK is spent: every further formula is refused. */
bool ab_formulas_exhausted(const ab_formulas *formulas);

/* True when a constant may have this name; else `why` says what is wrong. */
bool ab_formulas_name_ok(const ab_formulas *formulas, const char *name, char *why, size_t why_size);
/* Adds a constant. The name must be ok. */
ab_status ab_formulas_define(ab_formulas *formulas, const char *name, double value);

/* Compiles a formula. `number` becomes a constant when no variable is used in it. On AB_BAD_INPUT `why` has the cause and the remedy,
 * without the place. A constant that is not finite is refused. A scene may spend AB_FORMULA_WORK characters on formulas in all, aliases
 * written out, so that a hostile file cannot take hours. */
ab_status ab_formulas_compile(ab_formulas *formulas, const char *text, unsigned variables, ab_number *number, char *why, size_t why_size);

#endif
