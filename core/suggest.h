/* suggest.h: the name a user may have meant, and lists of names for messages. */
#ifndef AB_SUGGEST_H
#define AB_SUGGEST_H

#include <stddef.h>

/* The nearest of the names by edits (insert, delete, replace, swap of neighbours, ignoring case, '-' and '_' alike), or NULL when none is
 * near enough to be meant. */
const char *ab_suggest(const char *word, const char *const *names, size_t count);

/* Writes the tail of a message: "; did you mean 'x'?", or, when nothing is near and the list is short, "; known: a, b, c", or
 * nothing for an empty list. Returns buffer. */
const char *ab_suggest_tail(const char *word, const char *const *names, size_t count, char *buffer, size_t size);

#endif
