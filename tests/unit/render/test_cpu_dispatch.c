// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <stdlib.h>

#include "base/clock.h"
#include "scene/world.h"
#include "render/cpu_dispatch.h"
#include "session/session.h"

static const char *const scenes[] = {
    "scenes/cornell.obj",  "scenes/materials.obj", "scenes/glass_mirror.obj",
    "scenes/interior.obj", "scenes/skylit.obj",    "scenes/lights200.obj",
};

#define WIDTH  64
#define HEIGHT 36
#define SPP    3

#define BUILDS_MAX 10 /* for one instruction set */

/* The chosen build can do what is asked. Each build is the one chosen for
 * exactly its own features, so none is unused. */
static void chosen_builds_have_the_needed_features(void **state)
{
    const struct cpu_kernel *whole;

    (void)state;
    for (int i = 0; (whole = cpu_kernel_at(i)) != NULL; i++) {
        assert_int_equal(whole->features, FEATURES_ALL);
        for (uint32_t features = 0; features <= FEATURES_ALL; features++) {
            const struct cpu_kernel *p = cpu_kernel_fit(whole, features);

            assert_int_equal(features & ~p->features, 0);
            assert_string_equal(p->name, whole->name);
            assert_ptr_equal(cpu_kernel_fit(whole, p->features), p);
        }
        assert_int_equal(cpu_kernel_fit(whole, FEATURE_EMITTERS)->features,
                         FEATURE_EMITTERS);
        assert_ptr_equal(cpu_kernel_fit(whole, FEATURE_AOV), whole);
    }
}

static void render(struct session *s, uint32_t more_features, float *rgb)
{
    struct render_job job = {.host = &s->world,
                             .crop = {0, 0, WIDTH, HEIGHT},
                             .limits.spp = SPP};
    struct error err;

    check_or_say(world_lend(&s->world, &s->scene, &s->edit.now.view, 1,
                            &job.world, &err),
                 err.text);
    job.world.settings.features |= more_features;
    check_or_say(render_start(s->render, &job, &err), err.text);
    assert_true(render_wait(s->render, 60000));
    film_linear(render_film(s->render), rgb);
}

/* Adds the kernel to the builds and returns true, unless it is already
 * there. */
static bool is_new(const struct cpu_kernel *p, const struct cpu_kernel **builds,
                   int *count)
{
    for (int i = 0; i < *count; i++)
        if (builds[i] == p)
            return false;
    assert_true(*count < BUILDS_MAX);
    builds[(*count)++] = p;
    return true;
}

/* Lists all builds of an instruction set. Returns their number. */
static int list_builds(const struct cpu_kernel *whole,
                       const struct cpu_kernel **builds)
{
    int count = 0;

    for (uint32_t features = 0; features <= FEATURES_ALL; features++)
        is_new(cpu_kernel_fit(whole, features), builds, &count);
    return count;
}

/* Renders the scene with the build of all features and with each other possible
 * build. Returns the number of those. */
static int compare_builds(const char *scene, const struct cpu_kernel *whole,
                          const struct cpu_kernel **builds, int build_count)
{
    static float want[3 * WIDTH * HEIGHT], got[3 * WIDTH * HEIGHT];
    struct options o = {.scene_path = scene,
                        .max_bounces = -1,
                        .width_px = WIDTH,
                        .height_px = HEIGHT,
                        .paths = whole};
    struct session s;
    struct error err;
    uint32_t features;
    int count = 0;

    check_or_say(session_open(&s, &o, clock_ns(), &err), err.text);
    features = world_features(&s.world);
    render(&s, FEATURES_ALL & ~(uint32_t)FEATURE_COVERAGE, want);
    for (int i = 0; i < build_count; i++) {
        if (builds[i] == whole || (features & ~builds[i]->features) != 0)
            continue;
        render(&s, builds[i]->features, got);
        assert_memory_equal(want, got, sizeof want);
        count++;
    }
    session_close(&s);
    return count;
}

static void builds_give_the_same_bits(void **state)
{
    const struct cpu_kernel *whole, *builds[BUILDS_MAX];

    (void)state;
    for (int i = 0; (whole = cpu_kernel_at(i)) != NULL; i++) {
        int count = list_builds(whole, builds);

        for (size_t k = 0; k < sizeof scenes / sizeof scenes[0]; k++)
            assert_true(compare_builds(scenes[k], whole, builds, count) > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chosen_builds_have_the_needed_features),
        cmocka_unit_test(builds_give_the_same_bits),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
