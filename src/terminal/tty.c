// SPDX-License-Identifier: MIT
#include "terminal/tty.h"

#include <curses.h>
#include <errno.h>
#include <fcntl.h>
#include <langinfo.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <term.h>
#include <termios.h>
#include <unistd.h>

#include "base/min_max.h"
#include "base/stop.h"
#include "terminal/curses_windows.h"
#include "terminal/kitty.h"
#include "terminal/xmalloc.h"

/* Mouse reports of drags and the wheel, with coordinates of any size (SGR). */
#define MOUSE_ON  "\033[?1002h\033[?1006h"
#define MOUSE_OFF "\033[?1002l\033[?1006l"

/* Largest window that is used: the characters of a wall of screens. Curses
 * takes 100 bytes for each cell, and counts cells in 16 bits with a sign. */
#define COLS_MAX 2000
#define ROWS_MAX 1000

/* Marks of pasted text around it. */
#define PASTE_ON  "\033[?2004h"
#define PASTE_OFF "\033[?2004l"

/* Queries: synchronized updates, size of a cell, status, device attributes. */
#define QUESTIONS "\033[?2026$p\033[16t\033[5n\033[c"

/* Sets a 24-bit colour and asks for the colour that is set. */
#define COLOR_QUESTION "\033[48;2;1;2;3m\033P$qm\033\\\033[m"

/* Asks for the number of colours in a sixel image (XTSMGRAPHICS of xterm). */
#define SIXEL_QUESTION "\033[?1;1;0S"

/* Asks for the terminal's name and version (XTVERSION of xterm). */
#define NAME_QUESTION "\033[>q"

/* Asks for the colour of the background. */
#define BACKGROUND_QUESTION "\033]11;?\033\\"

/* Draws a half block in the corner and asks for the cursor position. */
#define GLYPH_QUESTION "\033[H\xe2\x96\x80\033[6n"

/* Resets every mode that glim may set, for fault handlers. Terminals skip
 * sequences that they do not know. */
static const char restore_text[] =
    TTY_SYNC_END MOUSE_OFF PASTE_OFF "\033[m\033[?25h\033[?1l\033>\033[?1049l";

static const int stop_signals[] = {SIGTERM, SIGHUP, SIGINT, SIGQUIT};
static const int other_signals[] = {SIGTSTP, SIGCONT, SIGWINCH};
static const int fault_signals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static struct {
    int signal_pipe[2];
    struct termios before;
    SCREEN *screen;
    bool has_mouse;
    bool has_sync;
    bool may_ask_colors; /* the terminal ignores questions that it does not
                            understand */
    struct sigaction old_stop[COUNT(stop_signals)];
    struct sigaction old_other[COUNT(other_signals)];
    struct sigaction old_fault[COUNT(fault_signals)];
} term;

/* read by fault handlers */
static volatile sig_atomic_t is_open;
static volatile sig_atomic_t must_stop;

static void on_signal(int number)
{
    int saved_errno = errno;
    unsigned char byte = (unsigned char)number;

    for (size_t i = 0; i < COUNT(stop_signals); i++) {
        if (number != stop_signals[i])
            continue;
        must_stop = 1;
        /* shells send SIGHUP again and again */
        stop_request(128 + number, number != SIGHUP);
    }
    if (write(term.signal_pipe[1], &byte, 1) < 0) {
        /* a full pipe wakes the loop as well */
    }
    errno = saved_errno;
}

/* Restores the terminal; async-signal-safe. A terminal that takes no output
 * loses what it has not taken, and nothing here waits for it. */
static void restore_now(void)
{
    struct pollfd out = {.fd = STDOUT_FILENO, .events = POLLOUT};
    int flags = fcntl(STDOUT_FILENO, F_GETFL);

    if (!is_open)
        return;
    is_open = 0;
    if (poll(&out, 1, 0) == 0)
        tcflush(STDOUT_FILENO, TCOFLUSH);
    fcntl(STDOUT_FILENO, F_SETFL, flags | O_NONBLOCK);
    if (write(STDOUT_FILENO, restore_text, sizeof restore_text - 1) < 0) {
        /* errors cannot be reported here */
    }
    fcntl(STDOUT_FILENO, F_SETFL, flags);
    tcsetattr(STDIN_FILENO, TCSANOW, &term.before);
}

static void on_fault(int number)
{
    restore_now();
    for (size_t i = 0; i < COUNT(fault_signals); i++) {
        if (fault_signals[i] == number)
            sigaction(number, &term.old_fault[i], NULL);
    }
    raise(number);
}

static void take_signals(void)
{
    struct sigaction action = {.sa_handler = on_signal};
    struct sigaction fault = {.sa_handler = on_fault, .sa_flags = SA_NODEFER};

    sigemptyset(&action.sa_mask);
    sigemptyset(&fault.sa_mask);
    for (size_t i = 0; i < COUNT(stop_signals); i++)
        sigaction(stop_signals[i], &action, &term.old_stop[i]);
    for (size_t i = 0; i < COUNT(other_signals); i++)
        sigaction(other_signals[i], &action, &term.old_other[i]);
    for (size_t i = 0; i < COUNT(fault_signals); i++)
        sigaction(fault_signals[i], &fault, &term.old_fault[i]);
}

void tty_ignore_termination(void)
{
    for (size_t i = 0; i < COUNT(stop_signals); i++) {
        if (stop_signals[i] == SIGHUP || stop_signals[i] == SIGTERM)
            term.old_stop[i] = (struct sigaction){.sa_handler = SIG_IGN};
    }
}

static void give_signals_back(void)
{
    for (size_t i = 0; i < COUNT(stop_signals); i++)
        sigaction(stop_signals[i], &term.old_stop[i], NULL);
    for (size_t i = 0; i < COUNT(other_signals); i++)
        sigaction(other_signals[i], &term.old_other[i], NULL);
    for (size_t i = 0; i < COUNT(fault_signals); i++)
        sigaction(fault_signals[i], &term.old_fault[i], NULL);
}

/* Returns the terminal name for curses. A name that terminfo lacks, as is
 * common on remote machines, is replaced by a similar common one. Returns NULL
 * with an error for terminals that cannot show a picture. */
static const char *terminal_name(struct error *err)
{
    static const char *const others[] = {"xterm-256color", "xterm", "vt100",
                                         "ansi"};
    const char *own = getenv("TERM");
    const char *name = NULL;
    int found;

    if (own && setupterm(own, STDOUT_FILENO, &found) == OK)
        name = own;
    for (size_t i = 0; !name && i < COUNT(others); i++) {
        if (setupterm(others[i], STDOUT_FILENO, &found) == OK)
            name = others[i];
    }
    if (!name) {
        fail(err,
             "TERM=%s: found no description of this terminal or of a common "
             "one (-b renders to a file)",
             own ? own : "");
        return NULL;
    }
    const char *jump = tigetstr("cup");
    bool is_ansi = jump && jump != (char *)-1 && strncmp(jump, "\033[", 2) == 0;
    del_curterm(cur_term);
    if (is_ansi)
        return name;
    fail(err,
         "TERM=%s: found a terminal that cannot show a picture, expected one "
         "like xterm (-b renders to a file)",
         own);
    return NULL;
}

static bool begins_with(const char *text, const char *with)
{
    return text && strncmp(text, with, strlen(with)) == 0;
}

/* Returns true for terminals that print sequences that they do not
 * understand. */
static bool is_simple(const char *name)
{
    static const char *const simple[] = {"linux",  "vt1",   "vt2",  "vt3",
                                         "vt4",    "vt5",   "ansi", "cons",
                                         "screen", "pcansi"};

    for (size_t i = 0; i < COUNT(simple); i++) {
        if (begins_with(name, simple[i]))
            return true;
    }
    return false;
}

bool tty_is_in_tmux(void)
{
    const char *tmux = getenv("TMUX");

    return tmux && tmux[0];
}

/* Returns true inside screen, which forwards KITTY_QUESTION blindly. */
static bool is_in_screen(void)
{
    const char *sty = getenv("STY");

    return sty && sty[0];
}

/* Writes to the terminal. If it ends early, a signal that stops the program
 * cuts the text where a full terminal would make it wait. */
static bool write_bytes(const char *bytes, size_t size_bytes, bool ends_early)
{
    while (size_bytes > 0) {
        ssize_t count = write(STDOUT_FILENO, bytes, size_bytes);

        if (count >= 0) {
            bytes += count;
            size_bytes -= (size_t)count;
        } else if (errno == EAGAIN) {
            struct pollfd out = {.fd = STDOUT_FILENO, .events = POLLOUT};

            poll(&out, 1, 100);
        } else if (errno != EINTR) {
            return false;
        }
        if (ends_early && must_stop && size_bytes > 0)
            return false;
    }
    return true;
}

/* Returns the size that the system reports, at most COLS_MAX and ROWS_MAX, or
 * false if it reports none. */
static bool window_size(struct winsize *w, int *cols, int *rows)
{
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, w) != 0 || w->ws_col == 0 ||
        w->ws_row == 0)
        return false;
    *cols = int_min(w->ws_col, COLS_MAX);
    *rows = int_min(w->ws_row, ROWS_MAX);
    return true;
}

/* Opens the screen of curses. It begins with the size of the terminal's
 * description where that of the window is too large for curses. */
static SCREEN *open_screen(const char *name)
{
    struct winsize w;
    int cols, rows;

    if (window_size(&w, &cols, &rows) && (cols < w.ws_col || rows < w.ws_row))
        use_env(FALSE);
    return newterm(name, stdout, stdin);
}

static void set_modes(void)
{
    raw();
    noecho();
    nonl();
    curs_set(0);
    typeahead(-1); /* otherwise curses stops drawing when keys wait */
    leaveok(stdscr, FALSE);
}

static void ask(void)
{
    bool may_learn;
    char text[32];
    int length;

    tty_is_utf8(&may_learn);
    if (may_learn)
        tty_write(GLYPH_QUESTION, sizeof GLYPH_QUESTION - 1);
    if (term.may_ask_colors) {
        tty_write(COLOR_QUESTION, sizeof COLOR_QUESTION - 1);
        tty_write(SIXEL_QUESTION, sizeof SIXEL_QUESTION - 1);
        tty_write(NAME_QUESTION, sizeof NAME_QUESTION - 1);
    }
    if (term.may_ask_colors && !tty_is_in_tmux() && !is_in_screen()) {
        tty_write(KITTY_QUESTION, sizeof KITTY_QUESTION - 1);
        tty_write(BACKGROUND_QUESTION, sizeof BACKGROUND_QUESTION - 1);
    }
    tty_write(QUESTIONS, sizeof QUESTIONS - 1);
    /* clears whatever a simple terminal printed of the questions */
    length = snprintf(text, sizeof text, "\033[2J\033[%d;1H", LINES);
    tty_write(text, (size_t)length);
}

void tty_ask_through_tmux(void)
{
    if (term.may_ask_colors && tty_is_in_tmux())
        tty_write(KITTY_TMUX_QUESTION, sizeof KITTY_TMUX_QUESTION - 1);
}

/* Releases everything that tty_open() takes before the screen. */
static void give_back(void)
{
    xmalloc_set_hook(NULL);
    give_signals_back();
    close(term.signal_pipe[0]);
    close(term.signal_pipe[1]);
}

bool tty_open(struct error *err)
{
    const char *name;

    if (!isatty(STDIN_FILENO) || !isatty(STDOUT_FILENO) ||
        tcgetattr(STDIN_FILENO, &term.before) != 0)
        return fail(err, "standard input and output: found no terminal, "
                         "expected one or -b to render to a file");
    name = terminal_name(err);
    if (!name || !stop_begin(err))
        return false;
    if (pipe2(term.signal_pipe, O_CLOEXEC | O_NONBLOCK) != 0)
        return fail(err, "cannot open a pipe for signals: %s", strerror(errno));
    must_stop = 0;
    take_signals();
    xmalloc_set_hook(restore_now);
    stop_at_end(restore_now);
    is_open = 1;
    term.screen = open_screen(name);
    if (!term.screen) {
        is_open = 0;
        give_back();
        return fail(err, "TERM=%s: no screen", name);
    }
    set_modes();
    term.may_ask_colors = !is_simple(getenv("TERM"));
    tty_ask_through_tmux();
    refresh(); /* enters the screen */
    tty_relayout(true);
    windows_update();
    ask();
    tty_set_mouse(true);
    tty_write(PASTE_ON, sizeof PASTE_ON - 1);
    return true;
}

/* Discards pending output if the terminal accepts none: closing it would
 * block. */
static void drop_stuck_output(void)
{
    struct pollfd out = {.fd = STDOUT_FILENO, .events = POLLOUT};

    if (poll(&out, 1, 200) == 0)
        tcflush(STDOUT_FILENO, TCOFLUSH);
}

/* Leaves the screen. A terminal without an alternate screen is cleared, so that
 * the picture does not stay above the shell's output. */
static void leave_screen(void)
{
    if (!exit_ca_mode) {
        erase();
        clearok(curscr, TRUE);
        refresh();
    }
    endwin();
}

static void write_restoring(void)
{
    static const char text[] = TTY_SYNC_END MOUSE_OFF PASTE_OFF "\033[m";
    size_t skip = term.has_sync ? 0 : sizeof TTY_SYNC_END - 1;

    write_bytes(text + skip, sizeof text - 1 - skip, false);
}

void tty_leave(bool is_gone)
{
    if (!is_open)
        return;
    if (!is_gone) {
        drop_stuck_output();
        write_restoring();
        leave_screen();
    }
    is_open = 0;
    if (!is_gone)
        tcsetattr(STDIN_FILENO, TCSANOW, &term.before);
}

bool tty_is_open(void)
{
    return is_open != 0;
}

void tty_close(bool is_gone)
{
    if (!term.screen)
        return;
    tty_leave(is_gone);
    windows_free();
    delscreen(term.screen);
    term.screen = NULL;
    give_back();
}

enum palette tty_palette(bool *is_final)
{
    struct palette_facts facts = {
        .no_color = getenv("NO_COLOR"),
        .colorterm = getenv("COLORTERM"),
        .term = getenv("TERM"),
        .sty = getenv("STY"),
        .tmux = getenv("TMUX"),
        .colors = tigetnum("colors"),
        .has_rgb =
            tigetflag("RGB") > 0 || tigetnum("RGB") > 0 || tigetflag("Tc") > 0,
    };

    return palette_guess(&facts, is_final);
}

bool tty_is_utf8(bool *may_learn)
{
    /* tmux accepts every character and shows underscores if the outer terminal
     * lacks it, so its answer does not tell */
    *may_learn = !tty_is_in_tmux() && !is_simple(getenv("TERM"));
    return strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
}

bool tty_scrolls_at_end(void)
{
    return tigetflag("am") > 0 && tigetflag("xenl") <= 0;
}

struct tty_size term_size(void)
{
    struct winsize w;
    struct tty_size size = {.cols = COLS, .rows = LINES};
    int cols, rows;

    if (!window_size(&w, &cols, &rows))
        return size;
    if (w.ws_xpixel >= w.ws_col && w.ws_ypixel >= w.ws_row) {
        size.cell_aspect =
            ((double)w.ws_ypixel / w.ws_row) / ((double)w.ws_xpixel / w.ws_col);
        size.cell_width_px = w.ws_xpixel / w.ws_col;
        size.cell_height_px = w.ws_ypixel / w.ws_row;
    }
    if (COLS == 0 || LINES == 0) {
        size.cols = cols;
        size.rows = rows;
    }
    return size;
}

int tty_signal_fd(void)
{
    return term.signal_pipe[0];
}

int tty_signal(void)
{
    unsigned char number;

    return read(term.signal_pipe[0], &number, 1) == 1 ? number : 0;
}

int tty_read(void *bytes, size_t size_bytes)
{
    struct pollfd in = {.fd = STDIN_FILENO, .events = POLLIN};

    if (poll(&in, 1, 0) <= 0)
        return 0;
    if (!(in.revents & POLLIN))
        return -1;
    ssize_t count = read(STDIN_FILENO, bytes, size_bytes);
    if (count < 0)
        return errno == EINTR || errno == EAGAIN ? 0 : -1;
    return count == 0 ? -1 : (int)count;
}

bool tty_has_input(void)
{
    struct pollfd in[] = {{.fd = STDIN_FILENO, .events = POLLIN},
                          {.fd = term.signal_pipe[0], .events = POLLIN}};

    return poll(in, 2, 0) > 0;
}

bool tty_write(const char *bytes, size_t size_bytes)
{
    return write_bytes(bytes, size_bytes, true);
}

void tty_suspend(void)
{
    struct sigaction stop = {.sa_handler = SIG_DFL};
    struct sigaction own;

    write_restoring();
    leave_screen();
    is_open = 0;
    sigemptyset(&stop.sa_mask);
    sigaction(SIGTSTP, &stop, &own);
    raise(SIGTSTP); /* returns when the process is continued */
    sigaction(SIGTSTP, &own, NULL);
    tty_resume();
}

void tty_resume(void)
{
    is_open = 1;
    reset_prog_mode();
    erase();
    refresh();
    curs_set(0);
    tty_relayout(true);
    tty_set_mouse(term.has_mouse);
    tty_write(PASTE_ON, sizeof PASTE_ON - 1);
}

void tty_flush_input(void)
{
    tcflush(STDIN_FILENO, TCIFLUSH);
}

bool tty_relayout(bool must_clear)
{
    struct winsize w;
    int cols, rows;

    if (window_size(&w, &cols, &rows))
        resizeterm(rows, cols);
    return windows_reset(must_clear);
}

void tty_set_mouse(bool is_on)
{
    term.has_mouse = is_on;
    if (is_on)
        tty_write(MOUSE_ON, sizeof MOUSE_ON - 1);
    else
        tty_write(MOUSE_OFF, sizeof MOUSE_OFF - 1);
}

void tty_use_sync(void)
{
    term.has_sync = true;
}

bool tty_has_sync(void)
{
    return term.has_sync;
}
