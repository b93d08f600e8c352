// SPDX-License-Identifier: MIT
/*
 * test_backend_cl.c - the OpenCL device against the CPU: on PoCL every pixel of
 * every shipped scene has the same bits, with all options
 *
 * GLIM_TEST_DEVICE names another device. Others may round differently: the
 * differences of pixels must have the mean 0 by a t-test, and the number of
 * different pixels is printed.
 */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>

#include "base/memory.h"
#include "scene/world_lamps.h"
#include "scene/world_materials.h"
#include "scene/world.h"
#include "load/scene_load.h"
#include "formats/view_file.h"
#include "render/cpu_dispatch.h"
#include "render/render_loop.h"
#include "opencl/backend_cl.h"
#include "opencl/cl_api.h"
#include "opencl/cl_device.h"
#include "opencl/cl_environment.h"
#include "opencl/cl_world.h"
#include "opencl/selftest.h"
#include "terminal/xmalloc.h"
#include "tests/unit/check.h"
#include "kernels/features.h"

static const char *const scenes[] = {
    "scenes/cornell.obj",  "scenes/materials.obj", "scenes/glass_mirror.obj",
    "scenes/interior.obj", "scenes/skylit.obj",    "scenes/lights200.obj",
};

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

static int open_device(void **state)
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

static int close_device(void **state)
{
    (void)state;
    if (device != NULL)
        device->destroy(device);
    return 0;
}

static void open_pair(struct pair *p, const char *path, int width, int height)
{
    struct warnings report = {0};
    struct error err;
    char *view_path = xformat("%.*s.view", (int)strlen(path) - 4, path);
    struct backend *cpu = backend_cpu_create(2, cpu_kernel_best(), &err);

    *p = (struct pair){0};
    view_init(&p->view);
    assert_non_null(cpu);
    check_or_say(view_read(&p->view, view_path, &report, &err) &&
                     scene_load(&p->scene, path, SCENE_UP_OF_FILE, &report,
                                &err) &&
                     world_init(&p->world, &p->scene, 1, &report, &err) &&
                     world_load_sky(&p->world, &p->view, &report, &err) &&
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

static void close_pair(struct pair *p)
{
    struct backend *cpu = render_backend(p->renders[0]);

    render_destroy(p->renders[0]);
    render_destroy(p->renders[1]);
    cpu->destroy(cpu);
    world_free(&p->world);
    scene_free(&p->scene);
    view_free(&p->view);
}

static void start(struct pair *p, int which, struct rect crop, uint64_t spp,
                  uint32_t seed)
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

static void finish(struct pair *p, int which)
{
    struct render_progress progress;

    assert_true(render_wait(p->renders[which], 300000));
    progress = render_progress(p->renders[which]);
    check_or_say(progress.state == RENDER_DONE, progress.error.text);
}

/* Returns the t value of the differences in one channel, and the number of
 * different pixels. */
static double t_of(const float *a, const float *b, size_t pixels,
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

static void assert_equal_in_the_mean(struct pair *p)
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

static void assert_same(struct pair *p, uint64_t spp)
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

static void render_both(struct pair *p, struct rect crop, uint64_t spp,
                        uint32_t seed)
{
    for (int i = 0; i < 2; i++) {
        start(p, i, crop, spp, seed);
        finish(p, i);
    }
    assert_same(p, spp);
}

static void shipped_scenes_are_equal(void **state)
{
    (void)state;
    for (size_t i = 0; device && i < sizeof scenes / sizeof scenes[0]; i++) {
        struct pair p;

        open_pair(&p, scenes[i], 97, 55);
        render_both(&p, (struct rect){0, 0, 97, 55}, 11, (uint32_t)i);
        close_pair(&p);
    }
}

/* Sums of first surfaces are those of the CPU, with and without them in
 * turn. */
static void surfaces_are_equal(void **state)
{
    struct pair p;

    (void)state;
    if (!device)
        return;
    open_pair(&p, "scenes/glass_mirror.obj", 90, 57);
    for (int i = 0; i < 4; i++) {
        p.has_surfaces = i % 2 == 0;
        render_both(&p, (struct rect){0, 0, 90 - i, 57 - i}, 9, 3);
    }
    close_pair(&p);
}

/* Tests one backend after another scene, sizes that are not multiples of a
 * group, crops, seeds, depths, and pictures of one pixel. */
static void pictures_of_all_options_are_equal(void **state)
{
    static const int depths[] = {-1, 0, 1, 3};
    struct pair p;

    (void)state;
    if (!device)
        return;
    open_pair(&p, "scenes/glass_mirror.obj", 130, 71);
    for (int i = 0; i < 4; i++) {
        struct rect crop = {i * 7, i * 11, 130 - 30 * i, 71 - 17 * i};

        p.view.max_bounces = depths[i];
        render_both(&p, crop, 3, 0xffffffffu - (uint32_t)i);
    }
    render_both(&p, (struct rect){129, 70, 1, 1}, 40, 5);
    render_both(&p, (struct rect){0, 3, 130, 1}, 9, 5);
    render_both(&p, (struct rect){3, 0, 1, 71}, 9, 5);
    close_pair(&p);
}

/* Pixels have different numbers of samples. */
static void adaptive_pictures_are_equal(void **state)
{
    struct pair p;

    (void)state;
    if (!device)
        return;
    open_pair(&p, "scenes/skylit.obj", 90, 51);
    p.is_adaptive = true;
    render_both(&p, (struct rect){3, 2, 83, 47}, 45, 7);
    assert_memory_equal(render_film(p.renders[0])->counts,
                        render_film(p.renders[1])->counts,
                        83 * 47 * sizeof(uint64_t));
    close_pair(&p);
}

/* Drafts for the filter have the same halves and surfaces. */
static void assert_equal_surfaces(const struct film *a, const struct film *b)
{
    size_t pixels = (size_t)b->width * (size_t)b->height;

    assert_memory_equal(a->odd_sums, b->odd_sums,
                        3 * pixels * sizeof *b->odd_sums);
    assert_memory_equal(a->surfaces, b->surfaces, pixels * sizeof *b->surfaces);
}

/* A small film is rendered before the film, which it does not affect. */
static void drafts_are_equal(void **state)
{
    struct pair p;

    (void)state;
    if (!device)
        return;
    open_pair(&p, "scenes/cornell.obj", 97, 55);
    for (int i = 0; i < 2; i++) {
        const struct film *a, *b;

        p.draft_width = 33 + 7 * i;
        p.draft_has_surfaces = i == 1;
        p.draft_height = 20;
        render_both(&p, (struct rect){9, 5, 80, 50}, 3, 1);
        a = render_draft(p.renders[0]);
        b = render_draft(p.renders[1]);
        assert_int_equal(b->width, p.draft_width);
        assert_memory_equal(a->counts, b->counts,
                            (size_t)b->width * 20 * sizeof *b->counts);
        if (is_exact)
            assert_memory_equal(a->sums, b->sums,
                                3 * (size_t)b->width * 20 * sizeof *b->sums);
        if (is_exact && p.draft_has_surfaces)
            assert_equal_surfaces(a, b);
    }
    close_pair(&p);
}

/* Previews and feature pictures have no film, and their drafts are equal. */
static void feature_pictures_are_equal(void **state)
{
    struct pair p;

    (void)state;
    if (!device)
        return;
    open_pair(&p, "scenes/interior.obj", 97, 55);
    p.draft_width = 60;
    p.draft_height = 34;
    for (p.sample = SAMPLE_PREVIEW; p.sample <= SAMPLE_MATERIAL; p.sample++) {
        struct film *drafts[2];

        for (int i = 0; i < 2; i++) {
            start(&p, i, (struct rect){9, 5, 80, 50}, 0, 1);
            finish(&p, i);
            assert_int_equal(render_progress(p.renders[i]).samples, 0);
            drafts[i] = render_draft(p.renders[i]);
            assert_int_equal(drafts[i]->samples, 60 * 34);
        }
        assert_true(drafts[0]->rays == drafts[1]->rays);
        if (is_exact)
            assert_memory_equal(drafts[0]->sums, drafts[1]->sums,
                                (size_t)3 * 60 * 34 * sizeof(struct sum));
    }
    close_pair(&p);
}

/* Materials, lights and triangles are swapped and freed between pictures, and
 * the device sees each change. */
static void edited_worlds_are_equal(void **state)
{
    struct mtl_source sources[32];
    uint32_t assigned[64];
    struct pair p;
    uint64_t seed = 9;

    (void)state;
    if (!device)
        return;
    open_pair(&p, "scenes/cornell.obj", 48, 48);
    assert_in_range(p.scene.material_count, 2, 32);
    assert_in_range(p.scene.object_count, 2, 64);
    for (uint32_t i = 0; i < p.scene.material_count; i++)
        sources[i] = p.scene.material_origins[i].source;
    for (uint32_t i = 0; i < p.scene.object_count; i++)
        assigned[i] = NO_INDEX;
    render_both(&p, (struct rect){0, 0, 48, 48}, 2, 0);
    for (uint32_t round = 1; round < 20; round++) {
        uint32_t count = p.scene.material_count - 1;
        uint32_t m = 1 + (uint32_t)(check_random(&seed) * count);
        uint32_t o = (uint32_t)(check_random(&seed) * p.scene.object_count);
        struct error err;

        sources[m].kd = (struct mtl_color){{check_random(&seed), 0.5, 0.5}, 1};
        if (round % 3 == 1)
            sources[m].ke =
                (struct mtl_color){{3 * check_random(&seed), 1, 1}, 1};
        if (round % 3 == 2)
            assigned[o] = m;
        check_or_say(world_set_materials(&p.world, &p.scene, count + 1, sources,
                                         assigned, &err),
                     err.text);
        render_both(&p, (struct rect){0, 0, 48, 48}, 2, round);
    }
    close_pair(&p);
}

/* A profile without symmetry. */
static struct profile *make_profile(void)
{
    struct profile *p = profile_create("a.ies", 8);

    assert_non_null(p);
    for (uint32_t i = 0; i < profile_value_count(p); i++)
        p->values[i] = (float)(1 + i % 13) / 13;
    return p;
}

/* Lamps of each kind come and go, with caustics of those that have a size, and
 * with a profile. */
static void lamps_are_equal(void **state)
{
    uint32_t has_caustics = 0;
    struct pair p;

    (void)state;
    if (!device)
        return;
    open_pair(&p, "scenes/materials.obj", 48, 48);
    for (uint32_t i = 0; i < 9; i++) {
        enum lamp_kind kind = (enum lamp_kind)(i % LAMP_KINDS);
        struct lamp lamp;
        struct error err;

        lamp_init(&lamp, kind);
        for (int k = 0; k < 3; k++)
            lamp.position[k] =
                p.view.pose.eye[k] + (k == 1 ? 0.5 * (double)i : 0);
        memcpy(lamp.at, p.view.pose.at, sizeof lamp.at);
        lamp.elevation_deg = 40;
        if (i >= 3) {
            lamp.radius = 0.1 * i;
            lamp.angle_deg = 5 * i;
        }
        if (i == 6)
            lamps_free(&p.view.lamps);
        lamp.profile = i == 1 || i == 6 ? make_profile() : NULL;
        assert_true(lamps_add(&p.view.lamps, &lamp));
        profile_release(lamp.profile);
        check_or_say(world_set_lamps(&p.world, &p.scene, &p.view, &err) &&
                         world_guide(&p.world, &p.scene, &p.view, &err),
                     err.text);
        has_caustics |= world_features(&p.world) & FEATURE_CAUSTICS;
        render_both(&p, (struct rect){0, 0, 48, 48}, 2, i);
    }
    assert_int_not_equal(has_caustics, 0);
    close_pair(&p);
}

/* A build for the scene's features gives the same bits. A build that lacks a
 * needed feature is not used. */
static void special_builds_give_the_same_bits(void **state)
{
    (void)state;
    for (size_t i = 0; device && i < sizeof scenes / sizeof scenes[0]; i++) {
        struct pair p;
        struct error err;
        char *log;

        open_pair(&p, scenes[i], 64, 36);
        assert_true(world_features(&p.world) != FEATURES_ALL);
        check_or_say(backend_cl_specialise(device, world_features(&p.world),
                                           &log, &err),
                     err.text);
        render_both(&p, (struct rect){0, 0, 64, 36}, 4, 1);
        check_or_say(backend_cl_specialise(device, 0, &log, &err), err.text);
        render_both(&p, (struct rect){0, 0, 64, 36}, 4, 2);
        close_pair(&p);
    }
}

/* The self-test passes for every build that a scene may need. */
static void self_tests_pass(void **state)
{
    (void)state;
    for (size_t i = 0; device && i < sizeof scenes / sizeof scenes[0]; i++) {
        char verdict[SELFTEST_VERDICT_BYTES] = "";
        struct cl_request request = {.device = "Portable"};
        struct backend *cpu, *special;
        struct error err;
        struct pair p;
        char *log;

        open_pair(&p, scenes[i], 8, 8);
        request.features = i == 0 ? 0 : world_features(&p.world);
        cpu = backend_cpu_create(1, cpu_kernel_best(), &err);
        special = backend_cl_create(&request, &log, &err);
        check_or_say(cpu != NULL && special != NULL, err.text);
        check_or_say(selftest_run(cpu, special, request.features, verdict,
                                  &err),
                     err.text);
        if (is_exact)
            assert_string_equal(verdict, "the CPU's bits");
        special->destroy(special);
        cpu->destroy(cpu);
        close_pair(&p);
    }
}

/* Halts at arbitrary moments lose no sample and count none twice. */
static void halts_lose_no_samples(void **state)
{
    struct pair p;
    struct timespec pause = {0, 0};
    int halt_count = 0;

    (void)state;
    if (!device)
        return;
    open_pair(&p, "scenes/interior.obj", 120, 68);
    start(&p, 0, (struct rect){0, 0, 120, 68}, 60, 3);
    finish(&p, 0);
    start(&p, 1, (struct rect){0, 0, 120, 68}, 60, 3);
    while (render_progress(p.renders[1]).state != RENDER_DONE) {
        pause.tv_nsec = halt_count % 40 * 500000;
        nanosleep(&pause, NULL);
        render_halt(p.renders[1]);
        halt_count++;
        render_resume(p.renders[1], (struct render_limits){.spp = 60});
        assert_true(halt_count < 100000);
    }
    assert_true(halt_count > 20);
    assert_same(&p, 60);
    close_pair(&p);
}

/* The driver's own functions, and the number of calls that will succeed. */
static struct cl_api driver;
static atomic_int calls_left;

static cl_int CL_API_CALL
failing_enqueue(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                const size_t *offset, const size_t *global, const size_t *local,
                cl_uint wait_count, const cl_event *waits, cl_event *done)
{
    if (atomic_fetch_sub(&calls_left, 1) <= 0)
        return CL_DEVICE_NOT_AVAILABLE;
    return driver.EnqueueNDRangeKernel(queue, kernel, dimensions, offset,
                                       global, local, wait_count, waits, done);
}

static cl_int CL_API_CALL failing_wait(cl_uint count, const cl_event *events)
{
    if (atomic_fetch_sub(&calls_left, 1) <= 0)
        return CL_DEVICE_NOT_AVAILABLE;
    return driver.WaitForEvents(count, events);
}

/* A device is lost during a picture, at one call after the other. The render
 * fails with its name, and nothing is written later. A device that returns can
 * be used again. */
static void lost_devices_are_reported(void **state)
{
    struct cl_api *api;
    struct error err;
    struct pair p;

    (void)state;
    if (!device)
        return;
    api = (struct cl_api *)(uintptr_t)cl_api_open(&err);
    driver = *api;
    open_pair(&p, "scenes/cornell.obj", 240, 160);
    for (int calls = 0; calls < 60; calls++) {
        struct render_progress progress;

        atomic_store(&calls_left, calls);
        api->EnqueueNDRangeKernel = failing_enqueue;
        api->WaitForEvents = failing_wait;
        start(&p, 1, (struct rect){0, 0, 240, 160}, 100, 3);
        assert_true(render_wait(p.renders[1], 300000));
        progress = render_progress(p.renders[1]);
        *api = driver;
        assert_int_equal(progress.state, RENDER_FAILED);
        assert_non_null(strstr(progress.error.text, device->device));
        assert_non_null(strstr(progress.error.text, "CL_DEVICE_NOT_AVAILABLE"));
    }
    render_both(&p, (struct rect){0, 0, 240, 160}, 5, 3);
    close_pair(&p);
}

/* Renders on both. Returns the number of arrays that were uploaded for it. */
static uint64_t uploads(struct pair *p)
{
    uint64_t before = device->upload_count;

    render_both(p, (struct rect){0, 0, 32, 32}, 2, 0);
    return device->upload_count - before;
}

static void paint(struct pair *p, uint32_t material, double red, double light)
{
    struct mtl_source sources[32];
    uint32_t assigned[64];
    struct error err;

    assert_in_range(p->world.material_count, 2, 32);
    assert_in_range(p->scene.object_count, 2, 64);
    memcpy(sources, p->world.sources,
           p->world.material_count * sizeof *sources);
    for (uint32_t i = 0; i < p->scene.object_count; i++)
        assigned[i] = NO_INDEX;
    sources[material].kd = (struct mtl_color){{red, .5, .5}, 1};
    if (light > 0)
        sources[material].ke = (struct mtl_color){{light, 1, 1}, 1};
    check_or_say(world_set_materials(&p->world, &p->scene,
                                     p->world.material_count, sources, assigned,
                                     &err),
                 err.text);
}

/* Loads the same files again, as a session does. */
static void load_again(struct pair *p, const char *path)
{
    struct warnings report = {0};
    struct scene scene = {.path = NULL};
    struct host_world world;
    struct error err;

    check_or_say(scene_load(&scene, path, SCENE_UP_OF_FILE, &report, &err) &&
                     world_init(&world, &scene, 1, &report, &err),
                 err.text);
    assert_true(scene_has_same_shape(&scene, &p->scene));
    world_take_shape(&world, &p->world);
    world_free(&p->world);
    scene_free(&p->scene);
    p->world = world;
    p->scene = scene;
    warnings_free(&report);
}

/* Before a restart only the settings and the changed arrays are uploaded. */
static void only_changes_are_uploaded(void **state)
{
    struct pair p;

    (void)state;
    if (!device)
        return;
    open_pair(&p, "scenes/cornell.obj", 32, 32);
    assert_int_equal(uploads(&p), CL_BUFFER_COUNT);
    assert_int_equal(uploads(&p), 1);
    p.view.pose.eye[0] += 5;
    assert_int_equal(uploads(&p), 1);
    for (int i = 0; i < 3; i++) {
        paint(&p, 1, 0.1 * i, 0);
        assert_int_equal(uploads(&p), 2);
    }
    paint(&p, 1, 0.5, 2);
    /* Lights, their owners, point lights, profiles and the tree. */
    assert_int_equal(uploads(&p), 2 + 5);
    load_again(&p, "scenes/cornell.obj");
    /* All but nodes and leaves. */
    assert_int_equal(uploads(&p), CL_BUFFER_COUNT - 2);
    close_pair(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shipped_scenes_are_equal),
        cmocka_unit_test(surfaces_are_equal),
        cmocka_unit_test(pictures_of_all_options_are_equal),
        cmocka_unit_test(adaptive_pictures_are_equal),
        cmocka_unit_test(drafts_are_equal),
        cmocka_unit_test(feature_pictures_are_equal),
        cmocka_unit_test(edited_worlds_are_equal),
        cmocka_unit_test(lamps_are_equal),
        cmocka_unit_test(special_builds_give_the_same_bits),
        cmocka_unit_test(self_tests_pass),
        cmocka_unit_test(halts_lose_no_samples),
        cmocka_unit_test(lost_devices_are_reported),
        cmocka_unit_test(only_changes_are_uploaded),
    };

    return cmocka_run_group_tests(tests, open_device, close_device);
}
