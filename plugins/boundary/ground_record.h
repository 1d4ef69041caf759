/* ground_record.h: a record of how the ground moves, as the settings of base-motion and free-field have it: velocity or acceleration, one or more directions, a baseline taken
 * off, from rest, and what stands below. The first RECORD_SETTINGS settings of a class that has it are RECORD_PARAMS. */
#ifndef ABUT_GROUND_RECORD_H
#define ABUT_GROUND_RECORD_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "abut_plugin.h"

enum { RIGID, COMPLIANT };
enum { NONE, MEAN, LINEAR, QUADRATIC };
enum { REST, HOLD };
enum { MOST = 3 }; /* directions */

typedef struct ground_record {
    const ab_host *host;
    const double *t;           /* rows of the record's time, s */
    double *a[MOST], *v[MOST]; /* per direction of the record: acceleration (NULL for a record of velocity), velocity; corrected */
    size_t rows, parts;        /* parts: 1, along `direction`, or one for each direction of space */
    double direction[MOST], start;
    int base, after;
    double density, p_speed, s_speed; /* of the ground below; 0: of the body itself */
    double storage[];                 /* t, then a and v by part */
} ground_record;

/* clang-format off */
#define RECORD_PARAMS \
    {"velocity", "s, m s-1", \
     "record of velocity, rows [t, v] along `direction`, or [t, v_x, v_y]; straight lines between the rows; one of velocity and " \
     "acceleration is needed", \
     NULL, AB_TABLE, AB_INCREASING, 0, -INFINITY, INFINITY}, \
    {"acceleration", "s, m s-2", "record of acceleration, as velocity; from rest, integrated exactly for straight lines between the rows", \
     NULL, AB_TABLE, AB_INCREASING, 0, -INFINITY, INFINITY}, \
    {"direction", "1", "of a record with one value a row", "x|y", AB_CHOICE, AB_OR_DIRECTION, 0, 0, 0}, \
    {"factor", "1", "the record is multiplied by it", NULL, AB_REAL, 0, 1, -INFINITY, INFINITY}, \
    {"base", "1", \
     "rigid: the edges move as the record says, at rest across it; compliant: the record is the wave that comes up (half of what a free " \
     "surface shows), and waves that go down leave", \
     "rigid|compliant", AB_CHOICE, 0, RIGID, 0, 0}, \
    {"baseline", "1", \
     "what is subtracted from the record. mean: its mean, so that its integral ends at 0; linear: the straight line that fits it best; " \
     "quadratic, of acceleration: the derivative of " \
     "the parabola from 0 that fits its velocity best (least squares over time)", \
     "none|mean|linear|quadratic", AB_CHOICE, 0, NONE, 0, 0}, \
    {"after", "1", "behind the end of the record: at rest, or held at its last velocity; before it begins always at rest", "rest|hold", \
     AB_CHOICE, 0, REST, 0, 0}, \
    {"start", "s", "time of the scene at which the record's time is 0", NULL, AB_REAL, 0, 0, -INFINITY, INFINITY}, \
    {"base_density", "kg m-3", "compliant: density of the ground below; without it that of the body", NULL, AB_REAL, AB_MIN_OPEN, INFINITY, \
     0, INFINITY}, \
    {"base_p_speed", "m s-1", "compliant: speed of P waves in the ground below; without it that of the body", NULL, AB_REAL, AB_MIN_OPEN, \
     INFINITY, 0, INFINITY}, \
    {"base_s_speed", "m s-1", "compliant: speed of S waves in the ground below; without it that of the body", NULL, AB_REAL, AB_MIN_OPEN, \
     INFINITY, 0, INFINITY}
/* clang-format on */
enum {
    AT_VELOCITY,
    AT_ACCELERATION,
    AT_DIRECTION,
    AT_FACTOR,
    AT_BASE,
    AT_BASELINE,
    AT_AFTER,
    AT_START,
    AT_DENSITY,
    AT_P,
    AT_S,
    RECORD_SETTINGS
};

/* Velocities at the rows from accelerations that are straight between them, from rest. */
static inline void integrate(const double *t, const double *a, double *v, size_t rows) {
    v[0] = 0;
    for (size_t k = 1; k < rows; ++k) v[k] = v[k - 1] + 0.5 * (a[k - 1] + a[k]) * (t[k] - t[k - 1]);
}

/* Value of the velocity at x, 0 to 1, between rows k and k + 1. */
static inline double velocity_between(const double *t, const double *a, const double *v, size_t k, double x) {
    const double s = x * (t[k + 1] - t[k]);
    return a ? v[k] + s * (a[k] + 0.5 * x * (a[k + 1] - a[k])) : v[k] + x * (v[k + 1] - v[k]);
}

/* Coefficients of q f1 + r f2 that fit the record (degree 0: 1 alone; 1: 1, s) or the velocity (degree 2: s, s^2) best over time, s from 0 to 1 along the record. Three Gauss points
 * in each interval: exact, as no product has more than degree 4. */
static inline void fit(const double *t, const double *a, const double *v, size_t rows, int baseline, double c[2]) {
    static const double X[] = {0.1127016653792583, 0.5, 0.8872983346207417}, W[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double m[3] = {0, 0, 0}, f[2] = {0, 0};
    const double *record = a ? a : v, length = t[rows - 1] - t[0];
    for (size_t k = 0; k + 1 < rows; ++k)
        for (int g = 0; g < 3; ++g) {
            const double s = (t[k] - t[0] + X[g] * (t[k + 1] - t[k])) / length, w = W[g] * (t[k + 1] - t[k]) / length;
            const double value =
                baseline == QUADRATIC ? velocity_between(t, a, v, k, X[g]) : record[k] + X[g] * (record[k + 1] - record[k]);
            const double one = baseline == QUADRATIC ? s : 1, two = baseline == QUADRATIC ? s * s : s;
            m[0] += w * one * one, m[1] += w * one * two, m[2] += w * two * two;
            f[0] += w * one * value, f[1] += w * two * value;
        }
    if (baseline == MEAN) {
        c[0] = f[0], c[1] = 0;
        return;
    }
    const double det = m[0] * m[2] - m[1] * m[1];
    c[0] = (f[0] * m[2] - f[1] * m[1]) / det;
    c[1] = (m[0] * f[1] - m[1] * f[0]) / det;
}

/* What is subtracted from the record: c0 + c1 s of it, s from 0 to 1. */
static inline void correct(const double *t, double *a, double *v, size_t rows, int baseline, double c[2]) {
    const double length = t[rows - 1] - t[0];
    double *record = a ? a : v;
    c[0] = c[1] = 0;
    if (a) integrate(t, a, v, rows);
    if (baseline == NONE) return;
    fit(t, a, v, rows, baseline, c);
    if (baseline == QUADRATIC) c[0] /= length, c[1] *= 2 / length;
    for (size_t k = 0; k < rows; ++k) record[k] -= c[0] + c[1] * (t[k] - t[0]) / length;
    if (a) integrate(t, a, v, rows);
}

/* What the corrected record comes to, in a line for the user. */
static inline void tell(const ground_record *b, size_t part, int baseline, const double c[2]) {
    static const char *const names[] = {"none", "mean", "linear", "quadratic"};
    char text[500], subtracted[120] = "nothing";
    const size_t last = b->rows - 1;
    const char *unit = b->a[part] ? "m/s2" : "m/s";
    double moved = 0, most = 0;
    for (size_t k = 0; k < last; ++k) {
        const double dt = b->t[k + 1] - b->t[k];
        moved += dt *
                 (velocity_between(b->t, b->a[part], b->v[part], k, 0) + 4 * velocity_between(b->t, b->a[part], b->v[part], k, 0.5) +
                  b->v[part][k + 1]) /
                 6;
    }
    for (size_t k = 0; k <= last; ++k) most = fmax(most, fabs(b->v[part][k]));
    if (baseline != NONE)
        snprintf(subtracted, sizeof subtracted, "%.6g %s at its start to %.6g %s at its end", c[0], unit, c[0] + c[1], unit);
    snprintf(text, sizeof text,
             "%s of %zu rows, %.6g to %.6g s%s; baseline %s: subtracted %s; largest velocity %.6g m/s; ends at %.6g m/s, %.6g m from where "
             "it began, and %s",
             b->a[part] ? "acceleration" : "velocity", b->rows, b->t[0], b->t[last],
             b->parts == 1 ? ""
             : part == 0   ? ", along x"
             : part == 1   ? ", along y"
                           : ", along z, which no scene in a plane uses (columns: [...] of a file leaves it out)",
             names[baseline], subtracted, most, b->v[part][last], moved, b->after == REST ? "is at rest then" : "keeps that velocity");
    b->host->log(b->host->context, text);
}

static inline const char *record_wrong(const ab_value *s) {
    const ab_value *velocity = &s[AT_VELOCITY], *acceleration = &s[AT_ACCELERATION], *record = velocity->given ? velocity : acceleration;
    if (!velocity->given && !acceleration->given)
        return "a record is missing: velocity, or acceleration, as rows [t, value] or {file: NAME}";
    if (velocity->given && acceleration->given) return "velocity and acceleration are both given; one of them is the record";
    if (record->rows < 2) return "a record needs two rows at least";
    if (record->columns < 2 || record->columns > MOST + 1)
        return "a record has rows [t, value], or [t, x, y]; choose the columns of a file with columns: [...]";
    if (record->columns > 2 && s[AT_DIRECTION].given)
        return "direction belongs to a record with one value a row; this one has a column for each direction";
    for (size_t k = 0; k < record->rows * record->columns; ++k)
        if (!isfinite(record->table[k])) return "a number of the record is not finite";
    for (size_t k = 1; k < record->rows; ++k)
        if (!(record->table[k * record->columns] > record->table[(k - 1) * record->columns]))
            return "the times of the record have to grow from row to row";
    if (!isfinite(s[AT_FACTOR].real) || !isfinite(s[AT_START].real)) return "factor and start have to be finite";
    if (s[AT_BASELINE].integer == QUADRATIC && velocity->given)
        return "baseline: quadratic is of records of acceleration; write linear, or mean, for velocity";
    if (s[AT_BASE].integer == RIGID && (s[AT_DENSITY].given || s[AT_P].given || s[AT_S].given))
        return "base_density, base_p_speed and base_s_speed belong to base: compliant; a rigid base has none";
    return NULL;
}

/* says: whether a line for the user tells what the record came to. NULL with a message: the settings contradict each other, or there is no memory. Released with host->release. */
static inline ground_record *record_open(const ab_host *host, const ab_value *settings, int says) {
    const char *wrong = record_wrong(settings);
    if (wrong) {
        host->message(host->context, wrong);
        return NULL;
    }
    const int accelerates = settings[AT_ACCELERATION].given, baseline = (int)settings[AT_BASELINE].integer;
    const ab_value *record = &settings[accelerates ? AT_ACCELERATION : AT_VELOCITY];
    const size_t rows = record->rows, parts = record->columns - 1;
    ground_record *b = host->allocate(host->context, sizeof *b + (1 + 2 * parts) * rows * sizeof(double));
    if (!b) return NULL;
    double *room = b->storage, *t = room;
    *b = (ground_record){.host = host,
                         .t = t,
                         .rows = rows,
                         .parts = parts,
                         .start = settings[AT_START].real,
                         .base = (int)settings[AT_BASE].integer,
                         .after = (int)settings[AT_AFTER].integer,
                         .density = settings[AT_DENSITY].given ? settings[AT_DENSITY].real : 0,
                         .p_speed = settings[AT_P].given ? settings[AT_P].real : 0,
                         .s_speed = settings[AT_S].given ? settings[AT_S].real : 0};
    if (settings[AT_DIRECTION].integer < 0)
        memcpy(b->direction, settings[AT_DIRECTION].table, sizeof b->direction);
    else
        b->direction[settings[AT_DIRECTION].integer == 1] = 1;
    for (size_t k = 0; k < rows; ++k) t[k] = record->table[k * record->columns];
    for (size_t p = 0; p < parts; ++p) {
        b->v[p] = room + (1 + 2 * p) * rows;
        if (accelerates) b->a[p] = b->v[p] + rows;
        double *to = accelerates ? b->a[p] : b->v[p], c[2];
        for (size_t k = 0; k < rows; ++k) to[k] = settings[AT_FACTOR].real * record->table[k * record->columns + 1 + p];
        correct(t, b->a[p], b->v[p], rows, baseline, c);
        if (says) tell(b, p, baseline, c);
    }
    return b;
}

static inline double record_velocity(const ground_record *b, size_t part, double time) {
    const double *t = b->t;
    if (time < t[0]) return 0;
    if (time >= t[b->rows - 1]) return b->after == HOLD || time == t[b->rows - 1] ? b->v[part][b->rows - 1] : 0;
    size_t low = 0, high = b->rows - 1; /* row low is at or before the time, row high behind it */
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (t[middle] <= time)
            low = middle;
        else
            high = middle;
    }
    return velocity_between(t, b->a[part], b->v[part], low, (time - t[low]) / (t[low + 1] - t[low]));
}

/* Velocity at a time of the scene, m/s. */
static inline void record_motion(const ground_record *b, double time, double v[MOST]) {
    const double along = record_velocity(b, 0, time - b->start);
    for (size_t c = 0; c < MOST; ++c)
        v[c] = b->parts == 1 ? along * b->direction[c] : c < b->parts ? record_velocity(b, c, time - b->start) : 0;
}

#endif
