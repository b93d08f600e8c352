// SPDX-License-Identifier: MIT
/*
 * test_adaptive.c - adaptive sampling: unbiased, the same bits however it is
 * computed, and samples where the error is
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "film/adaptive.h"
#include "film/film_error.h"
#include "render/cpu_dispatch.h"
#include "render/render_loop.h"
#include "tests/unit/check.h"
#include "tests/unit/mesh.h"
#include "kernels/sample_share.h"

#define WIDTH  16
#define HEIGHT 12
#define PIXELS (WIDTH * HEIGHT)

/* Side of a region of pixels whose mean is tested. */
#define REGION  4
#define REGIONS (WIDTH / REGION * (HEIGHT / REGION))

/* A lit corner with a glass ball before the dark: fireflies and background. */
static void make_scene(struct mesh *m)
{
    memset(m, 0, sizeof *m);
    m->materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.7f);
    m->materials[1] = mesh_material(MATERIAL_DIFFUSE, 0.0f);
    m->materials[1].emission = v3(90, 80, 70);
    m->materials[2] = mesh_material(MATERIAL_GLASS, 1.0f);
    mesh_add_quad(m, v3(-1, -1, -1), v3(1, -1, -1), v3(1, -1, 1), v3(-1, -1, 1),
                  0);
    mesh_add_quad(m, v3(-1, -1, -1), v3(-1, 1, -1), v3(0, 1, -1), v3(0, -1, -1),
                  0);
    mesh_add_quad(m, v3(-0.1f, 0.99f, -0.1f), v3(0.1f, 0.99f, -0.1f),
                  v3(0.1f, 0.99f, 0.1f), v3(-0.1f, 0.99f, 0.1f), 1);
    mesh_add_sphere(m, v3(0, -0.5f, 0), 0.4f, 12, 20, 2);
    m->world.settings.camera = (struct camera){.eye = {0, 0, 2.5f},
                                               .width = WIDTH,
                                               .forward = {0, 0, -1},
                                               .height = HEIGHT,
                                               .right = {0.6f, 0, 0},
                                               .up = {0, 0.35f, 0}};
    mesh_finish(m);
}

static struct render *open_render(int threads)
{
    struct error err;
    struct backend *backend =
        backend_cpu_create(threads, cpu_kernel_best(), &err);
    struct render *r;

    assert_non_null(backend);
    r = render_create(backend, &err);
    assert_non_null(r);
    return r;
}

static void close_render(struct render *r)
{
    struct backend *backend = render_backend(r);

    render_destroy(r);
    backend->destroy(backend);
}

/* FEATURE_FILTER: the shares lower the error of the filtered picture. 0: that
 * of the film. */
static uint64_t filter_feature;

static void start(struct render *r, struct mesh *m, uint64_t spp,
                  bool is_adaptive, uint32_t seed)
{
    struct render_job job = {.world = m->world,
                             .host = &m->host,
                             .crop = {0, 0, WIDTH, HEIGHT},
                             .limits.spp = spp,
                             .is_adaptive = is_adaptive};
    struct error err;

    job.world.settings.features =
        (FEATURES_ALL & ~FEATURE_AOV & ~FEATURE_FILTER) | filter_feature;
    job.world.settings.seed = seed;
    check_or_say(render_start(r, &job, &err), err.text);
}

/* Means of the regions of many pictures, and of their squares. */
struct means {
    double sum[REGIONS], square[REGIONS];
    int count;
};

static void add_picture(struct means *m, struct film *film)
{
    float rgb[3 * PIXELS];
    double region[REGIONS] = {0};

    film_linear(film, rgb);
    for (int i = 0; i < PIXELS; i++) {
        int x = i % WIDTH / REGION, y = i / WIDTH / REGION;

        region[y * (WIDTH / REGION) + x] +=
            (double)(rgb[3 * i] + rgb[3 * i + 1] + rgb[3 * i + 2]);
    }
    for (int i = 0; i < REGIONS; i++) {
        m->sum[i] += region[i];
        m->square[i] += region[i] * region[i];
    }
    m->count++;
}

static double mean_at(const struct means *m, int i)
{
    return m->sum[i] / m->count;
}

static double variance_at(const struct means *m, int i)
{
    double mean = mean_at(m, i);

    return (m->square[i] / m->count - mean * mean) / (m->count - 1);
}

/* The mean of 1,000 adaptive pictures is that of 1,000 uniform ones, in each of
 * 12 regions: chance exceeds 5 standard errors once in 1.5e5 runs, and the
 * seeds are fixed. */
static void the_mean_is_that_of_uniform_sampling(void **state)
{
    struct means means[2];
    struct mesh m;
    struct render *r = open_render(2);

    (void)state;
    memset(means, 0, sizeof means);
    make_scene(&m);
    for (uint32_t seed = 0; seed < (check_is_thorough() ? 1000 : 120); seed++)
        for (int k = 0; k < 2; k++) {
            start(r, &m, 48, k == 1, 2 * seed + (uint32_t)k);
            assert_true(render_wait(r, 60000));
            add_picture(&means[k], render_film(r));
        }
    for (int i = 0; i < REGIONS; i++) {
        double difference = mean_at(&means[1], i) - mean_at(&means[0], i);
        double error =
            sqrt(variance_at(&means[0], i) + variance_at(&means[1], i));

        check_at_most(fabs(difference), 5 * error + 1e-9);
    }
    close_render(r);
    mesh_free(&m);
}

static uint64_t state_of_random = 1;

/* Takes samples up to `mean` in the mean; in pixels from column x0 on the light
 * is 50 with a chance of 2 %, in the others 1. */
static void take_samples(struct film *film, const struct adaptive *a,
                         uint64_t mean, int x0)
{
    for (int y = 0; y < film->height; y++)
        for (int x = 0; x < film->width; x++) {
            int at = y * film->width + x;
            uint64_t end = share_samples(a->shares[at], mean);

            while (film->counts[at] < end) {
                float light = x < x0                                  ? 1.0f
                              : check_random(&state_of_random) < 0.02 ? 50.0f
                                                                      : 0.0f;
                struct path_sample sample = {{light, light, light}, 1, 0};

                film_add_row(film, (struct film_pixels){x, y, 1, 1}, &sample,
                             NULL, (const int[]){1});
            }
        }
}

/* Renders a film of take_samples(). */
static void take_film(struct film *film, struct adaptive *a, uint64_t mean,
                      int x0)
{
    struct error err;

    film_clear(film);
    adaptive_reset(a);
    take_samples(film, a, ADAPTIVE_FIRST, x0);
    assert_true(adaptive_decide(a, film, 0, NULL, NULL, &err));
    take_samples(film, a, mean, x0);
}

/* Pixels with rare light keep their mean of 1: if numbers of samples depended
 * on the pixel's own values it would be .73 to .96. 1,000 pictures of 144
 * pixels know it to .3 %. */
static void rare_light_is_not_lost(void **state)
{
    struct adaptive a = {0};
    struct film film;
    struct error err;
    float rgb[3 * 144];
    double sum = 0;

    (void)state;
    assert_true(film_init(&film, 12, 12, &err));
    assert_true(adaptive_init(&a, 12, 12, &err));
    for (int k = 0; k < 1000; k++) {
        take_film(&film, &a, 64, 0);
        film_linear(&film, rgb);
        for (int i = 0; i < 144; i++)
            sum += (double)rgb[3 * i];
    }
    check_close(sum / (1000 * 144), 1, 0.014);
    adaptive_free(&a);
    film_free(&film);
}

/* The number of samples of a pixel does not depend on its own ones: a film that
 * differs in one pixel, by any light, has the same share there. */
static void a_share_does_not_depend_on_its_pixel(void **state)
{
    struct adaptive a[2] = {{0}, {0}};
    struct film film;
    struct error err;

    (void)state;
    assert_true(film_init(&film, 20, 14, &err));
    for (int i = 0; i < 2; i++)
        assert_true(adaptive_init(&a[i], 20, 14, &err));
    for (int at = 0; at < 20 * 14; at++) {
        bool changes = false;

        for (int i = 0; i < 2; i++) {
            struct path_sample flash = {{500, 200, 30}, 1, 0};

            state_of_random = 7;
            film_clear(&film);
            adaptive_reset(&a[i]);
            take_samples(&film, &a[i], ADAPTIVE_FIRST - 1, 3);
            for (int x = 0; x < 20 * 14; x++)
                film_add_row(&film, (struct film_pixels){x % 20, x / 20, 1, 1},
                             i == 1 && x == at
                                 ? &flash
                                 : &(struct path_sample){{1, 1, 1}, 1, 0},
                             NULL, (const int[]){1});
            assert_true(adaptive_decide(&a[i], &film, 0, NULL, NULL, &err));
        }
        assert_int_equal(a[0].shares[at], a[1].shares[at]);
        for (int x = 0; x < 20 * 14; x++)
            changes |= a[0].shares[x] != a[1].shares[x];
        assert_true(changes);
    }
    for (int i = 0; i < 2; i++)
        adaptive_free(&a[i]);
    film_free(&film);
}

/* Where half of the picture has no noise, the other half gets nearly twice the
 * samples, and the calm one an eighth after the first 16. All pixels together
 * take what was planned, but for rounding. */
static void samples_go_where_the_error_is(void **state)
{
    struct adaptive a = {0};
    struct film film;
    struct error err;
    uint64_t noisy = 0, calm = 0;

    (void)state;
    assert_true(film_init(&film, 64, 64, &err));
    assert_true(adaptive_init(&a, 64, 64, &err));
    take_film(&film, &a, 256, 32);
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++) {
            noisy += x >= 38 ? film.counts[y * 64 + x] : 0;
            calm += x < 26 ? film.counts[y * 64 + x] : 0;
        }
    assert_true((double)noisy / (26 * 64) > 1.7 * 256);
    assert_true((double)calm / (26 * 64) == 16 + 240 / 8);
    check_close((double)atomic_load(&film.samples), 256 * 64 * 64,
                0.5 * 64 * 64);
    adaptive_free(&a);
    film_free(&film);
}

/* A single lamp before the dark: all but a few pixels have no error, and share
 * what those cannot take. */
static void a_few_noisy_pixels_take_the_most_samples(void **state)
{
    struct adaptive a = {0};
    struct film film;
    struct error err;

    (void)state;
    assert_true(film_init(&film, 64, 64, &err));
    assert_true(adaptive_init(&a, 64, 64, &err));
    take_film(&film, &a, 256, 63);
    assert_int_equal(film.counts[64 * 32 + 63], 16 + 5 * 240 / 2);
    assert_true(film.counts[64 * 32] > 100);
    check_close((double)atomic_load(&film.samples), 256 * 64 * 64,
                0.5 * 64 * 64);
    adaptive_free(&a);
    film_free(&film);
}

/* Light of mean 1 whose deviation is twice as large in the right half: shares
 * there are 2^(5/8) times as large, and one in the mean. */
static void shares_follow_deviations(void **state)
{
    struct adaptive a = {0};
    struct film film;
    struct error err;
    double left = 0, right = 0;

    (void)state;
    assert_true(film_init(&film, 64, 64, &err));
    assert_true(adaptive_init(&a, 64, 64, &err));
    for (int i = 0; i < 64 * 64 * (int)ADAPTIVE_FIRST; i++) {
        int x = i % 64, y = i / 64 % 64;
        double spread = x < 32 ? 0.3 : 0.6;
        float light =
            (float)(1 + spread * (2 * check_random(&state_of_random) - 1));
        struct path_sample sample = {{light, light, light}, 1, 0};

        film_add_row(&film, (struct film_pixels){x, y, 1, 1}, &sample, NULL,
                     (const int[]){1});
    }
    assert_true(adaptive_decide(&a, &film, 0, NULL, NULL, &err));
    for (int i = 0; i < 64 * 64; i++) {
        left += i % 64 < 25 ? a.shares[i] : 0;
        right += i % 64 >= 39 ? a.shares[i] : 0;
    }
    check_close(left / (25 * 64) / SHARE_ONE, 2 / (1 + exp2(0.625)), 0.03);
    check_close(right / (25 * 64) / SHARE_ONE, 2 / (1 + exp2(-0.625)), 0.03);
    adaptive_free(&a);
    film_free(&film);
}

/* Pixels of equal deviations have equal shares, at sides and corners too. */
static void equal_deviations_have_equal_shares(void **state)
{
    struct adaptive a = {0};
    struct film film;
    struct error err;

    (void)state;
    assert_true(film_init(&film, 17, 10, &err));
    assert_true(adaptive_init(&a, 17, 10, &err));
    for (int i = 0; i < 17 * 10 * (int)ADAPTIVE_FIRST; i++) {
        float light = i / (17 * 10) % 2 == 0 ? 0.999f : 1.001f;
        struct path_sample sample = {{light, light, light}, 1, 0};

        film_add_row(&film, (struct film_pixels){i % 17, i / 17 % 10, 1, 1},
                     &sample, NULL, (const int[]){1});
    }
    assert_true(adaptive_decide(&a, &film, 0, NULL, NULL, &err));
    for (int i = 0; i < 17 * 10; i++)
        check_close((double)a.shares[i] / SHARE_ONE, 1, 0.001);
    adaptive_free(&a);
    film_free(&film);
}

static void assert_same_film(struct film *a, struct film *b)
{
    assert_memory_equal(a->counts, b->counts, PIXELS * sizeof *a->counts);
    assert_memory_equal(a->sums, b->sums, 3 * PIXELS * sizeof *a->sums);
    assert_memory_equal(a->odd_sums, b->odd_sums,
                        3 * PIXELS * sizeof *a->odd_sums);
}

/* Threads and halts do not matter, nor does a limit that is raised later. */
static void the_bits_are_the_same(void **state)
{
    struct mesh m;
    struct render *one = open_render(1), *many = open_render(5);

    (void)state;
    make_scene(&m);
    start(one, &m, 144, true, 3);
    assert_true(render_wait(one, 60000));
    start(many, &m, 13, true, 3);
    assert_true(render_wait(many, 60000));
    render_resume(many, (struct render_limits){.spp = 43});
    for (int i = 0; !render_wait(many, i % 5); i++) {
        render_halt(many);
        render_resume(many, (struct render_limits){.spp = 43});
    }
    render_resume(many, (struct render_limits){.spp = 144});
    assert_true(render_wait(many, 60000));
    assert_same_film(render_film(one), render_film(many));
    close_render(one);
    close_render(many);
    mesh_free(&m);
}

/* A picture without noise, and one without light, end all the same. */
static void pictures_without_error_end(void **state)
{
    struct mesh m;
    struct render *r = open_render(2);

    (void)state;
    make_scene(&m);
    m.world.settings.camera.forward = v3(0, 0, 1); /* away from all */
    start(r, &m, 40, true, 0);
    assert_true(render_wait(r, 60000));
    assert_int_equal(render_film(r)->counts[0], 40);
    assert_true(render_progress(r).is_adaptive);
    close_render(r);
    mesh_free(&m);
}

/* The light before the decision is the same, so only its measure can give a
 * film with the filter's sums other shares. */
static void filtered_pictures_have_their_own_shares(void **state)
{
    uint16_t shares[2][PIXELS];
    struct mesh m;
    struct render *r = open_render(2);

    (void)state;
    make_scene(&m);
    for (int k = 0; k < 2; k++) {
        filter_feature = k == 1 ? FEATURE_FILTER : 0;
        start(r, &m, 48, true, 0);
        assert_true(render_wait(r, 60000));
        memcpy(shares[k], render_shares(r), sizeof shares[k]);
    }
    assert_memory_not_equal(shares[0], shares[1], sizeof shares[0]);
    filter_feature = 0;
    close_render(r);
    mesh_free(&m);
}

static int with_filter(void **state)
{
    (void)state;
    filter_feature = FEATURE_FILTER;
    return 0;
}

static int without_filter(void **state)
{
    (void)state;
    filter_feature = 0;
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mean_is_that_of_uniform_sampling),
        cmocka_unit_test_setup_teardown(the_mean_is_that_of_uniform_sampling,
                                        with_filter, without_filter),
        cmocka_unit_test(rare_light_is_not_lost),
        cmocka_unit_test(a_share_does_not_depend_on_its_pixel),
        cmocka_unit_test(samples_go_where_the_error_is),
        cmocka_unit_test(shares_follow_deviations),
        cmocka_unit_test(equal_deviations_have_equal_shares),
        cmocka_unit_test(a_few_noisy_pixels_take_the_most_samples),
        cmocka_unit_test(the_bits_are_the_same),
        cmocka_unit_test_setup_teardown(the_bits_are_the_same, with_filter,
                                        without_filter),
        cmocka_unit_test(pictures_without_error_end),
        cmocka_unit_test(filtered_pictures_have_their_own_shares),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
