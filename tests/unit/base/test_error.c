// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <locale.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "terminal/xmalloc.h"

static void fail_formats_one_line_and_returns_false(void **state)
{
    struct error err;

    (void)state;
    assert_false(fail(&err, "%s:%d: found '%s'", "a.obj", 3, "x"));
    assert_string_equal(err.text, "a.obj:3: found 'x'");
    /* The text is one line without control characters. */
    fail(&err, "a\nb\033[2Jc\177\t\xc2\x9b z\xc3\xa4");
    assert_string_equal(err.text, "a?b?[2Jc??? z\xc3\xa4");
    char *text = xformat("%02000d", 7);
    fail(&err, "%s", text);
    free(text);
    assert_int_equal(strlen(err.text), sizeof err.text - 1);
}

static void failures_are_added_in_the_same_line(void **state)
{
    struct error err, more, cut;

    (void)state;
    fail(&err, "a.film: full");
    fail(&more, "b.film: gone");
    error_add(&err, &more);
    assert_string_equal(err.text, "a.film: full; b.film: gone");
    memset(cut.text, 'x', sizeof cut.text);
    cut.text[sizeof cut.text - 4] = '\0';
    error_add(&cut, &more);
    assert_string_equal(cut.text + sizeof cut.text - 5, "x; b");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fail_formats_one_line_and_returns_false),
        cmocka_unit_test(failures_are_added_in_the_same_line),
    };

    setlocale(LC_CTYPE, "C.UTF-8");
    return cmocka_run_group_tests_name("error", tests, NULL, NULL);
}
