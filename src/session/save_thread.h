// SPDX-License-Identifier: MIT
/*
 * save_thread.h - saves pictures in a background thread
 *
 * The thread first copies the film, which must not be cleared before the copy
 * is complete. Neither the screen nor the renderer waits for the rest.
 *
 * Units:     samples per pixel
 * Ownership: save_thread_free() frees, after waiting for a running save
 * Threads:   all functions from one thread
 * Errors:    save_thread_finish() returns them with the result
 */
#ifndef GLIM_SAVE_THREAD_H
#define GLIM_SAVE_THREAD_H

#include "base/background.h"
#include "film/film.h"
#include "image/image_metadata.h"

/* A picture to be saved as stem.ending or the next free name. */
struct picture_to_save {
    struct film *film;
    struct develop how;
    struct image_metadata metadata;
    const char *stem;
    const char *ending; /* "png" or another one of image_write.h */
};

struct save_thread {
    struct background copying;
    /* set before the thread starts */
    struct picture_to_save picture;
    char *stem; /* of the picture, owned */
    /* owned by the thread until save_thread_finish() joins it */
    char *name;
    struct error error;
};

bool save_thread_init(struct save_thread *s, struct error *err);

/* Starts to save. The film lives until it is copied. Returns false if another
 * picture is being saved or no thread can start. */
bool save_thread_begin(struct save_thread *s, const struct picture_to_save *p,
                       struct error *err);

/* Blocks until the picture is written. Returns its name, for free(), or NULL
 * after a failure. */
char *save_thread_finish(struct save_thread *s, struct error *err);

void save_thread_free(struct save_thread *s);

#endif
