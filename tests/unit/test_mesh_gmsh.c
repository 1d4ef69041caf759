/* test_mesh_gmsh.c: meshes in Gmsh files, written here as text: what is taken, what is refused by the ids of the file, and files that are damaged on purpose. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include "effort.h"
#include "mesh_checks.h"

static char folder[64];

static void write_file(const char *name, const char *text, size_t length) {
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, length, file), length);
    fclose(file);
}

static ab_body_spec file_body(ab_element_type type) {
    return (ab_body_spec){.name = "beam", .mesh = {.kind = AB_MESH_FILE, .type = type, .file = (char *)"beam.msh", .hourglass = 1}};
}

static fem_mesh *read_back(ab_element_type type, const char *text, ab_report *report) {
    const ab_body_spec spec = file_body(type);
    fem_mesh *mesh = NULL;
    if (text != NULL) write_file("beam.msh", text, strlen(text));
    const ab_status status = fem_mesh_create(&spec, folder, &mesh, report);
    assert_true((status == AB_OK) == (mesh != NULL));
    if (status != AB_OK) assert_true(ab_report_errors(report) > 0);
    return mesh;
}

static bool said(const ab_report *report, const char *piece) {
    const char *text;
    for (size_t i = 0; (text = ab_report_text(report, i)) != NULL; i++)
        if (strstr(text, piece) != NULL) return true;
    fprintf(stderr, "not said: %s\n", piece);
    for (size_t i = 0; (text = ab_report_text(report, i)) != NULL; i++) fprintf(stderr, "  %s\n", text);
    return false;
}

#define HEAD2 "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
/* Two squares side by side, numbers with gaps; node 99 is of none. */
#define NODES2 "$Nodes\n7\n10 0 0 0\n11 1 0 0\n12 2 0 0\n20 0 1 0\n21 1 1 0\n22 2 1 0\n99 5 5 0\n$EndNodes\n"
#define SQUARE(id, a, b, c, d) #id " 3 2 1 1 " #a " " #b " " #c " " #d "\n"
#define ELEMENTS(n, text) "$Elements\n" #n "\n" text "$EndElements\n"
#define TWO SQUARE(7, 10, 11, 21, 20) SQUARE(9, 11, 12, 22, 21)

/* Two squares with middles of sides and of the right one; a spare node in none. */
#define MIXED                                                                                                                              \
    HEAD2                                                                                                                                  \
    "$Nodes\n14\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 .5 0 0\n6 1 .5 0\n7 .5 1 0\n8 0 .5 0\n9 2 0 0\n10 2 1 0\n11 1.5 0 0\n12 2 .5 "      \
    "0\n13 1.5 1 0\n14 1.5 .5 0\n$EndNodes\n"

#ifdef ABUT_WITH_GMSH

static const char two_squares_4[] =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$Entities\n0 0 2 0\n1 0 0 0 1 1 0 0 0\n2 1 0 0 2 1 0 0 0\n$EndEntities\n"
    "$Nodes\n2 7 10 99\n2 1 0 5\n10\n11\n20\n21\n99\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n5 5 0\n2 2 0 2\n12\n22\n2 0 0\n2 1 0\n$EndNodes\n"
    "$Elements\n2 2 7 9\n2 1 3 1\n7 10 11 21 20\n2 2 3 1\n9 11 12 22 21\n$EndElements\n";

static void check_two_squares(const fem_mesh *mesh) {
    static const uint32_t expected[8] = {0, 1, 4, 3, 1, 2, 5, 4};
    assert_int_equal(mesh->nodes, 4);
    assert_int_equal(mesh->node_count, 6);
    assert_int_equal(mesh->element_count, 2);
    assert_memory_equal(mesh->connectivity, expected, sizeof expected);
    assert_int_equal(mesh->node_id[4], 21);
    assert_int_equal(mesh->element_id[1], 9);
    assert_float_equal(area_of(mesh), 2, 1e-15);
    fem_faces *faces = faces_of(mesh);
    assert_int_equal(faces->count, 6);
    assert_int_equal(check_faces(mesh, faces), 1);
    fem_faces_destroy(faces);
}

static void test_squares_are_read_from_both_formats_surfaces_together(void **state) {
    (void)state;
    ab_report *report = ab_report_create();
    fem_mesh *mesh = read_back(AB_ELEMENT_Q4, HEAD2 NODES2 ELEMENTS(2, TWO), report);
    assert_non_null(mesh);
    check_two_squares(mesh);
    fem_mesh_destroy(mesh);
    ab_report_destroy(report);
    report = ab_report_create();
    mesh = read_back(AB_ELEMENT_Q6, two_squares_4, report);
    assert_non_null(mesh);
    assert_true(said(report, "warning: body 'beam': 1 nodes of"));
    assert_true(said(report, "belong to no element and are left out: 99"));
    check_two_squares(mesh);
    fem_mesh_destroy(mesh);
    ab_report_destroy(report);
}

static void test_elements_drawn_clockwise_are_turned_round(void **state) {
    (void)state;
    ab_report *report = ab_report_create();
    fem_mesh *mesh = read_back(AB_ELEMENT_Q4, HEAD2 NODES2 ELEMENTS(2, SQUARE(1, 20, 21, 11, 10) SQUARE(2, 11, 21, 22, 12)), report);
    assert_non_null(mesh);
    assert_float_equal(area_of(mesh), 2, 1e-15);
    fem_faces *faces = faces_of(mesh);
    assert_int_equal(check_faces(mesh, faces), 1);
    fem_faces_destroy(faces);
    fem_mesh_destroy(mesh);
    mesh = read_back(AB_ELEMENT_Q8,
                     HEAD2 "$Nodes\n8\n1 0 0 0\n2 0 1 0\n3 1 1 0\n4 1 0 0\n5 0 .5 0\n6 .5 1.2 0\n7 1 .5 0\n8 .5 0 0\n$EndNodes\n"
                           "$Elements\n1\n1 16 2 1 1 1 2 3 4 5 6 7 8\n$EndElements\n",
                     report);
    assert_non_null(mesh);
    assert_float_equal(area_of(mesh), 1 + 2.0 / 3 * 0.2, 1e-15); /* the parabola over the top */
    fem_mesh_destroy(mesh);
    ab_report_destroy(report);
}

static const struct {
    ab_element_type type;
    const char *text, *said;
} mistakes[] = {
    {AB_ELEMENT_Q4, HEAD2 NODES2 ELEMENTS(2, SQUARE(7, 10, 11, 21, 20) "9 2 2 1 1 11 12 22\n"),
     "has elements of several types: 1 of Triangle 3 (3 nodes): elements 9, 1 of Quadrilateral 4 (4 nodes)"},
    {AB_ELEMENT_Q4, HEAD2 NODES2 ELEMENTS(1, "9 2 2 1 1 11 12 22\n"), "has triangles (elements 9); quadrilaterals of 4 or 8"},
    /* one surface: libgmsh gives only what is like the first of its quadrilaterals */
    {AB_ELEMENT_Q4, MIXED "$Elements\n3\n7 3 2 1 1 1 2 3 4\n8 3 2 1 1 11 12 13 14\n9 10 2 1 1 2 9 10 3 11 12 13 6 14\n$EndElements\n",
     "beam.msh' has elements of several types: 2 of Quadrilateral 4 (4 nodes), 1 of Quadrilateral 9 (9 nodes): elements 9; quadrilaterals "
     "of one order are needed"},
    {AB_ELEMENT_Q8, MIXED "$Elements\n3\n70 16 2 1 1 1 2 3 4 5 6 7 8\n71 16 2 1 1 2 9 10 3 11 12 13 6\n99 3 2 1 1 1 2 3 4\n$EndElements\n",
     "1 of Quadrilateral 4 (4 nodes): elements 99, 2 of Quadrilateral 8 (8 nodes)"},
    {AB_ELEMENT_Q4, MIXED "$Elements\n2\n7 3 2 1 1 1 2 3 4\n9 9 2 2 2 2 9 3 11 13 6\n$EndElements\n",
     "1 of Quadrilateral 4 (4 nodes), 1 of Triangle 6 (6 nodes): elements 9"},
    {AB_ELEMENT_Q4, MIXED "$Elements\n2\n7 3 2 1 1 1 2 3 4\n20000000 10 2 1 1 2 9 10 3 11 12 13 6 14\n$EndElements\n",
     "a surface has elements of several types, and not all can be found by their numbers"},
    /* an element inside another, one across others, a piece drawn twice */
    {AB_ELEMENT_Q4,
     HEAD2 "$Nodes\n8\n1 0 0 0\n2 2 0 0\n3 2 2 0\n4 0 2 0\n5 .5 .5 0\n6 1.5 .5 0\n7 1.5 1 0\n8 .5 1 0\n$EndNodes\n" ELEMENTS(
         2, SQUARE(1, 1, 2, 3, 4) SQUARE(2, 5, 6, 7, 8)),
     "overlap in 1 pair, by 0.5 m2 together: 1 and 2, say, share 100 % of the smaller"},
    {AB_ELEMENT_Q4,
     HEAD2 "$Nodes\n10\n10 0 0 0\n11 1 0 0\n12 2 0 0\n20 0 1 0\n21 1 1 0\n22 2 1 0\n1 .5 .75 0\n2 1.75 .75 0\n3 1.75 2 0\n4 .5 2 "
           "0\n$EndNodes\n" ELEMENTS(3, TWO SQUARE(12, 1, 2, 3, 4)),
     "overlap in 2 pairs, by 0.3125 m2 together: 9 and 12, say, share 18.8 %"},
    {AB_ELEMENT_Q4,
     HEAD2 "$Nodes\n8\n1 0 0 0\n2 2 0 0\n3 2 2 0\n4 0 2 0\n5 0 0 0\n6 2 0 0\n7 2 2 0\n8 0 2 0\n$EndNodes\n" ELEMENTS(
         2, SQUARE(1, 1, 2, 3, 4) SQUARE(2, 5, 6, 7, 8)),
     "overlap in 1 pair, by 4 m2 together"},
    {AB_ELEMENT_Q4,
     HEAD2 "$Nodes\n4\n1 0 0 0\n2 1e-200 0 0\n3 1e-200 1e-200 0\n4 0 1e-200 0\n$EndNodes\n" ELEMENTS(1, SQUARE(5, 1, 2, 3, 4)),
     "too small to compute with"},
    {AB_ELEMENT_Q8, HEAD2 NODES2 ELEMENTS(2, TWO), "has quadrilaterals of 4 nodes (elements 7, 9), but the mesh's type is one of 8 nodes"},
    {AB_ELEMENT_Q8,
     HEAD2 "$Nodes\n9\n1 0 0 0\n2 2 0 0\n3 2 2 0\n4 0 2 0\n5 1 0 0\n6 2 1 0\n7 1 2 0\n8 0 1 0\n9 1 1 0\n$EndNodes\n"
           "$Elements\n1\n1 10 2 1 1 1 2 3 4 5 6 7 8 9\n$EndElements\n",
     "has quadrilaterals of 9 nodes (elements 1); quadrilaterals of 4 or 8 nodes are needed: set Mesh.SecondOrderIncomplete = 1"},
    {AB_ELEMENT_Q4, HEAD2 NODES2 ELEMENTS(1, "1 1 2 1 1 10 11\n"), "has no elements of surfaces"},
    {AB_ELEMENT_Q4, HEAD2 NODES2 ELEMENTS(2, SQUARE(7, 10, 11, 21, 20) SQUARE(9, 21, 22, 12, 11)), "1 go round one way and 1 the other"},
    {AB_ELEMENT_Q4, HEAD2 NODES2 ELEMENTS(3, TWO SQUARE(12, 11, 12, 22, 21)), "elements 9 and 12 lie on the same side"},
    {AB_ELEMENT_Q4, HEAD2 NODES2 ELEMENTS(3, TWO SQUARE(12, 10, 11, 99, 20)), "elements 7 and 12 lie on the same side"},
    {AB_ELEMENT_Q4, HEAD2 NODES2 ELEMENTS(2, SQUARE(7, 10, 11, 21, 20) SQUARE(9, 11, 12, 22, 22)), "element 9 of"},
    {AB_ELEMENT_Q4, HEAD2 "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 .4 .4 0\n4 0 1 0\n$EndNodes\n" ELEMENTS(1, SQUARE(5, 1, 2, 3, 4)),
     "element 5 near [0.35, 0.35] is folded"},
    {AB_ELEMENT_Q4, HEAD2 "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0.5\n4 0 1 0\n$EndNodes\n" ELEMENTS(1, SQUARE(5, 1, 2, 3, 4)),
     "node 1 has z = 0, node 3 has z = 0.5"},
    {AB_ELEMENT_Q4, HEAD2 "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 nan 0\n4 0 1 0\n$EndNodes\n" ELEMENTS(1, SQUARE(5, 1, 2, 3, 4)), "node 3 of"},
    {AB_ELEMENT_Q4, HEAD2 NODES2 ELEMENTS(1, SQUARE(5, 10, 11, 21, 44)),
     "element 5 names node 44, which the file does not have (Wrong node index 44); the file is damaged or cut off, save it anew"},
    {AB_ELEMENT_Q8,
     HEAD2 "$Nodes\n16\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 .5 0 0\n6 1 .5 0\n7 .5 1 0\n8 0 .5 0\n9 2 0 0\n10 2 .5 0\n11 1.5 0 0\n12 2 "
           ".25 0\n13 1.5 .5 "
           "0\n14 1 .25 0\n15 7 7 0\n16 7 7 0\n$EndNodes\n"
           "$Elements\n2\n1 16 2 1 1 1 2 3 4 5 6 7 8\n2 16 2 1 1 2 9 10 6 11 12 13 14\n$EndElements\n",
     "node 6 of"},
    {AB_ELEMENT_Q4, "SystemCall \"touch executed\";\n", "is no Gmsh mesh: it does not begin with $MeshFormat"},
    {AB_ELEMENT_Q4, "", "is no Gmsh mesh"},
    {AB_ELEMENT_Q4, "$MeshFormat\n", "beam.msh': it is damaged, or ends too early"},
    {AB_ELEMENT_Q4, HEAD2 "$Nodes\n", "beam.msh"},
    {AB_ELEMENT_Q4, HEAD2 "$Nodes\n99999999999\n1 0 0 0\n$EndNodes\n", "beam.msh"},
    {AB_ELEMENT_Q4, "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4000000000 1 4000000000\n2 1 0 4000000000\n", "beam.msh"},
    {AB_ELEMENT_Q4, "$MeshFormat\n4.1 1 8\n$EndMeshFormat\n$Nodes\nabcdefgh", "beam.msh"},
};

static void test_each_mistake_is_said_with_the_ids_of_the_file(void **state) {
    (void)state;
    for (size_t k = 0; k < sizeof mistakes / sizeof *mistakes; k++) {
        ab_report *report = ab_report_create();
        assert_null(read_back(mistakes[k].type, mistakes[k].text, report));
        assert_true(said(report, mistakes[k].said));
        assert_true(said(report, "body 'beam'"));
        ab_report_destroy(report);
    }
}

static void test_a_crack_is_warned_of(void **state) {
    (void)state;
    ab_report *report = ab_report_create();
    fem_mesh *mesh =
        read_back(AB_ELEMENT_Q4,
                  HEAD2 "$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 1 0 0\n6 2 0 0\n7 2 1 0\n8 1 1 0\n$EndNodes\n" ELEMENTS(
                      2, SQUARE(1, 1, 2, 3, 4) SQUARE(2, 5, 6, 7, 8)),
                  report);
    assert_non_null(mesh);
    assert_true(said(report, "2 nodes of"));
    assert_true(said(report, "are not joined with it (2 and 5, say)"));
    fem_mesh_destroy(mesh);
    ab_report_destroy(report);
}

/* Pieces that only touch, or overlap by chords of a common circle at most, are taken; the latter is said. */
static void test_pieces_that_touch_are_not_refused(void **state) {
    (void)state;
    static const struct {
        const char *x;
        size_t warnings;
    } upper[] = {{"1.0", 0}, {"0.95", 1}, {"1.000001", 0}};
    for (size_t k = 0; k < 3; k++) {
        char text[1000];
        snprintf(text, sizeof text,
                 HEAD2 "$Nodes\n10\n10 0 0 0\n11 1 0 0\n12 2 0 0\n20 0 1 0\n21 1 1 0\n22 2 1 0\n1 .5 %s 0\n2 1.75 %s 0\n3 1.75 2 0\n4 .5 2 "
                       "0\n$EndNodes\n" ELEMENTS(3, TWO SQUARE(12, 1, 2, 3, 4)),
                 upper[k].x, upper[k].x);
        ab_report *report = ab_report_create();
        fem_mesh *mesh = read_back(AB_ELEMENT_Q4, text, report);
        assert_non_null(mesh);
        assert_int_equal(ab_report_warnings(report), upper[k].warnings);
        if (upper[k].warnings > 0) assert_true(said(report, "overlap in 2 pairs, by 0.0625 m2 together"));
        fem_mesh_destroy(mesh);
        ab_report_destroy(report);
    }
}

static void test_files_that_are_not_there_are_named(void **state) {
    (void)state;
    ab_body_spec spec = file_body(AB_ELEMENT_Q4);
    ab_report *report = ab_report_create();
    fem_mesh *mesh = NULL;
    spec.mesh.file = (char *)"none.msh";
    assert_int_equal(fem_mesh_create(&spec, folder, &mesh, report), AB_BAD_INPUT);
    assert_true(said(report, "none.msh': No such file or directory; it is looked for in the scene's folder"));
    spec.mesh.file = (char *)"/";
    assert_int_equal(fem_mesh_create(&spec, folder, &mesh, report), AB_BAD_INPUT);
    spec.mesh.file = (char *)"/dev/zero";
    assert_int_equal(fem_mesh_create(&spec, folder, &mesh, report), AB_BAD_INPUT);
    ab_report_destroy(report);
}

/* Gmsh runs FILE.opt as a script when it opens FILE. */
static void test_nothing_beside_a_mesh_is_executed(void **state) {
    (void)state;
    char script[300], path[256];
    struct stat about;
    snprintf(path, sizeof path, "%s/executed", folder);
    snprintf(script, sizeof script, "SystemCall \"touch %s\";\n", path);
    write_file("beam.msh.opt", script, strlen(script));
    ab_report *report = ab_report_create();
    fem_mesh *mesh = read_back(AB_ELEMENT_Q4, HEAD2 NODES2 ELEMENTS(2, TWO), report);
    assert_non_null(mesh);
    assert_true(stat(path, &about) != 0);
    fem_mesh_destroy(mesh);
    ab_report_destroy(report);
}

/* Bytes changed one at a time: an answer each time, whatever libgmsh makes of it. */
static void test_damaged_files_are_answered(void **state) {
    (void)state;
    uint32_t random = 12345;
    for (int k = 0; k < EFFORT(24, 8); k++) {
        char text[2][1000];
        snprintf(text[0], sizeof text[0], "%s", HEAD2 NODES2 ELEMENTS(2, TWO));
        snprintf(text[1], sizeof text[1], "%s", two_squares_4);
        char *t = text[k % 2];
        size_t length = strlen(t);
        for (int n = 0; n < 1 + k % 3; n++) {
            random = random * 1664525u + 1013904223u;
            t[20 + random % (length - 20)] = "0159 -\n$.e\xff\0z"[(random >> 16) % 13];
        }
        if (k % 5 == 4) length = 20 + random % (length - 20);
        write_file("beam.msh", t, length);
        ab_report *report = ab_report_create();
        fem_mesh *mesh = read_back(AB_ELEMENT_Q4, NULL, report);
        if (mesh != NULL) {
            fem_faces *faces = faces_of(mesh);
            check_faces(mesh, faces);
            fem_faces_destroy(faces);
        }
        fem_mesh_destroy(mesh);
        ab_report_destroy(report);
    }
}

static int enter(void **state) {
    (void)state;
    dlopen("libgmsh.so", RTLD_NOW | RTLD_LOCAL); /* else every process that reads a file links it anew: a third of the time */
    strcpy(folder, "/tmp/abut-mesh-XXXXXX");
    return mkdtemp(folder) == NULL;
}

static int leave(void **state) {
    (void)state;
    static const char *const names[] = {"beam.msh", "beam.msh.opt", "executed"};
    for (size_t k = 0; k < 3; k++) {
        char path[256];
        snprintf(path, sizeof path, "%s/%s", folder, names[k]);
        unlink(path);
    }
    return rmdir(folder);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_squares_are_read_from_both_formats_surfaces_together),
        cmocka_unit_test(test_elements_drawn_clockwise_are_turned_round),
        cmocka_unit_test(test_each_mistake_is_said_with_the_ids_of_the_file),
        cmocka_unit_test(test_a_crack_is_warned_of),
        cmocka_unit_test(test_pieces_that_touch_are_not_refused),
        cmocka_unit_test(test_files_that_are_not_there_are_named),
        cmocka_unit_test(test_nothing_beside_a_mesh_is_executed),
        cmocka_unit_test(test_damaged_files_are_answered),
    };
    return cmocka_run_group_tests(tests, enter, leave);
}

#else

static void test_the_package_that_is_missing_is_named(void **state) {
    (void)state;
    strcpy(folder, "/tmp");
    const ab_body_spec spec = file_body(AB_ELEMENT_Q4);
    ab_report *report = ab_report_create();
    fem_mesh *mesh = NULL;
    assert_int_equal(fem_mesh_create(&spec, folder, &mesh, report), AB_BAD_INPUT);
    assert_true(said(report, "built without libgmsh; install libgmsh-dev"));
    ab_report_destroy(report);
    (void)write_file;
    (void)read_back;
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_the_package_that_is_missing_is_named)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#endif
