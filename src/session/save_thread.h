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

struct save_thread {
    struct background copying;
    /* set before the thread starts */
    struct film *film;
    struct develop how;
    struct image_metadata metadata;
    char *stem;
    const char *ending;
    /* owned by the thread until save_thread_finish() joins it */
    char *name;
    struct error error;
};

bool save_thread_init(struct save_thread *s, struct error *err);

/* Starts to save as STEM.ENDING or the next free name. ENDING is "png" or
 * another one of image_write.h. Returns false if another picture is being saved
 * or no thread can start. */
bool save_thread_begin(struct save_thread *s, struct film *film,
                       struct develop how,
                       const struct image_metadata *metadata, const char *stem,
                       const char *ending, struct error *err);

/* Blocks until the picture is written. Returns its name, for free(), or NULL
 * after a failure. */
char *save_thread_finish(struct save_thread *s, struct error *err);

void save_thread_free(struct save_thread *s);

#endif
