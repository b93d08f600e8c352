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

/* Enough for every decimal_format(). */
#define DECIMAL_TEXT_BYTES 32

/* The shortest of the usual forms that decimal_parse() reads back exactly; that
 * of a float if rounding gives the same float. */
void decimal_format(char text[DECIMAL_TEXT_BYTES], double value);
void decimal_format_float(char text[DECIMAL_TEXT_BYTES], float value);

/* The number that the shortest text of its float stands for. Beyond the range
 * of normal floats the number itself. */
double decimal_shortened(double value);

#endif
