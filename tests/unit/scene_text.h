/* scene_text.h: scenes for tests: one that is right, with single pieces replaced. Include after fake_registry.h. */
#ifndef AB_SCENE_TEXT_H
#define AB_SCENE_TEXT_H

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "core/scene.h"

static const char good_scene[] =
    "abut: 1\n"
    "title: two blocks\n"
    "constants: {mu: 0.25, E0: 20 MPa, twice: 2*mu}\n"
    "gravity: [0, -9.81]\n"
    "time: {end: 1, cfl: 0.4}\n"
    "grid:\n"
    "  from: [0, 0]\n"
    "  to: [8, 4]\n"
    "  cell: 0.5\n"
    "  sides: {bottom: fixed, left: roller}\n"
    "materials:\n"
    "  rubber: {model: linear-elastic, E: E0, nu: 0.3, density: 1000}\n"
    "bodies:\n"
    "  plane:\n"
    "    method: material-points\n"
    "    material: rubber\n"
    "    shape: {box: [[0, 0], [8, 1]]}\n"
    "  block:\n"
    "    method: material-points\n"
    "    material: rubber\n"
    "    shape: {box: [[1, 1], [2, 2]]}\n"
    "    fill: {rule: gauss, per_cell: 9}\n"
    "    velocity: [\"0.1*y\", 0]\n"
    "contact:\n"
    "  - bodies: [block, plane]\n"
    "    algorithm: multi-velocity\n"
    "    friction: mu\n"
    "monitors:\n"
    "  - {name: x, body: block, value: position.x}\n"
    "  - {name: push, contact: 0, value: force.y}\n"
    "expect:\n"
    "  - {name: slides, monitor: x, reference: \"1.5 + 2*t\", tolerance: 0.01}\n";

typedef struct outcome {
    ab_status status;
    ab_scene *scene;
    ab_report *report;
} outcome;

static inline void forget(outcome *o) {
    ab_scene_destroy(o->scene);
    ab_report_destroy(o->report);
}

static inline outcome read_bytes(const char *bytes, size_t length, const ab_override *overrides, size_t count) {
    char path[] = "/tmp/abut-scene-XXXXXX";
    outcome o = {AB_FAILED, NULL, ab_report_create()};
    const int handle = mkstemp(path);
    FILE *file = handle < 0 ? NULL : fdopen(handle, "wb");
    if (file == NULL) return o;
    fwrite(bytes, 1, length, file);
    fclose(file);
    o.status = ab_scene_read(path, overrides, count, NULL, &o.scene, o.report);
    unlink(path);
    return o;
}

/* The good scene with the first `from` replaced by `to`. NULL, NULL: as it is. */
static inline outcome read_changed(const char *from, const char *to, const ab_override *overrides, size_t count) {
    char *text = malloc(sizeof good_scene + 200000);
    const char *at = from == NULL ? NULL : strstr(good_scene, from);
    if (from != NULL && at == NULL) abort();
    if (from == NULL) strcpy(text, good_scene);
    else sprintf(text, "%.*s%s%s", (int)(at - good_scene), good_scene, to, at + strlen(from));
    outcome o = read_bytes(text, strlen(text), overrides, count);
    free(text);
    return o;
}

/* True when some line of the report holds the piece. */
static inline bool said(const outcome *o, const char *piece) {
    const char *text;
    for (size_t i = 0; (text = ab_report_text(o->report, i)) != NULL; i++)
        if (strstr(text, piece) != NULL) return true;
    fprintf(stderr, "not said: %s\n", piece);
    for (size_t i = 0; (text = ab_report_text(o->report, i)) != NULL; i++) fprintf(stderr, "  %s\n", text);
    return false;
}

#endif
