/* wrong_boundary_damping.c: a boundary with a stiffness of no traction. */
#define KIND AB_BOUNDARY
#define OPS_SIZE sizeof(ab_boundary_ops)
#define START update /* apply */
#define GIVES (AB_GIVE_MOTION | AB_GIVE_STIFFNESS)
#include "wrong.h"
