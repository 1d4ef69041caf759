/* wrong_param_null.c: settings counted and not there. */
#define PARAMS NULL
#include "wrong.h"
