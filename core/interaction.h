/* interaction.h: how bodies act on each other, as the scheduler sees it. main hands over one maker; contact/ fills it in. */
#ifndef AB_INTERACTION_H
#define AB_INTERACTION_H

#include "core/results.h"

typedef struct ab_interaction ab_interaction;

typedef enum ab_stage {
    AB_STAGE_DYNAMIC,  /* impulses change momentum; forces and work are booked */
    AB_STAGE_KINEMATIC /* the same conditions on a velocity field that only strains the bodies (USF before, MUSL after, USAVG both): nothing is booked */
} ab_stage;

struct ab_interaction { /* first member of the maker's own struct */
    void (*destroy)(ab_interaction *);
    /* Finds contact points (once per step, in the first stage that comes) and changes the dofs' velocities. */
    ab_status (*solve)(ab_interaction *, const ab_step *, ab_stage, ab_report *);
    /* After the bodies have taken their final velocities of the step (damping comes after contact): books forces and work. */
    void (*settle)(ab_interaction *, const ab_step *);
    const ab_contact_totals *(*totals)(const ab_interaction *);
    /* Friction and contact dissipation of a body so far, J. */
    void (*book)(const ab_interaction *, size_t body, double *friction, double *contact);
    /* dt, s, at which a spring of contact is neutrally stable (responses that act as one), as of the last step; or by which bodies without a limit of their own would pass
     * each other unseen; INFINITY without. */
    double (*critical_dt)(const ab_interaction *, const char **limit);
    /* As of a domain: core/checkpoint.h. */
    void (*keep)(ab_interaction *, struct ab_checkpoint *);
};

/* Only called for scenes with contacts. */
typedef ab_status (*ab_interaction_maker)(const ab_scene *, ab_domain **, ab_interaction **, ab_report *);

#endif
