/* picture.h: pictures as SVG: what those of several commands have in common. Lengths in pixels, y downwards. */
#ifndef AB_PICTURE_H
#define AB_PICTURE_H

#include "core/files.h"

void ab_picture_begin(ab_text *svg, int wide, int high);
void ab_picture_line(ab_text *svg, double x0, double y0, double x1, double y1, const char *style);
/* anchor: start, middle, end. */
void ab_picture_words(ab_text *svg, double x, double y, const char *anchor, const char *text);
void ab_picture_end(ab_text *svg);

#endif
