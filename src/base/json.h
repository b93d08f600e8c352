// SPDX-License-Identifier: MIT
/*
 * json.h - strings of JSON
 *
 * Threads:   any
 * Errors:    those of the stream, which its owner has to check
 */
#ifndef GLIM_JSON_H
#define GLIM_JSON_H

#include <stdio.h>

/* Writes a JSON string with its quotes. Bytes that are not UTF-8, which JSON
 * cannot hold, become U+FFFD. Characters that print.h does not show are
 * escaped; they are never beyond U+FFFF. */
void json_write_string(FILE *to, const char *text);

#endif
