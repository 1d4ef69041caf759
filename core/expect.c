/* expect.c: running sums over a series, and the error they give at the end. */
#include "core/expect.h"

#include <math.h>
#include <string.h>

static const char *const norm_names[AB_NORMS] = {"final",        "max",         "l2",         "mean",     "peak",     "min",  "range",
                                                 "time-of-peak", "first-above", "last-above", "duration", "integral", "slope"};

bool ab_norm_find(const char *name, ab_norm *norm) {
    for (int n = 0; n < AB_NORMS; n++)
        if (strcmp(norm_names[n], name) == 0) {
            *norm = (ab_norm)n;
            return true;
        }
    *norm = AB_NORM_INTEGRAL;
    return strcmp(name, "impulse") == 0;
}

ab_status ab_expect_begin(ab_expect *expect, const ab_expect_spec *spec, ab_report *report) {
    *expect = (ab_expect){.spec = spec, .first_above = (double)NAN, .last_above = (double)NAN};
    if (!ab_norm_find(spec->norm != NULL ? spec->norm : "final", &expect->norm))
        return ab_report_error(report, spec->mark, "expect '%s': no norm '%s'", spec->name, spec->norm);
    return AB_OK;
}

bool ab_expect_wants(const ab_expect *expect, double time, double dt) {
    const double slack = 1e-6 * dt;                                                      /* a window that ends on a step holds that step */
    if (expect->norm == AB_NORM_FINAL && expect->spec->to - time > 3 * dt) return false; /* later ones will replace it */
    return time >= expect->spec->from - slack && time <= expect->spec->to + slack;
}

/* What lies between two samples, y taken as linear. */
static void between(ab_expect *e, double t0, double y0, double r0, double t1, double y1, double r1) {
    const double dt = t1 - t0, level = e->spec->level;
    e->integral += 0.5 * dt * (y0 + y1);
    e->square_error += 0.5 * dt * ((y0 - r0) * (y0 - r0) + (y1 - r1) * (y1 - r1));
    e->square_value += 0.5 * dt * (y0 * y0 + y1 * y1);
    e->square_reference += 0.5 * dt * (r0 * r0 + r1 * r1);
    if (y0 <= level && y1 <= level) return;
    const double crossing = y0 > level && y1 > level ? t0 : t0 + dt * (level - y0) / (y1 - y0);
    const double from = y0 > level ? t0 : crossing, to = y1 > level ? t1 : crossing;
    if (isnan(e->first_above)) e->first_above = from;
    e->last_above = to;
}

bool ab_expect_wants_last(const ab_expect *expect, double time) {
    return expect->norm == AB_NORM_FINAL && time >= expect->spec->from && time <= expect->spec->to &&
           (expect->samples == 0 || expect->time < time);
}

void ab_expect_sample(ab_expect *e, double t, double y) {
    const double r = ab_number_at(&e->spec->reference, t, 0, 0, 0);
    if (!isfinite(y) || !isfinite(r)) e->broken = true;
    if (e->samples == 0) {
        e->first_time = t;
        e->origin = y;
        e->peak = e->least = y;
        e->peak_time = t;
        if (y > e->spec->level) e->first_above = e->last_above = t;
    } else {
        between(e, e->time, e->value, e->reference, t, y, r);
    }
    if (e->samples == 0 || fabs(y - r) > e->worst) {
        e->worst = fabs(y - r);
        e->worst_value = y;
        e->worst_reference = r;
    }
    e->largest_reference = fmax(e->largest_reference, fabs(r));
    if (y > e->peak) {
        e->peak = y;
        e->peak_time = t;
    }
    e->least = fmin(e->least, y);
    const double s = t - e->first_time, z = y - e->origin;
    e->sum_t += s;
    e->sum_y += z;
    e->sum_tt += s * s;
    e->sum_ty += s * z;
    e->time = t;
    e->value = y;
    e->reference = r;
    e->samples++;
}

static double drawn(const ab_expect *e) {
    const double span = e->time - e->first_time, n = (double)e->samples;
    switch (e->norm) {
    case AB_NORM_MEAN: return span > 0 ? e->integral / span : e->value;
    case AB_NORM_PEAK: return e->peak;
    case AB_NORM_MIN: return e->least;
    case AB_NORM_RANGE: return e->peak - e->least;
    case AB_NORM_TIME_OF_PEAK: return e->peak_time;
    case AB_NORM_FIRST_ABOVE: return e->first_above;
    case AB_NORM_LAST_ABOVE: return e->last_above;
    case AB_NORM_DURATION: return isnan(e->first_above) ? 0 : e->last_above - e->first_above;
    case AB_NORM_INTEGRAL: return e->integral;
    case AB_NORM_SLOPE: return (n * e->sum_ty - e->sum_t * e->sum_y) / (n * e->sum_tt - e->sum_t * e->sum_t);
    default: return e->value;
    }
}

ab_outcome ab_expect_end(const ab_expect *e) {
    ab_outcome outcome = {.value = (double)NAN, .reference = (double)NAN, .error = (double)NAN, .tolerance = e->spec->tolerance};
    if (e->samples == 0) return outcome;
    double size, difference;
    if (e->norm == AB_NORM_MAX) {
        outcome.value = e->worst_value;
        outcome.reference = e->worst_reference;
        difference = e->worst;
        size = e->largest_reference;
    } else if (e->norm == AB_NORM_L2) {
        const double span = e->time - e->first_time; /* one sample: its own values */
        outcome.value = span > 0 ? sqrt(e->square_value / span) : fabs(e->value);
        outcome.reference = size = span > 0 ? sqrt(e->square_reference / span) : fabs(e->reference);
        difference = span > 0 ? sqrt(e->square_error / span) : fabs(e->value - e->reference);
    } else {
        outcome.value = drawn(e);
        outcome.reference = e->reference;
        difference = fabs(outcome.value - outcome.reference);
        size = fabs(outcome.reference);
    }
    if (e->spec->scale > 0) size = e->spec->scale;
    outcome.error = e->broken ? (double)NAN : difference / (size > 0 ? size : 1);
    outcome.pass = outcome.error <= outcome.tolerance; /* false for NaN */
    return outcome;
}
