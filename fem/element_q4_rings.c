/* element_q4_rings.c: fem/element_q4.c once more, for rings about an axis. */
#define RINGS 1
#include "fem/element_q4.c"
