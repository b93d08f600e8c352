// SPDX-License-Identifier: MIT
#include "studio/help.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Finds entry `i` of the list. The panel's entries come first if in_panel.
 * Returns false behind the last key. */
static bool find_entry(const struct keymap *keys, bool in_panel, int i,
                       struct keymap_help *help)
{
    int count = 0;

    while (in_panel && keymap_panel_help(count, help))
        count++;
    return i < count ? keymap_panel_help(i, help)
                     : keymap_help(keys, i - count, help);
}

static int count_lines(const struct keymap *keys, bool in_panel)
{
    struct keymap_help help;
    int count = 0;

    while (find_entry(keys, in_panel, count, &help))
        count++;
    return count;
}

/* Appends entry `i` to a line, at the column of the entry. The note is the
 * entry after the last key. */
static void add_entry(char line[HELP_LINE_BYTES], const struct keymap *keys,
                      bool in_panel, const char *note, int i)
{
    int length = (int)strlen(line);
    int gap = length > 0 ? HELP_ENTRY_COLS + HELP_GAP - length : 0;
    char entry[HELP_ENTRY_COLS + 1];
    struct keymap_help help;

    if (find_entry(keys, in_panel, i, &help))
        snprintf(entry, sizeof entry, "%-7.20s %s", help.keys, help.text);
    else
        snprintf(entry, sizeof entry, "%s", note);
    snprintf(line + length, HELP_LINE_BYTES - (size_t)length, "%*s%s", gap, "",
             entry);
}

void help_page(struct help_page *page, const struct keymap *keys, bool in_panel,
               const char *note, int number, int cols, int rows)
{
    int entries = count_lines(keys, in_panel) + 1;
    int columns =
        cols >= HELP_COLUMNS * HELP_ENTRY_COLS + HELP_GAP ? HELP_COLUMNS : 1;
    int per_page, first, left;

    rows = rows < 1 ? 1 : rows > HELP_ROWS_MAX ? HELP_ROWS_MAX : rows;
    per_page = columns * rows;
    first = number * per_page;
    left = entries - first < per_page ? entries - first : per_page;
    memset(page, 0, sizeof *page);
    page->page_count = (entries + per_page - 1) / per_page;
    page->line_count = (left + columns - 1) / columns;
    for (int i = 0; i < left; i++)
        add_entry(page->lines[i % page->line_count], keys, in_panel, note,
                  first + i);
}
