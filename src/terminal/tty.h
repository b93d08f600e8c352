// SPDX-License-Identifier: MIT
/*
 * tty.h - the terminal: opened, asked, written to, and given back whatever
 * happens
 *
 * curses enters and leaves the screen; what is on it is written with
 * tty_write(), text by curses_windows.h, the picture by screen.h. There is one
 * terminal, so there is one state, in tty.c.
 *
 * Units:     terminal cells
 * Ownership: texts stay the caller's
 * Threads:   main only; the handlers of faults run anywhere
 * Errors:    tty_open() says why there is no screen
 */
#ifndef GLIM_TTY_H
#define GLIM_TTY_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"
#include "terminal/palette.h"

struct tty_size {
    int cols, rows;
    double cell_aspect;                /* height over width; 0: not known */
    int cell_width_px, cell_height_px; /* likewise */
};

/* Takes over signals, enters the screen and asks the terminal what it can; its
 * answers come with the keys, the last of them EVENT_ATTRIBUTES. */
bool tty_open(struct error *err);

/* Gives the terminal back. is_gone: nobody is there any more, write nothing. */
void tty_close(bool is_gone);

/* SIGHUP and SIGTERM change nothing from now on, not after tty_close() either:
 * one of them has come, and what is left to do is done in peace. */
void tty_ignore_ends(void);

/* What is known of colours at once. */
enum palette tty_palette(bool *is_final);

/* True where characters beyond ASCII are drawn as such. *may_learn says that
 * the answer EVENT_CURSOR tells better: x is 2 then, else 3 or more. */
bool tty_is_utf8(bool *may_learn);

/* True where a character in the last column of the last row scrolls. */
bool tty_scrolls_at_end(void);

/* Also before tty_open(), if the system knows it. */
struct tty_size term_size(void);

/* Readable when a signal came. tty_signal() takes it, 0 if there is none. */
int tty_signal_fd(void);
int tty_signal(void);

/* Reads keys and answers that are there; 0 if none, -1 if the terminal is
 * gone. */
int tty_read(void *bytes, size_t size_bytes);

/* Blocks until all is written. False if the terminal is gone or a signal says
 * that it is time to go. */
bool tty_write(const char *bytes, size_t size_bytes);

/* Keys and mouse of other programs come back; the process stops until it is
 * continued, then the screen is empty. */
void tty_suspend(void);

/* After the process was continued by someone else: all modes anew, and the
 * screen is empty. */
void tty_resume(void);

/* Drops what was typed or answered and not read. */
void tty_forget_input(void);

/* Follows a new size, and empties the screen at the next windows_update(). */
void tty_relayout(void);

void tty_set_mouse(bool is_on);

/* Between them the terminal holds back what is written. For terminals that have
 * said that they can. */
#define TTY_SYNC_BEGIN "\033[?2026h"
#define TTY_SYNC_END   "\033[?2026l"
void tty_use_sync(void);
bool tty_has_sync(void);

#endif
