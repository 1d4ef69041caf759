/* schema.h: tables of keys. One table says what a section of a scene may hold; the same table checks a file and writes docs/scene.md. */
#ifndef AB_SCHEMA_H
#define AB_SCHEMA_H

#include "core/document.h"
#include "core/quantity.h"
#include "core/vocabulary.h"

typedef enum ab_key_type {
    AB_KEY_NUMBER = 1, /* one number, constants allowed */
    AB_KEY_INTEGER,
    AB_KEY_FLAG,    /* true | false */
    AB_KEY_WORD,    /* one of `words` */
    AB_KEY_NAME,    /* the name of something in the scene */
    AB_KEY_TEXT,    /* free text */
    AB_KEY_POINT,   /* [x, y] */
    AB_KEY_FORMULA, /* a number or a formula of `variables` */
    AB_KEY_VECTOR,  /* two of them */
    AB_KEY_SECTION, /* a mapping or list with a table of its own */
    AB_KEY_LATER    /* known, but not in this version: refused by name */
} ab_key_type;

enum ab_key_flags {
    AB_KEY_REQUIRED = 1,
    AB_KEY_MIN_OPEN = 2,
    AB_KEY_MAX_OPEN = 4,
    AB_KEY_RANGE = 8,
    AB_KEY_NULL = 16 /* null has a meaning: as if not written */
};

typedef struct ab_key {
    const char *name;
    ab_key_type type;
    unsigned flags;
    const char *unit;    /* SI; "1" for a pure number; NULL where it has no meaning */
    const char *initial; /* default as a scene would write it, in SI; NULL: none */
    const char *words;   /* AB_KEY_WORD: separated by '|'; a word behind '!' is known but not in this version */
    double min, max;     /* with AB_KEY_RANGE */
    unsigned variables;  /* formulas: enum ab_variables */
    const char *help;    /* AB_KEY_LATER: also what to do instead */
} ab_key;

typedef struct ab_section {
    const char *title, *help, *example; /* of docs/scene.md */
    const ab_key *keys;
    size_t count;
    const char *more; /* what further keys may stand here (settings of plugins), or NULL: none */
} ab_section;

typedef struct ab_file_read { /* a file that settings were read from, by its name in the scene */
    const char *name;
    struct ab_file_read *next;
} ab_file_read;

typedef struct ab_reader { /* what every check needs */
    ab_arena *arena;
    ab_formulas *formulas;
    ab_units *units;
    ab_report *report;
    const char *scene_path; /* files are looked for beside it */
    ab_file_read *files;    /* so far, the last one first */
    bool out_of_memory;
} ab_reader;

enum { AB_WHERE = 200, AB_TAIL = 1024 }; /* "contact[0].friction"; "; did you mean ..." */

/* Sorts the values of a mapping by the section's keys: values[k] is what was written for keys[k], or NULL. Says every unknown, later,
 * empty and missing key. `where` is the section's place for messages ("contact[0]"; "" for the top). False when node is not a mapping. */
bool ab_section_open(ab_reader *reader, const ab_section *section, const ab_node *node, const char *where, const ab_node **values);
/* The check of unknown keys alone, with further names that are known: for sections with settings of plugins. `swapped`: --set has named the plugin, so keys
 * of the file that only the plugin named there would know are warned of and left out. */
void ab_section_unknown(ab_reader *reader, const ab_section *section, const char *const *more, size_t more_count, bool swapped,
                        const ab_node *node, const char *where);

/* One value each. node NULL: the key's default, where it has one. False when nothing was read, or a mistake was reported; *value is then unchanged.
 * `where` is the section's place. */
bool ab_read_number(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, double *value);
bool ab_read_integer(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, long *value);
bool ab_read_flag(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, bool *value);
bool ab_read_word(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, char **value);
bool ab_read_text(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, char **value);
bool ab_read_point(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, double value[2]);
bool ab_read_formula(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, ab_number *value);
bool ab_read_vector(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, ab_number value[2]);
/* Names of bodies, materials, monitors: letters, digits, '_' and '-', not beginning with a digit. */
bool ab_name_ok(ab_reader *reader, const char *what, const char *name, ab_mark mark);

/* "where.key" in a buffer of AB_WHERE characters; for messages. */
const char *ab_where_join(char *buffer, const char *where, const char *key);
void *ab_reader_take(ab_reader *reader, size_t count, size_t size); /* zeroed; NULL sets out_of_memory */
char *ab_reader_text(ab_reader *reader, const char *text);

#endif
