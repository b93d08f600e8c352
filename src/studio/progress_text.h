// SPDX-License-Identifier: MIT
/*
 * progress_text.h - the text of the progress panel: how far, how fast, how busy
 *
 * The number of lines and columns never changes, so that nothing jumps. Where
 * there is no Unicode the diagrams are made of ASCII.
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
#include "render/speeds.h"

#define PROGRESS_TEXT_COLS 36
#define PROGRESS_TEXT_ROWS 11

/* Characters of UTF-8 have three bytes here. */
#define PROGRESS_TEXT_BYTES (3 * PROGRESS_TEXT_COLS + 1)

struct progress_text_facts {
    const struct render_progress *progress;
    const struct speeds *speeds;
    const double *loads; /* of each thread, 0 to 1 */
    int load_count;      /* 0: a device renders */
    bool has_unicode;
};

void progress_text_format(char lines[PROGRESS_TEXT_ROWS][PROGRESS_TEXT_BYTES],
                          const struct progress_text_facts *facts);

/* A number in few characters: 950, 9.50 k, 12.3 M, 123 G. */
void progress_text_number(char *text, size_t size_bytes, double value);

#endif
