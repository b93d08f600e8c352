// SPDX-License-Identifier: MIT
/*
 * test_outline.c - the outline of a square that covers known pixels is the ring
 * of pixels around it, in frames with and without a place for each pixel
 */
#include "inspect/outline.h"
#include "tests/unit/check.h"
#include "tests/unit/mesh.h"

#define ORANGE(rgb) ((rgb)[0] == 0xff && (rgb)[1] == 0x9a && (rgb)[2] == 0x2e)

/* A square of material 1 that covers the middle half of the picture, in front
 * of a wall of material 0. */
static void open_square(struct mesh *m, int side)
{
    *m = (struct mesh){.tri_count = 0};
    mesh_add_quad(m, v3(-0.5f, -0.5f, 0), v3(0.5f, -0.5f, 0), v3(0.5f, 0.5f, 0),
                  v3(-0.5f, 0.5f, 0), 1);
    mesh_add_quad(m, v3(-9, -9, -1), v3(9, -9, -1), v3(9, 9, -1), v3(-9, 9, -1),
                  0);
    m->world.settings.camera = (struct camera){
        .eye = v3(0, 0, 4),
        .forward = v3(0, 0, -1),
        .right = v3(0.25f, 0, 0),
        .up = v3(0, 0.25f, 0),
        .width = (float)side,
        .height = (float)side,
        .focus = 1,
    };
    mesh_finish(m);
}

static bool is_around(int x, int lo, int hi, int reach)
{
    return (x >= lo - reach && x < lo) || (x >= hi && x < hi + reach);
}

/* Counts the pixels of the outline, all of which are in the ring of the given
 * width around the square. */
static int count_ring(const struct frame *frame, int reach)
{
    int lo = frame->width / 4, hi = frame->width - lo, count = 0;

    for (int y = 0; y < frame->height; y++) {
        for (int x = 0; x < frame->width; x++) {
            const uint8_t *rgb = frame->rgb + 3 * (y * frame->width + x);

            if (!ORANGE(rgb))
                continue;
            count++;
            assert_true(is_around(x, lo, hi, reach) ||
                        is_around(y, lo, hi, reach));
            assert_true(x >= lo - reach && x < hi + reach);
            assert_true(y >= lo - reach && y < hi + reach);
        }
    }
    return count;
}

static void check_ring(int side, int reach)
{
    const struct outline_choice choices[] = {{false, 1}, {false, 0}};
    struct outline o = {.mask = NULL};
    struct scene scene = {.path = NULL};
    struct frame frame;
    struct error err;
    struct mesh m;

    open_square(&m, side);
    assert_true(frame_init(&frame, side, side, &err));
    outline_find(&o, &m.world, &scene, 1, choices[0], &frame);
    outline_draw(&o, &frame);
    assert_int_equal(count_ring(&frame, reach), 4 * (side / 2) * reach);
    /* another choice is another mask: the wall reaches the border everywhere,
     * so that its outline is inside the square */
    memset(frame.rgb, 0, 3 * (size_t)side * (size_t)side);
    outline_find(&o, &m.world, &scene, 1, choices[1], &frame);
    outline_draw(&o, &frame);
    assert_int_equal(o.mask[0], true);
    assert_true(ORANGE(frame.rgb + 3 * ((side / 4) * side + side / 2)));
    assert_false(ORANGE(frame.rgb + 3 * ((side / 2) * side + side / 2)));
    outline_free(&o);
    frame_free(&frame);
    mesh_free(&m);
}

static void a_square_has_a_ring(void **state)
{
    (void)state;
    check_ring(64, 1);
    check_ring(128, 1);
}

/* A mask of fewer places than pixels is exact to one place. */
static void large_frames_have_coarse_masks(void **state)
{
    struct outline o = {.mask = NULL};
    struct scene scene = {.path = NULL};
    struct frame frame;
    struct error err;
    struct mesh m;
    int count;

    (void)state;
    open_square(&m, 800);
    assert_true(frame_init(&frame, 800, 800, &err));
    outline_find(&o, &m.world, &scene, 1, (struct outline_choice){false, 1},
                 &frame);
    assert_in_range(o.width * o.height, OUTLINE_PLACES / 2, OUTLINE_PLACES);
    outline_draw(&o, &frame);
    count = count_ring(&frame, 12);
    assert_in_range(count, 4 * 400 * 2, 4 * 400 * 4);
    outline_free(&o);
    frame_free(&frame);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_square_has_a_ring),
        cmocka_unit_test(large_frames_have_coarse_masks),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
