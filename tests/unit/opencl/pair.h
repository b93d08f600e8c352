// SPDX-License-Identifier: MIT
/*
 * pair.h - the same pictures of the CPU and of the OpenCL device
 *
 * On PoCL every pixel has the same bits. GLIM_TEST_DEVICE names another device.
 * Others may round differently: the differences of pixels must have the mean 0
 * by a t-test, and the number of different pixels is printed.
 *
 * open_device() and close_device() are the setup and teardown of a group.
 * Without a device the tests pass with a message.
 *
 * Threads:   one
 * Errors:    a failed check ends the test
 */
#ifndef TESTS_PAIR_H
#define TESTS_PAIR_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "engine/scene_load.h"
#include "render/cpu_dispatch.h"
#include "render/opencl/backend_cl.h"
#include "render/opencl/cl_api.h"
#include "render/render_loop.h"
#include "tests/unit/check.h"
#include "world/world.h"
#include "kernels/features.h"

/* A scene, and its renders on the CPU and on the device. */
struct pair {
    struct scene scene;
    struct host_world world;
    struct view view;
    struct render *renders[2];
    int draft_width, draft_height;
    bool is_adaptive;
    uint32_t sample; /* enum sample_kind */
    bool has_surfaces;
    bool draft_has_surfaces;
};

static struct backend *device; /* NULL: not available */
static bool is_exact;

/* A two-sided chance of 1e-6 is a false alarm in 10,000 runs of some 100
 * pictures and channels. With this many pixels the distribution is normal. */
#define T_MAX 4.9

static inline int open_device(void **state)
{
    const char *name = getenv("GLIM_TEST_DEVICE");
    struct cl_request request = {.device = name ? name : "Portable",
                                 .features = FEATURES_ALL};
    struct error err;
    char *log;

    (void)state;
    is_exact = name == NULL;
    cl_environment_prepare(2);
    device = backend_cl_create(&request, &log, &err);
    if (device == NULL)
        print_message("skipped: %s\n", err.text);
    check_or_say(log == NULL, log);
    return 0;
}

static inline int close_device(void **state)
{
    (void)state;
    if (device != NULL)
        device->destroy(device);
    return 0;
}

static inline void open_pair(struct pair *p, const char *path, int width,
                             int height)
{
    struct scene_options how = {.path = path,
                                .up = SCENE_UP_OF_FILE,
                                .thread_count = 1};
    struct warnings report = {0};
    struct error err;
    char *view_path;
    struct backend *cpu = backend_cpu_create(2, cpu_kernel_best(), &err);

    *p = (struct pair){0};
    view_init(&p->view);
    assert_non_null(cpu);
    check_or_say(view_find(&p->view, path, NULL, &view_path, &report, &err) &&
                     scene_open(&p->scene, &p->world, &p->view, &how, &report,
                                &err) &&
                     world_guide(&p->world, &p->scene, &p->view, &err),
                 err.text);
    p->view.width_px = width;
    p->view.height_px = height;
    p->renders[0] = render_create(cpu, &err);
    p->renders[1] = render_create(device, &err);
    assert_non_null(p->renders[0]);
    assert_non_null(p->renders[1]);
    warnings_free(&report);
    free(view_path);
}

static inline void close_pair(struct pair *p)
{
    struct backend *cpu = render_backend(p->renders[0]);

    render_destroy(p->renders[0]);
    render_destroy(p->renders[1]);
    cpu->destroy(cpu);
    world_free(&p->world);
    scene_free(&p->scene);
    view_free(&p->view);
}

static inline void start(struct pair *p, int which, struct rect crop,
                         uint64_t spp, uint32_t seed)
{
    struct render_job job = {.host = &p->world,
                             .crop = crop,
                             .limits.spp = spp,
                             .draft_width = p->draft_width,
                             .draft_height = p->draft_height,
                             .draft_has_surfaces = p->draft_has_surfaces,
                             .is_adaptive = p->is_adaptive};
    struct error err;

    check_or_say(world_lend(&p->world, &p->scene, &p->view, seed, &job.world,
                            &err),
                 err.text);
    job.world.settings.sample = p->sample;
    if (p->sample != SAMPLE_LIGHT)
        job.world.settings.features |= FEATURE_AOV;
    if (p->has_surfaces)
        job.world.settings.features |= FEATURE_FILTER;
    check_or_say(render_start(p->renders[which], &job, &err), err.text);
}

static inline void finish(struct pair *p, int which)
{
    struct render_progress progress;

    assert_true(render_wait(p->renders[which], 300000));
    progress = render_progress(p->renders[which]);
    check_or_say(progress.state == RENDER_DONE, progress.error.text);
}

/* Returns the t value of the differences in one channel, and the number of
 * different pixels. */
static inline double t_of(const float *a, const float *b, size_t pixels,
                          size_t *different)
{
    double sum = 0, squares = 0, mean, variance;

    for (size_t i = 0; i < pixels; i++) {
        double d = (double)a[3 * i] - (double)b[3 * i];

        sum += d;
        squares += d * d;
        *different += d != 0;
    }
    mean = sum / (double)pixels;
    variance = squares / (double)pixels - mean * mean;
    return variance > 0 ? mean / sqrt(variance / (double)pixels) : 0;
}

static inline void assert_equal_in_the_mean(struct pair *p)
{
    struct film *films[2] = {render_film(p->renders[0]),
                             render_film(p->renders[1])};
    size_t pixels = (size_t)films[0]->width * (size_t)films[0]->height;
    float *rgb[2];
    size_t different = 0;

    for (int i = 0; i < 2; i++) {
        rgb[i] = alloc_array(pixels, 3 * sizeof *rgb[i]);
        assert_non_null(rgb[i]);
        film_linear(films[i], rgb[i]);
    }
    for (int c = 0; c < 3; c++)
        check_at_most(fabs(t_of(rgb[0] + c, rgb[1] + c, pixels, &different)),
                      T_MAX);
    print_message("%s: %.3f %% of the channels differ\n", p->scene.path,
                  100.0 * (double)different / (3.0 * (double)pixels));
    free(rgb[0]);
    free(rgb[1]);
}

static inline void assert_same(struct pair *p, uint64_t spp)
{
    const struct film *a = render_film(p->renders[0]);
    const struct film *b = render_film(p->renders[1]);
    struct render_progress pa = render_progress(p->renders[0]);
    struct render_progress pb = render_progress(p->renders[1]);
    size_t pixels = (size_t)a->width * (size_t)a->height;

    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_true(p->is_adaptive || pa.samples == pixels * spp);
    assert_true(pb.samples == pa.samples);
    assert_memory_equal(a->counts, b->counts, pixels * sizeof *a->counts);
    if (!is_exact) {
        assert_equal_in_the_mean(p);
        return;
    }
    assert_true(pb.rays == pa.rays);
    assert_true(pb.cut_paths == pa.cut_paths);
    assert_memory_equal(a->sums, b->sums, 3 * pixels * sizeof *a->sums);
    assert_true((a->surfaces != NULL) == p->has_surfaces);
    if (p->has_surfaces)
        assert_memory_equal(a->surfaces, b->surfaces,
                            pixels * sizeof *a->surfaces);
}

static inline void render_both(struct pair *p, struct rect crop, uint64_t spp,
                               uint32_t seed)
{
    for (int i = 0; i < 2; i++) {
        start(p, i, crop, spp, seed);
        finish(p, i);
    }
    assert_same(p, spp);
}

/* Renders on both with a build of the device's kernels for the features of the
 * scene alone. */
static inline void render_special(struct pair *p, struct rect crop,
                                  uint64_t spp, uint32_t seed)
{
    struct error err;
    char *log;

    check_or_say(backend_cl_specialise(device, world_features(&p->world), &log,
                                       &err),
                 err.text);
    render_both(p, crop, spp, seed);
    check_or_say(backend_cl_specialise(device, 0, &log, &err), err.text);
}

#endif
