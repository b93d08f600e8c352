// SPDX-License-Identifier: MIT
/*
 * lettering.h - letters made of strokes, for diagrams
 *
 * A stroke is a polyline that follows the straight lines and curves of the
 * letter. Capitals are 120 units high, small letters 80; they go down to -40.
 *
 * Units:     as above; y is up, 0 at the line of writing
 * Threads:   any
 */
#ifndef GLIM_LETTERING_H
#define GLIM_LETTERING_H

#include <stdbool.h>

#define LETTER_HEIGHT 120
#define LETTER_GAP    28 /* between letters */

/* Most points of a stroke. */
#define STROKE_POINTS 128

struct stroke {
    int count;
    double x[STROKE_POINTS], y[STROKE_POINTS];
};

/* Returns the width of a letter without the gap. Characters that have no
 * strokes are as wide as a blank. */
int lettering_width(char letter);

/* Reads the next stroke of a letter. *at is NULL before the first call. Returns
 * false after the last stroke. */
bool lettering_stroke(char letter, const char **at, struct stroke *stroke);

#endif
