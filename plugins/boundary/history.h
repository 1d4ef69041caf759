/* history.h: a table of pairs [t, value] as a function of time: straight lines between its rows, the first value before and the last one after them. For boundary
 * plugins with such a setting (AB_TABLE of AB_COLUMNS_2 | AB_INCREASING); one that is not given is the constant 1. */
#ifndef ABUT_HISTORY_H
#define ABUT_HISTORY_H

#include "abut_plugin.h"

#include <stddef.h>

typedef struct history {
    const double *row; /* t, value, t, value ...: the host's, until destroy */
    size_t rows;
} history;

static inline history history_of(const ab_value *setting) {
    return setting->given ? (history){setting->table, setting->rows} : (history){NULL, 0};
}

static inline double history_at(const history *h, double time) {
    if (h->rows == 0) return 1.0;
    if (time <= h->row[0]) return h->row[1];
    size_t low = 0, high = h->rows; /* row low is at or before the time, row high behind it */
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (h->row[2 * middle] <= time)
            low = middle;
        else
            high = middle;
    }
    const double *a = h->row + 2 * low;
    return high == h->rows ? a[1] : a[1] + (a[3] - a[1]) * ((time - a[0]) / (a[2] - a[0]));
}

#endif
