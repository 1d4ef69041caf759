/* share.c: runs of tiles for threads, and taking from them. */
#include "mpm/share.h"

#include <omp.h>
#include <stdatomic.h>
#include <stdlib.h>

/* A run, with a cache line (and the one that is fetched beside it) of its own. left: what nobody has taken yet, first tile and the one behind the last. */
struct mpm_share {
    _Alignas(128) _Atomic uint64_t left;
    uint32_t first, last;
};

enum { NODES_COST = 2 }; /* of a tile's nodes, in blocks of points */

static uint64_t run_of(uint32_t first, uint32_t last) { return (uint64_t)first << 32 | last; }

/* Anew after the tiles or the number of threads have changed. False: no memory. */
static bool divide(mpm_body *body) {
    const size_t threads = (size_t)body->threads;
    if (body->share_count == threads && body->shared_version == body->version) return true;
    if (body->share_count != threads) {
        free(body->shares);
        body->shares = aligned_alloc(128, threads * sizeof *body->shares);
        body->share_count = body->shares ? threads : 0;
        if (!body->shares) return false;
    }
    size_t whole = 0, done = 0, tile = 0;
    for (size_t k = 0; k < body->tile_count; ++k) whole += body->tiles[k].blocks + NODES_COST;
    for (size_t t = 0; t < threads; ++t) {
        body->shares[t].first = (uint32_t)tile;
        /* a tile goes to whom its middle belongs */
        for (; tile < body->tile_count; ++tile) {
            const size_t cost = body->tiles[tile].blocks + NODES_COST;
            if (t + 1 < threads && (2 * done + cost) * threads >= 2 * whole * (t + 1)) break;
            done += cost;
        }
        body->shares[t].last = (uint32_t)tile;
    }
    body->shared_version = body->version;
    return true;
}

/* The next tile of a run from its beginning or from its end, or -1. Every second thread goes from the end to the beginning, so that two neighbours meet. */
static long take(struct mpm_share *share, bool from_end) {
    uint64_t left = atomic_load_explicit(&share->left, memory_order_relaxed), rest;
    uint32_t first, last;
    do {
        first = (uint32_t)(left >> 32), last = (uint32_t)left;
        if (first >= last) return -1;
        rest = from_end ? run_of(first, last - 1) : run_of(first + 1, last);
    } while (!atomic_compare_exchange_weak_explicit(&share->left, &left, rest, memory_order_relaxed, memory_order_relaxed));
    return from_end ? (long)last - 1 : (long)first;
}

void mpm_each_tile(mpm_body *body, mpm_visit visit, void *context) {
    const size_t threads = (size_t)body->threads;
    if (threads == 1 || !divide(body)) { /* one thread needs no list */
        for (size_t k = 0; k < body->tile_count; ++k) visit(body, k, context);
        return;
    }
    for (size_t t = 0; t < threads; ++t)
        atomic_store_explicit(&body->shares[t].left, run_of(body->shares[t].first, body->shares[t].last), memory_order_relaxed);
#pragma omp parallel num_threads((int)threads)
    {
        const size_t own = (size_t)omp_get_thread_num();
        for (size_t turn = 0; turn < threads; ++turn) {
            const size_t whose = (own + turn) % threads;
            const bool from_end = (whose % 2 == 1) != (turn > 0); /* others' from where they come last */
            for (long k = take(body->shares + whose, from_end); k >= 0; k = take(body->shares + whose, from_end))
                visit(body, (size_t)k, context);
        }
    }
}

void mpm_share_destroy(mpm_body *body) { free(body->shares); }
