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

/* A pasted text whose end does not come is over after this time. */
#define PASTE_NS (2 * S_NS)

/* Returns false if no more events are wanted. */
static bool take_all(struct tty_events *e, bool nothing_follows,
                     tty_take_event *take, void *context)
{
    struct event event;

    while (tty_input_next(&e->input, nothing_follows, &event))
        if (!take(context, &event))
            return false;
    return true;
}

bool tty_events_read(struct tty_events *e, tty_take_event *take, void *context)
{
    unsigned char bytes[1024];
    int count;

    while ((count = tty_read(bytes, sizeof bytes)) > 0) {
        if (clock_ns() > e->byte_ns + PASTE_NS)
            e->input.is_pasting = false;
        e->byte_ns = clock_ns();
        tty_input_feed(&e->input, bytes, (size_t)count);
        if (!take_all(e, false, take, context))
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
