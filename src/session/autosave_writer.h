// SPDX-License-Identifier: MIT
/*
 * autosave_writer.h - writes the file of an autosaved session in a background
 * thread
 *
 * The thread first copies the film and hashes the world, neither of which may
 * change before that is complete. Screen and render do not wait for the rest. A
 * film whose bytes are too many is left out.
 *
 * Ownership: autosave_writer_free() frees, after waiting for a file that is
 *            being written
 * Threads:   all functions from one thread
 * Errors:    autosave_writer_finish() returns them
 */
#ifndef GLIM_AUTOSAVE_WRITER_H
#define GLIM_AUTOSAVE_WRITER_H

#include "base/background.h"
#include "session/autosave_file.h"
#include "session/session.h"

/* Size limits of a film's copy in memory and of its bytes in the file. */
#define AUTOSAVE_COPY_BYTES_MAX ((uint64_t)1 << 30)
#define AUTOSAVE_FILM_BYTES_MAX ((size_t)1 << 28)

struct autosave_writer {
    struct background copying;
    /* set before the thread starts */
    struct autosave_file kept; /* its film is made by the thread */
    const char *path;
    bool has_film;
    struct render *render;
    const char *kernels_path;
    struct world world;
    struct film_header header;
    struct film_range range;
    /* owned by the thread until autosave_writer_finish() joins it */
    bool is_film_left_out; /* since it is too large */
    bool is_written;
    struct error error;
};

bool autosave_writer_init(struct autosave_writer *w, struct error *err);

/* Starts to write a session, with the film of the render if has_film. Frees
 * `k`, at the end or after a failure. `path` is the caller's until the end.
 * Nothing is being written. */
bool autosave_writer_begin(struct autosave_writer *w, struct session *s,
                           struct autosave_file *k, const char *path,
                           bool has_film, struct error *err);

/* Blocks until the file is written. Returns false, with the error, if it, or
 * its film, is not. *is_film_left_out says that the film is too large. */
bool autosave_writer_finish(struct autosave_writer *w, bool *is_film_left_out,
                            struct error *err);

void autosave_writer_free(struct autosave_writer *w);

#endif
