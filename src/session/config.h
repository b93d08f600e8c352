// SPDX-License-Identifier: MIT
/*
 * config.h - reads the user's configuration file: keys and default options
 *
 * The file is glim/config in the folder $XDG_CONFIG_HOME, or in ~/.config. Its
 * lines are `key ACTION KEY...`, `option NAME` and `option NAME VALUE`.
 *
 * Threads:   main only
 * Errors:    file:line, what was found and expected
 */
#ifndef GLIM_CONFIG_H
#define GLIM_CONFIG_H

#include <stdbool.h>

#include "session/command_line.h"

/* Sets the file's options in *o, after options_init(). It is not an error if
 * there is no file. */
bool config_read(struct options *o, struct error *err);

#endif
