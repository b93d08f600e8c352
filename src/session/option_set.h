// SPDX-License-Identifier: MIT
/*
 * option_set.h - sets the value of an option
 *
 * Units:     as in command_line.h
 * Ownership: strings stay the caller's and must outlive the options
 * Threads:   main only
 * Errors:    a wrong value: the option, the value and the expected one
 */
#ifndef GLIM_OPTION_SET_H
#define GLIM_OPTION_SET_H

#include <stdbool.h>

#include "session/command_line.h"
#include "session/option_rules.h"

/* Option from the command line or a file, with its value. */
struct option_given {
    const struct option_rule *rule;
    char shown[512]; /* "-w", "--seed" or the place in a file, for messages */
    const char *value;
};

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
