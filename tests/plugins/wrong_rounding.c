/* wrong_rounding.c: changes the direction of rounding for the whole program as it is loaded. */
#include <fenv.h>
#define CONSTRUCTOR fesetround(FE_UPWARD)
#include "wrong.h"
