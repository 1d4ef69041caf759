/* guard.h: looks over a plugin's shoulder: hands it copies of the host's arrays, inputs read-only and every array ending where memory ends, and looks at what it
 * wrote before the host takes it. For `checked: true` of a scene and for `abut plugins check`. What a correct plugin returns is passed on bit by bit. */
#ifndef AB_GUARD_H
#define AB_GUARD_H

#include "core/plugin_host.h"

typedef enum ab_promise { /* of abut_plugin.h */
                          AB_PROMISE_NONE = 0,
                          AB_PROMISE_CRASH,       /* every call returns */
                          AB_PROMISE_OLD,         /* what is handed in is not written */
                          AB_PROMISE_ARRAYS,      /* nothing outside of the items is touched */
                          AB_PROMISE_FINITE,      /* finite numbers in, finite numbers out, for every item */
                          AB_PROMISE_DISSIPATION, /* what is lost is not negative */
                          AB_PROMISE_MOMENTUM,    /* what one body gets the other gives: weights that sum to 1, unit normals */
                          AB_PROMISES
} ab_promise;
const char *ab_promise_name(ab_promise);

/* ---- memory with an end ---- */

enum { AB_GUARDED_MOST = 40 };

typedef struct
    ab_guarded { /* one array: its last byte is the last of its pages, and the next page is nobody's; so is the one before the first */
    const char *name;
    char *own, *shown; /* mappings of the same pages: the host's, and the plugin's (read-only for inputs); first usable byte */
    size_t room, bytes;
} ab_guarded;

typedef struct ab_guard_set {
    ab_guarded array[AB_GUARDED_MOST];
    size_t count;
    struct ab_guard_set *next;         /* for whoever keeps spare sets */
    const struct ab_guard_set *beside; /* more arrays of the same call */
} ab_guard_set;

/* Array number k of the set with exactly `bytes`, which is zero or more; `input`: read-only for the plugin. *shown is the plugin's pointer; returns the host's,
 * NULL without memory. What was there before is lost. `name` is borrowed. */
void *ab_guard_room(ab_guard_set *, size_t k, const char *name, size_t bytes, bool input, void *shown);
/* NULL, or the name of an array that was written in front of. After a call; the host's pages before the array hold a pattern. */
const char *ab_guard_underrun(const ab_guard_set *);
void ab_guard_set_clear(ab_guard_set *);

typedef struct ab_fault {
    ab_promise promise;
    char text[200];
} ab_fault;

/* Calls call(data) with signals of bad memory and bad arithmetic caught: false with the reason where it did not come back. Several threads may. */
bool ab_guard_call(const ab_guard_set *, int (*call)(void *), void *data, int *code, ab_fault *);

/* ---- classes with guards ---- */

/* A class that behaves as `inner` does, under guard: *outer keeps a pointer to it. Its create takes the host of an ab_service whose `guarded` is inner; a broken
 * promise is said by host->message and returned as a negative code. */
void ab_guard_class(const ab_loaded_class *inner, ab_loaded_class *outer);

/* For `abut plugins check`: the last promise that an instance of a guarded class broke. */
ab_promise ab_guard_broken(const void *self);

/* ---- between guard*.c ---- */

typedef struct ab_guard { /* an instance of a guarded class */
    const ab_loaded_class *inner;
    void *self;
    ab_service *service; /* of the outer instance */
    ab_host host;        /* what the plugin sees; its context is this guard */
    ab_guard_set *spare; /* one per thread that is in a call now */
    atomic_flag busy;    /* while the list is changed */
    ab_promise broken;
    void *finding; /* finders: the call under way */
    /* responses are asked for one point after the other: what was shown last is still there, and only the points in question are shown anew */
    ab_guard_set *points_set;
    ab_points points_shown;
    const ab_points *points_of;
    size_t points_next; /* where the call after the last one would go on */
} ab_guard;

ab_guard_set *ab_guard_take(ab_guard *); /* NULL: no memory */
void ab_guard_give(ab_guard *, ab_guard_set *);
/* Says it through the host's message; returns the negative code. */
int ab_guard_break(ab_guard *, ab_promise, const char *format, ...) __attribute__((format(printf, 3, 4)));
int ab_guard_state_rows(const ab_class *, uint32_t dimension);

/* -1, with the reason said. */
int ab_guard_no_memory(ab_guard *);
/* A copy of `bytes` that the plugin may read; *array, NULL or the host's, becomes it. */
bool ab_guard_show(ab_guard_set *, size_t k, const char *name, void *array, size_t bytes);
/* Rows of which `count` items are known, shown with an ld of just that. */
bool ab_guard_show_rows(ab_guard_set *, size_t k, const char *name, const double **array, size_t rows, size_t count, size_t ld);

#define AB_GUARD_POISON 0x7ff8dead0badf00du /* a NaN that no arithmetic makes: not written yet */
double ab_guard_poison(void);
bool ab_guard_poisoned(double);

int ab_guard_update(void *self, ab_batch *);
int ab_guard_start(void *self, ab_batch *);
int ab_guard_find(void *self, const ab_trace *a, const ab_trace *b, ab_points *out);
int ab_guard_respond(void *self, ab_points *points, size_t first, size_t count);
int ab_guard_apply(void *self, ab_edges *);
int ab_guard_reserve(void *context, ab_points *points, size_t points_more, size_t stencil_more);

#endif
