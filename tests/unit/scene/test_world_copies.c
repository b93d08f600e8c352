// SPDX-License-Identifier: MIT
/*
 * test_world_copies.c - the tree of faces in one place, before and after an
 * edit that lets rays through them
 */
#include "tests/unit/instanced.h"
#include "world/world.h"
#include "world/world_materials.h"

#define COPIES 40

static void make(struct scene *s, struct host_world *host)
{
    char text[64 + 8 * COPIES] = "usemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
    struct warnings report = {0};
    struct error err;

    *s = (struct scene){.path = NULL};
    for (int i = 0; i < COPIES; i++)
        strcat(text, "f 1 2 3\n");
    instanced_parse(s, "newmtl m\nKd .5 .5 .5\n", text);
    check_or_say(scene_finish(s, &report, &err) &&
                     world_init(host, s, 1, &report, &err),
                 err.text);
    warnings_free(&report);
}

static bool tree_lacks_copies(struct host_world *host, const struct scene *s)
{
    struct world world = world_arrays(host, s);
    struct error err;

    assert_true(world_ensure_tree(host, &world, NULL, &err));
    return world_tree(host)->lacks_copies;
}

/* Sets the opacity of the last material. */
static void set_opacity(struct host_world *host, const struct scene *s,
                        double opacity)
{
    uint32_t assigned[4] = {NO_INDEX, NO_INDEX, NO_INDEX, NO_INDEX};
    struct material_values sources[4];
    struct error err;

    assert_in_range(s->material_count, 1, 4);
    assert_in_range(s->object_count, 0, 4);
    for (uint32_t i = 0; i < s->material_count; i++)
        sources[i] = s->material_origins[i].source;
    sources[s->material_count - 1].opacity = (struct mtl_number){opacity, 1};
    check_or_say(world_set_materials(host, s, s->material_count, sources,
                                     assigned, &err),
                 err.text);
}

static void edits_that_let_rays_through_renew_the_tree(void **state)
{
    struct host_world host;
    struct scene s;
    uint64_t shape;

    (void)state;
    make(&s, &host);
    assert_true(tree_lacks_copies(&host, &s));
    shape = host.versions[WORLD_SHAPE];
    set_opacity(&host, &s, 1);
    assert_int_equal(host.versions[WORLD_SHAPE], shape);
    assert_non_null(world_tree(&host));
    set_opacity(&host, &s, 0.5);
    assert_int_not_equal(host.versions[WORLD_SHAPE], shape);
    assert_null(world_tree(&host));
    assert_false(tree_lacks_copies(&host, &s));
    /* that tree is right for every material */
    shape = host.versions[WORLD_SHAPE];
    set_opacity(&host, &s, 1);
    set_opacity(&host, &s, 0.25);
    assert_int_equal(host.versions[WORLD_SHAPE], shape);
    world_free(&host);
    scene_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edits_that_let_rays_through_renew_the_tree),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
