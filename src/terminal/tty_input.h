// SPDX-License-Identifier: MIT
/*
 * tty_input.h - bytes from the terminal to keys, mouse reports and answers
 *
 * Sequences may come in pieces, and answers between keys.
 *
 * Units:     terminal cells, from 1
 * Ownership: none
 * Threads:   one thread at a time
 * Errors:    none; what nobody understands is dropped whole
 */
#ifndef GLIM_TTY_INPUT_H
#define GLIM_TTY_INPUT_H

#include <stdbool.h>
#include <stddef.h>

/* Keys that are no ASCII characters. Enter is '\r', Escape 27. */
enum input_key {
    INPUT_UP = 256,
    INPUT_DOWN,
    INPUT_LEFT,
    INPUT_RIGHT,
    INPUT_PAGE_UP,
    INPUT_PAGE_DOWN,
    INPUT_HOME,
    INPUT_F1,
    INPUT_OTHER /* some key that has no use here */
};

enum event_kind {
    EVENT_KEY,
    EVENT_MOUSE,
    EVENT_READY,      /* ESC[0n: the answer to PACE_REQUEST */
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
    int key; /* a byte, or enum input_key */
    enum mouse_kind mouse;
    int button;       /* of the mouse: 0 is the left one, 2 the right one */
    bool is_modified; /* with Ctrl or Alt */
    int x, y;
};

#define INPUT_BYTES 4096

struct input {
    unsigned char bytes[INPUT_BYTES];
    size_t length;
};

/* Takes up to what fits; the number of bytes taken. Fits always after
 * input_next() has returned false. */
size_t input_feed(struct input *in, const void *bytes, size_t count);

/* The next event; false if there is none, perhaps because a sequence is not
 * complete. nothing_follows says that no byte has come for a while, so that a
 * lone ESC is the key and a half sequence is rubbish. */
bool input_next(struct input *in, bool nothing_follows, struct event *event);

/* True if the beginning of a sequence waits for the rest. */
static inline bool input_is_partial(const struct input *in)
{
    return in->length > 0;
}

#endif
