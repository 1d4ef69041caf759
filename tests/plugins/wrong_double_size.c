/* wrong_double_size.c: numbers of another size. */
#define DOUBLE_SIZE 4
#include "wrong.h"
