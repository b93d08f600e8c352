// SPDX-License-Identifier: MIT
/*
 * windows.h - what curses draws: the status line, a window over the picture, a
 * panel beside it
 *
 * Shown by windows_update(). There is one screen, so there is one state.
 *
 * Units:     terminal cells
 * Ownership: texts stay the caller's
 * Threads:   main only, between term_open() and term_close()
 * Errors:    without memory for a window there is none
 */
#ifndef GLIM_WINDOWS_H
#define GLIM_WINDOWS_H

struct window_rect {
    int col, row, cols, rows;
};

/* Puts text in the last row, reversed; NULL empties it. */
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

/* Text in the middle of an empty screen. */
void windows_notice(const char *text);

/* Writes what changed. The cursor is in the last row, column 0, afterwards. */
void windows_update(void);

#endif
