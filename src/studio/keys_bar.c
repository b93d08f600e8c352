// SPDX-License-Identifier: MIT
#include "studio/keys_bar.h"

#include <stdbool.h>
#include <stdio.h>

#include "base/print.h"
#include "studio/progress_panel.h"

/* ---- hints ---- */

#define GAP 2

const struct key_hint *key_hints_draw(enum window_part part, int row, int col,
                                      int cols, const struct key_hint *hints)
{
    int end = col + cols;

    for (; hints->does; hints++) {
        int key_cols = text_width_of(hints->key);
        int word_cols = text_width_of(hints->does);

        if (col + key_cols + 1 + word_cols > end)
            break;
        windows_text(part, row, col, key_cols, ROLE_KEY, hints->key);
        col += key_cols + 1;
        windows_text(part, row, col, word_cols, ROLE_FAINT, hints->does);
        col += word_cols + GAP;
    }
    return hints;
}

/* ---- the bar ---- */

#define HINTS_MAX 10

/* Columns of a bar beside the picture, at least: for a key and what it does. */
#define BESIDE_MIN 24

/* Rows of keys in a bar beside the picture, at most and beside the progress. */
#define KEY_ROWS     HINTS_MAX
#define KEY_ROWS_MIN 6

/* Rows of the progress, at least. */
#define ROOM_ROWS_MIN 4

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
    [KEYS_PANEL_NORMAL] = {{ACTION_MODE, NULL, "live mode"},
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

void keys_bar_lay_out(struct keys_bar *bar, struct screen *screen)
{
    struct tty_size size = term_size();
    struct cells_rect *fit = &screen->fit;
    int cols = size.cols - screen->panel_cols, rows = size.rows - 1;

    *bar = (struct keys_bar){.state = KEYS_NONE};
    screen->foot_rows = 1;
    if (screen->is_too_small || !screen->has_status_row || cols <= 0)
        return;
    if (cols - fit->cols >= BESIDE_MIN) {
        fit->col = 0;
        bar->area = (struct window_rect){fit->cols, 0, cols - fit->cols, rows};
        bar->key_rows = rows - PROGRESS_TEXT_USUAL_ROWS;
        bar->key_rows = bar->key_rows < KEY_ROWS_MIN ? KEY_ROWS_MIN
                        : bar->key_rows > KEY_ROWS   ? KEY_ROWS
                                                     : bar->key_rows;
    } else if (rows > fit->rows) {
        fit->row = 0;
        bar->area = (struct window_rect){0, fit->rows, cols, rows - fit->rows};
        bar->key_rows = 1;
        screen->foot_rows = 2;
    }
}

const struct window_rect *keys_bar_room(const struct keys_bar *bar,
                                        struct window_rect *room)
{
    *room = bar->area;
    room->rows -= bar->key_rows;
    return room->rows >= ROOM_ROWS_MIN && room->cols > PROGRESS_TEXT_COLS
               ? room
               : NULL;
}

void keys_bar_draw(struct keys_bar *bar, const struct live_render *control,
                   struct screen *screen, enum keys_state state)
{
    struct keymap_name names[HINTS_MAX];
    struct key_hint list[HINTS_MAX + 1] = {{NULL, NULL}};
    const struct key_hint *left = list;

    if (bar->area.cols == 0 || bar->state == state)
        return;
    for (int row = -bar->area.rows; row < 0 && bar->state == KEYS_NONE; row++)
        windows_text(WINDOW_STATUS, row, bar->area.col, bar->area.cols,
                     ROLE_TEXT, "");
    bar->state = state;
    for (int i = 0; i < HINTS_MAX && hints[state][i].does; i++) {
        const struct hint *h = &hints[state][i];

        names[i] = live_render_key(control, h->action);
        list[i] = (struct key_hint){h->keys ? h->keys : names[i].text, h->does};
    }
    for (int row = -bar->key_rows; row < 0; row++) {
        struct key_hint one[2] = {*left, {NULL, NULL}};

        windows_text(WINDOW_STATUS, row, bar->area.col, bar->area.cols,
                     ROLE_FAINT, "");
        key_hints_draw(WINDOW_STATUS, row, bar->area.col + 1,
                       bar->area.cols - 1, bar->key_rows > 1 ? one : list);
        left += left->does != NULL;
    }
    screen->must_update = true;
}
