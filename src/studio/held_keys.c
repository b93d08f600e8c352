// SPDX-License-Identifier: MIT
#include "studio/held_keys.h"

/* Time after which a key without repeats counts as released: longer than the 33
 * to 40 ms between repeats, and too short to be felt as a delay of the stop. */
#define HELD_NS 150000000u

void held_keys_press(struct held_keys *m, enum held_keys_axis axis, int sign,
                     uint64_t now_ns)
{
    bool is_held = m->sign[axis] == sign && now_ns <= m->until_ns[axis];

    if (!is_held)
        m->from_ns[axis] = now_ns - HELD_KEYS_STEP_NS;
    m->sign[axis] = sign;
    m->until_ns[axis] = now_ns + HELD_NS - HELD_KEYS_STEP_NS;
}

bool held_keys_step(struct held_keys *m, uint64_t now_ns,
                    double seconds[HELD_KEYS_AXES])
{
    bool has_moved = false;

    for (int i = 0; i < HELD_KEYS_AXES; i++) {
        uint64_t to_ns = now_ns < m->until_ns[i] ? now_ns : m->until_ns[i];

        seconds[i] = 0;
        if (m->sign[i] == 0)
            continue;
        if (to_ns > m->from_ns[i]) {
            seconds[i] = m->sign[i] * (double)(to_ns - m->from_ns[i]) * 1e-9;
            m->from_ns[i] = to_ns;
            has_moved = true;
        }
        if (now_ns >= m->until_ns[i])
            m->sign[i] = 0;
    }
    return has_moved;
}

uint64_t held_keys_next_ns(const struct held_keys *m)
{
    uint64_t next_ns = UINT64_MAX;

    for (int i = 0; i < HELD_KEYS_AXES; i++) {
        uint64_t due_ns = m->from_ns[i] + HELD_KEYS_STEP_NS;

        if (m->sign[i] != 0 && due_ns < next_ns)
            next_ns = due_ns;
    }
    return next_ns;
}

void held_keys_stop(struct held_keys *m)
{
    *m = (struct held_keys){0};
}
