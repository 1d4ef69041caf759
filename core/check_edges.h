/* check_edges.h: edges of a boundary that are moved about as a host would, for check_boundary*.c. */
#ifndef AB_CHECK_EDGES_H
#define AB_CHECK_EDGES_H

#include "core/check.h"

enum { EDGES = 24, LD = 32, SLACK = 512, STATES = 64 * 9 };

typedef struct edge_bench {
    ab_edges edges;
    size_t states;
    double position[3 * LD + SLACK], normal[3 * LD + SLACK], displacement[3 * LD + SLACK], velocity[3 * LD + SLACK];
    double area[LD + SLACK], density[LD + SLACK], p_wave_speed[LD + SLACK], s_wave_speed[LD + SLACK];
    double traction[3 * LD + SLACK], damping[2 * LD + SLACK], stiffness[2 * LD + SLACK], prescribed[3 * LD + SLACK];
    double state0[STATES * LD + SLACK], state1[STATES * LD + SLACK];
    uint8_t flag[LD + SLACK];
} edge_bench;

/* Pointers of a bench into its own arrays: everything that edges may have, whether the class gives it or not. */
void edge_bench_point(edge_bench *b);
/* Edges of soil, as a boundary begins to act. */
void edge_bench_begin(ab_check *check, edge_bench *b, uint32_t dimension);
/* As the host asks: what is to be written is zeroed, prescribed free. */
int edge_bench_apply(edge_bench *b, const ab_check_instance *instance);
/* Settings and edge i, in words. */
const char *edge_bench_words(const ab_check *check, const edge_bench *b, const ab_value *settings, size_t i, char *text, size_t size);
/* The next step: the edges move, turn and stretch a little, and have other velocities. */
void edge_bench_move(ab_check *check, edge_bench *b);
/* Edges after a few steps, ready to be asked about the next one. */
void edge_bench_prepare(ab_check *check, edge_bench *b, const ab_check_instance *instance, const ab_value *settings, uint32_t dimension);

/* False where a class that looks along the whole side (AB_NEED_WHOLE_SIDE) says that these edges are no side for such settings. */
bool edge_bench_fits(ab_check *check, const ab_value *settings, uint32_t dimension);

typedef void (*edge_bench_each)(ab_check *, const ab_value *, ab_check_instance *, uint32_t dimension);
/* Calls it for the first `most` sets of settings and every dimension. */
void edge_bench_for_all(ab_check *check, size_t most, edge_bench_each what);

#endif
