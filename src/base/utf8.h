// SPDX-License-Identifier: MIT
/*
 * utf8.h - characters of UTF-8 text, the same in every locale
 *
 * Units:     bytes
 * Threads:   any
 */
#ifndef GLIM_UTF8_H
#define GLIM_UTF8_H

#include <stddef.h>
#include <stdint.h>

/* Returns the length of the character at p, or 0 if it is invalid. The text
 * ends with a '\0', which is a character of length 1. */
size_t utf8_length(const char *p);

/* Returns the code point of the character of this length. */
uint32_t utf8_code(const char *p, size_t length);

#endif
