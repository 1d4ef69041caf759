/* element_q6_rings.c: fem/element_q6.c once more, for rings about an axis. */
#define RINGS 1
#include "fem/element_q6.c"
