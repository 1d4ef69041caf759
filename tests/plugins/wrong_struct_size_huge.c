/* wrong_struct_size_huge.c: a descriptor that says it goes on behind its end. */
#define STRUCT_SIZE 4000
#include "wrong.h"
