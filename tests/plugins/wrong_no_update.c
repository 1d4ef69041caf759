/* wrong_no_update.c: a material without the function that makes its stress. */
#define UPDATE NULL
#include "wrong.h"
