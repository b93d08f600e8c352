// SPDX-License-Identifier: MIT
/*
 * option_table.h - table of all options, and the function that sets each
 *
 * Units:     as in command_line.h
 * Ownership: strings stay the caller's and must outlive the options
 * Threads:   main only
 * Errors:    a wrong value: the option, the value and the expected one
 */
#ifndef GLIM_OPTION_TABLE_H
#define GLIM_OPTION_TABLE_H

#include <stdbool.h>
#include <stddef.h>

#include "session/command_line.h"

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
    OPTION_SUN,
    OPTION_TURBIDITY,
    OPTION_THREADS,
    OPTION_BACKEND,
    OPTION_DEVICE,
    OPTION_LIST_DEVICES,
    OPTION_KERNELS,
    OPTION_ISA,
    OPTION_PROBE,
    OPTION_RANKS,
    OPTION_WORKER,
    OPTION_BATCH,
    OPTION_OUTPUT,
    OPTION_ANSI,
    OPTION_SHOW,
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
    OPTION_COLOR,
    OPTION_GLYPH,
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
    const char *value; /* the expected value, for messages; NULL: no value */
};

/* Returns true if the value may be missing. It then follows a = sign. */
static inline bool option_value_is_optional(const struct option_rule *rule)
{
    return rule->id == OPTION_DENOISE;
}

/* Option from the command line or a file, with its value. */
struct option_given {
    const struct option_rule *rule;
    char shown[512]; /* "-w", "--seed" or the place in a file, for messages */
    const char *value;
};

/* Returns the rule of the option of this name, without dashes; NULL if there is
 * none. */
const struct option_rule *option_rule_named(const char *name, size_t length);

/* Sets an option. The value must be present if the rule wants one and it is not
 * optional. */
bool option_set(struct options *o, const struct option_given *g,
                struct error *err);

/* Sets the scene, which is given without an option. */
bool option_set_scene(struct options *o, const char *path, struct error *err);

/* Returns a hint to append to a message about a wrong value: -h is the height
 * here, but help in other programs. "" if there is none. */
const char *option_hint(const struct option_given *g);

#endif
