/* yardstick.c: what a machine can do. A bare material-point kernel - one elastic block in plane strain, every vector and cache trick that abut's own kernels know,
 * and nothing else: no plugins, no ledger, no sorting, no contact, no sides, no results. USL is the least that a step can be; MUSL maps velocities back to the nodes before it
 * strains the points, as abut does where a scene does not say otherwise. tests/bench/run puts abut's speed
 * beside it, so that figures of different machines, and of different hours on one machine, can be compared.
 *
 *     yardstick linear|gimp usl|musl PER_CELL POINTS THREADS WORK
 *
 * PER_CELL: 4 or 16. WORK: points times steps. Prints point-steps per second, after it has checked that mass and momentum are what they were. */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/vector.h"

#define UNROLL _Pragma("GCC unroll 8")
#define INLINE static inline __attribute__((always_inline))

enum { X, Y, VX, VY, SXX, SYY, SXY, MASS, VOLUME, NEXT_X, NEXT_Y, ROWS }; /* of a block of eight points */
enum { RECORD = 8, N_MASS = 0, N_MOMENTUM = 1, N_FORCE = 4 };             /* of a node: m, p, -, f, -, - */
enum { MARGIN = 4, AHEAD = 4, MOST_THREADS = 64 };

static const double CELL = 1.0, SPEED = 1.0, DENSITY = 1000.0, LAME = 5.77e7, SHEAR = 3.85e7;

typedef struct problem {
    double (*points)[ROWS][8];
    size_t blocks, columns, rows;                 /* blocks of points; nodes */
    double *nodes[MOST_THREADS];                  /* each thread scatters into its own */
    double *motion;                               /* velocity and its change in the step, 4 a node */
    size_t low[MOST_THREADS], high[MOST_THREADS]; /* rows of nodes that a thread's points reach */
    int threads, musl;
    double dt, half; /* s; m, half the size of a point */
} problem;

typedef struct weights {
    double n[2][3][8], g[2][3][8];
    int32_t node[8];
} __attribute__((aligned(64))) weights;

INLINE void ask_ahead(double (*block)[8]) {
    for (int r = 0; r < ROWS; ++r) __builtin_prefetch(block[ROWS * AHEAD + r], 0, 3);
}

INLINE v8 v8_size(v8 a) { return v8_max(a, -a); }

INLINE void weigh(const problem *p, const v8 place[2], weights *w, const int count) {
    v8 first[2];
    for (int c = 0; c < 2; ++c) {
        v8 n[3], g[3];
        const v8 one = v8_set(1.0), zero = v8_set(0.0);
        if (count == 2) {
            first[c] = v8_floor(place[c]);
            n[1] = place[c] - first[c], n[0] = one - n[1];
            g[1] = one, g[0] = -one;
        } else { /* GIMP: Bardenhagen and Kober, 2004 */
            const v8 l = v8_set(p->half), slope = v8_set(1.0 / p->half);
            first[c] = v8_floor(place[c] - v8_set(0.5));
            const v8 e = place[c] - first[c] - one;
            const v8 sign = v8_less(e, zero, -one, one);
            n[1] = v8_less(v8_size(e), l, one - (e * e + l * l) * v8_set(0.5) * slope, one - v8_size(e));
            g[1] = v8_less(v8_size(e), l, -e * slope, -sign);
            for (int k = 0; k < 3; k += 2) {
                const v8 r = k ? one - e : one + e, out = k ? one : -one, t = v8_max(one + l - r, zero);
                n[k] = v8_less(r, one - l, one - r, t * t * v8_set(0.25) * slope);
                g[k] = out * v8_less(r, one - l, one, t * v8_set(0.5) * slope);
            }
        }
        UNROLL for (int k = 0; k < count; ++k) v8_store(w->n[c][k], n[k]), v8_store(w->g[c][k], g[k]);
    }
    *(v8_int *)w->node = __builtin_convertvector(first[1] * v8_set((double)p->columns) + first[0], v8_int);
    V8_IN_MEMORY(*w);
}

/* Mass, momentum and internal force of a block to the nodes. */
INLINE void scatter(const problem *p, double *nodes, double (*block)[8], const int count) {
    const double upper[8] __attribute__((aligned(64))) = {0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0};
    const v8 lower_half = v8_load(upper);
    weights w;
    const v8 place[2] = {v8_load(block[X]), v8_load(block[Y])}, mass = v8_load(block[MASS]), volume = v8_load(block[VOLUME]);
    weigh(p, place, &w, count);
    const v8 shear = -volume * v8_load(block[SXY]);
    v8 point[8] = {mass,  mass * v8_load(block[VX]),    mass * v8_load(block[VY]), shear, -volume * v8_load(block[SXX]), shear,
                   shear, -volume * v8_load(block[SYY])};
    v8_transpose(point);
    UNROLL for (int l = 0; l < 8; ++l) {
        const v8 along = point[l], across = __builtin_shufflevector(along, along, 0, 1, 2, 3, 6, 7, 6, 7) * lower_half;
        double *node = nodes + RECORD * (size_t)w.node[l];
        UNROLL for (int j = 0; j < count; ++j) {
            const v8 a = along * v8_set(w.n[1][j][l]), c = across * v8_set(w.g[1][j][l]);
            UNROLL for (int i = 0; i < count; ++i) {
                double *at = node + RECORD * ((size_t)j * p->columns + (size_t)i);
                v8_store(at, v8_load(at) + a * v8_two(&w.n[0][i][l], &w.g[0][i][l], 0xf0) + c * v8_set(w.n[0][i][l]));
            }
        }
    }
}

/* What the nodes' motion is at a point: velocity and its change, and the gradient of velocity (xx, yx, xy, yy). */
INLINE void look(const problem *p, const weights *w, v8 point[8], const int count) {
    UNROLL for (int l = 0; l < 8; ++l) {
        v4 value = v4_set(0.0), by_x = value, by_y = value;
        UNROLL for (int j = 0; j < count; ++j) {
            const double *at = p->motion + 4 * ((size_t)w->node[l] + (size_t)j * p->columns);
            v4 n = v4_load(at) * v4_set(w->n[0][0][l]), g = v4_load(at) * v4_set(w->g[0][0][l]);
            UNROLL for (int i = 1; i < count; ++i) {
                n += v4_load(at + 4 * i) * v4_set(w->n[0][i][l]);
                g += v4_load(at + 4 * i) * v4_set(w->g[0][i][l]);
            }
            value += n * v4_set(w->n[1][j][l]);
            by_x += g * v4_set(w->n[1][j][l]);
            by_y += n * v4_set(w->g[1][j][l]);
        }
        point[l] = v8_join(value, __builtin_shufflevector(by_x, by_y, 0, 1, 4, 5));
    }
    v8_transpose(point);
}

INLINE void strain(const problem *p, double (*block)[8], const v8 point[8]) {
    const v8 dt = v8_set(p->dt), lame = v8_set(LAME), twice = v8_set(2.0 * SHEAR), shear = v8_set(SHEAR);
    const v8 xx = dt * point[4], yy = dt * point[7], xy = dt * (point[5] + point[6]), mean = lame * (xx + yy);
    v8_store(block[SXX], v8_load(block[SXX]) + mean + twice * xx);
    v8_store(block[SYY], v8_load(block[SYY]) + mean + twice * yy);
    v8_store(block[SXY], v8_load(block[SXY]) + shear * xy);
    v8_store(block[VOLUME], v8_load(block[VOLUME]) * (v8_set(1.0) + xx + yy));
}

/* USL: points move with the nodes, strain with them, and give the nodes what they need for the next step. */
INLINE void gather(const problem *p, double *nodes, size_t from, size_t to, const int count) {
    const v8 dt = v8_set(p->dt);
    for (size_t b = from; b < to; ++b) {
        double(*block)[8] = p->points[b];
        ask_ahead(block);
        weights w;
        v8 place[2] = {v8_load(block[X]), v8_load(block[Y])}, point[8];
        weigh(p, place, &w, count);
        look(p, &w, point, count);
        v8_store(block[X], place[0] + dt * point[0]), v8_store(block[Y], place[1] + dt * point[1]);
        v8_store(block[VX], v8_load(block[VX]) + point[2]), v8_store(block[VY], v8_load(block[VY]) + point[3]);
        strain(p, block, point);
        scatter(p, nodes, block, count);
    }
}

/* MUSL, first sweep: new velocities and places of the points, and their momentum back to the nodes. */
INLINE void move(const problem *p, double *nodes, size_t from, size_t to, const int count) {
    const v8 dt = v8_set(p->dt);
    for (size_t b = from; b < to; ++b) {
        double(*block)[8] = p->points[b];
        ask_ahead(block);
        weights w;
        const v8 place[2] = {v8_load(block[X]), v8_load(block[Y])}, mass = v8_load(block[MASS]);
        v8 point[8];
        weigh(p, place, &w, count);
        v4 moved[8];
        UNROLL for (int l = 0; l < 8; ++l) {
            moved[l] = v4_set(0.0);
            UNROLL for (int j = 0; j < count; ++j) {
                const double *at = p->motion + 4 * ((size_t)w.node[l] + (size_t)j * p->columns);
                v4 n = v4_load(at) * v4_set(w.n[0][0][l]);
                UNROLL for (int i = 1; i < count; ++i) n += v4_load(at + 4 * i) * v4_set(w.n[0][i][l]);
                moved[l] += n * v4_set(w.n[1][j][l]);
            }
        }
        v8_transpose_half(moved, point);
        const v8 vx = v8_load(block[VX]) + point[2], vy = v8_load(block[VY]) + point[3];
        v8_store(block[NEXT_X], place[0] + dt * point[0]), v8_store(block[NEXT_Y], place[1] + dt * point[1]);
        v8_store(block[VX], vx), v8_store(block[VY], vy);
        double given[4][8] __attribute__((aligned(64)));
        v8_store(given[0], mass), v8_store(given[1], mass * vx), v8_store(given[2], mass * vy);
        V8_IN_MEMORY(given);
        UNROLL for (int l = 0; l < 8; ++l) {
            const v4 one = {given[0][l], given[1][l], given[2][l], 0.0};
            double *node = nodes + RECORD * (size_t)w.node[l];
            UNROLL for (int j = 0; j < count; ++j) {
                const v4 a = one * v4_set(w.n[1][j][l]);
                UNROLL for (int i = 0; i < count; ++i) {
                    double *at = node + RECORD * ((size_t)j * p->columns + (size_t)i);
                    v4_store(at, v4_load(at) + a * v4_set(w.n[0][i][l]));
                }
            }
        }
    }
}

/* MUSL, second sweep: the points strain with the nodes, stand at their new places, and give the nodes what they need for the next step. */
INLINE void deform(const problem *p, double *nodes, size_t from, size_t to, const int count) {
    for (size_t b = from; b < to; ++b) {
        double(*block)[8] = p->points[b];
        ask_ahead(block);
        weights w;
        const v8 place[2] = {v8_load(block[X]), v8_load(block[Y])};
        v8 point[8];
        weigh(p, place, &w, count);
        look(p, &w, point, count);
        strain(p, block, point);
        v8_store(block[X], v8_load(block[NEXT_X])), v8_store(block[Y], v8_load(block[NEXT_Y]));
        scatter(p, nodes, block, count);
    }
}

/* One row of nodes: sums of the threads' records in their order, velocities, and records back to nothing. */
static void update_row(const problem *p, size_t row) {
    int who[MOST_THREADS], count = 0;
    for (int t = 0; t < p->threads; ++t)
        if (row >= p->low[t] && row <= p->high[t]) who[count++] = t;
    if (count == 0) return;
    for (size_t k = row * p->columns; k < (row + 1) * p->columns; ++k) {
        v8 sum = v8_load(p->nodes[who[0]] + RECORD * k);
        v8_store(p->nodes[who[0]] + RECORD * k, v8_set(0.0));
        for (int t = 1; t < count; ++t) {
            sum += v8_load(p->nodes[who[t]] + RECORD * k);
            v8_store(p->nodes[who[t]] + RECORD * k, v8_set(0.0));
        }
        double node[RECORD] __attribute__((aligned(64))), motion[4] = {0.0, 0.0, 0.0, 0.0};
        v8_store(node, sum);
        if (node[N_MASS] > 1e-9)
            for (int c = 0; c < 2; ++c) {
                motion[2 + c] = p->dt * node[N_FORCE + c] / node[N_MASS];
                motion[c] = node[N_MOMENTUM + c] / node[N_MASS] + motion[2 + c];
            }
        memcpy(p->motion + 4 * k, motion, sizeof motion);
    }
}

INLINE void update_rows(const problem *p) {
#pragma omp barrier
#pragma omp for schedule(static)
    for (size_t row = 0; row < p->rows; ++row) update_row(p, row);
}

INLINE void steps_of(const problem *p, long steps, const int count) {
    const size_t me = (size_t)omp_get_thread_num(), all = (size_t)p->threads;
    const size_t from = p->blocks * me / all, to = p->blocks * (me + 1) / all;
    for (long s = 0; s < steps; ++s) {
        update_rows(p);
        if (!p->musl) {
            gather(p, p->nodes[me], from, to, count);
        } else {
            move(p, p->nodes[me], from, to, count);
            update_rows(p);
            deform(p, p->nodes[me], from, to, count);
        }
    }
}

static void run(const problem *p, long steps, int count) {
#pragma omp parallel num_threads(p->threads)
    {
        if (count == 2)
            steps_of(p, steps, 2);
        else
            steps_of(p, steps, 3);
    }
}

/* A square of about `points` points in the order of their cells, flying; blocks beyond the last are there for the prefetch. */
static int build(problem *p, int per_cell, double points) {
    const size_t a_side = per_cell == 16 ? 4 : 2, side = (size_t)fmax(rint(sqrt(points / per_cell)), 1.0);
    const double size = CELL / (double)a_side;
    p->half = 0.5 * size;
    p->dt = 0.2 * CELL / sqrt((LAME + 2.0 * SHEAR) / DENSITY);
    p->columns = p->rows = side + 2 * MARGIN;
    p->blocks = side * side * a_side * a_side / 8;
    p->points = aligned_alloc(64, (p->blocks + AHEAD + 1) * sizeof *p->points);
    p->motion = aligned_alloc(64, p->columns * p->rows * 4 * sizeof(double));
    if (!p->points || !p->motion || p->blocks == 0) return 0;
    memset(p->points, 0, (p->blocks + AHEAD + 1) * sizeof *p->points);
    size_t k = 0;
    for (size_t cell = 0; cell < side * side; ++cell)
        for (size_t q = 0; q < a_side * a_side && k < 8 * p->blocks; ++q, ++k) {
            double(*block)[8] = p->points[k / 8];
            block[X][k % 8] = MARGIN + (double)(cell % side) + size * ((double)(q % a_side) + 0.4);
            block[Y][k % 8] = MARGIN + (double)(cell / side) + size * ((double)(q / a_side) + 0.4);
            block[VX][k % 8] = SPEED * sin((double)(cell / side) * 6.28 / (double)side) * 1e-3;
            block[MASS][k % 8] = DENSITY * size * size, block[VOLUME][k % 8] = size * size;
        }
    for (int t = 0; t < p->threads; ++t) {
        p->nodes[t] = aligned_alloc(64, p->columns * p->rows * RECORD * sizeof(double));
        if (!p->nodes[t]) return 0;
        memset(p->nodes[t], 0, p->columns * p->rows * RECORD * sizeof(double));
        const size_t from = p->blocks * (size_t)t / (size_t)p->threads, to = p->blocks * ((size_t)t + 1) / (size_t)p->threads;
        p->low[t] = (size_t)p->points[from][Y][0] - 2, p->high[t] = (size_t)p->points[to - 1][Y][7] + 3;
    }
    return 1;
}

static void totals(const problem *p, double sum[3]) {
    sum[0] = sum[1] = sum[2] = 0.0;
    for (size_t b = 0; b < p->blocks; ++b)
        for (int l = 0; l < 8; ++l) {
            const double mass = p->points[b][MASS][l];
            sum[0] += mass, sum[1] += mass * p->points[b][VX][l], sum[2] += mass * fabs(p->points[b][VX][l]);
        }
}

int main(int argc, char **argv) {
    const int gimp = argc == 7 && strcmp(argv[1], "gimp") == 0;
    problem p = {.threads = argc == 7 ? atoi(argv[5]) : 0, .musl = argc == 7 && strcmp(argv[2], "musl") == 0};
    if (argc != 7 || (!gimp && strcmp(argv[1], "linear") != 0) || (!p.musl && strcmp(argv[2], "usl") != 0) || p.threads < 1 ||
        p.threads > MOST_THREADS) {
        fprintf(stderr, "yardstick linear|gimp usl|musl 4|16 POINTS THREADS WORK\n");
        return 2;
    }
    if (!build(&p, atoi(argv[3]), atof(argv[4]))) return fprintf(stderr, "yardstick: no memory, or no points\n"), 1;
    double before[3], after[3];
    totals(&p, before);
    const long steps = (long)fmax(atof(argv[6]) / (8.0 * (double)p.blocks), 20.0);
    for (int t = 0; t < p.threads; ++t)
        for (size_t b = p.blocks * (size_t)t / (size_t)p.threads; b < p.blocks * ((size_t)t + 1) / (size_t)p.threads; ++b)
            scatter(&p, p.nodes[t], p.points[b], gimp ? 3 : 2);
    run(&p, 3, gimp ? 3 : 2);
    const double start = omp_get_wtime();
    run(&p, steps, gimp ? 3 : 2);
    const double seconds = omp_get_wtime() - start;
    totals(&p, after);
    if (!(fabs(after[1] - before[1]) <= 1e-11 * before[2]) || !(after[2] < 2.0 * before[2]) || !(after[2] < 0.999999 * before[2])) {
        fprintf(stderr, "yardstick: momentum %.17g kg m/s became %.17g, moduli %.6g became %.6g\n", before[1], after[1], before[2],
                after[2]);
        return 1;
    }
    printf("%.6g\n", 8.0 * (double)p.blocks * (double)steps / seconds);
    return 0;
}
