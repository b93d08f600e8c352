// SPDX-License-Identifier: MIT
/*
 * curses_windows.h - the text on the screen: the status line, a window over the
 * picture, a panel beside it
 *
 * They are windows of curses, which windows_update() writes; nothing else of
 * the screen changes by that. There is one screen, so there is one state.
 *
 * Units:     terminal cells
 * Ownership: texts stay the caller's
 * Threads:   main only, between tty_open() and tty_close()
 * Errors:    without memory for a window there is none
 */
#ifndef GLIM_CURSES_WINDOWS_H
#define GLIM_CURSES_WINDOWS_H

#include <wchar.h>

struct window_rect {
    int col, row, cols, rows;
};

/* Closes all of them. The next update empties the screen, which is the
 * picture's. */
void windows_clear(void);

/* At the end, before the screen is left. */
void windows_free(void);

/* Puts text in the last row, reversed; NULL leaves it to the picture. */
void windows_status(const char *text);

/* A window with these lines and a title, in the middle; where it is. One at a
 * time. */
struct window_rect windows_open(const char *title, const char *const *texts,
                                int text_count);
/* The same at the left edge, above the last row; in the corner at the top
 * right. */
struct window_rect windows_open_left(const char *title,
                                     const char *const *texts, int text_count);
struct window_rect windows_open_corner(const char *title,
                                       const char *const *texts,
                                       int text_count);

/* Replaces the lines of the window, by as long ones. */
void windows_set(const char *const *texts, int text_count);
void windows_close(void);

enum window_look { WINDOW_PLAIN, WINDOW_SELECTED, WINDOW_TITLE, WINDOW_HINT };

/* The columns of a panel, in characters of several bytes. */
#define WINDOW_LINE_BYTES 256

struct window_line {
    char text[WINDOW_LINE_BYTES];
    enum window_look look;
};

/* Lines at the right edge, cols wide with a bar at their left, down to the row
 * above the last; where they are. Shown in place of those before. */
struct window_rect windows_show_panel(const struct window_line *panel_lines,
                                      int line_count, int cols);
void windows_hide_panel(void);

/* Columns of the panel that something else writes. */
void windows_spare(int row, int col, int cols);

/* Text in the middle of an empty screen. */
void windows_notice(const char *text);

/* Writes what changed; blanks once where the picture or a swatch will be. The
 * cursor is in the last row, column 0, afterwards. */
void windows_update(void);

enum window_cell_kind {
    WINDOW_CELL_SPARED, /* something else writes there */
    WINDOW_CELL_TEXT,
    WINDOW_CELL_TAIL /* the right half of a wide character */
};

/* A character, and those that combine with it. */
#define WINDOW_CELL_CHARS 6

struct window_cell {
    enum window_cell_kind kind;
    wchar_t text[WINDOW_CELL_CHARS];
    unsigned attributes; /* of curses */
};

/* What the terminal shows since the last update. */
const struct window_cell *windows_shown(int col, int row);

#endif
