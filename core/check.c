/* check.c: `abut plugins check FILE.so|NAME`: which classes, one process per promise with limits of time and memory, and the report. */
#include "core/check.h"

#include <math.h>
#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/plugin_load.h"

enum { SECONDS = 3, WALL_SECONDS = 120, MEMORY = 1 << 30 };
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define UNLIMITED 1 /* their shadows are larger than any limit */
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define UNLIMITED 1
#endif
#endif
#ifndef UNLIMITED
#define UNLIMITED 0
#endif

/* ---- in the process of a promise -------------------------------------------------------------------------------------------------- */

_Noreturn void ab_check_fail(ab_check *check, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(check->shared->why, sizeof check->shared->why, format, arguments);
    va_end(arguments);
    check->shared->verdict = AB_VERDICT_BROKEN;
    _exit(0);
}

_Noreturn void ab_check_skip(ab_check *check, const char *why) {
    snprintf(check->shared->why, sizeof check->shared->why, "%s", why);
    check->shared->verdict = AB_VERDICT_SKIPPED;
    _exit(0);
}

void ab_check_trying(ab_check *check, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(check->shared->input, sizeof check->shared->input, format, arguments);
    va_end(arguments);
}

double ab_check_uniform(ab_check *check, double low, double high) {
    check->random = check->random * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(check->random >> 11) * 0x1p-53;
}

void ab_check_unit_vector(ab_check *check, uint32_t dimension, double *v) {
    double size = 0.0;
    while (!(size > 0.1 && size < 1.0)) {
        size = 0.0;
        for (uint32_t c = 0; c < dimension; c++) v[c] = ab_check_uniform(check, -1.0, 1.0), size += v[c] * v[c];
    }
    for (uint32_t c = 0; c < dimension; c++) v[c] /= sqrt(size);
}

static int reserve_nothing(void *context, ab_points *points, size_t points_more, size_t stencil_more) {
    (void)context, (void)points, (void)points_more, (void)stencil_more;
    return -1;
}

static void log_nothing(void *context, const char *text) { (void)context, (void)text; }

bool ab_check_open(ab_check *check, ab_check_instance *instance, const ab_value *settings, ab_loaded_class *guard) {
    memset(instance, 0, sizeof *instance);
    instance->loaded = check->loaded;
    if (guard) {
        ab_guard_class(check->loaded, guard);
        instance->loaded = guard;
    }
    ab_service_init(&instance->service, check->loaded->class_.name);
    instance->service.guarded = instance->loaded->guarded;
    instance->service.host.reserve = reserve_nothing;
    instance->service.host.log = log_nothing;
    const ab_class *class_ = &instance->loaded->class_;
    return !class_->create || class_->create(&instance->service.host, settings, &instance->self) == 0;
}

void ab_check_close(ab_check_instance *instance) {
    if (instance->loaded->class_.destroy) instance->loaded->class_.destroy(instance->self);
}

/* ---- processes -------------------------------------------------------------------------------------------------------------------- */

static void limit(int what, rlim_t value) {
    struct rlimit now;
    if (getrlimit(what, &now) != 0 || (now.rlim_max != RLIM_INFINITY && value > now.rlim_max)) return;
    now.rlim_cur = value;
    setrlimit(what, &now);
}

static _Noreturn void child(ab_check *check, const ab_check_promise *promise) {
    static char stack[1 << 16];
    const stack_t other = {.ss_sp = stack, .ss_size = sizeof stack};
    sigaltstack(&other, NULL); /* for a plugin that runs out of stack */
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, SECONDS * (UNLIMITED ? 20 : 1));
    alarm(WALL_SECONDS * (UNLIMITED ? 4 : 1));
    if (!UNLIMITED) limit(RLIMIT_DATA, MEMORY);
    promise->keep(check);
    check->shared->verdict = AB_VERDICT_KEPT;
    _exit(0);
}

/* How the process ended, where it was not by itself. */
static void note_death(ab_check_shared *shared, int status) {
    if (shared->verdict != AB_VERDICT_NONE) return;
    shared->verdict = AB_VERDICT_BROKEN;
    char how[120];
    if (WIFSIGNALED(status)) {
        const int number = WTERMSIG(status);
        if (number == SIGXCPU || number == SIGALRM || number == SIGKILL)
            snprintf(how, sizeof how, "it did not come back within %d s (%s)", number == SIGXCPU ? SECONDS : WALL_SECONDS,
                     number == SIGXCPU   ? "SIGXCPU"
                     : number == SIGALRM ? "SIGALRM"
                                         : "SIGKILL");
        else
            snprintf(how, sizeof how, "it crashed with signal %d, %s", number,
                     number == SIGSEGV   ? "SIGSEGV (memory that is not its own)"
                     : number == SIGFPE  ? "SIGFPE (division of integers by zero)"
                     : number == SIGABRT ? "SIGABRT (abort)"
                     : number == SIGILL  ? "SIGILL"
                     : number == SIGBUS  ? "SIGBUS"
                                         : strsignal(number));
    } else
        snprintf(how, sizeof how, "it ended the program with exit status %d", WEXITSTATUS(status));
    snprintf(shared->why, sizeof shared->why, "%s, trying %s", how, shared->input);
}

void ab_check_remove_folder(ab_check *check) {
    static const char *const files[] = {
        "out/results.h5", "out/results.xdmf", "out/history.csv", "out/summary.json", "out", "scene.yaml", ""};
    if (!check->shared->folder[0]) return;
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        char path[sizeof check->shared->folder + 32];
        snprintf(path, sizeof path, "%s/%s", check->shared->folder, files[k]);
        remove(path);
    }
    check->shared->folder[0] = '\0';
}

static bool fork_promise(ab_check *check, const ab_check_promise *promise) {
    ab_check_shared *shared = check->shared;
    shared->verdict = AB_VERDICT_NONE;
    shared->input[0] = shared->why[0] = '\0';
    fflush(stdout), fflush(stderr);
    const pid_t process = fork();
    if (process < 0) return false;
    if (process == 0) child(check, promise);
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {}
    note_death(shared, status);
    ab_check_remove_folder(check);
    return true;
}

/* One line of the report. Returns true where the promise is not broken. */
static bool report_promise(ab_check *check, const ab_check_promise *promise, bool try_it) {
    ab_check_shared *shared = check->shared;
    if (!try_it) {
        printf("  not tried  %-12s %s\n", promise->name, promise->text);
        return true;
    }
    if (!fork_promise(check, promise)) {
        printf("  not tried  %-12s %s (no process could be started: %s)\n", promise->name, promise->text, strerror(errno));
        return false;
    }
    const char *const word = shared->verdict == AB_VERDICT_KEPT ? "kept" : shared->verdict == AB_VERDICT_SKIPPED ? "-" : "BROKEN";
    printf("  %-9s  %-12s %s\n", word, promise->name, promise->text);
    if (shared->verdict != AB_VERDICT_KEPT) printf("             %-12s %s\n", "", shared->why);
    return shared->verdict != AB_VERDICT_BROKEN;
}

static bool check_class(ab_check *check) {
    const ab_class *class_ = &check->loaded->class_;
    const ab_check_promise settings = {"settings", "create takes settings at, inside and outside of their ranges, or says why not",
                                       ab_check_settings, false};
    printf("%s (%s), %s\n", class_->name, ab_kind_name(class_->kind), check->loaded->path);
    printf("  kept       %-12s %s\n", "descriptor", "tables of this interface's sizes, names, units, ranges and defaults that fit");
    bool kept = report_promise(check, &settings, true);
    const bool usable = check->shared->variants > 0;
    const ab_check_promise *lists[4] = {0};
    size_t count = 0;
    if (check->loaded->material.update) lists[count++] = ab_check_material;
    if (check->loaded->boundary.apply) lists[count++] = ab_check_boundary;
    if (check->loaded->contact.find) lists[count++] = ab_check_finder;
    if (check->loaded->contact.respond) lists[count++] = ab_check_response;
    for (size_t l = 0; l < count; l++) {
        bool go_on = usable;
        for (const ab_check_promise *promise = lists[l]; promise->name; promise++) {
            const bool good = report_promise(check, promise, go_on);
            kept = kept && good;
            if (!good && promise->alone) go_on = false;
        }
    }
    if (!usable) printf("  no settings were found that create takes: give some by --set KEY=VALUE\n");
    return kept && usable;
}

/* ---- the command ------------------------------------------------------------------------------------------------------------------ */

static ab_status check_loaded(const ab_command_line *line, const ab_loaded_class *loaded, bool *kept, ab_report *report) {
    ab_check_shared *shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) return ab_report_failure(report, "no memory for the check");
    ab_check check = {loaded, shared, line, 1};
    *kept = check_class(&check) && *kept;
    munmap(shared, sizeof *shared);
    return AB_OK;
}

static ab_status check_file(const ab_command_line *line, const char *path, bool *kept, ab_report *report) {
    char full[PATH_MAX];
    ab_plugin_file file;
    ab_refusal refusal;
    if (!realpath(path, full)) return ab_report_error(report, AB_NOWHERE, "cannot read the plugin '%s': %s", path, strerror(errno));
    if (!line->force_plugins && !ab_plugin_is_safe(full, &refusal))
        return ab_report_error(report, AB_NOWHERE, "plugin %s %s", full, refusal.text);
    if (!ab_plugin_load(full, &file, &refusal)) return ab_report_error(report, AB_NOWHERE, "plugin %s %s", full, refusal.text);
    ab_status status = AB_OK;
    for (uint32_t k = 0; status == AB_OK && k < file.plugin.class_count; k++) {
        const ab_class_copy *copy = &file.classes[k];
        const ab_loaded_class loaded = {
            .class_ = copy->class_, .material = copy->material, .boundary = copy->boundary, .contact = copy->contact, .path = full};
        status = check_loaded(line, &loaded, kept, report);
    }
    ab_plugin_unload(&file);
    return status;
}

static ab_status check_name(const ab_command_line *line, const char *name, bool *kept, ab_report *report) {
    ab_registry *registry = NULL;
    AB_TRY(ab_registry_create(line->plugin_path, &registry, report));
    if (line->force_plugins) ab_registry_force(registry);
    ab_status status = ab_registry_load_all(registry, report);
    size_t found = 0;
    for (size_t k = 0; status == AB_OK && k < ab_registry_count(registry); k++) {
        const ab_loaded_class *loaded = ab_registry_class(registry, k);
        if (strcmp(loaded->class_.name, name) != 0) continue;
        found++;
        status = check_loaded(line, loaded, kept, report);
    }
    if (status == AB_OK && found == 0) status = ab_registry_not_found(registry, 0, name, AB_NOWHERE, report);
    ab_registry_destroy(registry);
    return status;
}

int ab_command_plugin_check(const ab_command_line *line) {
    ab_report *report = ab_report_create();
    if (!report) return AB_FAILED;
    ab_status status = AB_OK;
    bool kept = true;
    if (line->word_count != 2)
        status = ab_report_error(report, AB_NOWHERE, "`abut plugins check` takes a file such as build/my_law.so, or the name of a class");
    if (status == AB_OK) {
        const char *what = line->words[1];
        const size_t length = strlen(what);
        const bool file = strchr(what, '/') || (length > 3 && strcmp(what + length - 3, ".so") == 0);
        status = file ? check_file(line, what, &kept, report) : check_name(line, what, &kept, report);
    }
    fflush(stdout);
    ab_report_print(report, stderr);
    ab_report_destroy(report);
    return status != AB_OK ? (int)status : kept ? AB_OK : AB_FAILED;
}
