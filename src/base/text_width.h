// SPDX-License-Identifier: MIT
/*
 * text_width.h - text measured and cut to columns of the terminal
 *
 * A character of the encoding of LC_CTYPE takes none, one or two columns.
 * print.h says which characters are replaced.
 *
 * Units:     columns of the terminal; bytes where the name says so
 * Threads:   any
 * Errors:    none; text is cut, and never within a character
 */
#ifndef GLIM_TEXT_WIDTH_H
#define GLIM_TEXT_WIDTH_H

#include <stddef.h>

/* Returns the columns of the whole text. */
int text_width_of(const char *text);

/* Copies the beginning of the text that fits into so many columns and bytes,
 * with a '\0'. Returns its columns. */
int text_width_cut(char *to, size_t size_bytes, const char *text, int cols);

/* The same, padded with blanks to that many columns. */
void text_width_fit(char *to, size_t size_bytes, const char *text, int cols);

#endif
