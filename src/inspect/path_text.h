// SPDX-License-Identifier: MIT
/*
 * path_text.h - the path of a sample as a table of text: a line for each
 * vertex, with the light that is added there in lines below it
 *
 * Units:     places and distances in the scene's units, radiance
 * Threads:   one at a time
 * Errors:    those of the stream
 */
#ifndef GLIM_PATH_TEXT_H
#define GLIM_PATH_TEXT_H

#include <stdio.h>

#include "inspect/overlay.h"

/* Prints the path of a sample of a world with its tree, and returns its
 * radiance. */
struct vec3 path_text_print(FILE *to, const struct scene *scene,
                            const struct overlay_names *names,
                            struct sample_id id);

/* Prints a line of light with all its digits: equal bits have equal texts. */
void path_text_light(FILE *to, const char *name, struct vec3 light);

#endif
