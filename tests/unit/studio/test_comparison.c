// SPDX-License-Identifier: MIT
/*
 * test_comparison.c - the wipe shows a kept render as the screen showed it,
 * unless it is developed in another way now
 */
#include "tests/unit/check.h"
#include "tests/unit/folder.h"

#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "studio/comparison.h"

#define WIDTH  40
#define HEIGHT 30

static int leave(void **state)
{
    unlink("s.obj");
    return leave_empty_folder(state);
}

static uint8_t pattern(size_t i)
{
    return (uint8_t)(50 + i * 7 % 150);
}

/* Returns true if the first row of the wipe, with all of the kept render, is
 * that of the frame that was kept. */
static bool shows_pattern(struct comparison *c, struct frame *frame)
{
    memset(frame->rgb, 0, 3 * WIDTH * HEIGHT);
    comparison_paint(c, frame);
    for (size_t i = 0; i < 3 * WIDTH; i++)
        if (frame->rgb[i] != pattern(i))
            return false;
    return true;
}

static void kept_renders_keep_the_filter(void **state)
{
    struct options options = {.scene_path = "s.obj",
                              .width_px = 32,
                              .height_px = 24,
                              .max_bounces = -1,
                              .thread_count = 1};
    struct session session;
    struct live_render control;
    struct comparison c;
    struct frame shown, frame;
    struct error err;
    FILE *to = fopen("s.obj", "w");

    (void)state;
    assert_non_null(to);
    fputs("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", to);
    assert_int_equal(fclose(to), 0);
    check_or_say(session_open(&session, &options, clock_ns(), &err), err.text);
    check_or_say(live_render_init(&control, &session, &err), err.text);
    comparison_init(&c, &control);
    assert_true(frame_init(&shown, WIDTH, HEIGHT, &err));
    assert_true(frame_init(&frame, WIDTH, HEIGHT, &err));
    while (control.progress.samples == 0)
        live_render_update(&control);
    for (size_t i = 0; i < 3 * WIDTH * HEIGHT; i++)
        shown.rgb[i] = pattern(i);
    comparison_keep(&c, &shown);
    assert_null(shown.rgb); /* it is taken */
    comparison_wipe_to(&c, 1);
    assert_true(shows_pattern(&c, &frame));
    comparison_wipe_to(&c, 0);
    assert_false(shows_pattern(&c, &frame));
    /* another exposure is that of the samples */
    comparison_wipe_to(&c, 1);
    session.edit.now.view.lighting.exposure += 1;
    assert_false(shows_pattern(&c, &frame));
    session.edit.now.view.lighting.exposure -= 1;
    assert_true(shows_pattern(&c, &frame));
    comparison_keep(&c, &(struct frame){.rgb = NULL}); /* without a filter */
    comparison_wipe_to(&c, 1);
    assert_false(shows_pattern(&c, &frame));
    frame_free(&frame);
    comparison_free(&c);
    live_render_free(&control);
    session_close(&session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kept_renders_keep_the_filter),
    };

    return cmocka_run_group_tests(tests, enter_folder, leave);
}
