// SPDX-License-Identifier: MIT
/* The filter of libglim: less noise, the picture with its noise unchanged, and
 * a picture for each setting. */
#include "tests/unit/check.h"

#include <math.h>
#include <string.h>

#include "glim/glim.h"

#define WIDTH  48
#define HEIGHT 36
#define COUNT  ((size_t)3 * WIDTH * HEIGHT)

static struct glim *open_cornell(void)
{
    struct glim_error err;
    struct glim *g = glim_open("scenes/cornell.obj", NULL, &err);

    check_or_say(g != NULL && glim_set_size(g, WIDTH, HEIGHT, &err), err.text);
    return g;
}

static void render(struct glim *g, uint64_t spp, float *rgb)
{
    struct glim_error err;

    check_or_say(glim_render(g, spp, 0, NULL, NULL, &err) == GLIM_DONE &&
                     glim_read_floats(g, rgb, COUNT, &err),
                 err.text);
}

static void denoise(struct glim *g, bool is_wanted)
{
    struct glim_error err;

    check_or_say(glim_set_denoise(g, is_wanted, &err), err.text);
}

static void read_floats(struct glim *g, float *rgb)
{
    assert_true(glim_read_floats(g, rgb, COUNT, NULL));
}

/* Relative, so that the edges of the lamp, which is not filtered, do not
 * outweigh the picture. */
static double mean_square(const float *a, const float *b)
{
    double sum = 0;

    for (size_t i = 0; i < COUNT; i++)
        sum +=
            pow((double)a[i] - (double)b[i], 2) / (pow((double)b[i], 2) + 0.01);
    return sum / (double)COUNT;
}

static bool is_same(const float *a, const float *b)
{
    return memcmp(a, b, COUNT * sizeof *a) == 0;
}

/* Against a converged picture the filtered one has at most a third of the
 * error. The stated error is that of the film. */
static void the_filter_removes_noise(void **state)
{
    static float truth[COUNT], raw[COUNT], filtered[COUNT], again[COUNT];
    struct glim *g = open_cornell();
    struct glim_progress p;

    (void)state;
    render(g, 1024, truth);
    denoise(g, true);
    assert_int_equal(glim_get_progress(g).samples, 0); /* a new picture */
    glim_set_seed(g, 7);
    render(g, 8, filtered);
    assert_true(glim_is_denoised(g));
    p = glim_get_progress(g);
    denoise(g, false); /* the picture stays */
    assert_false(glim_is_denoised(g));
    read_floats(g, raw);
    check_at_most(mean_square(filtered, truth), mean_square(raw, truth) / 3);
    assert_int_equal(glim_get_progress(g).samples, p.samples);
    assert_true(glim_get_progress(g).error == p.error);
    denoise(g, true);
    read_floats(g, again);
    assert_true(is_same(filtered, again));
    glim_close(g);
}

/* The film does not know of the filter, and threads change nothing. */
static void samples_are_the_same(void **state)
{
    static float raw[COUNT], beside[COUNT], filtered[2][COUNT];
    struct glim *plain = open_cornell(), *g = open_cornell();

    (void)state;
    render(plain, 4, raw);
    denoise(g, true);
    assert_true(glim_set_threads(g, 1, NULL));
    render(g, 4, filtered[0]);
    assert_true(glim_set_threads(g, 3, NULL));
    render(g, 4, filtered[1]);
    assert_true(is_same(filtered[0], filtered[1]));
    denoise(g, false);
    read_floats(g, beside);
    assert_true(is_same(raw, beside));
    glim_close(plain);
    glim_close(g);
}

/* A sample in each half is needed; more samples give another filtered picture,
 * that of a render at once. */
static void more_samples_are_filtered_again(void **state)
{
    static float one[COUNT], raw[COUNT], filtered[2][COUNT], at_once[COUNT];
    struct glim *g = open_cornell(), *whole = open_cornell();

    (void)state;
    assert_false(glim_is_denoised(g));
    denoise(g, true);
    render(g, 1, one);
    assert_false(glim_is_denoised(g));
    denoise(g, false);
    read_floats(g, raw);
    assert_true(is_same(one, raw));
    denoise(g, true);
    render(g, 2, filtered[0]);
    assert_true(glim_is_denoised(g));
    render(g, 8, filtered[1]);
    assert_false(is_same(filtered[0], filtered[1]));
    denoise(whole, true);
    render(whole, 8, at_once);
    assert_true(is_same(filtered[1], at_once));
    glim_close(g);
    glim_close(whole);
}

static bool read_and_count(void *context, const struct glim_progress *p)
{
    static float rgb[COUNT];
    void **values = context;

    (void)p;
    read_floats(values[0], rgb);
    ++*(int *)values[1];
    return true;
}

/* The progress function may read the filtered picture while threads render. */
static void progress_is_filtered(void **state)
{
    static float watched[COUNT], alone[COUNT];
    struct glim *g = open_cornell(), *other = open_cornell();
    int calls = 0;

    (void)state;
    denoise(g, true);
    denoise(other, true);
    assert_int_equal(glim_render(g, 32, 0, read_and_count,
                                 (void *[]){g, &calls}, NULL),
                     GLIM_DONE);
    assert_true(calls > 0);
    read_floats(g, watched);
    render(other, 32, alone);
    assert_true(is_same(watched, alone));
    glim_close(g);
    glim_close(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_filter_removes_noise),
        cmocka_unit_test(samples_are_the_same),
        cmocka_unit_test(more_samples_are_filtered_again),
        cmocka_unit_test(progress_is_filtered),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
