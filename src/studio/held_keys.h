// SPDX-License-Identifier: MIT
/*
 * held_keys.h - keys that are held down
 *
 * Terminals report presses and repeats of a key, but no releases. A key counts
 * as held until no repeat has come for 150 ms.
 *
 * Units:     nanoseconds of clock_ns(); held times in seconds
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
    HELD_KEYS_WIDEN, /* field of view */
    HELD_KEYS_OPEN,  /* aperture */
    HELD_KEYS_AXES
};

/* Time between two steps: 60 per second. */
#define HELD_KEYS_STEP_NS 16666667u

/* State of the keys of all axes. In a zeroed struct no key is held. */
struct held_keys {
    /* start of the held time that no step has returned yet */
    uint64_t from_ns[HELD_KEYS_AXES];
    uint64_t until_ns[HELD_KEYS_AXES];
    int sign[HELD_KEYS_AXES];
};

/* Reports a press or repeat of a key of an axis; sign is 1 or -1. */
void held_keys_press(struct held_keys *m, enum held_keys_axis axis, int sign,
                     uint64_t now_ns);

/* Computes for each axis the time in seconds that it was held since the last
 * call, with the sign of its key. A new press counts as one step at once.
 * Returns false if all are 0. */
bool held_keys_step(struct held_keys *m, uint64_t now_ns,
                    double seconds[HELD_KEYS_AXES]);

/* Returns the time of the next held_keys_step(), or UINT64_MAX if no key is
 * held. */
uint64_t held_keys_next_ns(const struct held_keys *m);

/* Releases all keys. */
void held_keys_stop(struct held_keys *m);

#endif
