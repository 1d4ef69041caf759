/* test_points.c: points are never lost, and sorting changes nothing. */
#include "one_body.h"

static const char *scene(const char *basis, const char *update, const char *more) {
    static char text[2000];
    snprintf(text, sizeof text,
             "abut: 1\nspace: plane-strain\ntime: {end: 1e4, dt: 0.002}\n"
             "grid: {from: [-5, -3], to: [15, 17], cell: 0.5, sides: {left: roller, bottom: fixed, right: roller, top: roller}}\n"
             "materials: {m: {model: linear-elastic, E: 1000, nu: 0.3, density: 1}}\n"
             "bodies: {b: {method: material-points, material: m, basis: %s, update: %s, %s}}\n",
             basis, update, more);
    return text;
}

/* ---- sorting -------------------------------------------------------------------------------------------------------------------- */

/* Every id once, every point in a cell of its tile, mass and padding right. */
static void check_points(const one_body *one, size_t born, double mass) {
    const mpm_body *body = one->mpm;
    char *seen = calloc(born, 1);
    size_t count = 0;
    double sum = 0;
    for (size_t k = 0; k < body->tile_count; k++) {
        const mpm_tile *tile = body->tiles + k;
        size_t here = 0;
        for (size_t slot = (size_t)tile->first * 8; slot < (size_t)(tile->first + tile->blocks) * 8; slot++) {
            sum += *point_row(body, slot, ROW_MASS);
            if (!is_point(body, slot)) {
                assert_true(*point_row(body, slot, ROW_MASS) == 0 && *point_row(body, slot, ROW_VOLUME) == 0);
                continue;
            }
            assert_true(body->ids[slot] < born && !seen[body->ids[slot]]);
            seen[body->ids[slot]] = 1;
            here++;
        }
        assert_int_equal(here, tile->points);
        count += here;
    }
    assert_int_equal(count, born);
    assert_int_equal(body->points, born);
    assert_true(fabs(sum - mass) <= 1e-12 * mass);
    free(seen);
}

static void test_no_point_is_lost(void **state) {
    (void)state;
    static const char *const basis[] = {"gimp", "linear", "bspline2", "bspline3", "cpdi"}, *const update[] = {"musl", "usf", "usavg"};
    for (int b = 0; b < 5; b++)
        for (int u = 0; u < 3; u++) {
            const char *text = scene(basis[b], update[u],
                                     "shape: {disc: {center: [4, 6], radius: 2}}, fill: {rule: regular, per_cell: 9}, velocity: "
                                     "['4-1.5*(y-6)', '-5+1.5*(x-4)']");
            one_body *one = one_body_create(text, 2);
            const size_t born = one->mpm->points;
            const uint64_t version = one->mpm->version;
            const double mass = 4 * 3.14159265358979323846;
            check_points(one, born, mass);
            for (int s = 0; s < 1500; s++) { /* it falls on the floor and is thrown about */
                one_body_step(one, NULL, NULL);
                if (s % 50 == 0) check_points(one, born, mass);
            }
            check_points(one, born, mass);
            double *x = malloc(2 * born * sizeof *x), *id = malloc(born * sizeof *id);
            must(one, one->domain->ops->read(one->domain, "position", x, one->report));
            must(one, one->domain->ops->read(one->domain, "id", id, one->report));
            for (size_t p = 0; p < born; p++) {
                assert_true(id[p] == (double)p);
                assert_true(x[2 * p] >= -5 && x[2 * p] <= 15 && x[2 * p + 1] >= -3 && x[2 * p + 1] <= 17);
            }
            assert_true(one->mpm->version > version + 5); /* it was sorted again and again */
            free(x), free(id);
            one_body_destroy(one);
        }
}

/* Sorts that were not due: the second of two in a row moves nothing, and a body that is sorted often goes where one goes that is not. */
static void test_sorting_changes_nothing(void **state) {
    (void)state;
    const char *text = scene("gimp", "musl", "shape: {disc: {center: [4, 6], radius: 2}}, velocity: ['1-1.5*(y-6)', '-1+1.5*(x-4)']");
    one_body *rare = one_body_create(text, 1), *often = one_body_create(text, 1);
    const size_t born = rare->mpm->points;
    double *a = malloc(4 * born * sizeof *a), *b = malloc(4 * born * sizeof *b), worst = 0;
    for (int s = 0; s < 400; s++) {
        if (s % 7 == 3) {
            must(often, mpm_points_sort(often->mpm, often->report));
            const size_t bytes = often->mpm->block_count * 64 * (size_t)often->mpm->rows.count;
            double *before = malloc(bytes);
            memcpy(before, often->mpm->blocks, bytes);
            must(often, mpm_points_sort(often->mpm, often->report));
            assert_memory_equal(before, often->mpm->blocks, bytes);
            free(before);
            often->mpm->scattered = false;
        }
        one_body_step(rare, NULL, NULL);
        one_body_step(often, NULL, NULL);
    }
    static const char *const fields[] = {"position", "velocity", "stress"};
    static const double sizes[] = {10, 1, 100};
    for (int f = 0; f < 3; f++) {
        must(rare, rare->domain->ops->read(rare->domain, fields[f], a, rare->report));
        must(often, often->domain->ops->read(often->domain, fields[f], b, often->report));
        for (size_t k = 0; k < (f == 2 ? 4 : 2) * born; k++) worst = fmax(worst, fabs(a[k] - b[k]) / sizes[f]);
    }
    print_message("sorted often or when due: apart by %.1e\n", worst);
    assert_true(worst <= 1e-11);
    free(a), free(b);
    one_body_destroy(rare);
    one_body_destroy(often);
}

/* All nodes move away from the middle of the grid, or back; the mass on them is summed. */
typedef struct parting {
    double rate, worst, most; /* 1/s, kg, m */
} parting;

static void part(one_body *one, void *data) {
    parting *p = data;
    const mpm_body *body = one->mpm;
    double mass = 0;
    for (size_t k = 0; k < body->tile_count; k++)
        for (int n = 0; n < AB_TILE_NODES; n++) {
            double x[2], *own = node_record(body, k, n);
            node_place(body, k, n, x);
            mass += own[OWN_MASS];
            for (int c = 0; c < 2 && own[OWN_MASS] > 0; c++) own[OWN_VELOCITY + c] = p->rate * (x[c] - 10);
        }
    p->worst = fmax(p->worst, fabs(mass - 0.64));
    for (size_t slot = 0; slot < body->block_count * 8; slot++)
        if (is_point(body, slot)) p->most = fmax(p->most, fabs(*point_row(body, slot, ROW_X) - 10));
}

/* Points that part, to thirteen times their distances, and come back: their domains may grow to a cell and no further, and weights go on adding up to 1. */
static void test_nodes_have_the_mass_of_points_that_part(void **state) {
    (void)state;
    static const char *const basis[] = {"gimp", "{gimp: fixed}", "cpdi", "linear", "bspline2", "bspline3"};
    for (int b = 0; b < 6; b++) {
        one_body *one =
            one_body_create(scene(basis[b], "musl", "shape: {box: [[4.6, 6.6], [5.4, 7.4]]}, fill: {rule: regular, per_cell: 4}"), 1);
        parting p = {.rate = 5};
        for (int s = 0; s < 512; s++) {
            if (s == 256) p.rate = -5;
            one_body_step(one, part, &p);
        }
        print_message("%s: mass off by %.1e of 0.64 kg, points up to %.3g m from the middle\n", basis[b], p.worst, p.most);
        assert_true(p.worst < 1e-13 && p.most > 3);
        one_body_destroy(one);
    }
}

static void test_a_start_velocity_without_a_value_is_named(void **state) {
    (void)state;
    one_body *one = calloc(1, sizeof *one);
    const char *text = scene("gimp", "musl", "shape: {box: [[0, 0], [1, 1]]}, fill: {rule: regular, per_cell: 4}, velocity: [0, 1/(x-0.125)]");
    assert_int_equal(one_body_attempt(one, text, 1), AB_BAD_INPUT);
    const char *said = ab_report_first_error(one->report);
    assert_non_null(said);
    if (!strstr(said, "error: bodies.b.velocity[1] is inf at t = 0 s at (0.125, ")) print_error("%s\n", said);
    assert_non_null(strstr(said, "error: bodies.b.velocity[1] is inf at t = 0 s at (0.125, "));
    one_body_destroy(one);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_point_is_lost),
        cmocka_unit_test(test_sorting_changes_nothing),
        cmocka_unit_test(test_nodes_have_the_mass_of_points_that_part),
        cmocka_unit_test(test_a_start_velocity_without_a_value_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
