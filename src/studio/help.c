// SPDX-License-Identifier: MIT
#include "studio/help.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "glim/version.h"
#include "studio/keys_bar.h"
#include "terminal/tty_input.h"

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
