// SPDX-License-Identifier: MIT
/*
 * screen.h - the terminal's screen: the picture, the editor panel, a window and
 * the status line
 *
 * The screen knows where these are and which cover the others. It shows frames
 * that it is given and sends as many bytes as frame_pacing allows.
 *
 * Units:     terminal cells
 * Ownership: screen_free() frees
 * Threads:   main only
 * Errors:    memory; screen_draw() says if the terminal is gone
 */
#ifndef GLIM_SCREEN_H
#define GLIM_SCREEN_H

#include <stdbool.h>

#include "terminal/ansi_diff.h"
#include "terminal/curses_windows.h"
#include "terminal/frame_pacing.h"
#include "terminal/term_caps.h"

/* Bytes of the longest status line, with its final 0. */
#define STATUS_BYTES 1024

/* A part of the last row that is of another role, in columns. */
struct status_span {
    int col, cols;
    enum text_role role;
};

#define STATUS_SPANS 2

/* The last row. Text before the end of a span is ASCII. */
struct status_row {
    char text[STATUS_BYTES];
    enum text_role role;
    struct status_span spans[STATUS_SPANS];
    int span_count;
};

struct screen {
    struct frame_pacing pace;
    struct term_caps display;
    bool has_status_row; /* else only messages appear in the last row */
    bool is_too_small;
    bool has_all_answers; /* to the questions of tty_open() */
    /* These have the size of the present layout. */
    struct cells_rect fit;
    int frame_width, frame_height;   /* pixels of the frames it wants at rest */
    int moving_width, moving_height; /* and while the picture moves */
    struct cells cells;
    struct pixel_graphics graphics; /* used instead of cells unless NONE */
    int image_layer;                /* of its images in the layout before */
    bool has_old_images;            /* kitty shows images of a layout before */
    struct ansi_diff ansi;          /* of the whole terminal */
    bool is_new;                    /* nothing of this layout was drawn yet */
    struct status_row status;
    bool has_status;
    struct ansi_diff_rect window; /* in the picture's cells; 0 cols: closed */
    bool must_update;  /* text has changed since screen_draw_text() */
    size_t text_bytes; /* of the text that screen_draw() has to end */
    int foot_rows;     /* last rows, below a window at the bottom */
    bool has_panel;    /* the next layout leaves room for the panel */
    int panel_cols;    /* columns at the right edge; 0: none */
    bool has_cursor;
    int cursor_col, cursor_row; /* from the picture's corner */
};

/* Returns where a picture of this size will be shown, as far as that is known
 * before tty_open(); no columns if the window is too small. */
struct cells_rect screen_expect(const struct term_caps_choice *choice,
                                int width_px, int height_px);

/* Call it after tty_open(). */
void screen_init(struct screen *screen, const struct term_caps_choice *choice);

/* Fits a picture of this size to the present size of the terminal. The window
 * closes, and everything has to be drawn anew, over what the terminal shows:
 * only another size or palette, other glyphs and pixels clear it. */
bool screen_layout(struct screen *screen, int width_px, int height_px,
                   struct error *err);

/* Takes an answer of the terminal. Returns true if screen_layout() has to be
 * called, as it has to be after a change of screen->display. */
bool screen_answer(struct screen *screen, const struct event *event);

/* Sets the last row, whose padding is 0; NULL leaves it to the picture. */
void screen_status(struct screen *screen, const struct status_row *row);

/* Returns true if the panel takes the whole window, and the picture is hidden
 * behind it. */
bool screen_is_hidden(const struct screen *screen);

/* Empties the panel, for windows_text() and windows_paint(). The layout must
 * have left room for it. */
void screen_begin_panel(struct screen *screen);

/* Opens a window with these lines and returns where it is. One window is open
 * at a time. */
struct window_rect screen_open_window(struct screen *screen,
                                      enum window_place place,
                                      const char *title,
                                      const char *const *texts, int text_count);

/* Replaces the lines of the window by as many. */
void screen_set_window(struct screen *screen, const char *const *texts,
                       int text_count);
void screen_close_window(struct screen *screen);

enum screen_result {
    SCREEN_DONE, /* the screen shows all of the frame */
    SCREEN_MORE, /* the budget of bytes or a cancel ended it before */
    SCREEN_GONE  /* the terminal is gone, or a signal ends the program */
};

/* Writes text that has changed, so that the terminal has it while the frame is
 * made. Call it only if frame_pacing_may_send(); screen_draw() must follow. */
void screen_draw_text(struct screen *screen);

struct screen_frame {
    struct frame *pixels; /* NULL: no picture. A cursor is drawn into it where
                             pixels are shown */
    int step; /* cells may stay if their colours changed by no more of 255 */
    enum pixel_graphics_pace pace;
};

/* Writes a frame, and ends what screen_draw_text() began. It has frame_width x
 * frame_height pixels, or moving_width x moving_height. */
enum screen_result screen_draw(struct screen *screen,
                               const struct screen_frame *frame);

/* Size, colours and glyphs of the picture, for saving it as text. */
struct ansi_text_style screen_style(const struct screen *screen);

/* Name of the kind of glyphs or pixels, for messages. */
const char *screen_glyphs_name(const struct screen *screen);

/* Removes pixels and waits half a second at most for the terminal's answers,
 * which the shell would read as typed text. Keys pressed meanwhile are lost. */
void screen_drain(struct screen *screen, struct tty_input *input);

void screen_free(struct screen *screen);

#endif
