/* check_boundary.c: promises of a boundary about how it is called: the same bits, edges alone and together, turned edges. */
#include <math.h>
#include <string.h>

#include "core/check_edges.h"

static edge_bench one, two; /* large; every promise has a process of its own */

/* check_boundary_law.c */
void ab_check_damping(ab_check *);
void ab_check_passive(ab_check *);
void ab_check_edges_old(ab_check *);
void ab_check_edges_arrays(ab_check *);
void ab_check_edges_unasked(ab_check *);
void ab_check_edges_finite(ab_check *);
void ab_check_edges_save(ab_check *);

/* ---- the same bits ------------------------------------------------------------------------------------------------------------------ */

typedef struct written {
    const char *name;
    const double *array; /* NULL: not given */
    size_t rows;
} written;
enum { WRITTEN = 5 };

static void list_written(const edge_bench *b, written list[WRITTEN]) {
    const ab_edges *e = &b->edges;
    const written all[WRITTEN] = {{"traction", e->traction, e->dimension},
                                  {"damping", e->damping, 2},
                                  {"stiffness", e->stiffness, 2},
                                  {"prescribed", e->prescribed, e->dimension},
                                  {"state1", e->state1, b->states}};
    memcpy(list, all, sizeof all);
}

/* Edge `i` of a against edge `j` of b. */
static void same_edge(ab_check *check, const ab_value *settings, const edge_bench *b, size_t j, const edge_bench *a, size_t i,
                      const char *what) {
    written first[WRITTEN], second[WRITTEN];
    char words[700];
    list_written(a, first), list_written(b, second);
    for (int k = 0; k < WRITTEN; k++)
        for (size_t r = 0; second[k].array && r < second[k].rows; r++) {
            const double *x = first[k].array + r * a->edges.ld + i, *y = second[k].array + r * b->edges.ld + j;
            if (memcmp(x, y, sizeof *x) && !(isnan(*x) && isnan(*y)))
                ab_check_fail(check, "row %zu of %s is %.17g %s, and %.17g before: %s", r, second[k].name, *x, what, *y,
                              edge_bench_words(check, b, settings, j, words, sizeof words));
        }
}

static void again(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    static edge_bench fresh;
    edge_bench_prepare(check, &one, instance, settings, dimension);
    fresh = one;
    if (edge_bench_apply(&one, instance) != 0) return;
    for (int round = 0; round < 2; round++) {
        if (round == 1) { /* something else between: a class that looks back in time has to see the same past */
            two = fresh, edge_bench_point(&two);
            edge_bench_move(check, &two);
            if (!check->loaded->class_.save) edge_bench_apply(&two, instance);
        }
        two = fresh, edge_bench_point(&two);
        if (edge_bench_apply(&two, instance) != 0) ab_check_fail(check, "asked again it gives up");
        for (size_t i = 0; i < EDGES; i++)
            same_edge(check, settings, &one, i, &two, i, round ? "when asked again after other input" : "when asked again");
    }
}
static void keep_again(ab_check *check) { edge_bench_for_all(check, 8, again); }

/* An instance made anew goes the same way from the start. */
static void anew(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    const uint64_t random = check->random;
    edge_bench_prepare(check, &one, instance, settings, dimension);
    if (edge_bench_apply(&one, instance) != 0) return;
    ab_check_instance other;
    if (!ab_check_open(check, &other, settings, NULL)) ab_check_fail(check, "create refuses settings that it took before");
    check->random = random;
    edge_bench_prepare(check, &two, &other, settings, dimension);
    if (edge_bench_apply(&two, &other) != 0) ab_check_fail(check, "an instance made anew gives up");
    for (size_t i = 0; i < EDGES; i++) same_edge(check, settings, &one, i, &two, i, "from an instance made anew");
    ab_check_close(&other);
}
static void keep_anew(ab_check *check) { edge_bench_for_all(check, 8, anew); }

static void copy_edges(edge_bench *to, const edge_bench *from, size_t first, size_t count, size_t ld) {
    *to = *from;
    edge_bench_point(to);
    to->edges.count = count, to->edges.ld = ld;
    struct {
        double *to;
        const double *from;
        size_t rows;
    } list[] = {{to->position, from->position, 3},
                {to->normal, from->normal, 3},
                {to->displacement, from->displacement, 3},
                {to->velocity, from->velocity, 3},
                {to->area, from->area, 1},
                {to->density, from->density, 1},
                {to->p_wave_speed, from->p_wave_speed, 1},
                {to->s_wave_speed, from->s_wave_speed, 1},
                {to->state0, from->state0, from->states}};
    for (size_t k = 0; k < sizeof list / sizeof *list; k++)
        for (size_t r = 0; r < list[k].rows; r++) memcpy(list[k].to + r * ld, list[k].from + r * LD + first, count * sizeof(double));
}

static void batches(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    static const size_t COUNT[] = {1, 2, 3, 5, 8, 17};
    edge_bench_prepare(check, &one, instance, settings, dimension);
    static edge_bench fresh;
    fresh = one;
    if (edge_bench_apply(&one, instance) != 0) return;
    for (size_t k = 0; k < sizeof COUNT / sizeof *COUNT; k++)
        for (size_t first = 0; first + COUNT[k] <= EDGES; first += COUNT[k] < 4 ? 5 : COUNT[k])
            for (int tight = 0; tight < 2; tight++) {
                const size_t count = COUNT[k], ld = tight ? count : (count + 7) / 8 * 8;
                char what[80];
                snprintf(what, sizeof what, "asked for %zu edge%s alone, ld %zu", count, count == 1 ? "" : "s", ld);
                ab_check_trying(check, "apply, %s", what);
                copy_edges(&two, &fresh, first, count, ld);
                if (edge_bench_apply(&two, instance) != 0) ab_check_fail(check, "%s it gives up: %s", what, instance->service.message);
                for (size_t i = 0; i < count; i++) same_edge(check, settings, &one, first + i, &two, i, what);
            }
}
static void keep_batches(ab_check *check) {
    if (check->loaded->class_.needs & AB_NEED_WHOLE_SIDE)
        ab_check_skip(check, "the class says that an edge's answer hangs on the others (AB_NEED_WHOLE_SIDE)");
    edge_bench_for_all(check, 8, batches);
}

/* ---- frame -------------------------------------------------------------------------------------------------------------------------- */

static void turn(double Q[3][3], double *v, uint32_t dimension, size_t ld) {
    double w[3] = {0};
    for (uint32_t r = 0; r < dimension; r++)
        for (uint32_t c = 0; c < dimension; c++) w[r] += Q[r][c] * v[c * ld];
    for (uint32_t r = 0; r < dimension; r++) v[r * ld] = w[r];
}

static void turn_rows(double Q[3][3], double *array, uint32_t dimension) {
    for (size_t i = 0; i < EDGES; i++) turn(Q, array + i, dimension, LD);
}

static void turn_states(const ab_check *check, edge_bench *b, double Q[3][3], double *array) {
    const ab_class *class_ = &check->loaded->class_;
    for (size_t row = 0, s = 0; s < class_->nstate; s++) {
        const bool vector = class_->state[s].shape == AB_VECTOR;
        if (vector) turn_rows(Q, array + row * LD, b->edges.dimension);
        row += vector ? b->edges.dimension : 1;
    }
}

/* Settings with a direction (AB_OR_DIRECTION, of which x, y and z are words too) turned. */
static void turn_settings(const ab_check *check, const ab_value *from, double Q[3][3], ab_value *to, double (*room)[3]) {
    const ab_class *class_ = &check->loaded->class_;
    memcpy(to, from, class_->nparam * sizeof *to);
    for (uint32_t k = 0; k < class_->nparam; k++) {
        const ab_param *p = &class_->param[k];
        if (p->type != AB_CHOICE || !(p->flags & AB_OR_DIRECTION)) continue;
        double *v = room[k];
        v[0] = v[1] = v[2] = 0.0;
        if (from[k].integer < 0)
            memcpy(v, from[k].table, 3 * sizeof *v);
        else {
            const char *word = p->choices;
            for (int64_t skip = from[k].integer; skip > 0 && strchr(word, '|'); skip--) word = strchr(word, '|') + 1;
            if (strcspn(word, "|") != 1 || *word < 'x' || *word > 'z') continue; /* "normal" turns by itself */
            v[*word - 'x'] = 1.0;
        }
        turn(Q, v, 3, 1);
        to[k].integer = -1, to[k].real = -1.0, to[k].table = v, to[k].rows = 1, to[k].columns = 3;
    }
}

static void compare_turned(ab_check *check, const ab_value *settings, const char *name, const double *got, const double *wanted,
                           size_t rows) {
    static const double LIKE = 1e-9;
    for (size_t i = 0; got && i < EDGES; i++) {
        double scale = 0.0;
        for (size_t r = 0; r < rows; r++)
            if (isfinite(wanted[r * LD + i])) scale = fmax(scale, fabs(wanted[r * LD + i]));
        for (size_t r = 0; r < rows; r++) {
            const double x = got[r * LD + i], y = wanted[r * LD + i];
            char words[700];
            if (fabs(x - y) > LIKE * (scale + 1e-300) || isnan(x) != isnan(y))
                ab_check_fail(check, "component %zu of %s is %.9g from turned input, and %.9g when what comes out is turned: %s", r, name,
                              x, y, edge_bench_words(check, &one, settings, i, words, sizeof words));
        }
    }
}

static void frame(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    const ab_class *class_ = &check->loaded->class_;
    static ab_value turned[AB_PARAMS_MAX];
    static double room[AB_PARAMS_MAX][3];
    for (uint32_t s = 0; s < class_->nstate; s++)
        if (class_->state[s].shape > AB_VECTOR) return;
    for (int n = 0; n < 4; n++) {
        const double a = ab_check_uniform(check, 0.0, 6.28), b = dimension == 3 ? ab_check_uniform(check, 0.0, 6.28) : 0.0;
        double Q[3][3] = {{cos(a), -sin(a) * cos(b), sin(a) * sin(b)}, {sin(a), cos(a) * cos(b), -cos(a) * sin(b)}, {0.0, sin(b), cos(b)}};
        for (int r = 0; r < 3 && n % 2; r++) Q[r][0] = -Q[r][0]; /* mirrored */
        edge_bench_prepare(check, &one, instance, settings, dimension);
        two = one, edge_bench_point(&two);
        double *inputs[] = {two.position, two.normal, two.displacement, two.velocity};
        for (size_t k = 0; k < sizeof inputs / sizeof *inputs; k++) turn_rows(Q, inputs[k], dimension);
        turn_states(check, &two, Q, two.state0), turn_states(check, &two, Q, two.state1);
        turn_settings(check, settings, Q, turned, room);
        ab_check_instance other;
        if (!ab_check_open(check, &other, turned, NULL))
            ab_check_fail(check, "create refuses turned directions: %s", other.service.message);
        if (edge_bench_apply(&one, instance) == 0 && edge_bench_apply(&two, &other) == 0) {
            bool free[LD] = {false};
            for (size_t i = 0; i < EDGES; i++)
                free[i] =
                    isnan(one.prescribed[i]) != isnan(one.prescribed[LD + i]); /* held along an axis alone: turned it is another one */
            turn_rows(Q, one.traction, dimension);
            turn_rows(Q, one.prescribed, dimension);
            turn_states(check, &one, Q, one.state1);
            for (size_t i = 0; i < EDGES; i++)
                for (uint32_t c = 0; free[i] && c < dimension; c++) one.prescribed[c * LD + i] = two.prescribed[c * LD + i] = 0.0;
            compare_turned(check, settings, "traction", two.edges.traction, one.traction, dimension);
            compare_turned(check, settings, "damping", two.edges.damping, one.damping, 2);
            compare_turned(check, settings, "stiffness", two.edges.stiffness, one.stiffness, 2);
            compare_turned(check, settings, "prescribed", two.edges.prescribed, one.prescribed, dimension);
            compare_turned(check, settings, "state1", two.edges.state1, one.state1, one.states);
        }
        ab_check_close(&other);
    }
}
static void keep_frame(ab_check *check) {
    if (check->loaded->class_.needs & AB_NEED_AXES)
        ab_check_skip(check, "the class says that its settings are of the axes of space (AB_NEED_AXES)");
    edge_bench_for_all(check, 8, frame);
}

const ab_check_promise ab_check_boundary[] = {
    {"again", "the same input gives the same bits when asked again", keep_again, true},
    {"anew", "an instance made anew gives the same bits", keep_anew, false},
    {"batch", "an edge has the same bits asked for alone and among many, for any ld", keep_batches, false},
    {"frame", "turned or mirrored edges get turned or mirrored tractions", keep_frame, false},
    {"differences", "damping and stiffness are what differences of the traction say, and not negative", ab_check_damping, false},
    {"passive", "a larger velocity, or displacement, gets no more traction along it where damping, or stiffness, is given",
     ab_check_passive, false},
    {"old-state", "state0, normals, velocities and all else that is handed in is not written", ab_check_edges_old, false},
    {"arrays", "nothing outside of the edges is read or written", ab_check_edges_arrays, false},
    {"unasked", "what it does not give may be NULL", ab_check_edges_unasked, false},
    {"finite", "finite numbers in, finite numbers out, or an error with a reason; every state written", ab_check_edges_finite, false},
    {"save-load", "what is saved and loaded goes on with the same bits", ab_check_edges_save, false},
    {.name = NULL},
};
