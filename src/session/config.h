// SPDX-License-Identifier: MIT
/*
 * config.h - the person's configuration file: keys, and what options are if
 * they are not given
 *
 * glim/config in the folder of XDG_CONFIG_HOME, or in ~/.config. Lines are
 * `key ACTION KEY...`, `option NAME` and `option NAME VALUE`.
 *
 * Ownership: nothing of the file's text is kept
 * Threads:   main only
 * Errors:    what is wrong in the file: file:line
 */
#ifndef GLIM_CONFIG_H
#define GLIM_CONFIG_H

#include <stdbool.h>

#include "session/command_line.h"

/* Sets what the file says in *o, which has been through options_init(). No
 * file is fine. */
bool config_read(struct options *o, struct error *err);

#endif
