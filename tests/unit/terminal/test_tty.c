// SPDX-License-Identifier: MIT
/*
 * test_tty.c - the whole screen on a terminal for tests (vt.h)
 *
 * glim runs in a child process. Each time before it waits, it reports the
 * expected screen: text, picture, swatches (belief.h). After every key the
 * terminal must show this screen, and no sequence may have moved cells.
 *
 * TERM_KEYS and TERM_SEED in the environment set the number of random keys and
 * their seed.
 */
#include "tests/unit/check.h"

#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/memory.h"
#include "session/session.h"
#include "studio/event_loop.h"
#include "tests/unit/belief.h"
#include "tests/unit/folder.h"

#include <term.h> /* last: it defines macros with short names */

/* Time that a busy program may be silent on a loaded machine. */
#define PATIENCE_MS 30000

/* Escape with a key behind it that does nothing; alone, Escape is recognised
 * only after a timeout. */
#define ESCAPE "\033\xc3\xa9"

/* Number of keys between two comparisons of the whole picture. */
#define WHOLE_EVERY 20

#define KEYS      2000
#define KEYS_LAST 12 /* printed after a failure */

static int run_glim(char **arguments)
{
    struct options options;
    struct session session;
    struct error err = {""};
    int status = 1, count = 0;

    while (arguments[count])
        count++;
    memory_init();
    setlocale(LC_CTYPE, "");
    options_init(&options);
    if (!options_parse(&options, count, arguments, &err) ||
        !session_open(&session, &options, clock_ns(), &err) ||
        !event_loop_run(&session, NULL, &status, &err))
        fprintf(stderr, "glim: %s\n", err.text);
    return status;
}

static void become_glim(const char *slave, const char *name, char **arguments)
{
    const char *color = strncmp(name, "xterm", 5) == 0 ? "truecolor" : "";
    int fd;

    is_child = true;
    signal(SIGSEGV, SIG_DFL); /* cmocka has a handler for it */
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    setsid();
    fd = open(slave, O_RDWR);
    ioctl(fd, TIOCSCTTY, 0);
    dup2(fd, STDIN_FILENO);
    dup2(fd, STDOUT_FILENO);
    close(fd);
    setenv("TERM", name, 1);
    setenv("COLORTERM", color, 1);
    if (chdir(folder) != 0)
        _exit(1);
    _exit(run_glim(arguments));
}

static struct vt vt;

static struct {
    const char *term;
    int pty;
    pid_t pid;
    unsigned strings; /* already seen */
    unsigned long sent_bytes;
    char last[KEYS_LAST][128]; /* most recent keys */
    unsigned key_count;
} line;

static void print_readable(const char *text)
{
    for (; *text != '\0'; text++)
        print_error((unsigned char)*text < ' ' ? "\\%03o" : "%c", *text);
}

/* Prints the most recent keys and ends the test. */
static void fail_at(const char *what)
{
    unsigned first =
        line.key_count > KEYS_LAST ? line.key_count - KEYS_LAST : 0;
    int status;

    print_error("TERM=%s, %dx%d, key %u: %s\nthe last keys:", line.term,
                vt.cols, vt.rows, line.key_count, what);
    for (unsigned i = first; i < line.key_count; i++) {
        print_error(" ");
        print_readable(line.last[i % KEYS_LAST]);
    }
    print_error("\n");
    kill(line.pid, SIGKILL);
    waitpid(line.pid, &status, 0);
    if (WIFEXITED(status))
        print_error("exit status %d\n", WEXITSTATUS(status));
    else if (WTERMSIG(status) != SIGKILL)
        print_error("signal %d\n", WTERMSIG(status));
    _fail(__FILE__, __LINE__);
}

static void open_pty(char slave[64])
{
    line.pty = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    assert_true(line.pty >= 0 && grantpt(line.pty) == 0 &&
                unlockpt(line.pty) == 0 && ptsname_r(line.pty, slave, 64) == 0);
}

static void set_size(int cols, int rows)
{
    struct winsize size = {.ws_col = (unsigned short)cols,
                           .ws_row = (unsigned short)rows};

    vt_resize(&vt, cols, rows);
    ioctl(line.pty, TIOCSWINSZ, &size);
}

static void open_line(const char *term, int cols, int rows, char **arguments)
{
    char slave[64];
    int found;

    memset(&line, 0, sizeof line);
    line.term = term;
    vt_open(&vt, cols, rows);
    setupterm(term, STDOUT_FILENO, &found);
    vt.wraps_at_once = auto_right_margin && !eat_newline_glitch;
    del_curterm(cur_term);
    open_pty(slave);
    set_size(cols, rows);
    shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE,
                  MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(shared != MAP_FAILED);
    assert_int_equal(sem_init(&shared->go, 1, 0), 0);
    fflush(NULL);
    line.pid = fork();
    assert_true(line.pid >= 0);
    if (line.pid == 0)
        become_glim(slave, term, arguments);
}

static void send(const char *bytes, size_t length)
{
    assert_int_equal(write(line.pty, bytes, length), length);
    line.sent_bytes += length;
}

/* Reads the output of glim until it reports its screen, or until it is silent
 * for PATIENCE_MS. Returns false when it has ended. */
static bool listen(void)
{
    struct pollfd in = {.fd = line.pty, .events = POLLIN};
    char bytes[65536];
    ssize_t count;

    for (;;) {
        if (poll(&in, 1, PATIENCE_MS) <= 0)
            fail_at("silent for too long");
        count = read(line.pty, bytes, sizeof bytes);
        if (count <= 0)
            return false;
        vt_write(&vt, bytes, (size_t)count);
        if (vt.answer_length > 0)
            send(vt.answers, vt.answer_length);
        vt.answer_length = 0;
        if (vt.string_count == line.strings)
            continue;
        line.strings = vt.string_count;
        if (strcmp(vt.last_string, "]told") == 0)
            return true;
    }
}

static void check_nothing_moved(void)
{
    const char *note = vt.moved[0] != '\0' ? vt.moved : vt.unknown;

    if (note[0] == '\0' || getenv("SKIP"))
        return;
    print_error("%s: ", vt.moved[0] != '\0' ? "moves cells" : "not known");
    print_readable(note);
    print_error("\n");
    fail_at("a sequence that must not be sent");
}

static bool is_blank(const struct vt_cell *c)
{
    return (c->glyph == ' ' || c->glyph == 0) && c->combined[0] == 0 &&
           c->bg == CELL_DEFAULT && !(c->attributes & VT_REVERSE);
}

static bool shows(const struct vt_cell *got, const struct belief_cell *want)
{
    if (want->kind == BELIEF_UNKNOWN)
        return true;
    if (want->kind == BELIEF_PICTURE)
        return vt_shows(got, &want->picture, want->glyphs);
    if (is_blank(got) && is_blank(&want->text))
        return true;
    if (want->text.glyph == VT_TAIL) /* the left half has the attributes */
        return got->glyph == VT_TAIL;
    return memcmp(got, &want->text, sizeof *got) == 0;
}

static void fail_cell(int x, int y)
{
    const struct vt_cell *got = &vt.cell[y][x];
    const struct belief_cell *want = &shared->cell[y][x];
    bool is_text = want->kind == BELIEF_TEXT;

    print_error("column %d of row %d shows U+%04X, colours %06x on %06x, "
                "attributes %x; ",
                x, y, got->glyph, got->fg, got->bg, got->attributes);
    print_error("glim believes in %s U+%04X, colours %06x on %06x, "
                "attributes %x\n",
                is_text ? "text" : "the picture",
                is_text ? want->text.glyph : want->picture.glyph,
                is_text ? want->text.fg : want->picture.fg,
                is_text ? want->text.bg : want->picture.bg,
                want->text.attributes);
    fail_at("the screen is another than glim believes");
}

static void check_screen(void)
{
    check_nothing_moved();
    for (int y = 0; y < vt.rows; y++) {
        for (int x = 0; x < vt.cols; x++) {
            if (!shows(&vt.cell[y][x], &shared->cell[y][x]))
                fail_cell(x, y);
        }
    }
}

/* Returns whether everything sent has been read and curses has written
 * everything. */
static bool is_quiet(void)
{
    return shared->taken_bytes == line.sent_bytes && shared->is_whole &&
           shared->cols == vt.cols && shared->rows == vt.rows;
}

static bool is_complete(void)
{
    for (int y = 0; y < vt.rows; y++) {
        for (int x = 0; x < vt.cols; x++) {
            if (shared->cell[y][x].kind == BELIEF_UNKNOWN)
                return false;
        }
    }
    return true;
}

/* Waits until the screen can be compared; with `all`, until every cell is
 * drawn. Compares it whenever that is possible. */
static void settle(bool all)
{
    uint64_t begin_ns = clock_ns();

    for (bool is_first = true;; is_first = false) {
        if (!is_first)
            sem_post(&shared->go);
        if (!listen())
            fail_at("glim has ended");
        if (is_quiet()) {
            check_screen();
            if (!all || is_complete())
                return;
        }
        if (clock_ns() - begin_ns > PATIENCE_MS * UINT64_C(1000000))
            fail_at("the screen is never whole");
    }
}

static void remember(const char *bytes)
{
    snprintf(line.last[line.key_count++ % KEYS_LAST], sizeof line.last[0], "%s",
             bytes);
}

static void press(const char *bytes, bool all)
{
    remember(bytes);
    send(bytes, strlen(bytes));
    sem_post(&shared->go);
    settle(all);
}

static void settle_all(void)
{
    sem_post(&shared->go);
    settle(true);
}

static void resize(int cols, int rows, bool all)
{
    char text[32];

    snprintf(text, sizeof text, "%dx%d", cols, rows);
    remember(text);
    set_size(cols, rows);
    sem_post(&shared->go);
    settle(all);
}

static void close_line(void)
{
    int status;

    send("\003", 1);
    do
        sem_post(&shared->go);
    while (listen());
    waitpid(line.pid, &status, 0);
    close(line.pty);
    munmap(shared, sizeof *shared);
    shared = NULL;
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 128 + SIGINT);
}

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
        "g", "?", "x", "x", "x", "x", "x", "?", ESCAPE,
        /* Opens the panel above a table. */
        "\t", "\033[B", "\033[B", "\r", "\033[B", "]", "[", "u", "?", ESCAPE,
        ESCAPE, "\t", "\t", ">", ">", ">", ESCAPE, ESCAPE,
        /* Shows questions and messages in the last line. */
        "k", "3", "3", "k", ESCAPE, "i", ">", "k", ESCAPE, "i", "\014",
        /* Changes colours and glyphs. */
        "C", ">", "C", ">", "C", ">", "C", "G", ">", "G", ">", "G", ">", "G",
        ">", "G", " ", "\r", ".", "0", ESCAPE, " ", "y", "m", "m"};

    for (int i = 0; i < COUNT(keys); i++)
        press(keys[i], i % WHOLE_EVERY == 0);
    for (int i = 0; i < COUNT(sizes); i++) {
        static const char *const few[] = {">", "\t",   "\033[B", ESCAPE,
                                          "?", ESCAPE, "g",      "g"};

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
        if (!has_terminal(terminals[i]))
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

/* Sends a random key that does something, except q, ^Z, ^C, ^\\ and b. Keys
 * that open or close something are more frequent. */
static void random_key(uint64_t *seed)
{
    static const char *const rare[] = {
        "w",       "s",      "a",      "d",      "Q",    "e",       "\033[A",
        "\033[B",  "\033[C", "\033[D", "+",      "-",    "o",       "z",
        "Z",       "[",      "]",      "f",      "{",    "}",       "u",
        "U",       "r",      "k",      "1",      "2",    "9",       "c",
        " ",       ".",      "0",      "p",      "P",    "x",       "l",
        "m",       "\014",   "y",      "#",      "-",    "5",       "\033[5~",
        "\033[6~", "\023",   "h",      "\033[H", "\177", "\xc3\xa9"};
    static const char *const often[] = {"v",  "\r", "n", "N", "t", "<", ">",
                                        "\t", "C",  "G", "g", "i", "?", ESCAPE};
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

static void random_keys_leave_the_expected_screen(void **state)
{
    unsigned long keys = number_from("TERM_KEYS", KEYS);
    uint64_t seed = number_from("TERM_SEED", 1);

    (void)state;
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
