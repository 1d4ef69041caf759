/* wrong_no_name.c: a class without a name. */
#define CLASS_NAME NULL
#include "wrong.h"
