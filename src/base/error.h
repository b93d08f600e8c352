// SPDX-License-Identifier: MIT
/*
 * error.h - the message of a failure
 *
 * Threads:   any
 */
#ifndef GLIM_ERROR_H
#define GLIM_ERROR_H

#include <stdbool.h>

/* One finished line: the place, the text found there, and the expected one. */
struct error {
    char text[1024];
};

/* Formats the text as print_replace() shows it and returns false. Longer texts
 * are cut. */
bool fail(struct error *err, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Adds the text of another failure that came after the first one. */
void error_add(struct error *err, const struct error *more);

#endif
