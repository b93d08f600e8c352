// SPDX-License-Identifier: MIT
/*
 * error_text.h - errors of pictures and their samples as text for people
 *
 * Threads:   any
 */
#ifndef GLIM_ERROR_TEXT_H
#define GLIM_ERROR_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "film/film_error.h"

#define ERROR_TEXT_BYTES   64
#define ERROR_FAULTS_BYTES 128

/* Formats a relative error with two digits: "0.98 %", "2.3 %", "120 %". */
void error_text_percent(char text[ERROR_TEXT_BYTES], double error);

/* Formats the error and its interval: "0.98 % (0.97 to 0.99 %)", followed by
 * ", mostly in few pixels" if it is unresolved, or "unknown". */
void error_text_interval(char text[ERROR_TEXT_BYTES],
                         const struct film_error *e);

/* Formats "noise 2.3 %", "noise 3 %, mostly in few pixels" or "noise unknown".
 */
void error_text_noise(char text[ERROR_TEXT_BYTES], const struct film_error *e);

/* Formats how many samples were not finite, or else how many were too bright
 * for their sums. Returns false if there are none. */
bool error_text_faults(char text[ERROR_FAULTS_BYTES], uint64_t non_finite,
                       uint64_t saturated);

/* Returns the error to aim at without a limit: the largest of 10 %, 5 %, 2 %,
 * 1 %, 0.5 % and so on that is at most half of this one. */
double error_text_target(double error);

#endif
