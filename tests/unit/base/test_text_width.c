// SPDX-License-Identifier: MIT
#include <locale.h>
#include <string.h>

#include "base/text_width.h"
#include "tests/unit/check.h"

/* Greek and Latin letters take one column, CJK and emoji two, what combines
 * with the letter before none: Unicode Standard Annex 11. */
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

static void test_widths(void **state)
{
    (void)state;
    assert_int_equal(text_width_of(""), 0);
    assert_int_equal(text_width_of("abc"), 3);
    assert_int_equal(text_width_of(UMLAUTS), 2);
    assert_int_equal(text_width_of(NIHON), 4);
    assert_int_equal(text_width_of(ACUTE), 1);
}

static void test_blanks_fill_up(void **state)
{
    (void)state;
    check_fit("abc", 5, "abc  ");
    check_fit(UMLAUTS, 4, UMLAUTS "  ");
    check_fit(NIHON, 6, NIHON "  ");
    check_fit(ACUTE, 2, ACUTE " ");
    check_fit("", 2, "  ");
    check_fit("abc", 0, "");
}

/* Half of a wide character has no place: a blank takes it. */
static void test_cuts_between_characters(void **state)
{
    (void)state;
    check_fit("abcdef", 3, "abc");
    check_fit(NIHON, 3, "\xe6\x97\xa5 ");
    check_fit(UMLAUTS "x", 1, "\xc3\xbc");
    check_fit(ACUTE "x", 1, ACUTE);
}

static void test_what_cannot_be_shown(void **state)
{
    (void)state;
    check_fit("a\tb\033c\nd\177", 8, "a?b?c?d?");
    check_fit("\xc2\x9b"
              "1m",
              3, "?1m"); /* a C1 control character */
    check_fit("a\xff\xfe"
              "b",
              4, "a??b");
    check_fit(HALF_CHAR, 2, "??");
}

static void test_few_bytes(void **state)
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
        cmocka_unit_test(test_widths),
        cmocka_unit_test(test_blanks_fill_up),
        cmocka_unit_test(test_cuts_between_characters),
        cmocka_unit_test(test_what_cannot_be_shown),
        cmocka_unit_test(test_few_bytes),
    };

    setlocale(LC_CTYPE, "C.UTF-8");
    return cmocka_run_group_tests(tests, NULL, NULL);
}
