/* trade_picture.c: error against cost as a picture (SVG), both logarithmic, the front drawn and labelled. */
#include <math.h>
#include <stdlib.h>

#include "core/picture.h"
#include "core/trade.h"

enum { WIDE = 860, HIGH = 560, LEFT = 80, RIGHT = 250, ABOVE = 40, BELOW = 60 };

typedef struct axis {
    double low, high; /* decades */
    double from, to;  /* pixels */
} axis;

static double place(const axis *a, double value) { return a->from + (log10(value) - a->low) / (a->high - a->low) * (a->to - a->from); }

/* Whole decades around all values. Errors of 0 stand at the bottom. */
static axis axis_of(double least, double most, double from, double to) {
    axis a = {floor(log10(least)), ceil(log10(most)), from, to};
    if (!(a.high > a.low)) a.high = a.low + 1;
    return a;
}

static void grid(ab_text *svg, const axis *x, const axis *y, bool wall) {
    char label[32];
    for (double d = x->low; d <= x->high; d++) {
        const double at = place(x, pow(10, d));
        ab_picture_line(svg, at, y->from, at, y->to, "stroke:#ddd");
        snprintf(label, sizeof label, "%g", pow(10, d));
        ab_picture_words(svg, at, y->from + 18, "middle", label);
    }
    for (double d = y->low; d <= y->high; d++) {
        const double at = place(y, pow(10, d));
        ab_picture_line(svg, x->from, at, x->to, at, "stroke:#ddd");
        snprintf(label, sizeof label, "1e%g", d);
        ab_picture_words(svg, x->from - 8, at + 4, "end", label);
    }
    ab_picture_words(svg, 0.5 * (x->from + x->to), y->from + 42, "middle", wall ? "wall time, s" : "processor time, s");
    ab_text_add(svg, "<g transform=\"translate(22 %.1f) rotate(-90)\">", 0.5 * (y->from + y->to));
    ab_picture_words(svg, 0, 0, "middle", "error");
    ab_text_add(svg, "</g>\n");
}

static bool shown(const ab_trade *trade, const ab_trial *trial) {
    return trial->run.state == AB_CHILD_DONE && isfinite(trial->error) && ab_trade_cost(trade, trial) > 0;
}

/* "40, gimp": the settings without their names, which stand once above the picture. */
static const char *values(const ab_trade *trade, const ab_trial *trial, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (size_t k = 0; k < trade->spec->ladder_count && used < size; k++)
        used += (size_t)snprintf(text + used, size - used, "%s%s", k > 0 ? ", " : "", trade->spec->ladders[k].values[trial->rung[k]]);
    return text;
}
static const char *names(const ab_trade *trade, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (size_t k = 0; k < trade->spec->ladder_count && used < size; k++)
        used += (size_t)snprintf(text + used, size - used, "%s%s", k > 0 ? ", " : "", trade->spec->ladders[k].name);
    return text;
}

void ab_trade_picture(const ab_trade *trade, ab_text *svg) {
    double low[2] = {INFINITY, INFINITY}, high[2] = {0, 0};
    for (size_t i = 0; i < trade->count; i++) {
        const ab_trial *t = &trade->trials[i];
        if (!shown(trade, t)) continue;
        low[0] = fmin(low[0], ab_trade_cost(trade, t)), high[0] = fmax(high[0], ab_trade_cost(trade, t));
        if (t->error > 0) low[1] = fmin(low[1], t->error), high[1] = fmax(high[1], t->error);
    }
    ab_picture_begin(svg, WIDE, HIGH);
    ab_picture_words(svg, LEFT, 24, "start", trade->runs.scene);
    if (!(high[0] > 0)) {
        ab_picture_words(svg, LEFT, 80, "start", "no run has an error");
        ab_picture_end(svg);
        return;
    }
    char settings[2000];
    if (!(high[1] > 0)) low[1] = 1e-16, high[1] = 1e-15;
    const axis x = axis_of(low[0], high[0], LEFT, WIDE - RIGHT), y = axis_of(low[1], high[1], HIGH - BELOW, ABOVE);
    grid(svg, &x, &y, trade->spec->wall);
    if (trade->spec->tolerance > pow(10, y.low) && trade->spec->tolerance < pow(10, y.high))
        ab_picture_line(svg, x.from, place(&y, trade->spec->tolerance), x.to, place(&y, trade->spec->tolerance),
                        "stroke:#999;stroke-dasharray:6 4");
    ab_picture_words(svg, WIDE - 8, ABOVE - 4, "end", names(trade, settings, sizeof settings));
    /* the front from cheap to dear: what is to be had for so much time */
    double before[2] = {NAN, NAN}, cost = 0, label = ABOVE;
    for (;;) {
        const ab_trial *next = NULL;
        for (size_t i = 0; i < trade->count; i++)
            if (trade->trials[i].front && shown(trade, &trade->trials[i]) && ab_trade_cost(trade, &trade->trials[i]) > cost &&
                (next == NULL || ab_trade_cost(trade, &trade->trials[i]) < ab_trade_cost(trade, next)))
                next = &trade->trials[i];
        if (next == NULL) break;
        cost = ab_trade_cost(trade, next);
        const double at[2] = {place(&x, ab_trade_cost(trade, next)), place(&y, next->error > 0 ? next->error : pow(10, y.low))};
        if (isfinite(before[0])) {
            ab_picture_line(svg, before[0], before[1], at[0], before[1], "stroke:#c22;stroke-width:1.5");
            ab_picture_line(svg, at[0], before[1], at[0], at[1], "stroke:#c22;stroke-width:1.5");
        }
        label = fmax(label + 14, at[1]);
        if (label > HIGH - 8) label = HIGH - 8;
        ab_picture_line(svg, at[0], at[1], x.to + 6, label - 4, "stroke:#c22;stroke-width:0.3");
        ab_picture_words(svg, x.to + 8, label, "start", values(trade, next, settings, sizeof settings));
        before[0] = at[0], before[1] = at[1];
    }
    for (size_t i = 0; i < trade->count; i++) {
        const ab_trial *t = &trade->trials[i];
        if (!shown(trade, t)) continue;
        ab_text_add(svg, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"><title>", place(&x, ab_trade_cost(trade, t)),
                    place(&y, t->error > 0 ? t->error : pow(10, y.low)), t->front ? "#c22" : "#468");
        ab_text_add_xml(svg, ab_trade_settings(trade, t, settings, sizeof settings));
        ab_text_add(svg, ": error %.2g, %.3g s</title></circle>\n", t->error, ab_trade_cost(trade, t));
    }
    ab_picture_end(svg);
}
