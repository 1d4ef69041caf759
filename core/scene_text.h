/* scene_text.h: a scene as lines of text, to tell whether it is still the same. */
#ifndef AB_SCENE_TEXT_H
#define AB_SCENE_TEXT_H

#include "core/files.h"
#include "core/scene.h"

/* A line "bodies.block.fill.per_cell: 16" for every value as it is written, with --set, in the order of the file; then the plugins it loads, with their versions, and the
 * files it reads, with their check sums. Left out is what may change between a checkpoint and the run that goes on from it: title, time.end, monitors, history, output, expect,
 * checkpoint, watchdog, checked, trade, extremes. */
void ab_scene_text(const ab_scene *scene, ab_text *text);
/* What the scene says of an expect, and of the monitor that it looks at. */
void ab_scene_text_of_expect(const ab_scene *scene, size_t expect, ab_text *text);

#endif
