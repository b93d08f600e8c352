// SPDX-License-Identifier: MIT
/*
 * text_stream.h - a stream that writes to memory
 *
 * open_memstream() of glibc drops what it has no memory for, and neither
 * ferror() nor fclose() tells: half a file of materials would replace a whole
 * one.
 *
 * Ownership: text_stream_close() frees the stream and returns memory for free()
 * Threads:   one at a time
 * Errors:    out of memory; those of file_write()
 */
#ifndef GLIM_TEXT_STREAM_H
#define GLIM_TEXT_STREAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/error.h"

/* Stays where it is while the stream is open. */
struct text_stream {
    FILE *to; /* NULL: it could not be opened */
    void *text;
    size_t size_bytes, capacity;
    bool lacks_memory;
};

/* Opens a stream. Returns false without memory. */
bool text_stream_open(struct text_stream *s);

/* Closes the stream, if it is open. Returns what was written, with a zero
 * behind it that does not count, or NULL without memory. */
char *text_stream_close(struct text_stream *s, size_t *size_bytes);

/* Closes the stream, if it is open, and writes what it has to a file. */
bool text_stream_write(struct text_stream *s, const char *path,
                       struct error *err);

#endif
