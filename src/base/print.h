// SPDX-License-Identifier: MIT
/*
 * print.h - messages for people, without terminal control characters
 *
 * Names and contents of files are foreign text. In messages a question mark
 * replaces their control characters (also DEL and U+0080 to U+009F), ends of
 * lines, bytes that are no character in the encoding of LC_CTYPE, and marks
 * that change the direction of text (U+202A to U+202E, U+2066 to U+2069).
 * Private characters are kept, as they do no harm.
 *
 * Units:     bytes; columns of the terminal
 * Threads:   any
 * Errors:    those of the stream, which its owner has to check
 */
#ifndef GLIM_PRINT_H
#define GLIM_PRINT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/error.h"

/* Returns true if the character with this code point is shown as it is. */
bool print_shows(uint32_t code);

/* First character of a text in the form in which it is shown. */
struct print_character {
    const char *bytes;
    size_t size_bytes;  /* bytes to show */
    size_t taken_bytes; /* bytes of the text that the character replaces */
    int cols;
};

/* Returns the first character of a text, which must not be empty. */
struct print_character print_first(const char *text);

/* Replaces unsafe characters and line ends in place. The text does not grow. */
void print_replace(char *text);

/* Writes the text with unsafe characters replaced. print_line() adds a line
 * end. */
void print_text(FILE *to, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void print_line(FILE *to, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Writes a text of several lines with unsafe characters replaced. A tab becomes
 * a blank. */
void print_lines(FILE *to, const char *text);

/* Writes what the stream of standard output still holds. Returns false if that
 * or an earlier write failed, such as on a full disk. */
bool print_finish(FILE *to, struct error *err);

/* Returns the ending of a noun after its number: "s", or "" after 1. */
const char *print_plural(uint64_t count);

#endif
