/* wrong_flush_to_zero.c: turns denormal numbers off for the whole program as it is loaded. */
#if defined(__SSE2__)
#include <xmmintrin.h>
#define CONSTRUCTOR _mm_setcsr(_mm_getcsr() | 0x8040u)
#elif defined(__aarch64__)
#define CONSTRUCTOR __asm__ volatile("msr fpcr, %0" : : "r"(1ul << 24))
#endif
#include "wrong.h"
