// SPDX-License-Identifier: MIT
/*
 * message.h - the line for the person in the place of the status line, and how
 * long it is shown
 *
 * Units:     nanoseconds of clock_ns()
 * Threads:   main only
 */
#ifndef GLIM_MESSAGE_H
#define GLIM_MESSAGE_H

#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

/* A zeroed struct is no message. */
struct message {
    char text[sizeof(struct error)];
    bool is_error; /* shown until a key is pressed */
    uint64_t said_ns;
    uint64_t until_ns; /* end of the display; 0: no message */
};

/* Shows a text for the time that it takes to read it, or longer. */
void message_set(struct message *m, bool is_long, const char *format,
                 va_list values) __attribute__((format(printf, 3, 0)));

/* Shows the text of an error until message_acknowledge(). */
void message_set_error(struct message *m, const char *text);

/* Shows an error only for the time that it takes to read it. Returns false if
 * there is no error. */
bool message_acknowledge(struct message *m);

#endif
