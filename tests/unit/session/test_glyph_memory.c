// SPDX-License-Identifier: MIT
/*
 * test_glyph_memory.c - each terminal has its own choice; the last fifty are
 * remembered; files of other contents do no harm
 */
#include "tests/unit/check.h"
#include "tests/unit/folder.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "session/state_list.h"

static void write_file(const char *text)
{
    FILE *to;

    state_list_finish();
    to = fopen("state/glim/glyphs", "w");
    assert_non_null(to);
    fputs(text, to);
    fclose(to);
}

static void each_terminal_has_its_own(void **state)
{
    (void)state;
    assert_int_equal(glyph_memory_read("XTerm(379)"), GLYPH_AUTO);
    glyph_memory_write("XTerm(379)", GLYPH_SIXEL);
    glyph_memory_write("kitty(0.26.5)", GLYPH_KITTY);
    glyph_memory_write("XTerm(380)", GLYPH_BRAILLE);
    assert_int_equal(glyph_memory_read("XTerm(379)"), GLYPH_SIXEL);
    assert_int_equal(glyph_memory_read("kitty(0.26.5)"), GLYPH_KITTY);
    assert_int_equal(glyph_memory_read("XTerm(380)"), GLYPH_BRAILLE);
    assert_int_equal(glyph_memory_read("XTerm"), GLYPH_AUTO);
    glyph_memory_write("XTerm(379)", GLYPH_BLOCK);
    assert_int_equal(glyph_memory_read("XTerm(379)"), GLYPH_BLOCK);
    glyph_memory_write("XTerm(379)", GLYPH_AUTO);
    assert_int_equal(glyph_memory_read("XTerm(379)"), GLYPH_AUTO);
    assert_int_equal(glyph_memory_read("kitty(0.26.5)"), GLYPH_KITTY);
}

static void the_last_fifty_are_remembered(void **state)
{
    char name[16];

    (void)state;
    for (int i = 0; i < 60; i++) {
        snprintf(name, sizeof name, "term-%d", i);
        glyph_memory_write(name, GLYPH_BLOCK);
    }
    for (int i = 0; i < 60; i++) {
        snprintf(name, sizeof name, "term-%d", i);
        assert_int_equal(glyph_memory_read(name),
                         i < 10 ? GLYPH_AUTO : GLYPH_BLOCK);
    }
}

static void other_lines_are_left_out(void **state)
{
    (void)state;
    write_file("block\n\n \nhexagon a\nblock b\nbraille b\nascii");
    assert_int_equal(glyph_memory_read("a"), GLYPH_AUTO);
    assert_int_equal(glyph_memory_read("b"), GLYPH_BLOCK);
    assert_int_equal(glyph_memory_read(""), GLYPH_AUTO);
    glyph_memory_write("c", GLYPH_ASCII);
    assert_int_equal(glyph_memory_read("b"), GLYPH_BLOCK);
    assert_int_equal(glyph_memory_read("c"), GLYPH_ASCII);
}

/* A choice is remembered before it is in the file, and in its order. */
static void threads_write_all(void **state)
{
    struct state_list list;
    FILE *from;
    char line[32];

    (void)state;
    write_file("");
    glyph_memory_write("a", GLYPH_HALF);
    glyph_memory_write("b", GLYPH_SHADE);
    glyph_memory_write("a", GLYPH_ASCII);
    assert_int_equal(glyph_memory_read("a"), GLYPH_ASCII);
    state_list_finish();
    from = fopen("state/glim/glyphs", "r");
    assert_non_null(from);
    assert_non_null(fgets(line, sizeof line, from));
    assert_string_equal(line, "ascii a\n");
    assert_non_null(fgets(line, sizeof line, from));
    assert_string_equal(line, "shade b\n");
    assert_null(fgets(line, sizeof line, from));
    fclose(from);
    state_list_read(&list, &(struct state_list_file){"none", 1, NULL});
    assert_int_equal(list.count, 0);
}

/* A file that cannot be read is not replaced: this one is too large. */
static void unreadable_lists_stay(void **state)
{
    struct stat found;

    (void)state;
    write_file("block b\n");
    if (truncate("state/glim/glyphs", (off_t)1 << 40) != 0)
        skip();
    glyph_memory_write("c", GLYPH_ASCII);
    state_list_finish();
    assert_int_equal(stat("state/glim/glyphs", &found), 0);
    assert_int_equal(found.st_size, (off_t)1 << 40);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_terminal_has_its_own),
        cmocka_unit_test(the_last_fifty_are_remembered),
        cmocka_unit_test(other_lines_are_left_out),
        cmocka_unit_test(threads_write_all),
        cmocka_unit_test(unreadable_lists_stay),
    };

    return cmocka_run_group_tests(tests, enter_folder_with_state,
                                  remove_folder);
}
