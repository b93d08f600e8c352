// SPDX-License-Identifier: MIT
#include "world/bvh/sah_splitter.h"

#include "tests/unit/check.h"
#include "tests/unit/many.h"

#include <stdlib.h>

/* Options that make leaves of one triangle only. */
static const struct bvh_leaves single = {0, 0, 1.0f, 1};

/* The splits of a mesh, and a check of the ranges' extents. */
struct splits {
    struct splitter splitter;
    uint32_t together; /* ranges larger than this are split by all threads */
    uint32_t *tris;    /* numbers in the order of the leaves */
    uint32_t tri_count;
};

static void check_extent(const struct splitter *s, const struct range *r)
{
    const struct box *boxes = s->buffers[r->buffer] + r->first;
    struct extent all = extent_of(boxes, r->count);

    assert_memory_equal(all.bounds.planes, r->extent.bounds.planes,
                        3 * sizeof(float));
    assert_memory_equal(all.bounds.planes + 4, r->extent.bounds.planes + 4,
                        3 * sizeof(float));
    assert_memory_equal(all.centers.planes, r->extent.centers.planes,
                        3 * sizeof(float));
    assert_memory_equal(all.centers.planes + 4, r->extent.centers.planes + 4,
                        3 * sizeof(float));
}

static void split_all(struct splits *p, struct range *r)
{
    struct range sides[2];

    check_extent(&p->splitter, r);
    if (r->count > p->together) {
        splitter_split_together(&p->splitter, r, sides);
    } else if (!splitter_split(&p->splitter, 0, r, sides)) {
        assert_int_equal(r->count, 1);
        p->tris[p->tri_count++] =
            box_tri(&p->splitter.buffers[r->buffer][r->first]);
        return;
    }
    assert_int_equal(sides[0].first, r->first);
    assert_int_equal(sides[1].first, r->first + sides[0].count);
    assert_int_equal(sides[0].count + sides[1].count, r->count);
    for (int i = 0; i < 2; i++) {
        assert_in_range(sides[i].count, 1, r->count - 1);
        split_all(p, &sides[i]);
    }
}

/* Returns the order of triangles, for free(). */
static uint32_t *order_by(const struct world *w, int threads, uint32_t together)
{
    struct error err;
    struct pool *pool = threads > 0 ? pool_create(threads, &err) : NULL;
    struct splits p = {.together = together};
    struct range all;

    p.tris = calloc(w->settings.tri_count, sizeof *p.tris);
    assert_true(splitter_init(&p.splitter, w, &single, pool));
    all = splitter_all(&p.splitter);
    split_all(&p, &all);
    assert_int_equal(p.tri_count, w->settings.tri_count);
    splitter_free(&p.splitter);
    pool_destroy(pool);
    return p.tris;
}

static void threads_make_the_same_splits(void **state)
{
    struct mesh m = {0};
    uint32_t *one;
    bool *seen = calloc(MANY, sizeof *seen);

    (void)state;
    mesh_add_many(&m, MANY, 6);
    mesh_finish(&m);
    one = order_by(&m.world, 0, 9000);
    for (uint32_t i = 0; i < MANY; i++) {
        assert_false(seen[one[i]]);
        seen[one[i]] = true;
    }
    for (int threads = 1; threads <= 5; threads += 2) {
        uint32_t *other = order_by(&m.world, threads, 9000);

        assert_memory_equal(one, other, MANY * sizeof *one);
        free(other);
    }
    free(seen);
    free(one);
    mesh_free(&m);
}

#define CLUSTER_SIZE 20000

static void add_small(struct mesh *m, float x)
{
    mesh_add(m, v3(x, 0, 0), v3(x + 0.25f, 0, 0), v3(x, 0.25f, 0), 0);
}

/* A single outlier among many equal triangles is separated from them. */
static void outliers_are_separated(void **state)
{
    struct mesh m = {0};
    struct splitter s;

    (void)state;
    for (uint32_t i = 0; i < CLUSTER_SIZE; i++)
        add_small(&m, i == CLUSTER_SIZE / 3 ? 5.0f : 0.0f);
    mesh_finish(&m);
    assert_true(splitter_init(&s, &m.world, &single, NULL));
    for (int together = 0; together < 2; together++) {
        struct range all = splitter_all(&s), sides[2];

        if (together)
            splitter_split_together(&s, &all, sides);
        else
            assert_true(splitter_split(&s, 0, &all, sides));
        assert_int_equal(sides[1].count, 1);
        assert_int_equal(box_tri(&s.buffers[1][sides[1].first]),
                         CLUSTER_SIZE / 3);
    }
    splitter_free(&s);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_make_the_same_splits),
        cmocka_unit_test(outliers_are_separated),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
