/* stop.c: see stop.h. */
#define _GNU_SOURCE
#include "core/stop.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <time.h>
#include <unistd.h>

static const int ENDING[AB_STOP_SIGNALS] = {SIGINT, SIGTERM, SIGHUP};

/* All that a handler may touch. Two threads may be in it at once: whoever sets `first` had the first signal. ns of CLOCK_MONOTONIC; 0: none yet. */
static atomic_llong first;
static atomic_int number;
_Static_assert(ATOMIC_LLONG_LOCK_FREE == 2 && ATOMIC_INT_LOCK_FREE == 2, "a signal handler may wait for no lock");

/* The first one ends the run after its step; whoever sends another later does not want to wait: files are whole at any moment. */
static void on_signal(int signal) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t); /* safe in a handler by POSIX */
    const long long now = t.tv_sec * 1000000000LL + t.tv_nsec + 1;
    long long before = 0;
    if (atomic_compare_exchange_strong(&first, &before, now))
        atomic_store(&number, signal);
    else if ((double)(now - before) > 1e9 * AB_STOP_PAUSE)
        _exit(128 + signal);
}

void ab_stop_catch(ab_stop_keeper *keeper) {
    const struct sigaction action = {.sa_handler = on_signal}, ignore = {.sa_handler = SIG_IGN};
    atomic_store(&number, 0);
    atomic_store(&first, 0);
    for (int k = 0; k < AB_STOP_SIGNALS; ++k) sigaction(ENDING[k], &action, &keeper->ending[k]);
    sigaction(SIGXFSZ, &ignore, &keeper->size);
}

void ab_stop_release(const ab_stop_keeper *keeper) {
    for (int k = 0; k < AB_STOP_SIGNALS; ++k) sigaction(ENDING[k], &keeper->ending[k], NULL);
    sigaction(SIGXFSZ, &keeper->size, NULL);
}

int ab_stop_signal(void) { return atomic_load_explicit(&number, memory_order_relaxed); }
