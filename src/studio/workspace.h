// SPDX-License-Identifier: MIT
/*
 * workspace.h - the layout of the screen: the picture, the editor panel beside
 * it, one window over it and the status line; and when each is drawn
 *
 * The list of commands, the window about the render and the inspector's table
 * share the window. The list hides the others while it is open. The window
 * about the render and the editor panel exclude each other, as there is room
 * for one of them.
 *
 * Units:     nanoseconds of clock_ns()
 * Ownership: control and camera stay the caller's and outlive it;
 *            workspace_free() frees the rest
 * Threads:   main only
 * Errors:    become messages
 */
#ifndef GLIM_WORKSPACE_H
#define GLIM_WORKSPACE_H

#include <stdbool.h>
#include <stdint.h>

#include "session/live_render.h"
#include "studio/about_window.h"
#include "studio/camera/camera_control.h"
#include "studio/comparison.h"
#include "studio/editor_panel.h"
#include "studio/glyph_choice.h"
#include "studio/inspector.h"
#include "studio/keys_bar.h"
#include "studio/command_list.h"
#include "studio/scene_list.h"
#include "studio/view_list.h"
#include "terminal/screen.h"

struct workspace {
    struct live_render *control;
    struct camera_control *camera;
    struct screen screen;
    struct frame frame; /* of the size that the screen wants */
    struct inspector inspector;
    struct comparison comparison;
    struct editor_panel panel;
    bool has_about; /* window about the render; hidden while the list is open */
    struct command_list commands;
    struct scene_list scenes;
    struct view_list views;
    char *chosen_scene; /* path from that list, for the taker; NULL: none */
    struct keys_bar keys_bar;
    struct glyph_choice glyph_choice;
    bool has_kept;        /* a kept session is offered */
    const char *prompt;   /* a question in the last line; NULL: none */
    bool is_settled;      /* the screen shows the final picture */
    bool has_frame;       /* else it was cancelled while it was made */
    bool has_more;        /* not all of the frame is on the screen */
    bool is_final;        /* the frame was made when the render had ended */
    bool is_cancelled;    /* input has ended the last drawing early */
    struct cancel cancel; /* of the frame */
    uint64_t layout_ns; /* when a layout was made that no frame has; 0: none */
    uint64_t frame_ns;  /* when a new frame is due */
    uint64_t status_ns; /* when the status line is formatted next */
    uint64_t facts_ns;  /* when the graph and the window about it are */
    uint64_t picked_until_ns;   /* the picked object is outlined until then */
    uint64_t filtered_until_ns; /* the status line says so until then */
    int width_px, height_px;    /* size of the picture in this layout */
};

/* Sets the size of the draft for the first restart, by the size that the
 * terminal has now. Call it before tty_open(). */
void workspace_expect(struct session *s);

void workspace_init(struct workspace *workspace, struct live_render *control,
                    struct camera_control *camera);

/* After tty_open(). */
void workspace_open(struct workspace *workspace);

/* Lays everything out for the present size of the terminal. Windows that are
 * open stay open. */
void workspace_layout(struct workspace *workspace);

/* The same on a screen that is cleared first: others have written to it. */
void workspace_redraw(struct workspace *workspace);

/* Draws all parts again as soon as possible. */
void workspace_refresh(struct workspace *workspace);

/* Shows a question in the last line; NULL: the status line. */
void workspace_ask(struct workspace *workspace, const char *prompt);

/* Returns the action of the hint of a key in a cell, or ACTION_NONE. */
enum action workspace_hint_at(const struct workspace *workspace, int col,
                              int row);

/* Keeps the render as it is shown, and compares with it. */
void workspace_keep_render(struct workspace *workspace);

void workspace_switch_about(struct workspace *workspace);
void workspace_open_panel(struct workspace *workspace);

/* Opens the panel at the page of light. */
void workspace_open_light(struct workspace *workspace);
void workspace_next_drawing(struct workspace *workspace);
void workspace_next_colors(struct workspace *workspace);
void workspace_next_theme(struct workspace *workspace);

void workspace_next_glyphs(struct workspace *workspace);

/* Goes back to the glyphs before while the message of workspace_next_glyphs()
 * is shown. Returns false if it is not. */
bool workspace_take_back_glyphs(struct workspace *workspace);

/* Shows the status line, or lets the picture have its row. */
void workspace_switch_status(struct workspace *workspace);

void workspace_open_commands(struct workspace *workspace);
void workspace_open_menu(struct workspace *workspace);
void workspace_open_scenes(struct workspace *workspace);
void workspace_open_views(struct workspace *workspace);

/* Returns true if a list is open. */
bool workspace_has_list(const struct workspace *workspace);

/* Gives a key or the mouse to the open list. Returns the action of a command
 * that is chosen, or ACTION_NONE. */
enum action workspace_take_list(struct workspace *workspace,
                                const struct event *event);

/* Closes the list that is open, if any. */
void workspace_close_list(struct workspace *workspace);

/* Takes a scene that was loaded anew; what had these names stays selected. */
void workspace_renew(struct workspace *workspace,
                     const struct selection_names *names);

/* Looks how far the render is, and decides what has to be drawn. */
void workspace_look(struct workspace *workspace);

/* Draws what is due, with the keys of a state in the bar. Returns false if the
 * terminal is gone. */
bool workspace_draw(struct workspace *workspace, enum keys_state keys,
                    uint64_t now_ns);

/* When workspace_look() and workspace_draw() are due if no event comes;
 * UINT64_MAX: never. */
uint64_t workspace_next_ns(const struct workspace *workspace, uint64_t now_ns);

/* Keeps a small picture of the scene for the list of scenes. */
void workspace_keep_picture(struct workspace *workspace);

/* After tty_close(). */
void workspace_free(struct workspace *workspace);

#endif
