// SPDX-License-Identifier: MIT
/*
 * autosave_file.h - files of autosaved sessions, from which the next session of
 * a scene goes on, the folder of them, and the thread that writes them
 *
 * Units:     bytes, nanoseconds; ages in seconds
 * Ownership: autosave_file_free() frees; a zeroed struct is empty;
 *            autosave_writer_free() frees, after waiting for a file that is
 *            being written
 * Threads:   files and autosave_prune() any; the rest of the folder main only;
 *            the writer from one thread
 * Errors:    one line that begins with the path; those of the writer come from
 *            autosave_writer_finish()
 */
#ifndef GLIM_AUTOSAVE_FILE_H
#define GLIM_AUTOSAVE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/background.h"
#include "base/error.h"
#include "session/session.h"

/* ---- files ---- */

/*
 * The head of a file is text: a line for each key, in a fixed order, and a
 * checksum. It has the lengths of the parts that follow it. A checksum of its
 * own protects all parts but the film, which has checksums in it. The folder is
 * `sessions` in the user's state folder, with one file for each scene, named
 * after the hash of the scene's absolute path, and its last picture as PNG
 * beside it. Files are removed when they are
 * older than 30 days, and the oldest ones when all together have more than
 * 1 GiB.
 */

/* ---- files ---- */

/*
 * The head is text: a line for each key, in a fixed order, and a checksum. It
 * has the lengths of the parts that follow it. A checksum of its own protects
 * all parts but the film, which has checksums in it.
 */

enum autosave_part {
    AUTOSAVE_VIEW,      /* text of a view file */
    AUTOSAVE_MATERIALS, /* names of edited materials (autosave_edit.h) */
    AUTOSAVE_MTL,       /* their statements, MTL text */
    AUTOSAVE_HISTORY,   /* states before and after it (autosave_history.h) */
    AUTOSAVE_FILM,      /* bytes of a film file */
    AUTOSAVE_PARTS
};

struct autosave_file {
    char *scene;        /* absolute path */
    bool is_live;       /* the film is of live mode */
    bool has_edits;     /* materials, assignments or light were not saved */
    uint64_t render_ns; /* time of rendering of the film */
    /* the bytes that were read are no session; otherwise reading may succeed
     * later */
    bool is_damaged;
    /* for free(); NULL without a part, and after autosave_file_read_head() */
    char *parts[AUTOSAVE_PARTS];
    size_t sizes[AUTOSAVE_PARTS];
};

/* Returns the bytes of a file, for free(), or NULL if memory is out. */
char *autosave_file_bytes(const struct autosave_file *k, size_t *size_bytes);

/* Parses the bytes of a file, after which a NUL follows. The caller frees after
 * a failure, too. `path` is for messages. */
bool autosave_file_parse(struct autosave_file *k, const char *path,
                         const char *bytes, size_t size_bytes,
                         struct error *err);

/* Reads a file, or its head only. The caller frees after a failure, too. */
bool autosave_file_read(struct autosave_file *k, const char *path,
                        struct error *err);
bool autosave_file_read_head(struct autosave_file *k, const char *path,
                             struct error *err);

void autosave_file_free(struct autosave_file *k);

/* ---- the folder ---- */

/*
 * It is `sessions` in the user's state folder. Files are removed when they are
 * older than 30 days, and the oldest ones when all together have more than
 * 1 GiB.
 */

#define AUTOSAVE_DAYS_MAX  30
#define AUTOSAVE_BYTES_MAX ((uint64_t)1 << 30)

/* Size of the text of autosave_describe(). */
#define AUTOSAVE_TEXT_BYTES 96

/* Returns the absolute path of a scene, for free(), or NULL if it cannot be
 * found or cannot be in the head of a file. */
char *autosave_scene(const char *scene_path);

/* Returns the path of the file of a scene with this absolute path, for free(),
 * or NULL without a state folder. */
char *autosave_path(const char *scene);

/* The same for the last picture of a scene. */
char *autosave_path_picture(const char *scene);

/* Returns the path of a file of the same scene that is set aside, for free(),
 * or NULL. */
char *autosave_path_aside(const char *path);

/* Locks the file for this process, until the descriptor that is returned is
 * closed. Returns -1 if another process has it. */
int autosave_lock(const char *path);

/* Removes files that are too old, then the oldest above a size of all together.
 * Returns how many. */
int autosave_prune(const char *path, int days_max, uint64_t bytes_max);

/* Writes what a file has, such as "3 min 20 s of render and unsaved changes".
 */
void autosave_describe(char text[AUTOSAVE_TEXT_BYTES],
                       const struct autosave_file *k);

/* Removes what is too old or too much, and prints a line for each file, the
 * last one first. Fails without a state folder. */
bool autosave_print_list(FILE *to, struct error *err);

/* ---- the writer ---- */

/*
 * The thread first copies the film and hashes the world, neither of which may
 * change before that is complete. Screen and render do not wait for the rest. A
 * film whose bytes are too many is left out.
 */

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
