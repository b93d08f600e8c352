// SPDX-License-Identifier: MIT
#include <locale.h>
#include <string.h>

#include "base/print.h"
#include "tests/unit/check.h"

/* Greek and Latin letters take one column, CJK and emoji two. Combining marks
 * take none. See Unicode Standard Annex 11. */
#define UMLAUTS   "\xc3\xbc\xc3\xa4"         /* 2 columns, 4 bytes */
#define NIHON     "\xe6\x97\xa5\xe6\x9c\xac" /* 4 columns, 6 bytes */
#define ACUTE     "e\xcc\x81"                /* 1 column, 3 bytes */
#define HALF_CHAR "\xe6\x97"

static void check_fit(const char *text, int cols, const char *expected)
{
    char to[64];

    text_width_fit(to, sizeof to, text, cols);
    assert_string_equal(to, expected);
}

static void widths_are_those_of_annex_11(void **state)
{
    (void)state;
    assert_int_equal(text_width_of(""), 0);
    assert_int_equal(text_width_of("abc"), 3);
    assert_int_equal(text_width_of(UMLAUTS), 2);
    assert_int_equal(text_width_of(NIHON), 4);
    assert_int_equal(text_width_of(ACUTE), 1);
}

static void blanks_fill_up_to_the_width(void **state)
{
    (void)state;
    check_fit("abc", 5, "abc  ");
    check_fit(UMLAUTS, 4, UMLAUTS "  ");
    check_fit(NIHON, 6, NIHON "  ");
    check_fit(ACUTE, 2, ACUTE " ");
    check_fit("", 2, "  ");
    check_fit("abc", 0, "");
}

/* A wide character that would be cut in half is replaced by a blank. */
static void texts_are_cut_between_characters(void **state)
{
    (void)state;
    check_fit("abcdef", 3, "abc");
    check_fit(NIHON, 3, "\xe6\x97\xa5 ");
    check_fit(UMLAUTS "x", 1, "\xc3\xbc");
    check_fit(ACUTE "x", 1, ACUTE);
}

static void controls_and_invalid_bytes_are_replaced(void **state)
{
    (void)state;
    check_fit("a\tb\033c\nd\177", 8, "a?b?c?d?");
    check_fit("\xc2\x9b"
              "1m",
              3, "?1m"); /* C1 control character */
    check_fit("a\xff\xfe"
              "b",
              4, "a??b");
    check_fit(HALF_CHAR, 2, "??");
}

static void short_buffers_hold_whole_characters(void **state)
{
    char to[6];

    (void)state;
    assert_int_equal(text_width_cut(to, sizeof to, NIHON, 10), 2);
    assert_string_equal(to, "\xe6\x97\xa5");
    text_width_fit(to, sizeof to, NIHON, 10);
    assert_string_equal(to, "\xe6\x97\xa5  ");
    assert_int_equal(text_width_cut(to, 1, "a", 10), 0);
    assert_string_equal(to, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(widths_are_those_of_annex_11),
        cmocka_unit_test(blanks_fill_up_to_the_width),
        cmocka_unit_test(texts_are_cut_between_characters),
        cmocka_unit_test(controls_and_invalid_bytes_are_replaced),
        cmocka_unit_test(short_buffers_hold_whole_characters),
    };

    setlocale(LC_CTYPE, "C.UTF-8");
    return cmocka_run_group_tests(tests, NULL, NULL);
}
