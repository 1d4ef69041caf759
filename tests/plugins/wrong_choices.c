/* wrong_choices.c: a choice with nothing to choose from. */
#define PARAM {"way", NULL, "which way", NULL, AB_CHOICE, 0, 0, 0, 0}
#include "wrong.h"
