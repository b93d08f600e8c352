// SPDX-License-Identifier: MIT
/*
 * text_width.h - characters of UTF-8, the same in every locale, and text
 * measured and cut to columns of the terminal
 *
 * A character of the encoding of LC_CTYPE takes none, one or two columns.
 * print.h says which characters are replaced.
 *
 * Units:     bytes; columns of the terminal
 * Threads:   any
 * Errors:    text that does not fit is cut, never within a character
 */
#ifndef GLIM_TEXT_WIDTH_H
#define GLIM_TEXT_WIDTH_H

#include <stddef.h>
#include <stdint.h>

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

#endif
