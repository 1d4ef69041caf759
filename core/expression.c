/* expression.c: formulas of constants and variables through muParser's C interface.
 *
 * One parser is kept as a workbench: every text is compiled there first, which finds mistakes and the variables in use; only formulas that do
 * use a variable get a parser of their own. muParser reports through a callback; ours does nothing, and mupError is asked after each call. */
#include "core/expression.h"

#include <ctype.h>
#include <math.h>
#include <muParserDLL.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "core/suggest.h"

struct ab_expression {
    muParserHandle_t parser;
    double variable[6]; /* t, x, y, z, X, Y */
    unsigned used;      /* of them: enum ab_variables */
};

typedef struct constant {
    char name[AB_FORMULA_NAME + 1];
    double value;
} constant;

struct ab_formulas {
    ab_expression bench;
    constant constants[AB_FORMULA_CONSTANTS];
    size_t constant_count;
    ab_expression *expressions[AB_FORMULA_COUNT];
    size_t expression_count;
    long work; /* spent so far, in characters */
};

static const char *const functions[] = {"sin",   "cos",   "tan",   "asin",  "acos", "atan",  "sinh", "cosh", "tanh",
                                        "asinh", "acosh", "atanh", "atan2", "log2", "log10", "log",  "ln",   "exp",
                                        "sqrt",  "sign",  "rint",  "abs",   "sum",  "avg",   "min",  "max"};
static const char *const variables_all[] = {"t", "x", "y", "z", "X", "Y"}; /* bit k of enum ab_variables */
static const char *const words[] = {"true", "false", "yes", "no", "on", "off", "null", "inf", "nan", "infinity", "_pi", "_e"};

enum { WORK_EACH = 40, WORK_MISTAKE = 5000 }; /* what a formula and a mistake cost besides their characters */

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static bool among(const char *name, const char *const *names, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (strcmp(name, names[i]) == 0) return true;
    return false;
}

static void stay_calm(muParserHandle_t parser) { (void)parser; }

/* A parser that knows the constants so far and the variables. */
static bool open_parser(const ab_formulas *formulas, ab_expression *expression) {
    expression->parser = mupCreate(muBASETYPE_FLOAT);
    if (expression->parser == NULL) return false;
    mupSetErrorHandler(expression->parser, stay_calm);
    for (size_t i = 0; i < COUNT(variables_all); i++) mupDefineVar(expression->parser, variables_all[i], &expression->variable[i]);
    for (size_t i = 0; i < formulas->constant_count; i++)
        mupDefineConst(expression->parser, formulas->constants[i].name, formulas->constants[i].value);
    return !mupError(expression->parser);
}

ab_formulas *ab_formulas_create(void) {
    ab_formulas *formulas = calloc(1, sizeof *formulas);
    if (formulas == NULL) return NULL;
    formulas->constants[0] = (constant){"pi", 3.14159265358979323846};
    formulas->constants[1] = (constant){"e", 2.71828182845904523536};
    formulas->constant_count = 2;
    if (!open_parser(formulas, &formulas->bench)) {
        ab_formulas_destroy(formulas);
        return NULL;
    }
    return formulas;
}

void ab_formulas_destroy(ab_formulas *formulas) {
    if (formulas == NULL) return;
    for (size_t i = 0; i < formulas->expression_count; i++) {
        mupRelease(formulas->expressions[i]->parser);
        free(formulas->expressions[i]);
    }
    if (formulas->bench.parser != NULL) mupRelease(formulas->bench.parser);
    free(formulas);
}

bool ab_formulas_exhausted(const ab_formulas *formulas) { return formulas->work > AB_FORMULA_WORK; }

bool ab_formulas_name_ok(const ab_formulas *formulas, const char *name, char *why, size_t why_size) {
    why[0] = '\0';
    if (strlen(name) > AB_FORMULA_NAME) {
        snprintf(why, why_size, "the name has more than %d characters", AB_FORMULA_NAME);
    } else if (!(isalpha((unsigned char)name[0]) || name[0] == '_') ||
               name[strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_")] != '\0') {
        snprintf(why, why_size, "a constant's name has letters, digits and '_' only and does not begin with a digit");
    } else if (among(name, variables_all, COUNT(variables_all))) {
        snprintf(why, why_size, "'%s' is a variable of formulas; choose another name", name);
    } else if (among(name, functions, COUNT(functions))) {
        snprintf(why, why_size, "'%s' is a function; choose another name", name);
    } else if (among(name, words, COUNT(words)) || strcmp(name, "pi") == 0 || strcmp(name, "e") == 0) {
        snprintf(why, why_size, "'%s' has a meaning already; choose another name", name);
    } else if (formulas->constant_count == AB_FORMULA_CONSTANTS) {
        snprintf(why, why_size, "more than %d constants", AB_FORMULA_CONSTANTS - 2);
    }
    return why[0] == '\0';
}

ab_status ab_formulas_define(ab_formulas *formulas, const char *name, double value) {
    if (formulas->constant_count == AB_FORMULA_CONSTANTS || strlen(name) > AB_FORMULA_NAME) return AB_BAD_INPUT;
    constant *c = &formulas->constants[formulas->constant_count++];
    strcpy(c->name, name);
    c->value = value;
    mupDefineConst(formulas->bench.parser, name, value);
    return mupError(formulas->bench.parser) ? AB_BAD_INPUT : AB_OK;
}

/* Names that a text may use here, for suggestions. */
static size_t known_names(const ab_formulas *formulas, unsigned variables, const char **names) {
    size_t count = 0;
    for (size_t i = 0; i < COUNT(variables_all); i++)
        if (variables & (1u << i)) names[count++] = variables_all[i];
    for (size_t i = formulas->constant_count; i > 0; i--) names[count++] = formulas->constants[i - 1].name;
    for (size_t i = 0; i < COUNT(functions); i++) names[count++] = functions[i];
    return count;
}

static const char *here(unsigned variables) {
    if (variables == AB_VARIABLE_T) return "only t (time, s) and constants are known here";
    if (variables == AB_VARIABLES_XY) return "only x, y (m) and constants are known here";
    if (variables == AB_VARIABLES_T_START) return "only t, X, Y (m, the place at the start) and constants are known here";
    if (variables == AB_VARIABLES_MOTION) return "only t, x, y (m, now), X, Y (m, at the start) and constants are known here";
    return variables == AB_NO_VARIABLE ? "only constants are known here" : "only t, x, y and constants are known here";
}

static ab_status explain(ab_formulas *formulas, unsigned variables, char *why, size_t size) {
    muParserHandle_t parser = formulas->bench.parser;
    formulas->work += WORK_MISTAKE;
    const char *message = mupGetErrorMsg(parser);
    char token[AB_FORMULA_NAME + 1] = "", text[300], tail[1024];
    snprintf(text, sizeof text, "%.*s", (int)sizeof text - 1, message == NULL ? "not a formula" : message);
    for (size_t n = strlen(text); n > 0 && (text[n - 1] == '.' || text[n - 1] == ' '); n--) text[n - 1] = '\0';
    const char *found = mupGetErrorToken(parser);
    if (found != NULL) snprintf(token, sizeof token, "%.*s", AB_FORMULA_NAME, found);
    const size_t letters = strspn(token, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_");
    if (letters > 0 && token[letters] == '\0' && !isdigit((unsigned char)token[0]) && !among(token, functions, COUNT(functions)) &&
        strstr(text, "nexpected token") != NULL) {
        const char *names[AB_FORMULA_CONSTANTS + COUNT(functions) + COUNT(variables_all)];
        const size_t count = known_names(formulas, variables, names);
        const char *nearest = ab_suggest(token, names, count);
        if (nearest != NULL && strcmp(nearest, token) != 0)
            snprintf(tail, sizeof tail, "; did you mean '%s'?", nearest);
        else
            snprintf(tail, sizeof tail, "; %s", here(variables));
        snprintf(why, size, "unknown name '%s'%s", token, tail);
    } else {
        snprintf(why, size, "not a formula: %s", text);
    }
    return AB_BAD_INPUT;
}

/* '=' would assign to a variable, quotes would make a text: neither belongs in a number. */
static bool has_assignment(const char *text) {
    for (const char *c = text; *c != '\0'; c++) {
        if (*c != '=') continue;
        if (c[1] == '=')
            c++;
        else if (c == text || strchr("<>!", c[-1]) == NULL)
            return true;
    }
    return false;
}

static ab_status own_parser(ab_formulas *formulas, const char *text, unsigned used, ab_number *number, char *why, size_t size) {
    if (formulas->expression_count == AB_FORMULA_COUNT) {
        snprintf(why, size, "more than %d formulas in one scene", AB_FORMULA_COUNT);
        return AB_BAD_INPUT;
    }
    ab_expression *own = calloc(1, sizeof *own);
    if (own == NULL || !open_parser(formulas, own)) {
        free(own);
        snprintf(why, size, "no memory left for a formula");
        return AB_FAILED;
    }
    mupSetExpr(own->parser, text);
    own->used = used;
    formulas->expressions[formulas->expression_count++] = own;
    number->value = 1;
    number->expression = own;
    return AB_OK;
}

ab_status ab_formulas_compile(ab_formulas *formulas, const char *text, unsigned variables, ab_number *number, char *why, size_t why_size) {
    number->value = 0;
    number->expression = NULL;
    if (text[strspn(text, " \t\r\n")] == '\0') {
        snprintf(why, why_size, "the formula is empty");
        return AB_BAD_INPUT;
    }
    if (strlen(text) > AB_FORMULA_TEXT) {
        snprintf(why, why_size, "the formula has %zu characters; the longest allowed is %d", strlen(text), AB_FORMULA_TEXT);
        return AB_BAD_INPUT;
    }
    if (has_assignment(text) || strchr(text, '"') != NULL) {
        snprintf(why, why_size, "a formula gives one number; '=' and quotes have no place in it (compare with ==)");
        return AB_BAD_INPUT;
    }
    formulas->work += WORK_EACH + (long)strlen(text);
    if (ab_formulas_exhausted(formulas)) {
        snprintf(why, why_size, "there are too many formulas in this scene, or too many mistakes in them");
        return AB_BAD_INPUT;
    }
    muParserHandle_t bench = formulas->bench.parser;
    (void)mupError(bench); /* forget an older mistake */
    for (size_t i = 0; i < COUNT(variables_all); i++) formulas->bench.variable[i] = 0;
    mupSetExpr(bench, text);
    if (mupError(bench)) return explain(formulas, variables, why, why_size);
    int results = 0;
    const double *values = mupEvalMulti(bench, &results);
    if (mupError(bench) || values == NULL) return explain(formulas, variables, why, why_size);
    if (results != 1) {
        snprintf(why, why_size, "gives %d numbers where one is needed; write a list as [a, b], and 1.5 with a point", results);
        return AB_BAD_INPUT;
    }
    const double value = values[0];
    const int used = mupGetExprVarNum(bench);
    if (mupError(bench)) return explain(formulas, variables, why, why_size);
    unsigned found = 0;
    for (int i = 0; i < used; i++) {
        const char *name = NULL;
        double *address = NULL;
        mupGetExprVar(bench, (unsigned)i, &name, &address);
        for (size_t k = 0; k < COUNT(variables_all) && name != NULL; k++)
            if (strcmp(name, variables_all[k]) == 0) found |= 1u << k;
    }
    if (found & ~variables) {
        unsigned first = 0;
        while (!((found & ~variables) & (1u << first))) first++;
        snprintf(why, why_size, "'%s' cannot be used in this value; %s", variables_all[first], here(variables));
        return AB_BAD_INPUT;
    }
    if (found != 0) return own_parser(formulas, text, found, number, why, why_size);
    if (!isfinite(value)) {
        snprintf(why, why_size, "'%.64s' is %s, not a finite number", text, isnan(value) ? "nan (undefined)" : "infinite");
        return AB_BAD_INPUT;
    }
    number->value = value;
    return AB_OK;
}

unsigned ab_number_variables(const ab_number *number) { return number->expression == NULL ? AB_NO_VARIABLE : number->expression->used; }

static double evaluate(const ab_number *number) {
    const double value = mupEval(number->expression->parser);
    return mupError(number->expression->parser) ? NAN : number->value * value;
}

double ab_number_at(const ab_number *number, double t, double x, double y, double z) {
    if (number->expression == NULL) return number->value;
    ab_expression *expression = number->expression;
    expression->variable[0] = t;
    expression->variable[1] = x;
    expression->variable[2] = y;
    expression->variable[3] = z;
    return evaluate(number);
}

double ab_number_of(const ab_number *number, double t, const double now[2], const double start[2]) {
    if (number->expression == NULL) return number->value;
    double *variable = number->expression->variable;
    variable[0] = t;
    for (int c = 0; c < 2; ++c) variable[1 + c] = now[c], variable[4 + c] = start[c];
    return evaluate(number);
}

ab_status ab_number_finite(const ab_number *number, double value, double t, const double place[2], ab_report *report, const char *name,
                           ...) {
    if (isfinite(value)) return AB_OK;
    char formula[AB_FORMULA_TEXT / 8], where[80] = "";
    va_list arguments;
    va_start(arguments, name);
    vsnprintf(formula, sizeof formula, name, arguments);
    va_end(arguments);
    if (place != NULL) snprintf(where, sizeof where, " at (%.6g, %.6g) m", place[0], place[1]);
    static const char remedy[] = "which is no finite number; write a formula that has a value there, if need be with (condition ? a : b)";
    const char *shown = isnan(value) ? "nan" : value > 0.0 ? "inf" : "-inf"; /* a library may write -nan */
    if (t > 0.0) return ab_report_failure(report, "%s is %s at t = %.9g s%s, %s", formula, shown, t, where, remedy);
    return ab_report_error(report, number->mark, "%s is %s at t = 0 s%s, %s", formula, shown, where, remedy);
}
