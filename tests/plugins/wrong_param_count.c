/* wrong_param_count.c: more settings than anybody has. */
#define PARAM_COUNT 100000
#include "wrong.h"
