// SPDX-License-Identifier: MIT
/*
 * test_tty_input.c - keys, mouse reports and answers of terminals (control
 * sequences of xterm, keys of the Linux console), whole and in pieces
 */
#include "tests/unit/check.h"

#include <string.h>

#include "terminal/tty_input.h"

#define EVENTS_MAX 64

static struct event events[EVENTS_MAX];

/* Feeds the bytes in pieces of this size. Returns the number of events. */
static int parse(const char *bytes, size_t length, size_t piece)
{
    static struct tty_input in;
    int count = 0;

    memset(&in, 0, sizeof in);
    for (size_t i = 0; i < length; i += piece) {
        size_t n = length - i < piece ? length - i : piece;

        assert_int_equal(tty_input_feed(&in, bytes + i, n), n);
        while (tty_input_next(&in, false, &events[count]))
            assert_true(++count < EVENTS_MAX);
    }
    while (tty_input_next(&in, true, &events[count]))
        assert_true(++count < EVENTS_MAX);
    assert_false(tty_input_is_partial(&in));
    return count;
}

static struct event only_event(const char *bytes, size_t piece)
{
    int count = parse(bytes, strlen(bytes), piece);

    if (count != 1)
        print_error("%d events from ESC%s\n", count, bytes + 1);
    assert_int_equal(count, 1);
    return events[0];
}

static void sequences_become_keys(void **state)
{
    static const struct {
        const char *bytes;
        int key;
    } cases[] = {
        {"w", 'w'},
        {"\r", '\r'},
        {"\n", '\r'},
        {"\003", 3},
        {"\033", 27},
        {"\033[A", TTY_KEY_UP},
        {"\033OA", TTY_KEY_UP},
        {"\033[B", TTY_KEY_DOWN},
        {"\033[C", TTY_KEY_RIGHT},
        {"\033OD", TTY_KEY_LEFT},
        {"\033[1;2A", TTY_KEY_UP},
        {"\033[5~", TTY_KEY_PAGE_UP},
        {"\033[6~", TTY_KEY_PAGE_DOWN},
        {"\033OP", TTY_KEY_F1},
        {"\033[11~", TTY_KEY_F1},
        {"\033[[A", TTY_KEY_F1}, /* the Linux console */
        {"\033[[B", TTY_KEY_OTHER},
        {"\033[H", TTY_KEY_HOME},
        {"\033[F", TTY_KEY_END},
        {"\033[4~", TTY_KEY_END},
        {"\033[2~", TTY_KEY_INSERT},
        {"\033[3~", TTY_KEY_DELETE},
        {"\033[1~", TTY_KEY_HOME},
        {"\033OM", '\r'}, /* Enter of the keypad */
        {"\033[15~", TTY_KEY_OTHER},
        {"\xc3\xa4", TTY_KEY_OTHER}, /* a character beyond ASCII is one key */
        {"\xe2\x82\xac", TTY_KEY_OTHER},
        {"\xf0\x9f\x98\x80", TTY_KEY_OTHER},
        {"\xe4", TTY_KEY_OTHER}, /* Latin-1 */
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        for (size_t piece = 1; piece < 4; piece++) {
            struct event e = only_event(cases[i].bytes, piece);

            assert_int_equal(e.kind, EVENT_KEY);
            assert_int_equal(e.key, cases[i].key);
        }
    }
    assert_int_equal(only_event("\xc3\xa9", 2).key,
                     TTY_KEY_OTHER); /* e acute */
}

/* Bytes that arrive together are the same keys as bytes that arrive one by one.
 * Alt with a key sends such bytes. */
static void escape_and_a_key_are_two(void **state)
{
    struct tty_input in = {.length = 0};
    struct event e;

    (void)state;
    tty_input_feed(&in, "\033q", 2);
    assert_true(tty_input_next(&in, false, &e));
    assert_int_equal(e.key, 27);
    assert_true(tty_input_next(&in, false, &e));
    assert_int_equal(e.key, 'q');
    assert_false(tty_input_next(&in, false, &e));
}

/* These are an xterm and kitty, and names that would break a line of a file. */
static void terminals_have_names(void **state)
{
    struct event e;

    (void)state;
    e = only_event("\033P>|XTerm(379)\033\\", 5);
    assert_int_equal(e.kind, EVENT_NAME);
    assert_string_equal(e.name, "XTerm(379)");
    e = only_event("\033P>|kitty(0.26.5)\033\\", 1);
    assert_string_equal(e.name, "kitty(0.26.5)");
    e = only_event("\033P>|tmux 3.3a\033\\", 100);
    assert_string_equal(e.name, "tmux_3.3a");
    e = only_event("\033P>|a\nb\xc3\033\\", 100);
    assert_string_equal(e.name, "a_b_");
    e = only_event("\033P>|0123456789012345678901234567890123456789012345678"
                   "\033\\",
                   100);
    assert_int_equal(strlen(e.name), TTY_NAME_BYTES - 1);
}

static void answers_become_events(void **state)
{
    static const struct {
        const char *bytes;
        enum event_kind kind;
        int x, y;
    } cases[] = {
        {"\033[0n", EVENT_READY, 0, 0},
        {"\033[?64;1;2;6;22c", EVENT_ATTRIBUTES, 0, 0},
        {"\033[?4;6c", EVENT_ATTRIBUTES, 0, 0}, /* a VT132 without sixels */
        /* These are an xterm as a VT340, and foot. */
        {"\033[?63;1;2;4;6;9;15;16;22;28;29c", EVENT_ATTRIBUTES, 1, 0},
        {"\033[?62;4;22;28c", EVENT_ATTRIBUTES, 1, 0},
        {"\033[?1;0;1024S", EVENT_SIXEL_COLORS, 1024, 0},
        {"\033_Gi=1;OK\033\\", EVENT_KITTY, 0, 0},
        {"\033]11;rgb:ffff/ffff/ffff\033\\", EVENT_BACKGROUND, 1, 0},
        {"\033]11;rgb:0000/0000/0000\007", EVENT_BACKGROUND, 0, 0},
        {"\033]11;rgb:fd/f6/e3\007", EVENT_BACKGROUND, 1, 0},
        {"\033]11;rgb:0000/2b2b/3636\033\\", EVENT_BACKGROUND, 0, 0},
        {"\033[?2026;2$y", EVENT_SYNC, 0, 0},
        {"\033[?2026;1$y", EVENT_SYNC, 0, 0},
        {"\033[6;17;8t", EVENT_CELL_SIZE, 8, 17},
        {"\033[1;2R", EVENT_CURSOR, 2, 1},
        /* These are xterm, kitty and foot, and a terminal with semicolons. */
        {"\033P1$r0;48:2::1:2:3m\033\\", EVENT_TRUE_COLOR, 0, 0},
        {"\033P1$r0;48:2:1:2:3m\033\\", EVENT_TRUE_COLOR, 0, 0},
        {"\033P1$r48;2;1;2;3m\033\\", EVENT_TRUE_COLOR, 0, 0},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        for (size_t piece = 1; piece < 40; piece += 3) {
            struct event e = only_event(cases[i].bytes, piece);

            assert_int_equal(e.kind, cases[i].kind);
            assert_int_equal(e.x, cases[i].x);
            assert_int_equal(e.y, cases[i].y);
        }
    }
}

/* Answers that say no, and answers without a question, are not keys. */
static void other_sequences_are_dropped(void **state)
{
    static const char *const cases[] = {
        "\033[?2026;0$y",           /* unknown mode */
        "\033[?2026;4$y",           /* known, but always off */
        "\033[?1;2$y",              /* another mode */
        "\033P1$r0;48:5:16m\033\\", /* rounded to 256 colours */
        "\033P0$r\033\\",           /* the question is unknown */
        "\033P>XTerm(379)\033\\",
        "\033]10;rgb:0000/0000/0000\033\\",
        "\033]11;rgb:0000/00x0/0000\007",
        "\033]11;rgb:0000/0000\007",
        "\033]11;?\007",
        "\033[>41;379;0c",
        "\033_Gi=1;ENOTSUPPORTED:no\033\\",
        "\033_G\033\\",
        "\033[?1;3;0S", /* no answer about colours */
        "\033[?2;0;1000;1000S",
        "\033[3n",
        "\033[8;24;80t",
        "\033[<35;10;10",
        "\033P1$r48",
        "\033[",
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        for (size_t piece = 1; piece < 40; piece += 3)
            assert_int_equal(parse(cases[i], strlen(cases[i]), piece), 0);
}

static void mouse_reports_become_events(void **state)
{
    struct event e;

    (void)state;
    e = only_event("\033[<0;12;34M", 3);
    assert_true(e.kind == EVENT_MOUSE && e.mouse == MOUSE_PRESS);
    assert_true(e.button == 0 && e.x == 12 && e.y == 34);
    assert_int_equal(only_event("\033[<0;12;34m", 3).mouse, MOUSE_RELEASE);
    e = only_event("\033[<34;250;3M", 3);
    assert_true(e.mouse == MOUSE_DRAG && e.button == 2 && e.x == 250);
    assert_int_equal(only_event("\033[<35;1;1M", 3).mouse,
                     MOUSE_OTHER); /* no button */
    assert_false(e.is_modified);
    assert_false(only_event("\033[<4;1;1M", 3).is_modified); /* Shift */
    assert_true(only_event("\033[<8;1;1M", 3).is_modified);
    assert_true(only_event("\033[<16;1;1M", 3).is_modified);
    e = only_event("\033[<80;1;1M", 3);
    assert_true(e.mouse == MOUSE_WHEEL_UP && e.is_modified);
    assert_int_equal(only_event("\033[<64;1;1M", 3).mouse, MOUSE_WHEEL_UP);
    assert_int_equal(only_event("\033[<65;1;1M", 3).mouse, MOUSE_WHEEL_DOWN);
    assert_int_equal(only_event("\033[<66;1;1M", 3).mouse, MOUSE_OTHER);
}

/* Feeds the answers at the start, with keys typed in between. */
static void keys_between_answers_are_not_lost(void **state)
{
    static const char bytes[] =
        "\033[1;2Rw\033P1$r0;48:2::1:2:3m\033\\\033[?2026;2$yq\033[6;17;8t"
        "\033[0n\033[A\033[?64;1c?";
    static const enum event_kind kinds[] = {EVENT_CURSOR,     EVENT_KEY,
                                            EVENT_TRUE_COLOR, EVENT_SYNC,
                                            EVENT_KEY,        EVENT_CELL_SIZE,
                                            EVENT_READY,      EVENT_KEY,
                                            EVENT_ATTRIBUTES, EVENT_KEY};

    (void)state;
    for (size_t piece = 1; piece < sizeof bytes; piece++) {
        int count = parse(bytes, sizeof bytes - 1, piece);

        assert_int_equal(count, 10);
        for (int i = 0; i < count; i++)
            assert_int_equal(events[i].kind, kinds[i]);
        assert_int_equal(events[1].key, 'w');
        assert_int_equal(events[4].key, 'q');
        assert_int_equal(events[7].key, TTY_KEY_UP);
        assert_int_equal(events[9].key, '?');
    }
}

/* Keys between the marks of a pasted text are no keys, answers are answers. */
static void pasted_text_is_marked(void **state)
{
    static const char bytes[] = "w\033[200~wq\033[A\r\033[0n\033[201~q";
    static const enum event_kind kinds[] = {EVENT_KEY,    EVENT_PASTED,
                                            EVENT_PASTED, EVENT_PASTED,
                                            EVENT_PASTED, EVENT_READY,
                                            EVENT_KEY};

    (void)state;
    for (size_t piece = 1; piece < 12; piece++) {
        assert_int_equal(parse(bytes, sizeof bytes - 1, piece), 7);
        for (int i = 0; i < 7; i++)
            assert_int_equal(events[i].kind, kinds[i]);
        assert_int_equal(events[2].key, 'q');
    }
}

/* For any bytes the parser ends, keys are in range, and the events fit. */
static void random_bytes_do_no_harm(void **state)
{
    static struct tty_input in;
    static const char alphabet[] =
        "\033\033\033[[P]O\\;?<0123456789mMcRnty~q\007";
    uint64_t seed = 11;
    struct event e;

    (void)state;
    for (int i = 0; i < 200000; i++) {
        unsigned char byte =
            check_random(&seed) < 0.8
                ? (unsigned char)alphabet[(int)((sizeof alphabet - 1) *
                                                check_random(&seed))]
                : (unsigned char)(256 * check_random(&seed));

        assert_int_equal(tty_input_feed(&in, &byte, 1), 1);
        while (tty_input_next(&in, check_random(&seed) < 0.01, &e)) {
            if (e.kind == EVENT_KEY)
                assert_in_range(e.key, 0, TTY_KEY_OTHER);
        }
        assert_true(in.length < 600);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sequences_become_keys),
        cmocka_unit_test(escape_and_a_key_are_two),
        cmocka_unit_test(terminals_have_names),
        cmocka_unit_test(answers_become_events),
        cmocka_unit_test(other_sequences_are_dropped),
        cmocka_unit_test(mouse_reports_become_events),
        cmocka_unit_test(keys_between_answers_are_not_lost),
        cmocka_unit_test(pasted_text_is_marked),
        cmocka_unit_test(random_bytes_do_no_harm),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
