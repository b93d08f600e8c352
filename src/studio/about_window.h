// SPDX-License-Identifier: MIT
/*
 * about_window.h - a window over the picture with what is known of the render:
 * its device, size, samples, rays, noise, times, and the ranks of a cluster
 *
 * The number of columns is constant, and that of lines depends on the number of
 * ranks alone, so that the text stays in place.
 *
 * Units:     terminal columns; nanoseconds
 * Threads:   any for texts, main only for the window
 */
#ifndef GLIM_ABOUT_WINDOW_H
#define GLIM_ABOUT_WINDOW_H

#include <stddef.h>

#include "session/live_render.h"
#include "terminal/screen.h"

#define ABOUT_COLS  40
#define ABOUT_BYTES (4 * ABOUT_COLS + 1) /* of UTF-8 */

/* Ranks that have a line: the late ones first, then the slow ones. */
#define ABOUT_RANKS 8

/* Lines of one process, and most lines, with those of ranks and their title. */
#define ABOUT_USUAL_ROWS 7
#define ABOUT_ROWS       (ABOUT_USUAL_ROWS + 1 + ABOUT_RANKS)

struct about_facts {
    const struct render_progress *progress;
    const char *device; /* NULL: threads of the processor */
    int thread_count;
    double load; /* mean of the threads since the start, 0 to 1 */
    int width_px, height_px;
    const char *glyphs, *colors; /* of the screen */
    const struct rank_progress *ranks;
    int rank_count; /* 0 without a cluster */
};

/* Returns the number of lines. */
int about_format(char lines[ABOUT_ROWS][ABOUT_BYTES],
                 const struct about_facts *facts);

/* Formats a number with three digits and a unit: 950, 9.50 k, 12.3 M, 123 G. */
void about_number(char *text, size_t size_bytes, double value);

/* Formats the samples of a second so far: "2.04 M samples/s". */
void about_speed(const struct live_render *control, char *text,
                 size_t size_bytes);

/* Opens the window, or updates its text. */
void about_window_draw(const struct live_render *control,
                       struct screen *screen);

#endif
