/* wrong_fast_math.c: right in its source, and linked with -ffast-math, which makes GCC before 13 add a start-up file that turns denormal
 * numbers off. Later compilers do not; the test then expects it to be taken. */
#define CONSTRUCTOR (void)0
#include "wrong.h"
