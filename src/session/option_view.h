// SPDX-License-Identifier: MIT
/*
 * option_view.h - options with values of the view: they become lines of a view
 * file, which go over those of the scene's
 *
 * Units:     those of view files
 * Ownership: the lines are the options'
 * Threads:   main only
 * Errors:    a wrong value: the option, the value and the expected one
 */
#ifndef GLIM_OPTION_VIEW_H
#define GLIM_OPTION_VIEW_H

#include "session/option_set.h"

/* Sets an option of the camera, the sky or the exposure. */
bool option_view_set(struct options *o, const struct option_given *g,
                     struct error *err);

/* Adds a line. */
void option_view_add(struct options *o, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
