/* element_samples.h: elements drawn at random, the same in every run, and what turns with them. */
#ifndef AB_ELEMENT_SAMPLES_H
#define AB_ELEMENT_SAMPLES_H

#include "static_solver.h"

static const ab_element_type TYPES[] = {AB_ELEMENT_Q4, AB_ELEMENT_Q4R, AB_ELEMENT_Q6, AB_ELEMENT_Q8, AB_ELEMENT_Q8R};
enum { TYPE_COUNT = 5 };
static const double PI = 3.14159265358979323846;

/* Numbers in [-1, 1], the same in every run. */
static inline double number(void) {
    static uint64_t state = 88172645463325252u;
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    return (double)(state >> 11) * 0x1p-52 - 1;
}

/* Eight elements of about the given sides; each corner and middle moved by up to `distortion` of them. */
static inline void draw(const fem_element *element, double width, double height, double distortion, double (*x)[8]) {
    static const double place[8][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0}, {1, 0.5}, {0.5, 1}, {0, 0.5}};
    for (int a = 0; a < element->nodes; a++)
        for (int l = 0; l < 8; l++) {
            x[2 * a][l] = width * (place[a][0] + distortion * number());
            x[2 * a + 1][l] = height * (place[a][1] + distortion * number());
        }
}

static inline void turn(int nodes, double angle, const double (*x)[8], double (*y)[8]) {
    const double c = cos(angle), s = sin(angle);
    for (int a = 0; a < nodes; a++)
        for (int l = 0; l < 8; l++) {
            const double px = x[2 * a][l], py = x[2 * a + 1][l];
            y[2 * a][l] = c * px - s * py;
            y[2 * a + 1][l] = s * px + c * py;
        }
}

static inline void turn_stress(double angle, const double (*s)[8], double (*t)[8]) {
    const double c = cos(angle), n = sin(angle);
    for (int l = 0; l < 8; l++) {
        const double xx = s[0][l], yy = s[1][l], xy = s[3][l];
        t[0][l] = c * c * xx + n * n * yy - 2 * c * n * xy;
        t[1][l] = n * n * xx + c * c * yy + 2 * c * n * xy;
        t[2][l] = s[2][l];
        t[3][l] = c * n * (xx - yy) + (c * c - n * n) * xy;
    }
}

/* Strain increment and spin angle of one lane by the rule of the middle of the step (Hughes and Winget 1980): G = H (I + H/2)^-1. */
static inline void middle_rule(const double (*h)[8], int l, double strain[3], double *angle) {
    const double a = 1 + h[0][l] / 2, b = h[1][l] / 2, c = h[2][l] / 2, d = 1 + h[3][l] / 2, det = a * d - b * c;
    const double xx = (h[0][l] * d - h[1][l] * c) / det, xy = (h[1][l] * a - h[0][l] * b) / det;
    const double yx = (h[2][l] * d - h[3][l] * c) / det, yy = (h[3][l] * a - h[2][l] * b) / det;
    strain[0] = xx, strain[1] = yy, strain[2] = xy + yx;
    *angle = 2 * atan((yx - xy) / 4);
}

static inline void fill_stress(const fem_element *element, double size, fem_block *block) {
    for (int l = 0; l < 8; l++) {
        for (int q = 0; q < element->gauss; q++)
            for (int c = 0; c < 4; c++) block->stress[q][c][l] = size * number();
        for (int k = 0; k < element->extra; k++) block->extra[k][l] = size * number();
    }
}

#endif
