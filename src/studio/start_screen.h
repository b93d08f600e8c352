// SPDX-License-Identifier: MIT
/*
 * start_screen.h - the screen of a program that was given no scene: the list of
 * scenes to open
 *
 * Ownership: the path that is returned is for free()
 * Threads:   main only
 * Errors:    there is no screen
 */
#ifndef GLIM_START_SCREEN_H
#define GLIM_START_SCREEN_H

#include "base/error.h"
#include "session/command_line.h"

/* Opens the terminal, lets the person choose a scene, and closes it. `message`
 * is in the last row (NULL: none): why a scene could not be read. *path is NULL
 * if the person leaves, with the status of the program. */
bool start_screen_run(const struct options *o, const char *message, char **path,
                      int *status, struct error *err);

#endif
