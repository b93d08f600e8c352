// SPDX-License-Identifier: MIT
#include <locale.h>
#include <stdlib.h>
#include <string.h>

#include "base/print.h"
#include "terminal/xmalloc.h"
#include "tests/unit/check.h"

static void check_shown(const char *text, const char *expected)
{
    char *shown = xstrdup(text);

    print_replace(shown);
    assert_string_equal(shown, expected);
    free(shown);
}

static void control_characters_are_replaced(void **state)
{
    static const struct {
        const char *text, *shown;
    } cases[] = {
        {"", ""},
        {"a b", "a b"},
        {"\xc3\xa4 \xe6\x97\xa5", "\xc3\xa4 \xe6\x97\xa5"},
        {"q\033]0;X\007.obj", "q?]0;X?.obj"},
        {"a\rb\nc\td\177", "a?b?c?d?"},
        {"\x9b"
         "31m",
         "?31m"}, /* C1 control in Latin-1 */
        {"\xc2\x9b"
         "31m",
         "?31m"}, /* the same in UTF-8 */
        {"\xc2\x80\xc2\x9f\xc2\xa1", "??\xc2\xa1"},
        {"a\xff\xfe"
         "b",
         "a??b"},
        {"\xe6\x97", "??"},      /* cut short */
        {"\xc0\x80", "??"},      /* overlong */
        {"\xed\xa0\x80", "???"}, /* surrogate */
        {"a\xe2\x80\xae"
         "jbo",
         "a?jbo"}, /* U+202E reverses the direction of the text */
        {"a\xe2\x81\xa9"
         "b",
         "a?b"}, /* U+2069 isolates a direction */
        {"a\xe2\x80\xa8"
         "b",
         "a?b"},                          /* U+2028 ends the line */
        {"\xee\x82\xa0", "\xee\x82\xa0"}, /* private-use character */
    };

    (void)state;
    setlocale(LC_CTYPE, "C.UTF-8");
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        check_shown(cases[i].text, cases[i].shown);
}

/* A terminal of 8 bits would obey single bytes of UTF-8 characters. */
static void no_utf8_goes_to_terminals_without_it(void **state)
{
    (void)state;
    setlocale(LC_CTYPE, "C");
    check_shown("a\xc3\x9b"
                "31m \x9b \xe4",
                "a??31m ? ?");
    setlocale(LC_CTYPE, "C.UTF-8");
}

/* No text of two bytes sends a control character to the terminal. */
static void no_pair_of_bytes_controls_the_terminal(void **state)
{
    (void)state;
    for (int a = 1; a < 256; a++) {
        for (int b = 1; b < 256; b++) {
            char text[3] = {(char)a, (char)b, '\0'};
            const unsigned char *p = (const unsigned char *)text;

            print_replace(text);
            assert_true(p[0] >= 0x20 && p[0] != 0x7f);
            assert_true(p[1] == 0 || (p[1] >= 0x20 && p[1] != 0x7f));
            assert_false(p[0] >= 0x80 && p[0] < 0xa0);
            assert_false(p[0] == 0xc2 && p[1] < 0xa0);
        }
    }
}

static void only_line_ends_of_print_lines_are_kept(void **state)
{
    char *text = NULL;
    size_t size_bytes;
    FILE *to = open_memstream(&text, &size_bytes);

    (void)state;
    assert_non_null(to);
    print_line(to, "%s: %d", "a\nb", 3);
    print_text(to, "%5.1f\r", 2.0);
    print_lines(to, "one\ttwo\033\n\nthree");
    assert_int_equal(fclose(to), 0);
    assert_string_equal(text, "a?b: 3\n  2.0?one two?\n\nthree\n");
    free(text);
}

static void one_has_no_plural(void **state)
{
    (void)state;
    assert_string_equal(print_plural(0), "s");
    assert_string_equal(print_plural(1), "");
    assert_string_equal(print_plural(2), "s");
    assert_string_equal(print_plural(UINT64_MAX), "s");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(control_characters_are_replaced),
        cmocka_unit_test(no_utf8_goes_to_terminals_without_it),
        cmocka_unit_test(no_pair_of_bytes_controls_the_terminal),
        cmocka_unit_test(only_line_ends_of_print_lines_are_kept),
        cmocka_unit_test(one_has_no_plural),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
