// SPDX-License-Identifier: MIT
/*
 * tty_input.h - bytes from the terminal to keys, mouse reports and answers
 *
 * Escape sequences may arrive in pieces, and answers between keys. Unknown
 * sequences are dropped as a whole.
 *
 * Units:     terminal cells, from 1
 * Threads:   one thread at a time
 */
#ifndef GLIM_TTY_INPUT_H
#define GLIM_TTY_INPUT_H

#include <stdbool.h>
#include <stddef.h>

/* Keys that are not ASCII characters. Enter is '\r', Escape is 27. */
enum tty_key {
    TTY_KEY_UP = 256,
    TTY_KEY_DOWN,
    TTY_KEY_LEFT,
    TTY_KEY_RIGHT,
    TTY_KEY_PAGE_UP,
    TTY_KEY_PAGE_DOWN,
    TTY_KEY_HOME,
    TTY_KEY_END,
    TTY_KEY_INSERT,
    TTY_KEY_DELETE,
    TTY_KEY_F1,
    TTY_KEY_OTHER /* a key that glim does not use */
};

enum event_kind {
    EVENT_KEY,
    EVENT_PASTED, /* key: of a pasted text; 0: a mouse report in it */
    EVENT_MOUSE,
    EVENT_READY,        /* ESC[0n: the answer to FRAME_PACING_REQUEST */
    EVENT_ATTRIBUTES,   /* the answer to ESC[c, the last question; x is 1 with
                           sixel graphics */
    EVENT_SIXEL_COLORS, /* x: number of colours in a sixel image */
    EVENT_KITTY,        /* kitty's graphics are supported */
    EVENT_TRUE_COLOR,   /* 24-bit colours are supported */
    EVENT_BACKGROUND,   /* x: 1 if the terminal's background is light */
    EVENT_SYNC,         /* synchronized updates are supported */
    EVENT_CELL_SIZE,    /* x, y: size of a cell in pixels */
    EVENT_CURSOR,       /* x, y: position of the cursor */
    EVENT_NAME          /* name: of the terminal, with its version */
};

enum mouse_kind {
    MOUSE_PRESS,
    MOUSE_RELEASE,
    MOUSE_DRAG,
    MOUSE_WHEEL_UP,
    MOUSE_WHEEL_DOWN,
    MOUSE_OTHER
};

/* Bytes of the longest name of a terminal, with its final 0. */
#define TTY_NAME_BYTES 48

struct event {
    enum event_kind kind;
    int key; /* a byte, or enum tty_key */
    enum mouse_kind mouse;
    int button;       /* mouse button: 0 left, 2 right */
    bool is_modified; /* with Ctrl or Alt */
    int x, y;
    char name[TTY_NAME_BYTES]; /* printable ASCII without blanks */
};

/* Copies a name, cut where it is too long. Other characters become _. */
void tty_name(char name[TTY_NAME_BYTES], const char *from, size_t length);

#define TTY_INPUT_BYTES 4096

struct tty_input {
    unsigned char bytes[TTY_INPUT_BYTES];
    size_t length;
    bool is_pasting; /* within the marks of a pasted text */
};

/* Stores bytes and returns how many fit. There is always room after
 * tty_input_next() has returned false. */
size_t tty_input_feed(struct tty_input *in, const void *bytes, size_t count);

/* Takes the next event. Returns false if there is none or its sequence is
 * incomplete. nothing_follows tells that no byte has arrived for a while: then
 * a lone ESC is the Escape key, and an incomplete sequence is dropped. */
bool tty_input_next(struct tty_input *in, bool nothing_follows,
                    struct event *event);

/* Returns true if an incomplete sequence is waiting. */
static inline bool tty_input_is_partial(const struct tty_input *in)
{
    return in->length > 0;
}

#endif
