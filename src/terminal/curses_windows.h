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

#include <wchar.h>

struct window_rect {
    int col, row, cols, rows;
};

/* Closes all windows. The next update clears the screen and leaves it to the
 * picture. */
void windows_clear(void);

/* Frees all. Call it before the screen is left. */
void windows_free(void);

/* Puts text into the last row, in reverse video; NULL leaves the row to the
 * picture. */
void windows_status(const char *text);

/* Opens a window with these lines and a title in the middle of the screen and
 * returns where it is. One window is open at a time. */
struct window_rect windows_open(const char *title, const char *const *texts,
                                int text_count);
/* The same in the corner at the bottom left, above the last row, and in the
 * corner at the top right. */
struct window_rect windows_open_left(const char *title,
                                     const char *const *texts, int text_count);
struct window_rect windows_open_corner(const char *title,
                                       const char *const *texts,
                                       int text_count);

/* Replaces the lines of the window; its size stays. */
void windows_set(const char *const *texts, int text_count);
void windows_close(void);

enum window_look { WINDOW_PLAIN, WINDOW_SELECTED, WINDOW_TITLE, WINDOW_HINT };

/* Bytes of a line: the columns of a panel in characters of several bytes. */
#define WINDOW_LINE_BYTES 256

struct window_line {
    char text[WINDOW_LINE_BYTES];
    enum window_look look;
};

/* Shows lines at the right edge of the screen, in `cols` columns with a bar at
 * their left, above the last row. They replace those shown before. Returns
 * where they are. */
struct window_rect windows_show_panel(const struct window_line *panel_lines,
                                      int line_count, int cols);
void windows_hide_panel(void);

/* Leaves columns of a row of the panel to be written by others. */
void windows_spare(int row, int col, int cols);

/* Shows text in the middle of an empty screen. */
void windows_notice(const char *text);

/* Writes what has changed, and blanks once where picture or swatches will be.
 * The cursor is in the last row, column 0, afterwards. */
void windows_update(void);

enum window_cell_kind {
    WINDOW_CELL_SPARED, /* written by others: picture or swatch */
    WINDOW_CELL_TEXT,
    WINDOW_CELL_TAIL /* the right half of a wide character */
};

/* A character and those that combine with it. */
#define WINDOW_CELL_CHARS 6

struct window_cell {
    enum window_cell_kind kind;
    wchar_t text[WINDOW_CELL_CHARS];
    unsigned attributes; /* curses' A_ constants */
};

/* Returns what the terminal shows in a cell since the last update. */
const struct window_cell *windows_shown(int col, int row);

#endif
