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

/* Reads a decimal number at *p, before end; moves *p behind it. Accepts nan,
 * inf, +1, .5, 5., 1e400 (gives inf). The value is the nearest double. False:
 * no number there, *p unmoved. */
bool decimal_parse(const char **p, const char *end, double *value);

/* Size of the text of any number. */
#define DECIMAL_TEXT_BYTES 32

/* Writes the shortest usual form that decimal_parse() reads back exactly. It is
 * the form of a float if the number is one. */
void decimal_format(char text[DECIMAL_TEXT_BYTES], double value);
void decimal_format_float(char text[DECIMAL_TEXT_BYTES], float value);

/* Returns the number of the shortest text of the value as a float. Beyond the
 * range of normal floats it returns the value. */
double decimal_shortened(double value);

#endif
