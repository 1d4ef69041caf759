/* vocabulary.h: words that the scene reader checks and that other rooms give a meaning: monitor values, norms, columns, fields. */
#ifndef AB_VOCABULARY_H
#define AB_VOCABULARY_H

#include <stdbool.h>
#include <stddef.h>

typedef struct ab_word {
    const char *name, *unit, *help;
} ab_word;

typedef struct ab_words {
    const ab_word *word;
    size_t count;
} ab_words;

extern const ab_words ab_words_body_values;     /* monitor values of a body */
extern const ab_words ab_words_contact_values;  /* monitor values of a contact */
extern const ab_words ab_words_boundary_values; /* monitor values of a boundary */
extern const ab_words ab_words_scene_values;    /* monitor values of the whole scene */
extern const ab_words ab_words_over;            /* how a body's points become one number */
extern const ab_words ab_words_norms;           /* unit: "" the monitor's own, "s" a time, "*s" own times s, "/s" own by s */
extern const ab_words
    ab_words_columns;                  /* ledger columns of history.csv; also as BODY.column, but for those that ab_column_is_total names */
extern const ab_words ab_words_fields; /* output fields that every material-point body has */

/* Names of a field's components: `names` where it has any, else those that a quantity of that many has in a plane. */
const char *ab_component_names(const char *names, int components);

const ab_word *ab_words_find(const ab_words *words, const char *name);
/* Columns there is only one of (t, step, dt, remainder). */
bool ab_column_is_total(const char *name);
/* Norms that need `level`. */
bool ab_norm_needs_level(const char *name);
/* Body values that are averages over points, so that `over` and `at` have a meaning. */
bool ab_value_is_of_points(const char *name);

#endif
