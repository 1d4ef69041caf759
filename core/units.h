/* units.h: conversion to SI by UDUNITS-2. The database is read when the first unit that is not SI already is met. */
#ifndef AB_UNITS_H
#define AB_UNITS_H

#include "core/report.h"

typedef struct ab_units ab_units;

ab_units *ab_units_create(void); /* NULL: no memory */
void ab_units_destroy(ab_units *units);

/* *factor: what a value in `unit` is multiplied with to be in `wanted`. wanted NULL: in base SI units of whatever dimension it has.
 * On AB_BAD_INPUT `why` names both units and the remedy. */
ab_status ab_units_factor(ab_units *units, const char *unit, const char *wanted, double *factor, char *why, size_t why_size);
/* True when the text can be read as a unit. */
bool ab_units_known(ab_units *units, const char *unit);

#endif
