// SPDX-License-Identifier: MIT
/*
 * stats_json.h - statistics of a render as one JSON object
 *
 * Units:     seconds, pixels, samples per pixel
 * Threads:   main only
 * Errors:    unwritable file
 */
#ifndef GLIM_STATS_JSON_H
#define GLIM_STATS_JSON_H

#include <stdbool.h>

#include "session/session.h"

/* Checks before the render that the file can be written. */
bool stats_json_check(const char *path, struct error *err);

/* Writes the object to the file, or to standard output for "-". */
bool stats_json_write(const struct session *s, bool is_denoised,
                      const char *path, struct error *err);

#endif
