// SPDX-License-Identifier: MIT
#include "session/keymap.h"

#include <stdio.h>
#include <string.h>

#include "terminal/tty_input.h"

#define CTRL(letter) ((letter)&31)
#define ESCAPE       27

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

/* A row of keymap_list.h: an action, or the title of a group. */
static const struct row {
    const char *title;
    enum action action;
    const char *name;
    const char *text;
    const char *words;
    int keys[KEYMAP_MAX];
} rows[] = {
#define GROUP(title) {title, ACTION_NONE, NULL, NULL, NULL, {0}},
#define KEY(action, name, text, words, ...) \
    {NULL, ACTION_##action, name, text, words, {__VA_ARGS__}},
#include "session/keymap_list.h"
#undef GROUP
#undef KEY
};

/* phoe_ray's keys where they differ. */
static const struct {
    enum action action;
    int keys[KEYMAP_MAX];
} phoe_keys[] = {
    {ACTION_FORWARD, {'q', 'Q'}},
    {ACTION_BACK, {'e', 'E'}},
    {ACTION_DOWN, {'s', 'S', TTY_KEY_PAGE_DOWN}},
    {ACTION_UP, {'w', 'W', TTY_KEY_PAGE_UP}},
};

/* Rows of the panel's keys. `keys` replaces the keys' names. */
#define PANEL_KEYS_MAX 13

static const struct panel_line {
    const char *keys;
    const char *text;
    struct {
        int key;
        enum panel_action action;
    } does[PANEL_KEYS_MAX];
} panel_lines[] = {
    {"arrows",
     "choose; change by a step",
     {{TTY_KEY_UP, PANEL_UP},
      {TTY_KEY_DOWN, PANEL_DOWN},
      {TTY_KEY_LEFT, PANEL_LESS},
      {TTY_KEY_RIGHT, PANEL_MORE}}},
    {"PgUp/Dn",
     "ten lines up, down",
     {{TTY_KEY_PAGE_UP, PANEL_PAGE_UP}, {TTY_KEY_PAGE_DOWN, PANEL_PAGE_DOWN}}},
    {NULL,
     "first line, last line",
     {{TTY_KEY_HOME, PANEL_FIRST}, {TTY_KEY_END, PANEL_LAST}}},
    {NULL, "find a name in the list", {{'/', PANEL_FIND}}},
    {NULL,
     "change by ten steps",
     {{'(', PANEL_MUCH_LESS}, {')', PANEL_MUCH_MORE}}},
    {NULL, "to the values; type, switch", {{'\r', PANEL_ENTER}}},
    {"0-9.-#",
     "type a value",
     {{'0', PANEL_TYPE},
      {'1', PANEL_TYPE},
      {'2', PANEL_TYPE},
      {'3', PANEL_TYPE},
      {'4', PANEL_TYPE},
      {'5', PANEL_TYPE},
      {'6', PANEL_TYPE},
      {'7', PANEL_TYPE},
      {'8', PANEL_TYPE},
      {'9', PANEL_TYPE},
      {'.', PANEL_TYPE},
      {'-', PANEL_TYPE},
      {'#', PANEL_TYPE}}},
    {NULL, "colours by HSV, by RGB", {{'h', PANEL_HSV}}},
    {NULL, "next of the three pages", {{'\t', PANEL_NEXT_PAGE}}},
    {NULL,
     "copy material, add a light",
     {{TTY_KEY_INSERT, PANEL_COPY}, {CTRL('N'), PANEL_COPY}}},
    {NULL,
     "remove the light",
     {{TTY_KEY_DELETE, PANEL_REMOVE}, {CTRL('D'), PANEL_REMOVE}}},
    {NULL, "compare with what is saved", {{'\\', PANEL_COMPARE}}},
    {NULL, "to the list; out of it", {{ESCAPE, PANEL_LEAVE}}},
};

static const struct key_name {
    int key;
    const char *name;
} key_names[] = {
    {' ', "space"},
    {'\r', "Enter"},
    {'\t', "Tab"},
    {ESCAPE, "Esc"},
    {127, "Bksp"},
    {TTY_KEY_UP, "Up"},
    {TTY_KEY_DOWN, "Down"},
    {TTY_KEY_LEFT, "Left"},
    {TTY_KEY_RIGHT, "Right"},
    {TTY_KEY_PAGE_UP, "PgUp"},
    {TTY_KEY_PAGE_DOWN, "PgDn"},
    {TTY_KEY_HOME, "Home"},
    {TTY_KEY_END, "End"},
    {TTY_KEY_INSERT, "Ins"},
    {TTY_KEY_DELETE, "Del"},
    {TTY_KEY_F1, "F1"},
};

static void take_away(struct keymap *k, enum action action, int key)
{
    for (int i = 0; i < KEYMAP_MAX; i++) {
        if (k->keys[action][i] == key)
            k->keys[action][i] = 0;
    }
}

void keymap_choose(struct keymap *k, enum action action,
                   const int keys[KEYMAP_MAX])
{
    for (int i = 0; i < KEYMAP_MAX; i++) {
        for (int other = 0; other < ACTIONS; other++)
            take_away(k, (enum action)other, keys[i]);
    }
    memcpy(k->keys[action], keys, sizeof k->keys[action]);
    k->is_chosen[action] = true;
}

static const int *default_keys(const struct row *row, bool phoe)
{
    for (size_t i = 0; phoe && i < COUNT(phoe_keys); i++)
        if (phoe_keys[i].action == row->action)
            return phoe_keys[i].keys;
    return row->keys;
}

void keymap_settle(struct keymap *k, bool phoe)
{
    for (size_t i = 0; i < COUNT(rows); i++) {
        enum action action = rows[i].action;
        const int *keys = default_keys(&rows[i], phoe);

        for (int j = 0; j < KEYMAP_MAX && !k->is_chosen[action]; j++)
            k->keys[action][j] =
                keymap_action(k, keys[j]) == ACTION_NONE ? keys[j] : 0;
    }
}

enum action keymap_action(const struct keymap *k, int key)
{
    for (int action = 0; action < ACTIONS && key != 0; action++) {
        for (int i = 0; i < KEYMAP_MAX; i++) {
            if (k->keys[action][i] == key)
                return (enum action)action;
        }
    }
    return ACTION_NONE;
}

static bool is_name(const char *name, const char *text, size_t length)
{
    return strlen(name) == length && memcmp(name, text, length) == 0;
}

enum action keymap_find_action(const char *name, size_t length)
{
    for (size_t i = 0; i < COUNT(rows); i++) {
        if (rows[i].name != NULL && is_name(rows[i].name, name, length))
            return rows[i].action;
    }
    return ACTION_NONE;
}

int keymap_find_key(const char *name, size_t length)
{
    if (length == 1 && name[0] > ' ' && name[0] < 127)
        return name[0];
    if (length == 2 && name[0] == '^' && name[1] > '@' && name[1] <= '_')
        return CTRL(name[1]);
    for (size_t i = 0; i < COUNT(key_names); i++) {
        if (is_name(key_names[i].name, name, length))
            return key_names[i].key;
    }
    return 0;
}

struct keymap_name keymap_key_name(int key)
{
    struct keymap_name name;

    for (size_t i = 0; i < COUNT(key_names); i++) {
        if (key_names[i].key == key) {
            snprintf(name.text, sizeof name.text, "%s", key_names[i].name);
            return name;
        }
    }
    if (key < ' ')
        snprintf(name.text, sizeof name.text, "^%c", key | 64);
    else
        snprintf(name.text, sizeof name.text, "%c", key);
    return name;
}

struct keymap_name keymap_first_name(const struct keymap *k, enum action action)
{
    for (int i = 0; i < KEYMAP_MAX; i++) {
        if (k->keys[action][i] != 0)
            return keymap_key_name(k->keys[action][i]);
    }
    return (struct keymap_name){"no key"};
}

struct keymap_names keymap_first_names(const struct keymap *k,
                                       const enum action *actions, int count)
{
    static const int arrows[] = {TTY_KEY_LEFT, TTY_KEY_RIGHT, TTY_KEY_UP,
                                 TTY_KEY_DOWN};
    struct keymap_names names = {""};
    bool is_arrows = count == COUNT(arrows), is_short = count > 2;
    size_t length = 0;

    for (int i = 0; i < count; i++) {
        is_arrows = is_arrows && k->keys[actions[i]][0] == arrows[i];
        is_short = is_short && keymap_first_name(k, actions[i]).text[1] == '\0';
    }
    if (is_arrows)
        return (struct keymap_names){"arrows"};
    for (int i = 0; i < count; i++)
        length +=
            (size_t)snprintf(names.text + length, sizeof names.text - length,
                             "%s%s", i > 0 && !is_short ? " " : "",
                             keymap_first_name(k, actions[i]).text);
    return names;
}

static void add_key(struct keymap_command *command, int key)
{
    size_t length = strlen(command->keys);

    snprintf(command->keys + length, sizeof command->keys - length, "%s%s",
             length > 0 ? " " : "", keymap_key_name(key).text);
}

/* Returns false for a capital beside its small letter. */
static bool is_shown(const int keys[KEYMAP_MAX], int i)
{
    int key = keys[i];

    if (key == 0)
        return false;
    for (int j = 0; j < i; j++) {
        if (key >= 'A' && key <= 'Z' && keys[j] == key - 'A' + 'a')
            return false;
    }
    return true;
}

bool keymap_command(const struct keymap *k, int index,
                    struct keymap_command *command)
{
    const char *group = "";

    for (size_t i = 0; i < COUNT(rows); i++) {
        const struct row *row = &rows[i];

        group = row->title != NULL ? row->title : group;
        if (row->text == NULL || index-- > 0)
            continue;
        *command = (struct keymap_command){.action = row->action,
                                           .text = row->text,
                                           .words = row->words,
                                           .group = group};
        for (int j = 0; j < KEYMAP_MAX; j++)
            if (is_shown(k->keys[row->action], j))
                add_key(command, k->keys[row->action][j]);
        return true;
    }
    return false;
}

enum panel_action keymap_panel_action(int key)
{
    for (size_t i = 0; i < COUNT(panel_lines) && key != 0; i++) {
        for (int j = 0; j < PANEL_KEYS_MAX; j++) {
            if (panel_lines[i].does[j].key == key)
                return panel_lines[i].does[j].action;
        }
    }
    return PANEL_NONE;
}

bool keymap_panel_command(int index, struct keymap_command *command)
{
    const struct panel_line *l;

    if (index < 0 || (size_t)index >= COUNT(panel_lines))
        return false;
    l = &panel_lines[index];
    *command =
        (struct keymap_command){.text = l->text, .words = "", .group = "Panel"};
    if (l->keys)
        snprintf(command->keys, sizeof command->keys, "%s", l->keys);
    for (int j = 0; !l->keys && l->does[j].key != 0; j++)
        add_key(command, l->does[j].key);
    return true;
}
