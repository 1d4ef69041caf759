/* wrong_struct_size.c: a descriptor of a size that no version has. */
#define STRUCT_SIZE (sizeof(ab_plugin) - 8)
#include "wrong.h"
