// SPDX-License-Identifier: MIT
/*
 * stats_json.h - one JSON object about a render
 *
 * Units:     seconds, pixels, samples a pixel
 * Threads:   main only
 * Errors:    unwritable file
 */
#ifndef GLIM_STATS_JSON_H
#define GLIM_STATS_JSON_H

#include <stdbool.h>

#include "session/session.h"

/* Fails, early, where stats_json_write() could not write. */
bool stats_json_check(const char *path, struct error *err);

/* Writes to the file, or to standard output for "-". */
bool stats_json_write(const struct session *s, const char *path,
                      struct error *err);

#endif
