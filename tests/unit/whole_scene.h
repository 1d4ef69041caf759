/* whole_scene.h: a scene from its text with the built-in plugins, for tests that make bodies of it. Include after cmocka.h. */
#ifndef AB_WHOLE_SCENE_H
#define AB_WHOLE_SCENE_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/plugin_host.h"
#include "core/scene.h"

/* Plugins are those of the build folder: $ABUT_BUILD, or two folders up, from build/tests/unit. As far as it goes: what is said is in the report. */
static inline ab_status whole_scene_read(const char *text, ab_registry **registry, ab_scene **scene, ab_report *report) {
    char path[] = "/tmp/abut-text-XXXXXX", plugins[4096];
    const int handle = mkstemp(path);
    assert_true(handle >= 0);
    assert_int_equal(write(handle, text, strlen(text)), (ssize_t)strlen(text));
    close(handle);
    const char *build = getenv("ABUT_BUILD");
    snprintf(plugins, sizeof plugins, "%s/plugins", build ? build : "../..");
    ab_status status = ab_registry_create(plugins, registry, report);
    if (status == AB_OK) status = ab_scene_read(path, NULL, 0, *registry, scene, report);
    unlink(path);
    return status;
}

#endif
