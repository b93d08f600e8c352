// SPDX-License-Identifier: MIT
/*
 * batch_progress.h - how commands without a screen render: the scene and the
 * device that the options name, the wait for the end with a progress bar, the
 * signals that stop it, and the last line
 *
 * Threads:   main only
 * Errors:    files that cannot be written; no event descriptor for the signals
 */
#ifndef GLIM_BATCH_PROGRESS_H
#define GLIM_BATCH_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

#include "session/frame_series.h"
#include "session/session_film.h"

/* Opens the session and prints its warnings. The caller closes it also after an
 * error. */
bool batch_open(struct session *s, const struct options *o, uint64_t start_ns,
                struct error *err);

/* Starts the device that the options select, if any. A device that was named
 * must work. If auto finds no GPU, that is not reported. */
bool batch_use_device(struct session *s, struct error *err);

/* Checks that the picture can be written to the file, or if `path` is NULL to a
 * new file in the current folder. */
bool batch_check_picture(const char *path, struct error *err);

/* Lets SIGINT, SIGTERM and SIGHUP stop renders, unless they are ignored. */
bool batch_catch_signals(struct error *err);

/* The first of these signals; 0: none has come. */
int batch_stop_signal(void);

/* What is shown and done while a picture renders. */
struct batch_bar {
    bool is_wanted; /* standard error is a terminal */
    int shown_cols;
    const struct frame_series *series; /* of the picture; NULL: none */
    struct session_film *film;         /* checkpoints of it; NULL: none */
    bool has_failed;                   /* a checkpoint did, and it was said */
};

struct batch_bar batch_bar_begin(void);

/* Waits until a limit is reached, the render fails or a signal arrives, and
 * halts. */
struct render_progress batch_wait(struct session *s, struct batch_bar *bar);

/* Says that a signal came before the first sample, so that nothing was written.
 * Fails if it was no signal but the limit of time. */
bool batch_say_empty(struct error *err);

/* Says what was written to `name`: which limit of the options ended the render,
 * and the error of the picture. */
void batch_say_result(const char *name, const struct session *s,
                      const struct render_progress *p);

/* Says that a picture of its own is filtered, or that one cannot be. */
void batch_say_filtered(const char *name);
void batch_warn_unfiltered(void);

/* Says how many samples were black or cut, which the two counters tell. */
void batch_warn_of_samples(uint64_t non_finite, uint64_t saturated);

/* Says how many pictures of a series were written since begin_ns, and which
 * signal stopped it. */
void batch_say_frames(int done, int count, uint64_t begin_ns);

/* Says that the CPU renders because of the error. */
void batch_warn_of_device(const char *text);

#endif
