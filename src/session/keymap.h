// SPDX-License-Identifier: MIT
/*
 * keymap.h - which key does what, and the help that says so
 *
 * The tables are in keymap.c; the configuration file may give actions other
 * keys, but for those of the panel. The manual and the README list the lines of
 * the help: a test compares.
 *
 * Units:     keys are bytes or enum tty_key; 0 is none
 * Ownership: strings live as long as the program
 * Threads:   any
 */
#ifndef GLIM_KEYMAP_H
#define GLIM_KEYMAP_H

#include <stdbool.h>
#include <stddef.h>

enum action {
    ACTION_NONE,
    ACTION_FORWARD,
    ACTION_BACK,
    ACTION_LEFT,
    ACTION_RIGHT,
    ACTION_DOWN,
    ACTION_UP,
    ACTION_LOOK_UP,
    ACTION_LOOK_DOWN,
    ACTION_LOOK_LEFT,
    ACTION_LOOK_RIGHT,
    ACTION_FASTER,
    ACTION_SLOWER,
    ACTION_CURSOR,
    ACTION_CANCEL,
    ACTION_ORBIT,
    ACTION_FRAME,
    ACTION_FRAME_ALL,
    ACTION_NARROWER,
    ACTION_WIDER,
    ACTION_FOCUS,
    ACTION_CLOSE, /* the aperture */
    ACTION_OPEN,
    ACTION_UNDO,
    ACTION_REDO,
    ACTION_RESET,
    ACTION_KEEP, /* as the numbered view of the next key */
    ACTION_VIEW_1,
    ACTION_VIEW_2,
    ACTION_VIEW_3,
    ACTION_VIEW_4,
    ACTION_VIEW_5,
    ACTION_VIEW_6,
    ACTION_VIEW_7,
    ACTION_VIEW_8,
    ACTION_VIEW_9,
    ACTION_SAVE_VIEW,
    ACTION_VIEW_NEXT, /* light, preview, normals, .. */
    ACTION_VIEW_BACK,
    ACTION_DRAWING, /* boxes, directions, a path */
    ACTION_LESS,
    ACTION_MORE,
    ACTION_PANEL,
    ACTION_MODE,
    ACTION_START,
    ACTION_STEP, /* one more sample a pixel */
    ACTION_RESTART,
    ACTION_SAVE,
    ACTION_SAVE_TEXT,
    ACTION_SAVE_LINEAR,
    ACTION_BACKEND,
    ACTION_RELOAD, /* the files of the scene */
    ACTION_COLORS,
    ACTION_GLYPHS,
    ACTION_METER, /* progress */
    ACTION_HIDE,
    ACTION_MOUSE,
    ACTION_REDRAW,
    ACTION_HELP,
    ACTION_SUSPEND,
    ACTION_INTERRUPT, /* Ctrl-C */
    ACTION_ABORT,     /* Ctrl-\ */
    ACTION_QUIT,
    ACTIONS
};

/* What keys do in the panel, where they are the same for everybody. */
enum panel_action {
    PANEL_NONE,
    PANEL_UP,
    PANEL_DOWN,
    PANEL_LESS,
    PANEL_MORE,
    PANEL_PAGE_UP,
    PANEL_PAGE_DOWN,
    PANEL_ENTER,
    PANEL_MUCH_LESS,
    PANEL_MUCH_MORE,
    PANEL_TYPE,
    PANEL_HSV,
    PANEL_NEXT_PAGE,
    PANEL_COPY,
    PANEL_UNDO,
    PANEL_REDO,
    PANEL_COMPARE,
    PANEL_SAVE,
    PANEL_LEAVE
};

/* Keys that an action can have. */
#define KEYMAP_MAX 4

/* A zeroed struct has no keys yet. */
struct keymap {
    int keys[ACTIONS][KEYMAP_MAX];
    bool is_chosen[ACTIONS]; /* by the person */
};

/* Gives an action these keys only, and takes them from others that were given
 * them before. */
void keymap_choose(struct keymap *k, enum action action,
                   const int keys[KEYMAP_MAX]);

/* Gives the others their keys of the table, but for those that are taken; phoe
 * says that W S A D Q E have phoe_ray's meaning. */
void keymap_settle(struct keymap *k, bool phoe);

/* What a key does. */
enum action keymap_action(const struct keymap *k, int key);

/* The action of this name; ACTION_NONE: there is none. */
enum action keymap_find_action(const char *name, size_t length);
const char *keymap_action_name(enum action action);

/* The key of this name: a character that is visible, ^A to ^_ for Ctrl, or a
 * word such as PgUp. 0: there is none. */
int keymap_find_key(const char *name, size_t length);

struct keymap_name {
    char text[8];
};

struct keymap_name keymap_key_name(int key);

/* The name of an action's first key, or "no key". */
struct keymap_name keymap_first_name(const struct keymap *k,
                                     enum action action);

struct keymap_help {
    char keys[32];
    const char *text;
};

/* Line `line` of the help, from 0; false behind the last. */
bool keys_help(const struct keymap *k, int line, struct keymap_help *help);

/* The same for the panel. */
enum panel_action keymap_panel_action(int key);
bool keymap_panel_help(int line, struct keymap_help *help);

#endif
