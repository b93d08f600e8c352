// SPDX-License-Identifier: MIT
/*
 * keymap.h - the table of commands and their keys
 *
 * keymap_list.h is the table. The configuration file can give actions other
 * keys, except in the panel. The manual repeats the table; a test compares
 * them.
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
#define GROUP(title)
#define KEY(action, name, text, words, ...) ACTION_##action,
#include "session/keymap_list.h"
#undef GROUP
#undef KEY
    ACTIONS
};

/* Actions of keys in the panel, which cannot be configured. */
enum panel_action {
    PANEL_NONE,
    PANEL_UP,
    PANEL_DOWN,
    PANEL_LESS,
    PANEL_MORE,
    PANEL_PAGE_UP,
    PANEL_PAGE_DOWN,
    PANEL_FIRST,
    PANEL_LAST,
    PANEL_FIND,
    PANEL_ENTER,
    PANEL_MUCH_LESS,
    PANEL_MUCH_MORE,
    PANEL_TYPE,
    PANEL_HSV,
    PANEL_NEXT_PAGE,
    PANEL_COPY,
    PANEL_REMOVE,
    PANEL_COMPARE,
    PANEL_LEAVE
};

/* Most keys of an action. */
#define KEYMAP_MAX 4

/* Keys of all actions. A zeroed struct has no keys yet. */
struct keymap {
    int keys[ACTIONS][KEYMAP_MAX];
    bool is_chosen[ACTIONS]; /* set by the configuration */
};

/* Gives the action exactly these keys and takes them from other actions that
 * were given them before. */
void keymap_choose(struct keymap *k, enum action action,
                   const int keys[KEYMAP_MAX]);

/* Gives all other actions their default keys, except keys that are taken. phoe
 * selects phoe_ray's meaning of W S A D Q E. */
void keymap_settle(struct keymap *k, bool phoe);

/* Returns the action of a key. */
enum action keymap_action(const struct keymap *k, int key);

/* Returns the action of this name, or ACTION_NONE. */
enum action keymap_find_action(const char *name, size_t length);

/* Returns the key of this name: a visible character, ^A to ^_ for Ctrl, or a
 * word such as PgUp. Returns 0 for unknown names. */
int keymap_find_key(const char *name, size_t length);

struct keymap_name {
    char text[8];
};

struct keymap_name keymap_key_name(int key);

/* Returns the name of an action's first key, or "no key". */
struct keymap_name keymap_first_name(const struct keymap *k,
                                     enum action action);

/* Names of up to six actions' first keys, as hints show them: "wasdqe", "Left
 * Right", or "arrows" for these four. */
struct keymap_names {
    char text[48];
};

struct keymap_names keymap_first_names(const struct keymap *k,
                                       const enum action *actions, int count);

/* A row of the list of commands. */
struct keymap_command {
    enum action action; /* ACTION_NONE: a key of the panel */
    char keys[32];      /* names of all its keys, "" for none */
    const char *text;   /* what it does */
    const char *words;  /* other words for that */
    const char *group;  /* title */
};

/* Fills row `index`, from 0, of the commands that are listed. Returns false
 * after the last one. */
bool keymap_command(const struct keymap *k, int index,
                    struct keymap_command *command);

/* Returns the panel's action of a key. */
enum panel_action keymap_panel_action(int key);
bool keymap_panel_command(int index, struct keymap_command *command);

#endif
