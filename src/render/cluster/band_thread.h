// SPDX-License-Identifier: MIT
/*
 * band_thread.h - a thread that renders bands, while its owner serves messages
 *
 * Ownership: band_thread_destroy() frees; bands and what they are rendered from
 *            are borrowed until the band is done
 * Threads:   all functions from one thread
 * Errors:    no thread; those of the band
 */
#ifndef GLIM_BAND_THREAD_H
#define GLIM_BAND_THREAD_H

#include "render/cluster/band.h"

struct band_thread;

/* A band and what it is rendered from. */
struct band_work {
    struct band *band;
    struct backend *backend;
    struct backend_picture whole; /* its film is not used */
    uint64_t first_sample;
    const struct cancel *cancel;
};

struct band_thread *band_thread_create(struct error *err);

/* Starts to render. The thread is idle. */
void band_thread_begin(struct band_thread *t, const struct band_work *work);

/* Returns the band once after it is done, with its result; NULL before. */
struct band *band_thread_end(struct band_thread *t, enum pass_result *result,
                             struct error *err);

/* Returns true between begin and end. */
bool band_thread_is_busy(const struct band_thread *t);

/* Sleeps for this time, or until a band in progress is done. */
void band_thread_wait(struct band_thread *t, long timeout_ns);

/* Waits for the band in progress, if any. */
void band_thread_destroy(struct band_thread *t);

#endif
