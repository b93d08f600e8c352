// SPDX-License-Identifier: MIT
#include "check.h"

#include <string.h>

#include "glim/input.h"
#include "glim/keys.h"

static void own_and_phoe_keys(void **state)
{
    static const struct {
        int key;
        enum action own, phoe;
    } cases[] = {
        {'w', ACTION_FORWARD, ACTION_UP},
        {'s', ACTION_BACK, ACTION_DOWN},
        {'a', ACTION_LEFT, ACTION_LEFT},
        {'d', ACTION_RIGHT, ACTION_RIGHT},
        {'Q', ACTION_DOWN, ACTION_FORWARD},
        {'e', ACTION_UP, ACTION_BACK},
        {'E', ACTION_UP, ACTION_BACK},
        {'q', ACTION_QUIT, ACTION_QUIT},
        {'?', ACTION_HELP, ACTION_HELP},
        {3, ACTION_INTERRUPT, ACTION_INTERRUPT},
        {26, ACTION_SUSPEND, ACTION_SUSPEND},
        {'c', ACTION_SAVE_VIEW, ACTION_SAVE_VIEW},
        {'C', ACTION_COLORS, ACTION_COLORS},
        {INPUT_LEFT, ACTION_LOOK_LEFT, ACTION_LOOK_LEFT},
        {INPUT_OTHER, ACTION_NONE, ACTION_NONE},
        {0, ACTION_NONE, ACTION_NONE},
        {'x', ACTION_SAVE_TEXT, ACTION_SAVE_TEXT},
        {'G', ACTION_GLYPHS, ACTION_GLYPHS},
        {'~', ACTION_NONE, ACTION_NONE},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_int_equal(keys_action(cases[i].key, false), cases[i].own);
        assert_int_equal(keys_action(cases[i].key, true), cases[i].phoe);
    }
}

/* With Caps Lock on the six keys of the camera do as people know them. */
static void capitals_move_too(void **state)
{
    (void)state;
    for (const char *p = "wasde"; *p; p++)
        assert_int_equal(keys_action(*p - 'a' + 'A', false),
                         keys_action(*p, false));
}

/* Every printable key that does something is in the help, and fits. */
static void help_names_every_key(void **state)
{
    (void)state;
    for (int phoe = 0; phoe < 2; phoe++) {
        char all[1024] = "";

        for (int i = 0; keys_help(i, phoe); i++) {
            const struct keys_help *h = keys_help(i, phoe);

            assert_true(strlen(h->keys) <= 7 && strlen(h->text) < 50);
            strcat(all, h->keys);
        }
        for (int key = '!'; key < 127; key++) {
            char lower = (char)(key >= 'A' && key <= 'Z' ? key + 32 : key);

            if (keys_action(key, phoe) == ACTION_NONE || key == '=' ||
                key == '_')
                continue;
            assert_true(strchr(all, key) || strchr(all, lower));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(own_and_phoe_keys),
        cmocka_unit_test(capitals_move_too),
        cmocka_unit_test(help_names_every_key),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
