// SPDX-License-Identifier: MIT
/*
 * decimal.h - decimal numbers in text, fast and the same in every locale
 *
 * Threads:   any
 * Errors:    a false result; the caller knows file and line
 */
#ifndef GLIM_DECIMAL_H
#define GLIM_DECIMAL_H

#include <stdbool.h>
#include <stdint.h>

/* Reads a decimal number at *p, before end, and moves *p behind it. Accepts
 * nan, inf, +1, .5, 5., 1e400 (gives inf). The value is the nearest double.
 * Returns false, with *p unmoved, if there is no number. */
bool decimal_parse(const char **p, const char *end, double *value);

/* Reads a whole number without a sign at *p, of base 10 or 16, and moves *p
 * behind it. Returns false if there is none, or it is above `most`. A NUL ends
 * the text. */
bool digits_parse(const char **p, int base, uint64_t most, uint64_t *value);

/* Size of a buffer for the text of any number. */
#define DECIMAL_TEXT_BYTES 32

/* Writes the shortest usual form that decimal_parse() reads back exactly; for a
 * value that is exactly a float, the form of the float. */
void decimal_format(char text[DECIMAL_TEXT_BYTES], double value);
void decimal_format_float(char text[DECIMAL_TEXT_BYTES], float value);

/* Returns the double nearest to the shortest text of the value as a float. A
 * value beyond the range of normal floats is returned unchanged. */
double decimal_shortened(double value);

#endif
