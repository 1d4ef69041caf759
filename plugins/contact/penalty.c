/* penalty.c: answers contact points with springs: a force of stiffness x penetration x area along the normal, viscous damping beside it, and across the
 * normal a spring that slips at the Coulomb limit.
 *
 * Springs are explicit: their force is that of the places at the start of the step, so it does not change from round to round and needs dt below
 * 2 sqrt(m/k). The viscous part is implicit in the velocity that all impulses of the step leave, and stable for any dt.
 *
 * A spring gives back at most what it has taken. Where a point begins deep in the other body (a corner reaches a node of the grid that was not shared before, bodies
 * are drawn overlapping) nothing has loaded its spring: it stops the bodies and throws nothing. So does one whose stiffness grows under its load. */
#include "abut_plugin.h"

#include <math.h>

enum { OF_MASS, OF_MODULUS };

typedef struct penalty {
    const ab_host *host;
    double stiffness, damping, friction, kinetic, tangential;
    int of, weakens; /* weakens: kinetic < friction */
} penalty;

static const ab_param PARAMS[] = {
    {"stiffness_of", "1",
     "what stiffness is a multiple of. mass: of m/dt^2, m the effective mass of the contact point along the normal: any dt will do, and "
     "the "
     "smaller, the stiffer. modulus: of E/h per area, E the P-wave modulus of the softer body and h the cell: the same for every dt, which "
     "has "
     "to stay below 2 sqrt(m/k)",
     "mass|modulus", AB_CHOICE, 0, OF_MASS, 0, 0},
    {"stiffness", "1",
     "multiple of what stiffness_of says: of mass at most 1, of modulus up to about 3; a pressure p makes bodies overlap by h p/(3 E). "
     "How far bodies overlap by their drawing nothing has pressed: springs keep it from growing and do not push it out",
     NULL, AB_REAL, AB_MIN_OPEN, 0.5, 0.0, 1e6},
    {"damping", "1", "viscous part, along and across the normal, of the critical one; it never pulls and stays below the friction limit",
     NULL, AB_REAL, 0, 0.2, 0.0, 1.0},
    {"friction", "1", "coefficient of friction", NULL, AB_REAL, 0, 0.0, 0.0, INFINITY},
    {"tangential", "1", "stiffness across the normal, of that along it", NULL, AB_REAL, AB_MIN_OPEN, 1.0, 0.0, 1.0},
    {"kinetic_friction", "1",
     "coefficient of friction of a point that slips, at most friction, which then is that of a point that sticks; without it: the same as "
     "friction",
     NULL, AB_REAL, 0, INFINITY, 0.0, INFINITY},
};

static const ab_state STATES[] = {
    {"elastic_slip", "m", "stretch of the spring across the normal", AB_VECTOR, AB_AVERAGE, 0.0},
    {"slips", "1", "1 where the point slipped in the last step or was apart (kept with kinetic_friction)", AB_SCALAR, AB_COPY, 0.0},
    {"stored", "J/m", "elastic energy in the spring along the normal: what it can give back (J in three dimensions)", AB_SCALAR, AB_SUM,
     0.0},
    {"stiffness_across", "N/m", "of the spring across the normal in the last step (per m of thickness in plane strain)", AB_SCALAR, AB_COPY,
     0.0},
};
enum { STATE_SLIPS, STATE_STORED, STATE_ACROSS }; /* rows after those of elastic_slip */

static int create(const ab_host *host, const ab_value *settings, void **self) {
    const int of = (int)settings[0].integer;
    if (of == OF_MASS && settings[1].real > 1.0)
        return host->message(host->context,
                             "a stiffness above 1 x mass/dt^2 overshoots in a single step where points share nodes; use at most 1, or "
                             "stiffness_of: modulus"),
               -1;
    if (settings[5].given && settings[5].real > settings[3].real)
        return host->message(host->context, "kinetic_friction is above friction, which is the static coefficient; it must not be"), -1;
    penalty *law = host->allocate(host->context, sizeof *law);
    if (!law) return -1;
    const double kinetic = fmin(settings[5].real, settings[3].real);
    *law = (penalty){host, settings[1].real, settings[2].real, settings[3].real, kinetic, settings[4].real, of, kinetic < settings[3].real};
    *self = law;
    return 0;
}

static void destroy(void *self) {
    penalty *law = self;
    law->host->release(law->host->context, law);
}

static const double AT_LIMIT = 1e-9; /* of the limit: what is needed beyond it is rounding, not slip */

/* The stretch of the tangential spring turned with the normal: as long as it was, in the plane that is tangential now. A spring that has become stiffer is as much
 * shorter as keeps its energy, k slip^2/2. */
static void turned_slip(const ab_points *p, size_t i, double k, double slip[3]) {
    const size_t ld = p->ld, d = p->dimension;
    const double last = p->state0[(d + STATE_ACROSS) * ld + i];
    double along = 0.0, old = 0.0, now = 0.0;
    for (size_t c = 0; c < d; ++c) {
        slip[c] = p->state0[c * ld + i];
        along += slip[c] * p->normal[c * ld + i];
        old += slip[c] * slip[c];
    }
    for (size_t c = 0; c < d; ++c) {
        slip[c] -= along * p->normal[c * ld + i];
        now += slip[c] * slip[c];
    }
    double scale = now > 0.0 ? sqrt(old / now) : 0.0;
    if (last < k) scale *= sqrt(last / k);
    for (size_t c = 0; c < d; ++c) slip[c] *= scale;
}

/* Tangential impulse under the limit mu lambda, and the stretch that the spring has then. A spring at the limit gives way: what is beyond is slip. across: the
 * velocity across the normal that the bodies would have without the impulse. */
static void slip_spring(const penalty *law, const ab_points *p, size_t i, double k, double limit, const double across[3],
                        double impulse[3]) {
    const size_t ld = p->ld, d = p->dimension;
    const double dt = p->dt, m = p->tangential_mass[i], c_dt = 2.0 * law->damping * sqrt(k * m) * dt;
    double slip[3] = {0}, stretch = 0.0, size = 0.0;
    turned_slip(p, i, k, slip);
    for (size_t c = 0; c < d; ++c) stretch += slip[c] * slip[c];
    stretch = sqrt(stretch);
    const double kept = stretch * k * dt > limit ? limit / (stretch * k * dt) : 1.0;
    for (size_t c = 0; c < d; ++c) {
        slip[c] *= kept;
        impulse[c] = (dt * k * slip[c] + c_dt * across[c]) / (1.0 + c_dt / m);
        size += impulse[c] * impulse[c];
    }
    size = sqrt(size);
    const double scale = size > limit ? limit / size : 1.0;
    p->state1[(d + STATE_ACROSS) * ld + i] = k;
    if (law->weakens) p->state1[(d + STATE_SLIPS) * ld + i] = kept < 1.0 - AT_LIMIT || scale < 1.0 - AT_LIMIT ? 1.0 : 0.0;
    for (size_t c = 0; c < d; ++c) {
        impulse[c] *= scale;
        p->state1[c * ld + i] = slip[c] + dt * (across[c] - impulse[c] / m);
    }
}

/* Impulse of the spring along the normal and its damper: lambda = held + c_dt (free - lambda/m), held = dt k depth, c_dt the damper times dt, free the approach
 * without lambda; old: the approach at the start of the step.
 *
 * lambda takes lambda (old + new)/2 from the bodies, new = free - lambda/m, and may not take less than -stored. An approach at the start is not counted: what
 * stops it stores its work and can give it back in the steps to come; so a spring without energy ends an approach and does not turn it round. Then
 * lambda <= m (s + sqrt(s^2 + 2 stored/m)), s = (min(old, 0) + free)/2. Both bounds rise with free, by at most m, which is what the host's rounds need to end.
 *
 * What is stored is the work of the spring alone: a damper that pulls back takes what the spring gives. It is k depth^2/2 only where the gap changes by the very
 * velocity that the impulse works on; nodes of the grid are off by a fifth, and are not cut down to it. */
static double loaded_spring(double held, double m, double c_dt, double free, double old, double *stored) {
    const double damped = 1.0 + c_dt / m, s = 0.5 * (fmin(old, 0.0) + free);
    const double root = sqrt(s * s + 2.0 * *stored / m), most = s >= 0.0 ? m * (s + root) : 2.0 * *stored / (root - s);
    const double lambda = fmax(0.0, fmin((held + c_dt * free) / damped, most));
    const double mean = 0.5 * (old + free - lambda / m), elastic = fmax(0.0, fmin(lambda * damped - c_dt * free, held));
    *stored = fmax(0.0, *stored + fmin(elastic * mean, lambda * mean));
    return lambda;
}

/* Of a cell of the grid: h, in three dimensions h^2, of rings what h sweeps there, at the axis what a cell beside it has in its middle. */
static double cell_face(const ab_points *p, size_t i) {
    if (p->axisymmetric) return 6.283185307179586 * fmax(p->position[i], 0.5 * p->cell) * p->cell;
    return p->dimension == 3 ? p->cell * p->cell : p->cell;
}

/* A point that is a node, on both sides: no other has its masses. */
static int alone(const ab_points *p, size_t i) { return p->a_start[i + 1] - p->a_start[i] == 1 && p->b_start[i + 1] - p->b_start[i] == 1; }

/* Stiffness of point i along the normal, N/m. Of mass: points that are several on the nodes of a cell share their masses as they share its face. */
static double normal_stiffness(const penalty *law, const ab_points *p, size_t i) {
    if (law->of == OF_MODULUS) return law->stiffness * p->modulus / p->cell * p->area[i];
    return law->stiffness * p->normal_mass[i] / (p->dt * p->dt) * (alone(p, i) ? 1.0 : fmin(1.0, p->area[i] / cell_face(p, i)));
}

/* What the host's bound of the step, 2 sqrt(m/k), has to know of a spring of modulus. Points that share nodes with others swing with all of a cell's face; and a
 * node that the body just reaches has next to no mass while the gap, which comes from material points, swings with theirs: no more area is counted than that of
 * a column with its mass. */
static double bounding_stiffness(const penalty *law, const ab_points *p, size_t i) {
    static const double COLUMN = 8.0; /* a node on the face between two equal bodies has rho h A/4: light is less than half of that */
    double area = alone(p, i) ? p->area[i] : fmax(p->area[i], cell_face(p, i));
    if (p->density > 0.0) area = fmin(area, COLUMN * p->normal_mass[i] / (p->density * p->cell));
    return law->stiffness * p->modulus / p->cell * area;
}

static const double SOON = 0.1, SOON_STEPS = 4.0; /* of a cell; steps */

static int respond(void *self, ab_points *p, size_t first, size_t count) {
    const penalty *law = self;
    const size_t ld = p->ld, d = p->dimension;
    if (law->of == OF_MODULUS && !(p->modulus > 0.0 && isfinite(p->modulus)))
        return law->host->message(law->host->context, "stiffness_of: modulus needs a body that can be deformed; between rigid bodies use "
                                                      "stiffness_of: mass"),
               -1;
    for (size_t i = first; i < first + count; ++i) {
        const double depth = -p->gap[i], m = p->normal_mass[i], mt = p->tangential_mass[i], dt = p->dt;
        double approach = 0.0, began = 0.0, lambda = 0.0, impulse[3] = {0};
        for (size_t c = 0; c < d; ++c) {
            approach += p->relative_velocity[c * ld + i] * p->normal[c * ld + i];
            began += p->relative_velocity_old[c * ld + i] * p->normal[c * ld + i];
            lambda += p->impulse[c * ld + i] * p->normal[c * ld + i];
            p->state1[c * ld + i] = 0.0;
        }
        p->state1[(d + STATE_SLIPS) * ld + i] =
            law->weakens; /* bodies that are apart slip; when they meet, until kinetic friction holds them */
        p->state1[(d + STATE_STORED) * ld + i] = p->state1[(d + STATE_ACROSS) * ld + i] = 0.0;
        /* the host bounds the next step: springs that the bodies are about to meet count already */
        if (p->stiffness && law->of == OF_MODULUS && m > 0.0 && depth > -fmax(SOON * p->cell, SOON_STEPS * dt * approach))
            p->stiffness[i] = bounding_stiffness(law, p, i);
        if (depth > 0.0 && m > 0.0) {
            const double k = normal_stiffness(law, p, i), c_dt = 2.0 * law->damping * sqrt(k * m) * dt, old = lambda;
            double stored = p->state0[(d + STATE_STORED) * ld + i];
            lambda = loaded_spring(dt * k * depth, m, c_dt, approach + old / m, began, &stored);
            p->state1[(d + STATE_STORED) * ld + i] = stored;
            if (law->friction > 0.0 && mt > 0.0) {
                double across[3] = {0};
                for (size_t c = 0; c < d; ++c) {
                    const double n = p->normal[c * ld + i];
                    across[c] = p->relative_velocity[c * ld + i] - approach * n + (p->impulse[c * ld + i] - old * n) / mt;
                }
                const double kt = law->tangential * (law->of == OF_MASS ? k / m * mt : k);
                const double friction = law->weakens && p->state0[(d + STATE_SLIPS) * ld + i] > 0.5 ? law->kinetic : law->friction;
                slip_spring(law, p, i, kt, friction * lambda, across, impulse);
            }
        } else if (depth > 0.0 && law->of == OF_MODULUS)
            lambda = dt * normal_stiffness(law, p, i) *
                     depth; /* both sides are held or driven: nothing swings, and the force is what holds them */
        else
            lambda = 0.0;
        for (size_t c = 0; c < d; ++c) p->impulse[c * ld + i] = lambda * p->normal[c * ld + i] + impulse[c];
    }
    return 0;
}

static uint32_t needs_with(const ab_value *settings) { return settings[0].integer == OF_MODULUS ? AB_NEED_AREA : 0u; }

static const ab_contact_ops OPS = {sizeof OPS, NULL, respond};
static const ab_class CLASS = {
    .struct_size = sizeof CLASS,
    .kind = AB_CONTACT,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D,
    .needs = AB_NEED_GAP,
    .gives = AB_GIVE_IMPULSE,
    .nparam = sizeof PARAMS / sizeof *PARAMS,
    .nstate = sizeof STATES / sizeof *STATES,
    .name = "penalty",
    .help = "springs between bodies that overlap, with damping and friction",
    .reference = "Wriggers 2006, Computational Contact Mechanics, ch. 6.3; friction by return of an elastic slip: Giannakopoulos 1989",
    .param = PARAMS,
    .state = STATES,
    .create = create,
    .destroy = destroy,
    .ops = &OPS,
    .needs_with = needs_with,
};
static const ab_class *const CLASSES[] = {&CLASS};
const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "penalty", "1.0", "MIT", CLASSES};
