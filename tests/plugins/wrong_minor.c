/* wrong_minor.c: built for a newer minor version of the interface than the host's. */
#define MINOR (AB_ABI_MINOR + 1)
#include "wrong.h"
