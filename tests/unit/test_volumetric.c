/* test_volumetric.c: what f_bar promises: the average is the one it is defined as, symmetric and never longer than what it averages; forces do the work that the
 * ledger books; motion that is affine, and the volume of every cell, are as without; any number of threads gives the same bits; without it there is nothing. */
#include "one_body.h"

static const char *const basis[] = {"linear", "gimp", "bspline2", "bspline3", "cpdi"}, *const cells[] = {"cell", "patch"},
                         *const update[] = {"usl", "musl", "usf", "usavg"};
enum { BASES = 5 };

static const char *scene(double E, const char *basis_, const char *update_, const char *f_bar, const char *more) {
    static char text[2000];
    snprintf(text, sizeof text,
             "abut: 1\nspace: plane-strain\ntime: {end: 1e4, dt: 1e-3}\ngrid: {from: [-5, -3], to: [15, 17], cell: 0.5}\n"
             "materials: {m: {model: linear-elastic, E: %g, nu: 0.499, density: 2}}\n"
             "bodies: {b: {method: material-points, material: m, shape: {polygon: [[4, 6.3], [8.1, 6.6], [7.2, 9.4], [4.3, 8.9]]}, basis: "
             "%s, update: %s, f_bar: %s%s}}\n",
             E, basis_, update_, f_bar, more);
    return text;
}

/* Stresses, volumes and places in disorder; points stay near enough to where they were sorted. */
static void shuffle(mpm_body *body) {
    for (size_t slot = 0; slot < body->block_count * 8; slot++) {
        if (!is_point(body, slot)) continue;
        for (int c = 0; c < 2; c++) {
            double *x = point_row(body, slot, ROW_X + c);
            *point_row(body, slot, ROW_NEXT + c) = *x += random_between(-0.2, 0.2) * body->h;
        }
        for (int c = 0; c < 4; c++) *point_row(body, slot, ROW_STRESS + c) = random_between(-1, 1);
        *point_row(body, slot, ROW_VOLUME) *= random_between(0.8, 1.2);
    }
}

static double mean_stress(mpm_body *body, size_t slot) {
    return 0.5 * (*point_row(body, slot, ROW_STRESS) + *point_row(body, slot, ROW_STRESS + 1));
}

enum { SIDE = 42 };
typedef double of_cells[SIDE][SIDE];

/* The part of sliver (j, i) that goes to the cell (dj, di) from it: the full ones among its four neighbours, else of the others, share alike. */
static double share_of(of_cells volume, double full, int j, int i, int dj, int di) {
    int count[2] = {0, 0};
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++)
            if ((x || y) && volume[j + y][i + x] >= full) count[x && y]++;
    const int corner = dj && di;
    if ((!dj && !di) || volume[j + dj][i + di] < full || (corner && count[0])) return 0;
    return 1.0 / count[corner];
}

/* The average of a[slot], written as its definition: slivers, which hold less than 0.3 of a cell, are parts of the full cells beside them. Their number. */
static int define_average(mpm_body *body, bool patch, const double *a, double *mean) {
    static of_cells whole, volume, node, cell, more, most;
    const double full = 0.3 * body->h * body->h;
    int slivers = 0;
    memset(whole, 0, sizeof whole), memset(volume, 0, sizeof volume);
    for (int pass = 0; pass < 2; pass++) {
        for (size_t slot = 0; slot < body->block_count * 8; slot++) {
            if (!is_point(body, slot)) continue;
            const int i = (int)floor(*point_row(body, slot, ROW_X) / body->h) + 1,
                      j = (int)floor(*point_row(body, slot, ROW_X + 1) / body->h) + 1;
            if (pass == 0) {
                whole[j][i] += *point_row(body, slot, ROW_VOLUME) * a[slot];
                volume[j][i] += *point_row(body, slot, ROW_VOLUME);
            } else if (volume[j][i] >= full || volume[j][i] == most[j][i]) {
                mean[slot] = patch ? cell[j][i] : more[j][i] / most[j][i];
            } else {
                mean[slot] = 0;
                for (int y = -1; y <= 1; y++)
                    for (int x = -1; x <= 1; x++)
                        mean[slot] += share_of(volume, full, j, i, y, x) * (patch ? cell[j + y][i + x] : more[j + y][i + x] / fmax(most[j + y][i + x], 1e-99));
            }
        }
        if (pass) break;
        memcpy(more, whole, sizeof whole), memcpy(most, volume, sizeof volume);
        for (int j = 1; j < SIDE - 1; j++)
            for (int i = 1; i < SIDE - 1; i++) {
                double given = 0;
                for (int y = -1; y <= 1 && volume[j][i] > 0 && volume[j][i] < full; y++)
                    for (int x = -1; x <= 1; x++) {
                        const double share = share_of(volume, full, j, i, y, x);
                        more[j + y][i + x] += share * whole[j][i];
                        most[j + y][i + x] += share * volume[j][i];
                        given += share;
                    }
                if (given > 0) more[j][i] = most[j][i] = 0, slivers++;
            }
        for (int j = 1; j < SIDE; j++)
            for (int i = 1; i < SIDE; i++) {
                const double v = most[j][i] + most[j - 1][i] + most[j][i - 1] + most[j - 1][i - 1];
                node[j][i] = v > 0 ? (more[j][i] + more[j - 1][i] + more[j][i - 1] + more[j - 1][i - 1]) / v : 0;
            }
        for (int j = 0; j < SIDE - 1; j++)
            for (int i = 0; i < SIDE - 1; i++) cell[j][i] = (node[j][i] + node[j][i + 1] + node[j + 1][i] + node[j + 1][i + 1]) / 4;
    }
    return slivers;
}

/* A is as defined; (a, A b) = (A a, b) with volumes as weights, and (A a, A a) <= (a, a): a stiffness with A in it is symmetric and nowhere larger. */
static void test_the_average_is_symmetric_and_contracts(void **state) {
    (void)state;
    for (int b = 0; b < BASES; b++)
        for (int patch = 0; patch < 2; patch++) {
            one_body *one = one_body_create(scene(1, basis[b], "musl", cells[patch], ""), 1);
            mpm_body *body = one->mpm;
            shuffle(body);
            const size_t slots = body->block_count * 8;
            double *q = calloc(slots, sizeof *q), *mean = calloc(slots, sizeof *mean), *first = calloc(slots, sizeof *first),
                   *averaged = calloc(slots, sizeof *averaged);
            double worst = 0, forth = 0, back = 0, before = 0, after = 0;
            for (int round = 0; round < 2; round++) {
                for (size_t s = 0; s < slots; s++) {
                    if (!is_point(body, s)) continue;
                    for (int c = 0; c < 4; c++) *point_row(body, s, ROW_STRESS + c) = random_between(-1, 1);
                    q[s] = mean_stress(body, s);
                }
                assert_true(define_average(body, patch, q, mean) > 0);
                mpm_volumetric_stress(body);
                for (size_t s = 0; s < slots; s++) {
                    if (!is_point(body, s)) continue;
                    const double v = *point_row(body, s, ROW_VOLUME), found = mean_stress(body, s);
                    worst = fmax(worst, fabs(found - mean[s]));
                    assert_true(*point_row(body, s, body->rows.mean_stress) == q[s]);
                    forth += round ? v * first[s] * found : 0;
                    back += round ? v * averaged[s] * q[s] : 0;
                    before += v * q[s] * q[s];
                    after += v * found * found;
                    if (!round) first[s] = q[s], averaged[s] = found;
                }
            }
            print_message("%-8s %-5s off by %.1e, asymmetry %.1e, size %.3f\n", basis[b], cells[patch], worst, forth - back,
                          sqrt(after / before));
            assert_true(worst <= 1e-14 && fabs(forth - back) <= 1e-13 * before && after < before);
            free(q), free(mean), free(first), free(averaged);
            one_body_destroy(one);
        }
}

/* Nodes with any velocities, points with any stresses: the power of the forces that the points put on the nodes is that of the materials' stresses on the strains
 * that the points then get. */
static void test_forces_do_the_work_that_is_booked(void **state) {
    (void)state;
    for (int b = 0; b < BASES; b++)
        for (int u = 0; u < 2; u++)
            for (int patch = 0; patch < 2; patch++) {
                one_body *one = one_body_create(scene(1e-12, basis[b], update[u], cells[patch], ""), 1);
                mpm_body *body = one->mpm;
                one->step.dt = 1e-8;
                body->light_limit = 0; /* each node on its own: those that go by others are test_light_nodes.c's */
                shuffle(body);
                mpm_volumetric_stress(body);
                must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
                double work = 0, size = 0;
                for (size_t n = 0; n < body->tile_count * AB_TILE_NODES; n++) {
                    double *own = body->own + n * OWN_RECORD;
                    if (!(own[OWN_MASS] > 0)) continue;
                    for (int c = 0; c < 2; c++) {
                        const double force = own[OWN_MASS] * (own[OWN_VELOCITY + c] - own[OWN_OLD + c]) / one->step.dt;
                        own[OWN_VELOCITY + c] = random_between(-1, 1);
                        work -= one->step.dt * force * own[OWN_VELOCITY + c];
                        size += one->step.dt * fabs(force * own[OWN_VELOCITY + c]);
                    }
                }
                must(one, one->domain->ops->stress(one->domain, &one->step, one->report));
                print_message("%-8s %-4s %-5s work %10.3e, booked %10.3e J: off by %.1e\n", basis[b], update[u], cells[patch], work,
                              body->last_strain, (body->last_strain - work) / size);
                assert_true(fabs(body->last_strain - work) <= 1e-6 * size);
                one_body_destroy(one);
            }
}

/* Where all points have one change of volume there is nothing to average. Without f_bar there is no room for it. */
static void test_affine_motion_is_as_without(void **state) {
    (void)state;
    for (int b = 0; b < BASES; b++)
        for (int u = 0; u < 3; u++) /* usavg: the forces of the first half of the strain make the second one uneven */
            for (int patch = 0; patch < 2; patch++) {
                static const char velocity[] = ", transfer: apic, velocity: [\"0.3*x - 1.7*y\", \"0.9*x + 0.4*y\"]";
                one_body *with = one_body_create(scene(1, basis[b], update[u], cells[patch], velocity), 1);
                one_body *without = one_body_create(scene(1, basis[b], update[u], "false", velocity), 1);
                one_body_step(with, NULL, NULL);
                one_body_step(without, NULL, NULL);
                double worst = 0, size = 0;
                for (size_t s = 0; s < with->mpm->block_count * 8; s++) {
                    if (!is_point(with->mpm, s)) continue;
                    for (int c = 0; c < 4; c++) {
                        const double stress = *point_row(without->mpm, s, ROW_STRESS + c);
                        worst = fmax(worst, fabs(stress - *point_row(with->mpm, s, ROW_STRESS + c)));
                        size = fmax(size, fabs(stress));
                    }
                }
                assert_true(with->mpm->rows.mean_stress >= 0 && with->mpm->volumetric && with->mpm->ids[0] == without->mpm->ids[0]);
                assert_true(without->mpm->rows.mean_stress < 0 && !without->mpm->volumetric); /* off, it takes no room */
                print_message("%-8s %-4s %-5s stress off by %.1e of %.1e Pa\n", basis[b], update[u], cells[patch], worst, size);
                assert_true(worst <= 1e-13 * size);
                one_body_destroy(with);
                one_body_destroy(without);
            }
}

/* A body that vibrates while it moves through the grid: any number of threads gives the same bits. */
static void test_threads_give_the_same_bits(void **state) {
    (void)state;
    static const char velocity[] = ", velocity: [\"4 + sin(3*x*y)\", \"-3 + cos(2*x + y*y)\"]";
    for (int b = 0; b < BASES; b++)
        for (int u = 0; u < 4; u++)
            for (int patch = 0; patch < 2; patch++) {
                one_body *one[2];
                for (int k = 0; k < 2; k++) {
                    one[k] = one_body_create(scene(1, basis[b], update[u], cells[patch], velocity), 1);
                    one[k]->mpm->threads = k ? 3 : 1;
                    one[k]->step.dt = 4e-3;
                    for (int s = 0; s < 60; s++) one_body_step(one[k], NULL, NULL);
                }
                const mpm_body *body = one[0]->mpm;
                assert_int_equal(body->block_count, one[1]->mpm->block_count);
                assert_memory_equal(body->blocks, one[1]->mpm->blocks, body->block_count * 64 * (size_t)body->rows.count);
                assert_true(body->energy.strain == one[1]->mpm->energy.strain);
                for (int k = 0; k < 2; k++) one_body_destroy(one[k]);
            }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_average_is_symmetric_and_contracts), cmocka_unit_test(test_forces_do_the_work_that_is_booked),
        cmocka_unit_test(test_affine_motion_is_as_without), cmocka_unit_test(test_threads_give_the_same_bits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
