/* check_edges.c: edges of a boundary that are moved about as a host would. */
#include "core/check_edges.h"

#include <math.h>
#include <string.h>

void edge_bench_point(edge_bench *b) {
    ab_edges *e = &b->edges;
    e->position = b->position, e->normal = b->normal, e->displacement = b->displacement, e->velocity = b->velocity;
    e->area = b->area, e->density = b->density, e->p_wave_speed = b->p_wave_speed, e->s_wave_speed = b->s_wave_speed;
    e->traction = b->traction;
    e->damping = b->damping, e->stiffness = b->stiffness, e->prescribed = b->prescribed;
    e->state0 = b->state0, e->state1 = b->state1;
    e->flag = b->flag;
}

/* Edges of soil at rest, as a boundary begins to act. */
void edge_bench_begin(ab_check *check, edge_bench *b, uint32_t dimension) {
    const ab_class *class_ = &check->loaded->class_;
    memset(b, 0, sizeof *b);
    b->states = (size_t)ab_guard_state_rows(class_, dimension);
    b->edges = (ab_edges){.struct_size = sizeof(ab_edges), .dimension = dimension, .count = EDGES, .ld = LD, .time = 0.0, .dt = 1e-4};
    edge_bench_point(b);
    size_t row = 0;
    for (uint32_t s = 0; s < class_->nstate; s++) {
        const uint32_t shape = class_->state[s].shape;
        const size_t rows = shape == AB_SCALAR      ? 1
                            : shape == AB_VECTOR    ? dimension
                            : shape == AB_SYMMETRIC ? (dimension == 2 ? 4 : 6)
                            : dimension == 2        ? 5
                                                    : 9;
        for (size_t r = 0; r < rows; r++, row++)
            for (size_t i = 0; i < LD; i++) b->state0[row * LD + i] = b->state1[row * LD + i] = class_->state[s].initial;
    }
    for (size_t i = 0; i < LD; i++) {
        double n[3] = {0};
        ab_check_unit_vector(check, dimension, n);
        for (uint32_t c = 0; c < dimension; c++) {
            b->normal[c * LD + i] = n[c];
            b->position[c * LD + i] = ab_check_uniform(check, 0.0, 10.0);
            b->velocity[c * LD + i] = ab_check_uniform(check, -0.5, 0.5);
        }
        b->area[i] = pow(10.0, ab_check_uniform(check, -2.0, 0.0));
        b->density[i] = ab_check_uniform(check, 1500.0, 2200.0);
        b->s_wave_speed[i] = ab_check_uniform(check, 50.0, 300.0);
        b->p_wave_speed[i] = b->s_wave_speed[i] * ab_check_uniform(check, 1.5, 4.0);
    }
}

/* As the host asks: what is to be written is zeroed, prescribed free. */
int edge_bench_apply(edge_bench *b, const ab_check_instance *instance) {
    memset(b->traction, 0, sizeof b->traction);
    memset(b->damping, 0, sizeof b->damping);
    memset(b->stiffness, 0, sizeof b->stiffness);
    memset(b->flag, 0, sizeof b->flag);
    for (size_t k = 0; k < 3 * LD; k++) b->prescribed[k] = NAN;
    return instance->loaded->boundary.apply(instance->self, &b->edges);
}

const char *edge_bench_words(const ab_check *check, const edge_bench *b, const ab_value *settings, size_t i, char *text, size_t size) {
    const ab_edges *e = &b->edges;
    char set[300];
    ab_check_words(check, settings, set, sizeof set);
    snprintf(text, size,
             "%s; %uD, t = %.4g s, normal (%.3g, %.3g), displacement (%.4g, %.4g) m, velocity (%.4g, %.4g) m/s, density %.4g kg/m3, waves "
             "%.4g and %.4g m/s",
             set, e->dimension, e->time, e->normal[i], e->normal[e->ld + i], e->displacement[i], e->displacement[e->ld + i], e->velocity[i],
             e->velocity[e->ld + i], e->density[i], e->p_wave_speed[i], e->s_wave_speed[i]);
    return text;
}

/* The next step: the edges move, turn and stretch a little, and have other velocities. */
void edge_bench_move(ab_check *check, edge_bench *b) {
    const uint32_t d = b->edges.dimension;
    memcpy(b->state0, b->state1, sizeof b->state0);
    b->edges.time += b->edges.dt;
    for (size_t i = 0; i < LD; i++) {
        double size = 0.0;
        for (uint32_t c = 0; c < d; c++) {
            const double step = b->velocity[c * LD + i] * b->edges.dt;
            b->position[c * LD + i] += step, b->displacement[c * LD + i] += step;
            b->velocity[c * LD + i] += ab_check_uniform(check, -0.1, 0.1);
            b->normal[c * LD + i] += ab_check_uniform(check, -1e-3, 1e-3);
            size += b->normal[c * LD + i] * b->normal[c * LD + i];
        }
        for (uint32_t c = 0; c < d; c++) b->normal[c * LD + i] /= sqrt(size);
        b->area[i] *= 1.0 + ab_check_uniform(check, -1e-3, 1e-3);
    }
}

/* Edges after a few steps, ready to be asked about the next one. */
void edge_bench_prepare(ab_check *check, edge_bench *b, const ab_check_instance *instance, const ab_value *settings, uint32_t dimension) {
    edge_bench_begin(check, b, dimension);
    for (int n = 0; n < 4; n++) {
        char words[700];
        ab_check_trying(check, "apply: %s", edge_bench_words(check, b, settings, 0, words, sizeof words));
        if (edge_bench_apply(b, instance) != 0)
            ab_check_fail(check, "apply gives up on plain edges: %s: %s",
                          instance->service.message[0] ? instance->service.message : "no reason",
                          edge_bench_words(check, b, settings, 0, words, sizeof words));
        edge_bench_move(check, b);
    }
    b->edges.time = ab_check_uniform(check, 0.0, 8.0); /* records of the check last as long as that */
}

bool edge_bench_fits(ab_check *check, const ab_value *settings, uint32_t dimension) {
    static edge_bench bench;
    if (!(check->loaded->class_.needs & AB_NEED_WHOLE_SIDE)) return true;
    ab_check_instance instance;
    if (!ab_check_open(check, &instance, settings, NULL)) ab_check_fail(check, "create refuses settings that it took before");
    edge_bench_begin(check, &bench, dimension);
    char words[700];
    ab_check_trying(check, "apply: %s", edge_bench_words(check, &bench, settings, 0, words, sizeof words));
    const bool fits = edge_bench_apply(&bench, &instance) == 0 || !instance.service.message[0];
    ab_check_close(&instance);
    return fits;
}

void edge_bench_for_all(ab_check *check, size_t most, edge_bench_each what) {
    const uint32_t spaces = check->loaded->class_.spaces;
    bool found = false;
    for (size_t v = 0; v < check->shared->variants && v < most; v++)
        for (uint32_t d = 2; d <= 3; d++) {
            if (!(spaces & (d == 2 ? AB_PLANE_STRAIN | AB_AXISYMMETRIC : AB_SPACE_3D))) continue;
            ab_check_instance instance;
            check->random = 53 + v;
            if (!edge_bench_fits(check, check->shared->settings[v], d)) continue;
            found = true;
            check->random = 53 + v;
            if (!ab_check_open(check, &instance, check->shared->settings[v], NULL))
                ab_check_fail(check, "create refuses settings that it took before");
            what(check, check->shared->settings[v], &instance, d);
            ab_check_close(&instance);
        }
    if (!found) ab_check_skip(check, "no settings were found for which the edges of the check are a side; give some by --set KEY=VALUE");
}
