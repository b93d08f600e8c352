// SPDX-License-Identifier: MIT
#include "studio/help.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/print.h"
#include "glim/version.h"
#include "studio/progress_panel.h"
#include "terminal/tty_input.h"

/* ---- the bar ---- */

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

/* ---- the help ---- */

#define ESCAPE    27
#define BACKSPACE 127

/* Most keys of keyboard and panel together. */
#define ENTRIES_MAX 96

/* Row of the window where the search is, below the keys. */
#define SEARCH_ROWS 2

/* Keys that match the search, each with the title of its group. */
struct entries {
    struct keymap_help entry[ENTRIES_MAX];
    int count;
};

static bool contains(const char *text, const char *part)
{
    size_t length = strlen(part);

    for (; *text != '\0'; text++)
        if (strncasecmp(text, part, length) == 0)
            return true;
    return length == 0;
}

static void add_matching(struct entries *e, const char *search,
                         const struct keymap_help *help, const char *group)
{
    if (e->count == ENTRIES_MAX ||
        (!contains(help->text, search) && !contains(group, search) &&
         strcmp(help->keys, search) != 0))
        return;
    e->entry[e->count] = *help;
    e->entry[e->count++].group = group;
}

static void find_entries(struct entries *e, const char *search,
                         const struct keymap *keys, bool in_panel)
{
    struct keymap_help help;
    const char *group = "";

    e->count = 0;
    for (int i = 0; in_panel && keymap_panel_help(i, &help); i++) {
        group = help.group ? help.group : group;
        add_matching(e, search, &help, group);
    }
    for (int i = 0; keymap_help(keys, i, &help); i++) {
        group = help.group ? help.group : group;
        add_matching(e, search, &help, group);
    }
}

/* Place of the next item. Titles have a blank row above, and are not the last
 * of a column. */
struct place {
    int rows, columns; /* of a page */
    int page, column, row;
};

static void begin_column(struct place *p)
{
    p->row = 0;
    if (++p->column < p->columns)
        return;
    p->column = 0;
    p->page++;
}

static void add_item(struct help_page *page, struct place *p, int number,
                     const struct keymap_help *entry)
{
    struct help_item *item = &page->items[page->count];

    if (p->page == number && page->count < HELP_ITEMS_MAX) {
        *item = (struct help_item){p->row, p->column, *entry};
        page->count++;
        page->rows = p->row + 1 > page->rows ? p->row + 1 : page->rows;
        page->columns = p->column + 1;
    }
    p->row++;
}

/* Places all entries on pages of so many rows. Returns the number of pages. */
static int place_all(struct help_page *page, const struct entries *e, int rows,
                     int columns, int number)
{
    struct place p = {.rows = rows, .columns = columns};
    const char *group = NULL;

    *page = (struct help_page){.count = 0};
    for (int i = 0; i < e->count; i++) {
        const struct keymap_help *entry = &e->entry[i];
        bool is_first = group == NULL || strcmp(group, entry->group) != 0;
        struct keymap_help title = {.text = entry->group};

        group = entry->group;
        if (is_first && p.row > 0)
            p.row++;
        if (p.row + (is_first && rows > 1 ? 2 : 1) > rows)
            begin_column(&p);
        if (is_first && rows > 1)
            add_item(page, &p, number, &title);
        add_item(page, &p, number, entry);
    }
    return p.page + 1;
}

void help_lay_out(struct help_page *page, struct help *help,
                  const struct keymap *keys, bool in_panel, int cols, int rows)
{
    int columns = (cols + HELP_GAP) / (HELP_ENTRY_COLS + HELP_GAP);
    struct entries e;
    int fewest = rows > 1 ? 2 : 1;

    columns = columns < 1                  ? 1
              : columns > HELP_COLUMNS_MAX ? HELP_COLUMNS_MAX
                                           : columns;
    rows = rows < 1 ? 1 : rows > HELP_ROWS_MAX ? HELP_ROWS_MAX : rows;
    find_entries(&e, help->search, keys, in_panel);
    /* the lowest window that has everything, or pages of all rows */
    while (fewest < rows && place_all(page, &e, fewest, columns, 0) > 1)
        fewest++;
    help->page_count = place_all(page, &e, fewest, columns, 0);
    if (help->page >= help->page_count)
        help->page = help->page_count - 1;
    place_all(page, &e, fewest, columns, help->page);
}

static void draw_item(const struct help_item *item)
{
    int col = 2 + item->column * (HELP_ENTRY_COLS + HELP_GAP);
    int row = 1 + item->row;

    if (item->entry.keys[0] == '\0') {
        windows_text(WINDOW_OVER, row, col, HELP_ENTRY_COLS, ROLE_TITLE,
                     item->entry.text);
        return;
    }
    windows_text(WINDOW_OVER, row, col, HELP_KEY_COLS, ROLE_KEY,
                 item->entry.keys);
    windows_text(WINDOW_OVER, row, col + HELP_KEY_COLS,
                 HELP_ENTRY_COLS - HELP_KEY_COLS, ROLE_TEXT, item->entry.text);
}

static void draw_search(const struct help *help, int row, int cols,
                        const char *note)
{
    static const struct key_hint usual[] = {{"Esc", "closes"},
                                            {"type", "to search"},
                                            {NULL, NULL}};
    static const struct key_hint page_hints[] = {{"Esc", "closes"},
                                                 {"Down", "next page"},
                                                 {"type", "to search"},
                                                 {NULL, NULL}};
    char text[HELP_SEARCH + 16];

    if (help->search[0] != '\0') {
        snprintf(text, sizeof text, "search: %s_", help->search);
        windows_text(WINDOW_OVER, row, 2, cols, ROLE_TITLE, text);
        return;
    }
    windows_text(WINDOW_OVER, row, 2, cols, ROLE_FAINT, note);
    key_hints_draw(WINDOW_OVER, row - 1, 2, cols,
                   help->page_count > 1 ? page_hints : usual);
}

void help_draw(struct help *help, const struct keymap *keys, bool in_panel,
               const char *note, struct screen *screen)
{
    const char *lines[HELP_ROWS_MAX + SEARCH_ROWS];
    char widest[HELP_COLUMNS_MAX * (HELP_ENTRY_COLS + HELP_GAP) + 1];
    char title[64];
    struct tty_size size = term_size();
    struct help_page page;
    int cols;

    /* a border, a blank at each side of the text, and the status line below */
    help_lay_out(&page, help, keys, in_panel, size.cols - 4,
                 size.rows - 3 - SEARCH_ROWS);
    cols = page.columns > 0
               ? page.columns * (HELP_ENTRY_COLS + HELP_GAP) - HELP_GAP
               : HELP_ENTRY_COLS;
    cols = cols < size.cols - 4 ? cols : size.cols - 4;
    snprintf(widest, sizeof widest, "%*s", cols, "");
    for (int i = 0; i < page.rows + SEARCH_ROWS; i++)
        lines[i] = widest;
    if (help->page_count > 1)
        snprintf(title, sizeof title, " keys %d/%d ", help->page + 1,
                 help->page_count);
    else
        snprintf(title, sizeof title, " glim " GLIM_VERSION " - keys ");
    screen_open_window(screen, WINDOW_MIDDLE, title, lines,
                       page.rows + SEARCH_ROWS);
    for (int i = 0; i < page.count; i++)
        draw_item(&page.items[i]);
    if (page.count == 0)
        windows_text(WINDOW_OVER, 1, 2, cols, ROLE_FAINT, "no key does that");
    draw_search(help, page.rows + SEARCH_ROWS, cols, note);
}

void help_key(struct help *help, int key)
{
    size_t length = strlen(help->search);

    if (key == ESCAPE || key == '\r') {
        *help = (struct help){.is_open = false};
    } else if (key == TTY_KEY_DOWN || key == TTY_KEY_PAGE_DOWN) {
        help->page = (help->page + 1) % help->page_count;
    } else if (key == TTY_KEY_UP || key == TTY_KEY_PAGE_UP) {
        help->page = (help->page + help->page_count - 1) % help->page_count;
    } else if ((key == BACKSPACE || key == '\b') && length > 0) {
        help->search[length - 1] = '\0';
    } else if (key >= ' ' && key < BACKSPACE && length + 1 < HELP_SEARCH) {
        help->search[length] = (char)key;
        help->search[length + 1] = '\0';
        help->page = 0;
    }
}
