/* element_q4r_rings.c: fem/element_q4r.c once more, for rings about an axis. */
#define RINGS 1
#include "fem/element_q4r.c"
