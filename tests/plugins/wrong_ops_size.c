/* wrong_ops_size.c: an operations struct of a size that no version has. */
#define OPS_SIZE 400
#include "wrong.h"
