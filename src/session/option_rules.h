// SPDX-License-Identifier: MIT
/*
 * option_rules.h - table of all options: names, values, the text of --help
 *
 * Ownership: strings live as long as the program
 * Threads:   any
 */
#ifndef GLIM_OPTION_RULES_H
#define GLIM_OPTION_RULES_H

#include <stdbool.h>
#include <stddef.h>

enum option_id {
    OPTION_SCENE,
    OPTION_VIEW,
    OPTION_WIDTH,
    OPTION_HEIGHT,
    OPTION_SPP,
    OPTION_ERROR,
    OPTION_ADAPTIVE,
    OPTION_NO_ADAPTIVE,
    OPTION_TIME,
    OPTION_BOUNCES,
    OPTION_SEED,
    OPTION_CROP,
    OPTION_UP,
    OPTION_EYE,
    OPTION_AT,
    OPTION_FOV,
    OPTION_CAMERA,
    OPTION_SCENE_PART,
    OPTION_VARIANT,
    OPTION_ANIMATION,
    OPTION_ANIM_TIME,
    OPTION_SKY,
    OPTION_SKY_STRENGTH,
    OPTION_SKY_ROTATION,
    OPTION_FORMATS,
    OPTION_SUN,
    OPTION_TURBIDITY,
    OPTION_THREADS,
    OPTION_BACKEND,
    OPTION_DEVICE,
    OPTION_LIST_DEVICES,
    OPTION_KERNELS,
    OPTION_ISA,
    OPTION_PROBE,
    OPTION_IMPORT,
    OPTION_UNPACK,
    OPTION_RANKS,
    OPTION_WORKER,
    OPTION_BATCH,
    OPTION_OUTPUT,
    OPTION_TURNTABLE,
    OPTION_FLY,
    OPTION_FRAMES,
    OPTION_FPS,
    OPTION_ANSI,
    OPTION_SHOW,
    OPTION_AOV,
    OPTION_DENOISE,
    OPTION_STATS,
    OPTION_ERROR_MAP,
    OPTION_FILM,
    OPTION_CHECKPOINT,
    OPTION_CHECKPOINT_INTERVAL,
    OPTION_RESUME,
    OPTION_SHARE,
    OPTION_EXPOSURE,
    OPTION_TONE,
    OPTION_LIGHT_UNIT,
    OPTION_COLOR,
    OPTION_GLYPH,
    OPTION_THEME,
    OPTION_CELL_ASPECT,
    OPTION_FILTER,
    OPTION_NO_FILTER,
    OPTION_WATCH,
    OPTION_PHOE_KEYS,
    OPTION_SESSIONS,
    OPTION_CSV,
    OPTION_SEEDS,
    OPTION_TILES,
    OPTION_FALSE_ALARMS,
    OPTION_HELP,
    OPTION_VERSION
};

struct option_rule {
    const char *name; /* without dashes; one letter is a short option */
    enum option_id id;
    const char *value;    /* the expected value, for messages; NULL: no value */
    const char *argument; /* the value in --help; NULL: none */
    const char *help;     /* NULL: not for people */
};

/* Options under one title of --help. */
struct option_section {
    const char *title;
    const struct option_rule *rules;
    size_t rule_count;
};

/* All options; the section after the last has no title. */
extern const struct option_section option_sections[];

/* Returns true if the value may be missing. It then follows a = sign. */
static inline bool option_value_is_optional(const struct option_rule *rule)
{
    return rule->id == OPTION_DENOISE;
}

/* Returns the rule of the option of this name, without dashes; NULL if there is
 * none. */
const struct option_rule *option_rule_named(const char *name, size_t length);

#endif
