// SPDX-License-Identifier: MIT
/*
 * test_help.c - every key is on one page of the help, whatever the size of the
 * window; items do not overlap; typing leaves what matches
 */
#include <string.h>

#include "studio/help.h"
#include "terminal/tty_input.h"
#include "tests/unit/check.h"

static struct keymap default_keys(void)
{
    struct keymap k;

    memset(&k, 0, sizeof k);
    keymap_settle(&k, false);
    return k;
}

static int count_keys(const struct keymap *k, bool in_panel)
{
    struct keymap_help help;
    int count = 0, of_panel = 0;

    while (keymap_help(k, count, &help))
        count++;
    while (in_panel && keymap_panel_help(of_panel, &help))
        of_panel++;
    return count + of_panel;
}

/* Checks a page and counts its keys. */
static int check_page(const struct help_page *page, int cols, int rows)
{
    bool is_taken[HELP_ROWS_MAX][HELP_COLUMNS_MAX] = {{false}};
    int keys = 0;

    assert_in_range(page->rows, 1, rows);
    assert_true(page->columns == 1 ||
                page->columns * (HELP_ENTRY_COLS + HELP_GAP) - HELP_GAP <=
                    cols);
    for (int i = 0; i < page->count; i++) {
        const struct help_item *item = &page->items[i];

        assert_in_range(item->row, 0, page->rows - 1);
        assert_in_range(item->column, 0, page->columns - 1);
        assert_false(is_taken[item->row][item->column]);
        is_taken[item->row][item->column] = true;
        keys += item->entry.keys[0] != '\0';
        /* a title has its first key below */
        if (item->entry.keys[0] == '\0') {
            assert_true(i + 1 < page->count);
            assert_int_equal(page->items[i + 1].row, item->row + 1);
            assert_int_equal(page->items[i + 1].column, item->column);
        }
    }
    return keys;
}

static void all_keys_are_shown_once(void **state)
{
    struct keymap k = default_keys();

    (void)state;
    for (int rows = 1; rows <= 50; rows++) {
        for (int cols = 20; cols <= 200; cols += 9) {
            struct help help = {.is_open = true};
            struct help_page page;
            bool in_panel = cols % 2 == 0;
            int keys = 0, pages = 1;

            for (int number = 0; number < pages; number++) {
                help.page = number;
                help_lay_out(&page, &help, &k, in_panel, cols, rows);
                assert_int_equal(help.page, number);
                keys += check_page(&page, cols, rows);
                pages = help.page_count;
            }
            assert_int_equal(keys, count_keys(&k, in_panel));
        }
    }
}

static void type(struct help *help, const char *text)
{
    for (; *text; text++)
        help_key(help, *text);
}

static bool has_text(const struct help_page *page, const char *text)
{
    for (int i = 0; i < page->count; i++)
        if (strcmp(page->items[i].entry.text, text) == 0)
            return true;
    return false;
}

static void typing_searches(void **state)
{
    struct keymap k = default_keys();
    struct help help = {.is_open = true};
    struct help_page page;

    (void)state;
    type(&help, "PNG");
    help_lay_out(&page, &help, &k, false, 76, 20);
    assert_int_equal(page.count, 2); /* with the title of its group */
    assert_true(has_text(&page, "save a new PNG file"));
    /* a group's name finds the group */
    help = (struct help){.is_open = true};
    type(&help, "files");
    help_lay_out(&page, &help, &k, false, 76, 20);
    assert_true(has_text(&page, "save coloured text"));
    assert_true(has_text(&page, "load changed files"));
    assert_false(has_text(&page, "quit"));
    /* a key finds what it does */
    help = (struct help){.is_open = true};
    type(&help, "^Z");
    help_lay_out(&page, &help, &k, false, 76, 20);
    assert_true(has_text(&page, "suspend"));
    help_key(&help, 127);
    assert_string_equal(help.search, "^");
    type(&help, "no such key whatever is typed here");
    assert_int_equal(strlen(help.search), HELP_SEARCH - 1);
    help_lay_out(&page, &help, &k, true, 76, 20);
    assert_int_equal(page.count, 0);
    assert_int_equal(help.page_count, 1);
    help_key(&help, 27);
    assert_false(help.is_open);
    assert_string_equal(help.search, "");
}

static void arrows_turn_pages(void **state)
{
    struct keymap k = default_keys();
    struct help help = {.is_open = true};
    struct help_page page;

    (void)state;
    help_lay_out(&page, &help, &k, true, 36, 8);
    assert_in_range(help.page_count, 5, 20);
    assert_true(strcmp(page.items[0].entry.text, "Panel") == 0);
    help_key(&help, TTY_KEY_UP);
    assert_int_equal(help.page, help.page_count - 1);
    help_key(&help, TTY_KEY_PAGE_DOWN);
    assert_int_equal(help.page, 0);
    help_key(&help, TTY_KEY_DOWN);
    assert_int_equal(help.page, 1);
    help_key(&help, 'q');
    assert_int_equal(help.page, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_keys_are_shown_once),
        cmocka_unit_test(typing_searches),
        cmocka_unit_test(arrows_turn_pages),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
