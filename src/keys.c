// SPDX-License-Identifier: MIT
#include "glim/keys.h"

#include <stddef.h>

#include "glim/input.h"

#define CTRL(letter) ((letter)&31)
#define KEYS_MAX     3

struct binding {
    enum action action;
    int keys[KEYS_MAX];
};

/* q quits, so the letter of the row Q E that moves down needs Shift; with Caps
 * Lock on all six do as they are written. */
static const struct binding own_keys[] = {
    {ACTION_FORWARD, {'w', 'W'}}, {ACTION_BACK, {'s', 'S'}},
    {ACTION_LEFT, {'a', 'A'}},    {ACTION_RIGHT, {'d', 'D'}},
    {ACTION_DOWN, {'Q'}},         {ACTION_UP, {'e', 'E'}},
};

static const struct binding phoe_keys[] = {
    {ACTION_UP, {'w', 'W'}},   {ACTION_DOWN, {'s', 'S'}},
    {ACTION_LEFT, {'a', 'A'}}, {ACTION_RIGHT, {'d', 'D'}},
    {ACTION_FORWARD, {'Q'}},   {ACTION_BACK, {'e', 'E'}},
};

static const struct binding common_keys[] = {
    {ACTION_DOWN, {INPUT_PAGE_DOWN}},
    {ACTION_UP, {INPUT_PAGE_UP}},
    {ACTION_LOOK_UP, {INPUT_UP}},
    {ACTION_LOOK_DOWN, {INPUT_DOWN}},
    {ACTION_LOOK_LEFT, {INPUT_LEFT}},
    {ACTION_LOOK_RIGHT, {INPUT_RIGHT}},
    {ACTION_FASTER, {'+', '='}},
    {ACTION_SLOWER, {'-', '_'}},
    {ACTION_MODE, {' '}},
    {ACTION_START, {'\r'}},
    {ACTION_STEP, {'.'}},
    {ACTION_RESTART, {'0'}},
    {ACTION_SAVE, {'p'}},
    {ACTION_SAVE_LINEAR, {'P'}},
    {ACTION_SAVE_VIEW, {'c'}},
    {ACTION_RESET, {'r', 'R', INPUT_HOME}},
    {ACTION_METER, {'t', 'T'}},
    {ACTION_HIDE, {'i', 'I'}},
    {ACTION_RELOAD, {'l', 'L'}},
    {ACTION_BACKEND, {'b', 'B'}},
    {ACTION_COLORS, {'C'}},
    {ACTION_MOUSE, {'m', 'M'}},
    {ACTION_REDRAW, {CTRL('L')}},
    {ACTION_HELP, {'?', 'h', INPUT_F1}},
    {ACTION_QUIT, {'q'}},
    {ACTION_INTERRUPT, {CTRL('C')}},
    {ACTION_ABORT, {CTRL('\\')}},
    {ACTION_SUSPEND, {CTRL('Z')}},
};

static const struct keys_help own_help[] = {
    {"w s", "move forward, back"},
    {"a d", "move left, right"},
    {"Q e", "move down, up (or PgDn, PgUp)"},
};

static const struct keys_help phoe_help[] = {
    {"w s", "move up, down"},
    {"a d", "move left, right"},
    {"Q e", "move forward, back"},
};

static const struct keys_help common_help[] = {
    {"arrows", "look around (or drag with the mouse)"},
    {"+ -", "move faster, slower (or the wheel)"},
    {"r", "back to the view as opened"},
    {"space", "live mode, normal mode"},
    {"Enter", "start, pause, go on"},
    {".", "one more sample a pixel, then pause"},
    {"0", "render anew, from sample 0"},
    {"p", "save the picture as a new PNG file"},
    {"P", "the same as HDR, linear"},
    {"c", "write the view to the view file"},
    {"l", "load the files of the scene anew"},
    {"b", "render on the OpenCL device, or on the CPU"},
    {"C", "next colours: 24 bit, 256, 16, mono"},
    {"t", "progress: times, speeds, threads"},
    {"i", "hide everything but the picture"},
    {"m", "mouse on, off"},
    {"^L", "draw the screen anew"},
    {"^Z", "back to the shell for a while"},
    {"? h F1", "this help"},
    {"q", "quit"},
};

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static enum action find(const struct binding *bindings, size_t count, int key)
{
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < KEYS_MAX; k++) {
            if (bindings[i].keys[k] != 0 && bindings[i].keys[k] == key)
                return bindings[i].action;
        }
    }
    return ACTION_NONE;
}

enum action keys_action(int key, bool phoe)
{
    enum action action = phoe ? find(phoe_keys, COUNT(phoe_keys), key)
                              : find(own_keys, COUNT(own_keys), key);

    if (action != ACTION_NONE)
        return action;
    return find(common_keys, COUNT(common_keys), key);
}

const struct keys_help *keys_help(int line, bool phoe)
{
    size_t i = (size_t)line;

    if (i < COUNT(own_help))
        return phoe ? &phoe_help[i] : &own_help[i];
    i -= COUNT(own_help);
    return i < COUNT(common_help) ? &common_help[i] : NULL;
}
