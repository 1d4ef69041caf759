/* wrong_class_size.c: a class struct of a size that no version has. */
#define CLASS_SIZE 16
#include "wrong.h"
