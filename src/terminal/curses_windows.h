// SPDX-License-Identifier: MIT
/*
 * curses_windows.h - the text on the screen: the status line, a window over the
 * picture, a panel beside it
 *
 * They are windows of curses. windows_update() writes what has changed in them
 * and touches nothing else of the screen. There is one screen, so the module
 * has one state.
 *
 * Units:     terminal cells
 * Ownership: texts stay the caller's
 * Threads:   main only, between tty_open() and tty_close()
 * Errors:    without memory a window does not open
 */
#ifndef GLIM_CURSES_WINDOWS_H
#define GLIM_CURSES_WINDOWS_H

#include <stdbool.h>
#include <stddef.h>
#include <wchar.h>

#include "terminal/theme.h"

struct window_rect {
    int col, row, cols, rows;
};

/* Sets the colours of all text from the next update on. */
void windows_use_theme(enum theme theme, enum palette palette);

/* Closes all windows and leaves the screen to the picture. The next update
 * clears it if `must_clear` or if its size is another one, and else overwrites
 * what it shows. Returns true if it will clear. */
bool windows_reset(bool must_clear);

/* Frees all. Call it before the screen is left. */
void windows_free(void);

/* Parts of the screen that show text. */
enum window_part {
    WINDOW_STATUS, /* the last row, which is row 0; row -1 is above it */
    WINDOW_PANEL,  /* at the right edge */
    WINDOW_OVER,   /* the window over the picture */
    WINDOW_PARTS
};

/* Puts text at a cell of a part, cut or filled with blanks to exactly `cols`
 * columns. */
void windows_text(enum window_part part, int row, int col, int cols,
                  enum text_role role, const char *text);

/* Puts cells with colours of their own at a cell of a part. */
void windows_paint(enum window_part part, int row, int col,
                   const struct cell *cells, int count);

/* Draws a horizontal line from a cell of a part. */
void windows_rule(enum window_part part, int row, int col, int cols);

/* Leaves the last row to the picture. */
void windows_hide_status(void);

/* Places of the window over the picture. */
enum window_place {
    WINDOW_MIDDLE,
    WINDOW_BOTTOM_LEFT, /* above the last rows */
    WINDOW_TOP_LEFT
};

/* Opens a window with these lines and a title and returns where it is. One at
 * the bottom leaves the last `foot_rows` free, others the last one. One window
 * is open at a time. */
struct window_rect windows_open(enum window_place place, int foot_rows,
                                const char *title, const char *const *texts,
                                int text_count);

/* Replaces the lines of the window; its size stays. */
void windows_set(const char *const *texts, int text_count);
void windows_close(void);

/* Makes a blank panel of `cols` columns with a line at its left, above the last
 * row. It replaces the panel that was shown before. */
void windows_open_panel(int cols);
void windows_hide_panel(void);

/* Shows text in the middle of an empty screen. */
void windows_notice(const char *text);

/* Writes what has changed, and blanks where text gives way to the picture.
 * Returns the number of bytes. The cursor is in the last row, column 0,
 * afterwards. */
size_t windows_update(void);

enum window_cell_kind {
    WINDOW_CELL_SPARED, /* blank until others write it: the picture */
    WINDOW_CELL_TEXT,
    WINDOW_CELL_LINE,    /* a name of curses' line drawing */
    WINDOW_CELL_PAINTED, /* a glyph of windows_paint() */
    WINDOW_CELL_TAIL,    /* the right half of a wide character */
    WINDOW_CELL_UNKNOWN
};

/* A character and those that combine with it. */
#define WINDOW_CELL_CHARS 6

struct window_cell {
    enum window_cell_kind kind;
    wchar_t text[WINDOW_CELL_CHARS];
    struct text_style style;
};

/* Returns what the terminal shows in a cell since the last update. */
const struct window_cell *windows_shown(int col, int row);

/* Sets what it shows: WINDOW_CELL_SPARED, so that the next update writes text
 * only, or WINDOW_CELL_UNKNOWN, so that it writes text or a blank. */
void windows_set_shown(int col, int row, enum window_cell_kind kind);

#endif
