// SPDX-License-Identifier: MIT
/* Streams into memory, and those that have too little of it: the linker sends
 * calls of realloc() to the function here (--wrap in tests.mk). */
#include "tests/unit/check.h"

#include "base/text_stream.h"

/* Calls of realloc() until one fails; 0: none does. */
static int left;

void *__real_realloc(void *p, size_t size);
void *__wrap_realloc(void *p, size_t size);
void *__wrap_realloc(void *p, size_t size)
{
    return left > 0 && --left == 0 ? NULL : __real_realloc(p, size);
}

static char *write_numbers(int count, size_t *size_bytes)
{
    struct text_stream s;

    if (text_stream_open(&s))
        for (int i = 0; i < count; i++)
            fprintf(s.to, "%04d\n", i);
    return text_stream_close(&s, size_bytes);
}

static void everything_is_kept(void **state)
{
    static const int counts[] = {0, 1, 3, 1000, 20000};

    (void)state;
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        size_t size_bytes = 1;
        char *text = write_numbers(counts[i], &size_bytes);

        assert_non_null(text);
        assert_int_equal(strlen(text), size_bytes);
        assert_in_range(size_bytes, 5 * (size_t)counts[i],
                        5 * (size_t)counts[i] + (size_t)counts[i] / 2);
        for (int k = 0; k < counts[i] && k < 10000; k++)
            assert_int_equal(atoi(text + 5 * k), k);
        free(text);
    }
}

static void bytes_may_be_zero(void **state)
{
    struct text_stream s;
    size_t size_bytes;
    char *bytes;

    (void)state;
    assert_true(text_stream_open(&s));
    fwrite("a\0b", 1, 3, s.to);
    fflush(s.to);
    assert_int_equal(s.size_bytes, 3);
    fwrite("\0", 1, 1, s.to);
    bytes = text_stream_close(&s, &size_bytes);
    assert_int_equal(size_bytes, 4);
    assert_memory_equal(bytes, "a\0b\0", 5);
    free(bytes);
}

/* Whichever allocation fails, no part of a text is taken for all of it. */
static void lack_of_memory_is_seen(void **state)
{
    size_t size_bytes;
    int failures = 0;

    (void)state;
    for (int n = 1; n < 100; n++) {
        char *text;
        bool has_failed;

        left = n;
        text = write_numbers(20000, &size_bytes);
        has_failed = left == 0;
        left = 0;
        assert_true(has_failed == (text == NULL));
        failures += has_failed;
        free(text);
    }
    assert_in_range(failures, 5, 90);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(everything_is_kept),
        cmocka_unit_test(bytes_may_be_zero),
        cmocka_unit_test(lack_of_memory_is_seen),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
