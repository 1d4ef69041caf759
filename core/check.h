/* check.h: `abut plugins check`: the promises of abut_plugin.h, tried one after the other, each in a process of its own. */
#ifndef AB_CHECK_H
#define AB_CHECK_H

#include "core/commands.h"
#include "core/guard.h"
#include "core/plugin_check.h"

enum { AB_CHECK_VARIANTS = 24, AB_CHECK_TABLE = 8 };

typedef enum ab_verdict { AB_VERDICT_NONE = 0, AB_VERDICT_KEPT, AB_VERDICT_BROKEN, AB_VERDICT_SKIPPED } ab_verdict;

typedef struct ab_check_shared { /* memory that the processes of a check have in common */
    ab_verdict verdict;
    char input[600]; /* what is being tried now */
    char why[900];
    char folder[4096]; /* of a small run; empty: none. Removed when the process has ended */
    size_t variants;
    ab_value settings[AB_CHECK_VARIANTS][AB_PARAMS_MAX]; /* that create takes; the first one is the plainest */
    double table[2 * AB_CHECK_TABLE];                    /* of every setting that is a table */
} ab_check_shared;

typedef struct ab_check {
    const ab_loaded_class *loaded;
    ab_check_shared *shared;
    const ab_command_line *line; /* --set KEY=VALUE; methods and contact, for finders */
    uint64_t random;
} ab_check;

typedef struct ab_check_promise {
    const char *name, *text;
    void (*keep)(ab_check *); /* returns where the promise is kept; else ab_check_fail */
    bool alone;               /* what follows means nothing where it is broken */
} ab_check_promise;

extern const ab_check_promise ab_check_material[], ab_check_response[], ab_check_finder[], ab_check_boundary[]; /* end with name NULL */
void ab_check_settings(ab_check *);
void ab_check_remove_folder(ab_check *);

/* In the process of one promise; neither returns. */
_Noreturn void ab_check_fail(ab_check *, const char *format, ...) __attribute__((format(printf, 2, 3)));
_Noreturn void ab_check_skip(ab_check *, const char *why);
/* What a report says when the next call does not come back. */
void ab_check_trying(ab_check *, const char *format, ...) __attribute__((format(printf, 2, 3)));

double ab_check_uniform(ab_check *, double low, double high);
void ab_check_unit_vector(ab_check *, uint32_t dimension, double *v);
/* "E = 1e+07, nu = 0.3" */
const char *ab_check_words(const ab_check *, const ab_value *settings, char *text, size_t size);

typedef struct ab_check_instance { /* of a class, with some settings */
    const ab_loaded_class *loaded;
    ab_service service;
    void *self;
} ab_check_instance;
/* False where create refused; the reason is in service.message. `guarded`: under guard (core/guard.h). */
bool ab_check_open(ab_check *, ab_check_instance *, const ab_value *settings, ab_loaded_class *guard);
void ab_check_close(ab_check_instance *);

#endif
