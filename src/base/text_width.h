// SPDX-License-Identifier: MIT
/*
 * text_width.h - text measured and cut to columns of the terminal
 *
 * A character of the encoding of LC_CTYPE takes none, one or two columns.
 * print.h says which characters are replaced.
 *
 * Units:     columns of the terminal; bytes where the name says so
 * Threads:   any
 * Errors:    text that does not fit is cut, never within a character
 */
#ifndef GLIM_TEXT_WIDTH_H
#define GLIM_TEXT_WIDTH_H

#include <stddef.h>

/* Returns the width of the whole text in columns. */
int text_width_of(const char *text);

/* Copies the longest beginning of the text that fits into `cols` columns and
 * size_bytes bytes with a '\0'. Returns its width in columns. */
int text_width_cut(char *to, size_t size_bytes, const char *text, int cols);

/* Copies as text_width_cut() does, and pads with blanks to `cols` columns. */
void text_width_fit(char *to, size_t size_bytes, const char *text, int cols);

#endif
