/* fake_domain.h: a body with numbers that are known, for the tests of what a run leaves. Point p (id p) starts at (p, 2p) and moves with velocity
 * (1, 0.5); stress (10, 20, 30, 4) times (p + 1); mass p + 1; volume 2. Points with id < `lost` have left. fake_mesh makes nodes of
 * them, in other places: eight go round one quadratic element of 2 x 2, any other number is a strip of square elements, two nodes at each x. It turns
 * by 0.25 rad a second, and something holds it with (2, -3) N and 5 N m times t. */
#ifndef FAKE_DOMAIN_H
#define FAKE_DOMAIN_H

#include <stdlib.h>
#include <string.h>

#include "core/results.h"

typedef struct fake_domain {
    ab_domain base;
    size_t start, lost;
    double time;
    long reads; /* of a field */
} fake_domain;

static inline size_t fake_count(const ab_domain *domain) {
    const fake_domain *fake = (const fake_domain *)domain;
    return fake->start - fake->lost;
}

static inline bool fake_is_mesh(const ab_domain *domain) { return domain->ops->cells != NULL; }

static inline const ab_field *fake_fields(const ab_domain *domain, size_t *count) {
    static const ab_field fields[] = {{"position", "m", 2, "x y"}, {"velocity", "m s-1", 2, "x y"},  {"stress", "Pa", 4, "xx yy zz xy"},
                                      {"mass", "kg", 1, NULL},     {"volume", "m2", 1, NULL},        {"back_stress", "Pa", 4, ""},
                                      {"rotation", "1", 1, NULL},  {"rotation-rate", "s-1", 1, NULL}};
    *count = sizeof fields / sizeof *fields - (fake_is_mesh(domain) ? 0 : 2);
    return fields;
}

/* Where point or node `id` stands at time 0. */
static inline void fake_place(const ab_domain *domain, size_t id, double place[2]) {
    static const double round[8][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
    const bool mesh = fake_is_mesh(domain), eight = mesh && ((const fake_domain *)domain)->start == 8;
    place[0] = eight ? round[id][0] : mesh ? (double)(id / 2) : (double)id;
    place[1] = eight ? round[id][1] : mesh ? (double)(id % 2) : 2 * (double)id;
}

static inline ab_status fake_read(const ab_domain *domain, const char *field, double *values, ab_report *report) {
    fake_domain *fake = (fake_domain *)(uintptr_t)domain;
    const size_t count = fake_count(domain);
    fake->reads++;
    for (size_t k = 0; k < count; k++) {
        const double id = (double)(k + fake->lost), t = fake->time;
        if (strcmp(field, "id") == 0)
            values[k] = id;
        else if (strcmp(field, "mass") == 0)
            values[k] = id + 1;
        else if (strcmp(field, "volume") == 0)
            values[k] = 2;
        else if (strcmp(field, "rotation") == 0)
            values[k] = 0.25 * t;
        else if (strcmp(field, "rotation-rate") == 0)
            values[k] = 0.25;
        else if (strcmp(field, "position") == 0) {
            fake_place(domain, k + fake->lost, values + 2 * k);
            values[2 * k] += t, values[2 * k + 1] += 0.5 * t;
        } else if (strcmp(field, "velocity") == 0)
            values[2 * k] = 1, values[2 * k + 1] = 0.5;
        else if (strcmp(field, "stress") == 0 || strcmp(field, "back_stress") == 0)
            for (int c = 0; c < 4; c++) values[4 * k + (size_t)c] = (double[]){10, 20, 30, 4}[c] * (id + 1);
        else
            return ab_report_failure(report, "no field '%s'", field);
    }
    return AB_OK;
}

enum { FAKE_ELEMENTS = 8 };

static inline void fake_cells(const ab_domain *domain, ab_cells *cells) {
    static const uint32_t eight[8] = {0, 2, 4, 6, 1, 3, 5, 7};
    static uint32_t four[FAKE_ELEMENTS][4];
    const size_t count = fake_count(domain);
    for (uint32_t e = 0; e < FAKE_ELEMENTS; e++)
        for (uint32_t a = 0; a < 4; a++) four[e][a] = 2 * e + (uint32_t[]){0, 2, 3, 1}[a];
    if (count == 8)
        *cells = (ab_cells){1, 8, eight};
    else
        *cells = (ab_cells){count / 2 - 1, 4, four[0]};
}

static inline void fake_reaction(const ab_domain *domain, double force[3]) {
    const double t = ((const fake_domain *)domain)->time;
    force[0] = 2 * t, force[1] = -3 * t, force[2] = 5 * t;
}

static const ab_domain_ops fake_ops = {.method = "fake", .count = fake_count, .fields = fake_fields, .read = fake_read};

static const ab_domain_ops fake_mesh_ops = {
    .method = "fake mesh", .cells = fake_cells, .reaction = fake_reaction, .count = fake_count, .fields = fake_fields, .read = fake_read};

/* A scene of two such bodies, and the view that a scheduler would keep of it. */
typedef struct fake_run {
    ab_scene scene;
    ab_body_spec bodies[2];
    ab_contact_spec contact;
    fake_domain domains[2];
    ab_domain *domain[2];
    ab_contact_totals contacts[1];
    ab_energy energy[2], energy_start[2];
    ab_motion motion[2];
    ab_state_view view;
} fake_run;

static inline void fake_update(fake_run *run, long step, double dt) {
    run->view.step = step;
    run->view.dt = dt;
    run->view.time = (double)step * dt;
    run->view.total = (ab_energy){0};
    for (int b = 0; b < 2; b++) {
        fake_domain *fake = &run->domains[b];
        fake->time = run->view.time;
        const double n = (double)fake->start, mass = n * (n + 1) / 2;
        double moment[2] = {0, 0};
        for (size_t id = 0; id < fake->start; id++) {
            double place[2];
            fake_place(&fake->base, id, place);
            moment[0] += (double)(id + 1) * (place[0] + fake->time), moment[1] += (double)(id + 1) * (place[1] + 0.5 * fake->time);
        }
        run->motion[b] = (ab_motion){.mass = mass,
                                     .momentum = {mass, 0.5 * mass, 0},
                                     .angular_momentum = {0, 0, moment[0] * 0.5 - moment[1]},
                                     .centre = {moment[0] / mass, moment[1] / mass, 0}};
        run->energy[b] = (ab_energy){.kinetic = 5 - run->view.time, .strain = run->view.time, .friction = 0.25};
        run->view.total.kinetic += run->energy[b].kinetic;
        run->view.total.strain += run->energy[b].strain;
        run->view.total.friction += run->energy[b].friction;
    }
    run->contacts[0] = (ab_contact_totals){.force = {3 * run->view.time, 7 * run->view.time, 0},
                                           .moment = 40 * run->view.time,
                                           .normal_force = 7 * run->view.time,
                                           .points = 3,
                                           .active = 2,
                                           .peak_pressure = 50 * run->view.time,
                                           .area = 0.75};
}

static inline fake_run *fake_create(size_t first, size_t second) {
    fake_run *run = calloc(1, sizeof *run);
    if (run == NULL) abort();
    static char block[] = "block", plane[] = "plane", title[] = "Two <bodies> & \"more\"", path[] = "scene.yaml";
    run->bodies[0].name = block;
    run->bodies[1].name = plane;
    run->contact.body[1] = 1;
    run->scene = (ab_scene){.title = title,
                            .path = path,
                            .dimension = 2,
                            .bodies = run->bodies,
                            .body_count = 2,
                            .contacts = &run->contact,
                            .contact_count = 1,
                            .history_every = 1,
                            .time_end = 1};
    for (size_t b = 0; b < 2; b++) {
        run->domains[b] = (fake_domain){.base = {&fake_ops, &run->bodies[b], 2, b}, .start = b == 0 ? first : second};
        run->domain[b] = &run->domains[b].base;
    }
    run->view = (ab_state_view){.scene = &run->scene,
                                .domains = run->domain,
                                .contacts = run->contacts,
                                .energy = run->energy,
                                .motion = run->motion,
                                .energy_start = run->energy_start,
                                .limit = "wave speed"};
    fake_update(run, 0, 0.1);
    memcpy(run->energy_start, run->energy, sizeof run->energy);
    return run;
}

/* Before anybody has looked at the run. */
static inline void fake_mesh(fake_run *run, int body) {
    run->domains[body].base.ops = &fake_mesh_ops;
    fake_update(run, 0, 0.1);
}

#endif
