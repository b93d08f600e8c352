// SPDX-License-Identifier: MIT
/*
 * progress_text.h - the text of the progress panel: samples, noise, speed, load
 * of the threads, ranks of a cluster
 *
 * The number of columns is constant, and that of lines depends on the number of
 * ranks alone, so that the text stays in place.
 * The diagrams use Unicode, or ASCII where the terminal has no Unicode.
 *
 * Units:     terminal columns
 * Ownership: text goes to the caller's memory
 * Threads:   any
 */
#ifndef GLIM_PROGRESS_TEXT_H
#define GLIM_PROGRESS_TEXT_H

#include <stdbool.h>
#include <stddef.h>

#include "render/render_loop.h"
#include "studio/plots.h"

#define PROGRESS_TEXT_COLS PLOT_COLS

/* Ranks that have a line: the late ones first, then the slow ones. */
#define PROGRESS_TEXT_RANKS 8

/* Lines of one process with the errors, and most lines, with those of ranks and
 * their title. */
#define PROGRESS_TEXT_USUAL_ROWS (12 + 5)
#define PROGRESS_TEXT_ROWS       (PROGRESS_TEXT_USUAL_ROWS + 1 + PROGRESS_TEXT_RANKS)

/* Size of a line: characters of the diagrams take three bytes in UTF-8. */
#define PROGRESS_TEXT_BYTES PLOT_BYTES

struct progress_text_facts {
    const struct render_progress *progress;
    const struct speeds *speeds;
    const struct error_history *errors;
    const double *loads; /* load of each thread, from 0 to 1 */
    int load_count;      /* 0 if an OpenCL device renders */
    bool has_unicode;
    const struct rank_progress *ranks;
    int rank_count; /* 0 without a cluster */
};

/* Line of the gauge, which the text leaves blank. */
#define PROGRESS_TEXT_GAUGE 1

/* Returns the number of lines. */
int progress_text_format(char lines[PROGRESS_TEXT_ROWS][PROGRESS_TEXT_BYTES],
                         const struct progress_text_facts *facts);

/* Formats a number with three digits and a unit: 950, 9.50 k, 12.3 M, 123 G. */
void progress_text_number(char *text, size_t size_bytes, double value);

#endif
