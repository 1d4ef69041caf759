/* check_bench.c: items of a material on their way through small strains. */
#include "core/check_bench.h"

#include <math.h>
#include <string.h>

static const double DENSITY = 1800.0;

void bench_dimensions(const ab_class *class_, uint32_t dimension[3]) {
    size_t count = 0;
    memset(dimension, 0, 3 * sizeof *dimension);
    if (class_->spaces & (AB_PLANE_STRAIN | AB_AXISYMMETRIC)) dimension[count++] = 2;
    if (class_->spaces & AB_SPACE_3D) dimension[count++] = 3;
}

void bench_batch(bench *b, const ab_check_instance *instance, size_t count, double dt) {
    const ab_class *class_ = &instance->loaded->class_;
    b->batch = (ab_batch){.struct_size = sizeof(ab_batch),
                          .dimension = b->dimension,
                          .components = (uint32_t)b->components,
                          .count = count,
                          .ld = BENCH_LD,
                          .time = 1.0,
                          .dt = dt,
                          .density = b->density,
                          .strain_increment = b->strain,
                          .deformation_gradient = b->F,
                          .velocity_gradient = b->L,
                          .stress0 = b->stress0,
                          .stress1 = b->stress1,
                          .state0 = class_->nstate ? b->state0 : NULL,
                          .state1 = class_->nstate ? b->state1 : NULL,
                          .dissipation = class_->gives & AB_GIVE_DISSIPATION ? b->dissipation : NULL,
                          .wave_speed = b->speed,
                          .flag = b->flag};
}

int bench_update(bench *b, const ab_check_instance *instance) {
    memset(b->flag, 0, sizeof b->flag);
    return instance->loaded->material.update(instance->self, &b->batch);
}

static const int PLANE_F[3][3] = {{0, 1, -1}, {2, 3, -1}, {-1, -1, 4}};

static double get(const double *a, uint32_t dimension, int i, int j, size_t item) {
    const int row = dimension == 3 ? 3 * i + j : PLANE_F[i][j];
    return row < 0 ? 0.0 : a[row * BENCH_LD + (int)item];
}

void bench_increment(ab_check *check, bench *b, double dt) {
    static const int PAIR[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    for (size_t i = 0; i < BENCH_ITEMS; i++) {
        double H[3][3] = {{0}}, F[3][3], moved[3][3];
        for (int c = 0; c < b->components; c++) {
            const bool out = b->dimension == 2 && c == 2; /* plane strain */
            const double e = out ? 0.0 : b->amplitude[i] * ab_check_uniform(check, -1.0, 1.0);
            const int p = PAIR[c][0], q = PAIR[c][1];
            b->strain[c * BENCH_LD + (int)i] = e;
            if (c < 3)
                H[p][p] = e;
            else
                H[p][q] = H[q][p] = 0.5 * e;
        }
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) F[r][c] = get(b->F, b->dimension, r, c, i);
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) {
                moved[r][c] = F[r][c];
                for (int k = 0; k < 3; k++) moved[r][c] += H[r][k] * F[k][c];
                const int row = b->dimension == 3 ? 3 * r + c : PLANE_F[r][c];
                if (row >= 0) b->F[row * BENCH_LD + (int)i] = moved[r][c];
                if (b->dimension == 3 || (r < 2 && c < 2))
                    b->L[(b->dimension == 3 ? 3 * r + c : 2 * r + c) * BENCH_LD + (int)i] = dt > 0.0 ? H[r][c] / dt : 0.0;
            }
        b->density[i] /= 1.0 + H[0][0] + H[1][1] + H[2][2];
    }
    bench_batch(b, &(ab_check_instance){.loaded = check->loaded}, BENCH_ITEMS, dt);
}

void bench_accept(bench *b) {
    memcpy(b->stress0, b->stress1, sizeof b->stress0);
    memcpy(b->state0, b->state1, sizeof b->state0);
}

void bench_start(ab_check *check, bench *b, const ab_check_instance *instance, uint32_t dimension) {
    const ab_class *class_ = &instance->loaded->class_;
    memset(b, 0, sizeof *b);
    b->dimension = dimension;
    b->components = dimension == 2 ? 4 : 6;
    b->gradients = dimension == 2 ? 5 : 9;
    b->states = ab_guard_state_rows(class_, dimension);
    int row = 0;
    for (uint32_t s = 0; s < class_->nstate; s++) {
        const uint32_t shape = class_->state[s].shape;
        const int rows = shape == AB_SCALAR      ? 1
                         : shape == AB_VECTOR    ? (int)dimension
                         : shape == AB_SYMMETRIC ? b->components
                                                 : b->gradients;
        for (int r = 0; r < rows; r++, row++)
            for (size_t i = 0; i < BENCH_LD; i++)
                b->state0[row * BENCH_LD + (int)i] = b->state1[row * BENCH_LD + (int)i] = class_->state[s].initial;
    }
    for (size_t i = 0; i < BENCH_LD; i++) {
        b->density[i] = DENSITY;
        for (int r = 0; r < 3; r++) b->F[(dimension == 3 ? 4 * r : PLANE_F[r][r]) * BENCH_LD + (int)i] = 1.0;
        b->amplitude[i] = pow(10.0, ab_check_uniform(check, -6.0, -2.5));
    }
    if (!instance->loaded->material.start) return;
    bench_batch(b, instance, BENCH_ITEMS, 0.0);
    ab_check_trying(check, "start");
    memset(b->flag, 0, sizeof b->flag);
    const int code = instance->loaded->material.start(instance->self, &b->batch);
    if (code != 0)
        ab_check_fail(check, "start returned %d and gave %s%s", code, instance->service.message[0] ? "the reason: " : "no reason",
                      instance->service.message);
    bench_accept(b);
}

void bench_drive(ab_check *check, bench *b, const ab_check_instance *instance, int steps) {
    static bench before; /* large, and a process checks one thing at a time */
    for (int step = 0, tries = 0; step < steps; tries++) {
        before = *b;
        bench_increment(check, b, 1e-4);
        char words[300];
        ab_check_trying(check, "update: %s", bench_words(check, b, NULL, 0, words, sizeof words));
        const bool good = bench_update(b, instance) == 0;
        if (good) {
            bench_accept(b);
            step++;
            continue;
        }
        *b = before;
        for (size_t i = 0; i < BENCH_ITEMS; i++) b->amplitude[i] *= 0.3;
        if (tries > 12 + steps) ab_check_fail(check, "update gives up for any strain, however small: %s", instance->service.message);
    }
}

const char *bench_words(const ab_check *check, const bench *b, const ab_value *settings, size_t item, char *text, size_t size) {
    char set[300] = "";
    if (settings) ab_check_words(check, settings, set, sizeof set);
    int used = snprintf(text, size, "%s%s%uD, strain increment (", set, settings ? "; " : "", b->dimension);
    for (int c = 0; c < b->components && used > 0 && (size_t)used < size; c++)
        used += snprintf(text + used, size - (size_t)used, "%s%.3g", c ? ", " : "", b->strain[c * BENCH_LD + (int)item]);
    if (used > 0 && (size_t)used < size) used += snprintf(text + used, size - (size_t)used, "), stress0 (");
    for (int c = 0; c < b->components && used > 0 && (size_t)used < size; c++)
        used += snprintf(text + used, size - (size_t)used, "%s%.3g", c ? ", " : "", b->stress0[c * BENCH_LD + (int)item]);
    if (used > 0 && (size_t)used < size) snprintf(text + used, size - (size_t)used, ")");
    return text;
}
