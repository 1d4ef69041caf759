/* material.h: what every method does alike with a material: its plugin's instance, its start, how its states turn, and its tangent at the start. */
#ifndef AB_MATERIAL_H
#define AB_MATERIAL_H

#include "core/scene.h"
#include "core/vector.h"

enum { AB_MATERIAL_STATES = 32 }; /* numbers that a material may keep per point */

int ab_state_components(uint32_t shape); /* numbers that a state of this enum ab_shape keeps per point */
int ab_state_count(const ab_class *);    /* numbers that all its states keep per point */
bool ab_state_turns(const ab_class *);   /* some state is a vector or a tensor */
/* Eight points whose material turns by an angle in the plane; rows of eight, as many as ab_state_count says. */
void ab_state_turn(const ab_class *, const double *state, v8 cosine, v8 sine, double *turned);

typedef struct ab_material_start { /* eight points before the first step */
    double stress[4][8], state[AB_MATERIAL_STATES][8];
    double wave_speed; /* m/s, of P-waves */
} ab_material_start;

/* Makes the instance (*self; destroyed by the class's destroy) and asks it for its start. A material that keeps more numbers than
 * AB_MATERIAL_STATES, refuses its settings, or says no wave speed is AB_BAD_INPUT. */
ab_status ab_material_open(const ab_material_spec *, ab_service *, void **self, ab_material_start *, ab_report *);

/* Stress and states where the scene gives the stress, and what the material makes of it without any strain: the same where it bears it. Not 0: the material failed. */
int ab_material_start_from(const ab_material_spec *, void *self, const double stress[4][8], ab_material_start *, double borne[4][8]);

/* The tangent at the start, Pa, by central differences of `update` at a strain of 1e-7; isotropy is taken for granted. */
ab_status ab_material_tangent(const ab_material_spec *, ab_service *, void *self, const ab_material_start *, double *lambda, double *mu,
                              ab_report *);

#endif
