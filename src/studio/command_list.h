// SPDX-License-Identifier: MIT
/*
 * command_list.h - the list of all commands with their keys, searched by
 * ordinary words, and the menu, which is its short form
 *
 * Units:     terminal cells
 * Ownership: screen and keys are the caller's
 * Threads:   main only
 */
#ifndef GLIM_COMMAND_LIST_H
#define GLIM_COMMAND_LIST_H

#include "session/keymap.h"
#include "studio/list_window.h"

#define COMMANDS_MAX 128

struct command_list {
    struct list_window list;
    bool is_menu;     /* while nothing is searched for: only what leaves */
    bool in_panel;    /* keys of the panel come first */
    bool has_kept;    /* the menu has what to do with a kept session */
    char changes[64]; /* what "save changes" writes, in the menu; "": nothing */
    int all;          /* commands before the search */
    int count;        /* those that match */
    struct keymap_command commands[COMMANDS_MAX];
    int points[COMMANDS_MAX]; /* how well each matches */
};

/* Opens the window of the list, for the first time or after a new layout. */
void command_list_open(struct command_list *p, const struct keymap *keys,
                       struct screen *screen);

/* Fills the commands that match the search, the best first. */
void command_list_find(struct command_list *p, const struct keymap *keys);

/* Takes a key or the mouse. Returns the action of a command that is chosen, or
 * ACTION_NONE. */
enum action command_list_take(struct command_list *p, const struct keymap *keys,
                              struct screen *screen, const struct event *event);

#endif
