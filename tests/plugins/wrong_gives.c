/* wrong_gives.c: a material that gives what only a contact class can. */
#define GIVES (AB_GIVE_STRESS | AB_GIVE_WAVE_SPEED | AB_GIVE_IMPULSE)
#include "wrong.h"
