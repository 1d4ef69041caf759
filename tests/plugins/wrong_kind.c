/* wrong_kind.c: a class of a kind that is none. */
#define KIND 9
#include "wrong.h"
