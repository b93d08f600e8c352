// SPDX-License-Identifier: MIT
/*
 * batch_progress.h - the check of a batch render's output file, the signals
 * that stop it, its progress bar and its last line
 *
 * Threads:   main only
 * Errors:    files that cannot be written; no event descriptor for the signals
 */
#ifndef GLIM_BATCH_PROGRESS_H
#define GLIM_BATCH_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

#include "glim/glim.h"

#include "base/error.h"
#include "session/command_line.h"

/* The bar is drawn this often, which also bounds what a slow link gets. */
#define BATCH_DRAW_MS 100

/* Checks that the picture can be written to the file, or if `path` is NULL to a
 * new file in the current folder. */
bool batch_check_picture(const char *path, struct error *err);

/* Lets SIGINT, SIGTERM and SIGHUP stop the render, unless they are ignored:
 * they cancel the handle, if there is one, and make *wake_fd readable. */
bool batch_catch_signals(struct glim *g, int *wake_fd, struct error *err);

/* The first of these signals; 0: none has come. */
int batch_stop_signal(void);

struct batch_bar {
    bool is_wanted; /* standard error is a terminal */
    int shown_cols;
    char of[32];     /* which picture of several it is, or "" */
    double before_s; /* time of the pictures before */
};

struct batch_bar batch_bar_begin(void);
void batch_bar_draw(struct batch_bar *bar, const struct glim_progress *p);
void batch_bar_erase(struct batch_bar *bar);

/* Says that a signal came before the first sample, so that nothing was written.
 * Fails if it was no signal but the limit of time. */
bool batch_say_empty(struct error *err);

/* Says what was written to `name`: which limit of the options ended the render,
 * and the error of the picture. start_ns is that of the program. */
void batch_say_result(const char *name, int width, int height,
                      const struct glim_progress *p, const struct options *o,
                      uint64_t start_ns);

/* Says how many samples were black or cut, which the two counters tell. */
void batch_warn_of_samples(uint64_t non_finite, uint64_t saturated);

/* Says how many pictures of a series were written since begin_ns, and which
 * signal stopped it. */
void batch_say_frames(int done, int count, uint64_t begin_ns);

/* Says that the CPU renders because of the error. */
void batch_warn_of_device(const char *text);

#endif
