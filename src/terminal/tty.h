// SPDX-License-Identifier: MIT
/*
 * tty.h - opens, queries and restores the terminal
 *
 * The terminal is restored on every way out, faults included. curses enters
 * and leaves the screen; output goes through tty_write(), text through
 * curses_windows.h, the picture through screen.h. There is one terminal, so
 * the state is global, in tty.c.
 *
 * Units:     terminal cells
 * Ownership: texts stay the caller's
 * Threads:   main only; fault handlers run on any thread
 * Errors:    tty_open() tells why there is no screen
 */
#ifndef GLIM_TTY_H
#define GLIM_TTY_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"
#include "terminal/theme.h"

struct tty_size {
    int cols, rows;
    double cell_aspect;                /* height over width; 0 if unknown */
    int cell_width_px, cell_height_px; /* 0 if unknown */
};

/* Installs signal handlers, enters the screen and queries the terminal. Answers
 * arrive among the keys; the last is EVENT_ATTRIBUTES. */
bool tty_open(struct error *err);

/* Restores the terminal, but goes on taking signals. is_gone means that it has
 * hung up: nothing is written. */
void tty_leave(bool is_gone);

/* Returns true between tty_open() and tty_leave(). Any thread may call it. */
bool tty_is_open(void);

/* Restores the terminal if that is not done, and the signal handlers of
 * before. */
void tty_close(bool is_gone);

/* Ignores SIGHUP and SIGTERM from now on, after tty_close() too. Called when
 * one of them has arrived, so that the shutdown can complete. */
void tty_ignore_termination(void);

/* Returns the palette that the environment suggests. */
enum palette tty_palette(bool *is_final);

/* Returns true if characters beyond ASCII are shown. *may_learn is true if the
 * answer EVENT_CURSOR is more reliable: its x is 2 if they are, otherwise 3 or
 * more. */
bool tty_is_utf8(bool *may_learn);

/* True inside tmux. */
bool tty_is_in_tmux(void);

/* Asks the terminal outside tmux, if there is one, for kitty's images. tmux
 * loses what it should pass on while it draws a window anew, so ask again
 * later. */
void tty_ask_through_tmux(void);

/* Returns true if a character in the last column of the last row scrolls the
 * screen. */
bool tty_scrolls_at_end(void);

/* Returns the terminal's size. Works before tty_open() if the system knows
 * it. */
struct tty_size term_size(void);

/* Returns a descriptor that is readable when a signal has arrived. tty_signal()
 * returns and removes a signal, 0 if there is none. */
int tty_signal_fd(void);
int tty_signal(void);

/* Reads available keys and answers. Returns the number of bytes, 0 if there are
 * none, -1 if the terminal is gone. */
int tty_read(void *bytes, size_t size_bytes);

/* Returns true if tty_read() or tty_signal() has something to return. Any
 * thread may call it. */
bool tty_has_input(void);

/* Writes all bytes; blocks. Returns false if the terminal is gone or a signal
 * asks the program to end. */
bool tty_write(const char *bytes, size_t size_bytes);

/* Restores the terminal and stops the process until it is continued, then
 * resumes. */
void tty_suspend(void);

/* Sets all modes again after another process has continued this one. The next
 * windows_update() clears the screen. */
void tty_resume(void);

/* Discards input that was not read. */
void tty_flush_input(void);

/* Applies a new size, at most 2000x1000 characters, and resets the windows:
 * windows_reset(). */
bool tty_relayout(bool must_clear);

void tty_set_mouse(bool is_on);

/* Control sequences of synchronized updates: the terminal delays output between
 * them. tty_use_sync() enables them for terminals that reported support. */
#define TTY_SYNC_BEGIN "\033[?2026h"
#define TTY_SYNC_END   "\033[?2026l"
void tty_use_sync(void);
bool tty_has_sync(void);

#endif
