// SPDX-License-Identifier: MIT
#include <locale.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/warnings.h"

/* Returns the output of warnings_print(), for free(). */
static char *printed(const struct warnings *r)
{
    char *text = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&text, &size);

    assert_non_null(f);
    warnings_print(r, f);
    fclose(f);
    return text;
}

static void no_warnings_print_nothing(void **state)
{
    struct warnings r = {0};
    char *text = printed(&r);

    (void)state;
    assert_string_equal(text, "");
    free(text);
    warnings_free(&r);
}

static void first_of_each_kind_is_printed_then_counts(void **state)
{
    struct warnings r = {0};
    char *text;

    (void)state;
    for (int i = 1; i <= 1000; i++)
        warnings_add(&r, "faces with a bad index", "a.obj:%d: found 0", i);
    warnings_add(&r, "unusable textures", "a.mtl:7: no 'wood.png'");
    text = printed(&r);
    assert_string_equal(text,
                        "glim: warning: a.obj:1: found 0 (in all 1000 faces "
                        "with a bad index)\n"
                        "glim: warning: a.mtl:7: no 'wood.png'\n");
    free(text);
    warnings_free(&r);
}

static void a_hundred_kinds_are_counted(void **state)
{
    struct warnings r = {0};

    (void)state;
    for (int round = 0; round < 2; round++) {
        for (int i = 0; i < 100; i++) {
            char kind[32];

            snprintf(kind, sizeof kind, "kind %d", i);
            warnings_add(&r, kind, "text %d %d", i, round);
        }
    }
    assert_int_equal(r.entry_count, 100);
    assert_string_equal(r.entries[99].kind, "kind 99");
    assert_string_equal(r.entries[99].text, "text 99 0");
    assert_int_equal(r.entries[99].count, 2);
    warnings_free(&r);
    assert_int_equal(r.entry_count, 0);
}

static void control_characters_are_replaced(void **state)
{
    struct warnings r = {0};
    char *text = NULL;
    size_t size_bytes;
    FILE *to;

    (void)state;
    for (int i = 0; i < 2; i++)
        warnings_add_named(&r, "names", "\033c", "%s",
                           "a\033[2Jb\nc\x7f\xc2\x9b z\xc3\xa4");
    to = open_memstream(&text, &size_bytes);
    assert_non_null(to);
    warnings_print(&r, to);
    assert_int_equal(fclose(to), 0);
    assert_string_equal(text, "glim: warning: a?[2Jb?c?? z\xc3\xa4 (in all 2 "
                              "names '?c')\n");
    free(text);
    warnings_free(&r);
}

static void long_texts_are_cut(void **state)
{
    struct warnings r = {0};
    char *word = malloc(100001);

    (void)state;
    memset(word, 'x', 100000);
    word[100000] = '\0';
    warnings_add(&r, "words", "%s", word);
    assert_true(strlen(r.entries[0].text) < 2000);
    free(word);
    warnings_free(&r);
}

static void names_of_a_kind_are_counted_up_to_a_limit(void **state)
{
    struct warnings r = {0};
    const struct warnings_entry *last;

    (void)state;
    for (int round = 0; round < 2; round++) {
        for (int i = 0; i < 1000; i++) {
            char name[32];

            snprintf(name, sizeof name, "m%d", i);
            warnings_add_named(&r, "unknown materials", name, "no '%s'", name);
        }
    }
    warnings_add_named(&r, "unusable textures", "m0", "no texture 'm0'");
    assert_int_equal(r.entry_count, WARNINGS_NAMES_MAX + 2);
    assert_string_equal(r.entries[3].kind, "unknown materials 'm3'");
    assert_int_equal(r.entries[3].count, 2);
    last = &r.entries[WARNINGS_NAMES_MAX];
    assert_string_equal(last->kind, "unknown materials");
    assert_int_equal(last->count, 2 * (1000 - WARNINGS_NAMES_MAX));
    warnings_free(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_warnings_print_nothing),
        cmocka_unit_test(first_of_each_kind_is_printed_then_counts),
        cmocka_unit_test(a_hundred_kinds_are_counted),
        cmocka_unit_test(control_characters_are_replaced),
        cmocka_unit_test(long_texts_are_cut),
        cmocka_unit_test(names_of_a_kind_are_counted_up_to_a_limit),
    };

    setlocale(LC_CTYPE, "C.UTF-8");
    return cmocka_run_group_tests(tests, NULL, NULL);
}
