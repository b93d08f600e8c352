// SPDX-License-Identifier: MIT
#include "studio/keys_bar.h"

#include "base/min_max.h"
#include "base/print.h"

/* ---- hints ---- */

#define GAP 2

static int hint_columns(const struct key_hint *hint)
{
    return text_width_of(hint->key) + 1 + text_width_of(hint->does);
}

const struct key_hint *key_hints_draw(enum window_part part, int row, int col,
                                      int cols, const struct key_hint *hints)
{
    int end = col + cols;

    for (; hints->does && col + hint_columns(hints) <= end; hints++) {
        int key_cols = text_width_of(hints->key);

        windows_text(part, row, col, key_cols, ROLE_KEY, hints->key);
        windows_text(part, row, col + key_cols + 1, text_width_of(hints->does),
                     ROLE_FAINT, hints->does);
        col += hint_columns(hints) + GAP;
    }
    return hints;
}

/* ---- the bar ---- */

/* Columns of a bar beside the picture, at least: for a key and what it does. */
#define BESIDE_MIN 24

/* Rows and columns of the graph, at least, and columns for each of its rows. */
#define ROOM_ROWS  4
#define ROOM_COLS  BESIDE_MIN
#define ROOM_SHAPE 3

#define HINT_ACTIONS 6

/* Actions with what they do together. */
struct hint {
    const char *does;
    enum action actions[HINT_ACTIONS];
};

#define MOVES                                                                \
    {                                                                        \
        ACTION_FORWARD, ACTION_LEFT, ACTION_BACK, ACTION_RIGHT, ACTION_DOWN, \
            ACTION_UP                                                        \
    }
#define LOOKS                                                                 \
    {                                                                         \
        ACTION_LOOK_LEFT, ACTION_LOOK_RIGHT, ACTION_LOOK_UP, ACTION_LOOK_DOWN \
    }

/* Hints of each state, the way out of it first. */
static const struct hint hints[KEYS_STATES][HINTS_MAX] = {
    [KEYS_LIVE] = {{"move", MOVES},
                   {"look", LOOKS},
                   {"pick", {ACTION_CURSOR}},
                   {"materials", {ACTION_PANEL}},
                   {"preview", {ACTION_VIEW_NEXT}},
                   {"compare", {ACTION_KEEP_RENDER}},
                   {"save", {ACTION_SAVE}},
                   {"normal mode", {ACTION_MODE}},
                   {"menu", {ACTION_CANCEL}}},
    [KEYS_PAUSED] = {{"goes on", {ACTION_START}},
                     {"one sample", {ACTION_STEP}},
                     {"materials", {ACTION_PANEL}},
                     {"save", {ACTION_SAVE}},
                     {"other mode", {ACTION_MODE}},
                     {"menu", {ACTION_CANCEL}}},
    [KEYS_NORMAL] = {{"live mode", {ACTION_MODE}},
                     {"start, pause", {ACTION_START}},
                     {"save", {ACTION_SAVE}},
                     {"about", {ACTION_ABOUT}},
                     {"compare", {ACTION_KEEP_RENDER}},
                     {"menu", {ACTION_CANCEL}}},
    [KEYS_CURSOR] = {{"leave", {ACTION_CANCEL}},
                     {"move", LOOKS},
                     {"pick", {ACTION_START}},
                     {"orbit it", {ACTION_ORBIT}},
                     {"frame it", {ACTION_FRAME}},
                     {"focus", {ACTION_FOCUS}}},
    [KEYS_PANEL] = {{"move", MOVES},
                    {"pick", {ACTION_CURSOR}},
                    {"about", {ACTION_ABOUT}},
                    {"compare", {ACTION_KEEP_RENDER}},
                    {"save", {ACTION_SAVE}}},
    [KEYS_PANEL_NORMAL] = {{"live mode", {ACTION_MODE}},
                           {"pick", {ACTION_CURSOR}},
                           {"about", {ACTION_ABOUT}},
                           {"compare", {ACTION_KEEP_RENDER}},
                           {"save", {ACTION_SAVE}}},
    [KEYS_ORBIT] = {{"leave the orbit", {ACTION_CANCEL}},
                    {"around", LOOKS},
                    {"near, far", {ACTION_FORWARD, ACTION_BACK}},
                    {"down, up", {ACTION_DOWN, ACTION_UP}}},
    [KEYS_VIEW] = {{"leave", {ACTION_CANCEL}},
                   {"next view", {ACTION_VIEW_NEXT}},
                   {"view before", {ACTION_VIEW_BACK}},
                   {"save it", {ACTION_SAVE}}},
    [KEYS_DRAWING] = {{"ends", {ACTION_CANCEL}},
                      {"next drawing", {ACTION_DRAWING}},
                      {"less, more", {ACTION_LESS, ACTION_MORE}},
                      {"elsewhere", {ACTION_CURSOR}}},
    [KEYS_COMPARE] = {{"ends", {ACTION_CANCEL}},
                      {"wipe", {ACTION_LOOK_LEFT, ACTION_LOOK_RIGHT}},
                      {"others", {ACTION_LOOK_UP, ACTION_LOOK_DOWN}},
                      {"wipe, differences", {ACTION_COMPARE}},
                      {"keep", {ACTION_KEEP_RENDER}}},
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
        bar->key_rows = int_min(rows, HINTS_MAX);
    } else if (rows > fit->rows) {
        fit->row = 0;
        bar->area = (struct window_rect){0, fit->rows, cols, rows - fit->rows};
        bar->key_rows = 1;
        screen->foot_rows = 2;
    }
}

bool keys_bar_room(const struct keys_bar *bar, struct window_rect *room)
{
    *room = bar->area;
    room->rows = int_min(room->rows - bar->key_rows, room->cols / ROOM_SHAPE);
    return room->rows >= ROOM_ROWS && room->cols >= ROOM_COLS;
}

enum action keys_bar_action_at(const struct keys_bar *bar, int col, int row)
{
    for (int i = 0; i < bar->spot_count; i++) {
        const struct window_rect *at = &bar->spots[i].at;

        if (row == at->row && col >= at->col && col < at->col + at->cols)
            return bar->spots[i].action;
    }
    return ACTION_NONE;
}

/* Notes where the hints from `from` up to `end` are drawn, in a row counted
 * from the last one of the screen. `of` are the same hints. */
static void note_spots(struct keys_bar *bar, int row, const struct hint *of,
                       const struct key_hint *from, const struct key_hint *end)
{
    int col = bar->area.col + 1;

    for (; from != end; from++, of++) {
        int cols = hint_columns(from);

        bar->spots[bar->spot_count++] =
            (struct hint_spot){{col, term_size().rows - 1 + row, cols, 1},
                               of->actions[1] == ACTION_NONE ? of->actions[0]
                                                             : ACTION_NONE};
        col += cols + GAP;
    }
}

void keys_bar_draw(struct keys_bar *bar, const struct live_render *control,
                   struct screen *screen, enum keys_state state)
{
    const struct keymap *keys = &control->session->options->keys;
    struct keymap_names names[HINTS_MAX];
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
        int count = 0;

        while (count < HINT_ACTIONS && h->actions[count] != ACTION_NONE)
            count++;
        names[i] = keymap_first_names(keys, h->actions, count);
        list[i] = (struct key_hint){names[i].text, h->does};
    }
    bar->spot_count = 0;
    for (int row = -bar->key_rows; row < 0; row++) {
        struct key_hint one[2] = {*left, {NULL, NULL}};
        const struct key_hint *from = bar->key_rows > 1 ? one : list, *end;

        windows_text(WINDOW_STATUS, row, bar->area.col, bar->area.cols,
                     ROLE_FAINT, "");
        end = key_hints_draw(WINDOW_STATUS, row, bar->area.col + 1,
                             bar->area.cols - 1, from);
        note_spots(bar, row, hints[state] + (left - list), from, end);
        left += left->does != NULL;
    }
    screen->must_update = true;
}
