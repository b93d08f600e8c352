// SPDX-License-Identifier: MIT
/*
 * import.h - formats that glim has no reader for, read by libassimp
 *
 * libassimp crashes or hangs on some files, so a copy of the program reads the
 * file (import_child.h) and sends the scene (import_stream.h). Time and memory
 * of the copy are limited.
 *
 * Ownership: everything belongs to the scene
 * Threads:   one for each scene
 * Errors:    no libassimp; its own messages; a crash, a limit
 */
#ifndef GLIM_IMPORT_H
#define GLIM_IMPORT_H

#include "scene/scene.h"

/* Endings of the names of such files, separated by blanks. */
extern const char import_endings[];

/* Reads the file `path`; its bytes do not matter. scene->program is the program
 * that the copy runs. */
bool import_parse(struct scene *scene, const char *bytes, size_t size_bytes,
                  const char *path, struct warnings *report, struct error *err);

/* Returns NULL if the formats can be read, else what is missing. */
const char *import_missing(void);

#endif
