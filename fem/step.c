/* step.c: elements and nodes from the start of a step to its end. */
#include <math.h>
#include <string.h>

#include "core/initial.h"
#include "fem/domain.h"

/* ---- elements ------------------------------------------------------------------------------------------------------------ */

#if defined(__AVX512F__)
/* Pairs of four nodes of one lane, one behind the other. */
static inline v8 four_pairs(const double *pairs, const uint32_t *node) {
    const v2 a = v2_load(pairs + 2 * (size_t)node[0]), b = v2_load(pairs + 2 * (size_t)node[8]), c = v2_load(pairs + 2 * (size_t)node[16]),
             d = v2_load(pairs + 2 * (size_t)node[24]);
    return v8_join(__builtin_shufflevector(a, b, 0, 1, 2, 3), __builtin_shufflevector(c, d, 0, 1, 2, 3));
}

/* Whole rows are stored: a vector that is read where eight doubles were just written one by one waits for all of them. */
void fem_gather(const fem_body *body, size_t block, const double *pairs, double (*rows)[8]) {
    const int nodes = body->element->nodes;
    const uint32_t *node = body->connectivity + block * 8 * (size_t)nodes;
    for (int a = 0; a < nodes; a += 4) {
        v8 lane[8];
        for (int l = 0; l < 8; ++l) lane[l] = four_pairs(pairs, node + 8 * a + l);
        v8_transpose(lane);
        for (int r = 0; r < 8; ++r) v8_store(rows[2 * a + r], lane[r]);
    }
}
#else
void fem_gather(const fem_body *body, size_t block, const double *pairs, double (*rows)[8]) {
    const int nodes = body->element->nodes;
    const uint32_t *node = body->connectivity + block * 8 * (size_t)nodes;
    for (int a = 0; a < nodes; ++a)
        for (int l = 0; l < 8; ++l) {
            const double *pair = pairs + 2 * (size_t)node[8 * a + l];
            rows[2 * a][l] = pair[0];
            rows[2 * a + 1][l] = pair[1];
        }
}
#endif

static const double NEARLY = 0.01; /* of the det J of a square as large: an element with less at a corner is about to turn inside out */

/* The first lane of a block that is no element any more (NaN counts), or is about to be none, or -1. */
static int inverted(const fem_body *body, size_t number, const fem_block *block) {
    const int lanes = fem_lanes(body, number);
    const double least = body->scene->watch ? NEARLY : 0.0;
    for (int l = 0; l < lanes; ++l)
        if (!(block->jacobian[l] > least)) return l;
    return -1;
}

static void fetch(const fem_body *body, size_t number, fem_block *block) {
    const fem_element *element = body->element;
    for (int q = 0; q < element->gauss; ++q)
        memcpy(block->stress[q], fem_gauss_rows(body, number, q) + 8 * FEM_ROW_STRESS, sizeof block->stress[q]);
    if (element->extra)
        memcpy(block->extra, body->extra + number * 8 * (size_t)element->extra, (size_t)element->extra * sizeof block->extra[0]);
}

static void leave_force(fem_body *body, size_t number, fem_block *block) {
    const fem_element *element = body->element;
    if (element->extra)
        memcpy(body->extra + number * 8 * (size_t)element->extra, block->extra, (size_t)element->extra * sizeof block->extra[0]);
    element->force(block, body->f_bar);
    memcpy(body->element_force + number * 16 * (size_t)element->nodes, block->force, (size_t)(2 * element->nodes) * sizeof block->force[0]);
}

static fem_trouble step_group(fem_body *body, size_t group, const ab_step *step, size_t *culprit) {
    const fem_element *element = body->element;
    const size_t first = group * (size_t)body->blocks_per_group, left = body->blocks - first;
    const size_t count = left < (size_t)body->blocks_per_group ? left : (size_t)body->blocks_per_group, points = 8 * (size_t)element->gauss;
    fem_sums *sums = body->sums + group;
    *sums = (fem_sums){0};
    fem_block block[FEM_GROUP] __attribute__((aligned(64)));
    fem_batch batch;
    fem_batch_open(&batch, body, step);
    for (size_t k = 0; k < count; ++k) {
        fem_gather(body, first + k, body->x_start, block[k].start);
        fem_gather(body, first + k, body->x, block[k].end);
        fetch(body, first + k, block + k);
        element->strain(block + k, &body->elastic, body->f_bar, body->hourglass);
        const int lane = inverted(body, first + k, block + k);
        if (lane >= 0) {
            *culprit = 8 * (first + k) + (size_t)lane;
            return block[k].jacobian[lane] > 0.0 ? FEM_NEARLY_INVERTED : FEM_INVERTED;
        }
        fem_batch_strain(&batch, body, first + k, block + k, k * points);
    }
    if (fem_batch_call(&batch, body, count * points) != 0) {
        *culprit = 8 * first;
        for (size_t i = count * points; i-- > 0;) /* the first flagged one */
            if (batch.flag[i]) *culprit = 8 * (first + i / points) + i % 8;
        if (*culprit >= body->elements) *culprit = body->elements - 1;
        return FEM_MATERIAL;
    }
    for (size_t k = 0; k < count; ++k) {
        fem_batch_settle(&batch, body, first + k, block + k, k * points, sums);
        leave_force(body, first + k, block + k);
    }
    return FEM_FINE;
}

fem_trouble fem_elements_step(fem_body *body, const ab_step *step, size_t *culprit) {
    size_t first = SIZE_MAX; /* of the elements in trouble, whichever thread met it: four times its number, and its trouble */
#pragma omp parallel for schedule(static) num_threads(body->threads) reduction(min : first)
    for (size_t g = 0; g < body->groups; ++g) {
        size_t element = 0;
        const fem_trouble trouble = step_group(body, g, step, &element);
        if (trouble == FEM_FINE) continue;
        const size_t mark = 4 * element + (size_t)trouble;
        first = mark < first ? mark : first;
    }
    if (first == SIZE_MAX) return FEM_FINE;
    *culprit = first / 4;
    return (fem_trouble)(first % 4);
}

static ab_status start_elements(fem_body *body, const struct ab_initial *initial, ab_report *report) {
    const fem_element *element = body->element;
    const fem_rows rows = body->rows;
    ab_material_start own = body->start;
    for (size_t b = 0; b < body->blocks; ++b) {
        fem_block block __attribute__((aligned(64)));
        memset(&block, 0, sizeof block);
        fem_gather(body, b, body->x, block.start);
        memcpy(block.end, block.start, sizeof block.end);
        element->strain(&block, &body->elastic, body->f_bar, body->hourglass);
        v8 volume = v8_set(0.0);
        for (int q = 0; q < element->gauss; ++q) {
            double *point = fem_gauss_rows(body, b, q);
            if (initial) AB_TRY(fem_initial_point(body, initial, b, q, &own, report));
            memcpy(block.stress[q], own.stress, sizeof block.stress[q]);
            volume += v8_load(block.volume[q]);
            memcpy(point + 8 * FEM_ROW_STRESS, own.stress, sizeof own.stress);
            v8_store(point + 8 * FEM_ROW_MASS, v8_set(body->material->density) * v8_load(block.volume[q]));
            if (rows.gradient >= 0)
                v8_store(point + 8 * rows.gradient, v8_set(1.0)), v8_store(point + 8 * (rows.gradient + 3), v8_set(1.0));
            if (rows.gradient >= 0 && element->axisymmetric) v8_store(point + 8 * (rows.gradient + 4), v8_set(1.0));
            for (int s = 0; s < rows.states; ++s) memcpy(point + 8 * (rows.state + s), own.state[s], sizeof own.state[s]);
        }
        v8_store(body->volume_start + 8 * b, volume);
        leave_force(body, b, &block);
    }
    return AB_OK;
}

ab_status fem_elements_start(fem_body *body, const fem_faces *faces, ab_report *report) {
    struct ab_initial *initial = NULL;
    AB_TRY(fem_initial_open(body, faces, &initial, report));
    const double before = body->start.wave_speed;
    const ab_status status = start_elements(body, initial, report);
    ab_initial_close(initial);
    AB_TRY(status);
    if (body->start.wave_speed == before) return AB_OK;
    return ab_material_tangent(body->material, &body->service, body->self, &body->start, &body->elastic.lambda, &body->elastic.mu, report);
}

/* ---- nodes --------------------------------------------------------------------------------------------------------------- */

void fem_nodes_force(fem_body *body) {
#pragma omp parallel for schedule(static) num_threads(body->threads)
    for (size_t i = 0; i < body->nodes; ++i) {
        double x = 0.0, y = 0.0;
        for (size_t k = body->gather_start[i]; k < body->gather_start[i + 1]; ++k) {
            const double *f = body->element_force + body->gather[k];
            x += f[0];
            y += f[8];
        }
        body->force[2 * i] = -x;
        body->force[2 * i + 1] = -y;
    }
}

void fem_nodes_trial(fem_body *body, const ab_step *step) {
    const double g[2] = {body->gravity ? step->gravity[0] : 0.0, body->gravity ? step->gravity[1] : 0.0},
                 dt = step->from_rest ? 0.5 * step->dt : step->dt;
#pragma omp parallel for schedule(static) num_threads(body->threads)
    for (size_t i = 0; i < body->nodes; ++i)
        for (size_t c = 0; c < 2; ++c) {
            const size_t k = 2 * i + c;
            body->force[k] += body->mass[i] * g[c];
            body->velocity[k] = body->old[k] + dt * body->inverse_mass[k] * body->force[k];
        }
}

/* Local non-viscous damping (Cundall 1987), as of the points: against the velocity, in proportion to all that changed it in this step, contact included. It never
 * turns a velocity round. Returns the energy taken, J. */
static double damp(const fem_body *body, size_t i, double factor) {
    double taken = 0.0;
    for (size_t c = 0; c < 2; ++c) {
        const size_t k = 2 * i + c;
        if (body->inverse_mass[k] == 0.0) continue;
        const double old = body->old[k], v = body->velocity[k];
        const double change = -copysign(fmin(factor * fabs(v - old), fabs(v)), v);
        body->velocity[k] = v + change;
        taken -= body->mass[i] * change * 0.5 * (old + v + change);
    }
    return taken;
}

void fem_nodes_balance(fem_body *body, const ab_step *step) {
    const double g[2] = {body->gravity ? step->gravity[0] : 0.0, body->gravity ? step->gravity[1] : 0.0};
    body->unbalanced = body->applied = 0.0;
    for (size_t i = 0; i < body->nodes; ++i) {
        double out[2], weight[2];
        for (size_t c = 0; c < 2; ++c) {
            const double mass = body->inverse_mass[2 * i + c] > 0.0 ? body->mass[i] : 0.0;
            out[c] = mass * (body->velocity[2 * i + c] - body->old[2 * i + c]) / step->dt;
            weight[c] = mass * g[c];
        }
        body->unbalanced += hypot(out[0], out[1]);
        body->applied += hypot(weight[0], weight[1]);
        if (body->domain.spec->has_force) body->applied += hypot(body->body_force[2 * i], body->body_force[2 * i + 1]);
    }
    for (size_t k = 0; k < body->load_count; ++k)
        for (int a = 0; a < 3 && body->loads[k].node[a] != FEM_NONE; ++a)
            body->applied += hypot(body->loads[k].force[a][0], body->loads[k].force[a][1]);
}

/* Sums over a run of nodes. */
static void add_motion(const fem_body *body, size_t from, size_t to, fem_node_sums *s) {
    for (size_t i = from; i < to; ++i) {
        const double m = body->mass[i], x = body->x[2 * i], y = body->x[2 * i + 1], vx = body->velocity[2 * i],
                     vy = body->velocity[2 * i + 1];
        s->mass += m;
        s->kinetic += 0.5 * m * (vx * vx + vy * vy);
        s->momentum[0] += m * vx;
        s->momentum[1] += m * vy;
        s->angular += m * (x * vy - y * vx);
        s->first[0] += m * x;
        s->first[1] += m * y;
    }
}

static void sum_motion(fem_body *body) {
    fem_node_sums all = {0};
    for (size_t r = 0; r < body->runs; ++r) {
        const fem_node_sums *s = body->node_sums + r;
        all.mass += s->mass;
        all.kinetic += s->kinetic;
        all.angular += s->angular;
        all.damping += s->damping;
        all.weight += s->weight;
        for (int c = 0; c < 2; ++c) {
            all.momentum[c] += s->momentum[c];
            all.first[c] += s->first[c];
        }
    }
    body->energy.kinetic = all.kinetic;
    body->energy.damping += all.damping;
    body->energy.potential -= all.weight;
    body->motion = (ab_motion){.mass = all.mass};
    for (int c = 0; c < 2; ++c) {
        body->motion.momentum[c] = all.momentum[c];
        body->motion.centre[c] = all.first[c] / all.mass + body->origin[c];
    }
    body->motion.angular_momentum[2] = all.angular + body->origin[0] * all.momentum[1] - body->origin[1] * all.momentum[0];
}

void fem_nodes_finish(fem_body *body, const ab_step *step) {
    const double g[2] = {body->gravity ? step->gravity[0] : 0.0, body->gravity ? step->gravity[1] : 0.0}, dt = step->dt;
#pragma omp parallel for schedule(static) num_threads(body->threads)
    for (size_t r = 0; r < body->runs; ++r) {
        const size_t from = r * FEM_RUN, to = from + FEM_RUN < body->nodes ? from + FEM_RUN : body->nodes;
        fem_node_sums s = {0};
        for (size_t i = from; i < to; ++i) {
            if (step->damping > 0.0) s.damping += damp(body, i, step->damping);
            for (size_t c = 0; c < 2; ++c) {
                const size_t k = 2 * i + c;
                s.weight += dt * body->mass[i] * g[c] * 0.5 * (body->old[k] + body->velocity[k]);
                body->x_start[k] = body->x[k];
                body->x[k] += dt * body->velocity[k];
            }
        }
        add_motion(body, from, to, &s);
        body->node_sums[r] = s;
    }
    sum_motion(body);
    /* Forces gave half of what their work over the whole step is booked as: the rest, as large as what they gave, goes with what the stop has taken. */
    if (step->from_rest) body->energy.damping += body->energy.kinetic;
}

void fem_nodes_measure(fem_body *body) {
    for (size_t r = 0; r < body->runs; ++r) {
        const size_t from = r * FEM_RUN, to = from + FEM_RUN < body->nodes ? from + FEM_RUN : body->nodes;
        body->node_sums[r] = (fem_node_sums){0};
        add_motion(body, from, to, body->node_sums + r);
    }
    sum_motion(body);
}
