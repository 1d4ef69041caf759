/* element_q8_rings.c: fem/element_q8.c once more, for rings about an axis. */
#define RINGS 1
#include "fem/element_q8.c"
