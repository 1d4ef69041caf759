/* vocabulary.c: the words themselves. */
#include "core/vocabulary.h"

#include <string.h>

#define WORDS(array)                                                                                                                       \
    { array, sizeof(array) / sizeof(array)[0] }

#define ENERGY_WORDS                                                                                                                       \
    {"energy.kinetic", "J", "kinetic energy"}, {"energy.strain", "J", "strain energy"},                                                    \
        {"energy.potential", "J", "potential energy in gravity, from the start"},                                                          \
        {"energy.plastic", "J", "dissipated in the material so far"}, {"energy.friction", "J", "dissipated by slip in contact so far"},    \
        {"energy.contact", "J", "lost by normal impulses in contact so far"},                                                              \
        {"energy.boundary", "J", "taken away by sides of the grid so far"}, {"energy.damping", "J", "taken away by local damping so far"}, \
        {"energy.external", "J", "work of loads, and of the forces that move prescribed nodes and motions, so far"},                       \
        {"energy.outflow", "J", "carried out by points that left so far"},                                                                 \
        {"energy.remainder", "J", "what the discretisation made (+) or lost (-) so far"}, {                                                \
        "energy.total", "J", "kinetic + strain + potential"                                                                                \
    }

#define MOMENTUM_WORDS                                                                                                                     \
    {"mass", "kg", "mass (per m of thickness)"}, {"momentum.x", "kg m s-1", "linear momentum along x"},                                    \
        {"momentum.y", "kg m s-1", "linear momentum along y"}, {                                                                           \
        "angular-momentum", "kg m2 s-1", "angular momentum about the origin"                                                               \
    }

static const ab_word body_values[] = {
    {"position.x", "m",
     "place along x; with `at`, as all values of points, of the point nearest to that place at the start, in a mesh the nearest node"},
    {"position.y", "m", "place along y"},
    {"displacement.x", "m", "displacement along x since the start"},
    {"displacement.y", "m", "displacement along y since the start"},
    {"velocity.x", "m s-1", "velocity along x"},
    {"velocity.y", "m s-1", "velocity along y"},
    {"speed", "m s-1", "size of the velocity"},
    {"stress.xx", "Pa", "normal stress along x, tension positive"},
    {"stress.yy", "Pa", "normal stress along y, tension positive"},
    {"stress.zz", "Pa", "normal stress out of the plane, tension positive"},
    {"stress.xy", "Pa", "shear stress"},
    {"pressure", "Pa", "minus the mean normal stress"},
    {"volume", "m2", "volume (per m of thickness)"},
    MOMENTUM_WORDS,
    {"rotation-rate", "s-1", "angular momentum about the centre of mass by the moment of inertia; the spin of a rigid body"},
    {"rotation", "rad", "angle through which a rigid body has turned, counter-clockwise"},
    {"force.x", "N", "sum of the contact forces on the body along x, of all contacts it is in (per m of thickness)"},
    {"force.y", "N", "sum of the contact forces on the body along y"},
    {"moment", "N m", "moment of the contact forces on the body about its centre of mass, counter-clockwise"},
    {"reaction.x", "N", "force along x that fixed and prescribed nodes, or the prescribed motion of a rigid body, put on the body"},
    {"reaction.y", "N", "the same along y"},
    {"reaction.moment", "N m", "moment of the same about the origin, counter-clockwise"},
    ENERGY_WORDS,
};

static const ab_word contact_values[] = {
    {"force.x", "N", "total contact force on the second body along x (per m of thickness)"},
    {"force.y", "N", "total contact force on the second body along y"},
    {"moment", "N m", "moment of the contact forces on the second body about the origin, counter-clockwise"},
    {"normal-force", "N", "sum of the sizes of the normal parts"},
    {"friction-force", "N", "size of the sum of the tangential parts"},
    {"points", "1", "contact points found"},
    {"active", "1", "contact points with an impulse"},
    {"pressure.max", "Pa", "largest normal force of a contact point over its share of the surface"},
    {"length", "m", "of the surface in contact: the shares of all contact points with an impulse"},
    {"penetration", "m", "deepest penetration, 0 or more"},
    {"impulse.x", "N s", "impulse on the second body in the step, along x"},
    {"impulse.y", "N s", "impulse on the second body in the step, along y"},
    {"work.friction", "J", "dissipated by slip so far"},
    {"work.contact", "J", "lost by normal impulses so far"},
};

static const ab_word boundary_values[] = {
    {"force.x", "N", "force on the body along x"},
    {"force.y", "N", "force on the body along y"},
    {"moment", "N m", "moment on the body about the origin of the scene"},
    {"impulse.x", "N s", "impulse on the body so far, along x"},
    {"impulse.y", "N s", "impulse on the body so far, along y"},
    {"work", "J", "done on the body so far"},
    {"work.dashpot", "J", "taken from the body by what the plugin calls damping, so far"},
    {"work.spring", "J", "held by what the plugin calls stiffness"},
    {"work.other", "J", "done on the body so far by all else: loads, waves that come in, prescribed motion"},
    {"length", "m", "of the outline under it (in axisymmetric scenes area, m2)"},
};

static const ab_word scene_values[] = {
    {"dt", "s", "time step"},
    MOMENTUM_WORDS,
    ENERGY_WORDS,
};

static const ab_word over[] = {
    {"mass", "1", "average weighted with mass (default)"},
    {"volume", "1", "average weighted with volume"},
    {"max", "1", "largest of all points"},
    {"min", "1", "least of all points"},
    {"sum", "1", "sum over all points"},
    {"rms", "1", "root of the mean square weighted with mass"},
};

static const ab_word norms[] = {
    {"final", "", "value at the end of the window against the reference there"},
    {"max", "", "largest |value - reference| in the window"},
    {"l2", "", "root of the mean square of value - reference over the window"},
    {"mean", "", "mean over the window against the reference at its end"},
    {"peak", "", "largest value in the window"},
    {"min", "", "least value in the window"},
    {"range", "", "largest less least value in the window"},
    {"time-of-peak", "s", "time of the largest value"},
    {"first-above", "s", "first time with value > level"},
    {"last-above", "s", "last time with value > level"},
    {"duration", "s", "from the first to the last time with value > level"},
    {"integral", "*s", "time integral over the window"},
    {"impulse", "*s", "the same as integral, of a force"},
    {"slope", "/s", "slope of the straight line fitted over the window"},
};

static const ab_word columns[] = {
    {"t", "s", "time"},
    {"step", "1", "number of the step"},
    {"dt", "s", "time step"},
    {"stage", "1", "number of the stage, from 1; only in scenes with stages"},
    {"kinetic", "J", "kinetic energy"},
    {"strain", "J", "strain energy"},
    {"potential", "J", "potential energy in gravity, from the start"},
    {"plastic", "J", "dissipated in the material so far"},
    {"friction", "J", "dissipated by slip in contact so far"},
    {"contact", "J", "lost by normal impulses in contact so far"},
    {"boundary", "J", "taken away by sides of the grid so far"},
    {"damping", "J", "taken away by local damping so far"},
    {"external", "J", "work of loads, and of the forces that move prescribed nodes and motions, so far"},
    {"outflow", "J", "carried out by points that left; only where a side of the grid says outflow"},
    {"remainder", "J", "what the discretisation made (+) or lost (-) so far"},
};

static const ab_word fields[] = {
    {"velocity", "m s-1", "velocity of each point, or node of a mesh"},
    {"displacement", "m", "displacement of each point since the start"},
    {"stress", "Pa", "Cauchy stress (xx, yy, zz, xy), tension positive; at nodes of a mesh from the elements around"},
    {"volume", "m2", "volume of each point (per m of thickness)"},
    {"mass", "kg", "mass of each point (per m of thickness)"},
};

const ab_words ab_words_body_values = WORDS(body_values);
const ab_words ab_words_contact_values = WORDS(contact_values);
const ab_words ab_words_boundary_values = WORDS(boundary_values);
const ab_words ab_words_scene_values = WORDS(scene_values);
const ab_words ab_words_over = WORDS(over);
const ab_words ab_words_norms = WORDS(norms);
const ab_words ab_words_columns = WORDS(columns);
const ab_words ab_words_fields = WORDS(fields);

const ab_word *ab_words_find(const ab_words *words, const char *name) {
    for (size_t i = 0; i < words->count; i++)
        if (strcmp(words->word[i].name, name) == 0) return &words->word[i];
    return NULL;
}

const char *ab_component_names(const char *names, int components) {
    if (names != NULL && names[0] != '\0') return names;
    return components == 2 ? "x y" : components == 4 ? "xx yy zz xy" : components == 5 ? "xx xy yx yy zz" : "value";
}

bool ab_column_is_total(const char *name) {
    return strcmp(name, "t") == 0 || strcmp(name, "step") == 0 || strcmp(name, "dt") == 0 || strcmp(name, "stage") == 0 ||
           strcmp(name, "remainder") == 0;
}

bool ab_norm_needs_level(const char *name) {
    return strcmp(name, "first-above") == 0 || strcmp(name, "last-above") == 0 || strcmp(name, "duration") == 0;
}

bool ab_value_is_of_points(const char *name) {
    static const char *const heads[] = {"position.", "displacement.", "velocity.", "speed", "stress.", "pressure"};
    for (size_t i = 0; i < sizeof heads / sizeof heads[0]; i++)
        if (strncmp(name, heads[i], strlen(heads[i])) == 0) return true;
    return strcmp(name, "volume") == 0 || strcmp(name, "mass") == 0;
}
