// SPDX-License-Identifier: MIT
/*
 * save_thread.h - saves pictures in a thread of its own
 *
 * The thread copies the film first. Until then the film must not be cleared;
 * after that neither the screen nor the render waits for it.
 *
 * Units:     samples a pixel
 * Ownership: save_thread_free() frees; waits for a picture that is being
 * written Threads:   all functions from one thread Errors:    with the result,
 * by save_thread_finish()
 */
#ifndef GLIM_SAVE_THREAD_H
#define GLIM_SAVE_THREAD_H

#include <pthread.h>
#include <stdbool.h>

#include "picture/film.h"

struct save_thread {
    int event_fd; /* readable when a picture is done */
    bool is_busy; /* between save_thread_begin() and save_thread_finish() */
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
    /* the thread's until save_thread_finish() joins it */
    char *name;
    struct error error;
};

bool save_thread_init(struct save_thread *s, struct error *err);

/* Begins to save as STEM.ENDING, "png" or another one of image_write.h, or the
 * next free name. False if another picture is being saved, or no thread can
 * start.
 */
bool save_thread_begin(struct save_thread *s, struct film *film,
                       struct develop how, const char *stem, const char *ending,
                       struct error *err);

/* Blocks until the film may be cleared: some milliseconds at most for pictures
 * of common sizes. */
void save_thread_wait_copied(struct save_thread *s);

/* Blocks until the picture is written. The name is for free(); NULL: failed. */
char *save_thread_finish(struct save_thread *s, struct error *err);

void save_thread_free(struct save_thread *s);

#endif
