// SPDX-License-Identifier: MIT
#include "tests/stress/extremes.h"
#include "tests/unit/folder.h"

/* Number of scenes that are also rendered on the device. */
#define SCENES    (check_is_thorough() ? 300u : 150u)
#define ON_DEVICE 15

static void random_extremes_are_finite(void **state)
{
    struct extremes *x = *state;

    for (uint32_t i = 0; i < SCENES; i++)
        assert_true(extremes_check(x, i, i % (SCENES / ON_DEVICE) == 0));
    assert_int_equal(x->scenes, SCENES);
    assert_in_range(x->refused, 0, SCENES / 4); /* most for their smoke */
    assert_true(x->saturated > 0);
}

/* Two faces emit towards each other with the greatest floats, so that the sum
 * of light exceeds them. */
static void facing_lamps_are_finite(void **state)
{
    struct extremes *x = *state;
    struct options options;
    struct session s;
    struct error err;
    float first[EXTREMES_NUMBERS];
    FILE *f = extremes_file("a.mtl");

    fprintf(f, "newmtl m\nKd .8 .8 0\nKe 3e38\n");
    fclose(f);
    f = extremes_file("a.obj");
    fprintf(f,
            "mtllib a.mtl\nusemtl m\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
            "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\nf 1 2 3 4\nf 8 7 6 5\n");
    fclose(f);
    f = extremes_file("a.view");
    fprintf(f, "eye 0 0 .5\nat 0 0 0\nup 0 1 0\nres %d %d\n", EXTREMES_SIDE,
            EXTREMES_SIDE);
    fclose(f);
    options_init(&options);
    options.scene_path = "a.obj";
    options.thread_count = 1;
    assert_true(session_load(&s, &options, 0, &err));
    x->samples = x->saturated = 0;
    for (int i = 0; i < x->count; i++)
        assert_true(extremes_render(x, &s, i, 0, first));
    assert_int_equal(x->samples, EXTREMES_SPP * EXTREMES_SIDE * EXTREMES_SIDE);
    assert_int_equal(x->saturated, x->samples);
    for (size_t i = 0; i < EXTREMES_NUMBERS; i++)
        assert_true(first[i] == 0x1p62f);
    assert_true(extremes_filter(x, &s, 0));
    session_close(&s);
}

static struct extremes extremes;

static int open_all(void **state)
{
    if (enter_folder(state) != 0)
        return -1;
    extremes_open(&extremes, true);
    *state = &extremes;
    return 0;
}

static int close_all(void **state)
{
    extremes_close(*state);
    return leave_empty_folder(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(facing_lamps_are_finite),
        cmocka_unit_test(random_extremes_are_finite),
    };

    return cmocka_run_group_tests(tests, open_all, close_all);
}
