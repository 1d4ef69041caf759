/* trade_runs.c: the runs of a trade: every combination of settings, each a process of its own in a folder of its own. */
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "core/trade.h"

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

const char *ab_trade_settings(const ab_trade *trade, const ab_trial *trial, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (size_t k = 0; k < trade->spec->ladder_count && used < size; k++) {
        const ab_ladder *ladder = &trade->spec->ladders[k];
        used += (size_t)snprintf(text + used, size - used, "%s%s=%s", k > 0 ? ", " : "", ladder->name, ladder->values[trial->rung[k]]);
    }
    return text;
}

/* ---- plan ---------------------------------------------------------------------------------------------------------------------------- */

static uint64_t hash(uint64_t h, const void *bytes, size_t count) { /* FNV-1a */
    const unsigned char *c = bytes;
    for (size_t i = 0; i < count; i++) h = (h ^ c[i]) * UINT64_C(0x100000001b3);
    return h;
}
static uint64_t hash_text(uint64_t h, const char *text) { return hash(h, text, strlen(text) + 1); }
static const uint64_t HASH_START = UINT64_C(0xcbf29ce484222325);

static char *trial_folder(const ab_trade *trade, const ab_trial *trial) {
    uint64_t h = HASH_START;
    char name[80] = "", *folder = NULL;
    for (size_t k = 0, used = 0; k < trade->spec->ladder_count; k++) {
        const ab_ladder *ladder = &trade->spec->ladders[k];
        const char *value = ladder->values[trial->rung[k]];
        for (size_t p = 0; p < ladder->path_count; p++) h = hash_text(h, ladder->paths[p]);
        h = hash_text(h, value);
        for (const char *c = value; *c != '\0' && used + 2 < sizeof name; c++)
            if (strchr("{}[]\"' /\\:", *c) == NULL) name[used++] = *c;
        if (used + 2 < sizeof name) name[used++] = '_';
    }
    const size_t size = strlen(trade->folder) + sizeof name + 40;
    folder = malloc(size);
    if (folder != NULL) snprintf(folder, size, "%s/runs/%s%08" PRIx32, trade->folder, name, (uint32_t)(h ^ (h >> 32)));
    return folder;
}

ab_status ab_trade_plan(ab_trade *trade, ab_report *report) {
    size_t count = 1;
    for (size_t k = 0; k < trade->spec->ladder_count; k++) count *= trade->spec->ladders[k].value_count;
    trade->trials = calloc(count, sizeof *trade->trials);
    if (trade->trials == NULL) return ab_report_failure(report, "no memory for %zu runs", count);
    trade->count = count;
    for (size_t i = 0; i < count; i++) {
        ab_trial *trial = &trade->trials[i];
        size_t rest = i;
        for (size_t k = trade->spec->ladder_count; k-- > 0;) {
            trial->rung[k] = rest % trade->spec->ladders[k].value_count;
            rest /= trade->spec->ladders[k].value_count;
        }
        trial->error = trial->remainder = NAN;
        trial->folder = trial_folder(trade, trial);
        if (trial->folder == NULL) return ab_report_failure(report, "no memory for %zu runs", count);
    }
    return AB_OK;
}

void ab_trade_clear(ab_trade *trade) {
    for (size_t i = 0; i < trade->count; i++) {
        ab_trial *trial = &trade->trials[i];
        free(trial->folder), free(trial->why), free(trial->errors), free(trial->values), free(trial->peaks);
    }
    free(trade->trials), free(trade->judges);
    trade->trials = NULL, trade->judges = NULL;
    trade->count = trade->judge_count = 0;
}

/* ---- what is there already ------------------------------------------------------------------------------------------------------------ */

static uint64_t hash_file(uint64_t h, const char *path) {
    FILE *file = fopen(path, "rb");
    char bytes[65536];
    size_t count;
    while (file != NULL && (count = fread(bytes, 1, sizeof bytes, file)) > 0) h = hash(h, bytes, count);
    if (file != NULL) fclose(file);
    return h;
}

/* The scene but for `trade`: other ladders leave the runs that are there as they are. */
static uint64_t hash_scene(uint64_t h, const char *path) {
    ab_report *report = ab_report_create();
    ab_document *document = NULL;
    if (report != NULL && ab_document_read(path, &document, report) == AB_OK)
        for (size_t i = 0; i < document->root->count; i++) {
            const ab_entry *entry = &document->root->entries[i];
            if (strcmp(entry->key, "trade") == 0) continue;
            const char *text = ab_node_flow(document->arena, entry->value);
            h = hash_text(hash_text(h, entry->key), text != NULL ? text : "");
        }
    ab_document_destroy(document);
    ab_report_destroy(report);
    return h;
}

/* Of all that decides what a run gives: the scene, meshes in files, overrides, the program and every plugin it finds. Threads change its cost. */
static void take_fingerprint(ab_trade *trade, const ab_scene *scene, ab_registry *registry) {
    uint64_t h = hash_scene(HASH_START, trade->scene);
    for (size_t b = 0; b < scene->body_count; b++) {
        const char *file = scene->bodies[b].mesh.file, *slash = strrchr(trade->scene, '/');
        if (file == NULL) continue;
        char path[4096];
        snprintf(path, sizeof path, "%.*s%s", file[0] == '/' || slash == NULL ? 0 : (int)(slash - trade->scene) + 1, trade->scene, file);
        h = hash_file(h, path);
    }
    for (size_t i = 0; i < trade->override_count; i++) h = hash_text(hash_text(h, trade->overrides[i].path), trade->overrides[i].value);
    h = hash_file(h, "/proc/self/exe");
    ab_report *refused = ab_report_create(); /* a plugin that no run asks for may be broken */
    if (refused != NULL) ab_registry_load_all(registry, refused);
    ab_report_destroy(refused);
    for (size_t i = 0; i < ab_registry_count(registry); i++) h = hash_file(h, ab_registry_class(registry, i)->path);
    snprintf(trade->fingerprint, sizeof trade->fingerprint, "%016" PRIx64 "-%d", h, trade->threads);
}

static double number_of(const ab_node *map, const char *key) {
    const ab_node *node = ab_node_find(map, key);
    return node != NULL && node->kind == AB_NODE_SCALAR && !ab_node_is_null(node) ? strtod(node->text, NULL) : NAN;
}

static void say_why(ab_trial *trial, const char *why) {
    free(trial->why);
    trial->why = strdup(why);
}

/* The reason a run broke off: the last line of its log that is an error, else the last. */
static void read_log(ab_trial *trial) {
    char path[4200], line[2000], last[2000] = "", error[2000] = "";
    snprintf(path, sizeof path, "%s.log", trial->folder);
    FILE *file = fopen(path, "r");
    while (file != NULL && fgets(line, sizeof line, file) != NULL) {
        line[strcspn(line, "\r\n")] = '\0';
        if (line[0] == '\0') continue;
        snprintf(last, sizeof last, "%s", line);
        const char *at = strstr(line, "error: ");
        if (at != NULL) snprintf(error, sizeof error, "%s", at + 7);
    }
    if (file != NULL) fclose(file);
    say_why(trial, error[0] != '\0' ? error : last[0] != '\0' ? last : "it said nothing");
}

static void conclude(ab_trial *trial, int status) {
    if (status == AB_OK || status == 3)
        trial->state = AB_TRIAL_DONE;
    else {
        trial->state = status == AB_BAD_INPUT ? AB_TRIAL_REFUSED : AB_TRIAL_FAILED;
        read_log(trial);
    }
}

static bool take_kept(const ab_trade *trade, ab_trial *trial) {
    char path[4200];
    snprintf(path, sizeof path, "%s/trial.json", trial->folder);
    if (access(path, R_OK) != 0) return false;
    ab_report *report = ab_report_create();
    ab_document *document = NULL;
    bool kept = report != NULL && ab_document_read(path, &document, report) == AB_OK;
    const ab_node *mark = kept ? ab_node_find(document->root, "fingerprint") : NULL;
    kept = mark != NULL && mark->kind == AB_NODE_SCALAR && strcmp(mark->text, trade->fingerprint) == 0;
    if (kept) {
        trial->wall = number_of(document->root, "wall_seconds");
        trial->cpu = number_of(document->root, "cpu_seconds");
        trial->bytes = number_of(document->root, "peak_bytes");
        trial->kept = true;
        conclude(trial, (int)number_of(document->root, "exit"));
    }
    ab_document_destroy(document);
    ab_report_destroy(report);
    return kept;
}

static ab_status keep(const ab_trade *trade, const ab_trial *trial, int status, ab_report *report) {
    ab_text text = {0};
    char settings[2000];
    ab_text_add(&text, "{\"fingerprint\": \"%s\", \"settings\": ", trade->fingerprint);
    ab_text_add_escaped(&text, ab_trade_settings(trade, trial, settings, sizeof settings));
    ab_text_add(&text, ", \"exit\": %d, \"wall_seconds\": ", status);
    ab_text_add_number(&text, trial->wall);
    ab_text_add(&text, ", \"cpu_seconds\": ");
    ab_text_add_number(&text, trial->cpu);
    ab_text_add(&text, ", \"peak_bytes\": ");
    ab_text_add_number(&text, trial->bytes);
    ab_text_add(&text, "}\n");
    char path[4200];
    snprintf(path, sizeof path, "%s/trial.json", trial->folder);
    ab_status made = ab_folder_make(trial->folder, report);
    if (made == AB_OK) made = text.failed ? AB_FAILED : ab_file_replace(path, text.bytes, text.count, report);
    ab_text_clear(&text);
    return made;
}

/* ---- processes ------------------------------------------------------------------------------------------------------------------------ */

static ab_status begin(const ab_trade *trade, ab_trial *trial, ab_report *report) {
    static char set_word[] = "--set", plugin_path[] = "--plugin-path";
    size_t most = 16 + 2 * trade->override_count, count = 0;
    for (size_t k = 0; k < trade->spec->ladder_count; k++) most += 2 * trade->spec->ladders[k].path_count;
    char **words = calloc(most, sizeof *words), **made = calloc(most, sizeof *made), threads[16], log[4200];
    size_t made_count = 0;
    ab_status status = words == NULL || made == NULL ? ab_report_failure(report, "no memory to start a run") : AB_OK;
    if (status == AB_OK) {
        snprintf(threads, sizeof threads, "%d", trade->threads);
        snprintf(log, sizeof log, "%s.log", trial->folder);
        const char *const head[] = {"abut", "run", trade->scene, "--quiet", "-j", threads, "-o", trial->folder};
        for (size_t i = 0; i < sizeof head / sizeof *head; i++) words[count++] = (char *)(uintptr_t)head[i];
        if (trade->plugin_path != NULL) words[count++] = plugin_path, words[count++] = (char *)(uintptr_t)trade->plugin_path;
    }
    for (size_t i = 0; status == AB_OK && i < trade->override_count + AB_TRADE_LADDERS * AB_TRADE_PATHS; i++) {
        const char *path = NULL, *value = NULL;
        if (i < trade->override_count)
            path = trade->overrides[i].path, value = trade->overrides[i].value;
        else {
            const size_t k = (i - trade->override_count) / AB_TRADE_PATHS, p = (i - trade->override_count) % AB_TRADE_PATHS;
            if (k >= trade->spec->ladder_count) break;
            if (p >= trade->spec->ladders[k].path_count) continue;
            path = trade->spec->ladders[k].paths[p], value = trade->spec->ladders[k].values[trial->rung[k]];
        }
        const size_t size = strlen(path) + strlen(value) + 2;
        char *set = made[made_count++] = malloc(size);
        if (set == NULL) {
            status = ab_report_failure(report, "no memory to start a run");
            break;
        }
        snprintf(set, size, "%s=%s", path, value);
        words[count++] = set_word;
        words[count++] = set;
    }
    if (status == AB_OK) {
        const pid_t child = fork();
        if (child == 0) {
            const int file = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0666), nothing = open("/dev/null", O_RDWR);
            if (file >= 0) dup2(file, STDERR_FILENO);
            if (nothing >= 0) dup2(nothing, STDIN_FILENO), dup2(nothing, STDOUT_FILENO);
            execv("/proc/self/exe", words);
            _exit(127);
        }
        if (child < 0)
            status = ab_report_failure(report, "a run cannot be started: %s", strerror(errno));
        else {
            trial->process = child;
            trial->started = now();
            trial->state = AB_TRIAL_RUNNING;
        }
    }
    for (size_t i = 0; i < made_count; i++) free(made[i]);
    free(made), free(words);
    return status;
}

static bool is_numeric(const ab_ladder *ladder) {
    for (size_t i = 0; i < ladder->value_count; i++) {
        char *end;
        strtod(ladder->values[i], &end);
        if (end == ladder->values[i] || *end != '\0') return false;
    }
    return true;
}

/* Runs that are dearer than one that was over the limit: as far or further on every ladder of numbers, the same on every other. */
static void skip_dearer(ab_trade *trade, const ab_trial *slow) {
    for (size_t i = 0; i < trade->count; i++) {
        ab_trial *trial = &trade->trials[i];
        if (trial->state != AB_TRIAL_WAITING) continue;
        bool dearer = true;
        for (size_t k = 0; k < trade->spec->ladder_count && dearer; k++)
            dearer = is_numeric(&trade->spec->ladders[k]) ? trial->rung[k] >= slow->rung[k] : trial->rung[k] == slow->rung[k];
        if (!dearer) continue;
        char settings[600], why[800];
        trial->state = AB_TRIAL_SKIPPED;
        snprintf(why, sizeof why, "a cheaper run is over the limit: %s", ab_trade_settings(trade, slow, settings, sizeof settings));
        say_why(trial, why);
    }
}

static volatile sig_atomic_t stopped;
static void on_signal(int number) { stopped = number; }

static void tell(const ab_trade *trade, size_t ended, const ab_trial *trial) {
    static const char *const words[] = {"", "", "done", "failed", "refused", "over the limit", "skipped"};
    char settings[2000];
    if (trade->quiet) return;
    ab_trade_settings(trade, trial, settings, sizeof settings);
    if (!isatty(STDERR_FILENO)) {
        fprintf(stderr, "%4zu of %zu  %s: %s%s, %.3g s\n", ended, trade->count, settings, words[trial->state], trial->kept ? " before" : "",
                trial->cpu);
        return;
    }
    char bar[31];
    const size_t full = 30 * ended / trade->count;
    for (size_t i = 0; i < 30; i++) bar[i] = i < full ? '#' : '.';
    bar[30] = '\0';
    fprintf(stderr, "\r%s %zu of %zu  %.60s: %s\033[K", bar, ended, trade->count, settings, words[trial->state]);
    fflush(stderr);
}

/* One that has ended; its times and memory from the system. */
static ab_status collect(ab_trade *trade, ab_trial *trial, int how, const struct rusage *use, ab_report *report) {
    trial->wall = now() - trial->started;
    trial->cpu = (double)(use->ru_utime.tv_sec + use->ru_stime.tv_sec) + 1e-6 * (double)(use->ru_utime.tv_usec + use->ru_stime.tv_usec);
    trial->bytes = 1024.0 * (double)use->ru_maxrss;
    trial->process = 0;
    const int status = WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how);
    if (trial->wall > trade->spec->limit && status > 3) {
        char why[80];
        trial->state = AB_TRIAL_LIMIT;
        snprintf(why, sizeof why, "over the limit of %g s", trade->spec->limit);
        say_why(trial, why);
        skip_dearer(trade, trial);
        return AB_OK;
    }
    if (stopped && status > 128) { /* with this program, by its signal: to be run again */
        trial->state = AB_TRIAL_WAITING;
        return AB_OK;
    }
    conclude(trial, status);
    if (WIFSIGNALED(how)) {
        char why[80];
        snprintf(why, sizeof why, "killed by signal %d (%s)", WTERMSIG(how), strsignal(WTERMSIG(how)));
        say_why(trial, why);
    }
    if (trial->state == AB_TRIAL_FAILED) return AB_OK; /* a full disk or a lack of memory may be gone the next time */
    return keep(trade, trial, status, report);
}

/* The cheapest that waits: the lowest on all ladders together. */
static ab_trial *next_trial(ab_trade *trade) {
    ab_trial *best = NULL;
    size_t least = SIZE_MAX;
    for (size_t i = 0; i < trade->count; i++) {
        if (trade->trials[i].state != AB_TRIAL_WAITING) continue;
        size_t height = 0;
        for (size_t k = 0; k < trade->spec->ladder_count; k++) height += trade->trials[i].rung[k];
        if (height < least) least = height, best = &trade->trials[i];
    }
    return best;
}

static size_t ended(const ab_trade *trade) {
    size_t count = 0;
    for (size_t i = 0; i < trade->count; i++) count += trade->trials[i].state >= AB_TRIAL_DONE;
    return count;
}

static ab_status run_all(ab_trade *trade, ab_report *report) {
    int running = 0;
    bool told = false;
    ab_status status = AB_OK;
    for (;;) {
        ab_trial *trial;
        while (status == AB_OK && !stopped && running < trade->jobs && (trial = next_trial(trade)) != NULL) {
            if (take_kept(trade, trial)) {
                tell(trade, ended(trade), trial);
                continue;
            }
            status = begin(trade, trial, report);
            running += status == AB_OK;
        }
        if (running == 0) return status;
        struct rusage use;
        int how;
        const pid_t child = wait4(-1, &how, WNOHANG, &use);
        if (child > 0) {
            for (size_t i = 0; i < trade->count; i++)
                if (trade->trials[i].process == child) {
                    const ab_status kept = collect(trade, &trade->trials[i], how, &use, report);
                    if (status == AB_OK) status = kept;
                    if (trade->trials[i].state != AB_TRIAL_WAITING) tell(trade, ended(trade), &trade->trials[i]);
                }
            running--;
            continue;
        }
        for (size_t i = 0; i < trade->count; i++) {
            const ab_trial *t = &trade->trials[i];
            const bool late = t->process > 0 && now() - t->started > trade->spec->limit;
            if (t->process > 0 && (late || (stopped && !told) || status != AB_OK)) kill(t->process, SIGTERM);
        }
        told = stopped != 0;
        nanosleep(&(struct timespec){0, 5000000}, NULL);
    }
}

ab_status ab_trade_run(ab_trade *trade, const ab_scene *scene, ab_registry *registry, ab_report *report) {
    char folder[4200];
    snprintf(folder, sizeof folder, "%s/runs", trade->folder);
    AB_TRY(ab_folder_make(folder, report));
    take_fingerprint(trade, scene, registry);
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction action = {.sa_handler = on_signal}, old[3];
    stopped = 0;
    for (int i = 0; i < 3; i++) sigaction(signals[i], &action, &old[i]);
    const ab_status status = run_all(trade, report);
    for (int i = 0; i < 3; i++) sigaction(signals[i], &old[i], NULL);
    if (!trade->quiet && isatty(STDERR_FILENO)) fprintf(stderr, "\r\033[K");
    return status != AB_OK ? status : stopped ? (ab_status)(128 + stopped) : AB_OK;
}
