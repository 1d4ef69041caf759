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
static inline bool ab_number_is_constant(const ab_number *number) { return number->expression == NULL; }

#endif
