// SPDX-License-Identifier: MIT
#include "terminal/tty_events.h"

#include "base/clock.h"
#include "terminal/tty.h"

#define MS_NS UINT64_C(1000000)
#define S_NS  UINT64_C(1000000000)

/* An ESC byte is the Esc key if no byte follows within this time; it begins the
 * sequence of another key otherwise. */
#define ESCAPE_NS (50 * MS_NS)

/* The terminal's answers may come in pieces, so they have longer. */
#define ANSWER_NS S_NS

/* A pasted text whose end does not come is over after this time without a
 * character of it. Answers of the terminal are no characters. */
#define PASTE_NS (2 * S_NS)

/* Longest time for which input that keeps coming is taken: then a frame is
 * drawn. */
#define READ_NS (50 * MS_NS)

/* Returns false if no more events are wanted. */
static bool take_all(struct tty_events *e, bool nothing_follows,
                     tty_take_event *take, void *context)
{
    struct event event;
    bool was_pasting = e->input.is_pasting;

    while (tty_input_next(&e->input, nothing_follows, &event)) {
        if (event.kind == EVENT_PASTED)
            e->paste_ns = clock_ns();
        if (!take(context, &event))
            return false;
    }
    if (!was_pasting && e->input.is_pasting)
        e->paste_ns = clock_ns();
    return true;
}

bool tty_events_read(struct tty_events *e, tty_take_event *take, void *context)
{
    unsigned char bytes[1024];
    uint64_t until_ns = clock_ns() + READ_NS;
    int count;

    while ((count = tty_read(bytes, sizeof bytes)) > 0) {
        e->byte_ns = clock_ns();
        if (e->byte_ns > e->paste_ns + PASTE_NS)
            e->input.is_pasting = false;
        tty_input_feed(&e->input, bytes, (size_t)count);
        if (!take_all(e, false, take, context) || clock_ns() >= until_ns)
            return true;
    }
    return count == 0;
}

uint64_t tty_events_deadline_ns(const struct tty_events *e)
{
    if (!tty_input_is_partial(&e->input))
        return UINT64_MAX;
    return e->byte_ns + (e->input.length == 1 ? ESCAPE_NS : ANSWER_NS);
}

void tty_events_expire(struct tty_events *e, tty_take_event *take,
                       void *context)
{
    if (clock_ns() >= tty_events_deadline_ns(e))
        take_all(e, true, take, context);
}
