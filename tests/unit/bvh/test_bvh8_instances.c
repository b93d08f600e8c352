// SPDX-License-Identifier: MIT
#include "render/cpu_dispatch.h"
#include "world/bvh/ray_queries.h"

#include "tests/unit/instance_rays.h"

#define SAMPLES 20000

/* A room with a lamp, a mesh with vertex normals, of glossy metal, and one that
 * glows. */
static const char materials[] = "newmtl lamp\nKe 5 5 4\n"
                                "newmtl metal\nKd .9 .7 .5\nPm 1\nPr .4\n"
                                "newmtl glow\nKe 9 2 2\n";
static const char room[] =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 -1 1\nv -1 -1 1\n"
    "v -.3 1 -.3\nv .3 1 -.3\nv .3 1 .3\nv -.3 1 .3\n"
    "f 1 2 3 4\nusemtl lamp\nf 5 6 7 8\no mesh\nusemtl metal\n"
    "v 0 .4 0\nv -.4 -.2 -.3\nv .4 -.2 -.3\nv 0 -.2 .4\n"
    "vn 0 1 0\nvn -.8 -.2 -.5\nvn .8 -.2 -.5\nvn 0 -.2 .9\n"
    "f 9//1 11//3 10//2\nf 9//1 10//2 12//4\nf 9//1 12//4 11//3\n"
    "f 10//2 11//3 12//4\n"
    "o mesh2\nusemtl glow\n"
    "v 0 0 0\nv .4 0 0\nv .4 .4 .04\nv 0 .4 0\nv .8 .4 .4\n"
    "f 13 14 15 16\nf 14 17 15\n";

/* Compares samples of both worlds with this kernel. */
static void compare_samples(const struct cpu_kernel *kernel,
                            const struct instance_test *t,
                            const struct world *copies)
{
    uint64_t features = t->w.settings.features;
    const struct cpu_kernel *full = cpu_kernel_fit(kernel, features);
    const struct cpu_kernel *part =
        cpu_kernel_fit(kernel, copies->settings.features);
    double light = 0;

    for (uint32_t i = 0; i < SAMPLES; i++) {
        struct sample_id id = {i % 320u, i / 320u * 3u % 240u, i % 16u};
        struct path_sample a = {.rays = 0}, b = {.rays = 0};
        struct first_surface surface;

        full->samples(&t->w, &id, 1, &a, &surface, NULL);
        part->samples(copies, &id, 1, &b, &surface, NULL);
        assert_memory_equal(&a, &b, sizeof a);
        light += (double)a.radiance.x;
    }
    assert_true(light > SAMPLES * 1e-3);
}

static void samples_are_those_of_copies(void **state)
{
    struct instance_test t = {.positions = NULL};
    struct lights lights = {.lights = NULL};
    struct bvh8 tree = {0};
    struct world copies;
    const struct cpu_kernel *kernel;
    uint64_t seed = 12;
    struct error err;

    (void)state;
    instanced_parse(&t.scene, materials, room);
    for (int k = 0; k < 16; k++) {
        struct affine a = random_affine(&seed, 0.8, k % 2 == 0);

        instanced_place(&t.scene, k % 4 == 0 ? 1 : 0, &a);
    }
    instance_test_finish(&t);
    assert_true(t.w.settings.light_count > 8);
    assert_true(lights_build(&lights, &t.copies, &err));
    lights_lend(&lights, &t.copies);
    assert_true(bvh8_build(&tree, &t.copies, NULL, &err));
    copies = t.copies;
    bvh8_lend(&tree, &copies);
    for (int i = 0; (kernel = cpu_kernel_at(i)) != NULL; i++)
        compare_samples(kernel, &t, &copies);
    bvh8_free(&tree);
    lights_free(&lights);
    instance_test_free(&t);
}

int main(void)
{
    const struct CMUnitTest pictures[] = {
        cmocka_unit_test(samples_are_those_of_copies),
    };

    return run_instance_rays() + cmocka_run_group_tests(pictures, NULL, NULL);
}
