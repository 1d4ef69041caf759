/* suggest.c: nearest names by the distance of Damerau and Levenshtein (adjacent swaps count one). */
#include "core/suggest.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST = 64, MOST_NAMES = 2000, MOST_LISTED = 24, MOST_EDITS = 3 };

static int folded(char c) { return c == '-' ? '_' : tolower((unsigned char)c); }

static int fold(const char *from, char *to) {
    int n = 0;
    for (; from[n] != '\0'; n++) to[n] = (char)folded(from[n]);
    return n;
}

/* Edits from a to b, both folded and at most LONGEST characters, or most + 1 where it takes more: what they share at both ends is left out, and only
 * the band of the table that can matter is filled. */
static int distance(const char *a, int a_length, const char *b, int b_length, int most) {
    if (abs(a_length - b_length) > most) return most + 1;
    while (a_length > 0 && b_length > 0 && a[0] == b[0]) a++, b++, a_length--, b_length--;
    while (a_length > 0 && b_length > 0 && a[a_length - 1] == b[b_length - 1]) a_length--, b_length--;
    int rows[3][LONGEST + 2];
    int *before = rows[0], *above = rows[1], *row = rows[2];
    for (int j = 0; j <= b_length + 1; j++) rows[0][j] = rows[1][j] = rows[2][j] = most + 1;
    for (int j = 0; j <= b_length && j <= most; j++) above[j] = j;
    for (int i = 1; i <= a_length; i++) {
        const int first = i - most > 1 ? i - most : 1, last = i + most < b_length ? i + most : b_length;
        int least = most + 1;
        row[first - 1] = first == 1 && i <= most ? i : most + 1;
        if (first == 1) least = row[0];
        for (int j = first; j <= last; j++) {
            const int same = a[i - 1] == b[j - 1];
            int best = above[j - 1] + !same;
            if (above[j] + 1 < best) best = above[j] + 1;
            if (row[j - 1] + 1 < best) best = row[j - 1] + 1;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && before[j - 2] + 1 < best) best = before[j - 2] + 1;
            row[j] = best;
            if (best < least) least = best;
        }
        row[last + 1] = most + 1;
        if (least > most) return most + 1;
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
    char wanted[LONGEST + 1], name[LONGEST + 1];
    fold(word, wanted);
    int least = length <= 2 ? 1 : length <= 5 ? 2 : MOST_EDITS;
    if (count > MOST_NAMES) count = MOST_NAMES;
    for (size_t i = 0; i < count; i++) {
        const size_t other = strlen(names[i]);
        if (other > LONGEST) continue;
        const int edits = distance(wanted, (int)length, name, fold(names[i], name), least);
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
