/* suggest.c: nearest names by the distance of Damerau and Levenshtein (adjacent swaps count one). */
#include "core/suggest.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { LONGEST = 64, MOST_NAMES = 2000, MOST_LISTED = 24 };

static int folded(char c) { return c == '-' ? '_' : tolower((unsigned char)c); }

/* Edits from a to b; both at most LONGEST characters. */
static int distance(const char *a, size_t a_length, const char *b, size_t b_length) {
    int rows[3][LONGEST + 1];
    int *before = rows[0], *above = rows[1], *row = rows[2];
    for (size_t j = 0; j <= b_length; j++) above[j] = (int)j;
    for (size_t i = 1; i <= a_length; i++) {
        row[0] = (int)i;
        for (size_t j = 1; j <= b_length; j++) {
            const int same = folded(a[i - 1]) == folded(b[j - 1]);
            int best = above[j - 1] + !same;
            if (above[j] + 1 < best) best = above[j] + 1;
            if (row[j - 1] + 1 < best) best = row[j - 1] + 1;
            if (i > 1 && j > 1 && folded(a[i - 1]) == folded(b[j - 2]) && folded(a[i - 2]) == folded(b[j - 1]) && before[j - 2] + 1 < best)
                best = before[j - 2] + 1;
            row[j] = best;
        }
        int *spare = before;
        before = above;
        above = row;
        row = spare;
    }
    return above[b_length];
}

const char *ab_suggest(const char *word, const char *const *names, size_t count) {
    const size_t length = strlen(word);
    if (length == 0 || length > LONGEST) return NULL;
    const char *nearest = NULL;
    int least = length <= 2 ? 1 : length <= 5 ? 2 : (int)(length / 3 + 1);
    if (count > MOST_NAMES) count = MOST_NAMES;
    for (size_t i = 0; i < count; i++) {
        const size_t other = strlen(names[i]);
        if (other > LONGEST) continue;
        const int edits = distance(word, length, names[i], other);
        if (edits < least || (edits == least && nearest == NULL)) {
            if ((size_t)edits >= other && other > 0 && edits > 0) continue; /* every letter would have to change */
            least = edits;
            nearest = names[i];
        }
    }
    return nearest;
}

const char *ab_suggest_tail(const char *word, const char *const *names, size_t count, char *buffer, size_t size) {
    buffer[0] = '\0';
    const char *nearest = ab_suggest(word, names, count);
    if (nearest != NULL) {
        snprintf(buffer, size, "; did you mean '%s'?", nearest);
        return buffer;
    }
    size_t used = 0;
    for (size_t i = 0; i < count && i < MOST_LISTED && used + 4 < size; i++) {
        const int wrote = snprintf(buffer + used, size - used, "%s%.*s", i == 0 ? "; known: " : ", ", LONGEST, names[i]);
        used += (size_t)wrote;
    }
    if (count > MOST_LISTED && used + 6 < size) snprintf(buffer + used, size - used, ", ...");
    return buffer;
}
