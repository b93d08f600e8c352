// SPDX-License-Identifier: MIT
/*
 * print.h - messages for people, without terminal control characters, and text
 * measured and cut to columns of the terminal
 *
 * Units:     bytes; columns of the terminal
 * Threads:   any
 * Errors:    those of the stream, which its owner has to check; text that does
 * not fit is cut, never within a character
 */
#ifndef GLIM_PRINT_H
#define GLIM_PRINT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/error.h"

/* ---- characters of UTF-8 ---- */

/*
 * A character of the encoding of LC_CTYPE takes none, one or two columns.
 * print.h says which characters are replaced.
 */

/* ---- UTF-8 ---- */

/* Returns the length of the character at p, or 0 if it is invalid. The text
 * ends with a '\0', which is a character of length 1. */
size_t utf8_length(const char *p);

/* Returns the code point of the character of this length. */
uint32_t utf8_code(const char *p, size_t length);

/* ---- columns ---- */

/* Returns the width of the whole text in columns. */
int text_width_of(const char *text);

/* Copies the longest beginning of the text that fits into `cols` columns and
 * size_bytes bytes with a '\0'. Returns its width in columns. */
int text_width_cut(char *to, size_t size_bytes, const char *text, int cols);

/* Copies as text_width_cut() does, and pads with blanks to `cols` columns. */
void text_width_fit(char *to, size_t size_bytes, const char *text, int cols);

/* ---- messages ---- */

/*
 * Names and contents of files are foreign text. In messages a question mark
 * replaces their control characters (also DEL and U+0080 to U+009F), ends of
 * lines, bytes that are no character in the encoding of LC_CTYPE, and marks
 * that change the direction of text (U+202A to U+202E, U+2066 to U+2069).
 * Private characters are kept, as they do no harm.
 */

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
