/* wrong_unit.c: a number without a unit. */
#define PARAM {"E", NULL, "modulus", NULL, AB_REAL, AB_REQUIRED, 0, 0, 1}
#include "wrong.h"
