/* wrong_boundary_gives.c: a boundary that gives neither a traction nor a motion. */
#define KIND AB_BOUNDARY
#define OPS_SIZE sizeof(ab_boundary_ops)
#define START update /* apply */
#define GIVES AB_GIVE_DAMPING
#include "wrong.h"
