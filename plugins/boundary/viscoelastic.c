/* viscoelastic.c: dashpots that take waves away, and springs beside them that stand for the ground beyond and bring the boundary back. */
#include "abut_plugin.h"

#include <math.h>

#include "boundary/dashpots.h"

enum { DEEKS_RANDOLPH, KELLEZI, GIVEN };

typedef struct viscoelastic {
    const ab_host *host;
    double a, b, r_b, k[2];
    int springs;
} viscoelastic;

static const ab_param PARAMS[] = {
    {"a", "1", "of the dashpot along the normal, a rho c_p", NULL, AB_REAL, 0, 1.0, 0.0, INFINITY},
    {"b", "1", "of the dashpot across the normal, b rho c_s", NULL, AB_REAL, 0, 1.0, 0.0, INFINITY},
    {"springs", "1",
     "stiffness per area, along and across the normal. deeks-randolph: G/(2 r_b) both, the tail of a cylindrical wave; kellezi: rho "
     "c_p^2/r_b and "
     "rho c_s^2/r_b, that of a spherical one; given: k_n and k_t",
     "deeks-randolph|kellezi|given", AB_CHOICE, 0, DEEKS_RANDOLPH, 0, 0},
    {"r_b", "m", "distance of the boundary from what makes the waves", NULL, AB_REAL, AB_MIN_OPEN, 1.0, 0.0, INFINITY},
    {"k_n", "Pa/m", "with springs: given, stiffness along the normal", NULL, AB_REAL, 0, 0.0, 0.0, INFINITY},
    {"k_t", "Pa/m", "with springs: given, stiffness across the normal", NULL, AB_REAL, 0, 0.0, 0.0, INFINITY},
};
enum { AT_A, AT_B, AT_SPRINGS, AT_R_B, AT_K_N, AT_K_T };

static int create(const ab_host *host, const ab_value *settings, void **self) {
    const int springs = (int)settings[AT_SPRINGS].integer;
    const int stiffness = settings[AT_K_N].given || settings[AT_K_T].given;
    const char *wrong =
        springs == GIVEN && !stiffness               ? "springs: given needs k_n or k_t, in Pa/m; what is left out is 0"
        : springs == GIVEN && settings[AT_R_B].given ? "r_b says nothing where springs: given; leave one of them out"
        : springs != GIVEN && stiffness              ? "k_n and k_t are read with springs: given only; add it, or leave them out"
        : springs != GIVEN && !settings[AT_R_B].given
            ? "r_b is missing: the distance, in m, of the boundary from what makes the waves (or springs: given with k_n and k_t)"
            : NULL;
    if (wrong) return host->message(host->context, wrong), -1;
    viscoelastic *law = host->allocate(host->context, sizeof *law);
    if (!law) return -1;
    *law = (viscoelastic){.host = host,
                          .a = settings[AT_A].real,
                          .b = settings[AT_B].real,
                          .r_b = settings[AT_R_B].real,
                          .k = {settings[AT_K_N].real, settings[AT_K_T].real},
                          .springs = springs};
    *self = law;
    return 0;
}

static void destroy(void *self) {
    viscoelastic *law = self;
    law->host->release(law->host->context, law);
}

static int apply(void *self, ab_edges *e) {
    const viscoelastic *law = self;
    for (size_t i = 0; i < e->count; ++i) {
        const double rho = e->density[i], p = rho * e->p_wave_speed[i] * e->p_wave_speed[i],
                     g = rho * e->s_wave_speed[i] * e->s_wave_speed[i];
        edge_resistance r = edge_dashpots(e, i, law->a, law->b);
        r.stiffness[0] = law->springs == GIVEN ? law->k[0] : law->springs == KELLEZI ? p / law->r_b : g / (2.0 * law->r_b);
        r.stiffness[1] = law->springs == GIVEN ? law->k[1] : law->springs == KELLEZI ? g / law->r_b : g / (2.0 * law->r_b);
        edge_resist(&r, e, i, NULL);
    }
    return 0;
}

static const ab_boundary_ops OPS = {sizeof OPS, apply};
static const ab_class CLASS = {
    .struct_size = sizeof CLASS,
    .kind = AB_BOUNDARY,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D,
    .gives = AB_GIVE_TRACTION | AB_GIVE_DAMPING | AB_GIVE_STIFFNESS,
    .nparam = sizeof PARAMS / sizeof *PARAMS,
    .name = "viscoelastic",
    .help = "dashpots and springs: absorbs waves and comes back",
    .reference =
        "Deeks and Randolph 1994, J. Eng. Mech. 120(1) 25-42; Kellezi 2000, Soil Dyn. Earthq. Eng. 19 533-547; dashpots: Lysmer and "
        "Kuhlemeyer 1969",
    .param = PARAMS,
    .create = create,
    .destroy = destroy,
    .ops = &OPS,
};
static const ab_class *const CLASSES[] = {&CLASS};
const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "viscoelastic", "1.0", "MIT", CLASSES};
