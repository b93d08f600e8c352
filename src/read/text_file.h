// SPDX-License-Identifier: MIT
/*
 * text_file.h - reads the text files of a scene, also those that gzip has
 * packed, and standard input
 *
 * Units:     bytes
 * Ownership: the text is for free()
 * Threads:   one thread reads standard input
 * Errors:    a file that cannot be read, that is broken, or that is too large
 *            for the memory
 */
#ifndef GLIM_TEXT_FILE_H
#define GLIM_TEXT_FILE_H

#include "base/file.h"

/* Reads the whole file, as file_read() does, or standard input for "-", and
 * unpacks it if it begins as gzip's files do, whatever its name is. */
bool text_file_read(const char *path, char **text, size_t *size_bytes,
                    struct error *err);

/* Unpacks the bytes of a file of gzip; `path` is for messages. A text with a
 * NUL behind it, which is not counted. */
bool text_file_unpack(const char *path, const char *packed, size_t packed_bytes,
                      char **text, size_t *size_bytes, struct error *err);

#endif
