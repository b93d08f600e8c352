// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/memory.h"
#include "terminal/xmalloc.h"

static void strings_are_copied_and_formatted(void **state)
{
    char *a = xstrdup("abc"), *b = xformat("%s-%d", a, 12);

    (void)state;
    assert_string_equal(b, "abc-12");
    a = xrealloc(a, 10);
    assert_string_equal(a, "abc");
    free(a);
    free(b);
    free(xmalloc(0));
}

static void arrays_beyond_memory_are_refused(void **state)
{
    (void)state;
    unsigned char *p = alloc_array(1000, 7);
    assert_non_null(p);
    for (int i = 0; i < 7000; i++)
        assert_int_equal(p[i], 0);
    free(p);
    p = alloc_array(0, 8);
    assert_non_null(p);
    free(p);
    assert_null(alloc_array(SIZE_MAX / 2, 4));
    assert_null(alloc_array((size_t)1 << 33, (size_t)1 << 33));
    assert_null(alloc_array(SIZE_MAX, 1));
}

static void arrays_keep_their_contents_as_they_grow(void **state)
{
    uint32_t *items = NULL;
    void *array = NULL;
    size_t capacity = 0;
    int moves = 0;

    (void)state;
    for (uint32_t i = 0; i < 100000; i++) {
        size_t before = capacity;
        assert_true(grow_array(&array, &capacity, i + 1, sizeof *items));
        assert_true(capacity > i);
        moves += capacity != before;
        items = array;
        items[i] = i;
    }
    assert_true(moves <= 17);
    for (uint32_t i = 0; i < 100000; i++)
        assert_int_equal(items[i], i);
    size_t before = capacity;
    assert_false(grow_array(&array, &capacity, SIZE_MAX / 2, sizeof *items));
    assert_false(grow_array(&array, &capacity, SIZE_MAX, 1));
    assert_ptr_equal(array, items);
    assert_int_equal(capacity, before);
    free(array);
}

#define LARGE_BYTES ((size_t)32 << 20)

/* Returns whether the mapping of an address asks for large pages, by the flag
 * of proc_pid_smaps(5). */
static bool asks_for_large_pages(const void *p)
{
    FILE *from = fopen("/proc/self/smaps", "r");
    unsigned long begin = 0, end = 0, address = (unsigned long)p;
    char line[512];
    bool asks = false;

    assert_non_null(from);
    while (fgets(line, sizeof line, from) != NULL)
        if (strncmp(line, "VmFlags:", 8) == 0)
            asks |= begin <= address && address < end &&
                    strstr(line, " hg") != NULL;
        else
            sscanf(line, "%lx-%lx ", &begin, &end);
    fclose(from);
    return asks;
}

/* All bytes of an array have them, so that the system grows it in place. */
static void large_arrays_ask_for_large_pages(void **state)
{
    size_t capacity = 0, sizes[] = {LARGE_BYTES / 2, LARGE_BYTES};
    char *arrays[] = {alloc_array(LARGE_BYTES, 1),
                      alloc_aligned(LARGE_BYTES, 1)};
    void *grown = NULL;

    (void)state;
    if (access("/sys/kernel/mm/transparent_hugepage", F_OK) != 0) {
        puts("memory: skipped: this system has no large pages");
        skip();
    }
    for (int i = 0; i < 2; i++) {
        char *p;

        assert_true(grow_array(&grown, &capacity, sizes[i], 1));
        p = grown;
        assert_true(asks_for_large_pages(p));
        assert_true(asks_for_large_pages(p + sizes[i] - 1));
        assert_true(asks_for_large_pages(arrays[i]));
        assert_true(asks_for_large_pages(arrays[i] + LARGE_BYTES - 1));
        free(arrays[i]);
    }
    free(grown);
}

static void print_hook(void)
{
    static const char text[] = "restored\n";

    if (write(STDERR_FILENO, text, sizeof text - 1) < 0)
        _exit(9);
}

/* When memory is out, the hook is called, one line is printed, and the exit
 * status is 1. */
static void out_of_memory_calls_the_hook_and_exits(void **state)
{
    int ends[2], status;
    char text[200] = "";
    size_t length = 0;
    ssize_t n;

    (void)state;
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], STDERR_FILENO);
        xmalloc_set_hook(print_hook);
        xcalloc(SIZE_MAX / 2, 4);
        _exit(0);
    }
    close(ends[1]);
    while ((n = read(ends[0], text + length, sizeof text - 1 - length)) > 0)
        length += (size_t)n;
    close(ends[0]);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 1);
    assert_string_equal(text, "restored\nglim: out of memory\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strings_are_copied_and_formatted),
        cmocka_unit_test(arrays_beyond_memory_are_refused),
        cmocka_unit_test(arrays_keep_their_contents_as_they_grow),
        cmocka_unit_test(large_arrays_ask_for_large_pages),
        cmocka_unit_test(out_of_memory_calls_the_hook_and_exits),
    };

    return cmocka_run_group_tests_name("memory", tests, NULL, NULL);
}
