// SPDX-License-Identifier: MIT
/*
 * held_keys.h - keys that are held down
 *
 * Terminals report that a key was pressed, and again and again while it is
 * held, but not that it was let go. A key counts as held until no byte has come
 * for a while.
 *
 * Units:     nanoseconds of clock_ns(); seconds for what an axis was held
 * Ownership: none
 * Threads:   one thread at a time
 * Errors:    none
 */
#ifndef GLIM_HELD_KEYS_H
#define GLIM_HELD_KEYS_H

#include <stdbool.h>
#include <stdint.h>

enum motion_axis {
    MOTION_RIGHT,
    MOTION_UP,
    MOTION_FORWARD,
    MOTION_LOOK_RIGHT,
    MOTION_LOOK_UP,
    MOTION_WIDEN, /* the field of view */
    MOTION_OPEN,  /* the aperture */
    MOTION_AXES
};

/* Time between two steps: 60 a second. */
#define MOTION_STEP_NS 16666667u

/* A zeroed struct is at rest. */
struct motion {
    uint64_t from_ns[MOTION_AXES]; /* what is before has been taken */
    uint64_t until_ns[MOTION_AXES];
    int sign[MOTION_AXES];
};

/* A key for this axis came; sign is 1 or -1. */
void motion_press(struct motion *m, enum motion_axis axis, int sign,
                  uint64_t now_ns);

/* Takes the seconds, with sign, that each axis was held since the last call. A
 * key pressed just now counts as one step at once. False if nothing moved. */
bool motion_step(struct motion *m, uint64_t now_ns,
                 double seconds[MOTION_AXES]);

/* When to call motion_step() next; UINT64_MAX: at rest. */
uint64_t motion_next_ns(const struct motion *m);

void motion_stop(struct motion *m);

#endif
