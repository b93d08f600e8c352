// SPDX-License-Identifier: MIT
/*
 * text_width.h - text that must fit into columns of the terminal
 *
 * Names in files are foreign text: characters of none, one or two columns, in
 * the encoding of LC_CTYPE, of which print.h says what is shown.
 *
 * Units:     columns of the terminal; bytes where the name says so
 * Threads:   any
 * Errors:    none; text is cut, and never within a character
 */
#ifndef GLIM_TEXT_WIDTH_H
#define GLIM_TEXT_WIDTH_H

#include <stddef.h>

/* How many the whole text takes. */
int text_width_of(const char *text);

/* The beginning of the text that fits into so many columns and bytes, with its
 * '\0'. Returns the columns that it takes. */
int text_width_cut(char *to, size_t size_bytes, const char *text, int cols);

/* The same, filled up with blanks to that many columns. */
void text_width_fit(char *to, size_t size_bytes, const char *text, int cols);

#endif
