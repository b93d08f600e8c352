// SPDX-License-Identifier: MIT
#include "studio/message.h"

#include <stdio.h>
#include <string.h>

#include "base/clock.h"

/* Least time of a message, and per byte for 200 words per minute. LONG_NS is
 * the least time of long ones. */
#define MESSAGE_NS UINT64_C(4000000000)
#define BYTE_NS    UINT64_C(60000000)
#define LONG_NS    UINT64_C(10000000000)

/* Returns the time to read a text, at least `least_ns`. */
static uint64_t reading_ns(const char *text, uint64_t least_ns)
{
    uint64_t ns = strlen(text) * BYTE_NS;

    return ns > least_ns ? ns : least_ns;
}

void message_set(struct message *m, bool is_long, const char *format,
                 va_list values)
{
    vsnprintf(m->text, sizeof m->text, format, values);
    m->is_error = false;
    m->said_ns = clock_ns();
    m->until_ns =
        m->said_ns + reading_ns(m->text, is_long ? LONG_NS : MESSAGE_NS);
}

void message_set_error(struct message *m, const char *text)
{
    snprintf(m->text, sizeof m->text, "%s", text);
    m->is_error = true;
    m->said_ns = clock_ns();
    m->until_ns = UINT64_MAX;
}

bool message_acknowledge(struct message *m)
{
    if (!m->is_error)
        return false;
    m->is_error = false;
    m->until_ns = m->said_ns + reading_ns(m->text, MESSAGE_NS);
    return true;
}
