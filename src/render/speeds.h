// SPDX-License-Identifier: MIT
/*
 * speeds.h - samples a second over the time of a render
 *
 * A few spans of equal length cover the whole time: when they are used up, each
 * two become one of double length.
 *
 * Units:     nanoseconds of rendering, samples of all pixels together
 * Ownership: none; a zeroed struct has seen nothing yet
 * Threads:   one at a time
 */
#ifndef GLIM_SPEEDS_H
#define GLIM_SPEEDS_H

#include <stdint.h>

/* Two a column of a small diagram. Even. */
#define SPEEDS_MAX 72

struct speeds {
    double samples[SPEEDS_MAX]; /* of each span */
    int count;                  /* the last one may have just begun */
    uint64_t span_ns;
    uint64_t time_ns; /* of the last look */
    uint64_t sample_count;
};

/* So many samples are there after so much time: what has come since the last
 * look belongs to the time since then, evenly. Begins anew where either is less
 * than before. */
void speeds_look(struct speeds *s, uint64_t time_ns, uint64_t sample_count);

/* Samples a second in span i below count. */
double speeds_at(const struct speeds *s, int i);

#endif
