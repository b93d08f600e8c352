// SPDX-License-Identifier: MIT
/*
 * screen.h - the picture, the status line and the help window on the terminal
 *
 * Knows where they are and what they cover; writes frames as the pace allows.
 *
 * Units:     terminal cells
 * Ownership: canvas_free() frees
 * Threads:   main only
 * Errors:    memory; a terminal that is gone by the result of canvas_draw()
 */
#ifndef GLIM_SCREEN_H
#define GLIM_SCREEN_H

#include "terminal/ansi_diff.h"
#include "terminal/term_caps.h"
#include "terminal/frame_pacing.h"
#include "terminal/swatches.h"
#include "terminal/ansi_text.h"
#include "terminal/curses_windows.h"

/* The longest text of the status line, with its end. */
#define STATUS_BYTES 1024

/* Draws into frames before they are shown. */
struct painter {
    void (*paint)(void *context, struct film *film, struct film *draft,
                  struct frame *frame);
    void *context;
};

struct canvas {
    struct painter painter; /* none: films are shown as they are */
    struct pace pace;
    struct display display;
    bool has_status_row; /* else the line shows only what is urgent */
    bool is_too_small;
    bool has_all_answers; /* to what was asked at the start */
    /* of the present size */
    struct fit fit;
    struct frame frame;
    struct cells cells;
    struct graphics graphics; /* instead of cells, if of a kind */
    struct ansi ansi;
    char status[STATUS_BYTES];
    bool has_status;
    struct ansi_rect window;  /* no columns: closed */
    bool must_update;         /* curses has something to write */
    bool has_panel;           /* the next layout leaves room for one */
    int panel_cols;           /* at the right edge; 0: none */
    struct swatches swatches; /* of the panel's lines */
    bool has_new_panel;
    bool has_cursor;
    int cursor_col, cursor_row; /* in the picture */
};

/* Where a picture of this size will go, as far as that is known before
 * term_open(). No columns: nowhere. */
struct fit canvas_expect(const struct display_choice *choice, int width_px,
                         int height_px);

/* After term_open(). */
void canvas_init(struct canvas *c, const struct display_choice *choice);

/* Fits a picture of this size to the terminal's size of now; everything is
 * drawn anew. */
bool canvas_layout(struct canvas *c, int width_px, int height_px,
                   struct error *err);

/* Takes an answer of the terminal. True if the layout must be done anew, as it
 * must after a change of c->display. */
bool canvas_answer(struct canvas *c, const struct event *event);

/* The text of the last row; NULL: none, the picture shows there. */
void canvas_status(struct canvas *c, const char *text);

/* Shows lines in the panel that the layout has left room for; c->swatches
 * stand left of them. */
void canvas_show_panel(struct canvas *c, const struct window_line *panel_lines,
                       int line_count);

void canvas_open_window(struct canvas *c, const char *title,
                        const char *const *texts, int text_count);
/* The same at the left edge of the last rows, beside which keys go on. */
void canvas_open_panel(struct canvas *c, const char *title,
                       const char *const *texts, int text_count);

/* The same at the right of the top, with lines that change: as many, and as
 * long. */
void canvas_open_corner(struct canvas *c, const char *title,
                        const char *const *texts, int text_count);
void canvas_set_corner(struct canvas *c, const char *const *texts,
                       int text_count);
void canvas_close_window(struct canvas *c);

enum canvas_result {
    CANVAS_DONE, /* all is shown */
    CANVAS_MORE, /* the budget was too small for all */
    CANVAS_GONE  /* the terminal is gone, or a signal wants an end */
};

/* Writes what has changed, and the film's picture if there is one, with the
 * draft's if there is one. Call it only if pace_may_send(). */
enum canvas_result canvas_draw(struct canvas *c, struct film *film,
                               struct film *draft, struct develop how,
                               int step);

/* How the picture is shown, as text would be. */
struct text_style canvas_style(const struct canvas *c);

/* The kind of glyphs or pixels, for people. */
const char *canvas_glyphs_name(const struct canvas *c);

/* Removes pixels and waits for answers on their way, half a second at most:
 * they would be typed into the shell. Keys pressed meanwhile are lost. */
void canvas_drain(struct canvas *c, struct input *input);

void canvas_free(struct canvas *c);

#endif
