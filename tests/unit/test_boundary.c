/* test_boundary.c: what the host of boundary plugins makes of their answers, on a body of three nodes and a plugin that are both made up. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "core/boundary.h"

static void assert_near(double found, double wanted, double apart) {
    if (!(fabs(found - wanted) <= apart)) print_error("%.17g where %.17g is wanted, within %g\n", found, wanted, apart);
    assert_true(fabs(found - wanted) <= apart);
}

/* ---- a body: three nodes, two edges that share the middle one ------------------------------------------------------------------ */

typedef struct three {
    ab_domain domain; /* first */
    double velocity[6], old[6], inverse[6];
    double position[16], normal[16], area[8], density[8], p_speed[8], s_speed[8], weight[4];
    size_t start[3];
    uint32_t dof[4];
} three;

static ab_status edges(ab_domain *domain, size_t number, const ab_step *step, ab_edge_list *list, ab_report *report) {
    (void)number, (void)step, (void)report;
    three *b = (three *)domain;
    *list = (ab_edge_list){.count = 2, .ld = 8, .position = b->position, .normal = b->normal, .area = b->area, .density = b->density, .p_wave_speed = b->p_speed, .s_wave_speed = b->s_speed, .start = b->start, .dof = b->dof, .weight = b->weight};
    return AB_OK;
}
static void dofs(const ab_domain *domain, ab_dofs *d) {
    three *b = (three *)(uintptr_t)domain;
    *d = (ab_dofs){.velocity = b->velocity, .velocity_old = b->old, .inverse_mass = b->inverse, .velocity_stride = 2, .old_stride = 2, .mass_stride = 2};
}
static const ab_domain_ops BODY = {.method = "made up", .edges = edges, .dofs = dofs};
static const ab_domain_ops BARE = {.method = "bare", .dofs = dofs};

static void make_body(three *b, const ab_body_spec *spec) {
    static const double MASS[3] = {2.0, 1e-3, 3.0}; /* the middle one is light, and has as little weight as a basis gives such a node: w^2/m is that of the others */
    *b = (three){.domain = {.ops = &BODY, .spec = spec, .dimension = 2}, .start = {0, 2, 4}, .dof = {0, 1, 1, 2}, .weight = {0.98, 0.02, 0.02, 0.98}};
    for (size_t k = 0; k < 6; ++k) b->inverse[k] = 1.0 / MASS[k / 2];
    for (size_t e = 0; e < 8; ++e) b->normal[8 + e] = -1.0, b->area[e] = 0.5, b->density[e] = 2000.0, b->p_speed[e] = 200.0, b->s_speed[e] = 100.0;
}

/* ---- a plugin ------------------------------------------------------------------------------------------------------------------ */

static struct {
    double traction[2], damping[2], stiffness[2], prescribed[2];
    double seen_velocity, seen_displacement, seen_time;
    int code, flagged, calls;
} answer;

static int apply(void *self, ab_edges *e) {
    (void)self;
    ++answer.calls;
    answer.seen_velocity = e->velocity[e->ld];
    answer.seen_displacement = e->displacement[e->ld];
    answer.seen_time = e->time;
    for (size_t i = 0; i < e->count; ++i) {
        for (size_t c = 0; c < 2; ++c) {
            const size_t k = c * e->ld + i;
            e->traction[k] = answer.traction[c];
            if (e->damping) { /* the normal is along y */
                e->damping[k] = answer.damping[c];
                e->traction[k] -= answer.damping[1 - c] * e->velocity[k];
            }
            if (e->stiffness) {
                e->stiffness[k] = answer.stiffness[c];
                e->traction[k] -= answer.stiffness[1 - c] * e->displacement[k];
            }
            if (e->prescribed) e->prescribed[k] = answer.prescribed[c];
        }
        e->flag[i] = answer.flagged == (int)i + 1;
    }
    return answer.code;
}

typedef struct bench {
    ab_loaded_class loaded;
    ab_body_spec body_spec;
    ab_boundary_spec spec;
    ab_scene scene;
    three body;
    ab_domain *domain;
    ab_boundaries *boundaries;
    ab_report *report;
    ab_step step;
} bench;

static void open_bench(bench *b, uint32_t gives) {
    memset(b, 0, sizeof *b);
    memset(&answer, 0, sizeof answer);
    b->body_spec.name = (char *)(uintptr_t) "body";
    b->loaded = (ab_loaded_class){.class_ = {.kind = AB_BOUNDARY, .gives = gives, .name = "made-up"}, .boundary = {sizeof(ab_boundary_ops), apply}};
    b->spec = (ab_boundary_spec){.loaded = &b->loaded};
    b->scene = (ab_scene){.dimension = 2, .bodies = &b->body_spec, .body_count = 1, .boundaries = &b->spec, .boundary_count = 1};
    make_body(&b->body, &b->body_spec);
    b->domain = &b->body.domain;
    b->report = ab_report_create();
    b->step = (ab_step){.dt = 1e-3};
    assert_int_equal(ab_boundaries_create(&b->scene, &b->domain, &b->boundaries, b->report), AB_OK);
}
static void close_bench(bench *b) {
    ab_boundaries_destroy(b->boundaries);
    ab_report_destroy(b->report);
}
static ab_status step(bench *b) {
    const ab_status status = ab_boundaries_apply(b->boundaries, &b->step, b->report);
    if (status != AB_OK) return status;
    ab_boundaries_settle(b->boundaries, &b->step);
    b->step.time += b->step.dt, ++b->step.number;
    return AB_OK;
}
static double kinetic(const three *b, const double *v) {
    double sum = 0.0;
    for (int k = 0; k < 6; ++k) sum += 0.5 * v[k] * v[k] / b->inverse[k];
    return sum;
}

/* ---- promises ------------------------------------------------------------------------------------------------------------------ */

static void test_a_traction_is_a_force_and_its_work_is_booked(void **state) {
    (void)state;
    bench b;
    open_bench(&b, AB_GIVE_TRACTION);
    answer.traction[0] = 3.0, answer.traction[1] = -5.0;
    for (int k = 0; k < 6; ++k) b.body.old[k] = b.body.velocity[k] = 0.1 * k;
    const double before = kinetic(&b.body, b.body.velocity);
    assert_int_equal(step(&b), AB_OK);
    const ab_boundary_totals *t = ab_boundaries_totals(b.boundaries);
    assert_near(t->force[0], 3.0, 1e-12); /* two edges of 0.5 m */
    assert_near(t->force[1], -5.0, 1e-12);
    assert_near(b.body.velocity[0] - b.body.old[0], 1e-3 * 0.5 * 0.98 * 3.0 / 2.0, 1e-15);
    assert_near(t->work, kinetic(&b.body, b.body.velocity) - before, 1e-12 * fabs(t->work));
    assert_near(ab_boundaries_taken(b.boundaries, 0), -t->work, 0.0);
    close_bench(&b);
}

static void test_damping_is_taken_at_the_mean_velocity_and_only_takes(void **state) {
    (void)state;
    static const double FACTORS[] = {1e-3, 1.0, 1e3, 1e5};
    for (size_t f = 0; f < 4; ++f) {
        bench b;
        open_bench(&b, AB_GIVE_TRACTION | AB_GIVE_DAMPING);
        answer.damping[0] = 4e3 * FACTORS[f], answer.damping[1] = 1e3 * FACTORS[f];
        for (int k = 0; k < 6; ++k) b.body.old[k] = b.body.velocity[k] = k % 2 ? -1.0 : 0.5 + k;
        const double before = kinetic(&b.body, b.body.velocity);
        double old[2][2], now[2][2];
        for (int e = 0; e < 2; ++e)
            for (int c = 0; c < 2; ++c) old[e][c] = 0.98 * b.body.old[4 * e + c] + 0.02 * b.body.old[2 + c];
        assert_int_equal(step(&b), AB_OK);
        const ab_boundary_totals *t = ab_boundaries_totals(b.boundaries);
        double force[2] = {0.0, 0.0};
        for (int e = 0; e < 2; ++e)
            for (int c = 0; c < 2; ++c) {
                now[e][c] = 0.98 * b.body.velocity[4 * e + c] + 0.02 * b.body.velocity[2 + c];
                force[c] -= 0.5 * answer.damping[1 - c] * 0.5 * (old[e][c] + now[e][c]);
            }
        for (int c = 0; c < 2; ++c) assert_near(t->force[c], force[c], 1e-6 * (fabs(force[c]) + answer.damping[0] * 1e-3));
        assert_true(t->dashpot >= 0.0 && t->work <= 0.0);
        assert_near(t->work, kinetic(&b.body, b.body.velocity) - before, 1e-9 * before);
        assert_true(kinetic(&b.body, b.body.velocity) <= before * (1.0 + 1e-9));
        close_bench(&b);
    }
}

static void test_what_is_prescribed_is_reached_and_the_rest_is_free(void **state) {
    (void)state;
    bench b;
    open_bench(&b, AB_GIVE_MOTION);
    answer.prescribed[0] = 0.7, answer.prescribed[1] = NAN;
    for (int k = 0; k < 6; ++k) b.body.old[k] = b.body.velocity[k] = 0.1 * k;
    assert_int_equal(step(&b), AB_OK);
    for (int e = 0; e < 2; ++e) assert_near(0.98 * b.body.velocity[4 * e] + 0.02 * b.body.velocity[2], 0.7, 1e-8);
    for (int k = 1; k < 6; k += 2) assert_near(b.body.velocity[k], 0.1 * k, 0.0);
    close_bench(&b);
}

static void test_displacements_are_those_since_it_began_and_springs_bound_the_step(void **state) {
    (void)state;
    bench b;
    open_bench(&b, AB_GIVE_TRACTION | AB_GIVE_STIFFNESS);
    for (int k = 0; k < 6; ++k) b.body.old[k] = b.body.velocity[k] = 2.0;
    for (int n = 0; n < 5; ++n) {
        assert_int_equal(step(&b), AB_OK);
        assert_near(answer.seen_displacement, n * 2e-3, 1e-15);
    }
    const char *limit = "body";
    assert_near(ab_boundaries_critical_dt(b.boundaries, 0, 1e-3, &limit), 1e-3, 0.0);
    answer.stiffness[0] = answer.stiffness[1] = 1e12;
    assert_int_equal(step(&b), AB_OK);
    const double with = ab_boundaries_critical_dt(b.boundaries, 0, 1e-3, &limit);
    assert_true(with > 0.0 && with < 1e-4);
    assert_string_not_equal(limit, "body");
    close_bench(&b);
}

static void test_it_acts_in_its_stages_alone(void **state) {
    (void)state;
    bench b;
    open_bench(&b, AB_GIVE_TRACTION);
    b.spec.absent = 1u;
    answer.traction[0] = 3.0;
    assert_int_equal(step(&b), AB_OK);
    assert_int_equal(answer.calls, 0);
    assert_near(b.body.velocity[0], 0.0, 0.0);
    b.step.stage = 1;
    assert_int_equal(step(&b), AB_OK);
    assert_int_equal(answer.calls, 1);
    assert_true(b.body.velocity[0] > 0.0);
    close_bench(&b);
}

static void test_a_plugin_that_fails_is_named_with_the_place(void **state) {
    (void)state;
    static const struct {
        uint32_t gives;
        double traction, damping;
        int code, flagged;
        const char *said;
    } wrong[] = {
        {AB_GIVE_TRACTION, 0.0, 0.0, -1, 0, "boundary 'made-up' on 'body' (boundaries[0]) gave up at t = 0 s"},
        {AB_GIVE_TRACTION, 0.0, 0.0, 1, 0, "asks for a smaller step"},
        {AB_GIVE_TRACTION, 0.0, 0.0, 0, 2, "gave up"},
        {AB_GIVE_TRACTION, NAN, 0.0, 0, 0, "a traction that is no finite number"},
        {AB_GIVE_TRACTION | AB_GIVE_DAMPING, 0.0, -1.0, 0, 0, "a damping that is negative"},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
        bench b;
        open_bench(&b, wrong[k].gives);
        answer.traction[0] = wrong[k].traction, answer.damping[0] = wrong[k].damping, answer.code = wrong[k].code, answer.flagged = wrong[k].flagged;
        assert_int_equal(step(&b), AB_FAILED);
        const char *said = ab_report_first_error(b.report);
        assert_non_null(said);
        if (!strstr(said, wrong[k].said)) print_error("said: %s\n", said);
        assert_non_null(strstr(said, wrong[k].said));
        close_bench(&b);
    }
}

static void test_a_body_without_edges_is_refused(void **state) {
    (void)state;
    bench b;
    open_bench(&b, AB_GIVE_TRACTION);
    b.body.domain.ops = &BARE;
    ab_boundaries *none = NULL;
    assert_int_equal(ab_boundaries_create(&b.scene, &b.domain, &none, b.report), AB_BAD_INPUT);
    assert_non_null(strstr(ab_report_first_error(b.report), "do not act on bodies of method bare"));
    close_bench(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_traction_is_a_force_and_its_work_is_booked),
        cmocka_unit_test(test_damping_is_taken_at_the_mean_velocity_and_only_takes),
        cmocka_unit_test(test_what_is_prescribed_is_reached_and_the_rest_is_free),
        cmocka_unit_test(test_displacements_are_those_since_it_began_and_springs_bound_the_step),
        cmocka_unit_test(test_it_acts_in_its_stages_alone),
        cmocka_unit_test(test_a_plugin_that_fails_is_named_with_the_place),
        cmocka_unit_test(test_a_body_without_edges_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
