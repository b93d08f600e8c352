// SPDX-License-Identifier: MIT
#include "world/bvh/ray_queries.h"

#include "tests/unit/many.h"

static void threads_build_the_same_tree(void **state)
{
    struct mesh m = {0};
    struct error err;

    (void)state;
    mesh_add_many(&m, MANY, 5);
    mesh_finish(&m);
    for (int threads = 1; threads <= 7; threads += threads == 2 ? 5 : 1) {
        struct pool *pool = pool_create(threads, &err);
        struct bvh8 other = {0};

        assert_true(bvh8_build(&other, &m.world, pool, &err));
        assert_int_equal(m.tree.node_count, other.node_count);
        assert_int_equal(m.tree.block_count, other.block_count);
        assert_memory_equal(m.tree.nodes, other.nodes,
                            other.node_count * sizeof *other.nodes);
        assert_memory_equal(m.tree.blocks, other.blocks,
                            other.block_count * sizeof *other.blocks);
        bvh8_free(&other);
        pool_destroy(pool);
    }
    mesh_free(&m);
}

struct tree_check {
    const struct mesh *mesh;
    bool *tris;
    double cost; /* in units of the root's area */
};

static struct vec3 plane(const struct bvh8_node *n, int side, uint32_t i)
{
    return v3(n->planes[0][side][i], n->planes[1][side][i],
              n->planes[2][side][i]);
}

static double area(struct vec3 lo, struct vec3 hi)
{
    double x = hi.x - lo.x, y = hi.y - lo.y, z = hi.z - lo.z;

    return x * y + y * z + z * x;
}

/* Each triangle is in its own box and in those of all ancestors. */
static void visit_leaf(struct tree_check *s, uint32_t child, struct vec3 lo,
                       struct vec3 hi)
{
    const struct tri_block *block = bvh8_block_at(s->mesh->tree.nodes, child);
    uint32_t count = (child & BVH8_MORE) + 1;

    s->cost += BVH8_BLOCK_COST * count * area(lo, hi);
    for (uint32_t i = 0; i < count * BVH8_BLOCK_TRIS; i++) {
        uint32_t tri = block[i / BVH8_BLOCK_TRIS].tri[i % BVH8_BLOCK_TRIS];

        if (tri == NO_INDEX)
            continue;
        assert_false(s->tris[tri]);
        s->tris[tri] = true;
        assert_true(box_holds(lo, hi, &s->mesh->positions[3 * tri]));
    }
}

static void visit_node(struct tree_check *s, const struct bvh8_node *n,
                       struct vec3 lo, struct vec3 hi)
{
    s->cost += area(lo, hi);
    for (uint32_t i = 0; i < BVH8_CHILDREN; i++) {
        struct vec3 low = plane(n, 0, i), high = plane(n, 1, i);

        if (low.x > high.x || low.x == INFINITY)
            continue;
        assert_true(v3_is_between(low, lo, hi) && v3_is_between(high, lo, hi));
        if ((n->child[i] & BVH8_LEAF) != 0)
            visit_leaf(s, n->child[i], low, high);
        else
            visit_node(s, bvh8_node_at(s->mesh->tree.nodes, n->child[i]), low,
                       high);
    }
}

/* Visits the whole tree and returns its cost. */
static double cost_of(const struct mesh *m, const struct node *root)
{
    struct tree_check s = {m, calloc(m->tri_count, sizeof *s.tris), 0};

    visit_node(&s, m->tree.nodes, root->lo, root->hi);
    for (uint32_t i = 0; i < m->tri_count; i++)
        assert_true(s.tris[i]);
    free(s.tris);
    return s.cost;
}

/* Builds the binary tree from which the wide tree is made. */
static struct bvh binary_of(const struct mesh *m)
{
    struct bvh bvh = {0};
    struct error err;

    assert_true(bvh_build_nodes(&bvh, &m->world, &bvh8_leaves, NULL, &err));
    return bvh;
}

static void boxes_enclose_their_subtrees(void **state)
{
    struct mesh m = {0};
    struct bvh bvh;

    (void)state;
    mesh_add_many(&m, MANY, 6);
    mesh_finish(&m);
    bvh = binary_of(&m);
    assert_true(cost_of(&m, &bvh.nodes[0]) > 0);
    bvh_free(&bvh);
    mesh_free(&m);
}

static uint32_t tris_below(const struct bvh *bvh, uint32_t node)
{
    const struct node *n = &bvh->nodes[node];

    return n->count != 0 ? n->count
                         : tris_below(bvh, node + 1) + tris_below(bvh, n->next);
}

static double least_cost(const struct bvh *bvh, uint32_t node, bool is_root,
                         double *known);

/* Returns the least cost of all sets of at most eight children: some nodes of
 * `cut`, from `at` on, are replaced by their children. */
static double least_of_cuts(const struct bvh *bvh, uint32_t *cut,
                            uint32_t count, uint32_t at, double *known)
{
    double least = 0;

    for (uint32_t i = 0; i < count; i++)
        least += least_cost(bvh, cut[i], false, known);
    for (uint32_t i = at; i < count && count < BVH8_CHILDREN; i++) {
        const struct node *n = &bvh->nodes[cut[i]];
        uint32_t opened = cut[i];

        if (n->count != 0)
            continue;
        cut[i] = opened + 1;
        cut[count] = n->next;
        least = fmin(least, least_of_cuts(bvh, cut, count + 1, i, known));
        cut[i] = opened;
    }
    return least;
}

/* Returns the least cost of the node as a leaf, or with any set of children. */
static double least_cost(const struct bvh *bvh, uint32_t node, bool is_root,
                         double *known)
{
    const struct node *n = &bvh->nodes[node];
    uint32_t count = tris_below(bvh, node);
    uint32_t cut[BVH8_CHILDREN] = {node + 1, n->next};
    double least = INFINITY;

    if (!is_root && known[node] > 0)
        return known[node];
    if (count <= (BVH8_MORE + 1) * BVH8_BLOCK_TRIS)
        least = BVH8_BLOCK_COST * area(n->lo, n->hi) *
                ((count + BVH8_BLOCK_TRIS - 1) / BVH8_BLOCK_TRIS);
    if (n->count == 0)
        least = fmin(least,
                     area(n->lo, n->hi) + least_of_cuts(bvh, cut, 2, 0, known));
    known[node] = least;
    return least;
}

/* Compares with all ways to make some small trees wide. */
static void no_other_children_cost_less(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        struct mesh m = {0};
        struct bvh bvh;
        double *known;

        mesh_add_many(&m, 90, seed);
        mesh_finish(&m);
        bvh = binary_of(&m);
        known = calloc(bvh.node_count, sizeof *known);
        check_close(cost_of(&m, &bvh.nodes[0]) /
                        least_cost(&bvh, 0, true, known),
                    1, 1e-5);
        free(known);
        bvh_free(&bvh);
        mesh_free(&m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_build_the_same_tree),
        cmocka_unit_test(boxes_enclose_their_subtrees),
        cmocka_unit_test(no_other_children_cost_less),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
