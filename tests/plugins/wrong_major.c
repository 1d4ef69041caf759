/* wrong_major.c: built for another major version of the interface. */
#define MAJOR (AB_ABI_MAJOR + 1)
#include "wrong.h"
