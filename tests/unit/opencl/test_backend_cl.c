// SPDX-License-Identifier: MIT
/*
 * test_backend_cl.c - the OpenCL device against the CPU: sizes, crops, drafts,
 * builds, halts, uploads, and devices that are lost
 */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "render/opencl/cl_api.h"
#include "render/opencl/cl_buffers.h"
#include "render/opencl/cl_device.h"
#include "render/opencl/cl_start.h"
#include "tests/unit/opencl/pair.h"
#include "world/world_materials.h"

static const char *const scenes[] = {
    "scenes/cornell.obj",  "scenes/materials.obj", "scenes/glass_mirror.obj",
    "scenes/interior.obj", "scenes/skylit.obj",    "scenes/lights200.obj",
};

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

/* A scene whose only triangle has no area shows its background. */
static void pictures_without_triangles_are_equal(void **state)
{
    char path[] = "/tmp/glim-test-XXXXXX.obj";
    int file = mkstemps(path, 4);
    struct pair p;

    (void)state;
    assert_true(file >= 0);
    assert_true(write(file, "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", 32) > 0);
    close(file);
    if (device) {
        open_pair(&p, path, 40, 30);
        render_both(&p, (struct rect){0, 0, 40, 30}, 3, 1);
        close_pair(&p);
    }
    unlink(path);
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

/* A build for the scene's features gives the same bits. A build that lacks a
 * needed feature is not used. */
static void special_builds_give_the_same_bits(void **state)
{
    (void)state;
    for (size_t i = 0; device && i < sizeof scenes / sizeof scenes[0]; i++) {
        struct pair p;

        open_pair(&p, scenes[i], 64, 36);
        assert_true(world_features(&p.world) != FEATURES_ALL);
        render_special(&p, (struct rect){0, 0, 64, 36}, 4, 1);
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
    struct material_values sources[32];
    uint32_t assigned[64];
    struct error err;

    assert_in_range(p->world.material_count, 2, 32);
    assert_in_range(p->scene.object_count, 2, 64);
    memcpy(sources, p->world.sources,
           p->world.material_count * sizeof *sources);
    for (uint32_t i = 0; i < p->scene.object_count; i++)
        assigned[i] = NO_INDEX;
    sources[material].base_color = (struct mtl_color){{red, .5, .5}, 1};
    if (light > 0)
        sources[material].emission = (struct mtl_color){{light, 1, 1}, 1};
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
        cmocka_unit_test(surfaces_are_equal),
        cmocka_unit_test(pictures_of_all_options_are_equal),
        cmocka_unit_test(pictures_without_triangles_are_equal),
        cmocka_unit_test(adaptive_pictures_are_equal),
        cmocka_unit_test(drafts_are_equal),
        cmocka_unit_test(feature_pictures_are_equal),
        cmocka_unit_test(special_builds_give_the_same_bits),
        cmocka_unit_test(self_tests_pass),
        cmocka_unit_test(halts_lose_no_samples),
        cmocka_unit_test(lost_devices_are_reported),
        cmocka_unit_test(only_changes_are_uploaded),
    };

    return cmocka_run_group_tests(tests, open_device, close_device);
}
