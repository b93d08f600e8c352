// SPDX-License-Identifier: MIT
/*
 * view_light.h - the `light` lines of a view file
 *
 *     light point X Y Z intensity R G B radius R ies FILE
 *     light spot X Y Z at X Y Z intensity R G B inner A outer A radius R ies
 * FILE light directional AZ EL irradiance R G B angle A
 *
 * Units:     those of scene/lamp.h
 * Threads:   one thread at a time
 * Errors:    a malformed or impossible value: file:line; a file of IES
 */
#ifndef GLIM_VIEW_LIGHT_H
#define GLIM_VIEW_LIGHT_H

#include <stdio.h>

#include "read/view_parse.h"

/* Reads the rest of a line after the key `light` into the reader's view. */
bool view_light_read(struct view_reader *reader, struct error *err);

/* Writes a line for each lamp into the file at `path`. Values that equal their
 * default are left out. */
void view_lights_write(const struct lamps *lamps, const char *path, FILE *to);

#endif
