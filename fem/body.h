/* body.h: what main hands to the scheduler for `method: finite-elements` and `method: rigid`. */
#ifndef AB_FEM_BODY_H
#define AB_FEM_BODY_H

#include "core/domain.h"

ab_status fem_create(const ab_scene *, size_t body, int threads, ab_domain **, ab_report *);   /* body.c */
ab_status rigid_create(const ab_scene *, size_t body, int threads, ab_domain **, ab_report *); /* rigid.c */

#endif
