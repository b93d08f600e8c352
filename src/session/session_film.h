// SPDX-License-Identifier: MIT
/*
 * session_film.h - film files of a session: written while it renders and at its
 * end, and read to go on
 *
 * A checkpoint is written by a thread of its own, so that the render never
 * waits for a slow disk. After a failure, such as a full disk, the last good
 * file stays, and the next one is tried when its time comes.
 *
 * Units:     samples per pixel, nanoseconds
 * Ownership: session_film_end() joins the thread and frees
 * Threads:   main only
 * Errors:    files of other pictures, by what differs; files that cannot be
 *            written
 */
#ifndef GLIM_SESSION_FILM_H
#define GLIM_SESSION_FILM_H

#include "session/session.h"

struct session_film {
    struct session *session;
    struct film_identity identity; /* of the picture */
    uint64_t first_sample;         /* index */
    struct film_file from;         /* of --resume */
    /* keep the names of --checkpoint and --film locked; or -1 */
    int lock_fds[2];
    pthread_t thread;
    bool has_thread;
    pthread_mutex_t lock;
    pthread_cond_t end;
    /* guarded by lock */
    bool is_ending;
    bool has_error; /* error is of the last checkpoint, and not taken yet */
    struct error error;
};

/* Sets the range of samples of --share, and finds what decides the samples of
 * the session if a film is read or written. Fails if another program writes the
 * file of --checkpoint. */
bool session_film_begin(struct session_film *f, struct session *s,
                        struct error *err);

/* Reads the film of --resume, to go on from, which must be of the picture that
 * the session renders. *from is NULL if there is none. */
bool session_film_resume(struct session_film *f, struct film_file **from,
                         struct error *err);

/* Starts the thread that writes the file of --checkpoint every interval.
 * Signals stay blocked in it. */
bool session_film_watch(struct session_film *f, struct error *err);

/* Takes the error of a checkpoint that could not be written. Returns false if
 * there is no new one. */
bool session_film_failed(struct session_film *f, struct error *err);

/* Stops the thread, after a file that it is writing. */
void session_film_stop(struct session_film *f);

/* Writes the files of --checkpoint and --film as the film is now, each even if
 * the other one fails. The render is halted. */
bool session_film_write(struct session_film *f, struct error *err);

/* Returns the index of the first sample of the options' share. */
uint64_t session_film_first(const struct options *o);

/* Returns the limits of the options, of the share's samples. */
struct render_limits session_film_limits(const struct options *o);

void session_film_end(struct session_film *f);

#endif
