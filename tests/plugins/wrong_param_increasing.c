/* wrong_param_increasing.c: a number whose first column is to grow. */
#define PARAM { "E", "Pa", "Young's modulus", NULL, AB_REAL, AB_REQUIRED | AB_INCREASING, 0, 0, INFINITY }
#include "wrong.h"
