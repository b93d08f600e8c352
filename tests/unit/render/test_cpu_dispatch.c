// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "render/cpu_dispatch.h"
#include "session/session.h"
#include "world/world.h"

static const char *const scenes[] = {
    "scenes/cornell.obj",  "scenes/materials.obj", "scenes/glass_mirror.obj",
    "scenes/interior.obj", "scenes/skylit.obj",    "scenes/lights200.obj",
};

#define WIDTH  64
#define HEIGHT 36
#define SPP    3

#define RANDOM_SETS 100000 /* sets of features that are asked for */

/* The chosen build can do what is asked, and no build with fewer features
 * could. Each build is the one chosen for exactly its own features, so none is
 * unused. */
static void chosen_builds_have_the_needed_features(void **state)
{
    const struct cpu_kernel *whole, *p;

    (void)state;
    srand(1);
    for (int i = 0; (whole = cpu_kernel_at(i)) != NULL; i++) {
        assert_int_equal(whole->features, FEATURES_ALL);
        for (int k = 0; k < RANDOM_SETS; k++) {
            uint64_t features = FEATURES_ALL;

            for (int n = k % 8; n > 0; n--) /* of few bits and of many */
                features &= (uint64_t)rand() << 24 ^ (uint64_t)rand();
            p = cpu_kernel_fit(whole, features);
            assert_int_equal(features & ~p->features, 0);
            assert_string_equal(p->name, whole->name);
        }
        for (int k = 0; (p = cpu_kernel_build(k)) != NULL; k++)
            if (strcmp(p->name, whole->name) == 0)
                assert_ptr_equal(cpu_kernel_fit(whole, p->features), p);
        assert_int_equal(cpu_kernel_fit(whole, FEATURE_EMITTERS)->features,
                         FEATURE_EMITTERS | FEATURE_RADIANCE_CELLS);
        assert_ptr_equal(cpu_kernel_fit(whole, FEATURE_AOV), whole);
    }
}

static void render(struct session *s, uint64_t more_features, float *rgb)
{
    struct render_job job = {.host = &s->engine.world,
                             .crop = {0, 0, WIDTH, HEIGHT},
                             .limits.spp = SPP};
    struct error err;

    check_or_say(world_lend(&s->engine.world, &s->engine.scene,
                            &s->edit.now.view, 1, &job.world, &err),
                 err.text);
    job.world.settings.features |= more_features;
    check_or_say(render_start(s->engine.render, &job, &err), err.text);
    assert_true(render_wait(s->engine.render, 60000));
    film_linear(render_film(s->engine.render), rgb);
}

/* Renders the scene with the build of all features and with each other possible
 * build. Returns the number of those. */
static int compare_builds(const char *scene, const struct cpu_kernel *whole)
{
    static float want[3 * WIDTH * HEIGHT], got[3 * WIDTH * HEIGHT];
    struct options o = {.scene_path = scene,
                        .max_bounces = -1,
                        .width_px = WIDTH,
                        .height_px = HEIGHT,
                        .paths = whole};
    const struct cpu_kernel *p;
    struct session s;
    struct error err;
    uint64_t features;
    int count = 0;

    check_or_say(session_open(&s, &o, clock_ns(), &err), err.text);
    features = world_features(&s.engine.world);
    render(&s, FEATURES_ALL & ~FEATURE_COVERAGE, want);
    for (int i = 0; (p = cpu_kernel_build(i)) != NULL; i++) {
        if (p == whole || strcmp(p->name, whole->name) != 0 ||
            (features & ~p->features) != 0)
            continue;
        render(&s, p->features, got);
        assert_memory_equal(want, got, sizeof want);
        count++;
    }
    session_close(&s);
    return count;
}

static void builds_give_the_same_bits(void **state)
{
    const struct cpu_kernel *whole;
    int count = 0;

    (void)state;
    for (int i = 0; (whole = cpu_kernel_at(i)) != NULL; i++)
        for (size_t k = 0; k < sizeof scenes / sizeof scenes[0]; k++)
            count += compare_builds(scenes[k], whole);
    assert_true(count > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chosen_builds_have_the_needed_features),
        cmocka_unit_test(builds_give_the_same_bits),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
