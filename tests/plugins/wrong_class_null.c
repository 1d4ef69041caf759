/* wrong_class_null.c: a class pointer that is NULL. */
#define CLASSES &wrong_class, NULL
#include "wrong.h"
