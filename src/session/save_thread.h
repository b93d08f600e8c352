// SPDX-License-Identifier: MIT
/*
 * save_thread.h - saves pictures in a thread of its own
 *
 * The thread copies the film first. Until then the film must not be cleared;
 * after that neither the screen nor the render waits for it.
 *
 * Units:     samples a pixel
 * Ownership: saver_free() frees; waits for a picture that is being written
 * Threads:   all functions from one thread
 * Errors:    with the result, by saver_finish()
 */
#ifndef GLIM_SAVE_THREAD_H
#define GLIM_SAVE_THREAD_H

#include <pthread.h>

#include "picture/film.h"

struct saver {
    int event_fd; /* readable when a picture is done */
    bool is_busy; /* between saver_begin() and saver_finish() */
    pthread_t thread;
    /* set before the thread starts */
    struct film *film;
    struct develop how;
    char *stem;
    const char *ending;
    /* guarded by lock */
    pthread_mutex_t lock;
    pthread_cond_t copied;
    bool has_copied;
    /* the thread's until saver_finish() joins it */
    char *name;
    struct error error;
};

bool saver_init(struct saver *s, struct error *err);

/* Begins to save as STEM.ENDING, "png" or another one of image_write.h, or the next
 * free name. False if another picture is being saved, or no thread can start.
 */
bool saver_begin(struct saver *s, struct film *film, struct develop how,
                 const char *stem, const char *ending, struct error *err);

/* Blocks until the film may be cleared: some milliseconds at most for pictures
 * of common sizes. */
void saver_wait_copied(struct saver *s);

/* Blocks until the picture is written. The name is for free(); NULL: failed. */
char *saver_finish(struct saver *s, struct error *err);

void saver_free(struct saver *s);

#endif
