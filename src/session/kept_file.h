// SPDX-License-Identifier: MIT
/*
 * kept_file.h - files of kept sessions: the state of a scene that was open on
 * the screen, from which the next session goes on
 *
 * The head is text: a line for each key, in a fixed order, and a checksum. It
 * has the lengths of the parts that follow it. A checksum of its own protects
 * all parts but the film, which has checksums in it.
 *
 * Units:     bytes, nanoseconds
 * Ownership: kept_free() frees; a zeroed struct is empty
 * Threads:   any
 * Errors:    one line that begins with the path
 */
#ifndef GLIM_KEPT_FILE_H
#define GLIM_KEPT_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

enum kept_part {
    KEPT_VIEW,      /* text of a view file */
    KEPT_MATERIALS, /* names of edited materials (kept_edit.h) */
    KEPT_MTL,       /* their statements, MTL text */
    KEPT_HISTORY,   /* states before and after it (kept_history.h) */
    KEPT_FILM,      /* bytes of a film file */
    KEPT_PARTS
};

struct kept {
    char *scene;        /* absolute path */
    bool is_live;       /* the film is of live mode */
    bool has_edits;     /* materials, assignments or light were not saved */
    uint64_t render_ns; /* time of rendering of the film */
    /* for free(); NULL without a part, and after kept_read_head() */
    char *parts[KEPT_PARTS];
    size_t sizes[KEPT_PARTS];
};

/* Returns the bytes of a file, for free(), or NULL if memory is out. */
char *kept_bytes(const struct kept *k, size_t *size_bytes);

/* Parses the bytes of a file, after which a NUL follows. The caller frees after
 * a failure, too. `path` is for messages. */
bool kept_parse(struct kept *k, const char *path, const char *bytes,
                size_t size_bytes, struct error *err);

/* Reads a file, or its head only. The caller frees after a failure, too. */
bool kept_read(struct kept *k, const char *path, struct error *err);
bool kept_read_head(struct kept *k, const char *path, struct error *err);

void kept_free(struct kept *k);

#endif
