/* child_kept.c: runs that an earlier call made: what they were made of, and how they ended. */
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/child_runs.h"
#include "core/document.h"
#include "core/files.h"
#include "core/schema.h"

static uint64_t hash(uint64_t h, const void *bytes, size_t count) { /* FNV-1a */
    const unsigned char *c = bytes;
    for (size_t i = 0; i < count; i++) h = (h ^ c[i]) * UINT64_C(0x100000001b3);
    return h;
}
static uint64_t hash_text(uint64_t h, const char *text) { return hash(h, text, strlen(text) + 1); }
static const uint64_t HASH_START = UINT64_C(0xcbf29ce484222325);

/* "40_gimp_9c31aa02": the values, a value that several paths get once, then all of it hashed. */
static char *folder_of(const ab_child_runs *runs, const ab_override *settings, size_t count) {
    uint64_t h = HASH_START;
    char name[80] = "";
    for (size_t i = 0, used = 0; i < count; i++) {
        const char *value = settings[i].value;
        h = hash_text(hash_text(h, settings[i].path), value);
        if (i > 0 && value == settings[i - 1].value) continue;
        for (const char *c = value; *c != '\0' && used + 2 < sizeof name; c++)
            if (strchr("{}[]\"' /\\:", *c) == NULL) name[used++] = *c;
        if (used + 2 < sizeof name) name[used++] = '_';
    }
    const size_t size = strlen(runs->folder) + sizeof name + 40;
    char *folder = malloc(size);
    if (folder != NULL) snprintf(folder, size, "%s/runs/%s%08" PRIx32, runs->folder, name, (uint32_t)(h ^ (h >> 32)));
    return folder;
}

ab_status ab_child_plan(const ab_child_runs *runs, ab_child *child, const ab_override *settings, size_t count, const char *label,
                        ab_report *report) {
    child->folder = folder_of(runs, settings, count);
    child->label = strdup(label);
    child->settings = calloc(count + 1, sizeof *child->settings);
    if (child->folder == NULL || child->label == NULL || child->settings == NULL) return ab_report_failure(report, "no memory for a run");
    if (count > 0) memcpy(child->settings, settings, count * sizeof *settings);
    child->setting_count = count;
    return AB_OK;
}

void ab_child_clear(ab_child *child) {
    free(child->settings), free(child->folder), free(child->label), free(child->why);
    *child = (ab_child){0};
}

void ab_child_say_why(ab_child *child, const char *why) {
    free(child->why);
    child->why = strdup(why);
}

static uint64_t hash_file(uint64_t h, const char *path) {
    FILE *file = fopen(path, "rb");
    char bytes[65536];
    size_t count;
    while (file != NULL && (count = fread(bytes, 1, sizeof bytes, file)) > 0) h = hash(h, bytes, count);
    if (file != NULL) fclose(file);
    return h;
}

/* The scene but for what only commands read: other ladders leave the runs that are there as they are. */
static uint64_t hash_scene(uint64_t h, const char *path) {
    ab_report *report = ab_report_create();
    ab_document *document = NULL;
    if (report != NULL && ab_document_read(path, &document, report) == AB_OK)
        for (size_t i = 0; i < document->root->count; i++) {
            const ab_entry *entry = &document->root->entries[i];
            if (strcmp(entry->key, "trade") == 0 || strcmp(entry->key, "extremes") == 0) continue;
            const char *text = ab_node_flow(document->arena, entry->value);
            h = hash_text(hash_text(h, entry->key), text != NULL ? text : "");
        }
    ab_document_destroy(document);
    ab_report_destroy(report);
    return h;
}

static uint64_t hash_beside(uint64_t h, const char *scene, const char *file) {
    const char *slash = strrchr(scene, '/');
    char path[4096];
    snprintf(path, sizeof path, "%.*s%s", file[0] == '/' || slash == NULL ? 0 : (int)(slash - scene) + 1, scene, file);
    return hash_file(h, path);
}

/* Threads change a run's cost. */
void ab_child_fingerprint(ab_child_runs *runs, const ab_scene *scene, ab_registry *registry) {
    uint64_t h = hash_scene(HASH_START, runs->scene);
    for (size_t b = 0; b < scene->body_count; b++)
        if (scene->bodies[b].mesh.file != NULL) h = hash_beside(h, runs->scene, scene->bodies[b].mesh.file);
    for (const ab_file_read *file = scene->files; file != NULL; file = file->next) h = hash_beside(h, runs->scene, file->name);
    for (size_t i = 0; i < runs->override_count; i++) h = hash_text(hash_text(h, runs->overrides[i].path), runs->overrides[i].value);
    h = hash_file(h, "/proc/self/exe");
    ab_report *refused = ab_report_create(); /* a plugin that no run asks for may be broken */
    if (refused != NULL) ab_registry_load_all(registry, refused);
    ab_report_destroy(refused);
    for (size_t i = 0; i < ab_registry_count(registry); i++) h = hash_file(h, ab_registry_class(registry, i)->path);
    snprintf(runs->fingerprint, sizeof runs->fingerprint, "%016" PRIx64 "-%d", h, runs->threads);
}

static double number_of(const ab_node *map, const char *key) {
    const ab_node *node = ab_node_find(map, key);
    return node != NULL && node->kind == AB_NODE_SCALAR && !ab_node_is_null(node) ? strtod(node->text, NULL) : NAN;
}

/* The reason a run broke off: the last line of its log that is an error, else the last. */
static void read_log(ab_child *child) {
    char path[4200], line[2000], last[2000] = "", error[2000] = "";
    snprintf(path, sizeof path, "%s.log", child->folder);
    FILE *file = fopen(path, "r");
    while (file != NULL && fgets(line, sizeof line, file) != NULL) {
        line[strcspn(line, "\r\n")] = '\0';
        if (line[0] == '\0') continue;
        snprintf(last, sizeof last, "%s", line);
        const char *at = strstr(line, "error: ");
        if (at != NULL) snprintf(error, sizeof error, "%s", at + 7);
    }
    if (file != NULL) fclose(file);
    ab_child_say_why(child, error[0] != '\0' ? error : last[0] != '\0' ? last : "it said nothing");
}

void ab_child_conclude(ab_child *child, int status) {
    if (status == AB_OK || status == 3) {
        child->state = AB_CHILD_DONE;
        return;
    }
    child->state = status == AB_BAD_INPUT ? AB_CHILD_REFUSED : AB_CHILD_FAILED;
    read_log(child);
    if (status <= 128) return;
    child->killed = true;
    char why[80];
    snprintf(why, sizeof why, "killed by signal %d (%s)", status - 128, strsignal(status - 128));
    ab_child_say_why(child, why);
}

void ab_child_over_limit(const ab_child_runs *runs, ab_child *child) {
    char why[80];
    child->state = AB_CHILD_LIMIT;
    snprintf(why, sizeof why, "over the limit of %g s", runs->limit);
    ab_child_say_why(child, why);
}

/* What a run has written and others read: cut off since, by a full disk or by hand, it is none. */
static const char *const WRITTEN[] = {"summary.json", "history.csv"};
enum { WRITTEN_COUNT = sizeof WRITTEN / sizeof *WRITTEN };

static double size_of(const ab_child *child, const char *name) { /* bytes; -1: not there */
    char path[4300];
    struct stat file;
    snprintf(path, sizeof path, "%s/%s", child->folder, name);
    return stat(path, &file) == 0 ? (double)file.st_size : -1;
}

bool ab_child_take_kept(const ab_child_runs *runs, ab_child *child) {
    char path[4200];
    snprintf(path, sizeof path, "%s/trial.json", child->folder);
    if (access(path, R_OK) != 0) return false;
    ab_report *report = ab_report_create();
    ab_document *document = NULL;
    bool kept = report != NULL && ab_document_read(path, &document, report) == AB_OK;
    const ab_node *mark = kept ? ab_node_find(document->root, "fingerprint") : NULL;
    kept = mark != NULL && mark->kind == AB_NODE_SCALAR && strcmp(mark->text, runs->fingerprint) == 0;
    const ab_node *sizes = kept ? ab_node_find(document->root, "bytes") : NULL;
    for (int i = 0; kept && i < WRITTEN_COUNT; i++) kept = sizes != NULL && size_of(child, WRITTEN[i]) == number_of(sizes, WRITTEN[i]);
    if (kept) child->wall = number_of(document->root, "wall_seconds");
    const bool late = kept && (int)number_of(document->root, "exit") == AB_CHILD_STOPPED;
    if (late) { /* stopped at a limit: the same again unless there is more time now */
        kept = child->wall > runs->limit;
        if (kept) ab_child_over_limit(runs, child);
        child->kept = kept;
    } else if (kept) {
        child->cpu = number_of(document->root, "cpu_seconds");
        child->bytes = number_of(document->root, "peak_bytes");
        child->kept = true;
        ab_child_conclude(child, (int)number_of(document->root, "exit"));
    }
    ab_document_destroy(document);
    ab_report_destroy(report);
    return kept;
}

ab_status ab_child_keep(const ab_child_runs *runs, const ab_child *child, int status, ab_report *report) {
    ab_text text = {0};
    ab_text_add(&text, "{\"fingerprint\": \"%s\", \"settings\": ", runs->fingerprint);
    ab_text_add_escaped(&text, child->label);
    ab_text_add(&text, ", \"exit\": %d, \"wall_seconds\": ", status);
    ab_text_add_number(&text, child->wall);
    ab_text_add(&text, ", \"cpu_seconds\": ");
    ab_text_add_number(&text, child->cpu);
    ab_text_add(&text, ", \"peak_bytes\": ");
    ab_text_add_number(&text, child->bytes);
    ab_text_add(&text, ", \"bytes\": {");
    for (int i = 0; i < WRITTEN_COUNT; i++) {
        ab_text_add(&text, "%s\"%s\": ", i > 0 ? ", " : "", WRITTEN[i]);
        ab_text_add_number(&text, size_of(child, WRITTEN[i]));
    }
    ab_text_add(&text, "}}\n");
    char path[4200];
    snprintf(path, sizeof path, "%s/trial.json", child->folder);
    ab_status made = ab_folder_make(child->folder, report);
    if (made == AB_OK) made = text.failed ? AB_FAILED : ab_file_replace(path, text.bytes, text.count, report);
    ab_text_clear(&text);
    return made;
}
