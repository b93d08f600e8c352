// SPDX-License-Identifier: MIT
#include "session/keymap.h"

#include <stdio.h>
#include <string.h>

#include "terminal/tty_input.h"

#define CTRL(letter) ((letter)&31)
#define ESCAPE       27

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

struct binding {
    enum action action;
    const char *name;
    int keys[KEYMAP_MAX];
    int phoe[KEYMAP_MAX]; /* phoe_ray's keys; empty: the same */
};

/* Default keys. q quits, so the key for down is Q, beside e for up. With Caps
 * Lock on, all of W A S D Q E move. */
static const struct binding bindings[] = {
    {ACTION_FORWARD, "forward", {'w', 'W'}, {'Q'}},
    {ACTION_BACK, "back", {'s', 'S'}, {'e', 'E'}},
    {ACTION_LEFT, "left", {'a', 'A'}, {0}},
    {ACTION_RIGHT, "right", {'d', 'D'}, {0}},
    {ACTION_DOWN,
     "down",
     {'Q', TTY_KEY_PAGE_DOWN},
     {'s', 'S', TTY_KEY_PAGE_DOWN}},
    {ACTION_UP, "up", {'e', 'E', TTY_KEY_PAGE_UP}, {'w', 'W', TTY_KEY_PAGE_UP}},
    {ACTION_LOOK_UP, "look-up", {TTY_KEY_UP}, {0}},
    {ACTION_LOOK_DOWN, "look-down", {TTY_KEY_DOWN}, {0}},
    {ACTION_LOOK_LEFT, "look-left", {TTY_KEY_LEFT}, {0}},
    {ACTION_LOOK_RIGHT, "look-right", {TTY_KEY_RIGHT}, {0}},
    {ACTION_FASTER, "faster", {'+', '='}, {0}},
    {ACTION_SLOWER, "slower", {'-', '_'}, {0}},
    {ACTION_CURSOR, "cursor", {'v', 'V'}, {0}},
    {ACTION_CANCEL, "cancel", {ESCAPE}, {0}},
    {ACTION_ORBIT, "orbit", {'o', 'O'}, {0}},
    {ACTION_WALLS, "walls", {'j', 'J'}, {0}},
    {ACTION_FRAME, "frame", {'z'}, {0}},
    {ACTION_FRAME_ALL, "frame-all", {'Z'}, {0}},
    {ACTION_NARROWER, "narrower", {'['}, {0}},
    {ACTION_WIDER, "wider", {']'}, {0}},
    {ACTION_FOCUS, "focus", {'f'}, {0}},
    {ACTION_CLOSE, "close-lens", {'{'}, {0}},
    {ACTION_OPEN, "open-lens", {'}'}, {0}},
    {ACTION_UNDO, "undo", {'u'}, {0}},
    {ACTION_REDO, "redo", {'U'}, {0}},
    {ACTION_RESET, "reset", {'r', 'R', TTY_KEY_HOME}, {0}},
    {ACTION_KEEP, "keep", {'k'}, {0}},
    {ACTION_VIEW_1, "view-1", {'1'}, {0}},
    {ACTION_VIEW_2, "view-2", {'2'}, {0}},
    {ACTION_VIEW_3, "view-3", {'3'}, {0}},
    {ACTION_VIEW_4, "view-4", {'4'}, {0}},
    {ACTION_VIEW_5, "view-5", {'5'}, {0}},
    {ACTION_VIEW_6, "view-6", {'6'}, {0}},
    {ACTION_VIEW_7, "view-7", {'7'}, {0}},
    {ACTION_VIEW_8, "view-8", {'8'}, {0}},
    {ACTION_VIEW_9, "view-9", {'9'}, {0}},
    {ACTION_SAVE_VIEW, "save-view", {'c'}, {0}},
    {ACTION_VIEW_NEXT, "next-view", {'n'}, {0}},
    {ACTION_VIEW_BACK, "previous-view", {'N'}, {0}},
    {ACTION_KEEP_RENDER, "keep-render", {'K'}, {0}},
    {ACTION_COMPARE, "compare", {'y', 'Y'}, {0}},
    {ACTION_FILTER, "filter", {'F'}, {0}},
    {ACTION_DRAWING, "drawing", {'t', 'T'}, {0}},
    {ACTION_LESS, "less", {'<'}, {0}},
    {ACTION_MORE, "more", {'>'}, {0}},
    {ACTION_PANEL, "panel", {'\t'}, {0}},
    {ACTION_MODE, "mode", {' '}, {0}},
    {ACTION_START, "start", {'\r'}, {0}},
    {ACTION_STEP, "step", {'.'}, {0}},
    {ACTION_RESTART, "restart", {'0'}, {0}},
    {ACTION_SAVE, "save", {'p'}, {0}},
    {ACTION_SAVE_TEXT, "save-text", {'x', 'X'}, {0}},
    {ACTION_SAVE_LINEAR, "save-linear", {'P'}, {0}},
    {ACTION_BACKEND, "backend", {'b', 'B'}, {0}},
    {ACTION_RELOAD, "reload", {'l', 'L'}, {0}},
    {ACTION_COLORS, "colors", {'C'}, {0}},
    {ACTION_GLYPHS, "glyphs", {'G'}, {0}},
    {ACTION_METER, "meter", {'g'}, {0}},
    {ACTION_HIDE, "hide", {'i', 'I'}, {0}},
    {ACTION_MOUSE, "mouse", {'m', 'M'}, {0}},
    {ACTION_REDRAW, "redraw", {CTRL('L')}, {0}},
    {ACTION_HELP, "help", {'?', 'h', TTY_KEY_F1}, {0}},
    {ACTION_SUSPEND, "suspend", {CTRL('Z')}, {0}},
    {ACTION_INTERRUPT, "interrupt", {CTRL('C')}, {0}},
    {ACTION_ABORT, "abort", {CTRL('\\')}, {0}},
    {ACTION_QUIT, "quit", {'q'}, {0}},
};

/* Lines of the help. A line shows the first key of each of its actions, or all
 * keys of its only action, without capitals beside their small letters. `keys`
 * replaces them while the defaults are in use. Keys take 8 columns of a window
 * of 40. */
static const struct line {
    const char *keys;
    enum action actions[4];
    const char *text;
} lines[] = {
    {NULL, {ACTION_FORWARD, ACTION_BACK}, "move forward, back"},
    {NULL, {ACTION_LEFT, ACTION_RIGHT}, "move left, right"},
    {NULL, {ACTION_DOWN, ACTION_UP}, "move down, up"},
    {"arrows",
     {ACTION_LOOK_LEFT, ACTION_LOOK_RIGHT, ACTION_LOOK_UP, ACTION_LOOK_DOWN},
     "look around, or drag"},
    {NULL, {ACTION_FASTER, ACTION_SLOWER}, "faster, slower, or wheel"},
    {NULL, {ACTION_WALLS}, "go through walls, or not"},
    {NULL, {ACTION_CURSOR}, "cursor; Enter or click picks"},
    {NULL, {ACTION_CANCEL}, "leave cursor, clear message"},
    {NULL, {ACTION_ORBIT}, "orbit the picked point"},
    {NULL, {ACTION_FRAME, ACTION_FRAME_ALL}, "frame picked object, scene"},
    {NULL, {ACTION_NARROWER, ACTION_WIDER}, "narrower, wider view"},
    {NULL, {ACTION_FOCUS}, "focus on the picked point"},
    {NULL, {ACTION_CLOSE, ACTION_OPEN}, "close, open the aperture"},
    {NULL, {ACTION_UNDO, ACTION_REDO}, "undo, redo changes"},
    {NULL, {ACTION_RESET}, "opened view, or whole scene"},
    {"1-9", {ACTION_VIEW_1}, "go to a numbered view"},
    {"k 1-9", {ACTION_KEEP}, "give this view a number"},
    {NULL, {ACTION_SAVE_VIEW}, "write the view file"},
    {NULL, {ACTION_VIEW_NEXT, ACTION_VIEW_BACK}, "preview, normals, cost, .."},
    {NULL, {ACTION_KEEP_RENDER, ACTION_COMPARE}, "keep renders, compare them"},
    {NULL, {ACTION_FILTER}, "filter the noise, or show it"},
    {NULL, {ACTION_DRAWING}, "draw boxes, lobes, a path"},
    {NULL, {ACTION_LESS, ACTION_MORE}, "its level or step"},
    {NULL, {ACTION_PANEL}, "materials, objects, light"},
    {NULL, {ACTION_MODE}, "live mode, normal mode"},
    {NULL, {ACTION_START}, "start, pause, continue"},
    {NULL, {ACTION_STEP}, "one more sample, then pause"},
    {NULL, {ACTION_RESTART}, "render again from sample 0"},
    {NULL, {ACTION_BACKEND}, "OpenCL device, or CPU"},
    {NULL, {ACTION_SAVE}, "save a new PNG file"},
    {NULL, {ACTION_SAVE_LINEAR}, "save a linear HDR file"},
    {NULL, {ACTION_SAVE_TEXT}, "save coloured text"},
    {NULL, {ACTION_RELOAD}, "load changed files"},
    {NULL, {ACTION_COLORS, ACTION_GLYPHS}, "colours, glyphs, pixels"},
    {NULL, {ACTION_METER}, "times, speeds, threads"},
    {NULL, {ACTION_HIDE}, "only the picture, or status"},
    {NULL, {ACTION_MOUSE}, "mouse off, on"},
    {NULL, {ACTION_REDRAW}, "redraw the screen"},
    {NULL, {ACTION_HELP}, "this help"},
    {NULL, {ACTION_SUSPEND}, "suspend"},
    {NULL, {ACTION_INTERRUPT, ACTION_ABORT}, "exit at once"},
    {NULL, {ACTION_QUIT}, "quit"},
};

/* Groups of the help, each with the action that its first line begins with. */
static const struct group {
    enum action first;
    const char *title;
} groups[] = {
    {ACTION_FORWARD, "Move"},    {ACTION_CURSOR, "Pick"},
    {ACTION_NARROWER, "Camera"}, {ACTION_VIEW_1, "Views"},
    {ACTION_VIEW_NEXT, "Look"},  {ACTION_PANEL, "Edit"},
    {ACTION_MODE, "Render"},     {ACTION_SAVE, "Files"},
    {ACTION_COLORS, "Screen"},
};

/* Lines of the help for the panel. `keys` replaces the keys' names. */
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
     "change by ten steps",
     {{'[', PANEL_MUCH_LESS}, {']', PANEL_MUCH_MORE}}},
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
    {NULL, "copy material, add a light", {{'n', PANEL_COPY}}},
    {NULL, "remove the light", {{'N', PANEL_REMOVE}}},
    {NULL, "compare with the saved state", {{'x', PANEL_COMPARE}}},
    {NULL, "save what was changed", {{CTRL('S'), PANEL_SAVE}}},
    {NULL, "to the list; close the panel", {{ESCAPE, PANEL_LEAVE}}},
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

void keymap_settle(struct keymap *k, bool phoe)
{
    for (size_t i = 0; i < COUNT(bindings); i++) {
        const struct binding *b = &bindings[i];
        const int *keys = phoe && b->phoe[0] != 0 ? b->phoe : b->keys;

        for (int j = 0; j < KEYMAP_MAX && !k->is_chosen[b->action]; j++)
            k->keys[b->action][j] =
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
    for (size_t i = 0; i < COUNT(bindings); i++) {
        if (is_name(bindings[i].name, name, length))
            return bindings[i].action;
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

static void add_key(struct keymap_help *help, int key)
{
    size_t length = strlen(help->keys);

    snprintf(help->keys + length, sizeof help->keys - length, "%s%s",
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

static void add_action(struct keymap_help *help, const struct keymap *k,
                       enum action action, bool only_first)
{
    bool has_first = false;

    for (int i = 0; i < KEYMAP_MAX; i++) {
        if ((has_first && only_first) || !is_shown(k->keys[action], i))
            continue;
        add_key(help, k->keys[action][i]);
        has_first = true;
    }
}

/* Returns the title of the group that begins with the action, or NULL. */
static const char *group_of(enum action first)
{
    for (size_t i = 0; i < COUNT(groups); i++)
        if (groups[i].first == first)
            return groups[i].title;
    return NULL;
}

bool keymap_help(const struct keymap *k, int line, struct keymap_help *help)
{
    const struct line *l;
    bool is_chosen = false;

    if (line < 0 || (size_t)line >= COUNT(lines))
        return false;
    l = &lines[line];
    *help =
        (struct keymap_help){.text = l->text, .group = group_of(l->actions[0])};
    for (size_t i = 0; i < COUNT(l->actions); i++)
        is_chosen |= k->is_chosen[l->actions[i]];
    if (l->keys && !is_chosen) {
        snprintf(help->keys, sizeof help->keys, "%s", l->keys);
        return true;
    }
    for (size_t i = 0; i < COUNT(l->actions); i++) {
        if (l->actions[i] != ACTION_NONE)
            add_action(help, k, l->actions[i], l->actions[1] != ACTION_NONE);
    }
    return true;
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

bool keymap_panel_help(int line, struct keymap_help *help)
{
    const struct panel_line *l;

    if (line < 0 || (size_t)line >= COUNT(panel_lines))
        return false;
    l = &panel_lines[line];
    *help = (struct keymap_help){.text = l->text,
                                 .group = line == 0 ? "Panel" : NULL};
    if (l->keys)
        snprintf(help->keys, sizeof help->keys, "%s", l->keys);
    for (int j = 0; !l->keys && l->does[j].key != 0; j++)
        add_key(help, l->does[j].key);
    return true;
}
