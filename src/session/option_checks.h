// SPDX-License-Identifier: MIT
/*
 * option_checks.h - refuses combinations of options
 *
 * Threads:   main only
 * Errors:    an option that another one excludes, or that needs another one
 */
#ifndef GLIM_OPTION_CHECKS_H
#define GLIM_OPTION_CHECKS_H

#include "session/command_line.h"

/* Refuses combinations of options, after all of them are set. */
bool options_check(const struct options *o, struct error *err);

/* Returns true for options that ask for something else than a render. */
bool options_need_no_scene(const struct options *o);

#endif
