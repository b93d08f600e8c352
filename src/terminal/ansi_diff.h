// SPDX-License-Identifier: MIT
/*
 * ansi_diff.h - cells to the bytes that make a terminal show them
 *
 * Keeps what the terminal shows and writes only what differs, each colour only
 * when it changes. A budget cuts a frame short; the next one goes on where it
 * stopped, so that every cell has its turn.
 *
 * Units:     terminal cells, bytes
 * Ownership: ansi_diff_free() frees; a zeroed struct is empty
 * Threads:   one thread at a time
 * Errors:    memory
 */
#ifndef GLIM_ANSI_DIFF_H
#define GLIM_ANSI_DIFF_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "terminal/cells.h"

struct ansi_diff {
    int cols, rows;
    struct cell *shown;
    enum palette palette;   /* of `shown` */
    enum glyphs glyphs;     /* likewise */
    int next_row, next_col; /* where the next frame goes on */
    char *bytes;            /* what is to be written */
    size_t length, capacity;
    uint32_t fg, bg; /* colours that are set at the end of `bytes` */
};

/* Cells of the picture, from its corner. */
struct ansi_diff_rect {
    int col, row, cols, rows;
};

struct ansi_diff_draw {
    int col, row; /* where the picture's corner is on the screen, from 0 */
    size_t budget_bytes; /* stop beyond it; SIZE_MAX: none */
    int step; /* 24 bit: leave cells whose channels differ by no more */
    const struct ansi_diff_rect *covered; /* not to be touched: windows above */
    int covered_count;
};

/* For a picture of cols x rows cells of which nothing is known. */
bool ansi_diff_init(struct ansi_diff *a, int cols, int rows, struct error *err);
void ansi_diff_free(struct ansi_diff *a);

/* Something else has written over these cells, or nobody knows. */
void ansi_diff_forget(struct ansi_diff *a, struct ansi_diff_rect rect);
void ansi_diff_forget_all(struct ansi_diff *a);

/* Begins an empty buffer; colours are the terminal's own at this point. */
void ansi_diff_begin(struct ansi_diff *a);

/* Appends a few control bytes, at most ANSI_DIFF_TEXT_MAX a frame. */
void ansi_diff_text(struct ansi_diff *a, const char *text);
#define ANSI_DIFF_TEXT_MAX 256

/* Makes room for so many bytes behind `length`, and for the rest of the frame's
 * ansi_diff_text(). False if memory is out. */
bool ansi_diff_reserve(struct ansi_diff *a, size_t size_bytes);

/* Appends a jump of the cursor, from 0. */
void ansi_diff_jump(struct ansi_diff *a, int row, int col);

/* The first column of the picture from col on that no window covers. */
int ansi_diff_uncovered(const struct ansi_diff_draw *how, int col, int row);

/* Appends what turns the shown picture into `cells`. Leaves colours and cursor
 * anywhere. True if nothing is left for the next frame. */
bool ansi_diff_picture(struct ansi_diff *a, const struct cells *cells,
                       const struct ansi_diff_draw *how);

/* The cells as lines of text for a file or a pipe, each with its colours and
 * the reader's own at its end. *text is for free(). */
bool ansi_diff_lines(const struct cells *cells, char **text, size_t *size_bytes,
                     struct error *err);

/* Appends the way back: own colours, cursor at this row, column 0. */
void ansi_diff_end(struct ansi_diff *a, int row);

#endif
