/* vector.h: eight doubles at a time by the compiler's vector extensions; the same source serves AVX-512, AVX2, SSE2 and NEON. */
#ifndef AB_VECTOR_H
#define AB_VECTOR_H

#include <stdint.h>
#if defined(__AVX512F__)
#include <immintrin.h>
#endif

typedef double v8 __attribute__((vector_size(64)));
typedef double v8_loose __attribute__((vector_size(64), aligned(8))); /* for loads from any double */
typedef double v4 __attribute__((vector_size(32)));
typedef double v4_loose __attribute__((vector_size(32), aligned(8)));
typedef double v2 __attribute__((vector_size(16)));
typedef double v2_loose __attribute__((vector_size(16), aligned(8)));
typedef int32_t v8_int __attribute__((vector_size(32)));
typedef int64_t v8_mask __attribute__((vector_size(64)));

/* As fmax and fmin, a NaN being ignored, but inline: calls of the library's cost ten times as much, and more where vectors are in use. */
static inline double ab_larger(double a, double b) { return b > a || a != a ? b : a; }
static inline double ab_smaller(double a, double b) { return b < a || a != a ? b : a; }

static inline v8 v8_set(double a) {
#if defined(__AVX512F__)
    return (v8){a, a, a, a, a, a, a, a};
#else
    return a - (v8){0}; /* a broadcast; gcc would fill an initialiser lane by lane through memory */
#endif
}
static inline v4 v4_set(double a) { return (v4){a, a, a, a}; }
static inline v8 v8_load(const double *p) { return *(const v8_loose *)p; }
static inline v4 v4_load(const double *p) { return *(const v4_loose *)p; }
static inline void v8_store(double *p, v8 a) { *(v8_loose *)p = a; }
static inline void v4_store(double *p, v4 a) { *(v4_loose *)p = a; }
static inline v8 v8_select(v8_mask c, v8 a, v8 b) { return (v8)((c & (v8_mask)a) | (~c & (v8_mask)b)); }
static inline v8 v8_min(v8 a, v8 b) {
#if defined(__AVX512F__)
    return (v8)_mm512_min_pd((__m512d)a, (__m512d)b);
#else
    return v8_select(a < b, a, b);
#endif
}
static inline v8 v8_max(v8 a, v8 b) {
#if defined(__AVX512F__)
    return (v8)_mm512_max_pd((__m512d)a, (__m512d)b);
#else
    return v8_select(a > b, a, b);
#endif
}
/* a < b ? x : y, lane by lane. */
static inline v8 v8_less(v8 a, v8 b, v8 x, v8 y) {
#if defined(__AVX512F__)
    return (v8)_mm512_mask_blend_pd(_mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ), (__m512d)y, (__m512d)x);
#else
    return v8_select(a < b, x, y);
#endif
}
/* Lanes whose bit is set in `bits` take *b, the others *a. */
#if defined(__AVX512F__)
#define v8_two(a, b, bits) ((v8)_mm512_mask_broadcastsd_pd(_mm512_set1_pd(*(a)), (bits), _mm_load_sd(b)))
#else
#define V8_BIT(bits, l) (-(int64_t)((bits) >> (l)&1))
#define v8_two(a, b, bits)                                                                                                                 \
    v8_select((v8_mask){V8_BIT(bits, 0), V8_BIT(bits, 1), V8_BIT(bits, 2), V8_BIT(bits, 3), V8_BIT(bits, 4), V8_BIT(bits, 5),              \
                        V8_BIT(bits, 6), V8_BIT(bits, 7)},                                                                                 \
              v8_set(*(b)), v8_set(*(a)))
#endif
static inline v8 v8_floor(v8 a) /* |a| < 2^51 */
{
#if defined(__AVX512F__)
    return (v8)_mm512_roundscale_pd((__m512d)a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
#endif
    const v8 magic = v8_set(0x1.8p52);
    const v8 nearest = (a + magic) - magic;
    return nearest - v8_select(nearest > a, v8_set(1.0), v8_set(0.0));
}
static inline double v8_sum(v8 a) /* in one fixed order */
{
    return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7]));
}
static inline double v8_lowest(v8 a) {
    double m = a[0];
    for (int l = 1; l < 8; ++l) m = a[l] < m ? a[l] : m;
    return m;
}
static inline double v8_highest(v8 a) {
    double m = a[0];
    for (int l = 1; l < 8; ++l) m = a[l] > m ? a[l] : m;
    return m;
}
static inline v2 v2_load(const double *p) { return *(const v2_loose *)p; }
static inline void v2_store(double *p, v2 a) { *(v2_loose *)p = a; }
static inline v8 v8_join(v4 low, v4 high) {
#if defined(__AVX512F__)
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
#else
    v8 both;
    __builtin_memcpy(&both, &low, sizeof low);
    __builtin_memcpy((char *)&both + sizeof low, &high, sizeof high);
    return both;
#endif
}
static inline v4 v8_low(v8 a) {
    v4 low;
    __builtin_memcpy(&low, &a, sizeof low);
    return low;
}

/* Makes the compiler take an array it has just stored from memory again: a broadcast from memory is free, one from a register's lane costs two shuffles. */
#define V8_IN_MEMORY(array) __asm__("" : "+m"(array))

/* Rows become columns: between eight points' component c and one point's eight components. */
static inline __attribute__((always_inline)) void v8_transpose(v8 r[8]) {
#if defined(__AVX512F__)
#define AB_LO(a, b) __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14)
#define AB_HI(a, b) __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15)
#define AB_EVEN(a, b) __builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13)
#define AB_ODD(a, b) __builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15)
    const v8 a0 = AB_LO(r[0], r[1]), a1 = AB_HI(r[0], r[1]), a2 = AB_LO(r[2], r[3]), a3 = AB_HI(r[2], r[3]);
    const v8 a4 = AB_LO(r[4], r[5]), a5 = AB_HI(r[4], r[5]), a6 = AB_LO(r[6], r[7]), a7 = AB_HI(r[6], r[7]);
    const v8 b0 = AB_EVEN(a0, a2), b1 = AB_EVEN(a1, a3), b2 = AB_ODD(a0, a2), b3 = AB_ODD(a1, a3);
    const v8 b4 = AB_EVEN(a4, a6), b5 = AB_EVEN(a5, a7), b6 = AB_ODD(a4, a6), b7 = AB_ODD(a5, a7);
    r[0] = AB_EVEN(b0, b4);
    r[4] = AB_ODD(b0, b4);
    r[1] = AB_EVEN(b1, b5);
    r[5] = AB_ODD(b1, b5);
    r[2] = AB_EVEN(b2, b6);
    r[6] = AB_ODD(b2, b6);
    r[3] = AB_EVEN(b3, b7);
    r[7] = AB_ODD(b3, b7);
#undef AB_LO
#undef AB_HI
#undef AB_EVEN
#undef AB_ODD
#else /* shuffles across 64 bytes are slow where registers are shorter: go through memory */
    double from[8][8] __attribute__((aligned(64))), to[8][8] __attribute__((aligned(64)));
    for (int i = 0; i < 8; ++i) *(v8 *)from[i] = r[i];
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j) to[j][i] = from[i][j];
    for (int i = 0; i < 8; ++i) r[i] = *(v8 *)to[i];
#endif
}

/* The same for eight points of four components: four vectors over the points. */
static inline __attribute__((always_inline)) void v8_transpose_half(const v4 r[8], v8 out[4]) {
#if defined(__AVX512F__)
    const v8 p0 = v8_join(r[0], r[4]), p1 = v8_join(r[1], r[5]), p2 = v8_join(r[2], r[6]), p3 = v8_join(r[3], r[7]);
    /* p0: 0a 0b 0c 0d 4a 4b 4c 4d, ... */
    const v8 ac0 = __builtin_shufflevector(p0, p1, 0, 8, 2, 10, 4, 12, 6, 14),
             bd0 = __builtin_shufflevector(p0, p1, 1, 9, 3, 11, 5, 13, 7, 15);
    const v8 ac1 = __builtin_shufflevector(p2, p3, 0, 8, 2, 10, 4, 12, 6, 14),
             bd1 = __builtin_shufflevector(p2, p3, 1, 9, 3, 11, 5, 13, 7, 15);
    out[0] = __builtin_shufflevector(ac0, ac1, 0, 1, 8, 9, 4, 5, 12, 13);
    out[1] = __builtin_shufflevector(bd0, bd1, 0, 1, 8, 9, 4, 5, 12, 13);
    out[2] = __builtin_shufflevector(ac0, ac1, 2, 3, 10, 11, 6, 7, 14, 15);
    out[3] = __builtin_shufflevector(bd0, bd1, 2, 3, 10, 11, 6, 7, 14, 15);
#else
    double from[8][4] __attribute__((aligned(64))), to[4][8] __attribute__((aligned(64)));
    for (int i = 0; i < 8; ++i) *(v4 *)from[i] = r[i];
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 4; ++j) to[j][i] = from[i][j];
    for (int j = 0; j < 4; ++j) out[j] = *(v8 *)to[j];
#endif
}

#endif
