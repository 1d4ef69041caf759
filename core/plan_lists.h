/* plan_lists.h: what a plan goes over, as JSON and as text: plugins in use, what is left out, sums over the bodies. For plan*.c and trade_order.c. */
#ifndef AB_PLAN_LISTS_H
#define AB_PLAN_LISTS_H

#include "core/plan.h"

/* Receives one item of a list: a name and what there is to say of it. */
typedef void (*ab_plan_item)(ab_text *text, size_t number, const char *name, const char *what, const ab_loaded_class *loaded);

const char *ab_plan_kind_name(uint32_t kind);
/* Each plugin class in use once, with the first reason for it. */
void ab_plan_each_plugin(const ab_scene *scene, ab_plan_item tell, ab_text *text);
/* "a, b, c" of what a contact's finder and response need. */
void ab_plan_contact_needs(const ab_contact_spec *contact, char *words, size_t size);
/* "gravity (ramp), local damping 0.7, until at rest, then displacements from zero" */
void ab_plan_stage_words(const ab_stage_spec *stage, char *words, size_t size);
/* Where K0 is from, for bodies that begin with it. */
void ab_plan_initial_words(const ab_body_spec *body, char *words, size_t size);
/* What a scene might cost and this one does not. */
void ab_plan_each_left_out(const ab_schedule *schedule, ab_plan_item tell, ab_text *text);
double ab_plan_steps_of(const ab_schedule *schedule);
/* points: of clouds; *nodes: of meshes; those of rigid bodies, which no step goes over, left out. */
ab_plan_body ab_plan_totals_of(const ab_schedule *schedule, size_t *nodes);
/* dt at which a spring of contact is neutrally stable, as far as any is in touch; INFINITY: none. */
double ab_plan_contact_dt(const ab_schedule *schedule, const char **limit);
bool ab_plan_has_elements(const ab_domain *domain);

#endif
