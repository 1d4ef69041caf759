/* wrong_duplicate.c: a class that a built-in plugin offers. */
#define CLASS_NAME "linear-elastic"
#include "wrong.h"
