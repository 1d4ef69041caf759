/* monitor_inner.h: what monitor_find.c (what a monitor means) and monitor.c (its value) share. */
#ifndef AB_MONITOR_INNER_H
#define AB_MONITOR_INNER_H

#include "core/monitor.h"

typedef enum source { OF_MOTION, OF_ENERGY, OF_CONTACT, OF_BOUNDARY, OF_ALL_CONTACTS, OF_REACTION, OF_POINTS, OF_ROTATION, OF_DT } source;
typedef enum quantity { THE_COMPONENT, THE_LENGTH, THE_PRESSURE, THE_DISPLACEMENT } quantity; /* what is made of a field's components */
typedef enum gather { AT_POINT, MEAN_BY_MASS, MEAN_BY_VOLUME, LARGEST, SMALLEST, SUM, MEAN_SQUARE } gather;

typedef struct field_values { /* one field of one body, read once a step */
    char name[64];
    int components;
    double *values;
    size_t capacity;
    long step;
    bool used;
} field_values;

enum { FIELDS_PER_BODY = 16 };

typedef struct body_points { /* what is kept of a body's start, where a monitor needs it */
    size_t count;            /* points at the start */
    double *position;        /* count x dimension */
    double *id;              /* count */
    double *datum;           /* as position: where displacements are counted from; NULL: from the start */
    field_values fields[FIELDS_PER_BODY];
} body_points;

typedef struct monitor {
    const ab_monitor_spec *spec;
    source source;
    gather gather;
    quantity quantity;
    size_t offset;   /* of a number in ab_motion or ab_contact_totals; of an energy the term, SIZE_MAX - 1: total, SIZE_MAX: remainder */
    bool is_size;    /* the number is a size_t */
    bool by_mass;    /* momentum / mass */
    bool from_start; /* displacement: less the value at the start */
    int component;   /* of a field; of a force: 0, 1, or 2 for its moment */
    const char *unit, *field;
    size_t *selected; /* points at the start, ascending; NULL: all */
    size_t selected_count;
    long step;
    double value;
} monitor;

struct ab_monitors {
    monitor *items;
    size_t count, bodies;
    int dimension;
    body_points *of_body;
    ab_motion *start;
};

/* The field of that name of a domain, or NULL. */
const ab_field *ab_monitor_field(const ab_domain *domain, const char *name);

#endif
