// SPDX-License-Identifier: MIT
/*
 * test_tty.c - the whole screen on a terminal for tests (vt.h)
 *
 * glim runs in a child process. Each time before it waits, it reports the
 * expected screen: text, picture, swatches (belief.h). After every key the
 * terminal must show this screen, and no sequence may have moved cells.
 *
 * TERM_KEYS and TERM_SEED in the environment set the number of random keys and
 * their seed. With TERM_SECONDS only random keys are sent, for that long, and
 * memory must not grow after the first tenth of it.
 */
#include <limits.h>
#include <locale.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "tests/unit/folder.h"
#include "tests/unit/terminal/tty_line.h"

/* Escape with a key behind it that does nothing; alone, Escape is recognised
 * only after a timeout. */
#define ESCAPE "\033\xc3\xa9"

/* The list of commands and the menu, searched and closed. Enter comes behind
 * Home, which selects a row that neither ends nor suspends the program, as only
 * a search for q would. */
#define ENTER "\033[H\r"
#define LIST \
    "?"      \
    "zo\177\033[B\033[5~" ESCAPE ESCAPE
#define MENU ESCAPE "o" ESCAPE ESCAPE

/* Growth of memory that is no leak, and keys between two measurements. */
#define GROWTH_MOST_KB 1024
#define REST_EVERY     100

#define KEYS (check_is_thorough() ? 2000 : 700)

static bool has_terminal(const char *name)
{
    int found;

    if (setupterm(name, STDOUT_FILENO, &found) != OK) {
        print_message("skip TERM=%s (no description of it)\n", name);
        return false;
    }
    del_curterm(cur_term);
    return true;
}

static const char *const terminals[] = {"xterm-256color",  "linux",
                                        "screen-256color", "tmux-256color",
                                        "vt100",           "ansi",
                                        "xterm-kitty"};

static const struct {
    int cols, rows;
} sizes[] = {{120, 40}, {80, 24}, {40, 12}, {20, 5},
             {100, 30}, {3, 2},   {60, 50}, {97, 23}};

#define COUNT(array) (int)(sizeof(array) / sizeof(array)[0])

static char program[] = "glim", size_w[] = "-w", width[] = "96",
            size_h[] = "-h", height[] = "54", threads[] = "-t", one[] = "1",
            interior[] = "interior.obj", wide[] = "box.obj";

/* Copies the scenes so that they may be overwritten. The box has names that are
 * wide, that combine, or that are longer than the space for them. */
static void copy_scenes(void)
{
    char command[512];

    snprintf(
        command, sizeof command,
        "cp scenes/interior.* scenes/*.png %s && "
        "for e in obj mtl view; do sed -e 's/white/\xe7\x99\xbd\xe3\x81\x84"
        "\xe5\xa3\x81\xe3\x81\xaf\xe9\x95\xb7\xe3\x81\x84/' -e "
        "'s/green/vert e\xcc\x81tr\xcc\x81"
        "ange/' -e "
        "'s/cornell/box/' <scenes/cornell.$e >%s/box.$e || exit; done",
        folder, folder);
    assert_int_equal(system(command), 0);
}

static int prepare(void **state)
{
    if (make_folder(state) != 0)
        return -1;
    setlocale(LC_CTYPE, "C.UTF-8");
    setenv("LC_ALL", "C.UTF-8", 1);
    setenv("XDG_STATE_HOME", folder, 1);
    unsetenv("TMUX");
    unsetenv("STY");
    unsetenv("NO_COLOR");
    unsetenv("GLIM_COLOR");
    return 0;
}

/* Opens every panel, drawing, view and question, some of them in little
 * space. */
static void press_all_keys(void)
{
    static const char *const keys[] = {
        /* The table of a path has another length at every sample. */
        "t", "t", "t", ">", ">", ">", ">", ">", ">", ">", "<", "<", "<",
        /* Costs are shown for a newly loaded scene. */
        "N", "N", "l", "n", "n",
        /* Picks a point and follows its path. */
        "v", "\033[A", "\r", ESCAPE, "t", "t", "n", "n", "N", "t", "t", "g",
        "g", "?", "x", "x", "x", "x", "x", "?", "\033[B", ESCAPE, ESCAPE,
        /* Opens the panel above a table. */
        "\t", "\033[B", "\033[B", "\r", "\033[B", ")", "(", "u", "?", "\033[6~",
        "\033[F", ESCAPE, ESCAPE, "\t", "\t", ">", ">", ">", ESCAPE, ESCAPE,
        ESCAPE, ESCAPE, MENU,
        /* Shows questions and messages in the last line. */
        "k", "3", "3", "k", ESCAPE, "i", ">", "k", ESCAPE, "i", "\014", "c",
        "n",
        /* Changes colours and glyphs. */
        "C", ">", "C", ">", "C", ">", "C", "G", ">", "G", ">", "G", ">", "G",
        ">", "G", " ", "\r", ".", "0", ESCAPE, " ", "y", "m", "m"};

    for (int i = 0; i < COUNT(keys); i++)
        press(keys[i], i % WHOLE_EVERY == 0);
    for (int i = 0; i < COUNT(sizes); i++) {
        static const char *const few[] = {">",  "\t", "\033[B", ESCAPE,
                                          LIST, "g",  "g"};

        resize(sizes[i].cols, sizes[i].rows, true);
        for (int k = 0; k < COUNT(few); k++)
            press(few[k], false);
    }
}

static void no_key_moves_cells(void **state)
{
    char *arguments[] = {program, size_w, width,    size_h, height,
                         threads, one,    interior, NULL};

    (void)state;
    for (int i = 0; i < COUNT(terminals); i++) {
        if (!check_is_due(2) || getenv("TERM_SECONDS") != NULL ||
            !has_terminal(terminals[i]))
            continue;
        arguments[7] = i == 0 ? interior : wide;
        copy_scenes();
        open_line(terminals[i], 120, 40, arguments);
        settle(true);
        press_all_keys();
        close_line();
    }
}

static int below(uint64_t *seed, int n)
{
    return (int)(check_random(seed) * n);
}

/* Sends a random key that does something, except ^Q, ^Z, ^C, ^\\ and b. Keys
 * that open or close something are more frequent. */
static void random_key(uint64_t *seed)
{
    static const char *const rare[] = {
        "w",      "s",       "a",        "d",       "E",
        "e",      "\033[A",  "\033[B",   "\033[C",  "\033[D",
        "+",      "-",       "o",        "z",       "Z",
        "[",      "]",       "f",        "{",       "}",
        "u",      "U",       "r",        "k",       "1",
        "2",      "9",       "c",        " ",       ".",
        "0",      "p",       "P",        "x",       "l",
        "m",      "\014",    "y",        "#",       "-",
        "5",      "\033[5~", "\033[6~",  "\023",    "h",
        "\033[H", "\177",    "\xc3\xa9", "W",       "(",
        ")",      "\\",      "\033[2~",  "\033[3~", "\033[200~wq\r\033[201~"};
    static const char *const often[] = {"v",  ENTER, "n", "N", "t", "<",  ">",
                                        "\t", "C",   "G", "g", "i", LIST, MENU};
    double what = check_random(seed);
    char text[128];
    int x = 1 + below(seed, vt.cols), y = 1 + below(seed, vt.rows);

    if (what < (vt.cols < 40 || vt.rows < 12 ? 0.5 : 0.03)) {
        int i = below(seed, COUNT(sizes));

        resize(sizes[i].cols, sizes[i].rows, false);
    } else if (what < 0.55) {
        press(often[below(seed, COUNT(often))], false);
    } else if (what < 0.9) {
        press(rare[below(seed, COUNT(rare))], false);
    } else {
        int button = below(seed, 8);

        button = button < 3 ? button : button < 5 ? 64 + button - 3 : 0;
        snprintf(text, sizeof text,
                 "\033[<%d;%d;%dM\033[<%d;%d;%dM\033[<%d;%d;%dm", button, x, y,
                 32 + button, x + 1, y, button, x + 1, y);
        press(text, false);
    }
}

static unsigned long number_from(const char *name, unsigned long otherwise)
{
    const char *text = getenv(name);

    return text && text[0] != '\0' ? strtoul(text, NULL, 10) : otherwise;
}

static void play_random_keys(const char *term, unsigned long keys,
                             uint64_t seed)
{
    char *arguments[] = {program, size_w, width, size_h, height,
                         threads, one,    wide,  NULL};

    if (!has_terminal(term))
        return;
    print_message("TERM=%s, %lu keys, TERM_SEED=%llu\n", term, keys,
                  (unsigned long long)seed);
    copy_scenes();
    open_line(term, 100, 30, arguments);
    settle(true);
    for (unsigned long i = 0; i < keys; i++) {
        random_key(&seed);
        if (i % WHOLE_EVERY == 0)
            settle_all();
    }
    close_line();
}

/* Returns the memory that glim has allocated when it rests. */
static long rest_kb(void)
{
    resize(100, 30, false);
    for (int i = 0; i < 6; i++)
        press(ESCAPE, false);
    shared->wants_memory = true;
    settle_all();
    settle_all();
    shared->wants_memory = false;
    return shared->allocated_bytes / 1024;
}

/* Sends random keys until a time, and returns the least memory at rest in
 * between: what is allocated depends on what is shown and was begun. */
static long play_until(double end, uint64_t begin_ns, uint64_t *seed,
                       unsigned long *keys)
{
    long least_kb = LONG_MAX;

    while ((double)(clock_ns() - begin_ns) * 1e-9 < end) {
        long kb = *keys % REST_EVERY == 0 ? rest_kb() : LONG_MAX;

        least_kb = kb < least_kb ? kb : least_kb;
        random_key(seed);
        if (++*keys % WHOLE_EVERY == 0)
            settle_all();
    }
    return least_kb;
}

/* Sends random keys for a time, of which each tenth has its least memory. In
 * the first one lists that have a limit grow, as that of changes to undo. */
static void soak(double seconds, uint64_t seed)
{
    const double tenth = seconds / 10;
    char *arguments[] = {program, size_w, width, size_h, height,
                         threads, one,    wide,  NULL};
    uint64_t begin_ns = clock_ns();
    unsigned long keys = 0;
    long first_kb;

    copy_scenes();
    open_line(terminals[0], 100, 30, arguments);
    settle(true);
    play_until(tenth, begin_ns, &seed, &keys);
    first_kb = play_until(2 * tenth, begin_ns, &seed, &keys);
    for (double next = 3 * tenth; next <= seconds; next += tenth) {
        long kb = play_until(next, begin_ns, &seed, &keys);

        print_message("%.0f s, %lu keys, %ld KB of memory, %ld KB at first\n",
                      next, keys, kb, first_kb);
        if (kb > first_kb + GROWTH_MOST_KB)
            fail_at("memory grows");
    }
    close_line();
}

static void random_keys_leave_the_expected_screen(void **state)
{
    unsigned long keys = number_from("TERM_KEYS", KEYS);
    uint64_t seed = number_from("TERM_SEED", 1);
    unsigned long seconds = number_from("TERM_SECONDS", 0);

    (void)state;
    if (seconds > 0) {
        soak((double)seconds, seed);
        return;
    }
    play_random_keys(terminals[0], keys / 2, seed);
    for (int i = 1; i < COUNT(terminals); i++)
        play_random_keys(terminals[i], keys / 10, seed + (unsigned)i);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_key_moves_cells),
        cmocka_unit_test(random_keys_leave_the_expected_screen),
    };

    (void)argv;
    if (argc > 1) /* glim looks for a device with a copy of itself */
        return 1;
    return cmocka_run_group_tests(tests, prepare, remove_folder);
}
