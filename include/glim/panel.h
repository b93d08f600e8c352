// SPDX-License-Identifier: MIT
/*
 * panel.h - the text of the progress panel: how far, how fast, how busy
 *
 * The number of lines and columns never changes, so that nothing jumps. Where
 * there is no Unicode the diagrams are made of ASCII.
 *
 * Units:     terminal columns
 * Ownership: text goes to the caller's memory
 * Threads:   any
 * Errors:    none
 */
#ifndef GLIM_PANEL_H
#define GLIM_PANEL_H

#include "glim/render.h"
#include "glim/speeds.h"

#define PANEL_COLS 36
#define PANEL_ROWS 11

/* Characters of UTF-8 have three bytes here. */
#define PANEL_BYTES (3 * PANEL_COLS + 1)

struct panel_facts {
    const struct render_progress *progress;
    const struct speeds *speeds;
    const double *loads; /* of each thread, 0 to 1 */
    int load_count;      /* 0: a device renders */
    bool has_unicode;
};

void panel_format(char lines[PANEL_ROWS][PANEL_BYTES],
                  const struct panel_facts *facts);

/* A number in few characters: 950, 9.50 k, 12.3 M, 123 G. */
void panel_number(char *text, size_t size_bytes, double value);

#endif
