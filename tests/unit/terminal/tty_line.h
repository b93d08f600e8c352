// SPDX-License-Identifier: MIT
/*
 * tty_line.h - glim in a child process on a pseudo-terminal
 *
 * press() sends a key and compares the terminal (vt.h) with the screen that the
 * child reports (belief.h).
 *
 * Units:     cells, row 0 at the top
 * Threads:   one
 * Errors:    a wrong screen ends the test and prints the most recent keys
 */
#ifndef TESTS_TTY_LINE_H
#define TESTS_TTY_LINE_H

#include <errno.h>
#include <fcntl.h>
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
#include "studio/studio.h"
#include "tests/unit/belief.h"
#include "tests/unit/check.h"

#include <term.h> /* last: it defines macros with short names */

/* Time that a busy program may be silent on a loaded machine. */
#define PATIENCE_MS 30000

/* Number of keys between two comparisons of the whole picture. */
#define WHOLE_EVERY 20

#define KEYS_LAST 12 /* printed after a failure */

static inline int run_glim(char **arguments)
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
        !studio_loop(&session, &status, &err))
        fprintf(stderr, "glim: %s\n", err.text);
    return status;
}

static inline void become_glim(const char *slave, const char *name,
                               char **arguments)
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

static inline void print_readable(const char *text)
{
    for (; *text != '\0'; text++)
        print_error((unsigned char)*text < ' ' ? "\\%03o" : "%c", *text);
}

/* Prints the most recent keys and ends the test. */
static inline void fail_at(const char *what)
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

static inline void open_pty(char slave[64])
{
    line.pty = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    assert_true(line.pty >= 0 && grantpt(line.pty) == 0 &&
                unlockpt(line.pty) == 0 && ptsname_r(line.pty, slave, 64) == 0);
}

static inline void set_size(int cols, int rows)
{
    struct winsize size = {.ws_col = (unsigned short)cols,
                           .ws_row = (unsigned short)rows};

    vt_resize(&vt, cols, rows);
    ioctl(line.pty, TIOCSWINSZ, &size);
}

static inline void open_line(const char *term, int cols, int rows,
                             char **arguments)
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

static inline void send(const char *bytes, size_t length)
{
    assert_int_equal(write(line.pty, bytes, length), length);
    line.sent_bytes += length;
}

/* Reads the output of glim until it reports its screen, or until it is silent
 * for PATIENCE_MS. Returns false when it has ended. */
static inline bool listen(void)
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

static inline void check_nothing_moved(void)
{
    const char *note = vt.moved[0] != '\0' ? vt.moved : vt.unknown;

    if (note[0] == '\0' || getenv("SKIP"))
        return;
    print_error("%s: ", vt.moved[0] != '\0' ? "moves cells" : "not known");
    print_readable(note);
    print_error("\n");
    fail_at("a sequence that must not be sent");
}

static inline bool is_blank(const struct vt_cell *c)
{
    return (c->glyph == ' ' || c->glyph == 0) && c->combined[0] == 0 &&
           c->bg == CELL_DEFAULT && !(c->attributes & VT_REVERSE);
}

static inline bool shows(const struct vt_cell *got,
                         const struct belief_cell *want)
{
    if (want->kind == BELIEF_UNKNOWN)
        return true;
    if (want->kind == BELIEF_PICTURE)
        return vt_shows(got, &want->picture);
    if (is_blank(got) && is_blank(&want->text))
        return true;
    if (want->text.glyph == VT_TAIL) /* the left half has the attributes */
        return got->glyph == VT_TAIL;
    return memcmp(got, &want->text, sizeof *got) == 0;
}

static inline void fail_cell(int x, int y)
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

static inline void check_screen(void)
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
static inline bool is_quiet(void)
{
    return shared->taken_bytes == line.sent_bytes && shared->is_whole &&
           shared->cols == vt.cols && shared->rows == vt.rows;
}

static inline bool is_complete(void)
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
static inline void settle(bool all)
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

static inline void remember(const char *bytes)
{
    snprintf(line.last[line.key_count++ % KEYS_LAST], sizeof line.last[0], "%s",
             bytes);
}

static inline void press(const char *bytes, bool all)
{
    remember(bytes);
    send(bytes, strlen(bytes));
    sem_post(&shared->go);
    settle(all);
}

static inline void settle_all(void)
{
    sem_post(&shared->go);
    settle(true);
}

static inline void resize(int cols, int rows, bool all)
{
    char text[32];

    snprintf(text, sizeof text, "%dx%d", cols, rows);
    remember(text);
    set_size(cols, rows);
    sem_post(&shared->go);
    settle(all);
}

static inline void close_line(void)
{
    int status;

    send("\034", 1);
    do
        sem_post(&shared->go);
    while (listen());
    waitpid(line.pid, &status, 0);
    close(line.pty);
    munmap(shared, sizeof *shared);
    shared = NULL;
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 128 + SIGQUIT);
}

#endif
