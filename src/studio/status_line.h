// SPDX-License-Identifier: MIT
/*
 * status_line.h - the text of the status line
 *
 * Units:     terminal columns, nanoseconds
 * Ownership: text goes to the caller's memory
 * Threads:   any
 * Errors:    fields without room are left out, the least important first;
 *            the mode and what renders stay
 */
#ifndef GLIM_STATUS_LINE_H
#define GLIM_STATUS_LINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "render/render_loop.h"
#include "terminal/screen.h"

struct status_line {
    bool is_live;
    bool is_orbiting;
    bool passes_walls;
    bool is_filtered;        /* the picture shown is */
    double filtered_error;   /* of that picture, an estimate */
    bool is_halted;          /* the user has paused the render */
    bool is_started;         /* normal mode has begun a render */
    bool has_device;         /* OpenCL renders */
    const char *restore_key; /* goes on with a kept session; NULL: none is */
    const char *load_key;    /* key that loads changed files; NULL if none has
                                changed */
    const char *help_key;
    const struct render_progress *progress;
};

/* Formats the line for `cols` columns. */
void status_line_format(struct status_row *row, int cols,
                        const struct status_line *s);

/* Formats a time in seconds, rounded down: 7 s, 1:07, 2:01:07. */
void status_line_duration(char *text, size_t size_bytes, uint64_t ns);

/* Formats the time to the nearest limit. Returns false if it is unknown. */
bool status_line_left(char *text, size_t size_bytes,
                      const struct render_progress *p);

/* Formats a message, without its control characters and cut at `cols` columns,
 * beside the mode and OpenCL, if that renders, or beside the mode's first word,
 * or alone: as it fits. */
void status_line_message(struct status_row *row, int cols,
                         const struct status_line *s, const char *message,
                         enum text_role role);

#endif
