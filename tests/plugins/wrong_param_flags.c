/* wrong_param_flags.c: a setting with flags that are none. */
#define PARAM {"E", "Pa", "modulus", NULL, AB_REAL, 0x4000, 1, 0, 2}
#include "wrong.h"
