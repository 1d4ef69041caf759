/* table_file.h: a setting that is a table, from a text file of columns: {file: base.csv, columns: [t, a], units: [s, "m/s2"]}. Plugins never see files. */
#ifndef AB_TABLE_FILE_H
#define AB_TABLE_FILE_H

#include "core/plugin_host.h"
#include "core/schema.h"

enum ab_table_limits { /* a hostile file must cost little */
                       AB_TABLE_BYTES = 64 << 20,
                       AB_TABLE_ROWS = 1000000,
                       AB_TABLE_COLUMNS = 64, /* that are wanted */
                       AB_TABLE_CELLS = 256   /* of one line of the file */
};

/* The SI unit of column `c` of a table that declares "s, m s-2": the last one stands for the columns after it. Returns buffer. */
const char *ab_table_unit(const ab_param *param, size_t c, char *buffer, size_t size);

/* Reads the file that the mapping `node` (ab_section_table) names, from the scene's folder, into value->table (in SI), rows and columns. Columns are chosen by their names in the
 * header or by their numbers from 1; units come from `units` or from the header ("t [s]"), else the file is in SI. False with every mistake reported, at its line and column of the file. */
bool ab_table_file_read(ab_reader *reader, const ab_param *param, const ab_node *node, const char *where, ab_value *value);

#endif
