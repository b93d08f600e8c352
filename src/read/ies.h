// SPDX-License-Identifier: MIT
/*
 * ies.h - reads photometric files of lamps: IESNA LM-63 of 1986, 1991, 1995
 * and 2002
 *
 * A file has type C photometry and TILT=NONE. Its horizontal angles are those
 * of the full circle, or of a half, a quarter or none of it, which then repeat
 * by symmetry. Where it has no vertical angles the lamp is dark.
 *
 * Units:     candelas become radiance times area in metres, where radiance 1
 *            is DAYLIGHT_UNIT of world/light/daylight.h
 * Ownership: the profile is for profile_release()
 * Threads:   any
 * Errors:    a malformed or unsupported file: file:line, memory
 */
#ifndef GLIM_IES_H
#define GLIM_IES_H

#include <stddef.h>

#include "base/error.h"
#include "scene/lamp.h"

/* Parses the text of a file. Returns NULL if that fails. `path` is that of the
 * profile and in messages. */
struct profile *ies_parse(const char *text, size_t size_bytes, const char *path,
                          struct error *err);

/* Reads the file at `path`. */
struct profile *ies_read(const char *path, struct error *err);

#endif
