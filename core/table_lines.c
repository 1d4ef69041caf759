/* table_lines.c: lines, cells and numbers of a text of columns. */
#include "core/table_lines.h"

#include <ctype.h>
#include <string.h>

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

static void trim(const char **begin, const char **end) {
    while (*begin < *end && is_blank(**begin)) ++*begin;
    while (*end > *begin && is_blank((*end)[-1])) --*end;
}

bool ab_line_next(const char **at, const char *end, ab_line *line) {
    if (*at >= end) return false;
    const char *c = *at;
    line->start = line->begin = c;
    line->comment = NULL;
    bool quoted = false;
    for (; c < end && *c != '\n' && *c != '\r'; c++) {
        if (*c == '"') quoted = !quoted;
        if (*c == '#' && !quoted && line->comment == NULL) line->comment = c + 1;
    }
    line->end = line->comment != NULL ? line->comment - 1 : c;
    line->comment_end = c;
    line->number++;
    if (c < end) c += *c == '\r' && c + 1 < end && c[1] == '\n' ? 2 : 1;
    *at = c;
    trim(&line->begin, &line->end);
    return true;
}

char ab_line_separator(const char *begin, const char *end) {
    static const char order[] = {';', '\t', ','};
    for (size_t k = 0; k < sizeof order; k++)
        if (memchr(begin, order[k], (size_t)(end - begin)) != NULL) return order[k];
    return ' ';
}

/* The end of the cell that begins at c. */
static const char *cell_end(char separator, const char *c, const char *end) {
    bool quoted = false;
    int depth = 0;
    for (; c < end; c++) {
        if (*c == '"') quoted = !quoted;
        if (quoted) continue;
        if (*c == '[' || *c == '(') depth++;
        if ((*c == ']' || *c == ')') && depth > 0) depth--;
        if (depth > 0) continue;
        if (*c == separator && separator != ' ') return c;
        if (separator != ' ' || !is_blank(*c)) continue;
        const char *next = c;
        while (next < end && is_blank(*next)) next++;
        if (next == end || (*next != '[' && *next != '(')) return c; /* "t [s]" is one cell */
        c = next - 1;
    }
    return c;
}

size_t ab_line_split(char separator, const char *begin, const char *end, ab_cell *cells, size_t most) {
    size_t count = 0;
    for (const char *c = begin; c < end;) {
        const char *from = c, *to = c = cell_end(separator, c, end);
        trim(&from, &to);
        if (to - from >= 2 && *from == '"' && to[-1] == '"') {
            from++, to--;
            trim(&from, &to);
        }
        if (count < most) cells[count] = (ab_cell){from, (size_t)(to - from)};
        count++;
        if (c < end) c++;
        while (separator == ' ' && c < end && is_blank(*c)) c++;
    }
    return count;
}

ab_literal ab_cell_number(const ab_cell *cell, double *value, char *why, size_t size) {
    char text[64];
    if (cell->length == 0 || cell->length >= sizeof text) return AB_LITERAL_NONE;
    for (size_t k = 0; k < cell->length; k++) {
        const char c = cell->begin[k];
        if (c == '\0') return AB_LITERAL_NONE;
        text[k] = (c == 'd' || c == 'D') && k > 0 ? 'e' : c; /* double precision of Fortran */
    }
    text[cell->length] = '\0';
    char *first = text + (text[0] == '+' || text[0] == '-'), *kept = first;
    while (kept[0] == '0' && isdigit((unsigned char)kept[1])) kept++; /* fixed width */
    memmove(first, kept, strlen(kept) + 1);
    return ab_literal_read(text, value, why, size);
}

const char *ab_cell_shown(const ab_cell *cell, char text[48]) {
    size_t n = 0;
    for (; n < cell->length && n < 40; n++) {
        const unsigned char c = (unsigned char)cell->begin[n];
        text[n] = c < 0x20 || c >= 0x7f ? '?' : (char)c;
    }
    text[n] = '\0';
    return text;
}
