/* check_finder.c: promises of a contact finder, in a small run: a block of material points comes down on one of finite elements, askew, with every call of find
 * under guard and asked about more than once. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/check.h"

static const char SCENE[] = "abut: 1\n"
                            "title: a finder under check\n"
                            "space: plane-strain\n"
                            "constants: {c: 0.9, s: 0.2}\n"
                            "time: {end: 6e-4, dt: 2e-5}\n"
                            "grid: {from: [0, 0], to: [2, 2], cell: 0.1}\n"
                            "materials:\n"
                            "  soft: {model: linear-elastic, E: 1e7, nu: 0.3, density: 1000}\n"
                            "bodies:\n"
                            "  upper:\n"
                            "    method: material-points\n"
                            "    material: soft\n"
                            "    shape: {polygon: [[0.61, 1.021], [1.21, 1.121], [1.11, 1.721], [0.51, 1.621]]}\n"
                            "    velocity: [0.3, -2]\n"
                            "  lower:\n"
                            "    method: finite-elements\n"
                            "    material: soft\n"
                            "    mesh: {patch: {bottom: [[0.53, 0.42], [1.43, 0.57]], right: [[1.43, 0.57], [1.33, 1.14]], top: [[0.43, "
                            "0.99], [1.33, 1.14]], left: [[0.53, 0.42], [0.43, 0.99]]}, elements: [5, 3], type: q4}\n"
                            "contact:\n"
                            "  - {bodies: [upper, lower], algorithm: multi-velocity, response: frictionless}\n";

typedef struct probe { /* one process checks one thing */
    ab_check *check;
    const ab_value *settings;
    ab_loaded_class guard, face;
    ab_promise promise;
    void (*look)(void *self, const ab_trace *, const ab_trace *, ab_points *);
    size_t calls, points, broken;
    ab_service *service;
    void *twin; /* sees turned bodies alone, in every step: a finder may remember where points touched */
} probe;
static probe now;

typedef struct found { /* what a call of find wrote */
    size_t count, stencil_a, stencil_b;
    uint64_t *key;
    uint32_t *dof;
    double *numbers; /* position, normal: x, y each; gap, area; then weights of a and b */
} found;

static found copy_found(const ab_points *p) {
    const size_t n = p->count, a = p->a_start[n], b = p->b_start[n];
    found f = {
        n, a, b, malloc((n + 1) * sizeof *f.key), malloc((a + b + 1) * sizeof *f.dof), malloc((6 * n + a + b + 1) * sizeof *f.numbers)};
    if (!f.key || !f.dof || !f.numbers) ab_check_skip(now.check, "no memory");
    memcpy(f.key, p->key, n * sizeof *f.key);
    memcpy(f.dof, p->a_dof, a * sizeof *f.dof), memcpy(f.dof + a, p->b_dof, b * sizeof *f.dof);
    const double *rows[6] = {p->position, p->position + p->ld, p->normal, p->normal + p->ld, p->gap, p->area};
    for (int r = 0; r < 6; r++) memcpy(f.numbers + (size_t)r * n, rows[r], n * sizeof(double));
    memcpy(f.numbers + 6 * n, p->a_weight, a * sizeof(double)), memcpy(f.numbers + 6 * n + a, p->b_weight, b * sizeof(double));
    return f;
}

/* In the order of their keys: places of points may decide in which order they are found. */
static void sort_found(found *f) {
    for (size_t i = 1; i < f->count; i++)
        for (size_t k = i; k > 0 && f->key[k - 1] > f->key[k]; k--) {
            const uint64_t key = f->key[k];
            f->key[k] = f->key[k - 1], f->key[k - 1] = key;
            for (size_t r = 0; r < 6; r++) {
                double *x = f->numbers + r * f->count + k;
                const double number = x[0];
                x[0] = x[-1], x[-1] = number;
            }
        }
}

static void free_found(found *f) { free(f->key), free(f->dof), free(f->numbers); }

static const char *const ROW[6] = {"position x", "position y", "normal x", "normal y", "gap", "area"};

static void same_found(const found *a, const found *b, double like, const char *what) {
    char words[400];
    ab_check_words(now.check, now.settings, words, sizeof words);
    if (a->count != b->count || a->stencil_a != b->stencil_a || a->stencil_b != b->stencil_b)
        ab_check_fail(now.check, "%s it finds %zu points where it found %zu: %s", what, b->count, a->count, words);
    for (size_t i = 0; i < a->count; i++) {
        if (a->key[i] != b->key[i])
            ab_check_fail(now.check, "%s point %zu has the key %llu where it had %llu: %s", what, i, (unsigned long long)b->key[i],
                          (unsigned long long)a->key[i], words);
        for (size_t r = 0; r < 6; r++) {
            const double x = a->numbers[r * a->count + i], y = b->numbers[r * a->count + i];
            if (like > 0.0 ? fabs(x - y) > like : memcmp(&x, &y, sizeof x) != 0)
                ab_check_fail(now.check, "%s %s of point %zu is %.17g where it was %.17g: %s", what, ROW[r], i, y, x, words);
        }
    }
    if (like == 0.0 && (memcmp(a->dof, b->dof, (a->stencil_a + a->stencil_b) * sizeof *a->dof) ||
                        memcmp(a->numbers + 6 * a->count, b->numbers + 6 * a->count, (a->stencil_a + a->stencil_b) * sizeof(double))))
        ab_check_fail(now.check, "%s it writes other stencils: %s", what, words);
}

static int find(void *self, const ab_trace *a, const ab_trace *b, ab_points *out) {
    out->failures = 0;
    return now.guard.contact.find(self, a, b, out);
}

static void look_again(void *self, const ab_trace *a, const ab_trace *b, ab_points *out) {
    found first = copy_found(out);
    if (find(self, a, b, out) != 0) return;
    found second = copy_found(out);
    same_found(&first, &second, 0.0, "asked again");
    free_found(&first), free_found(&second);
}

/* ---- saved and loaded ------------------------------------------------------------------------------------------------------------------ */

static struct {
    char bytes[1 << 20];
    size_t count, read;
} saved;

static int write_saved(void *context, const void *bytes, size_t count) {
    (void)context;
    if (count > sizeof saved.bytes - saved.count) return -1;
    memcpy(saved.bytes + saved.count, bytes, count);
    saved.count += count;
    return 0;
}

static int read_saved(void *context, void *bytes, size_t count) {
    (void)context;
    if (count > saved.count - saved.read) return -1;
    memcpy(bytes, saved.bytes + saved.read, count);
    saved.read += count;
    return 0;
}

/* An instance that has just been made and loads what this one saves finds the same points. */
static void look_saved(void *self, const ab_trace *a, const ab_trace *b, ab_points *out) {
    const ab_stream stream = {.struct_size = sizeof stream, .write = write_saved, .read = read_saved};
    void *fresh = NULL;
    saved.count = saved.read = 0;
    if (now.guard.class_.save(self, &stream) != 0) ab_check_fail(now.check, "save failed in the middle of a run: %s", now.service->message);
    if (now.guard.class_.create(&now.service->host, now.settings, &fresh) != 0)
        ab_check_fail(now.check, "create refuses settings that it took before");
    if (now.guard.class_.load(fresh, &stream) != 0)
        ab_check_fail(now.check, "load failed on the %zu bytes that save wrote: %s", saved.count, now.service->message);
    if (saved.read != saved.count) ab_check_fail(now.check, "save wrote %zu bytes and load read %zu of them", saved.count, saved.read);
    if (find(fresh, a, b, out) != 0) return;
    found second = copy_found(out);
    if (find(self, a, b, out) != 0) return;
    found first = copy_found(out);
    same_found(&first, &second, 0.0, "from an instance that loaded what this one had saved");
    free_found(&first), free_found(&second);
    now.guard.class_.destroy(fresh);
}

/* ---- turned by a right angle: what lies along the grid still does --------------------------------------------------------------------- */

enum { TURNED = 16 };
static double *turned[2][TURNED];

/* (x, y) -> (-y, x) of rows of ld; symmetric: (xx, yy, xy) -> (yy, xx, -xy). The copy lives until the next look. */
static const double *turn(int side, int k, const double *from, size_t count, size_t ld, bool symmetric) {
    free(turned[side][k]);
    turned[side][k] = NULL;
    if (!from) return NULL;
    double *to = turned[side][k] = malloc((3 * ld + 1) * sizeof *to);
    if (!to) ab_check_skip(now.check, "no memory");
    for (size_t i = 0; i < count; i++) {
        if (symmetric)
            to[i] = from[ld + i], to[ld + i] = from[i], to[2 * ld + i] = -from[2 * ld + i];
        else
            to[i] = -from[ld + i], to[ld + i] = from[i];
    }
    return to;
}

static void turn_trace(int side, const ab_trace *t, ab_trace *q, ab_surface *s) {
    *q = *t;
    q->position = turn(side, 0, t->position, t->count, t->ld, false);
    q->mass_gradient = turn(side, 1, t->mass_gradient, t->count, t->ld, false);
    q->area_vector = turn(side, 2, t->area_vector, t->count, t->ld, false);
    const size_t near = t->near_start ? t->near_start[t->count] : 0;
    q->near_position = turn(side, 3, t->near_position, near, t->near_ld, false);
    q->near_extent = turn(side, 4, t->near_extent, near, t->near_ld, true);
    q->density_gradient = turn(side, 5, t->density_gradient, t->count, t->ld, false);
    q->face_normal = turn(side, 6, t->face_normal, t->count, t->ld, false);
    if (!t->surface) return;
    *s = *t->surface;
    s->point_position = turn(side, 7, t->surface->point_position, s->point_count, s->point_ld, false);
    s->point_extent = turn(side, 8, t->surface->point_extent, s->point_count, s->point_ld, true);
    s->vertex_position = turn(side, 9, t->surface->vertex_position, s->vertex_count, s->vertex_ld, false);
    q->surface = s;
}

static void look_turned(void *self, const ab_trace *a, const ab_trace *b, ab_points *out) {
    static const double LIKE = 1e-7; /* m, and of 1: normals by iteration */
    ab_trace qa, qb;
    ab_surface sa, sb;
    found first = copy_found(out);
    turn_trace(0, a, &qa, &sa), turn_trace(1, b, &qb, &sb);
    if (find(now.twin, &qa, &qb, out) != 0) ab_check_fail(now.check, "it gives up on a turned pair of bodies: %s", now.service->message);
    found second = copy_found(out);
    for (size_t i = 0; i < second.count; i++) /* back again */
        for (size_t r = 0; r < 4; r += 2) {
            double *x = second.numbers + r * second.count + i, *y = x + second.count;
            const double old = *x;
            *x = *y, *y = -old;
        }
    sort_found(&first), sort_found(&second);
    same_found(&first, &second, LIKE, "with everything turned by a right angle");
    free_found(&first), free_found(&second);
    find(self, a, b, out); /* what the run goes on with */
}

/* ---- the run ---------------------------------------------------------------------------------------------------------------------------- */

static int probing_find(void *self, const ab_trace *a, const ab_trace *b, ab_points *out) {
    now.calls++;
    const int code = find(self, a, b, out);
    if (code != 0) {
        const ab_promise broken = ab_guard_broken(self);
        if (broken == now.promise && now.promise != AB_PROMISE_NONE) ab_check_fail(now.check, "%s", now.service->message);
        if (broken == AB_PROMISE_NONE && now.promise == AB_PROMISE_CRASH && !now.service->message[0]) {
            char words[400];
            ab_check_fail(now.check, "find returned %d and gave no reason: %s", code,
                          ab_check_words(now.check, now.settings, words, sizeof words));
        }
        now.broken += broken != AB_PROMISE_NONE;
        out->count = 0; /* of another promise: go on without */
        return 0;
    }
    now.points += out->count;
    if (now.look) now.look(self, a, b, out);
    return 0;
}

static int probing_create(const ab_host *host, const ab_value *settings, void **self) {
    now.service = host->context;
    (void)settings;
    const int code = now.guard.class_.create(host, now.settings, self);
    return code != 0 || !now.look ? code : now.guard.class_.create(host, now.settings, &now.twin);
}

/* The twin has the same host, which goes with the contact. */
static void probing_destroy(void *self) {
    if (now.twin) now.guard.class_.destroy(now.twin);
    now.twin = NULL;
    now.guard.class_.destroy(self);
}

static ab_status run_scene(const ab_check *check, const char *folder, ab_report *report) {
    char path[4200];
    snprintf(path, sizeof path, "%s/scene.yaml", folder);
    FILE *file = fopen(path, "w");
    if (!file || fputs(SCENE, file) < 0 || fclose(file) != 0) return ab_report_failure(report, "cannot write '%s'", path);
    ab_registry *registry = NULL;
    ab_scene *scene = NULL;
    AB_TRY(ab_registry_create(NULL, &registry, report));
    ab_status status = ab_scene_read(path, NULL, 0, registry, &scene, report);
    if (status == AB_OK) {
        scene->contacts[0].finder = &now.face;
        scene->contacts[0].finder_settings = (ab_value *)(uintptr_t)now.settings;
        const ab_run_options options = {.threads = 1,
                                        .quiet = true,
                                        .methods = check->line->methods,
                                        .method_count = check->line->method_count,
                                        .interact = check->line->interact};
        ab_schedule *schedule = NULL;
        status = ab_schedule_create(scene, &options, &schedule, report);
        while (status == AB_OK && schedule->time < scene->time_end) status = ab_schedule_step(schedule, report);
        if (schedule) ab_schedule_destroy(schedule);
    }
    ab_scene_destroy(scene);
    ab_registry_destroy(registry);
    return status;
}

static void keep(ab_check *check, ab_promise promise, void (*look)(void *, const ab_trace *, const ab_trace *, ab_points *), size_t most) {
    const char *temporary = getenv("TMPDIR");
    for (size_t v = 0; v < check->shared->variants && v < most; v++) {
        char *folder = check->shared->folder, words[400];
        snprintf(folder, sizeof check->shared->folder, "%s/abut-check-XXXXXX", temporary && *temporary ? temporary : "/tmp");
        if (!mkdtemp(folder)) folder[0] = '\0', ab_check_skip(check, "a folder for a small run could not be made in $TMPDIR or /tmp");
        now = (probe){.check = check, .settings = check->shared->settings[v], .promise = promise, .look = look};
        ab_guard_class(check->loaded, &now.guard);
        now.face = now.guard;
        now.face.class_.create = probing_create;
        now.face.class_.destroy = probing_destroy;
        now.face.contact.find = probing_find;
        ab_check_trying(check, "find in a small run: %s", ab_check_words(check, now.settings, words, sizeof words));
        ab_report *report = ab_report_create();
        const ab_status status = run_scene(check, folder, report);
        ab_check_remove_folder(check);
        if (status != AB_OK && now.calls == 0) {
            static char why[900];
            snprintf(why, sizeof why, "the small run did not come to a call of find: %s", ab_report_first_error(report));
            if (v == 0) ab_check_skip(check, why);
        } else if (v == 0 && promise == AB_PROMISE_CRASH && now.points == 0 && now.broken == 0)
            ab_check_fail(check, "it found no contact point between a block and another that it runs into (%zu calls)", now.calls);
        ab_report_destroy(report);
    }
}

static void keep_find(ab_check *check) { keep(check, AB_PROMISE_CRASH, NULL, AB_CHECK_VARIANTS); }
static void keep_again(ab_check *check) { keep(check, AB_PROMISE_NONE, look_again, 4); }
static void keep_saved(ab_check *check) {
    if (!check->loaded->class_.save) ab_check_skip(check, "the class has no save and load: nothing is remembered");
    keep(check, AB_PROMISE_NONE, look_saved, 4);
}
/* Without save and load an instance made anew has to do. */
static void look_anew(void *self, const ab_trace *a, const ab_trace *b, ab_points *out) {
    void *fresh = NULL;
    if (now.guard.class_.save) return;
    if (now.guard.class_.create(&now.service->host, now.settings, &fresh) != 0)
        ab_check_fail(now.check, "create refuses settings that it took before");
    if (find(fresh, a, b, out) != 0) return;
    found second = copy_found(out);
    if (find(self, a, b, out) != 0) return;
    found first = copy_found(out);
    same_found(&first, &second, 0.0, "from an instance made anew (what it remembers needs save and load)");
    free_found(&first), free_found(&second);
    now.guard.class_.destroy(fresh);
}
static void keep_anew(ab_check *check) { keep(check, AB_PROMISE_NONE, look_anew, 4); }
static void keep_turned(ab_check *check) { keep(check, AB_PROMISE_NONE, look_turned, 1); }
static void keep_old(ab_check *check) { keep(check, AB_PROMISE_OLD, NULL, 2); }
static void keep_arrays(ab_check *check) { keep(check, AB_PROMISE_ARRAYS, NULL, 4); }
static void keep_finite(ab_check *check) { keep(check, AB_PROMISE_FINITE, NULL, AB_CHECK_VARIANTS); }
static void keep_momentum(ab_check *check) { keep(check, AB_PROMISE_MOMENTUM, NULL, AB_CHECK_VARIANTS); }

const ab_check_promise ab_check_finder[] = {
    {"find", "contact points where a block runs into another, and no error", keep_find, false},
    {"again", "the same bodies give the same points, bit by bit", keep_again, true},
    {"anew", "an instance made anew finds the same points, where the class has no save and load", keep_anew, false},
    {"save-load", "an instance that loads what another saved finds the same points", keep_saved, false},
    {"frame", "turned bodies give turned points (by a right angle, as the grid)", keep_turned, false},
    {"old-state", "what it is shown of the bodies is not written", keep_old, false},
    {"arrays", "nothing outside of arrays is read or written; room is asked for by host->reserve", keep_arrays, false},
    {"finite", "places, normals, gaps, areas and weights are finite numbers, and written", keep_finite, false},
    {"momentum", "unit normals, and weights of each side that sum to 1: what one body gets the other gives", keep_momentum, false},
    {.name = NULL},
};
