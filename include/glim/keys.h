// SPDX-License-Identifier: MIT
/*
 * keys.h - which key does what, and the help that says so
 *
 * Units:     none
 * Ownership: strings live as long as the program
 * Threads:   any
 * Errors:    none
 */
#ifndef GLIM_KEYS_H
#define GLIM_KEYS_H

#include <stdbool.h>

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
    ACTION_MODE,
    ACTION_START,
    ACTION_STEP, /* one more sample a pixel */
    ACTION_RESTART,
    ACTION_SAVE,
    ACTION_SAVE_LINEAR,
    ACTION_SAVE_VIEW,
    ACTION_RESET,
    ACTION_METER, /* progress */
    ACTION_HIDE,
    ACTION_RELOAD, /* the files of the scene */
    ACTION_BACKEND,
    ACTION_COLORS,
    ACTION_MOUSE,
    ACTION_REDRAW,
    ACTION_HELP,
    ACTION_QUIT,
    ACTION_INTERRUPT, /* Ctrl-C */
    ACTION_ABORT,     /* Ctrl-\ */
    ACTION_SUSPEND
};

/* What a key (a byte or enum input_key) does; phoe says that W S A D Q E have
 * phoe_ray's meaning. */
enum action keys_action(int key, bool phoe);

struct keys_help {
    const char *keys;
    const char *text;
};

/* The lines of the help window, in order; NULL behind the last. */
const struct keys_help *keys_help(int line, bool phoe);

#endif
