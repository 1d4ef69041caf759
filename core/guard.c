/* guard.c: memory with an end, calls that come back, and the instance that stands before a plugin's. */
#define _GNU_SOURCE
#include "core/guard.h"

#include <pthread.h>
#include <omp.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { PATTERN = 0xa5 };

const char *ab_promise_name(ab_promise promise) {
    static const char *const names[AB_PROMISES] = {"none",
                                                   "every call returns",
                                                   "what is handed in is not written",
                                                   "arrays are not overrun",
                                                   "finite",
                                                   "dissipation not negative",
                                                   "momentum is kept"};
    return promise < AB_PROMISES ? names[promise] : "?";
}

/* ---- memory with an end ---------------------------------------------------------------------------------------------------------- */

static size_t page_size(void) { return (size_t)sysconf(_SC_PAGESIZE); }

static void unmap(ab_guarded *g) {
    const size_t page = page_size();
    if (g->own) munmap(g->own - page, g->room + 2 * page);
    if (g->shown && g->shown != g->own) munmap(g->shown - page, g->room + 2 * page);
    g->own = g->shown = NULL;
    g->room = 0;
}

/* Pages of `file` (or -1) with a page that nobody may touch on both sides; NULL without memory. */
static char *map(size_t room, int file, int protection) {
    const size_t page = page_size();
    char *all = mmap(NULL, room + 2 * page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (all == MAP_FAILED) return NULL;
    const int how = file < 0 ? MAP_PRIVATE | MAP_ANONYMOUS : MAP_SHARED;
    if (mmap(all + page, room, protection, how | MAP_FIXED, file, 0) == MAP_FAILED) {
        munmap(all, room + 2 * page);
        return NULL;
    }
    return all + page;
}

static bool map_input(ab_guarded *g, size_t room) {
    const int file = memfd_create("abut-guard", MFD_CLOEXEC);
    if (file < 0) return false;
    if (ftruncate(file, (off_t)room) == 0) {
        g->own = map(room, file, PROT_READ | PROT_WRITE);
        g->shown = g->own ? map(room, file, PROT_READ) : NULL;
    }
    close(file); /* the mappings keep it */
    return g->shown != NULL;
}

void *ab_guard_room(ab_guard_set *set, size_t k, const char *name, size_t bytes, bool input, void *shown) {
    ab_guarded *g = set->array + k;
    if (k >= AB_GUARDED_MOST) return NULL;
    if (k >= set->count) set->count = k + 1;
    const bool was_input = g->shown != g->own;
    if (bytes > g->room || !g->own || was_input != input) {
        const size_t page = page_size(), wanted = (bytes + bytes / 2 + page) / page * page;
        unmap(g);
        if (input) {
            if (!map_input(g, wanted)) return unmap(g), NULL;
        } else {
            g->own = g->shown = map(wanted, -1, PROT_READ | PROT_WRITE);
            if (!g->own) return NULL;
        }
        g->room = wanted;
        memset(g->own, PATTERN, wanted);
    } else if (bytes < g->bytes) {
        memset(g->own, PATTERN, g->room - bytes);
    }
    g->name = name;
    g->bytes = bytes;
    *(void **)shown = g->shown + (g->room - bytes);
    return g->own + (g->room - bytes);
}

const char *ab_guard_underrun(const ab_guard_set *set) {
    for (size_t k = 0; k < set->count; k++) {
        const ab_guarded *g = set->array + k;
        if (!g->own || g->shown != g->own) continue;
        for (size_t i = 0; i < g->room - g->bytes; i++)
            if ((unsigned char)g->own[i] != PATTERN) return g->name;
    }
    return NULL;
}

void ab_guard_set_clear(ab_guard_set *set) {
    for (size_t k = 0; k < AB_GUARDED_MOST; k++) unmap(set->array + k);
    set->count = 0;
}

/* ---- calls that come back -------------------------------------------------------------------------------------------------------- */

static _Thread_local struct {
    sigjmp_buf back;
    volatile sig_atomic_t active;
    int signal;
    const char *address;
} now;

static void on_fault(int number, siginfo_t *info, void *context) {
    (void)context;
    if (!now.active) { /* not a plugin's: let it die of it */
        signal(number, SIG_DFL);
        raise(number);
        return;
    }
    now.active = 0;
    now.signal = number;
    now.address = info->si_addr;
    siglongjmp(now.back, 1);
}

static void catch_faults(void) {
    static const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL};
    struct sigaction action = {.sa_sigaction = on_fault, .sa_flags = SA_SIGINFO | SA_NODEFER | SA_ONSTACK};
    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) sigaction(faults[k], &action, NULL);
}

static void describe(const ab_guard_set *set, ab_fault *fault) {
    const char *const word = now.signal == SIGFPE   ? "a division by zero of integers (SIGFPE)"
                             : now.signal == SIGILL ? "an instruction that this machine does not have (SIGILL)"
                             : now.signal == SIGBUS ? "a crash (SIGBUS)"
                                                    : "a crash (SIGSEGV: it touched memory that is not its own)";
    fault->promise = AB_PROMISE_CRASH;
    snprintf(fault->text, sizeof fault->text, "%s", word);
    if (now.signal != SIGSEGV && now.signal != SIGBUS) return;
    const size_t page = page_size();
    for (size_t k = 0; set; k++) {
        if (k >= set->count) {
            k = SIZE_MAX; /* 0 in the next round */
            set = set->beside;
            continue;
        }
        const ab_guarded *g = set->array + k;
        if (!g->own) continue;
        if (g->shown != g->own && now.address >= g->shown && now.address < g->shown + g->room) {
            fault->promise = AB_PROMISE_OLD;
            snprintf(fault->text, sizeof fault->text, "it wrote into %s, which is the host's and read only, at byte %td of %zu", g->name,
                     now.address - (g->shown + (g->room - g->bytes)), g->bytes);
        } else if (now.address >= g->shown + g->room && now.address < g->shown + g->room + page) {
            fault->promise = AB_PROMISE_ARRAYS;
            snprintf(fault->text, sizeof fault->text, "it went %td bytes behind the end of %s, which has %zu",
                     now.address - (g->shown + g->room), g->name, g->bytes);
        } else if (now.address >= g->shown - page && now.address < g->shown) {
            fault->promise = AB_PROMISE_ARRAYS;
            snprintf(fault->text, sizeof fault->text, "it went %td bytes before the start of %s",
                     g->shown + (g->room - g->bytes) - now.address, g->name);
        }
    }
}

bool ab_guard_call(const ab_guard_set *set, int (*call)(void *), void *data, int *code, ab_fault *fault) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, catch_faults);
    const int threads = omp_get_max_threads(); /* a loop that the plugin shares out stays on this thread, the only one that can come back */
    omp_set_num_threads(1);
    if (sigsetjmp(now.back, 0)) {
        omp_set_num_threads(threads);
        describe(set, fault);
        return false;
    }
    now.active = 1;
    *code = call(data);
    now.active = 0;
    omp_set_num_threads(threads);
    return true;
}

/* ---- instances ------------------------------------------------------------------------------------------------------------------- */

double ab_guard_poison(void) {
    const uint64_t bits = AB_GUARD_POISON;
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

bool ab_guard_poisoned(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits == AB_GUARD_POISON;
}

static void lock(ab_guard *guard) {
    while (atomic_flag_test_and_set_explicit(&guard->busy, memory_order_acquire)) {}
}
static void unlock(ab_guard *guard) { atomic_flag_clear_explicit(&guard->busy, memory_order_release); }

ab_guard_set *ab_guard_take(ab_guard *guard) {
    lock(guard);
    ab_guard_set *set = guard->spare;
    if (set) guard->spare = set->next;
    unlock(guard);
    if (set) set->beside = NULL;
    return set ? set : calloc(1, sizeof *set);
}

void ab_guard_give(ab_guard *guard, ab_guard_set *set) {
    lock(guard);
    set->next = guard->spare;
    guard->spare = set;
    unlock(guard);
}

int ab_guard_break(ab_guard *guard, ab_promise promise, const char *format, ...) {
    char text[512];
    int used = snprintf(text, sizeof text, "plugin '%s' (%.160s) breaks a promise, \"%s\": ", guard->inner->class_.name, guard->inner->path,
                        ab_promise_name(promise));
    va_list arguments;
    va_start(arguments, format);
    if (used > 0 && (size_t)used < sizeof text) vsnprintf(text + used, sizeof text - (size_t)used, format, arguments);
    va_end(arguments);
    guard->broken = promise;
    guard->service->host.message(guard->service->host.context, text);
    return -1;
}

int ab_guard_state_rows(const ab_class *class_, uint32_t dimension) {
    int rows = 0;
    for (uint32_t s = 0; s < class_->nstate; s++) {
        const uint32_t shape = class_->state[s].shape;
        rows += shape == AB_SCALAR      ? 1
                : shape == AB_VECTOR    ? (int)dimension
                : shape == AB_SYMMETRIC ? (dimension == 2 ? 4 : 6)
                : dimension == 2        ? 5
                                        : 9;
    }
    return rows;
}

ab_promise ab_guard_broken(const void *self) { return ((const ab_guard *)self)->broken; }

/* ---- what a plugin is shown ---- */

int ab_guard_no_memory(ab_guard *guard) {
    guard->host.message(guard, "no memory for guarded arrays (checked: true)");
    return -1;
}

/* A copy of `bytes` that the plugin may read; *array is NULL or the host's. */
bool ab_guard_show(ab_guard_set *set, size_t k, const char *name, void *array_pointer, size_t bytes) {
    const void **array = array_pointer;
    if (!*array) return true;
    const void *host = *array;
    void *own = ab_guard_room(set, k, name, bytes, true, array);
    if (!own) return false;
    memcpy(own, host, bytes);
    return true;
}

/* Rows of which `count` items are known, shown with an ld of just that. */
bool ab_guard_show_rows(ab_guard_set *set, size_t k, const char *name, const double **array, size_t rows, size_t count, size_t ld) {
    if (!*array) return true;
    const double *host = *array;
    double *own = ab_guard_room(set, k, name, rows * count * sizeof(double), true, array);
    for (size_t r = 0; own && r < rows; r++) memcpy(own + r * count, host + r * ld, count * sizeof(double));
    return own != NULL;
}

/* ---- its host ---- */

static void *allocate(void *context, size_t bytes) {
    const ab_host *host = &((ab_guard *)context)->service->host;
    return host->allocate(host->context, bytes);
}
static void release(void *context, void *pointer) {
    const ab_host *host = &((ab_guard *)context)->service->host;
    host->release(host->context, pointer);
}
static void message(void *context, const char *text) {
    const ab_host *host = &((ab_guard *)context)->service->host;
    host->message(host->context, text);
}
static void say(void *context, const char *text) {
    const ab_host *host = &((ab_guard *)context)->service->host;
    host->log(host->context, text);
}

static int create(const ab_host *outer, const ab_value *settings, void **self) {
    ab_service *service = outer->context;
    ab_guard *guard = calloc(1, sizeof *guard);
    if (!guard) return outer->message(outer->context, "no memory for its guard (checked: true)"), -1;
    guard->inner = service->guarded;
    guard->service = service;
    atomic_flag_clear(&guard->busy);
    guard->host = *outer;
    guard->host.context = guard;
    guard->host.allocate = allocate, guard->host.release = release, guard->host.message = message, guard->host.log = say;
    if (outer->reserve) guard->host.reserve = ab_guard_reserve;
    const ab_class *class_ = &guard->inner->class_;
    const int code = class_->create ? class_->create(&guard->host, settings, &guard->self) : 0;
    if (code != 0) return free(guard), code;
    *self = guard;
    return 0;
}

static void destroy(void *self) {
    ab_guard *guard = self;
    if (guard->inner->class_.destroy) guard->inner->class_.destroy(guard->self);
    while (guard->spare) {
        ab_guard_set *next = guard->spare->next;
        ab_guard_set_clear(guard->spare);
        free(guard->spare);
        guard->spare = next;
    }
    if (guard->points_set) ab_guard_set_clear(guard->points_set), free(guard->points_set);
    free(guard);
}

static int save(void *self, const ab_stream *stream) {
    const ab_guard *guard = self;
    return guard->inner->class_.save(guard->self, stream);
}
static int load(void *self, const ab_stream *stream) {
    const ab_guard *guard = self;
    return guard->inner->class_.load(guard->self, stream);
}

void ab_guard_class(const ab_loaded_class *inner, ab_loaded_class *outer) {
    *outer = *inner;
    outer->guarded = inner;
    outer->class_.create = create;
    outer->class_.destroy = destroy;
    if (inner->class_.save) outer->class_.save = save, outer->class_.load = load;
    if (inner->material.update) outer->material.update = ab_guard_update;
    if (inner->material.start) outer->material.start = ab_guard_start;
    if (inner->boundary.apply) outer->boundary.apply = ab_guard_apply;
    if (inner->contact.find) outer->contact.find = ab_guard_find;
    if (inner->contact.respond) outer->contact.respond = ab_guard_respond;
}
