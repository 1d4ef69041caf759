/* picture.c: pieces of pictures as SVG. */
#include "core/picture.h"

void ab_picture_begin(ab_text *svg, int wide, int high) {
    ab_text_add(
        svg, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\" style=\"font:12px sans-serif\">\n",
        wide, high, wide, high);
    ab_text_add(svg, "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n");
}

void ab_picture_line(ab_text *svg, double x0, double y0, double x1, double y1, const char *style) {
    ab_text_add(svg, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" style=\"%s\"/>\n", x0, y0, x1, y1, style);
}

void ab_picture_words(ab_text *svg, double x, double y, const char *anchor, const char *text) {
    ab_text_add(svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", x, y, anchor);
    ab_text_add_xml(svg, text);
    ab_text_add(svg, "</text>\n");
}

void ab_picture_end(ab_text *svg) { ab_text_add(svg, "</svg>\n"); }
