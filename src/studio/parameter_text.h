// SPDX-License-Identifier: MIT
/*
 * parameter_text.h - a knob that is set by what a person types
 *
 * Units:     those of MTL and view files
 * Threads:   one thread at a time
 * Errors:    a text that does not fit: what was expected
 */
#ifndef GLIM_PARAMETER_TEXT_H
#define GLIM_PARAMETER_TEXT_H

#include <stdbool.h>

#include "studio/parameter.h"

/* False for what has only some states, which are turned through. */
bool knob_takes_text(int id);

/* Gives the knob the value that the text says, as a step of the edit. */
bool knob_set_text(struct edit *edit, const struct parameter_target *target,
                   int id, const char *text, struct error *err);

#endif
