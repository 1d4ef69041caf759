/* wrong_default.c: a default outside of its own range. */
#define PARAM {"E", "Pa", "modulus", NULL, AB_REAL, 0, 5, 0, 2}
#include "wrong.h"
