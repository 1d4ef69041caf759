/* strain.h: the strain in the plane, and of hoops across it, from the displacement gradient of a step, for eight points at once; the same for every method.
 *
 * H_ij = d(du_i)/dx_j with respect to the start of the step, in the order xx, xy, yx, yy. The increment is that of Hughes and Winget (1980):
 * G = H (I + H/2)^-1, so that a finite rotation gives no strain; in two dimensions the rotation is one angle. */
#ifndef AB_STRAIN_H
#define AB_STRAIN_H

#include "core/vector.h"

typedef struct ab_increment {
    v8 xx, yy, xy;   /* strain; engineering shear */
    v8 cosine, sine; /* of the angle that the material turns by */
    v8 jacobian;     /* det(I + H) */
} ab_increment;

static inline __attribute__((always_inline)) ab_increment ab_strain_increment(v8 hxx, v8 hxy, v8 hyx, v8 hyy) {
    const v8 one = v8_set(1.0), half = v8_set(0.5);
    const v8 cross = hxx * hyy - hxy * hyx, trace = hxx + hyy;
    const v8 middle = one + half * trace + v8_set(0.25) * cross; /* det(I + H/2) */
    const v8 twist = half * (hyx - hxy), quarter = v8_set(0.25) * twist * twist, square = middle * middle;
    const v8 both = one / (middle * (square + quarter)); /* one division for 1/middle and 1/(middle^2 + twist^2/4) */
    const v8 inverse = both * (square + quarter), scale = both * middle;
    return (ab_increment){.xx = (hxx + half * cross) * inverse,
                          .yy = (hyy + half * cross) * inverse,
                          .xy = (hxy + hyx) * inverse,
                          .cosine = (square - quarter) * scale, /* of the angle whose half has the tangent twist/(2 middle) */
                          .sine = twist * middle * scale,
                          .jacobian = one + trace + cross};
}

/* Turns the strain, which lies in the middle of the step, by the second half of the rotation: to the end, where the stress stands that its increment is added to.
 * Left in the middle, strain and stress are out of line by half a step's rotation, always to the same side: in the frame of a spinning body the stiffness is then
 * not symmetric, and vibrations grow by about (frequency)(step)(rotation) in energy. */
static inline __attribute__((always_inline)) void ab_turn_increment(ab_increment *i) {
    const v8 mean = v8_set(0.5) * (i->xx + i->yy), d = v8_set(0.5) * (i->xx - i->yy), g = v8_set(0.5) * i->xy;
    const v8 turned = d * i->cosine - g * i->sine, sheared = d * i->sine + g * i->cosine; /* twice half the angle */
    i->xx = mean + turned;
    i->yy = mean - turned;
    i->xy = sheared + sheared;
}

/* Q sigma Q^T of rows xx, yy, zz, xy; zz stays. */
static inline __attribute__((always_inline)) void ab_turn_stress(v8 cosine, v8 sine, v8 *xx, v8 *yy, v8 *xy) {
    const v8 cc = cosine * cosine, ss = sine * sine, cs = cosine * sine, sxx = *xx, syy = *yy, sxy = *xy;
    *xx = cc * sxx + ss * syy - (cs + cs) * sxy;
    *yy = ss * sxx + cc * syy + (cs + cs) * sxy;
    *xy = cs * (sxx - syy) + (cc - ss) * sxy;
}

/* Across the plane: the strain of a hoop that grows by the part h of its length in the step, as Hughes and Winget have it; and F_zz <- (1 + h) F_zz, a row of eight. */
static inline __attribute__((always_inline)) v8 ab_hoop_strain(v8 h) { return h / (v8_set(1.0) + v8_set(0.5) * h); }
static inline __attribute__((always_inline)) v8 ab_move_hoop(v8 h, double *f) {
    const v8 moved = v8_load(f) + h * v8_load(f);
    v8_store(f, moved);
    return moved;
}

/* F <- (I + H) F; rows xx, xy, yx, yy of eight. */
static inline __attribute__((always_inline)) void ab_move_gradient(v8 hxx, v8 hxy, v8 hyx, v8 hyy, double *f, v8 moved[4]) {
    const v8 fxx = v8_load(f), fxy = v8_load(f + 8), fyx = v8_load(f + 16), fyy = v8_load(f + 24);
    moved[0] = fxx + hxx * fxx + hxy * fyx;
    moved[1] = fxy + hxx * fxy + hxy * fyy;
    moved[2] = fyx + hyx * fxx + hyy * fyx;
    moved[3] = fyy + hyx * fxy + hyy * fyy;
    for (int c = 0; c < 4; ++c) v8_store(f + 8 * c, moved[c]);
}

#endif
