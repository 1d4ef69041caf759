/* table_file.c: reads columns of numbers from a text file, as instruments and spreadsheets write them. */
#include "core/table_file.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/plugin_check.h"
#include "core/scene_keys.h"
#include "core/suggest.h"
#include "core/table_lines.h"

enum { MOST_SAID = 10 /* mistakes of one file */, NAME = 80 };

typedef struct header_cell {
    char name[NAME], unit[NAME]; /* unit "": none said */
} header_cell;

typedef struct reading { /* one file */
    ab_reader *reader;
    const ab_param *param;
    const char *path;
    const char *bytes, *end;
    char separator; /* ' ': blanks and tabs */
    header_cell *header;
    size_t header_count; /* 0: the file has none */
    int header_line;
    size_t width; /* cells of its first line */
    size_t wanted[AB_TABLE_COLUMNS], count;
    double factor[AB_TABLE_COLUMNS];
    size_t said;
    bool good;
} reading;

const char *ab_table_unit(const ab_param *param, size_t c, char *buffer, size_t size) {
    const char *unit = param->unit == NULL || param->unit[0] == '\0' ? "1" : param->unit;
    for (; c > 0 && strchr(unit, ',') != NULL; c--) unit = strchr(unit, ',') + 1;
    unit += strspn(unit, " ");
    size_t length = strcspn(unit, ",");
    while (length > 0 && unit[length - 1] == ' ') length--;
    snprintf(buffer, size, "%.*s", (int)length, unit);
    return buffer;
}

/* ---- mistakes ------------------------------------------------------------------------------------------------------------------------- */

static bool may_say(reading *r) {
    r->good = false;
    return ++r->said <= MOST_SAID;
}

#define SAY(r, line_, column_, ...)                                                                                                        \
    do {                                                                                                                                   \
        if (may_say(r)) ab_report_error((r)->reader->report, (ab_mark){(r)->path, (line_), (column_)}, __VA_ARGS__);                       \
    } while (0)

static int column_of(const ab_line *l, const char *place) { return (int)(place - l->start) + 1; }

/* ---- the header ----------------------------------------------------------------------------------------------------------------------- */

/* "t [s]": name and unit. In round brackets only what is a unit is taken for one. */
static void take_name(reading *r, const ab_cell *from, header_cell *to) {
    char text[2 * NAME];
    const size_t length = from->length < sizeof text - 1 ? from->length : sizeof text - 1;
    memcpy(text, from->begin, length);
    text[length] = '\0';
    char *open = strrchr(text, '['), close = ']';
    if (open == NULL) open = strrchr(text, '('), close = ')';
    if (open != NULL && length > 0 && text[length - 1] == close) {
        text[length - 1] = '\0';
        const char *unit = open + 1 + strspn(open + 1, " ");
        const bool pure = strcmp(unit, "-") == 0 || *unit == '\0';
        if (close == ']' || pure || ab_units_known(r->reader->units, unit)) {
            snprintf(to->unit, sizeof to->unit, "%.*s", NAME - 1, pure ? "1" : unit);
            *open = '\0';
        } else
            text[length - 1] = close;
    }
    size_t end = strlen(text);
    while (end > 0 && text[end - 1] == ' ') text[--end] = '\0';
    snprintf(to->name, sizeof to->name, "%.*s", NAME - 1, text);
}

static bool keep_header(reading *r, const ab_cell *cells, size_t count, int number) {
    r->header = ab_reader_take(r->reader, count, sizeof *r->header);
    if (r->header == NULL) return false;
    for (size_t k = 0; k < count; k++) take_name(r, &cells[k], &r->header[k]);
    r->header_count = count;
    r->header_line = number;
    return true;
}

/* Finds separator, width and header, and where the rows begin. The header is the first line where none of its cells is a number; or the last comment before the rows, where it
 * has a cell for each column and a unit in square brackets, or names are asked for. False where there are no rows. */
static bool find_header(reading *r, bool by_name, const char **rows, int *before) {
    ab_cell cells[AB_TABLE_CELLS];
    ab_line l = {0}, comment = {0};
    const char *at = r->bytes, *line_begin = at;
    while (ab_line_next(&at, r->end, &l)) {
        if (l.begin == l.end) {
            if (l.comment != NULL && l.comment_end > l.comment) comment = l;
            line_begin = at;
            continue;
        }
        if (r->header_count == 0) r->separator = ab_line_separator(l.begin, l.end);
        const size_t count = ab_line_split(r->separator, l.begin, l.end, cells, AB_TABLE_CELLS);
        if (count > AB_TABLE_CELLS) {
            SAY(r, l.number, column_of(&l, l.begin), "%zu cells in one line; at most %d are read", count, AB_TABLE_CELLS);
            return false;
        }
        bool numbers = false;
        double value;
        char why[200];
        for (size_t k = 0; k < count; k++) numbers = numbers || ab_cell_number(&cells[k], &value, why, sizeof why) != AB_LITERAL_NONE;
        if (!numbers && r->header_count == 0) {
            if (!keep_header(r, cells, count, l.number)) return false;
            line_begin = at;
            continue;
        }
        r->width = count;
        if (r->header_count == 0 && comment.comment != NULL) {
            const size_t names = ab_line_split(ab_line_separator(comment.comment, comment.comment_end), comment.comment,
                                               comment.comment_end, cells, AB_TABLE_CELLS);
            const bool units = memchr(comment.comment, '[', (size_t)(comment.comment_end - comment.comment)) != NULL;
            if (names == count && (units || by_name) && !keep_header(r, cells, names, comment.number)) return false;
        }
        *rows = line_begin;
        *before = l.number - 1;
        return true;
    }
    SAY(r, 0, 0, "has no row of numbers; each line is a row, its columns apart by commas, semicolons, tabs or blanks");
    return false;
}

/* ---- which columns, and in which units -------------------------------------------------------------------------------------------------- */

static void want_named(reading *r, const ab_node *node, const char *where) {
    const ab_node *at = node;
    char tail[AB_TAIL];
    const char *names[AB_TABLE_CELLS];
    size_t found = SIZE_MAX, twins = 0;
    for (size_t k = 0; k < r->header_count; k++) {
        names[k] = r->header[k].name;
        if (strcmp(names[k], at->text) != 0) continue;
        if (found == SIZE_MAX) found = k;
        twins++;
    }
    if (r->header_count == 0) {
        r->good = false;
        ab_report_error(r->reader->report, at->mark,
                        "%s.columns: '%.64s': %s has no line with names before its rows; write the columns' numbers, from 1", where,
                        at->text, r->path);
    } else if (twins != 1) {
        r->good = false;
        ab_report_error(r->reader->report, at->mark, "%s.columns: %s has %s column '%.64s' (line %d)%s", where, r->path,
                        twins == 0 ? "no" : "more than one", at->text, r->header_line,
                        twins == 0 ? ab_suggest_tail(at->text, names, r->header_count, tail, sizeof tail) : "; write its number, from 1");
    }
    r->wanted[r->count++] = found == SIZE_MAX ? 0 : found;
}

static void want_numbered(reading *r, const ab_node *node, double number, const char *where) {
    const size_t width = r->header_count > r->width ? r->header_count : r->width;
    if (!(number >= 1 && number <= (double)width && number == floor(number))) {
        r->good = false;
        ab_report_error(r->reader->report, node->mark, "%s.columns: '%.64s': %s has columns 1 to %zu", where, node->text, r->path, width);
        number = 1;
    }
    r->wanted[r->count++] = (size_t)number - 1;
}

static void choose(reading *r, const ab_node *columns, const ab_node *file, const char *where) {
    double number;
    char why[200];
    const size_t needed = r->param->flags & AB_COLUMNS_2 ? 2 : 0;
    if (columns == NULL) {
        for (size_t k = 0; k < r->width && k < AB_TABLE_COLUMNS; k++) r->wanted[r->count++] = k;
        if (r->width > AB_TABLE_COLUMNS || (needed && r->width != needed)) {
            r->good = false;
            ab_report_error(r->reader->report, file->mark, "%s: %s has %zu columns and %s%zu; choose them with columns: [1, 2]", where,
                            r->path, r->width,
                            needed ? "the setting needs " : "at most are read: ", needed ? needed : (size_t)AB_TABLE_COLUMNS);
        }
        return;
    }
    if (columns->kind != AB_NODE_LIST || columns->count == 0 || columns->count > AB_TABLE_COLUMNS || (needed && columns->count != needed)) {
        r->good = false;
        ab_report_error(r->reader->report, columns->mark, "%s.columns must be a list of %s names or numbers (from 1) of columns, as [t, a]",
                        where,
                        needed                                                ? "two"
                        : columns->kind == AB_NODE_LIST && columns->count > 0 ? "at most 64"
                                                                              : "one or more");
        return;
    }
    for (size_t k = 0; k < columns->count; k++) {
        const ab_node *node = columns->items[k];
        if (node->kind != AB_NODE_SCALAR || ab_node_is_null(node)) {
            r->good = false;
            ab_report_error(r->reader->report, node->mark, "%s.columns[%zu] must be the name or the number of a column, not %s", where, k,
                            ab_node_kind_name(node));
            r->wanted[r->count++] = 0;
        } else if (node->plain && ab_literal_read(node->text, &number, why, sizeof why) == AB_LITERAL_NUMBER)
            want_numbered(r, node, number, where);
        else
            want_named(r, node, where);
        if (r->good && k > 0 && r->wanted[k] == r->wanted[0]) {
            r->good = false;
            ab_report_error(r->reader->report, node->mark, "%s.columns[%zu] is the first column once more, '%.64s'; choose another one",
                            where, k, node->text);
        }
    }
}

static bool factor_of(reading *r, ab_mark mark, const char *where, const char *unit, size_t k, double *factor) {
    char wanted[NAME], why[500];
    if (ab_units_factor(r->reader->units, unit, ab_table_unit(r->param, k, wanted, sizeof wanted), factor, why, sizeof why) == AB_OK)
        return true;
    r->good = false;
    ab_report_error(r->reader->report, mark, "%s%sunit of column %zu: %s%s", where, where[0] ? ": " : "", r->wanted[k] + 1, why,
                    strcmp(unit, "g") == 0 ? " ('g' is the gram; the acceleration of gravity is written gravity)" : "");
    return false;
}

static void take_units(reading *r, const ab_node *units, const char *where) {
    char path[AB_WHERE];
    ab_where_join(path, where, "units");
    const bool list = units != NULL && units->kind == AB_NODE_LIST;
    if (units != NULL && (!list || units->count != r->count)) {
        r->good = false;
        if (list)
            ab_report_error(r->reader->report, units->mark,
                            "%s has %zu units for %zu columns; write one for each, null where the column is in SI", path, units->count,
                            r->count);
        else
            ab_report_error(r->reader->report, units->mark, "%s must be a list with a unit for each column, as [s, \"m/s2\"], not %s", path,
                            ab_node_kind_name(units));
        units = NULL;
    }
    for (size_t k = 0; k < r->count; k++) {
        const header_cell *header = r->wanted[k] < r->header_count ? &r->header[r->wanted[k]] : NULL;
        const ab_node *node = units != NULL ? units->items[k] : NULL;
        double said = 1, given = 1;
        r->factor[k] = 1;
        const bool has_said = header != NULL && header->unit[0] != '\0';
        const bool has_given = node != NULL && !ab_node_is_null(node);
        if (has_given && node->kind != AB_NODE_SCALAR) {
            r->good = false;
            ab_report_error(r->reader->report, node->mark, "%s[%zu] must be one unit, not %s", path, k, ab_node_kind_name(node));
            continue;
        }
        if (has_given && !factor_of(r, node->mark, path, node->text, k, &given)) continue;
        if (has_said && !factor_of(r, (ab_mark){r->path, r->header_line, 1}, "", header->unit, k, &said)) continue;
        if (has_given && has_said && fabs(said - given) > 1e-12 * fabs(said)) {
            r->good = false;
            ab_report_error(r->reader->report, node->mark,
                            "%s[%zu]: '%.64s' here, and '%s' in the header of %s (line %d); leave one of them out", path, k, node->text,
                            header->unit, r->path, r->header_line);
        }
        r->factor[k] = has_given ? given : said;
    }
}

/* ---- rows ------------------------------------------------------------------------------------------------------------------------------- */

static void take_cell(reading *r, const ab_line *l, const ab_cell *cell, size_t k, double *value) {
    char why[300], text[48];
    double number = 0;
    const ab_literal read = ab_cell_number(cell, &number, why, sizeof why);
    const bool comma = r->separator != ',' && memchr(cell->begin, ',', cell->length) != NULL;
    *value = number * r->factor[k];
    if (cell->length == 0)
        SAY(r, l->number, column_of(l, cell->begin), "column %zu is empty; write a number, or leave the line out", r->wanted[k] + 1);
    else if (read == AB_LITERAL_NONE)
        SAY(r, l->number, column_of(l, cell->begin), "'%s' in column %zu is not a number%s", ab_cell_shown(cell, text), r->wanted[k] + 1,
            comma ? "; write decimal points, not commas" : "");
    else if (read == AB_LITERAL_REFUSED)
        SAY(r, l->number, column_of(l, cell->begin), "column %zu: %s; leave the line out or mend it", r->wanted[k] + 1, why);
    else if (!isfinite(*value))
        SAY(r, l->number, column_of(l, cell->begin), "'%s' in column %zu is too large once it is converted to SI",
            ab_cell_shown(cell, text), r->wanted[k] + 1);
    else if (!ab_param_allows(r->param, *value))
        SAY(r, l->number, column_of(l, cell->begin), "%g in column %zu is out of the range of '%s' (%s)", *value, r->wanted[k] + 1,
            r->param->name, r->param->help);
}

static size_t count_rows(const reading *r, const char *at) {
    ab_line l = {0};
    size_t rows = 0;
    while (ab_line_next(&at, r->end, &l)) rows += l.begin < l.end;
    return rows;
}

static double *take_rows(reading *r, const char *at, int before, size_t *rows) {
    ab_cell cells[AB_TABLE_CELLS];
    *rows = count_rows(r, at);
    if (*rows > AB_TABLE_ROWS) {
        SAY(r, 0, 0, "has %zu rows; at most %d are read: keep every second one", *rows, AB_TABLE_ROWS);
        return NULL;
    }
    double *table = ab_reader_take(r->reader, *rows * r->count, sizeof *table);
    if (table == NULL) return NULL;
    ab_line l = {.number = before};
    for (size_t row = 0, last_line = 0; ab_line_next(&at, r->end, &l);) {
        if (l.begin == l.end) continue;
        const size_t count = ab_line_split(r->separator, l.begin, l.end, cells, AB_TABLE_CELLS), said = r->said;
        double *value = table + row * r->count;
        for (size_t k = 0; k < r->count; k++) {
            if (r->wanted[k] < count && r->wanted[k] < AB_TABLE_CELLS)
                take_cell(r, &l, &cells[r->wanted[k]], k, &value[k]);
            else
                SAY(r, l.number, column_of(&l, l.begin), "has %zu column%s; column %zu is wanted", count, count == 1 ? "" : "s",
                    r->wanted[k] + 1);
        }
        if (r->param->flags & AB_INCREASING && row > 0 && r->said == said && !(value[0] > value[-(ptrdiff_t)r->count]))
            SAY(r, l.number, column_of(&l, l.begin), "column %zu has to grow from row to row: %.9g here, and %.9g in line %zu (in SI)",
                r->wanted[0] + 1, value[0], value[-(ptrdiff_t)r->count], last_line);
        last_line = (size_t)l.number;
        row++;
    }
    return table;
}

/* ---- the file --------------------------------------------------------------------------------------------------------------------------- */

static const char *path_of(ab_reader *reader, const char *name) {
    const char *scene = reader->scene_path == NULL ? "" : reader->scene_path, *slash = name[0] != '/' ? strrchr(scene, '/') : NULL;
    const size_t folder = slash != NULL ? (size_t)(slash + 1 - scene) : 0;
    char *path = ab_reader_take(reader, folder + strlen(name) + 1, 1);
    if (path == NULL) return NULL;
    memcpy(path, scene, folder);
    strcpy(path + folder, name);
    return path;
}

/* All bytes of a file, with a NUL behind them; NULL with the reason reported. To be freed. */
static char *read_all(ab_reader *reader, const char *path, ab_mark mark, const char *where, size_t *count) {
    struct stat facts;
    char *bytes = NULL;
    *count = 0;
    FILE *file = NULL;
    if (stat(path, &facts) != 0)
        ab_report_error(reader->report, mark, "%s: cannot read '%s': %s; it is looked for in the scene's folder", where, path,
                        strerror(errno));
    else if (!S_ISREG(facts.st_mode))
        ab_report_error(reader->report, mark, "%s: '%s' is not a file of text", where, path);
    else if (facts.st_size > AB_TABLE_BYTES)
        ab_report_error(reader->report, mark, "%s: '%s' has %lld bytes; at most %d MiB are read", where, path, (long long)facts.st_size,
                        AB_TABLE_BYTES >> 20);
    else if ((file = fopen(path, "rbe")) == NULL)
        ab_report_error(reader->report, mark, "%s: cannot read '%s': %s", where, path, strerror(errno));
    if (file == NULL) return NULL;
    const size_t room = (size_t)facts.st_size;
    bytes = malloc(room + 1);
    if (bytes == NULL)
        reader->out_of_memory = true;
    else {
        *count = fread(bytes, 1, room, file);
        bytes[*count] = '\0';
        if (ferror(file)) {
            ab_report_error(reader->report, mark, "%s: cannot read '%s': %s", where, path, strerror(errno));
            free(bytes);
            bytes = NULL;
        }
    }
    fclose(file);
    return bytes;
}

static bool remember(ab_reader *reader, const char *name) {
    ab_file_read *file = ab_reader_take(reader, 1, sizeof *file);
    if (file == NULL) return false;
    *file = (ab_file_read){.name = name, .next = reader->files};
    reader->files = file;
    return true;
}

static bool take_file(reading *r, const ab_node *const *v, size_t length, const char *where, ab_value *value) {
    const char *rows = NULL;
    int before = 0;
    size_t row_count = 0;
    const bool utf16 = length >= 2 && (memcmp(r->bytes, "\xFF\xFE", 2) == 0 || memcmp(r->bytes, "\xFE\xFF", 2) == 0);
    const bool mark = length >= 3 && memcmp(r->bytes, "\xEF\xBB\xBF", 3) == 0;
    r->end = r->bytes + length;
    if (utf16 || memchr(r->bytes, '\0', length) != NULL) {
        SAY(r, 0, 0, utf16 ? "is in UTF-16; save it as UTF-8" : "has a NUL character; this does not look like a file of text");
        return false;
    }
    if (mark) r->bytes += 3;
    bool by_name = false;
    for (size_t k = 0; v[TABLE_COLUMNS] != NULL && v[TABLE_COLUMNS]->kind == AB_NODE_LIST && k < v[TABLE_COLUMNS]->count; k++) {
        const ab_node *node = v[TABLE_COLUMNS]->items[k];
        by_name = by_name || (node->kind == AB_NODE_SCALAR && node->text[strspn(node->text, "0123456789")] != '\0');
    }
    if (find_header(r, by_name, &rows, &before)) {
        choose(r, v[TABLE_COLUMNS], v[TABLE_FILE], where);
        if (r->count > 0) take_units(r, v[TABLE_UNITS], where);
        double *table = r->count > 0 ? take_rows(r, rows, before, &row_count) : NULL;
        if (table != NULL && r->good) *value = (ab_value){.table = table, .rows = row_count, .columns = r->count, .given = 1};
        r->good = r->good && table != NULL;
    }
    if (r->said > MOST_SAID)
        ab_report_error(r->reader->report, (ab_mark){r->path, 0, 0}, "has %zu mistakes; the first %d follow", r->said, MOST_SAID);
    return r->good;
}

bool ab_table_file_read(ab_reader *reader, const ab_param *param, const ab_node *node, const char *where, ab_value *value) {
    const ab_node *v[TABLE_KEYS];
    char place[AB_WHERE], *name = NULL;
    const size_t errors = ab_report_errors(reader->report);
    ab_where_join(place, where, param->name);
    if (!ab_section_open(reader, &ab_section_table, node, place, v) || v[TABLE_FILE] == NULL ||
        !ab_read_text(reader, &ab_section_table.keys[TABLE_FILE], v[TABLE_FILE], place, &name))
        return false;
    const char *path = path_of(reader, name);
    if (path == NULL || !remember(reader, name)) return false;
    size_t length = 0;
    const ab_value kept = *value;
    reading r = {.reader = reader, .param = param, .path = path, .good = true};
    char *bytes = read_all(reader, path, v[TABLE_FILE]->mark, place, &length);
    r.bytes = bytes;
    const bool good = bytes != NULL && take_file(&r, v, length, place, value) && ab_report_errors(reader->report) == errors;
    free(bytes);
    if (!good) *value = kept;
    return good && !reader->out_of_memory;
}
