// SPDX-License-Identifier: MIT
/*
 * test_command_list.c - words of people find their commands; keys and the mouse
 * choose rows
 */
#include <string.h>

#include "studio/command_list.h"
#include "tests/unit/check.h"

static struct keymap default_keys(void)
{
    struct keymap k;

    memset(&k, 0, sizeof k);
    keymap_settle(&k, false);
    return k;
}

static void find(struct command_list *p, const char *search)
{
    struct keymap k = default_keys();

    snprintf(p->list.search, sizeof p->list.search, "%s", search);
    command_list_find(p, &k);
}

static bool has_action(const struct command_list *p, enum action action)
{
    for (int i = 0; i < p->count; i++)
        if (p->commands[i].action == action)
            return true;
    return false;
}

static void words_find_commands(void **state)
{
    static const struct {
        const char *search;
        enum action first, also;
    } cases[] = {
        {"zoom in", ACTION_NARROWER, ACTION_NARROWER},
        {"zoom", ACTION_FRAME, ACTION_WIDER},
        {"rotate", ACTION_LOOK_LEFT, ACTION_ORBIT},
        {"sun", ACTION_LIGHT, ACTION_LIGHT},
        {"texture", ACTION_PANEL, ACTION_PANEL},
        {"exposure", ACTION_LIGHT, ACTION_LIGHT},
        {"screenshot", ACTION_SAVE, ACTION_SAVE},
        {"denoise", ACTION_FILTER, ACTION_FILTER},
        {"export", ACTION_SAVE, ACTION_SAVE_LINEAR},
        {"fov", ACTION_NARROWER, ACTION_WIDER},
        {"wireframe", ACTION_VIEW_NEXT, ACTION_DRAWING},
        {"theme", ACTION_THEME, ACTION_THEME},
        {"reset", ACTION_RESET, ACTION_RESET},
        {"revert", ACTION_UNDO, ACTION_RELOAD},
        {"lamp", ACTION_LIGHT, ACTION_ADD_LAMP},
        {"add lamp", ACTION_ADD_LAMP, ACTION_ADD_LAMP},
        {"Save", ACTION_SAVE_EDIT, ACTION_SAVE},
        {"exit", ACTION_ABORT, ACTION_QUIT},
        {"GPU", ACTION_BACKEND, ACTION_BACKEND},
        {"^Z", ACTION_SUSPEND, ACTION_SUSPEND},
        {"k", ACTION_KEEP, ACTION_KEEP_RENDER},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct command_list p = {.is_menu = i % 2 == 0};

        find(&p, cases[i].search);
        if (p.count == 0 || p.commands[0].action != cases[i].first)
            print_error("'%s' finds '%s'\n", cases[i].search,
                        p.count > 0 ? p.commands[0].text : "nothing");
        assert_true(p.count > 0 && p.commands[0].action == cases[i].first);
        assert_true(has_action(&p, cases[i].also));
        assert_true(p.count < p.all);
    }
}

static void all_commands_are_in_the_list(void **state)
{
    struct command_list p = {.in_panel = true}, menu = {.is_menu = true};
    struct keymap_command c;
    struct keymap k = default_keys();
    int count = 0;

    (void)state;
    find(&p, "");
    while (keymap_command(&k, count, &c))
        count++;
    assert_string_equal(p.commands[0].group, "Panel");
    assert_true(p.count == p.all && p.count > count);
    find(&menu, "");
    assert_in_range(menu.count, 5, 8);
    assert_int_equal(menu.commands[0].action, ACTION_NONE);
    assert_int_equal(menu.commands[menu.count - 1].action, ACTION_QUIT);
    find(&p, "no such command");
    assert_int_equal(p.count, 0);
}

static void keys_choose(void **state)
{
    struct list_window l = {.is_open = true};

    (void)state;
    assert_int_equal(list_window_key(&l, TTY_KEY_UP, 20), LIST_STAYS);
    assert_int_equal(l.selected, 0);
    list_window_key(&l, TTY_KEY_PAGE_DOWN, 20);
    list_window_key(&l, TTY_KEY_DOWN, 20);
    assert_int_equal(l.selected, 11);
    list_window_key(&l, TTY_KEY_END, 20);
    assert_int_equal(l.selected, 19);
    list_window_key(&l, 'q', 20);
    list_window_key(&l, ' ', 20);
    assert_string_equal(l.search, "q ");
    assert_int_equal(l.selected, 0);
    list_window_key(&l, 127, 20);
    assert_string_equal(l.search, "q");
    for (int i = 0; i < 2 * LIST_SEARCH; i++)
        list_window_key(&l, 'x', 20);
    assert_int_equal(strlen(l.search), LIST_SEARCH - 1);
    assert_int_equal(list_window_key(&l, '\r', 0), LIST_STAYS);
    assert_int_equal(list_window_key(&l, 27, 0), LIST_STAYS);
    assert_string_equal(l.search, "");
    assert_int_equal(list_window_key(&l, '\r', 1), LIST_CHOSEN);
    assert_false(l.is_open);
    l.is_open = true;
    assert_int_equal(list_window_key(&l, 27, 5), LIST_CANCELLED);
    assert_false(l.is_open);
}

/* Rows of two groups: titles at lines 0 and 3. */
static enum list_result press(struct list_window *l, int x, int y)
{
    static const struct list_row rows[] = {{"a", "one", "first"},
                                           {"b", "two", "first"},
                                           {"c", "three", "second"}};
    struct event event = {.kind = EVENT_MOUSE,
                          .mouse = MOUSE_PRESS,
                          .x = x,
                          .y = y};

    l->is_open = true;
    return list_window_take(l, &event, rows, 3);
}

static void the_mouse_chooses(void **state)
{
    struct list_window l = {.rows = 6, .at = {10, 5, 30, 11}};

    (void)state;
    assert_int_equal(press(&l, 20, 8), LIST_STAYS); /* a title */
    assert_int_equal(press(&l, 20, 9), LIST_CHOSEN);
    assert_int_equal(l.selected, 0);
    assert_int_equal(press(&l, 20, 10), LIST_CHOSEN);
    assert_int_equal(l.selected, 1);
    assert_int_equal(press(&l, 20, 11), LIST_STAYS);
    assert_int_equal(press(&l, 20, 12), LIST_CHOSEN);
    assert_int_equal(l.selected, 2);
    assert_int_equal(press(&l, 20, 13), LIST_STAYS); /* behind the last */
    assert_int_equal(press(&l, 20, 7), LIST_STAYS);  /* the search */
    assert_int_equal(press(&l, 10, 9), LIST_CANCELLED);
    assert_int_equal(press(&l, 20, 17), LIST_CANCELLED);
    l.top = 3;
    assert_int_equal(press(&l, 20, 9), LIST_CHOSEN);
    assert_int_equal(l.selected, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_find_commands),
        cmocka_unit_test(all_commands_are_in_the_list),
        cmocka_unit_test(keys_choose),
        cmocka_unit_test(the_mouse_chooses),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
