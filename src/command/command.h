// SPDX-License-Identifier: MIT
/*
 * command.h - the commands without a screen, which main.c chooses
 *
 * *status becomes the exit status of a success: 0, what the command says, or
 * 128 + signal after the output so far. start_ns is the time of the program's
 * start.
 *
 * Ownership: options and session stay the caller's
 * Threads:   main only
 * Errors:    unreadable scenes, pictures and films, unwritable outputs, memory,
 *            a failing device
 */
#ifndef GLIM_COMMAND_H
#define GLIM_COMMAND_H

#include <stdbool.h>

#include "image/image_read.h"
#include "session/session.h"

/* ---- a picture ---- */

/* Renders, shows progress on stderr if that is a terminal, writes the picture
 * and the statistics. *status becomes 0, or 128 + signal after saving the
 * picture so far. */
bool batch_run(struct session *s, int *status, struct error *err);

/* ---- the path of a sample ---- */

/* Prints the path of the sample of --trace. */
bool batch_trace_run(struct session *s, struct error *err);

/* ---- glim curve ---- */

/* Measures and prints. *status becomes 0, or 128 + signal after the output of
 * the points measured before it. */
bool batch_curve_run(const struct options *o, uint64_t start_ns, int *status,
                     struct error *err);

/* ---- glim reference ---- */

/* Renders and writes. *status becomes 0, or 128 + signal after the output of
 * the seeds that were complete. start_ns is that of the program. */
bool batch_reference_run(const struct options *o, uint64_t start_ns,
                         int *status, struct error *err);

/* ---- glim info, merge, develop ---- */

/* Prints what each film is of. */
bool batch_films_info(const struct options *o, struct error *err);

/* Joins the films and writes a film or a picture. start_ns is that of the
 * program. */
bool batch_films_merge(const struct options *o, uint64_t start_ns,
                       struct error *err);

/* ---- glim compare ---- */

/* Compares and prints. *status becomes 0 if the pictures differ by noise alone,
 * 1 if a tile differs by more. */
bool batch_compare_run(const struct options *o, int *status, struct error *err);

/* Reads a picture as linear floats, and warns of values that were clamped.
 * held_bytes are those of other pictures. */
bool batch_compare_read(struct image *image, const char *path,
                        uint64_t held_bytes, struct error *err);

#endif
