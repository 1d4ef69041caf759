/* neo_hookean.c: compressible neo-Hookean elasticity for large strain,
 *     sigma = mu/J (b - I) + lambda ln(J)/J I,   b = F F^T, J = det F   (Bonet and Wood 2008, eq. 6.29).
 * Along one axis the first Piola-Kirchhoff stress is mu (F - 1/F) + lambda ln(J)/F, its slope (lambda (1 - ln J) + mu)/F^2 + mu. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "abut_plugin.h"

#if defined(__GNUC__) && !defined(__clang__)
#define ROWS_APART _Pragma("GCC ivdep") /* ld >= count: rows do not overlap, which the compiler cannot know */
#else
#define ROWS_APART
#endif

typedef struct law {
    const ab_host *host;
    double lambda, mu; /* Pa */
} law;

static int create(const ab_host *host, const ab_value *settings, void **self) {
    const double E = settings[0].real, nu = settings[1].real;
    law *made = host->allocate(host->context, sizeof *made);
    if (!made) return -1;
    *made = (law){.host = host, .lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), .mu = E / (2 * (1 + nu))};
    *self = made;
    return 0;
}

static void destroy(void *self) {
    const law *made = self;
    made->host->release(made->host->context, self);
}

/* ln x for normal positive x, below one unit in the last place: the method and the coefficients of fdlibm's e_log.c (Sun Microsystems 1993),
 * without branches and calls, so that the loop around it becomes vector code. x = 2^k m, sqrt(1/2) < m < sqrt(2), s = (m-1)/(m+1). */
static inline double natural_log(double x) {
    uint64_t bits, exponent, k_bits;
    double m, k;
    memcpy(&bits, &x, sizeof bits);
    exponent = (bits + (0x3ff0000000000000u - 0x3fe6a09e00000000u)) >> 52; /* k + 1023 */
    bits -= (exponent << 52) - 0x3ff0000000000000u;
    memcpy(&m, &bits, sizeof m);
    k_bits = exponent | 0x4330000000000000u; /* 2^52 + exponent as a double */
    memcpy(&k, &k_bits, sizeof k);
    k -= 0x1p52 + 1023.0;
    const double f = m - 1.0, half_square = 0.5 * f * f, s = f / (2.0 + f), z = s * s, w = z * z;
    const double even = w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
    const double odd =
        z * (6.666666666666735130e-01 + w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
    return k * 6.93147180369123816490e-01 - ((half_square - (s * (half_square + (odd + even)) + k * 1.90821492927058770002e-10)) - f);
}

typedef struct strain {
    double xx, yy, zz, xy, yz, zx, J;
} strain; /* b and J */

static inline __attribute__((always_inline)) strain left_cauchy_green(const double *restrict F, size_t ld, size_t i, int dimension) {
    if (dimension == 2) {
        const double xx = F[i], xy = F[ld + i], yx = F[2 * ld + i], yy = F[3 * ld + i], zz = F[4 * ld + i];
        return (strain){
            .xx = xx * xx + xy * xy, .yy = yx * yx + yy * yy, .zz = zz * zz, .xy = xx * yx + xy * yy, .J = (xx * yy - xy * yx) * zz};
    }
    const double xx = F[i], xy = F[ld + i], xz = F[2 * ld + i], yx = F[3 * ld + i], yy = F[4 * ld + i], yz = F[5 * ld + i];
    const double zx = F[6 * ld + i], zy = F[7 * ld + i], zz = F[8 * ld + i];
    return (strain){.xx = xx * xx + xy * xy + xz * xz,
                    .yy = yx * yx + yy * yy + yz * yz,
                    .zz = zx * zx + zy * zy + zz * zz,
                    .xy = xx * yx + xy * yy + xz * yz,
                    .yz = yx * zx + yy * zy + yz * zz,
                    .zx = zx * xx + zy * xy + zz * xz,
                    .J = xx * (yy * zz - yz * zy) - xy * (yx * zz - yz * zx) + xz * (yx * zy - yy * zx)};
}

static inline int is_turned_over(double J) { return !(J > 0x1p-1000 && J < 0x1p1000); } /* NaN is, too */

typedef struct rows {
    const double *F, *density;
    double *stress, *speed;
} rows; /* speed may be NULL */

/* Eight items, whose rows are ld apart. Returns how many are turned over; their stress is that of J = 1. Inlined into one function per
 * dimension and nowhere else, so that an item has the same bits in any batch, however the compiler fuses products and sums. */
static inline __attribute__((always_inline)) long stress(double lambda, double mu, size_t ld, int dimension, const double *restrict F,
                                                         double *restrict sigma) {
    long bad = 0;
    ROWS_APART
    for (size_t i = 0; i < 8; i++) {
        const strain b = left_cauchy_green(F, ld, i, dimension);
        const double J = is_turned_over(b.J) ? 1.0 : b.J;
        bad += is_turned_over(b.J);
        const double inverse = 1.0 / J, shear = mu * inverse, pressure = lambda * natural_log(J) * inverse;
        sigma[i] = shear * (b.xx - 1.0) + pressure;
        sigma[ld + i] = shear * (b.yy - 1.0) + pressure;
        sigma[2 * ld + i] = shear * (b.zz - 1.0) + pressure;
        sigma[3 * ld + i] = shear * b.xy;
        if (dimension == 3) sigma[4 * ld + i] = shear * b.yz;
        if (dimension == 3) sigma[5 * ld + i] = shear * b.zx;
    }
    return bad;
}

/* The P-wave modulus along an axis with b_i is (lambda (1 - ln J) + mu + mu b_i)/J; the largest b_i is at most the largest row sum of |b|. */
static inline __attribute__((always_inline)) void wave_speed(double lambda, double mu, size_t ld, int dimension, const double *restrict F,
                                                             const double *restrict density, double *restrict speed) {
    for (size_t i = 0; i < 8; i++) {
        const strain s = left_cauchy_green(F, ld, i, dimension);
        const double x = s.xx + fabs(s.xy) + fabs(s.zx), y = s.yy + fabs(s.xy) + fabs(s.yz), z = s.zz + fabs(s.yz) + fabs(s.zx);
        const double largest = x > y ? (x > z ? x : z) : (y > z ? y : z), J = is_turned_over(s.J) ? 1.0 : s.J;
        const double bulk = lambda * (1.0 - natural_log(J));
        speed[i] = sqrt(((bulk > 0.0 ? bulk : 0.0) + mu + mu * largest) / (J * density[i]));
    }
}

static __attribute__((noinline)) long plane(const law *l, size_t ld, const rows *r) {
    if (r->speed) wave_speed(l->lambda, l->mu, ld, 2, r->F, r->density, r->speed);
    return stress(l->lambda, l->mu, ld, 2, r->F, r->stress);
}

static __attribute__((noinline)) long space(const law *l, size_t ld, const rows *r) {
    if (r->speed) wave_speed(l->lambda, l->mu, ld, 3, r->F, r->density, r->speed);
    return stress(l->lambda, l->mu, ld, 3, r->F, r->stress);
}

/* Fewer than eight items from `first` on: the last one again in the lanes that are free. */
static long few(const law *l, ab_batch *b, size_t first) {
    double F[9 * 8], sigma[6 * 8], density[8], speed[8];
    const size_t count = b->count - first, size = b->dimension == 2 ? 5 : 9;
    for (size_t i = 0; i < 8; i++) {
        const size_t from = first + (i < count ? i : count - 1);
        density[i] = b->wave_speed ? b->density[from] : 1.0;
        for (size_t c = 0; c < size; c++) F[c * 8 + i] = b->deformation_gradient[c * b->ld + from];
    }
    const long bad = (b->dimension == 2 ? plane : space)(l, 8, &(rows){F, density, sigma, b->wave_speed ? speed : NULL});
    for (size_t i = 0; i < count; i++) {
        for (size_t c = 0; c < b->components; c++) b->stress1[c * b->ld + first + i] = sigma[c * 8 + i];
        if (b->wave_speed) b->wave_speed[first + i] = speed[i];
    }
    return bad;
}

/* Says which items have J <= 0, or so small that the rounding of another function may have taken it for that. */
static int complain(const law *l, ab_batch *b) {
    char text[160];
    for (size_t i = 0; i < b->count; i++) {
        const double J = left_cauchy_green(b->deformation_gradient, b->ld, i, (int)b->dimension).J;
        if (J > 1e-12 && !is_turned_over(J)) continue;
        b->flag[i] = 1;
        if (isfinite(J))
            snprintf(text, sizeof text, "the material is turned inside out: det F = %g", J);
        else
            snprintf(text, sizeof text, "the material is turned inside out: det F is no finite number, the run has blown up");
        l->host->message(l->host->context, text);
    }
    return -1;
}

static int update(void *self, ab_batch *b) {
    const law *l = self;
    long bad = 0;
    size_t i = 0;
    for (; i + 8 <= b->count; i += 8)
        bad += (b->dimension == 2 ? plane : space)(l, b->ld,
                                                   &(rows){b->deformation_gradient + i, b->wave_speed ? b->density + i : NULL,
                                                           b->stress1 + i, b->wave_speed ? b->wave_speed + i : NULL});
    if (i < b->count) bad += few(l, b, i);
    return bad == 0 ? 0 : complain(l, b);
}

static const ab_param params[] = {
    {"E", "Pa", "Young's modulus at small strain", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN, 0, 0, INFINITY},
    {"nu", "1", "Poisson's ratio at small strain", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN | AB_MAX_OPEN, 0, -1, 0.5},
};
static const ab_material_ops ops = {sizeof ops, NULL, update};
static const ab_class neo_hookean = {
    .struct_size = sizeof(ab_class),
    .kind = AB_MATERIAL,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D,
    .needs = AB_NEED_DEFORMATION_GRADIENT,
    .gives = AB_GIVE_STRESS | AB_GIVE_WAVE_SPEED,
    .nparam = 2,
    .name = "neo-hookean",
    .help = "compressible neo-Hookean elasticity, any strain",
    .reference = "Bonet and Wood 2008, eq. 6.29",
    .param = params,
    .create = create,
    .destroy = destroy,
    .ops = &ops,
};
static const ab_class *const classes[] = {&neo_hookean};
AB_EXPORT const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "neo-hookean", "1.0", "MIT", classes};
