// SPDX-License-Identifier: MIT
/*
 * screen.h - the picture, the status line and the help window on the terminal
 *
 * Knows where they are and what they cover; writes frames as the pace allows.
 *
 * Units:     terminal cells
 * Ownership: screen_free() frees
 * Threads:   main only
 * Errors:    memory; a terminal that is gone by the result of screen_draw()
 */
#ifndef GLIM_SCREEN_H
#define GLIM_SCREEN_H

#include <stdbool.h>

#include "terminal/ansi_diff.h"
#include "terminal/ansi_text.h"
#include "terminal/curses_windows.h"
#include "terminal/frame_pacing.h"
#include "terminal/swatches.h"
#include "terminal/term_caps.h"

/* The longest text of the status line, with its end. */
#define STATUS_BYTES 1024

struct screen {
    struct frame_pacing pace;
    struct term_caps display;
    bool has_status_row; /* else the line shows only what is urgent */
    bool is_too_small;
    bool has_all_answers; /* to what was asked at the start */
    /* of the present size */
    struct fit fit;
    int frame_width, frame_height; /* pixels of the frames it wants */
    struct cells cells;
    struct pixel_graphics graphics; /* instead of cells, if of a kind */
    struct ansi_diff ansi;
    char status[STATUS_BYTES];
    bool has_status;
    struct ansi_diff_rect window; /* no columns: closed */
    bool must_update;             /* curses has something to write */
    bool has_panel;               /* the next layout leaves room for one */
    int panel_cols;               /* at the right edge; 0: none */
    struct swatches swatches;     /* of the panel's lines */
    bool has_new_panel;
    bool has_cursor;
    int cursor_col, cursor_row; /* in the picture */
};

/* Where a picture of this size will go, as far as that is known before
 * tty_open(). No columns: nowhere. */
struct fit screen_expect(const struct term_caps_choice *choice, int width_px,
                         int height_px);

/* After tty_open(). */
void screen_init(struct screen *screen, const struct term_caps_choice *choice);

/* Fits a picture of this size to the terminal's size of now; everything is
 * drawn anew. */
bool screen_layout(struct screen *screen, int width_px, int height_px,
                   struct error *err);

/* Takes an answer of the terminal. True if the layout must be done anew, as it
 * must after a change of screen->display. */
bool screen_answer(struct screen *screen, const struct event *event);

/* The text of the last row; NULL: none, the picture shows there. */
void screen_status(struct screen *screen, const char *text);

/* Shows lines in the panel that the layout has left room for; screen->swatches
 * stand left of them. */
void screen_show_panel(struct screen *screen,
                       const struct window_line *panel_lines, int line_count);

void screen_open_window(struct screen *screen, const char *title,
                        const char *const *texts, int text_count);
/* The same at the left edge of the last rows, beside which keys go on. */
void screen_open_panel(struct screen *screen, const char *title,
                       const char *const *texts, int text_count);

/* The same at the right of the top, with lines that change: as many, and as
 * long. */
void screen_open_corner(struct screen *screen, const char *title,
                        const char *const *texts, int text_count);
void screen_set_corner(struct screen *screen, const char *const *texts,
                       int text_count);
void screen_close_window(struct screen *screen);

enum screen_result {
    SCREEN_DONE, /* all is shown */
    SCREEN_MORE, /* the budget was too small for all */
    SCREEN_GONE  /* the terminal is gone, or a signal wants an end */
};

/* Writes text that has changed and the frame, or only the text if that is NULL.
 * The frame has frame_width x frame_height pixels; a cursor is drawn into it
 * where pixels are shown. Cells whose colours changed by no more than `step` of
 * 255 may stay as they are. Call it only if frame_pacing_may_send(). */
enum screen_result screen_draw(struct screen *screen, struct frame *frame,
                               int step);

/* How the picture is shown, as text would be. */
struct ansi_text_style screen_style(const struct screen *screen);

/* The kind of glyphs or pixels, for people. */
const char *screen_glyphs_name(const struct screen *screen);

/* Removes pixels and waits for answers on their way, half a second at most:
 * they would be typed into the shell. Keys pressed meanwhile are lost. */
void screen_drain(struct screen *screen, struct tty_input *input);

void screen_free(struct screen *screen);

#endif
