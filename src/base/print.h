// SPDX-License-Identifier: MIT
/*
 * print.h - text for people, in which nothing moves a terminal's cursor
 *
 * Names of files and what stands in them are foreign text. A question mark
 * stands for what is not shown of it: control characters (also DEL and U+0080
 * to U+009F), ends of lines, bytes that are no character in the encoding of
 * LC_CTYPE, and marks that turn the direction of text (U+202A to U+202E, U+2066
 * to U+2069). Private characters stay: they look odd and do nothing.
 *
 * Units:     bytes; columns of the terminal
 * Threads:   any
 * Errors:    those of the stream, for its owner to ask for
 */
#ifndef GLIM_PRINT_H
#define GLIM_PRINT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Whether the character of this number in Unicode is shown. */
bool print_shows(uint32_t code);

/* A character of the text as it is shown. */
struct print_character {
    const char *bytes;
    size_t size_bytes;  /* of what is shown */
    size_t taken_bytes; /* of the text */
    int cols;
};

/* The first of a text that is not empty. */
struct print_character print_first(const char *text);

/* Makes the text one line that can be shown. It gets no longer. */
void print_replace(char *text);

/* Writes the text as it can be shown; print_line() with a line end. */
void print_text(FILE *to, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void print_line(FILE *to, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* The same for a text of several lines, in which a tab is a blank. */
void print_lines(FILE *to, const char *text);

#endif
