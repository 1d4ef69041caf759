/* nearest.c: the distance of Damerau and Levenshtein (optimal string alignment) over short names. */
#include "core/nearest.h"

#include <ctype.h>
#include <string.h>

enum { longest = 63 }; /* longer words are not looked up */

static int folded(char letter) { return letter == '_' ? '-' : tolower((unsigned char)letter); }

static int smaller(int a, int b) { return a < b ? a : b; }

static int distance(const char *a, const char *b) {
    const int length_a = (int)strlen(a), length_b = (int)strlen(b);
    int row[3][longest + 2]; /* the row before last, the last, and the current one */
    if (length_a > longest || length_b > longest) return 2 * longest;
    for (int j = 0; j <= length_b; j++) row[1][j] = j;
    for (int i = 1; i <= length_a; i++) {
        row[2][0] = i;
        for (int j = 1; j <= length_b; j++) {
            const int differs = folded(a[i - 1]) != folded(b[j - 1]);
            int best = smaller(row[1][j - 1] + differs, smaller(row[1][j], row[2][j - 1]) + 1);
            if (i > 1 && j > 1 && folded(a[i - 1]) == folded(b[j - 2]) && folded(a[i - 2]) == folded(b[j - 1]))
                best = smaller(best, row[0][j - 2] + 1);
            row[2][j] = best;
        }
        memcpy(row[0], row[1], sizeof row[0]);
        memcpy(row[1], row[2], sizeof row[1]);
    }
    return row[1][length_b];
}

const char *ab_nearest(const char *word, const char *const *names, size_t count) {
    const int length = (int)strlen(word);
    const int limit = length < 5 ? 1 : length / 3;
    const char *nearest = NULL;
    int least = limit + 1;
    for (size_t i = 0; i < count; i++) {
        if (!names[i]) continue;
        const int far = distance(word, names[i]);
        if (far < least && far < length) {
            least = far;
            nearest = names[i];
        }
    }
    return nearest;
}
