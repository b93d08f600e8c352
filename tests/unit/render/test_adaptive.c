// SPDX-License-Identifier: MIT
/*
 * test_adaptive.c - adaptive sampling: unbiased, the same bits however it is
 * computed, and samples where the error is
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "picture/adaptive.h"
#include "picture/film_error.h"
#include "render/cpu_dispatch.h"
#include "render/render_loop.h"
#include "tests/unit/check.h"
#include "tests/unit/mesh.h"
#include "kernels/targets.h"

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

static void start(struct render *r, struct mesh *m, uint64_t spp,
                  bool is_adaptive, uint32_t seed)
{
    struct render_job job = {.world = m->world,
                             .host = &m->host,
                             .crop = {0, 0, WIDTH, HEIGHT},
                             .limits.spp = spp,
                             .is_adaptive = is_adaptive};
    struct error err;

    job.world.settings.features = FEATURES_ALL & ~FEATURE_AOV;
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
    for (uint32_t seed = 0; seed < 1000; seed++)
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

/* Takes the samples that the targets want; in pixels from column x0 on the
 * light is 50 with a chance of 2 %, in the others 1. */
static void take_samples(struct film *film, const struct adaptive *a,
                         uint64_t target, int x0)
{
    for (int y = 0; y < film->height; y++)
        for (int x = 0; x < film->width; x++) {
            uint64_t *count = &film->counts[y * film->width + x];
            uint64_t end =
                target <= ADAPTIVE_FIRST
                    ? target
                    : a->targets[target_index((uint32_t)x, (uint32_t)y,
                                              (uint32_t)film->width)];

            while (*count < end) {
                float light = x < x0                                  ? 1.0f
                              : check_random(&state_of_random) < 0.02 ? 50.0f
                                                                      : 0.0f;
                struct path_sample sample = {{light, light, light}, 1, 0};

                film_add_row(film, x, y, 1, 1, &sample, NULL, (const int[]){1});
            }
        }
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
    double sum = 0, pilots = 0;

    (void)state;
    assert_true(film_init(&film, 12, 12, &err));
    assert_true(adaptive_init(&a, 12, 12, &err));
    for (int k = 0; k < 1000; k++) {
        uint64_t done = ADAPTIVE_FIRST;

        film_clear(&film);
        adaptive_reset(&a);
        take_samples(&film, &a, done, 0);
        while (done < 64) {
            uint64_t target = done + 8;

            assert_true(adaptive_next_pass(&a, &film, 0, done, &target, &err));
            take_samples(&film, &a, target, 0);
            done = target;
        }
        film_linear(&film, rgb);
        for (int i = 0; i < 144; i++) {
            sum += (double)rgb[3 * i];
            if (i % 2 == 0 && i / 12 % 2 == 0)
                pilots += (double)rgb[3 * i];
        }
    }
    check_close(sum / (1000 * 144), 1, 0.014);
    check_close(pilots / (1000 * 36), 1, 0.028);
    adaptive_free(&a);
    film_free(&film);
}

/* Where half of the picture has no noise, the other half gets nearly twice the
 * samples, and the calm one none after the first 16. All pixels together take
 * what was planned, but for the rounding of quotas. */
static void samples_go_where_the_error_is(void **state)
{
    struct adaptive a = {0};
    struct film film;
    struct error err;
    uint64_t noisy = 0, calm = 0;
    uint64_t done = ADAPTIVE_FIRST;

    (void)state;
    assert_true(film_init(&film, 64, 64, &err));
    assert_true(adaptive_init(&a, 64, 64, &err));
    take_samples(&film, &a, done, 32);
    while (done < 256) {
        uint64_t target = done + 8;

        assert_true(adaptive_next_pass(&a, &film, 0, done, &target, &err));
        take_samples(&film, &a, target, 32);
        done = target;
    }
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++) {
            noisy += x >= 38 ? film.counts[y * 64 + x] : 0;
            calm += x < 26 ? film.counts[y * 64 + x] : 0;
        }
    assert_true((double)noisy / (26 * 64) > 1.7 * 256);
    assert_true((double)calm / (26 * 64) == 16);
    assert_true(atomic_load(&film.samples) <= 256 * 64 * 64);
    assert_true(atomic_load(&film.samples) >= 250 * 64 * 64);
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

/* Threads and halts do not matter, nor does a limit that is raised later at the
 * end of a pass. */
static void the_bits_are_the_same(void **state)
{
    struct mesh m;
    struct render *one = open_render(1), *many = open_render(5);

    (void)state;
    make_scene(&m);
    start(one, &m, 144, true, 3);
    assert_true(render_wait(one, 60000));
    start(many, &m, 40, true, 3);
    for (int i = 0; !render_wait(many, i % 5); i++) {
        render_halt(many);
        render_resume(many, (struct render_limits){.spp = 40});
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mean_is_that_of_uniform_sampling),
        cmocka_unit_test(rare_light_is_not_lost),
        cmocka_unit_test(samples_go_where_the_error_is),
        cmocka_unit_test(the_bits_are_the_same),
        cmocka_unit_test(pictures_without_error_end),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
