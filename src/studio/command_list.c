// SPDX-License-Identifier: MIT
#include "studio/command_list.h"

#include <string.h>
#include <strings.h>

#include "glim/version.h"

/* Commands of the menu after the first row, which goes on. */
static const enum action menu[] = {ACTION_RESTORE,   ACTION_DROP,  ACTION_SAVE,
                                   ACTION_SAVE_EDIT, ACTION_SCENE, ACTION_HELP,
                                   ACTION_QUIT};

/* Those at its begin that concern a kept session. */
#define MENU_KEPT 2

#define MENU_COUNT ((int)(sizeof menu / sizeof menu[0]))

/* ---- search ---- */

/* Returns true if a word of the text begins with these letters. */
static bool has_word(const char *text, const char *letters, size_t length)
{
    for (const char *p = text; *p != '\0'; p++)
        if ((p == text || p[-1] == ' ') && strncasecmp(p, letters, length) == 0)
            return true;
    return false;
}

/* Returns how well a command matches a word: 0 not at all, more if what it does
 * has the word than if only the other words or the group have it. */
static int match_word(const struct keymap_command *c, const char *word,
                      size_t length)
{
    if (has_word(c->text, word, length))
        return 3;
    if (has_word(c->words, word, length))
        return 2;
    return has_word(c->group, word, length) ? 1 : 0;
}

/* The same for all words of a search, with the least of them. A key finds its
 * command first. */
static int match(const struct keymap_command *c, const char *search)
{
    int least = 4;

    if (search[0] != '\0' && strcmp(c->keys, search) == 0)
        return 5;
    while (*(search += strspn(search, " ")) != '\0') {
        size_t length = strcspn(search, " ");
        int points = match_word(c, search, length);

        least = points < least ? points : least;
        search += length;
    }
    return least;
}

/* Adds a command behind those that match as well. */
static void add(struct command_list *p, const struct keymap_command *c)
{
    int points = match(c, p->list.search), at = p->count;

    p->all++;
    if (points == 0 || p->count == COMMANDS_MAX)
        return;
    for (; at > 0 && p->points[at - 1] < points; at--) {
        p->commands[at] = p->commands[at - 1];
        p->points[at] = p->points[at - 1];
    }
    p->commands[at] = *c;
    p->points[at] = points;
    p->count++;
}

static void find_menu(struct command_list *p, const struct keymap *keys)
{
    struct keymap_command c;

    p->commands[0] = (struct keymap_command){.keys = "Esc",
                                             .text = "go on",
                                             .words = "",
                                             .group = ""};
    p->count = 1;
    for (int k = p->has_kept ? 0 : MENU_KEPT; k < MENU_COUNT; k++)
        for (int i = 0; keymap_command(keys, i, &c); i++)
            if (c.action == menu[k]) {
                c.group = "";
                if (c.action == ACTION_SAVE_EDIT && p->changes[0] != '\0')
                    c.text = p->changes;
                p->commands[p->count++] = c;
            }
    p->all = p->count;
}

void command_list_find(struct command_list *p, const struct keymap *keys)
{
    struct keymap_command c;

    p->count = p->all = 0;
    if (p->is_menu && p->list.search[0] == '\0') {
        find_menu(p, keys);
        return;
    }
    for (int i = 0; p->in_panel && keymap_panel_command(i, &c); i++)
        add(p, &c);
    for (int i = 0; keymap_command(keys, i, &c); i++)
        add(p, &c);
}

/* ---- window ---- */

static void rows_of(const struct command_list *p,
                    struct list_row rows[COMMANDS_MAX])
{
    for (int i = 0; i < p->count; i++)
        rows[i] = (struct list_row){p->commands[i].keys, p->commands[i].text,
                                    p->commands[i].group};
}

static void draw(struct command_list *p, const struct keymap *keys,
                 struct screen *screen)
{
    struct list_row rows[COMMANDS_MAX];

    command_list_find(p, keys);
    rows_of(p, rows);
    list_window_draw(&p->list, screen, rows, p->count, p->all);
}

void command_list_open(struct command_list *p, const struct keymap *keys,
                       struct screen *screen)
{
    struct command_list whole = {.is_menu = p->is_menu,
                                 .in_panel = p->in_panel,
                                 .has_kept = p->has_kept};
    struct list_row rows[COMMANDS_MAX];

    command_list_find(&whole, keys);
    rows_of(&whole, rows);
    p->list.does = "runs";
    list_window_open(&p->list, screen, " glim " GLIM_VERSION " ", rows,
                     whole.count);
    draw(p, keys, screen);
}

enum action command_list_take(struct command_list *p, const struct keymap *keys,
                              struct screen *screen, const struct event *event)
{
    struct list_row rows[COMMANDS_MAX];
    enum list_result result;

    rows_of(p, rows);
    result = list_window_take(&p->list, event, rows, p->count);
    if (result == LIST_STAYS)
        draw(p, keys, screen);
    return result == LIST_CHOSEN ? p->commands[p->list.selected].action
                                 : ACTION_NONE;
}
