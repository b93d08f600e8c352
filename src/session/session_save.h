// SPDX-License-Identifier: MIT
/*
 * session_save.h - writes what a session has changed: pictures by a background
 * thread, materials, assignments, light and view into their files
 *
 * The thread first copies the film, which must not be cleared before. Neither
 * the screen nor the renderer waits for the rest.
 *
 * Units:     samples per pixel
 * Ownership: save_thread_free() frees, after waiting for a running save
 * Threads:   main only
 * Errors:    files that cannot be written, or that another program has changed;
 *            save_thread_finish() returns those of a picture
 */
#ifndef GLIM_SESSION_SAVE_H
#define GLIM_SESSION_SAVE_H

#include <stdbool.h>

#include "base/background.h"
#include "film/film_file.h"
#include "image/image_metadata.h"
#include "session/session.h"

/* ---- pictures ---- */

/* A picture to be saved as stem.ending or the next free name: a film, a frame
 * or a text. */
struct picture_to_save {
    struct film *film;
    struct frame frame; /* in place of the film; the thread frees it */
    char *text;         /* in place of both; the thread frees it */
    size_t text_bytes;
    /* the film is filtered as PNG: the world, with its tree, for the draft; its
     * camera has the film's pixels */
    bool is_filtered;
    struct world world;
    struct develop how;
    struct image_metadata metadata, filtered_metadata;
    /* of which the thread adds hashes to the metadata; without positions in
     * `identified` there are none */
    struct film_identity identity;
    struct world identified;
    const char *kernels_path;
    const char *stem;
    const char *ending; /* "png" or another one of image_write.h */
};

struct save_thread {
    struct background copying;
    /* set before the thread starts */
    struct picture_to_save picture;
    char *stem; /* of the picture, owned */
    struct cancel cancel;
    /* owned by the thread until save_thread_finish() joins it */
    char *name;
    bool was_filtered;
    struct error error;
};

bool save_thread_init(struct save_thread *s, struct error *err);

/* Starts to save. The film lives until it is copied. Returns false if another
 * picture is being saved or no thread can start. */
bool save_thread_begin(struct save_thread *s, const struct picture_to_save *p,
                       struct error *err);

/* Blocks until film and world may change. A picture that is not filtered by
 * then is saved with its noise. */
void save_thread_wait_copied(struct save_thread *s);

/* Blocks until the picture is written. Returns its name, for free(), or NULL
 * after a failure. */
char *save_thread_finish(struct save_thread *s, struct error *err);

void save_thread_free(struct save_thread *s);

/* ---- edits ---- */

/* Writes changed materials into their MTL files. If assignments or light have
 * changed, writes them into the view file, whose other values stay. Tells the
 * watch of both. *what is a line about the files, for free(). After an error,
 * files that were already written count as saved. */
bool session_save_edit(struct session *s, struct file_watch *watch, char **what,
                       struct error *err);

/* Returns what session_save_edit() would write, for free(), or NULL if nothing
 * has changed: "2 materials to room.mtl, room.view". */
char *session_unsaved(struct session *s);

/* Makes the view that would be saved now, for view_free(), with the size and
 * the bounces of this run. Materials that objects are given keep their order in
 * the saved view. */
void session_view_to_save(const struct session *s, struct view *view);

/* Writes view and light into the view file. Size and bounces stay those of the
 * file, since the command line sets them for one run. */
bool session_save_view(struct session *s, struct file_change *change,
                       struct error *err);

#endif
