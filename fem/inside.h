/* inside.h: which elements of a body have points that the grid sees. Inside fem/inside*.c only. */
#ifndef AB_FEM_INSIDE_H
#define AB_FEM_INSIDE_H

#include "fem/domain.h"

enum {
    FEM_DEEP,  /* no points */
    FEM_RIM,   /* the inmost elements with points: next to the layer, beyond its depth */
    FEM_LAYER, /* within the depth of an outer face */
};

/* Marks all elements of a body as it is now; depth in cells, in the largest-component norm. False: no memory. */
bool fem_layer_mark(const fem_body *, double depth, uint8_t *marks);

#endif
