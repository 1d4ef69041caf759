/* columns.h: the fixed columns of history.csv, their values and units: time, ledger of the whole and of each body. The columns of monitors follow them.
 *
 * What each ledger column means, J (J per m of thickness in plane strain): docs/user.md. Sum of a row's terms less external, less the same sum at the
 * start, is the remainder: what the discretisation made (+) or lost (-). */
#ifndef AB_COLUMNS_H
#define AB_COLUMNS_H

#include "core/results.h"

enum { AB_TERMS = 10 }; /* of the ledger; outflow is shown only where a side lets points out */

const char *ab_term_name(size_t term); /* kinetic strain potential plastic friction contact boundary damping external outflow */
double ab_term_value(const ab_energy *energy, size_t term);
size_t ab_term_shown(const ab_scene *scene);       /* AB_TERMS, or one less */
double ab_energy_balance(const ab_energy *energy); /* sum of the terms less external: constant where nothing is lost */

size_t ab_column_count(const ab_scene *scene);
/* Name of a column; `name` holds at least 320 bytes. */
void ab_column_name(const ab_scene *scene, size_t column, char *name, size_t size);
const char *ab_column_unit(const ab_scene *scene, size_t column);
double ab_column_value(const ab_state_view *view, size_t column);
/* SIZE_MAX where there is none of that name. */
size_t ab_column_find(const ab_scene *scene, const char *name);

#endif
