/* node_normals.c: what the finder on shared nodes says at the start of a scene, with every word of its setting `normal`. For study_normals.py.
 *
 *     node_normals BUILD SCENE...
 *
 * reads each scene, looks for the points of its first contact once with each normal, and prints lines
 *     normal SCENE WORD NODES SECONDS      shared nodes; seconds of one find, traces included, the least of some. WORD+gap: with gap: regression
 *     point X Y NX NY GAP AREA             of a node, as drawn, m */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "contact/contact.h"
#include "fem/body.h"
#include "mpm/body.h"

enum { REPEATS = 20, WORDS = 4096, REGRESSION = 2 /* word of the setting `gap` */ };

static int reserve(void *context, ab_points *view, size_t points_more, size_t stencil_more) {
    (void)context;
    const size_t stencil = points_more + stencil_more + (view->count ? view->a_start[view->count] + view->b_start[view->count] : 0);
    return contact_points_reserve((contact_points *)view, view->count + points_more, stencil) ? 0 : -1;
}

static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static ab_status look(const ab_scene *scene, const ab_contact_spec *spec, ab_domain *a, ab_domain *b, const char *path, const char *word,
                      ab_report *report) {
    contact_pair pair = {.spec = spec, .a = a, .b = b};
    pair.points.view = (ab_points){.struct_size = sizeof(ab_points), .dimension = 2};
    pair.points.states = HISTORY;
    ab_service_init(&pair.finder_service, "study");
    pair.finder_service.host.reserve = reserve;
    ab_report *aside = ab_report_create();
    const bool can = contact_can_find(&pair, aside) == AB_OK;
    ab_report_destroy(aside);
    if (!can) return AB_OK; /* faces, and no body has any */
    if (spec->finder->class_.create(&pair.finder_service.host, spec->finder_settings, &pair.finder) != 0)
        return ab_report_failure(report, "%s: the finder refused its settings", path);
    const ab_step step = {.dt = 1e-3};
    double least = INFINITY;
    ab_status status = AB_OK;
    for (int k = 0; status == AB_OK && k < REPEATS; ++k) {
        const double begin = seconds();
        status = contact_find(&pair, &step, report);
        least = fmin(least, seconds() - begin);
    }
    const ab_points *p = &pair.points.view;
    printf("normal %s %s %zu %.9g\n", path, word, pair.node_count, least);
    for (size_t i = 0; status == AB_OK && i < p->count; ++i)
        printf("point %.17g %.17g %.17g %.17g %.17g %.17g\n", scene->grid_cell * ab_tile_x(p->key[i]) + scene->grid_from[0],
               scene->grid_cell * ab_tile_y(p->key[i]) + scene->grid_from[1], p->normal[i], p->normal[p->ld + i], p->gap[i], p->area[i]);
    spec->finder->class_.destroy(pair.finder);
    contact_points_destroy(&pair.points);
    contact_faces_destroy(pair.faces);
    free(pair.tiles), free(pair.nodes_a), free(pair.nodes_b);
    return status;
}

static ab_status study(ab_registry *registry, const char *path, ab_report *report) {
    ab_scene *scene = NULL;
    ab_domain *body[2] = {NULL, NULL};
    ab_status status = ab_scene_read(path, NULL, 0, registry, &scene, report);
    if (status == AB_OK && (scene->contact_count != 1 || scene->body_count != 2))
        status = ab_report_failure(report, "%s: two bodies and one contact", path);
    for (size_t k = 0; status == AB_OK && k < 2; ++k) {
        const char *method = scene->bodies[k].method;
        status = (!strcmp(method, "material-points") ? mpm_create
                  : !strcmp(method, "rigid")         ? rigid_create
                                                     : fem_create)(scene, k, 1, body + k, report);
        const ab_step step = {.dt = 1e-6};
        if (status == AB_OK) status = body[k]->ops->begin(body[k], &step, report);
    }
    if (status == AB_OK) {
        ab_contact_spec *spec = scene->contacts;
        const char *word = spec->finder->class_.param[0].choices;
        for (int64_t number = 0; status == AB_OK && word && *word; ++number) {
            char name[64] = "";
            const size_t length = strcspn(word, "|");
            memcpy(name, word, length < sizeof name ? length : sizeof name - 1);
            word += length + (word[length] == '|');
            spec->finder_settings[0].integer = number;
            status = look(scene, spec, body[spec->body[0]], body[spec->body[1]], path, name, report);
            if (status != AB_OK || (strcmp(name, "average") && strcmp(name, "regression"))) continue;
            strcat(name, "+gap");
            spec->finder_settings[1].integer = REGRESSION;
            status = look(scene, spec, body[spec->body[0]], body[spec->body[1]], path, name, report);
            spec->finder_settings[1].integer = 0;
        }
    }
    for (int k = 0; k < 2; ++k)
        if (body[k]) body[k]->ops->destroy(body[k]);
    ab_scene_destroy(scene);
    return status;
}

int main(int argc, char **argv) {
    if (argc < 3) return fprintf(stderr, "node_normals BUILD SCENE...\n"), 2;
    char plugins[WORDS];
    snprintf(plugins, sizeof plugins, "%s/plugins", argv[1]);
    ab_report *report = ab_report_create();
    ab_registry *registry = NULL;
    ab_status status = ab_registry_create(plugins, &registry, report);
    for (int k = 2; status == AB_OK && k < argc; ++k) status = study(registry, argv[k], report);
    for (size_t k = 0; ab_report_text(report, k); ++k) fprintf(stderr, "%s\n", ab_report_text(report, k));
    ab_registry_destroy(registry);
    ab_report_destroy(report);
    return status == AB_OK ? 0 : 1;
}
