// SPDX-License-Identifier: MIT
/*
 * test_glyph_memory.c - each terminal has its own choice; the last fifty are
 * remembered; files of other contents do no harm
 */
#include "tests/unit/check.h"
#include "tests/unit/folder.h"

#include <string.h>

#include "session/state_list.h"

static void write_file(const char *text)
{
    FILE *to = fopen("state/glim/glyphs", "w");

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_terminal_has_its_own),
        cmocka_unit_test(the_last_fifty_are_remembered),
        cmocka_unit_test(other_lines_are_left_out),
    };

    return cmocka_run_group_tests(tests, enter_folder_with_state,
                                  remove_folder);
}
