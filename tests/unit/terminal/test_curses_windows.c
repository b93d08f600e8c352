// SPDX-License-Identifier: MIT
/*
 * test_curses_windows.c - what text costs on a line; what it shows is compared
 * in test_tty.c
 */
#include <curses.h>
#include <fcntl.h>
#include <unistd.h>

#include "tests/unit/check.h"

#include "terminal/curses_windows.h"

/* Most bytes of "\033[24;80H", of "\033[38;2;r;g;b;48;2;r;g;bm", and of the end
 * of an update, "\033[m\033[24;1H". */
#define JUMP_BYTES   8
#define COLORS_BYTES 39
#define END_BYTES    10

static char written[65536];

/* Returns the bytes of an update, which are in `written` as well. */
static size_t update(void)
{
    FILE *file = tmpfile();
    int before = dup(STDOUT_FILENO);
    size_t size_bytes, read_bytes;

    assert_true(file && before >= 0);
    fflush(stdout);
    dup2(fileno(file), STDOUT_FILENO);
    size_bytes = windows_update();
    dup2(before, STDOUT_FILENO);
    close(before);
    rewind(file);
    read_bytes = fread(written, 1, sizeof written - 1, file);
    written[read_bytes] = '\0';
    fclose(file);
    assert_int_equal(size_bytes, read_bytes);
    return size_bytes;
}

static int count_of(const char *text)
{
    int count = 0;

    for (const char *p = written; (p = strstr(p, text)) != NULL; p++)
        count++;
    return count;
}

static void write_status(int samples)
{
    char text[32];

    snprintf(text, sizeof text, " %3d spp  noise unknown", samples);
    windows_text(WINDOW_STATUS, 0, 0, 40, ROLE_STATUS, text);
}

/* A number in the last row costs one jump, its colours and its digits. */
static void only_changed_cells_are_sent(void **state)
{
    (void)state;
    write_status(7);
    update();
    assert_int_equal(update(), 0);
    write_status(8);
    check_at_most((double)update(), JUMP_BYTES + COLORS_BYTES + 1 + END_BYTES);
    write_status(123);
    check_at_most((double)update(), JUMP_BYTES + COLORS_BYTES + 3 + END_BYTES);
}

/* Colours that stay are not written again: two roles have the same ground. */
static void colors_are_not_repeated(void **state)
{
    struct text_style style =
        theme_style(THEME_DARK, PALETTE_24BIT, ROLE_STATUS);
    char ground[32];

    (void)state;
    assert_int_equal(
        style.bg, theme_style(THEME_DARK, PALETTE_24BIT, ROLE_STATUS_FAINT).bg);
    snprintf(ground, sizeof ground, "48;2;%d;%d;%d", (int)(style.bg >> 16),
             (int)(style.bg >> 8 & 255), (int)(style.bg & 255));
    for (int i = 0; i < 8; i++)
        windows_text(WINDOW_STATUS, 0, 5 * i, 5,
                     i % 2 ? ROLE_STATUS : ROLE_STATUS_FAINT, "word");
    update();
    assert_int_equal(count_of(ground), 1);
    assert_int_equal(count_of("38;2;"), 8);
}

/* Bold text does not make what follows it bold. */
static void attributes_end(void **state)
{
    const char *bold, *text;

    (void)state;
    windows_text(WINDOW_STATUS, 0, 0, 4, ROLE_STATUS_KEY, "bold");
    windows_text(WINDOW_STATUS, 0, 4, 5, ROLE_STATUS, "plain");
    update();
    bold = strstr(written, "bold");
    text = strstr(written, "plain");
    assert_true(bold && text && bold < text);
    assert_non_null(strstr(bold, "\033[0;38;2;"));
    assert_true(strstr(bold, "\033[0;38;2;") < text);
}

static int open_screen(void **state)
{
    FILE *nothing = fopen("/dev/null", "r+");

    (void)state;
    if (!nothing || !newterm("xterm-256color", nothing, nothing))
        return 1;
    resizeterm(24, 80);
    windows_use_theme(THEME_DARK, PALETTE_24BIT);
    windows_reset(true);
    update();
    return 0;
}

static int close_screen(void **state)
{
    (void)state;
    windows_free();
    endwin();
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_changed_cells_are_sent),
        cmocka_unit_test(colors_are_not_repeated),
        cmocka_unit_test(attributes_end),
    };

    return cmocka_run_group_tests(tests, open_screen, close_screen);
}
