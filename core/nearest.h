/* nearest.h: "did you mean": the known name that a mistyped word is closest to. */
#ifndef AB_NEAREST_H
#define AB_NEAREST_H

#include <stddef.h>

/* The name with the fewest changed, missing, added or swapped letters (capitals and '_' for '-' count nothing); the first of equals.
 * NULL where none is near: more than a third of the letters (at least one) would have to change. NULL names are passed over. */
const char *ab_nearest(const char *word, const char *const *names, size_t count);

#endif
