// SPDX-License-Identifier: MIT
/*
 * held_keys.h - keys that are held down
 *
 * Terminals report that a key was pressed, and again and again while it is
 * held, but not that it was let go. A key counts as held until no byte has come
 * for a while.
 *
 * Units:     nanoseconds of clock_ns(); seconds for what an axis was held
 * Threads:   one thread at a time
 */
#ifndef GLIM_HELD_KEYS_H
#define GLIM_HELD_KEYS_H

#include <stdbool.h>
#include <stdint.h>

enum held_keys_axis {
    HELD_KEYS_RIGHT,
    HELD_KEYS_UP,
    HELD_KEYS_FORWARD,
    HELD_KEYS_LOOK_RIGHT,
    HELD_KEYS_LOOK_UP,
    HELD_KEYS_WIDEN, /* the field of view */
    HELD_KEYS_OPEN,  /* the aperture */
    HELD_KEYS_AXES
};

/* Time between two steps: 60 a second. */
#define HELD_KEYS_STEP_NS 16666667u

/* A zeroed struct is at rest. */
struct held_keys {
    uint64_t from_ns[HELD_KEYS_AXES]; /* what is before has been taken */
    uint64_t until_ns[HELD_KEYS_AXES];
    int sign[HELD_KEYS_AXES];
};

/* A key for this axis came; sign is 1 or -1. */
void held_keys_press(struct held_keys *m, enum held_keys_axis axis, int sign,
                     uint64_t now_ns);

/* Takes the seconds, with sign, that each axis was held since the last call. A
 * key pressed just now counts as one step at once. False if nothing moved. */
bool held_keys_step(struct held_keys *m, uint64_t now_ns,
                    double seconds[HELD_KEYS_AXES]);

/* When to call held_keys_step() next; UINT64_MAX: at rest. */
uint64_t held_keys_next_ns(const struct held_keys *m);

void held_keys_stop(struct held_keys *m);

#endif
