/* wrong_nothing.c: nothing is wrong with it; the tests need to know that their wrong plugins are refused for the one thing. */
#define CONSTRUCTOR (void)0
#include "wrong.h"
