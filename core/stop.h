/* stop.h: a run that is asked to end by a signal ends after its step; one that is asked again ends at once. */
#ifndef AB_STOP_H
#define AB_STOP_H

#include <signal.h>

enum { AB_STOP_SIGNALS = 3 }; /* SIGINT, SIGTERM, SIGHUP */

/* s after the first signal in which another does not count: `timeout` and a terminal send theirs to the program and to its group, so that it comes twice within microseconds. */
#define AB_STOP_PAUSE 0.5

typedef struct ab_stop_keeper { /* what signals did before */
    struct sigaction ending[AB_STOP_SIGNALS], size;
} ab_stop_keeper;

/* From here on a signal is only noted, and writing past a limit on the size of files is an error of the write, not a death. */
void ab_stop_catch(ab_stop_keeper *keeper);
void ab_stop_release(const ab_stop_keeper *keeper);
/* The number of the first signal since ab_stop_catch, or 0. */
int ab_stop_signal(void);

#endif
