// SPDX-License-Identifier: MIT
/*
 * tty_input.h - bytes from the terminal to keys, mouse reports and answers
 *
 * Sequences may come in pieces, and answers between keys.
 *
 * Units:     terminal cells, from 1
 * Threads:   one thread at a time
 * Errors:    none; what nobody understands is dropped whole
 */
#ifndef GLIM_TTY_INPUT_H
#define GLIM_TTY_INPUT_H

#include <stdbool.h>
#include <stddef.h>

/* Keys that are no ASCII characters. Enter is '\r', Escape 27. */
enum tty_key {
    TTY_KEY_UP = 256,
    TTY_KEY_DOWN,
    TTY_KEY_LEFT,
    TTY_KEY_RIGHT,
    TTY_KEY_PAGE_UP,
    TTY_KEY_PAGE_DOWN,
    TTY_KEY_HOME,
    TTY_KEY_F1,
    TTY_KEY_OTHER /* some key that has no use here */
};

enum event_kind {
    EVENT_KEY,
    EVENT_MOUSE,
    EVENT_READY,      /* ESC[0n: the answer to FRAME_PACING_REQUEST */
    EVENT_ATTRIBUTES, /* the answer to ESC[c, the last of the questions; x: 1 if
                         the terminal has sixels */
    EVENT_SIXEL_COLORS, /* x: how many a sixel image may have */
    EVENT_KITTY,        /* it has kitty's graphics */
    EVENT_TRUE_COLOR,   /* the terminal keeps 24-bit colours */
    EVENT_SYNC,         /* it knows synchronized updates */
    EVENT_CELL_SIZE,    /* x, y: pixels of a cell */
    EVENT_CURSOR        /* x, y: where the cursor is */
};

enum mouse_kind {
    MOUSE_PRESS,
    MOUSE_RELEASE,
    MOUSE_DRAG,
    MOUSE_WHEEL_UP,
    MOUSE_WHEEL_DOWN,
    MOUSE_OTHER
};

struct event {
    enum event_kind kind;
    int key; /* a byte, or enum tty_key */
    enum mouse_kind mouse;
    int button;       /* of the mouse: 0 is the left one, 2 the right one */
    bool is_modified; /* with Ctrl or Alt */
    int x, y;
};

#define TTY_INPUT_BYTES 4096

struct tty_input {
    unsigned char bytes[TTY_INPUT_BYTES];
    size_t length;
};

/* Takes up to what fits; the number of bytes taken. Fits always after
 * tty_input_next() has returned false. */
size_t tty_input_feed(struct tty_input *in, const void *bytes, size_t count);

/* The next event; false if there is none, perhaps because a sequence is not
 * complete. nothing_follows says that no byte has come for a while, so that a
 * lone ESC is the key and a half sequence is rubbish. */
bool tty_input_next(struct tty_input *in, bool nothing_follows,
                    struct event *event);

/* True if the beginning of a sequence waits for the rest. */
static inline bool tty_input_is_partial(const struct tty_input *in)
{
    return in->length > 0;
}

#endif
