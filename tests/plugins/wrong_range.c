/* wrong_range.c: a range that holds nothing. */
#define PARAM {"E", "Pa", "modulus", NULL, AB_REAL, AB_REQUIRED, 0, 2, 1}
#include "wrong.h"
