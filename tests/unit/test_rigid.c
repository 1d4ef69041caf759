/* test_rigid.c: rigid bodies: area and inertia of every shape, the layer of points that the grid sees, motion as given or from forces, and a ledger that closes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fem/body.h"
#include "fem/rigid.h"
#include "whole_scene.h"

static const double PI = 3.14159265358979323846;

typedef struct one {
    ab_report *report;
    ab_registry *registry;
    ab_scene *scene;
    ab_domain *domain;
    rigid_body *body;
    ab_step step;
} one;

/* Scene of one body `b`; its section behind "method: rigid, " and whole other sections. */
static ab_status read_scene(one *o, const char *body, const char *more) {
    char text[4000];
    snprintf(text, sizeof text,
             "abut: 1\nspace: plane-strain\ntime: {end: 1e4, dt: 0.001}\n"
             "materials: {m: {model: linear-elastic, E: 1000, nu: 0.3, density: 2}}\n"
             "bodies: {b: {method: rigid, %s}}\n%s",
             body, more);
    o->report = ab_report_create();
    ab_status status = whole_scene_read(text, &o->registry, &o->scene, o->report);
    if (status == AB_OK) status = rigid_create(o->scene, 0, 1, &o->domain, o->report);
    o->body = (rigid_body *)o->domain;
    o->step.dt = 0.001;
    return status;
}

static void say_all(const one *o) {
    for (size_t i = 0; ab_report_text(o->report, i); i++) print_error("%s\n", ab_report_text(o->report, i));
}

#define must(o, call)                                                                                                                      \
    do {                                                                                                                                   \
        const ab_status status_ = (call);                                                                                                  \
        if (status_ != AB_OK) say_all(o);                                                                                                  \
        assert_int_equal(status_, AB_OK);                                                                                                  \
    } while (0)

static one create(const char *body, const char *more) {
    one o = {0};
    must(&o, read_scene(&o, body, more));
    return o;
}

static void clear(one *o) {
    if (o->domain) o->domain->ops->destroy(o->domain);
    if (o->scene) ab_scene_destroy(o->scene);
    ab_registry_destroy(o->registry);
    ab_report_destroy(o->report);
}

/* One step; `push`, where given, stands in for contact. */
static void step(one *o, void (*push)(one *, const ab_dofs *)) {
    for (int c = 0; c < 2; c++) o->step.gravity[c] = ab_number_at(o->scene->gravity + c, o->step.time + 0.5 * o->step.dt, 0, 0, 0);
    const ab_domain_ops *ops = o->domain->ops;
    must(o, ops->begin(o->domain, &o->step, o->report));
    must(o, ops->trial(o->domain, &o->step, o->report));
    ab_dofs d;
    ops->dofs(o->domain, &d);
    if (push) push(o, &d);
    must(o, ops->finish(o->domain, &o->step, o->report));
    ops->dofs(o->domain, &d);
    assert_true(d.inverse_mass[0] == 0 && d.inverse_mass[1] == 0 && d.inverse_inertia == 0);
    o->step.number++;
    o->step.time = o->step.number * o->step.dt;
}

static double balance(const one *o) {
    ab_energy e;
    ab_motion m;
    o->domain->ops->ledger(o->domain, &e, &m);
    return e.kinetic + e.potential + e.damping + e.boundary + e.contact - e.external;
}

/* ---- shapes --------------------------------------------------------------------------------------------------------------- */

static const struct shape {
    const char *text;
    double area, centre[2], polar, round; /* round: of a circle, what its faces may leave it by, of the area */
} SHAPES[] = {
    {"box: [[1, 2], [4, 3]]", 3, {2.5, 2.5}, 3.0 / 12 * 10, 0},
    {"disc: {center: [-2, 1], radius: 0.7}", 1.5393804002589986, {-2, 1}, 0.37714819806345467, 2e-8},
    {"ring: {center: [5, 5], radius: 2, inner: 1.5}", 5.497787143782138, {5, 5}, 17.180584824319183, 4e-8},
    {"polygon: [[0, 0], [2, 0], [2, 1], [1, 1], [1, 3], [0, 3]]", 4, {0.75, 1.25}, 25.0 / 6, 0}, /* an L */
    {"polygon: [[0, 0], [-1, 1.7320508075688772], [-1.8660254037844386, 1.2320508075688772], [-0.8660254037844386, -0.5]]",
     2,
     {-0.9330127018922193, 0.6160254037844386},
     2.0 / 12 * 5,
     0}, /* 2 x 1, turned by 120 degrees */
    {"polygon: [[0, 0], [10, 1], [0, 2]]",
     10,
     {10.0 / 3, 1},
     10.0 / 36 * (101 + 101 + 4),
     0}, /* a wedge: A/36 times the sum of the squared sides */
};
enum { SHAPE_COUNT = sizeof SHAPES / sizeof *SHAPES };

static void test_area_centre_and_inertia(void **state) {
    (void)state;
    for (int k = 0; k < SHAPE_COUNT; k++) {
        char text[500];
        snprintf(text, sizeof text, "material: m, shape: {%s}", SHAPES[k].text);
        one o = create(text, "");
        const rigid_outline *outline = &o.body->outline;
        const double polar = SHAPES[k].polar;
        assert_true(fabs(outline->area - SHAPES[k].area) < 1e-13 * SHAPES[k].area);
        assert_true(fabs(outline->polar - polar) < 1e-12 * polar);
        for (int c = 0; c < 2; c++) assert_true(fabs(outline->centre[c] - SHAPES[k].centre[c]) < 1e-12);
        assert_true(fabs(o.body->mass - 2 * SHAPES[k].area) < 1e-12 * o.body->mass);
        assert_true(fabs(o.body->inertia - 2 * polar) < 1e-12 * o.body->inertia);
        double area = 0, length = 0, points = 0;
        for (size_t f = 0; f < outline->face_count; f++) { /* closed, the body on the left */
            const uint32_t *v = outline->face + 3 * f, before = outline->beside[2 * f], after = outline->beside[2 * f + 1];
            assert_int_equal(outline->face[3 * before + 1], v[0]);
            assert_int_equal(outline->face[3 * after], v[1]);
            const double *a = outline->vertex[v[0]], *b = outline->vertex[v[1]];
            area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
            if (v[2] != FEM_NONE) {
                const double *m = outline->vertex[v[2]];
                area += 2.0 / 3.0 * ((m[0] - a[0]) * (b[1] - a[1]) - (m[1] - a[1]) * (b[0] - a[0]));
                length += hypot(m[0] - a[0], m[1] - a[1]) + hypot(b[0] - m[0], b[1] - m[1]);
            } else {
                length += hypot(b[0] - a[0], b[1] - a[1]);
            }
        }
        for (size_t p = 0; p < outline->point_count; p++) points += outline->point_area[p];
        assert_true(fabs(area - SHAPES[k].area) < (1e-12 + SHAPES[k].round) * SHAPES[k].area);
        assert_true(fabs(points - length) < (1e-12 + 1e3 * 1e-7 * (SHAPES[k].round > 0)) * length);
        clear(&o);
    }
}

/* The whole body where it is thin against the layer: area, centre and second moment of its points; and each face is reached, not passed. */
static void test_layer_is_the_body(void **state) {
    (void)state;
    for (int k = 0; k < SHAPE_COUNT; k++)
        for (int size = 0; size < 3; size++) {
            char text[500];
            snprintf(text, sizeof text, "material: m, shape: {%s}", SHAPES[k].text);
            one o = create(text, "");
            const rigid_outline *outline = &o.body->outline;
            const double spacing = (double[]){0.31, 0.11, 0.043}[size];
            rigid_layer layer;
            assert_true(rigid_layer_create(outline, spacing, 10, &layer));
            double area = 0, first[2] = {0};
            for (size_t q = 0; q < layer.count; q++) {
                area += layer.volume[q];
                for (int c = 0; c < 2; c++) first[c] += layer.volume[q] * layer.place[q][c];
                assert_true(layer.extent[q][0] >= 0 && layer.extent[q][1] >= 0);
                assert_true(layer.extent[q][0] * layer.extent[q][1] >= layer.extent[q][2] * layer.extent[q][2] * (1 - 1e-9));
            }
            assert_true(fabs(area - SHAPES[k].area) < 1e-9 * SHAPES[k].area);
            for (int c = 0; c < 2; c++) assert_true(fabs(first[c]) < 1e-9 * SHAPES[k].area * 10);
            for (size_t f = 0; f < outline->face_count; f++) { /* how far material reaches along the normal beside places of the face */
                const double *a = outline->vertex[outline->face[3 * f]], *b = outline->vertex[outline->face[3 * f + 1]];
                const double whole = hypot(b[0] - a[0], b[1] - a[1]);
                double t[2] = {(b[0] - a[0]) / whole, (b[1] - a[1]) / whole}, n[2] = {t[1], -t[0]};
                if (outline->face[3 * f + 2] == FEM_NONE && whole < 4 * spacing) continue;
                for (int at = 3; at < 10; at += 3) {
                    double reach = -INFINITY, x[2];
                    for (int c = 0; c < 2; c++) x[c] = a[c] + 0.1 * at * (b[c] - a[c]) - outline->centre[c];
                    if (outline->radius > 0) { /* from the chord to the circle */
                        const double far = hypot(x[0], x[1]), side = n[0] * x[0] + n[1] * x[1] > 0 ? 1 : -1;
                        for (int c = 0; c < 2; c++) n[c] = side * x[c] / far, x[c] *= (side > 0 ? outline->radius : outline->inner) / far;
                        t[0] = -n[1], t[1] = n[0];
                    }
                    for (size_t q = 0; q < layer.count; q++) {
                        const double *e = layer.extent[q], dx = layer.place[q][0] - x[0], dy = layer.place[q][1] - x[1];
                        if (fabs(dx * t[0] + dy * t[1]) > spacing || fabs(dx * n[0] + dy * n[1]) > 2 * spacing) continue;
                        const double half = sqrt(n[0] * n[0] * e[0] + n[1] * n[1] * e[1] + 2 * n[0] * n[1] * e[2]);
                        reach = fmax(reach, dx * n[0] + dy * n[1] + half);
                    }
                    const bool hole = outline->inner > 0 && f >= outline->face_count / 2; /* whose sides come forward */
                    const double slack = hole                  ? 0.7 * spacing * spacing / outline->inner
                                         : outline->radius > 0 ? 2e-3 * spacing * spacing / outline->radius + 1e-7 * outline->radius
                                         : k == 5              ? 2e-3 * spacing /* cells of the tip have both faces, almost parallel */
                                                               : 1e-9;
                    if (!(fabs(reach) < slack)) print_error("shape %d size %d face %zu: %g\n", k, size, f, reach);
                    assert_true(fabs(reach) < slack);
                }
            }
            rigid_layer_clear(&layer);
            assert_true(rigid_layer_create(outline, 0.043, 0.1, &layer)); /* a thin layer: fewer points, none deep inside */
            for (size_t q = 0; q < layer.count; q++) {
                double nearest = INFINITY;
                for (size_t v = 0; v < outline->face_count; v++) {
                    const double *a = outline->vertex[outline->face[3 * v]], *b = outline->vertex[outline->face[3 * v + 1]];
                    const double d[2] = {b[0] - a[0], b[1] - a[1]},
                                 y[2] = {layer.place[q][0] + outline->centre[0] - a[0], layer.place[q][1] + outline->centre[1] - a[1]};
                    const double s = fmin(fmax((y[0] * d[0] + y[1] * d[1]) / (d[0] * d[0] + d[1] * d[1]), 0), 1);
                    nearest = fmin(nearest, hypot(y[0] - s * d[0], y[1] - s * d[1]));
                }
                assert_true(nearest < 0.3);
            }
            rigid_layer_clear(&layer);
            clear(&o);
        }
}

/* A disc that is drawn as a mesh is that disc, also for the grid. */
static void test_mesh_of_a_disc(void **state) {
    (void)state;
    one o = create("material: m, mesh: {patch: {bottom: {arc: {from: [-1, -1], to: [1, -1], center: [0, 0]}}, right: {arc: {from: [1, -1], "
                   "to: [1, 1], center: "
                   "[0, 0]}}, top: {arc: {from: [-1, 1], to: [1, 1], center: [0, 0]}}, left: {arc: {from: [-1, -1], to: [-1, 1], center: "
                   "[0, 0]}}}, elements: [16, "
                   "16], type: q8}",
                   "");
    const rigid_outline *outline = &o.body->outline;
    assert_int_equal(outline->face_count, 64);
    assert_true(fabs(outline->area - 2 * PI) < 1e-6 * 2 * PI && fabs(outline->polar - 2 * PI) < 2e-6 * 2 * PI);
    assert_true(fabs(outline->centre[0]) < 1e-12 && fabs(outline->centre[1]) < 1e-12);
    for (int size = 0; size < 3; size++) {
        const double spacing = (double[]){0.2, 0.07, 0.031}[size];
        rigid_layer layer;
        assert_true(rigid_layer_create(outline, spacing, 10, &layer));
        double area = 0, worst = 0;
        for (size_t q = 0; q < layer.count; q++) area += layer.volume[q];
        assert_true(fabs(area - outline->area) < 0.07 * spacing); /* chords instead of parabolas */
        for (int k = 0; k < 200; k++) {
            const double n[2] = {cos(0.1 * k), sin(0.1 * k)};
            double reach = -INFINITY;
            for (size_t q = 0; q < layer.count; q++) {
                const double *e = layer.extent[q], *x = layer.place[q];
                reach = fmax(reach, x[0] * n[0] + x[1] * n[1] + sqrt(n[0] * n[0] * e[0] + n[1] * n[1] * e[1] + 2 * n[0] * n[1] * e[2]));
            }
            worst = fmax(worst, fabs(reach - sqrt(2)));
        }
        if (!(worst < 1e-2 * spacing * spacing + 1e-6)) print_error("size %d: %g\n", size, worst);
        assert_true(worst < 1e-2 * spacing * spacing + 1e-6);
        rigid_layer_clear(&layer);
    }
    ab_cells cells;
    o.domain->ops->cells(o.domain, &cells);
    assert_true(cells.count == 256 && cells.nodes == 8);
    clear(&o);
}

/* ---- motion --------------------------------------------------------------------------------------------------------------- */

static void test_free_flight(void **state) {
    (void)state;
    one o = create("material: m, shape: {polygon: [[0, 0], [3, 0], [0, 1]]}, velocity: ['2 - 5*(y - 1/3)', '3 + 5*(x - 1)']",
                   "gravity: [0, -9.81]\n");
    const double momentum = o.body->motion.angular_momentum[2];
    const double start = balance(&o);
    assert_true(fabs(o.body->spin - 5) < 1e-12 && fabs(momentum - (o.body->inertia * 5 + 3 * (1 * 3 - 2.0 / 3))) < 1e-11);
    for (int k = 0; k < 1000; k++) step(&o, NULL);
    /* symplectic Euler: v = v0 + g t exactly, x = v t + g t (t + dt)/2 */
    assert_true(fabs(o.body->motion.centre[0] - 3) < 1e-12);
    assert_true(fabs(o.body->motion.centre[1] - (1.0 / 3 + 3 - 9.81 * 0.5 * 1.001)) < 1e-11);
    assert_true(fabs(o.body->angle - 5) < 1e-12 && fabs(balance(&o) - start) < 1e-12);
    double place[6], velocity[6];
    must(&o, o.domain->ops->read(o.domain, "position", place, o.report));
    must(&o, o.domain->ops->read(o.domain, "velocity", velocity, o.report));
    assert_true(fabs(hypot(place[2] - place[0], place[3] - place[1]) - 3) < 1e-14 * 10); /* as drawn, not merely close to it */
    assert_true(fabs(velocity[2] - velocity[0] + 5 * (place[3] - place[1])) < 1e-12);
    clear(&o);
}

static void test_motion_as_given(void **state) {
    (void)state;
    one o = create("shape: {box: [[0, 0], [2, 1]]}, motion: {velocity: ['3*t^2', 0.5], spin: 2, center: [0, 0]}", "");
    for (int k = 0; k < 1000; k++) step(&o, NULL);
    double place[8];
    must(&o, o.domain->ops->read(o.domain, "position", place, o.report));
    assert_true(fabs(place[0] - 1) < 1e-6 && fabs(place[1] - 0.5) < 1e-12); /* mid-step velocities: second order */
    assert_true(fabs(place[2] - place[0] - 2 * cos(2.0)) < 1e-12 && fabs(place[3] - place[1] - 2 * sin(2.0)) < 1e-12);
    clear(&o);
    /* one direction held at a place beside the centre of mass, the spin given, the other direction free */
    o = create("material: m, shape: {box: [[0, 0], [2, 1]]}, motion: {velocity: [1, null], spin: 2, center: [0, 0]}",
               "gravity: [0, -10]\n");
    const double start = balance(&o);
    for (int k = 0; k < 1000; k++) step(&o, NULL);
    must(&o, o.domain->ops->read(o.domain, "position", place, o.report));
    assert_true(fabs(place[0] - 1) < 1e-12);
    assert_true(fabs(o.body->motion.centre[1] - (0.5 - 5.005)) < 1e-11);
    assert_true(fabs(balance(&o) - start) < 1e-11);
    clear(&o);
}

/* A bar hung up at its end: period of a small swing, energy, and the force of the hinge. */
static void test_pendulum(void **state) {
    (void)state;
    one o = create(
        "material: m, shape: {box: [[-0.05, -2], [0.05, 0]]}, motion: {velocity: [0, 0], center: [0, 0]}, velocity: ['-0.01*y', '0.01*x']",
        "gravity: [0, -10]\n");
    const double m = 0.4, inertia = m * (4 + 0.01) / 12 + m, period = 2 * PI * sqrt(inertia / (m * 10));
    double last = 1, time = 0, sum = 0;
    int crossings = 0, steps = 0;
    while (crossings < 10) {
        step(&o, NULL);
        double force[3];
        o.domain->ops->reaction(o.domain, force);
        sum += force[1], steps++;
        if (last < 0 && o.body->angle >= 0) crossings++, time = o.step.time - 0.001 * o.body->angle / (o.body->angle - last);
        last = o.body->angle;
    }
    assert_true(fabs(time / 10 - period) < 2e-5 * period); /* amplitude 0.0025: 4e-7; dt: (w dt)^2/24 */
    assert_true(fabs(sum / steps - m * 10) < 1e-4);
    double place[8];
    must(&o, o.domain->ops->read(o.domain, "position", place, o.report));
    const double middle[2] = {0.5 * (place[4] + place[6]), 0.5 * (place[5] + place[7])};
    assert_true(hypot(middle[0], middle[1]) < 1e-13); /* the hinge */
    clear(&o);
}

static double random_number(void) {
    static uint64_t state = 7;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 11) * 0x1p-52 - 1.0;
}

static double contact_loss, impulse_sum[3];

/* Random impulses at random places, as a contact loop gives them; what they do is known once the step is done. */
static struct { double place[2], impulse[2]; } pushes[3];
static void push(one *o, const ab_dofs *d) {
    (void)o;
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < 2; c++) pushes[k].place[c] = d->centre[c] + random_number(), pushes[k].impulse[c] = 0.1 * random_number();
        const double arm[2] = {pushes[k].place[0] - d->centre[0], pushes[k].place[1] - d->centre[1]}, *j = pushes[k].impulse;
        const double moment = arm[0] * j[1] - arm[1] * j[0];
        for (int c = 0; c < 2; c++) d->velocity[c] += d->inverse_mass[c] * j[c], impulse_sum[c] += j[c];
        *d->spin += d->inverse_inertia * moment;
        impulse_sum[2] += pushes[k].place[0] * j[1] - pushes[k].place[1] * j[0];
        if (d->impulse) d->impulse[0] += j[0], d->impulse[1] += j[1], d->impulse[2] += moment;
    }
}

static void test_ledger_closes(void **state) {
    (void)state;
    static const char *const motions[] = {"",
                                          "motion: {velocity: ['0.4*sin(3*t)', null]}, ",
                                          "motion: {velocity: [null, 1], spin: 't'}, ",
                                          "motion: {velocity: ['t', 'cos(t)'], spin: '3*t^2'}, ",
                                          "motion: {velocity: ['t', 'cos(t)'], spin: '3*t^2', center: [0.2, -1]}, ",
                                          "motion: {velocity: ['t', 'cos(t)'], center: [0.2, -1]}, ",
                                          "motion: {velocity: ['t', null], spin: -4, center: [0.2, -1], mass: 3, inertia: 0.2}, ",
                                          "motion: {spin: 0}, gravity: false, "};
    for (int k = 0; k < 8; k++)
        for (int damping = 0; damping < 2; damping++) {
            char text[500];
            snprintf(text, sizeof text, "material: m, %svelocity: ['1 - 2*y', '2*x'], shape: {polygon: [[0, 0], [2, 0], [0.3, 1.1]]}",
                     motions[k]);
            one o = create(text, "gravity: ['cos(t)', -9.81]\nloads: [{body: b, at: [2, 0], force: ['sin(40*t)', 2]}, {body: b, at: [0, "
                                 "0], force: [0, -1]}]\n");
            o.step.damping = 0.2 * damping;
            contact_loss = 0;
            memset(impulse_sum, 0, sizeof impulse_sum);
            const double start = balance(&o);
            const ab_motion first = o.body->motion;
            double reactions[3] = {0};
            double largest = 0;
            for (int n = 0; n < 500; n++) {
                double before[3][2];
                const double old[2] = {o.body->velocity[0], o.body->velocity[1]}, spin = o.body->spin;
                step(&o, push);
                ab_dofs d;
                o.domain->ops->dofs(o.domain, &d);
                for (int p = 0; p < 3; p++) {
                    const double arm[2] = {pushes[p].place[0] - d.centre[0], pushes[p].place[1] - d.centre[1]}, w = 0.5 * (spin + *d.spin);
                    before[p][0] = 0.5 * (old[0] + d.velocity[0]) - w * arm[1];
                    before[p][1] = 0.5 * (old[1] + d.velocity[1]) + w * arm[0];
                    contact_loss -= pushes[p].impulse[0] * before[p][0] + pushes[p].impulse[1] * before[p][1];
                }
                largest = fmax(largest, fabs(balance(&o) + contact_loss - start));
                double force[3] = {0};
                if (o.domain->ops->reaction) o.domain->ops->reaction(o.domain, force);
                for (int c = 0; c < 3; c++) reactions[c] += o.step.dt * force[c];
            }
            if (!(largest < 1e-10)) print_error("motion %d, damping %d: %g\n", k, damping, largest);
            assert_true(largest < 1e-10);
            if (!damping && k == 3) { /* momentum: loads, gravity, contact and the reaction */
                const double t = 0.5, weight = o.body->mass;
                const double expected = first.momentum[1] + impulse_sum[1] + reactions[1] + t * (1 - 9.81 * weight);
                assert_true(fabs(o.body->motion.momentum[1] - expected) < 1e-9);
            }
            clear(&o);
        }
}

/* With contact alone a free body keeps momentum and angular momentum to rounding. */
static void test_momenta_of_a_free_body(void **state) {
    (void)state;
    one o = create("material: m, velocity: ['1 - 2*y', '2*x'], shape: {polygon: [[0, 0], [2, 0], [0.3, 1.1]]}", "");
    memset(impulse_sum, 0, sizeof impulse_sum);
    const ab_motion first = o.body->motion;
    for (int n = 0; n < 500; n++) step(&o, push);
    for (int c = 0; c < 2; c++) assert_true(fabs(o.body->motion.momentum[c] - first.momentum[c] - impulse_sum[c]) < 1e-12);
    assert_true(fabs(o.body->motion.angular_momentum[2] - first.angular_momentum[2] - impulse_sum[2]) < 1e-11);
    clear(&o);
}

/* ---- what is refused ------------------------------------------------------------------------------------------------------ */

static void refused(const char *body, const char *more, const char *why) {
    one o = {0};
    assert_int_equal(read_scene(&o, body, more), AB_BAD_INPUT);
    bool found = false;
    for (size_t i = 0; ab_report_text(o.report, i); i++) found = found || strstr(ab_report_text(o.report, i), why);
    if (!found) say_all(&o);
    assert_true(found);
    clear(&o);
}

static void test_what_cannot_be_is_refused(void **state) {
    (void)state;
    refused("material: m, shape: {box: [[0, 0], [1, 1]]}, velocity: ['x', 0]", "", "not that of a rigid body");
    refused("material: m, shape: {box: [[0, 0], [1, 1]]}, velocity: ['y', 0]", "", "not that of a rigid body");
    refused("material: m, shape: {box: [[0, 0], [1, 1]]}, motion: {velocity: [1, null], center: [0, 0]}", "", "a hinge");
    refused("material: m, shape: {box: [[0, 0], [1, 1]]}, motion: {spin: 1, center: [0, 0]}", "", "motion.center");
    refused("material: m, shape: {union: [{box: [[0, 0], [1, 1]]}, {box: [[1, 0], [2, 1]]}]}", "", "union");
    refused("shape: {box: [[0, 0], [1, 1]]}, motion: {velocity: [1, null], spin: 0}", "", "mass");
}

/* A formula without a value: named at the start, at its line, and in the step where it loses it. */
static void test_formulas_without_a_value_are_named(void **state) {
    (void)state;
    static const char body[] = "material: m, shape: {box: [[0, 0], [1, 1]]}";
    static const struct {
        const char *body, *more, *start, *later;
    } wrong[] = {
        {", motion: {velocity: [0, 0], spin: 1/t}", "", ":5:107: error: bodies.b.motion.spin is inf at t = 0 s, which is no finite number", NULL},
        {", motion: {velocity: [0, log(t)]}", "", "error: bodies.b.motion.velocity[1] is -inf at t = 0 s", NULL},
        {", motion: {velocity: [sqrt(0.0012-t), 0]}", "", NULL, "bodies.b.motion.velocity[0] is "},
        {", motion: {spin: sqrt(0.0012-t)}", "", NULL, "bodies.b.motion.spin is "},
        {"", "loads: [{body: b, at: [0, 0], force: [0, sqrt(0.0012-t)]}]\n", NULL, "loads[0].force[1] is "},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char text[400];
        snprintf(text, sizeof text, "%s%s", body, wrong[k].body);
        if (wrong[k].start) {
            refused(text, wrong[k].more, wrong[k].start);
            continue;
        }
        one o = create(text, wrong[k].more);
        step(&o, NULL);
        ab_status status = o.domain->ops->begin(o.domain, &o.step, o.report);
        if (status == AB_OK) status = o.domain->ops->trial(o.domain, &o.step, o.report);
        assert_int_equal(status, AB_FAILED);
        const char *said = ab_report_text(o.report, 0);
        if (!strstr(said, wrong[k].later) || !strstr(said, " is nan at t = 0.0015 s")) say_all(&o);
        assert_non_null(strstr(said, wrong[k].later));
        assert_non_null(strstr(said, " is nan at t = 0.0015 s"));
        clear(&o);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_area_centre_and_inertia),
        cmocka_unit_test(test_layer_is_the_body),
        cmocka_unit_test(test_mesh_of_a_disc),
        cmocka_unit_test(test_free_flight),
        cmocka_unit_test(test_motion_as_given),
        cmocka_unit_test(test_pendulum),
        cmocka_unit_test(test_ledger_closes),
        cmocka_unit_test(test_momenta_of_a_free_body),
        cmocka_unit_test(test_what_cannot_be_is_refused),
        cmocka_unit_test(test_formulas_without_a_value_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
