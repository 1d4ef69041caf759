/* wrong_no_symbol.c: a shared object without the symbol. */
#define NO_DESCRIPTOR
extern const int abut_plugin;
const int abut_plugin = 1;
#include "wrong.h"
