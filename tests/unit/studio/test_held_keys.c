// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <stdbool.h>

#include "studio/camera/camera_input.h"

#define MS UINT64_C(1000000)

/* Makes steps whenever one is due, like the event loop, until `to`. Returns the
 * time held. */
static double run(struct held_keys *m, uint64_t from_ns, uint64_t to_ns,
                  enum held_keys_axis axis)
{
    double sum = 0;
    double seconds[HELD_KEYS_AXES];

    for (uint64_t now = from_ns; now < to_ns; now += MS / 4) {
        if (now >= held_keys_next_ns(m) && held_keys_step(m, now, seconds))
            sum += seconds[axis];
    }
    return sum;
}

static void a_tap_moves_at_once_and_then_stops(void **state)
{
    struct held_keys m = {0};
    double seconds[HELD_KEYS_AXES];

    (void)state;
    assert_true(held_keys_next_ns(&m) == UINT64_MAX);
    held_keys_press(&m, HELD_KEYS_FORWARD, -1, 1000 * MS);
    assert_true(held_keys_next_ns(&m) <= 1000 * MS);
    assert_true(held_keys_step(&m, 1000 * MS, seconds));
    check_close(seconds[HELD_KEYS_FORWARD], -1.0 / 60, 1e-6);
    assert_true(seconds[HELD_KEYS_RIGHT] == 0);
    check_close(run(&m, 1000 * MS, 2000 * MS, HELD_KEYS_FORWARD),
                -0.150 + 1.0 / 60, 1e-6);
    assert_true(held_keys_next_ns(&m) == UINT64_MAX);
}

/* With a repeat every 33 ms the motion is even as long as the key is held. */
static void held_keys_move_evenly(void **state)
{
    struct held_keys m = {0};
    double sum = 0;

    (void)state;
    for (int i = 0; i < 30; i++) {
        uint64_t now = (1000 + 33 * (uint64_t)i) * MS;

        held_keys_press(&m, HELD_KEYS_RIGHT, 1, now);
        sum += run(&m, now, now + 33 * MS, HELD_KEYS_RIGHT);
    }
    sum += run(&m, 1990 * MS, 3000 * MS, HELD_KEYS_RIGHT);
    check_close(sum, 29 * 0.033 + 0.150, 1e-6);
}

static void several_keys_are_held_together(void **state)
{
    struct held_keys m = {0};
    double seconds[HELD_KEYS_AXES];

    (void)state;
    held_keys_press(&m, HELD_KEYS_RIGHT, 1, 1000 * MS);
    held_keys_press(&m, HELD_KEYS_UP, 1, 1000 * MS);
    assert_true(held_keys_step(&m, 1000 * MS, seconds));
    assert_true(seconds[HELD_KEYS_RIGHT] > 0 && seconds[HELD_KEYS_UP] > 0);
    held_keys_press(&m, HELD_KEYS_RIGHT, -1, 1010 * MS);
    assert_true(held_keys_step(&m, 1010 * MS, seconds));
    assert_true(seconds[HELD_KEYS_RIGHT] < 0 && seconds[HELD_KEYS_UP] > 0);
    held_keys_stop(&m);
    assert_false(held_keys_step(&m, 1020 * MS, seconds));
}

/* After a frame of a second a tap is as long as always. */
static void stalls_are_no_leaps(void **state)
{
    struct held_keys m = {0};
    double seconds[HELD_KEYS_AXES];
    double sum;

    (void)state;
    held_keys_press(&m, HELD_KEYS_FORWARD, 1, 1000 * MS);
    held_keys_step(&m, 1000 * MS, seconds);
    sum = seconds[HELD_KEYS_FORWARD];
    held_keys_step(&m, 2000 * MS, seconds);
    check_close(sum + seconds[HELD_KEYS_FORWARD], 0.150, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tap_moves_at_once_and_then_stops),
        cmocka_unit_test(held_keys_move_evenly),
        cmocka_unit_test(several_keys_are_held_together),
        cmocka_unit_test(stalls_are_no_leaps),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
