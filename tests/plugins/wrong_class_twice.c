/* wrong_class_twice.c: the same class twice in one file. */
#define CLASSES &wrong_class, &wrong_class
#include "wrong.h"
