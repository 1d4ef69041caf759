/* extremes_map.c: two quantities against each other as a picture (SVG): one cell a run, coloured by its verdict. */
#include <math.h>

#include "core/extremes.h"
#include "core/picture.h"

enum { LEFT = 110, ABOVE = 50, BELOW = 90, RIGHT = 200, SIDE = 520 };

static const char *const COLOURS[] = {"#ffffff", "#4c9f50", "#eebc3a", "#c0392b", "#9aa0ad"};
static const char *const WORDS[] = {"no verdict", "right", "stable, but wrong", "unstable", "refused"};

static void draw_cell(const ab_extremes *x, const ab_sample *s, double left, double top, double wide, double high, ab_text *svg) {
    ab_text_add(svg, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\" stroke=\"white\"><title>", left, top, wide,
                high, COLOURS[s->verdict]);
    ab_text_add_xml(svg, x->spec->quantities[s->quantity].name);
    ab_text_add(svg, " %s, ", s->shown);
    ab_text_add_xml(svg, x->spec->quantities[s->second].name);
    ab_text_add(svg, " %s: %s%s", s->other_shown, WORDS[s->verdict], s->why[0] != '\0' ? ": " : "");
    ab_text_add_xml(svg, s->why);
    ab_text_add(svg, "</title></rect>\n");
}

void ab_extremes_map(const ab_extremes *x, ab_text *svg) {
    const ab_extreme *a = &x->spec->quantities[x->spec->map[0]], *b = &x->spec->quantities[x->spec->map[1]];
    const size_t columns = ab_extremes_rungs(a), rows = ab_extremes_rungs(b);
    const double wide = (double)SIDE / (double)columns, high = (double)SIDE / (double)rows, bottom = ABOVE + SIDE;
    size_t counts[5] = {0};
    ab_picture_begin(svg, LEFT + SIDE + RIGHT, ABOVE + SIDE + BELOW);
    ab_picture_words(svg, LEFT, 24, "start", x->runs.scene);
    for (size_t i = 0; i < columns; i++)
        for (size_t k = 0; k < rows; k++) {
            const ab_sample *s = ab_extremes_cell(x, i, k);
            if (s == NULL) continue;
            counts[s->verdict]++;
            draw_cell(x, s, LEFT + (double)i * wide, bottom - (double)(k + 1) * high, wide, high, svg);
            if (k == 0) { /* upright where columns are narrow */
                ab_text_add(svg, "<g transform=\"translate(%.1f %.1f) rotate(%d)\">", LEFT + ((double)i + 0.5) * wide, bottom + 16,
                            wide < 60 ? 40 : 0);
                ab_picture_words(svg, 0, 0, wide < 60 ? "start" : "middle", s->shown);
                ab_text_add(svg, "</g>\n");
            }
            if (i == 0) ab_picture_words(svg, LEFT - 8, bottom - ((double)k + 0.5) * high + 4, "end", s->other_shown);
        }
    ab_picture_words(svg, LEFT + 0.5 * SIDE, bottom + 78, "middle", a->name);
    ab_text_add(svg, "<g transform=\"translate(22 %.1f) rotate(-90)\">", ABOVE + 0.5 * SIDE);
    ab_picture_words(svg, 0, 0, "middle", b->name);
    ab_text_add(svg, "</g>\n");
    double at = ABOVE;
    for (int v = 0; v < 5; v++) {
        const int verdict = (v + 1) % 5; /* no verdict last */
        char words[80];
        if (verdict == AB_VERDICT_NONE && counts[verdict] == 0) continue;
        snprintf(words, sizeof words, "%s (%zu)", WORDS[verdict], counts[verdict]);
        ab_text_add(svg, "<rect x=\"%d\" y=\"%.1f\" width=\"14\" height=\"14\" fill=\"%s\" stroke=\"#888\"/>\n", LEFT + SIDE + 20, at,
                    COLOURS[verdict]);
        ab_picture_words(svg, LEFT + SIDE + 42, at + 12, "start", words);
        at += 24;
    }
    ab_picture_end(svg);
}
