// SPDX-License-Identifier: MIT
/*
 * Keys, mouse reports and answers of terminals. The events are the same whether
 * the bytes arrive at once or in pieces, whose size is the first byte.
 */
#include "fuzz.h"
#include "terminal/tty_input.h"

/* Longer sequences are dropped at the end of a piece, so pieces change the
 * events there. */
#define COMPARED_BYTES 500

#define EVENTS_MAX (2 * TTY_INPUT_BYTES)

struct events {
    struct event items[EVENTS_MAX];
    size_t count;
};

static void take(struct tty_input *in, int nothing_follows, struct events *to)
{
    struct event event;

    while (tty_input_next(in, nothing_follows, &event)) {
        require(event.kind >= EVENT_KEY && event.kind <= EVENT_CURSOR,
                "a kind of event");
        require(event.kind != EVENT_KEY ||
                    (event.key >= 0 && event.key <= TTY_KEY_OTHER),
                "a key");
        require(event.x >= 0 && event.y >= 0, "a place");
        if (to->count < EVENTS_MAX)
            to->items[to->count++] = event;
    }
}

static void feed(const uint8_t *data, size_t size, size_t piece,
                 struct events *to)
{
    static struct tty_input in;

    in.length = 0;
    to->count = 0;
    for (size_t i = 0; i < size; i += piece) {
        size_t n = size - i < piece ? size - i : piece;

        require(tty_input_feed(&in, data + i, n) == n, "room for a piece");
        take(&in, 0, to);
    }
    take(&in, 1, to);
    require(!tty_input_is_partial(&in), "bytes are left");
}

static int is_same(const struct event *a, const struct event *b)
{
    return a->kind == b->kind && a->key == b->key && a->mouse == b->mouse &&
           a->button == b->button && a->is_modified == b->is_modified &&
           a->x == b->x && a->y == b->y;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct events whole, pieces;

    if (size < 1)
        return 0;
    feed(data + 1, size - 1, COMPARED_BYTES, &whole);
    feed(data + 1, size - 1, 1 + data[0] % 64, &pieces);
    if (size > COMPARED_BYTES)
        return 0;
    require(whole.count == pieces.count, "as many events");
    for (size_t i = 0; i < whole.count; i++)
        require(is_same(&whole.items[i], &pieces.items[i]), "the same event");
    return 0;
}
