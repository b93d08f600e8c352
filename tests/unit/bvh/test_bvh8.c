// SPDX-License-Identifier: MIT
/* This file is built for several instruction sets; ISA is the name of the
 * set. */
#include "render/cpu_dispatch.h"
#include "world/bvh/ray_queries.h"

#include "tests/unit/trees.h"

#ifndef ISA
#define ISA "plain"
#endif

static void machine_without_the_instructions_skips(void **state)
{
    (void)state;
    skip();
}

/* Says whether rays from one point through a row of points are a group. */
static bool is_group(uint32_t count, float left, float width)
{
    struct mesh m = {0};
    struct ray rays[GROUP];
    struct hit hits[GROUP] = {{0}};
    bool taken;

    mesh_add_box(&m, v3(-1, -1, -1), v3(1, 1, 1), 0);
    mesh_finish(&m);
    for (uint32_t k = 0; k < count; k++) {
        float x = left + width * (float)k / (GROUP - 1);

        rays[k] =
            (struct ray){{0, 0, 0}, v3_unit(v3(x, 0.3f, 1)), FLOAT_MAX, 0, 0};
    }
    taken = packet_closest(&m.world, rays, count, hits);
    for (uint32_t k = 0; taken && k < count; k++)
        check_close(hits[k].t * rays[k].d.z, 1, 1e-6);
    mesh_free(&m);
    return taken;
}

static void only_similar_rays_are_a_group(void **state)
{
    (void)state;
    assert_true(is_group(GROUP, 0.2f, 0.01f));
    assert_true(is_group(GROUP, -0.2f, 0.01f));
    assert_true(is_group(GROUP / 2, 0.2f, 0.01f));
    assert_false(is_group(1, 0.2f, 0.01f));
    assert_false(is_group(GROUP, -0.005f, 0.01f));
    assert_false(is_group(GROUP, 0.995f, 0.01f));
    assert_false(is_group(GROUP, 0.2f, 0.1f));
}

int main(void)
{
    const struct CMUnitTest groups[] = {
        cmocka_unit_test(only_similar_rays_are_a_group),
    };
    const struct CMUnitTest none[] = {
        cmocka_unit_test(machine_without_the_instructions_skips),
    };
    struct error err;

    return cpu_kernel_named(ISA, &err) != NULL
               ? run_trees() + cmocka_run_group_tests(groups, NULL, NULL)
               : cmocka_run_group_tests(none, NULL, NULL);
}
