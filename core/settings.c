/* settings.c: one ab_param, one YAML value, one ab_value. */
#include "core/settings.h"

#include <math.h>
#include <string.h>

#include "core/suggest.h"
#include "core/table_file.h"

/* The same key as the tables of the scene have, so that ranges and units are checked by the same code. */
static ab_key as_key(const ab_param *param) {
    ab_key key = {.name = param->name,
                  .type = AB_KEY_NUMBER,
                  .unit = param->unit == NULL || param->unit[0] == '\0' ? "1" : param->unit,
                  .help = param->help == NULL ? "" : param->help};
    const bool open = param->min == 0 && param->max == 0;
    if (!open && (isfinite(param->min) || isfinite(param->max))) {
        key.flags =
            AB_KEY_RANGE | (param->flags & AB_MIN_OPEN ? AB_KEY_MIN_OPEN : 0u) | (param->flags & AB_MAX_OPEN ? AB_KEY_MAX_OPEN : 0u);
        key.min = param->min;
        key.max = param->max;
    }
    return key;
}

static void read_direction(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, ab_value *value) {
    ab_key pure = *key;
    pure.unit = "1";
    pure.flags = 0;
    double v[2] = {0, 0};
    char path[AB_WHERE];
    if (!ab_read_point(reader, &pure, node, where, v)) return;
    const double length = hypot(v[0], v[1]);
    if (!(length > 0) || !isfinite(length)) {
        ab_report_error(reader->report, node->mark, "%s: a direction needs a length greater than 0", ab_where_join(path, where, key->name));
        return;
    }
    double *unit = ab_reader_take(reader, 3, sizeof *unit);
    if (unit == NULL) return;
    unit[0] = v[0] / length;
    unit[1] = v[1] / length;
    value->integer = -1;
    value->real = -1;
    value->table = unit;
    value->rows = 1;
    value->columns = 3;
}

static void read_choice(ab_reader *reader, const ab_param *param, const ab_key *key, const ab_node *node, const char *where,
                        ab_value *value) {
    enum { MOST = 32 };
    char words[512], path[AB_WHERE], tail[AB_TAIL];
    const char *names[MOST];
    size_t count = 0;
    const bool direction = param->flags & AB_OR_DIRECTION;
    if (direction && node->kind == AB_NODE_LIST) {
        read_direction(reader, key, node, where, value);
        return;
    }
    ab_where_join(path, where, param->name);
    if (node->kind != AB_NODE_SCALAR) {
        ab_report_error(reader->report, node->mark, "%s must be %s, not %s", path, direction ? "a word or a direction [x, y]" : "one word",
                        ab_node_kind_name(node));
        return;
    }
    snprintf(words, sizeof words, "%s", param->choices == NULL ? "" : param->choices);
    char *rest = NULL;
    for (char *word = strtok_r(words, "|", &rest); word != NULL && count < MOST; word = strtok_r(NULL, "|", &rest)) {
        word += strspn(word, " ");
        for (size_t n = strlen(word); n > 0 && word[n - 1] == ' '; n--) word[n - 1] = '\0';
        if (strcmp(word, node->text) == 0) {
            value->integer = (int64_t)count;
            value->real = (double)count;
            return;
        }
        names[count++] = word;
    }
    ab_suggest_tail(node->text, names, count, tail, sizeof tail);
    const size_t length = strlen(tail);
    const bool asked = length > 0 && tail[length - 1] == '?';
    ab_report_error(reader->report, node->mark, "%s: unknown word '%.64s'%s%s", path, node->text, tail,
                    !direction ? ""
                    : asked    ? " It may be a direction [x, y], too"
                               : ", or a direction [x, y]");
}

static bool read_row(ab_reader *reader, const ab_param *param, const ab_key *key, const ab_node *row, size_t columns, const char *where,
                     double *values) {
    bool good = true;
    char unit[80];
    for (size_t c = 0; c < columns; c++) {
        const ab_node *cell = row->kind == AB_NODE_LIST ? row->items[c] : row;
        ab_key of_column = *key;
        of_column.unit = ab_table_unit(param, c, unit, sizeof unit);
        if (!ab_read_number(reader, &of_column, cell, where, &values[c])) good = false;
    }
    return good;
}

static void read_table(ab_reader *reader, const ab_param *param, const ab_key *key, const ab_node *node, const char *where,
                       ab_value *value) {
    char path[AB_WHERE];
    ab_where_join(path, where, param->name);
    if (node->kind == AB_NODE_MAP) {
        ab_table_file_read(reader, param, node, where, value);
        return;
    }
    if (node->kind != AB_NODE_LIST || node->count == 0) {
        ab_report_error(reader->report, node->mark, "%s must be a list of %s, or {file: NAME}, not %s", path,
                        param->flags & AB_COLUMNS_2 ? "pairs [[a, b], ...]" : "rows",
                        node->kind == AB_NODE_LIST ? "an empty one" : ab_node_kind_name(node));
        return;
    }
    const size_t rows = node->count, columns = param->flags & AB_COLUMNS_2            ? 2
                                               : node->items[0]->kind == AB_NODE_LIST ? node->items[0]->count
                                                                                      : 1;
    double *table = ab_reader_take(reader, rows * columns, sizeof *table);
    if (table == NULL) return;
    bool good = columns > 0;
    for (size_t r = 0; r < rows; r++) {
        const ab_node *row = node->items[r];
        const size_t found = row->kind == AB_NODE_LIST ? row->count : 1;
        if (found != columns || row->kind == AB_NODE_MAP || columns == 0) {
            ab_report_error(reader->report, row->mark, "%s: row %zu must have %zu numbers, not %zu", path, r, columns == 0 ? 1 : columns,
                            found);
            good = false;
        } else if (!read_row(reader, param, key, row, columns, where, table + r * columns)) {
            good = false;
        } else if (param->flags & AB_INCREASING && r > 0 && good && !(table[r * columns] > table[(r - 1) * columns])) {
            ab_report_error(reader->report, row->mark,
                            "%s: the first column has to grow from row to row: %.9g in row %zu, and %.9g before it", path,
                            table[r * columns], r, table[(r - 1) * columns]);
        }
    }
    if (!good) return;
    value->table = table;
    value->rows = rows;
    value->columns = columns;
}

static void read_one(ab_reader *reader, const ab_param *param, const ab_node *node, const char *where, ab_value *value) {
    const ab_key key = as_key(param);
    long whole = 0;
    bool flag = false;
    switch (param->type) {
    case AB_INTEGER:
        if (ab_read_integer(reader, &key, node, where, &whole)) {
            value->integer = whole;
            value->real = (double)whole;
        }
        break;
    case AB_FLAG:
        if (ab_read_flag(reader, &key, node, where, &flag)) {
            value->integer = flag;
            value->real = flag;
        }
        break;
    case AB_CHOICE: read_choice(reader, param, &key, node, where, value); break;
    case AB_TABLE: read_table(reader, param, &key, node, where, value); break;
    default: ab_read_number(reader, &key, node, where, &value->real); break;
    }
}

ab_value *ab_settings_read(ab_reader *reader, const ab_class *class_, const ab_node *node, const char *where) {
    ab_value *values = ab_reader_take(reader, class_->nparam, sizeof *values);
    if (values == NULL) return NULL;
    for (uint32_t i = 0; i < class_->nparam; i++) {
        const ab_param *param = &class_->param[i];
        values[i].real = param->initial;
        if (param->type != AB_REAL && param->type != AB_TABLE) values[i].integer = (int64_t)param->initial;
        const ab_node *found = ab_node_find(node, param->name);
        char path[AB_WHERE];
        if (found == NULL) {
            if (param->flags & AB_REQUIRED)
                ab_report_error(reader->report, node->mark, "key '%s' is missing in %s: %s needs it (%s%s%s)", param->name, where,
                                class_->name, param->help == NULL ? "" : param->help,
                                param->unit == NULL || strcmp(param->unit, "1") == 0 || param->unit[0] == '\0' ? "" : ", ",
                                param->unit == NULL || strcmp(param->unit, "1") == 0 ? "" : param->unit);
        } else if (ab_node_is_null(found)) {
            ab_report_error(reader->report, found->mark, "%s has no value: %s", ab_where_join(path, where, param->name),
                            param->help == NULL ? "" : param->help);
        } else {
            values[i].given = 1;
            read_one(reader, param, found, where, &values[i]);
        }
    }
    return values;
}

size_t ab_settings_names(const ab_class *class_, const char **names, size_t count, size_t most) {
    for (uint32_t i = 0; i < class_->nparam && count < most; i++) names[count++] = class_->param[i].name;
    return count;
}
