/* wrong_empty_data.c: the descriptor is memory that is filled while the program runs. */
#include "abut_plugin.h"
extern AB_EXPORT ab_plugin wrong_alias __asm__("abut_plugin_v1");
AB_EXPORT ab_plugin wrong_alias;
