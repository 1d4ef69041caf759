/* check_boundary_law.c: promises of a boundary about its answers: damping, stiffness, energy, memory, finite numbers, what it saves. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/check_edges.h"

static edge_bench one, two, plain; /* large; every promise has a process of its own */

void ab_check_damping(ab_check *);
void ab_check_passive(ab_check *);
void ab_check_edges_old(ab_check *);
void ab_check_edges_arrays(ab_check *);
void ab_check_edges_unasked(ab_check *);
void ab_check_edges_finite(ab_check *);
void ab_check_edges_save(ab_check *);

/* ---- damping and stiffness --------------------------------------------------------------------------------------------------------- */

/* Traction per velocity (or displacement) along `along`, by central differences, against minus the tensor that rows (along the normal, across it) stand for. */
static void differ(ab_check *check, const ab_value *settings, const ab_check_instance *instance, uint32_t dimension, bool velocity) {
    static const double LIKE = 1e-5;
    const char *const name = velocity ? "damping" : "stiffness";
    const double small = velocity ? 1e-4 : 1e-6;
    char words[700];
    for (uint32_t axis = 0; axis < dimension; axis++) {
        for (int sign = 0; sign < 2; sign++) {
            edge_bench *b = sign ? &two : &one;
            *b = plain, edge_bench_point(b);
            double *moved = (velocity ? b->velocity : b->displacement) + axis * LD;
            for (size_t i = 0; i < EDGES; i++) moved[i] += sign ? small : -small;
            if (edge_bench_apply(b, instance) != 0) return;
        }
        const double *rows = velocity ? one.damping : one.stiffness, *other = velocity ? two.damping : two.stiffness;
        for (size_t i = 0; i < EDGES; i++) {
            const double along = 0.5 * (rows[i] + other[i]), across = 0.5 * (rows[LD + i] + other[LD + i]);
            for (int r = 0; r < 2; r++)
                if (!(rows[(size_t)r * LD + i] >= 0.0) || !isfinite(rows[(size_t)r * LD + i]))
                    ab_check_fail(check, "%s %s the normal is %g %s: %s", name, r ? "across" : "along", rows[(size_t)r * LD + i],
                                  velocity ? "Pa s/m" : "Pa/m", edge_bench_words(check, &one, settings, i, words, sizeof words));
            double size = 0.0;
            for (uint32_t c = 0; c < dimension; c++)
                size = fmax(size, fmax(fabs(one.traction[c * LD + i]), fabs(two.traction[c * LD + i])));
            for (uint32_t c = 0; c < dimension; c++) {
                const double n = one.normal[c * LD + i] * one.normal[axis * LD + i], said = along * n + across * ((c == axis) - n);
                const double found = -(two.traction[c * LD + i] - one.traction[c * LD + i]) / (2.0 * small);
                if (fabs(found - said) > LIKE * fmax(along, across) + 1e-13 * size / small)
                    ab_check_fail(check,
                                  "the %s that it says is %.9g %s for component %u of the traction and motion along axis %u; differences "
                                  "say %.9g: %s",
                                  name, said, velocity ? "Pa s/m" : "Pa/m", c, axis, found,
                                  edge_bench_words(check, &one, settings, i, words, sizeof words));
            }
        }
    }
}

static void differences(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    const uint32_t gives = check->loaded->class_.gives;
    edge_bench_prepare(check, &plain, instance, settings, dimension);
    if (gives & AB_GIVE_DAMPING) differ(check, settings, instance, dimension, true);
    if (gives & AB_GIVE_STIFFNESS) differ(check, settings, instance, dimension, false);
}

void ab_check_damping(ab_check *check) {
    if (!(check->loaded->class_.gives & (AB_GIVE_DAMPING | AB_GIVE_STIFFNESS)))
        ab_check_skip(check, "the class gives neither damping nor stiffness");
    edge_bench_for_all(check, 8, differences);
}

/* ---- energy ------------------------------------------------------------------------------------------------------------------------- */

/* (t(v + d) - t(v)) . d <= 0 for any d: what differs between two motions never grows by the boundary. */
static void monotone(ab_check *check, const ab_value *settings, const ab_check_instance *instance, uint32_t dimension, bool velocity) {
    static const double SIZE[] = {1e-3, 0.1, 10.0};
    for (int k = 0; k < 6; k++) {
        two = plain, edge_bench_point(&two);
        double *moved = velocity ? two.velocity : two.displacement;
        const double size = SIZE[k % 3] * (velocity ? 1.0 : 0.01);
        double d[3 * LD] = {0};
        for (size_t i = 0; i < EDGES; i++)
            for (uint32_t c = 0; c < dimension; c++) moved[c * LD + i] += d[c * LD + i] = ab_check_uniform(check, -size, size);
        one = plain, edge_bench_point(&one);
        if (edge_bench_apply(&one, instance) != 0 || edge_bench_apply(&two, instance) != 0) return;
        for (size_t i = 0; i < EDGES; i++) {
            double power = 0.0, scale = 0.0;
            for (uint32_t c = 0; c < dimension; c++) {
                const double a = one.traction[c * LD + i], b = two.traction[c * LD + i];
                power += (b - a) * d[c * LD + i];
                scale += (fabs(a) + fabs(b)) * fabs(d[c * LD + i]);
            }
            char words[700];
            if (power > 1e-12 * scale)
                ab_check_fail(
                    check,
                    "a %s that is larger by (%.4g, %.4g) %s gets a traction that is larger by (%.6g, %.6g) Pa: that makes energy: %s",
                    velocity ? "velocity" : "displacement", d[i], d[LD + i], velocity ? "m/s" : "m", two.traction[i] - one.traction[i],
                    two.traction[LD + i] - one.traction[LD + i], edge_bench_words(check, &one, settings, i, words, sizeof words));
        }
    }
}

static void passive(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    const uint32_t gives = check->loaded->class_.gives;
    edge_bench_prepare(check, &plain, instance, settings, dimension);
    if (gives & AB_GIVE_DAMPING) monotone(check, settings, instance, dimension, true);
    if (gives & AB_GIVE_STIFFNESS) monotone(check, settings, instance, dimension, false);
}

void ab_check_passive(ab_check *check) {
    if (!(check->loaded->class_.gives & (AB_GIVE_DAMPING | AB_GIVE_STIFFNESS)))
        ab_check_skip(check, "the class gives neither damping nor stiffness");
    edge_bench_for_all(check, 8, passive);
}

/* ---- memory ------------------------------------------------------------------------------------------------------------------------- */

/* What the class does not give, as the host hands it over. */
static void leave_out(const ab_check *check, edge_bench *b) {
    const uint32_t gives = check->loaded->class_.gives;
    if (!(gives & AB_GIVE_DAMPING)) b->edges.damping = NULL;
    if (!(gives & AB_GIVE_STIFFNESS)) b->edges.stiffness = NULL;
    if (!(gives & AB_GIVE_MOTION)) b->edges.prescribed = NULL;
    if (!check->loaded->class_.nstate) b->edges.state0 = b->edges.state1 = NULL;
}

static void guarded(ab_check *check, ab_promise promise) {
    static const size_t COUNT[] = {EDGES, 1, 3, 7, 8, 9, 17};
    const bool whole = check->loaded->class_.needs & AB_NEED_WHOLE_SIDE;
    for (uint32_t d = 2; d <= 3; d++) {
        if (!(check->loaded->class_.spaces & (d == 2 ? AB_PLANE_STRAIN | AB_AXISYMMETRIC : AB_SPACE_3D))) continue;
        for (size_t v = 0; v < check->shared->variants && v < 6; v++) {
            ab_check_instance other, instance;
            ab_loaded_class guard;
            const ab_value *settings = check->shared->settings[v];
            check->random = 53 + v;
            if (!edge_bench_fits(check, settings, d)) continue;
            check->random = 53 + v;
            if (!ab_check_open(check, &other, settings, NULL) || !ab_check_open(check, &instance, settings, &guard))
                ab_check_fail(check, "create refuses settings that it took before");
            edge_bench_prepare(check, &one, &other, settings, d);
            for (size_t k = 0; k < (whole ? 1 : sizeof COUNT / sizeof *COUNT); k++) {
                two = one, edge_bench_point(&two), leave_out(check, &two);
                two.edges.count = COUNT[k];
                ab_check_trying(check, "apply for %zu edges", COUNT[k]);
                if (edge_bench_apply(&two, &instance) != 0 && ab_guard_broken(instance.self) == promise)
                    ab_check_fail(check, "%s", instance.service.message);
            }
            ab_check_close(&instance);
            ab_check_close(&other);
        }
    }
}
void ab_check_edges_old(ab_check *check) { guarded(check, AB_PROMISE_OLD); }
void ab_check_edges_arrays(ab_check *check) { guarded(check, AB_PROMISE_ARRAYS); }

static void unasked(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    edge_bench_prepare(check, &one, instance, settings, dimension);
    two = one, edge_bench_point(&two), leave_out(check, &two);
    if (edge_bench_apply(&one, instance) != 0) return;
    ab_check_trying(check, "apply with NULL for %s%s%s%s", two.edges.damping ? "" : "damping ", two.edges.stiffness ? "" : "stiffness ",
                    two.edges.prescribed ? "" : "prescribed ", two.edges.state0 ? "" : "state0, state1");
    if (edge_bench_apply(&two, instance) != 0)
        ab_check_fail(check, "it gives up without what it does not give: %s", instance->service.message);
    if (memcmp(one.traction, two.traction, sizeof one.traction))
        ab_check_fail(check, "the traction is another one without what it does not give");
}
void ab_check_edges_unasked(ab_check *check) { edge_bench_for_all(check, 8, unasked); }

/* ---- finite numbers ---------------------------------------------------------------------------------------------------------------- */

static void look(ab_check *check, const ab_value *settings, const char *name, const double *array, size_t rows, bool may_be_free) {
    char words[700];
    for (size_t r = 0; r < rows; r++)
        for (size_t i = 0; i < EDGES; i++) {
            const double x = array[r * LD + i];
            if (ab_guard_poisoned(x))
                ab_check_fail(check, "row %zu of %s is not written for edge %zu of %d: %s", r, name, i, (int)EDGES,
                              edge_bench_words(check, &two, settings, i, words, sizeof words));
            if (isfinite(x) || (may_be_free && isnan(x))) continue;
            ab_check_fail(check, "row %zu of %s is %g: %s", r, name, x, edge_bench_words(check, &two, settings, i, words, sizeof words));
        }
}

static void numbers(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    static const double TIME[] = {0.0, -1.0, 1e-9, 3.5, 1e6}, SPEED[] = {1.0, 0.0, 1e4}, DT[] = {1e-4, 1e-12};
    edge_bench_prepare(check, &plain, instance, settings, dimension);
    for (int n = 0; n < 5 * 3 * 2; n++) {
        two = plain, edge_bench_point(&two);
        two.edges.time = TIME[n % 5], two.edges.dt = DT[n / 15];
        for (size_t i = 0; i < EDGES; i++) {
            if (i % 4 == 1) two.area[i] = 0.0;         /* stretched to nothing, or not there yet */
            if (i % 3 == 1) two.s_wave_speed[i] = 0.0; /* a fluid */
            if (i % 5 == 1) two.density[i] = 1e-3;
            for (uint32_t c = 0; c < dimension; c++)
                two.velocity[c * LD + i] *= SPEED[n / 5 % 3], two.displacement[c * LD + i] *= SPEED[n / 5 % 3];
        }
        for (size_t k = 0; k < two.states * LD; k++) two.state1[k] = ab_guard_poison();
        instance->service.message[0] = '\0';
        char words[700];
        ab_check_trying(check, "apply: %s", edge_bench_words(check, &two, settings, 0, words, sizeof words));
        const int code = edge_bench_apply(&two, instance);
        if (code != 0) {
            bool flagged = false;
            for (size_t i = 0; i < EDGES; i++) flagged = flagged || two.flag[i];
            if (!flagged && !instance->service.message[0])
                ab_check_fail(check, "apply returned %d, flagged nothing and gave no reason: %s", code,
                              edge_bench_words(check, &two, settings, 0, words, sizeof words));
            continue;
        }
        const uint32_t gives = check->loaded->class_.gives;
        look(check, settings, "traction", two.traction, dimension, false);
        if (gives & AB_GIVE_DAMPING) look(check, settings, "damping", two.damping, 2, false);
        if (gives & AB_GIVE_STIFFNESS) look(check, settings, "stiffness", two.stiffness, 2, false);
        if (gives & AB_GIVE_MOTION) look(check, settings, "prescribed", two.prescribed, dimension, true);
        look(check, settings, "state1", two.state1, two.states, false);
    }
}
void ab_check_edges_finite(ab_check *check) { edge_bench_for_all(check, AB_CHECK_VARIANTS, numbers); }

/* ---- saved and loaded -------------------------------------------------------------------------------------------------------------- */

typedef struct kept {
    char *bytes;
    size_t count, read, room;
} kept;

static int write_kept(void *context, const void *bytes, size_t count) {
    kept *k = context;
    if (count > k->room - k->count) {
        char *larger = realloc(k->bytes, 2 * k->room + count);
        if (!larger) return -1;
        k->bytes = larger, k->room = 2 * k->room + count;
    }
    if (count) memcpy(k->bytes + k->count, bytes, count);
    k->count += count;
    return 0;
}

static int read_kept(void *context, void *bytes, size_t count) {
    kept *k = context;
    if (count > k->count - k->read) return -1;
    if (count) memcpy(bytes, k->bytes + k->read, count);
    k->read += count;
    return 0;
}

static void saved(ab_check *check, const ab_value *settings, ab_check_instance *instance, uint32_t dimension) {
    edge_bench_prepare(check, &one, instance, settings, dimension);
    if (edge_bench_apply(&one, instance) != 0) return;
    kept k = {0};
    const ab_stream stream = {.struct_size = sizeof stream, .context = &k, .write = write_kept, .read = read_kept};
    ab_check_instance other;
    if (!ab_check_open(check, &other, settings, NULL)) ab_check_fail(check, "create refuses settings that it took before");
    ab_check_trying(check, "save");
    if (instance->loaded->class_.save(instance->self, &stream) != 0) ab_check_fail(check, "save gives up: %s", instance->service.message);
    ab_check_trying(check, "load of %zu bytes", k.count);
    if (other.loaded->class_.load(other.self, &stream) != 0)
        ab_check_fail(check, "load refuses what save wrote: %s", other.service.message);
    if (k.read != k.count) ab_check_fail(check, "load reads %zu of the %zu bytes that save wrote", k.read, k.count);
    for (int n = 0; n < 4; n++) {
        edge_bench_move(check, &one);
        two = one, edge_bench_point(&two);
        if (edge_bench_apply(&one, instance) != 0 || edge_bench_apply(&two, &other) != 0) break;
        char words[700];
        for (size_t c = 0; c < dimension * LD; c++)
            if (memcmp(one.traction + c, two.traction + c, sizeof *one.traction))
                ab_check_fail(check, "step %d after load: the traction is %.17g, and %.17g where nothing was saved and loaded: %s", n,
                              two.traction[c], one.traction[c], edge_bench_words(check, &one, settings, c % LD, words, sizeof words));
    }
    free(k.bytes);
    ab_check_close(&other);
}

void ab_check_edges_save(ab_check *check) {
    if (!check->loaded->class_.save) ab_check_skip(check, "the class keeps nothing beside its states");
    edge_bench_for_all(check, 8, saved);
}
