// SPDX-License-Identifier: MIT
#include "world/bvh/ray_queries.h"

#include <string.h>

#include "tests/unit/brute.h"
#include "tests/unit/many.h"

static struct bvh build_by(const struct world *w, int thread_count)
{
    struct bvh bvh = {0};
    struct error err;
    struct pool *pool =
        thread_count > 0 ? pool_create(thread_count, &err) : NULL;

    assert_true(bvh_build_nodes(&bvh, w, &bvh8_leaves, pool, &err));
    pool_destroy(pool);
    return bvh;
}

static void threads_build_the_same_tree(void **state)
{
    struct mesh m = {0};
    struct bvh one;

    (void)state;
    mesh_add_many(&m, MANY, 3);
    mesh_finish(&m);
    one = build_by(&m.world, 0);
    for (int threads = 1; threads <= 7; threads += threads == 2 ? 5 : 1) {
        struct bvh other = build_by(&m.world, threads);

        assert_int_equal(one.node_count, other.node_count);
        assert_int_equal(one.depth, other.depth);
        assert_memory_equal(one.nodes, other.nodes,
                            one.node_count * sizeof *one.nodes);
        assert_memory_equal(one.tris, other.tris,
                            one.tri_count * sizeof *one.tris);
        bvh_free(&other);
    }
    bvh_free(&one);
    mesh_free(&m);
}

struct tree_check {
    const struct mesh *mesh;
    const struct bvh *bvh;
    bool *tris;
    uint32_t nodes, depth;
};

static void visit_leaf(struct tree_check *s, const struct node *n)
{
    for (uint32_t i = n->next; i < n->next + n->count; i++) {
        uint32_t tri = s->bvh->tris[i];

        assert_false(s->tris[tri]);
        s->tris[tri] = true;
        assert_true(box_holds(n->lo, n->hi, &s->mesh->positions[3 * tri]));
    }
}

static void visit_node(struct tree_check *s, uint32_t index, uint32_t depth)
{
    const struct node *n = &s->bvh->nodes[index];
    uint32_t children[2] = {index + 1, n->next};

    s->nodes++;
    s->depth = depth > s->depth ? depth : s->depth;
    if (n->count != 0) {
        visit_leaf(s, n);
        return;
    }
    for (int i = 0; i < 2; i++) {
        const struct node *child = &s->bvh->nodes[children[i]];

        assert_true(v3_is_between(child->lo, n->lo, n->hi) &&
                    v3_is_between(child->hi, n->lo, n->hi));
        visit_node(s, children[i], depth + 1);
    }
}

static void boxes_enclose_their_subtrees(void **state)
{
    struct mesh m = {0};
    struct tree_check s = {.mesh = &m, .tris = calloc(MANY, sizeof *s.tris)};
    struct bvh bvh;

    (void)state;
    mesh_add_many(&m, MANY, 4);
    mesh_finish(&m);
    bvh = build_by(&m.world, 0);
    s.bvh = &bvh;
    visit_node(&s, 0, 0);
    assert_int_equal(s.nodes, bvh.node_count);
    assert_in_range(bvh.depth, s.depth, TRAVERSE_STACK - 1);
    for (uint32_t i = 0; i < MANY; i++)
        assert_true(s.tris[i]);
    free(s.tris);
    bvh_free(&bvh);
    mesh_free(&m);
}

/* Adds two squares of two triangles each, side by side. */
static void add_domino(struct mesh *m, float x, float size)
{
    for (int i = 0; i < 2; i++) {
        float left = x + (float)i * size, right = left + size;

        mesh_add_quad(m, v3(left, 0, 0), v3(right, 0, 0), v3(right, size, 0),
                      v3(left, size, 0), 0);
    }
}

/* Two separate leaves for a domino cost as much as one leaf block of four, and
 * half of two blocks of two. */
static void large_triangles_are_in_separate_leaves(void **state)
{
    const struct bvh_leaves leaves = {2, 1, 4.0f, 16};
    uint32_t of_two = 0, of_four = 0;
    struct mesh m = {0};
    struct bvh bvh = {0};
    struct error err;

    (void)state;
    add_domino(&m, 0, 1);
    add_domino(&m, 4, 0.01f);
    mesh_finish(&m);
    assert_true(bvh_build_nodes(&bvh, &m.world, &leaves, NULL, &err));
    for (uint32_t i = 0; i < bvh.node_count; i++) {
        of_two += bvh.nodes[i].count == 2;
        of_four += bvh.nodes[i].count == 4;
    }
    assert_int_equal(bvh.node_count, 5);
    assert_int_equal(of_two, 2);
    assert_int_equal(of_four, 1);
    bvh_free(&bvh);
    mesh_free(&m);
}

#define COPIES 5000

/* Adds copies of a square's triangles, of both windings, among others. */
static void add_copies(struct mesh *m)
{
    const struct vec3 a = v3(-0.5f, -0.5f, 0.1f), b = v3(0.5f, -0.5f, 0),
                      c = v3(0.5f, 0.5f, -0.1f), d = v3(-0.5f, 0.5f, 0);

    mesh_add_many(m, 1000, 5);
    for (int i = 0; i < COPIES; i++) {
        mesh_add(m, a, i % 3 ? b : c, i % 3 ? c : b, 0);
        mesh_add(m, a, c, d, 1);
    }
    for (int i = 0; i < MESH_MATERIALS; i++)
        m->materials[i] = material_default();
}

static void check_hits(const struct mesh *m)
{
    uint64_t seed = 3;

    for (int i = 0; i < 300; i++) {
        struct ray r = {.o = random_point(&seed, 2), .t_max = FLOAT_MAX};
        struct hit h, brute;
        bool is_hit;

        r.d = v3_unit(v3_sub(random_point(&seed, 0.5f), r.o));
        is_hit = brute_force(&m->world, r, &brute);
        assert_int_equal(hit_closest(&m->world, r, &h), is_hit);
        assert_int_equal(h.tri, brute.tri);
        assert_true(!is_hit || memcmp(&h, &brute, sizeof h) == 0);
    }
}

/* A ray hits the first of them, so that others are not needed. */
static void copies_have_one_leaf(void **state)
{
    struct mesh m = {0};
    struct bvh bvh;

    (void)state;
    add_copies(&m);
    mesh_finish(&m);
    bvh = build_by(&m.world, 0);
    assert_int_equal(bvh.tri_count, 1000 + 2);
    assert_true(m.tree.lacks_copies);
    check_hits(&m);
    bvh_free(&bvh);
    mesh_free(&m);
}

/* A surface that lets rays through shows those behind it. */
static void copies_that_let_rays_through_stay(void **state)
{
    struct mesh m = {0};
    struct bvh bvh;

    (void)state;
    add_copies(&m);
    m.materials[1].opacity = 0.9f;
    mesh_finish(&m);
    bvh = build_by(&m.world, 0);
    assert_int_equal(bvh.tri_count, 1000 + 2 * COPIES);
    assert_false(m.tree.lacks_copies);
    bvh_free(&bvh);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_build_the_same_tree),
        cmocka_unit_test(boxes_enclose_their_subtrees),
        cmocka_unit_test(copies_have_one_leaf),
        cmocka_unit_test(copies_that_let_rays_through_stay),
        cmocka_unit_test(large_triangles_are_in_separate_leaves),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
