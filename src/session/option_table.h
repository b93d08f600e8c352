// SPDX-License-Identifier: MIT
/*
 * option_table.h - the options one by one: names, what stands behind them, and
 * what that sets
 *
 * Units:     as command_line.h
 * Ownership: strings stay the caller's, and outlive the options
 * Threads:   main only
 * Errors:    a wrong value: which option has it, and what was expected
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
    OPTION_BOUNCES,
    OPTION_SEED,
    OPTION_CROP,
    OPTION_UP,
    OPTION_THREADS,
    OPTION_BACKEND,
    OPTION_DEVICE,
    OPTION_LIST_DEVICES,
    OPTION_KERNELS,
    OPTION_ISA,
    OPTION_PROBE,
    OPTION_BATCH,
    OPTION_OUTPUT,
    OPTION_ANSI,
    OPTION_SHOW,
    OPTION_STATS,
    OPTION_COLOR,
    OPTION_GLYPH,
    OPTION_CELL_ASPECT,
    OPTION_WATCH,
    OPTION_PHOE_KEYS,
    OPTION_HELP,
    OPTION_VERSION
};

struct option_rule {
    const char *name; /* as it is typed: one letter is a short option */
    enum option_id id;
    const char *value; /* what is expected behind it; NULL: nothing */
};

/* An option as it stands on the command line or in a file. */
struct option_given {
    const struct option_rule *rule;
    char shown[512]; /* "-w" or "--seed" or its place, for messages */
    const char *value;
};

/* NULL: there is none of this name, which is without dashes. */
const struct option_rule *option_rule_named(const char *name, size_t length);

/* Takes an option whose value is there if the rule wants one. */
bool option_set(struct options *o, const struct option_given *g,
                struct error *err);

/* A scene that was named without its option. */
bool option_set_scene(struct options *o, const char *path, struct error *err);

/* What may be said behind a message about the value: -h asks for help
 * elsewhere. "" is nothing. */
const char *option_hint(const struct option_given *g);

#endif
