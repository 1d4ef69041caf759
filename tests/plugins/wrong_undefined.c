/* wrong_undefined.c: calls a function that is nowhere. */
int nowhere_to_be_found(void);
#define CONSTRUCTOR (void)nowhere_to_be_found()
#include "wrong.h"
