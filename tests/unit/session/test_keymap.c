// SPDX-License-Identifier: MIT
/*
 * test_keymap.c - actions of keys, with a person's own keys too; help, manual
 * and README name all of them
 */
#include <stdlib.h>

#include "base/file.h"
#include "session/keymap.h"
#include "terminal/tty_input.h"
#include "tests/unit/check.h"

static struct keymap table_keys(bool phoe)
{
    struct keymap k = {0};

    keymap_settle(&k, phoe);
    return k;
}

static void choose(struct keymap *k, enum action action, int a, int b)
{
    const int keys[KEYMAP_MAX] = {a, b};

    keymap_choose(k, action, keys);
}

static void key_tables_have_their_actions(void **state)
{
    static const struct {
        int key;
        enum action own, phoe;
    } cases[] = {
        {'w', ACTION_FORWARD, ACTION_UP},
        {'s', ACTION_BACK, ACTION_DOWN},
        {'a', ACTION_LEFT, ACTION_LEFT},
        {'d', ACTION_RIGHT, ACTION_RIGHT},
        {'q', ACTION_DOWN, ACTION_FORWARD},
        {'Q', ACTION_DOWN, ACTION_FORWARD},
        {'e', ACTION_UP, ACTION_BACK},
        {'E', ACTION_UP, ACTION_BACK},
        {17, ACTION_QUIT, ACTION_QUIT},
        {'?', ACTION_HELP, ACTION_HELP},
        {':', ACTION_HELP, ACTION_HELP},
        {3, ACTION_QUIT, ACTION_QUIT},
        {26, ACTION_SUSPEND, ACTION_SUSPEND},
        {'c', ACTION_SAVE_VIEW, ACTION_SAVE_VIEW},
        {'C', ACTION_COLORS, ACTION_COLORS},
        {'9', ACTION_VIEW_9, ACTION_VIEW_9},
        {TTY_KEY_LEFT, ACTION_LOOK_LEFT, ACTION_LOOK_LEFT},
        {TTY_KEY_PAGE_UP, ACTION_UP, ACTION_UP},
        {TTY_KEY_OTHER, ACTION_NONE, ACTION_NONE},
        {0, ACTION_NONE, ACTION_NONE},
        {'x', ACTION_SAVE_TEXT, ACTION_SAVE_TEXT},
        {'G', ACTION_GLYPHS, ACTION_GLYPHS},
        {'~', ACTION_NONE, ACTION_NONE},
    };
    struct keymap own = table_keys(false), phoe = table_keys(true);

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_int_equal(keymap_action(&own, cases[i].key), cases[i].own);
        assert_int_equal(keymap_action(&phoe, cases[i].key), cases[i].phoe);
    }
}

/* With Caps Lock on, the six keys of the camera keep their actions. */
static void capitals_keep_camera_actions(void **state)
{
    struct keymap k = table_keys(false);

    (void)state;
    for (const char *p = "wasdqe"; *p; p++)
        assert_int_equal(keymap_action(&k, *p - 'a' + 'A'),
                         keymap_action(&k, *p));
}

static void a_key_has_one_action(void **state)
{
    (void)state;
    for (int phoe = 0; phoe < 2; phoe++) {
        struct keymap k = table_keys(phoe);

        for (int key = 1; key <= TTY_KEY_OTHER; key++) {
            int count = 0;

            for (int i = 0; i < ACTIONS * KEYMAP_MAX; i++)
                count += k.keys[i / KEYMAP_MAX][i % KEYMAP_MAX] == key;
            assert_in_range(count, 0, 1);
        }
    }
}

static void chosen_keys_replace_those_of_the_table(void **state)
{
    struct keymap k = {0};

    (void)state;
    choose(&k, ACTION_FORWARD, 'x', 'q');
    choose(&k, ACTION_ORBIT, 'y', 0);
    choose(&k, ACTION_MOUSE, 0, 0);
    choose(&k, ACTION_UNDO, 'x', 0); /* which takes it away from forward */
    keymap_settle(&k, true);
    assert_int_equal(keymap_action(&k, 'q'), ACTION_FORWARD);
    assert_int_equal(keymap_action(&k, 'x'), ACTION_UNDO);
    assert_int_equal(keymap_action(&k, 'u'), ACTION_NONE);
    assert_int_equal(keymap_action(&k, 'y'), ACTION_ORBIT);
    assert_int_equal(keymap_action(&k, 'o'), ACTION_NONE);
    assert_int_equal(keymap_action(&k, 'm'), ACTION_NONE);
    assert_int_equal(keymap_action(&k, 'Q'), ACTION_NONE); /* phoe's forward */
    assert_int_equal(keymap_action(&k, 'w'), ACTION_UP);
}

static void names_of_keys_are_read_back(void **state)
{
    struct keymap_name name;

    (void)state;
    assert_int_equal(keymap_find_action("forwar", 6), ACTION_NONE);
    assert_int_equal(keymap_find_action("", 0), ACTION_NONE);
    for (int key = 1; key < TTY_KEY_OTHER; key++) {
        if (key >= 128 && key < TTY_KEY_UP)
            continue; /* no terminal sends it */
        name = keymap_key_name(key);
        assert_int_equal(keymap_find_key(name.text, strlen(name.text)), key);
    }
    assert_int_equal(keymap_find_key("^A", 2), 1);
    assert_int_equal(keymap_find_key("PgUp", 4), TTY_KEY_PAGE_UP);
    assert_int_equal(keymap_find_key("pgup", 4), 0);
    assert_int_equal(keymap_find_key("ww", 2), 0);
    assert_int_equal(keymap_find_key("^", 1), '^');
    assert_int_equal(keymap_find_key("^a", 2), 0);
}

static void first_names_are_the_usual_ones(void **state)
{
    struct keymap k = {0};

    (void)state;
    choose(&k, ACTION_MOUSE, 0, 0);
    keymap_settle(&k, false);
    assert_string_equal(keymap_first_name(&k, ACTION_HELP).text, "?");
    assert_string_equal(keymap_first_name(&k, ACTION_MODE).text, "space");
    assert_string_equal(keymap_first_name(&k, ACTION_MOUSE).text, "no key");
}

static bool is_numbered_view(int action)
{
    return action > ACTION_VIEW_1 && action <= ACTION_VIEW_9;
}

/* Every action is in the list once, but for the views from 2 on, and rows fit
 * into a window of 40 columns. */
static void list_has_every_action(void **state)
{
    struct keymap k = table_keys(false);
    struct keymap_command c;
    int seen[ACTIONS] = {0};

    (void)state;
    for (int i = 0; keymap_command(&k, i, &c); i++) {
        assert_in_range(strlen(c.text), 1, 27);
        assert_true(c.group[0] != '\0');
        seen[c.action]++;
    }
    for (int action = 1; action < ACTIONS; action++)
        assert_int_equal(seen[action], is_numbered_view(action) ? 0 : 1);
}

/* Returns the keys of an action in the list. */
static struct keymap_command command_of(const struct keymap *k,
                                        enum action action)
{
    struct keymap_command c = {.action = ACTION_NONE};

    for (int i = 0; c.action != action; i++)
        assert_true(keymap_command(k, i, &c));
    return c;
}

static void list_shows_chosen_keys(void **state)
{
    static const enum action moves[] = {ACTION_FORWARD, ACTION_LEFT,
                                        ACTION_BACK,    ACTION_RIGHT,
                                        ACTION_DOWN,    ACTION_UP};
    static const enum action looks[] = {ACTION_LOOK_LEFT, ACTION_LOOK_RIGHT,
                                        ACTION_LOOK_UP, ACTION_LOOK_DOWN};
    struct keymap k = table_keys(false);

    (void)state;
    assert_string_equal(command_of(&k, ACTION_DOWN).keys, "q PgDn");
    assert_string_equal(command_of(&k, ACTION_LIGHT).keys, "");
    assert_string_equal(keymap_first_names(&k, moves, 6).text, "wasdqe");
    assert_string_equal(keymap_first_names(&k, looks, 4).text, "arrows");
    assert_string_equal(keymap_first_names(&k, looks, 2).text, "Left Right");
    k = (struct keymap){0};
    choose(&k, ACTION_BACK, 'x', 0);
    choose(&k, ACTION_LOOK_UP, 'i', 0);
    keymap_settle(&k, false);
    assert_string_equal(command_of(&k, ACTION_BACK).keys, "x");
    assert_string_equal(keymap_first_names(&k, moves, 6).text, "waxdqe");
    assert_string_equal(keymap_first_names(&k, looks, 4).text,
                        "Left Right i Down");
}

/* Returns the text from the line after `begin` up to `end`, for free(). */
static char *section(const char *path, const char *begin, const char *end)
{
    struct error err;
    size_t size_bytes;
    char *text, *from, *to;

    check_or_say(file_read(path, &text, &size_bytes, &err), err.text);
    from = strstr(text, begin);
    assert_non_null(from);
    from += strlen(begin);
    to = strstr(from, end);
    assert_non_null(to);
    memmove(text, from, (size_t)(to - from));
    text[to - from] = '\0';
    return text;
}

/* Returns the character that the manual writes as "\-" and so on, and moves
 * behind it. */
static char manual_char(const char **p)
{
    static const struct {
        const char *written;
        char c;
    } escapes[] = {{"\\-", '-'}, {"\\(ha", '^'}, {"\\e", '\\'}};

    if (strncmp(*p, "\\&", 2) == 0)
        *p += 2;
    for (size_t i = 0; i < sizeof escapes / sizeof escapes[0]; i++) {
        size_t length = strlen(escapes[i].written);

        if (strncmp(*p, escapes[i].written, length) == 0) {
            *p += length;
            return escapes[i].c;
        }
    }
    return *(*p)++;
}

/* Reads the keys of the next item of a section. Returns false after the last
 * one. */
static bool next_item(const char **item, char keys[64])
{
    size_t length = 0;
    const char *p = strstr(*item, "\n.It Ic ");

    if (p == NULL)
        return false;
    p += strlen("\n.It Ic ");
    memset(keys, 0, 64);
    while (*p != '\n' && length < 63)
        keys[length++] = manual_char(&p);
    *item = p;
    return true;
}

/* Items of the manual have the first key of one action or several. */
static void manual_lists_the_same_keys(void **state)
{
    char *text = section("man/glim.1", ".Sh KEYS\n", "\n.El\n");
    const char *item = text;
    struct keymap k = table_keys(false);
    char keys[64], all[1024] = " ";

    (void)state;
    while (next_item(&item, keys))
        strcat(strcat(all, keys), " ");
    for (int action = 1; action < ACTIONS; action++) {
        char name[16];

        if (k.keys[action][0] == 0)
            continue;
        snprintf(name, sizeof name, " %s ",
                 keymap_key_name(k.keys[action][0]).text);
        if (action >= ACTION_LOOK_LEFT && action <= ACTION_LOOK_DOWN)
            strcpy(name, " arrows ");
        if (action >= ACTION_VIEW_1 && action <= ACTION_VIEW_9)
            strcpy(name, " 1-9 ");
        check_has(all, name);
    }
    free(text);
}

static void manual_lists_the_panels_keys(void **state)
{
    char *text = section("man/glim.1", ".Sh PANEL\n", "\n.El\n");
    const char *item = text;
    struct keymap_command c;
    char keys[64];
    int i = 0;

    (void)state;
    for (; next_item(&item, keys); i++) {
        assert_true(keymap_panel_command(i, &c));
        assert_string_equal(keys, c.keys);
    }
    assert_false(keymap_panel_command(i, &c));
    free(text);
}

/* Each key of the panel has one meaning, and no letter of it has another one
 * elsewhere. */
static void panel_keys_are_its_own(void **state)
{
    struct keymap k = table_keys(false);
    struct keymap_command c;

    (void)state;
    for (int i = 0; keymap_panel_command(i, &c); i++)
        assert_in_range(strlen(c.text), 1, 27);
    for (int key = 'A'; key <= 'z'; key++)
        assert_true(keymap_panel_action(key) == PANEL_NONE ||
                    keymap_action(&k, key) == ACTION_NONE);
    assert_int_equal(keymap_panel_action(0), PANEL_NONE);
    assert_int_equal(keymap_panel_action('w'), PANEL_NONE);
    assert_int_equal(keymap_panel_action('\\'), PANEL_COMPARE);
}

/* The README has the usual keys in at most 30 rows. */
static void readme_has_keys(void **state)
{
    struct keymap k = table_keys(false);
    char *text =
        section("README.md", "| key | on the screen |\n| --- | --- |", "\n\n");
    int rows = 0;

    (void)state;
    for (char *row = text; (row = strstr(row, "\n| ")); rows++) {
        char *end = strchr(row += 3, '|');
        char *rest = row;

        *end = '\0';
        for (char *key; (key = strsep(&rest, " `"));)
            if (*key != '\0' && strcmp(key, "arrows") != 0 &&
                strcmp(key, "1-9") != 0)
                assert_true(
                    keymap_action(&k, keymap_find_key(key, strlen(key))) !=
                    ACTION_NONE);
        row = end + 1;
    }
    assert_in_range(rows, 15, 30);
    free(text);
}

static void manual_lists_the_actions(void **state)
{
    char *text = section("man/glim.1", "The actions are\n", "\nAn error");
    char *rest = text;
    int action;
    bool is_listed[ACTIONS] = {false};

    (void)state;
    for (char *word; (word = strsep(&rest, " \n"));) {
        if (*word == '\0' || *word == '.' || strcmp(word, "and") == 0)
            continue;
        action = keymap_find_action(word, strlen(word));
        if (action == ACTION_NONE || is_listed[action])
            print_error("no action '%s', or twice\n", word);
        assert_true(action != ACTION_NONE && !is_listed[action]);
        is_listed[action] = true;
    }
    for (action = 1; action < ACTIONS; action++)
        assert_true(is_listed[action]);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(key_tables_have_their_actions),
        cmocka_unit_test(capitals_keep_camera_actions),
        cmocka_unit_test(a_key_has_one_action),
        cmocka_unit_test(chosen_keys_replace_those_of_the_table),
        cmocka_unit_test(names_of_keys_are_read_back),
        cmocka_unit_test(first_names_are_the_usual_ones),
        cmocka_unit_test(list_has_every_action),
        cmocka_unit_test(list_shows_chosen_keys),
        cmocka_unit_test(manual_lists_the_same_keys),
        cmocka_unit_test(manual_lists_the_panels_keys),
        cmocka_unit_test(panel_keys_are_its_own),
        cmocka_unit_test(readme_has_keys),
        cmocka_unit_test(manual_lists_the_actions),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
