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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fail_formats_one_line_and_returns_false),
    };

    setlocale(LC_CTYPE, "C.UTF-8");
    return cmocka_run_group_tests_name("error", tests, NULL, NULL);
}
