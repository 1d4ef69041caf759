/* places.c: ABUT_BUILD and ABUT_SOURCE of a unit test that is started by hand: the folders it was built in and from. What the caller sets, as ctest does, holds. */
#define _GNU_SOURCE
#include <stdlib.h>

__attribute__((constructor)) static void set_places(void) {
    setenv("ABUT_BUILD", PLACE_OF_BUILD, 0);
    setenv("ABUT_SOURCE", PLACE_OF_SOURCE, 0);
}
