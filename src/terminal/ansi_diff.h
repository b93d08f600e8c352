// SPDX-License-Identifier: MIT
/*
 * ansi_diff.h - terminal cells to escape sequences, by difference, and a
 * picture as lines of coloured text
 *
 * An ansi_diff remembers what the terminal shows, also while the picture moves
 * on it, and writes only cells that differ; a colour is set only when it
 * changes. A byte budget ends a frame early. The next frame continues where it
 * ended, so that every cell is updated in turn. The text of a picture has the
 * same cells as the screen at the same size.
 *
 * Units:     terminal cells, bytes
 * Ownership: ansi_diff_free() frees; a zeroed struct is empty; a text is for
 *            free()
 * Threads:   one thread at a time
 * Errors:    memory
 */
#ifndef GLIM_ANSI_DIFF_H
#define GLIM_ANSI_DIFF_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "terminal/cells.h"

/* ---- differences ---- */

struct ansi_diff {
    int cols, rows; /* of the terminal */
    struct cell *shown;
    enum palette palette;   /* of `shown` */
    int next_row, next_col; /* start of the next frame */
    char *bytes;            /* output to be written */
    size_t length, capacity;
    size_t begun;    /* length at the start of the picture */
    uint32_t fg, bg; /* colours that are set at the end of `bytes` */
};

/* Rectangle of cells, relative to the picture's corner. */
struct ansi_diff_rect {
    int col, row, cols, rows;
};

struct ansi_diff_draw {
    int col, row;        /* the picture's corner on the screen, from 0 */
    size_t budget_bytes; /* the frame ends beyond it; SIZE_MAX: no limit */
    int step;            /* 24 bit: cells stay if no channel differs by more */
    const struct ansi_diff_rect *covered; /* windows above: not drawn */
    int covered_count;
};

/* Initializes for a terminal of cols x rows cells, with unknown contents. */
bool ansi_diff_init(struct ansi_diff *a, int cols, int rows, struct error *err);
void ansi_diff_free(struct ansi_diff *a);

/* Marks cells of the terminal as unknown, for example because something else
 * was drawn there. */
void ansi_diff_invalidate(struct ansi_diff *a, struct ansi_diff_rect rect);
void ansi_diff_invalidate_all(struct ansi_diff *a);

/* Returns what the terminal shows in a cell. */
struct cell *ansi_diff_shown(const struct ansi_diff *a, int col, int row);

/* Empties the buffer. The terminal's default colours must be set at this
 * point. */
void ansi_diff_begin(struct ansi_diff *a);

/* Appends control bytes, at most ANSI_DIFF_TEXT_MAX in a frame. */
void ansi_diff_text(struct ansi_diff *a, const char *text);
#define ANSI_DIFF_TEXT_MAX 256

/* Makes room for size_bytes after `length`, and for the rest of the frame's
 * ansi_diff_text(). Returns false when memory is out. */
bool ansi_diff_reserve(struct ansi_diff *a, size_t size_bytes);

/* Appends a cursor movement. Row and column count from 0. */
void ansi_diff_jump(struct ansi_diff *a, int row, int col);

/* Returns the first column of the picture from `col` on that no window
 * covers. */
int ansi_diff_uncovered(const struct ansi_diff_draw *how, int col, int row);

/* Appends the changes from the shown picture to `cells`, whose rows it makes as
 * it comes to them. Colours and cursor position are undefined afterwards.
 * Returns true if the picture is complete, false if the budget or a cancel of
 * the cells' frame ended it; a frame that is cancelled has a row at least. */
bool ansi_diff_picture(struct ansi_diff *a, struct cells *cells,
                       const struct ansi_diff_draw *how);

/* Makes lines of text for a file or a pipe. Each line sets its colours and ends
 * with the default ones. *text is for free(). */
bool ansi_diff_lines(const struct cells *cells, char **text, size_t *size_bytes,
                     struct error *err);

/* Appends a reset of the colours and a movement of the cursor to column 0 of
 * the row. */
void ansi_diff_end(struct ansi_diff *a, int row);

/* ---- text ---- */

/*
 * The text has the same cells as the screen at the same size.
 */

struct ansi_text_style {
    int cols, rows;
    enum palette palette;
    enum glyphs glyphs;
};

/* Initializes a frame of the size that the text needs, for frame_free(). */
bool ansi_text_frame_init(struct frame *frame,
                          const struct ansi_text_style *style,
                          struct error *err);

bool ansi_text_of_frame(const struct frame *frame,
                        const struct ansi_text_style *style, char **text,
                        size_t *size_bytes, struct error *err);

#endif
