// SPDX-License-Identifier: MIT
/*
 * stats_json.h - statistics of a render as one JSON object, and strings of JSON
 *
 * Units:     seconds, pixels, samples per pixel
 * Threads:   main only; strings any
 * Errors:    unwritable file; those of the stream, which its owner has to check
 */
#ifndef GLIM_STATS_JSON_H
#define GLIM_STATS_JSON_H

#include <stdbool.h>
#include <stdio.h>

#include "session/session.h"

/* ---- strings ---- */

/* Writes a JSON string with its quotes. Bytes that are not UTF-8, which JSON
 * cannot hold, become U+FFFD. Characters that print.h does not show are
 * escaped; they are never beyond U+FFFF. */
void json_write_string(FILE *to, const char *text);

/* ---- statistics ---- */

/* Checks before the render that the file can be written. */
bool stats_json_check(const char *path, struct error *err);

/* Writes the object to the file, or to standard output for "-". */
bool stats_json_write(const struct session *s, bool is_denoised,
                      const char *path, struct error *err);

#endif
