// SPDX-License-Identifier: MIT
#include "studio/keys_bar.h"

#include <stdio.h>

#include "studio/key_hints.h"

#define HINTS_MAX 10

/* Actions with what they do. Where an action has no key of its own, the text
 * has it. */
struct hint {
    enum action action;
    const char *keys, *does;
};

/* Hints of each state, the way out of it first. */
static const struct hint hints[KEYS_STATES][HINTS_MAX] = {
    [KEYS_LIVE] = {{ACTION_NONE, "wasdqe", "move"},
                   {ACTION_NONE, "arrows", "look"},
                   {ACTION_CURSOR, NULL, "pick"},
                   {ACTION_PANEL, NULL, "materials"},
                   {ACTION_VIEW_NEXT, NULL, "views"},
                   {ACTION_KEEP_RENDER, NULL, "compare"},
                   {ACTION_METER, NULL, "meters"},
                   {ACTION_SAVE, NULL, "save"},
                   {ACTION_MODE, NULL, "normal mode"}},
    [KEYS_PAUSED] = {{ACTION_START, NULL, "goes on"},
                     {ACTION_STEP, NULL, "one sample"},
                     {ACTION_PANEL, NULL, "materials"},
                     {ACTION_SAVE, NULL, "save"},
                     {ACTION_MODE, NULL, "other mode"}},
    [KEYS_NORMAL] = {{ACTION_MODE, NULL, "live mode"},
                     {ACTION_START, NULL, "start, pause"},
                     {ACTION_SAVE, NULL, "save"},
                     {ACTION_METER, NULL, "meters"},
                     {ACTION_KEEP_RENDER, NULL, "compare"}},
    [KEYS_CURSOR] = {{ACTION_CANCEL, NULL, "leave"},
                     {ACTION_NONE, "arrows", "move"},
                     {ACTION_START, NULL, "pick"},
                     {ACTION_ORBIT, NULL, "orbit it"},
                     {ACTION_FRAME, NULL, "frame it"},
                     {ACTION_FOCUS, NULL, "focus"}},
    [KEYS_PANEL] = {{ACTION_NONE, "wasdqe", "move"},
                    {ACTION_CURSOR, NULL, "pick"},
                    {ACTION_METER, NULL, "meters"},
                    {ACTION_KEEP_RENDER, NULL, "compare"},
                    {ACTION_SAVE, NULL, "save"}},
    [KEYS_ORBIT] = {{ACTION_ORBIT, NULL, "leave the orbit"},
                    {ACTION_NONE, "arrows", "around"},
                    {ACTION_NONE, "w s", "near, far"},
                    {ACTION_NONE, "Q e", "down, up"}},
    [KEYS_VIEW] = {{ACTION_VIEW_BACK, NULL, "back"},
                   {ACTION_VIEW_NEXT, NULL, "next view"},
                   {ACTION_SAVE, NULL, "save it"}},
    [KEYS_DRAWING] = {{ACTION_DRAWING, NULL, "next drawing, none"},
                      {ACTION_LESS, NULL, "less"},
                      {ACTION_MORE, NULL, "more"},
                      {ACTION_CURSOR, NULL, "elsewhere"}},
    [KEYS_COMPARE] = {{ACTION_CANCEL, NULL, "ends"},
                      {ACTION_NONE, "Left Right", "wipe"},
                      {ACTION_NONE, "Up Down", "others"},
                      {ACTION_COMPARE, NULL, "wipe, differences"},
                      {ACTION_KEEP_RENDER, NULL, "keep"}},
};

void keys_bar_draw(struct keys_bar *bar, const struct render_control *control,
                   struct screen *screen, enum keys_state state)
{
    struct keymap_name names[HINTS_MAX];
    struct key_hint list[HINTS_MAX + 1] = {{NULL, NULL}};
    int cols = term_size().cols - screen->panel_cols;
    bool has_row = !screen->is_too_small && screen->has_status_row &&
                   screen->fit.row + screen->fit.rows < term_size().rows - 1;

    if (!has_row || cols <= 0 || (bar->state == state && bar->cols == cols))
        return;
    *bar = (struct keys_bar){state, cols};
    for (int i = 0; i < HINTS_MAX && hints[state][i].does; i++) {
        const struct hint *h = &hints[state][i];

        names[i] = render_control_key(control, h->action);
        list[i] = (struct key_hint){h->keys ? h->keys : names[i].text, h->does};
    }
    windows_text(WINDOW_STATUS, -1, 0, cols, ROLE_FAINT, "");
    key_hints_draw(WINDOW_STATUS, -1, 1, cols - 1, list);
    screen->must_update = true;
}
