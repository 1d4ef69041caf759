/* extremes_write.c: what was found: a table on the terminal that can stand in a document, extremes.csv, extremes.json. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/extremes.h"

enum { CUT = 200 }; /* characters of a message in the table; the whole stands in extremes.json */

typedef struct found { /* of one quantity */
    ab_sample **list;
    size_t count;
    ab_stretch right, stable, accepted;
    const ab_sample *fault;
} found;

static bool look(const ab_extremes *x, size_t quantity, found *f) {
    f->list = calloc(x->count + 1, sizeof(ab_sample *));
    if (f->list == NULL) return false;
    f->count = ab_extremes_along(x, quantity, f->list);
    f->right = ab_extremes_stretch(f->list, f->count, AB_VERDICT_WRONG);
    f->stable = ab_extremes_stretch(f->list, f->count, AB_VERDICT_UNSTABLE);
    f->accepted = ab_extremes_stretch(f->list, f->count, AB_VERDICT_REFUSED);
    f->fault = ab_extremes_fault(x, quantity);
    return true;
}

/* "0.975, not 1", "1e8, the end", "not even 0.1", "from 12, not 11, up to 1e8, the end". */
static const char *up_to(const found *f, const ab_stretch *stretch, char *text, size_t size) {
    const ab_sample *last = stretch->end.before, *after = stretch->end.after;
    int used = 0;
    if (stretch->begin.before != NULL)
        used = snprintf(text, size, "from %s, not %s, up to ", stretch->begin.after->shown, stretch->begin.before->shown);
    text += used, size -= (size_t)used;
    if (last == NULL && after == NULL)
        snprintf(text, size, "not known");
    else if (after == NULL)
        snprintf(text, size, last == f->list[f->count - 1] ? "%s, the end" : "%s", last->shown);
    else if (last == NULL)
        snprintf(text, size, "not even %s", after->shown);
    else
        snprintf(text, size, "%s, not %s", last->shown, after->shown);
    return text - used;
}

/* "nowhere", "0.5", "0.1 up to 0.2", "0.1 up to 0.2 and from 0.5": the first where the easy end is refused already. */
static const char *refused_from(const found *f, char *text, size_t size) {
    const ab_sample *last = f->accepted.begin.before, *again = f->accepted.end.after;
    if (last == NULL)
        snprintf(text, size, "%s", again != NULL ? again->shown : "nowhere");
    else
        snprintf(text, size, again != NULL ? "%s up to %s and from %s" : "%s up to %s", f->list[0]->shown, last->shown,
                 again != NULL ? again->shown : "");
    return text;
}

/* Which sample tells how it ends: of the run that stops being stable, else of the one that stops being right, else of what comes before either. */
static const ab_sample *ending(const found *f) {
    if (f->stable.end.after != NULL) return f->stable.end.after;
    if (f->right.end.after != NULL) return f->right.end.after;
    if (f->accepted.end.after != NULL) return f->accepted.end.after;
    return f->stable.begin.before != NULL ? f->stable.begin.before : f->right.begin.before;
}

/* A message in a cell of a table: short, and no '|'. */
static void cell(FILE *stream, const char *text, size_t most) {
    const size_t length = strlen(text);
    for (size_t i = 0; i < length && i < most; i++) putc(text[i] == '|' ? '/' : text[i], stream);
    if (length > most) fprintf(stream, "...");
}

static void table_row(const ab_extremes *x, size_t q, const found *f, FILE *stream) {
    char text[400];
    const ab_sample *end = ending(f);
    fprintf(stream, "| ");
    cell(stream, x->spec->quantities[q].name, 60);
    fprintf(stream, " | %s", up_to(f, &f->right, text, sizeof text));
    fprintf(stream, " | %s", up_to(f, &f->stable, text, sizeof text));
    fprintf(stream, " | %s | %s | ", refused_from(f, text, sizeof text),
            f->fault == NULL                      ? "yes"
            : x->spec->quantities[q].open != NULL ? "not yet"
                                                  : "no");
    if (end != NULL) cell(stream, end->why, CUT);
    fprintf(stream, " |\n");
}

/* Pieces of one verdict, where there are more than the order right, wrong, unstable, refused would make. */
static void tell_pieces(const ab_extremes *x, size_t q, const found *f, FILE *stream) {
    bool again = false;
    ab_verdict worst = AB_VERDICT_NONE;
    for (size_t i = 0; i < f->count; i++) {
        again = again || (f->list[i]->verdict != AB_VERDICT_NONE && f->list[i]->verdict < worst);
        if (f->list[i]->verdict > worst) worst = f->list[i]->verdict;
    }
    if (!again) return;
    fprintf(stream, "  %s does not go one way:", x->spec->quantities[q].name);
    for (size_t i = 0, k; i < f->count; i = k) {
        for (k = i; k < f->count && f->list[k]->verdict == f->list[i]->verdict;) k++;
        fprintf(stream, "%s %s %s", i > 0 ? "," : "", ab_verdict_name(f->list[i]->verdict), f->list[i]->shown);
        if (k - i > 1) fprintf(stream, " to %s", f->list[k - 1]->shown);
    }
    fprintf(stream, "\n");
}

static void text_map(const ab_extremes *x, FILE *stream) {
    static const char marks[] = "?#ox-";
    const ab_extreme *a = &x->spec->quantities[x->spec->map[0]], *b = &x->spec->quantities[x->spec->map[1]];
    fprintf(stream, "\n  %s to the right from", a->name);
    const ab_sample *first = ab_extremes_cell(x, 0, 0), *last = ab_extremes_cell(x, ab_extremes_rungs(a) - 1, 0);
    fprintf(stream, " %s to %s, %s upwards; # right, o stable but wrong, x unstable, - refused\n", first != NULL ? first->shown : "?",
            last != NULL ? last->shown : "?", b->name);
    for (size_t k = ab_extremes_rungs(b); k-- > 0;) {
        const ab_sample *row = ab_extremes_cell(x, 0, k);
        fprintf(stream, "  %12s ", row != NULL ? row->other_shown : "");
        for (size_t i = 0; i < ab_extremes_rungs(a); i++) {
            const ab_sample *s = ab_extremes_cell(x, i, k);
            fprintf(stream, " %c", marks[s != NULL ? s->verdict : 0]);
        }
        fprintf(stream, "\n");
    }
}

void ab_extremes_table(const ab_extremes *x, FILE *stream) {
    fprintf(stream,
            "\n| quantity | right up to | stable up to | refused from | holds | how it ends |\n| --- | --- | --- | --- | --- | --- |\n");
    found f;
    for (size_t q = 0; q < x->spec->count; q++)
        if (look(x, q, &f)) table_row(x, q, &f, stream), free(f.list);
    fprintf(stream, "\n");
    size_t unknown = 0;
    for (size_t q = 0; q < x->spec->count; q++) {
        if (!look(x, q, &f)) continue;
        tell_pieces(x, q, &f, stream);
        if (f.fault != NULL) {
            fprintf(stream, "  %s does not hold%s: %s at %s: ", x->spec->quantities[q].name,
                    x->spec->quantities[q].open != NULL ? " yet" : "", ab_verdict_name(f.fault->verdict), f.fault->shown);
            cell(stream, f.fault->why[0] != '\0' ? f.fault->why : "not run", 600);
            fprintf(stream, "\n");
        }
        if (f.fault == NULL && x->spec->quantities[q].open != NULL)
            fprintf(stream, "  %s holds now: take `open` away from it\n", x->spec->quantities[q].name);
        free(f.list);
    }
    for (size_t i = 0; i < x->count; i++) unknown += x->samples[i]->verdict == AB_VERDICT_NONE;
    if (unknown > 0) fprintf(stream, "  %zu of %zu runs have no verdict\n", unknown, x->count);
    if (x->scene->expect_count == 0) fprintf(stream, "  the scene has no expects: whatever is stable counts as right\n");
    if (x->spec->has_map) text_map(x, stream);
}

/* ---- files ----------------------------------------------------------------------------------------------------------------------------------- */

static void csv_number(ab_text *text, double value) {
    ab_text_add(text, ",");
    if (isfinite(value)) ab_text_add_number(text, value);
}

static void csv_sample(const ab_extremes *x, const ab_sample *s, ab_text *text) {
    ab_text_add_csv(text, x->spec->quantities[s->quantity].name), ab_text_add(text, ",");
    ab_text_add_csv(text, s->shown), ab_text_add(text, ",");
    if (s->second != SIZE_MAX) ab_text_add_csv(text, x->spec->quantities[s->second].name);
    ab_text_add(text, ",");
    ab_text_add_csv(text, s->other_shown);
    ab_text_add(text, ",%s", ab_verdict_name(s->verdict));
    csv_number(text, s->error);
    csv_number(text, s->tolerance);
    csv_number(text, s->remainder);
    csv_number(text, s->run.cpu);
    ab_text_add(text, ",");
    ab_text_add_csv(text, s->why);
    ab_text_add(text, "\n");
}

static void write_csv(const ab_extremes *x, ab_text *text) {
    ab_text_add(text, "quantity,value,second,second_value,verdict,error,tolerance,remainder,cpu_seconds,why\n");
    found f;
    for (size_t q = 0; q < x->spec->count; q++) {
        if (!look(x, q, &f)) continue;
        for (size_t i = 0; i < f.count; i++) csv_sample(x, f.list[i], text);
        free(f.list);
    }
    for (size_t i = 0; i < x->count; i++)
        if (x->samples[i]->second != SIZE_MAX) csv_sample(x, x->samples[i], text);
}

static void json_number(ab_text *text, const char *name, double value) {
    ab_text_add(text, ", \"%s\": ", name);
    ab_text_add_number(text, value);
}
static void json_text(ab_text *text, const char *name, const char *value) {
    ab_text_add(text, ", \"%s\": ", name);
    if (value != NULL)
        ab_text_add_escaped(text, value);
    else
        ab_text_add(text, "null");
}

static const char *shown(const ab_sample *s) { return s != NULL ? s->shown : NULL; }

/* "last_not" and "first": where the easy end is not, the last that is not and the first that is; "last" and "first_not": the other end of the stretch. */
static void json_stretch(ab_text *text, const char *name, const ab_stretch *stretch) {
    ab_text_add(text, ",\n     \"%s\": {\"last\": ", name);
    if (stretch->end.before != NULL) ab_text_add_escaped(text, stretch->end.before->shown);
    if (stretch->end.before == NULL) ab_text_add(text, "null");
    json_text(text, "first_not", shown(stretch->end.after));
    if (stretch->begin.before != NULL)
        json_text(text, "last_not", shown(stretch->begin.before)), json_text(text, "first", shown(stretch->begin.after));
    ab_text_add(text, "}");
}

static void json_sample(const ab_extremes *x, const ab_sample *s, ab_text *text) {
    ab_text_add(text, "{\"value\": ");
    ab_text_add_escaped(text, s->shown);
    if (s->second != SIZE_MAX)
        json_text(text, "second", x->spec->quantities[s->second].name), json_text(text, "second_value", s->other_shown);
    json_text(text, "verdict", ab_verdict_name(s->verdict));
    json_number(text, "error", s->error);
    json_number(text, "tolerance", s->tolerance);
    json_number(text, "remainder", s->remainder);
    json_number(text, "cpu_seconds", s->run.cpu);
    json_text(text, "folder", s->run.folder);
    json_text(text, "why", s->why);
    ab_text_add(text, "}");
}

static void json_quantity(const ab_extremes *x, size_t q, const found *f, ab_text *text) {
    const ab_extreme *e = &x->spec->quantities[q];
    ab_text_add(text, "    {\"name\": ");
    ab_text_add_escaped(text, e->name);
    ab_text_add(text, ", \"set\": [");
    for (size_t p = 0; p < e->path_count; p++) ab_text_add(text, "%s", p > 0 ? ", " : ""), ab_text_add_escaped(text, e->paths[p]);
    ab_text_add(text, "]");
    if (f->count > 0) json_text(text, "from", f->list[0]->shown), json_text(text, "to", f->list[f->count - 1]->shown);
    json_text(text, "scale", e->values != NULL ? "values" : e->logarithmic ? "log" : "linear");
    json_stretch(text, "right", &f->right);
    json_stretch(text, "stable", &f->stable);
    json_stretch(text, "accepted", &f->accepted);
    const ab_sample *end = ending(f);
    ab_text_add(text, ",\n     \"holds\": %s", f->fault != NULL ? "false" : "true");
    json_text(text, "open", e->open);
    json_text(text, "fault", f->fault != NULL ? f->fault->why : NULL);
    json_text(text, "fault_at", f->fault != NULL ? f->fault->shown : NULL);
    json_text(text, "how_it_ends", end != NULL ? end->why : NULL);
    ab_text_add(text, ",\n     \"pieces\": [");
    for (size_t i = 0, k; i < f->count; i = k) {
        for (k = i; k < f->count && f->list[k]->verdict == f->list[i]->verdict;) k++;
        ab_text_add(text, "%s{\"verdict\": \"%s\"", i > 0 ? ", " : "", ab_verdict_name(f->list[i]->verdict));
        json_text(text, "from", f->list[i]->shown), json_text(text, "to", f->list[k - 1]->shown);
        ab_text_add(text, "}");
    }
    ab_text_add(text, "],\n     \"runs\": [");
    for (size_t i = 0; i < f->count; i++) {
        ab_text_add(text, "%s\n      ", i > 0 ? "," : "");
        json_sample(x, f->list[i], text);
    }
    ab_text_add(text, "]}");
}

static void write_json(const ab_extremes *x, ab_text *text) {
    ab_text_add(text, "{\n  \"scene\": ");
    ab_text_add_escaped(text, x->runs.scene);
    json_text(text, "title", x->scene->title != NULL ? x->scene->title : "");
    ab_text_add(text, ",\n  \"quantities\": [");
    found f;
    for (size_t q = 0; q < x->spec->count; q++) {
        if (!look(x, q, &f)) continue;
        ab_text_add(text, "%s\n", q > 0 ? "," : "");
        json_quantity(x, q, &f, text);
        free(f.list);
    }
    ab_text_add(text, "],\n  \"map\": ");
    if (!x->spec->has_map) ab_text_add(text, "null");
    for (size_t i = 0, written = 0; x->spec->has_map && i < x->count; i++) {
        if (x->samples[i]->second == SIZE_MAX) continue;
        ab_text_add(text, written++ > 0 ? ",\n    " : "[\n    ");
        json_sample(x, x->samples[i], text);
    }
    ab_text_add(text, "%s\n}\n", x->spec->has_map ? "]" : "");
}

ab_status ab_extremes_write(const ab_extremes *x, ab_report *report) {
    static void (*const writers[])(const ab_extremes *, ab_text *) = {write_csv, write_json, ab_extremes_map};
    static const char *const names[] = {"extremes.csv", "extremes.json", "map.svg"};
    for (int i = 0; i < 2 + x->spec->has_map; i++) {
        ab_text text = {0};
        writers[i](x, &text);
        AB_TRY(ab_text_write(&text, x->runs.folder, names[i], report));
    }
    return AB_OK;
}
