/* scene_section.h: how the tables of a scene's sections are written, for scene_keys*.c only. */
#ifndef AB_SCENE_SECTION_H
#define AB_SCENE_SECTION_H

#include "core/scene_keys.h"

#include <math.h>

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define SECTION(name_, title_, keys_, more_, help_, example_)                                                                              \
    const ab_section ab_section_##name_ = {                                                                                                \
        .title = title_, .help = help_, .example = example_, .keys = keys_, .count = COUNT(keys_), .more = more_}

/* RANGE adds the flag; ANY leaves a side open. */
#define ANY INFINITY
#define POSITIVE .flags = AB_KEY_RANGE | AB_KEY_MIN_OPEN, .min = 0, .max = INFINITY
#define POSITIVE_REQUIRED .flags = AB_KEY_REQUIRED | AB_KEY_RANGE | AB_KEY_MIN_OPEN, .min = 0, .max = INFINITY

#endif
