/* wrong_param_type.c: a setting of a type that is none. */
#define PARAM {"E", "Pa", "modulus", NULL, 77, 0, 1, 0, 2}
#include "wrong.h"
