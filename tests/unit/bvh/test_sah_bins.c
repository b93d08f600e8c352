// SPDX-License-Identifier: MIT
#include "world/bvh/sah_bins.h"

#include <math.h>

#include "tests/unit/brute.h"
#include "tests/unit/check.h"

#define BOXES 3000

/* Every third box is large; every fifth has the place of the previous one. */
static void random_boxes(struct box *boxes, uint32_t count, uint64_t seed)
{
    for (uint32_t i = 0; i < count; i++) {
        struct vec3 p = random_point(&seed, 1.0f);
        struct vec3 q =
            v3_add(p, random_point(&seed, i % 3 == 0 ? 0.5f : 0.02f));
        struct box a = box_of_point(p), b = box_of_point(q);

        boxes[i] = box_empty();
        box_join(&boxes[i], &a);
        box_join(&boxes[i], &b);
        if (i % 5 == 4)
            boxes[i] = boxes[i - 1];
        box_set_tri(&boxes[i], i);
    }
}

static void fill(struct bins *bins, const struct box *boxes, uint32_t count)
{
    struct extent all = extent_of(boxes, count);

    bins_clear(bins, count, &all.centers);
    bins_add(bins, boxes, count, 1);
}

/* Returns the bin of the box on an axis of this many bins. */
static uint32_t bin_of(const struct box *box, const struct box *centers,
                       int axis, uint32_t bin_count)
{
    float first = centers->planes[axis];
    float length = -centers->planes[4 + axis] - first;
    float center = box->planes[axis] - box->planes[4 + axis];
    uint32_t bin = (uint32_t)((center - first) * ((float)bin_count / length));

    return bin >= bin_count ? bin_count - 1 : bin;
}

/* Returns half the surface of the boxes in bins [lo, hi) of an axis times their
 * blocks, computed from the corners in double. */
static double cost_of(const struct box *boxes, uint32_t count,
                      const struct box *centers, int axis, uint32_t bin_count,
                      uint32_t lo, uint32_t hi, uint32_t block)
{
    double low[3] = {9, 9, 9}, high[3] = {-9, -9, -9};
    uint32_t n = 0;

    for (uint32_t i = 0; i < count; i++) {
        const float *p = boxes[i].planes;
        uint32_t bin = bin_of(&boxes[i], centers, axis, bin_count);

        if (bin < lo || bin >= hi)
            continue;
        n++;
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], p[k]);
            high[k] = fmax(high[k], -p[4 + k]);
        }
    }
    double x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return n == 0 ? INFINITY
                  : (x * y + y * z + z * x) * ((n + block - 1) / block);
}

/* Checks that each box is on its side of the split, once. */
static void check_sides(const struct split *s, const struct box *boxes,
                        uint32_t count, const struct box *centers)
{
    static struct box sides[BOXES];
    static bool seen[BOXES];
    uint32_t lefts = split_part(s, boxes, count, sides, sides + count);

    assert_int_equal(split_count(s, boxes, count), count - lefts);
    assert_in_range(lefts, 1, count - 1);
    memset(seen, 0, sizeof seen);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t bin = bin_of(&sides[i], centers, s->axis, s->binning.count);
        uint32_t tri = box_tri(&sides[i]);

        assert_int_equal(bin >= s->bin, i >= lefts);
        assert_false(seen[tri]);
        seen[tri] = true;
    }
}

static void the_cheapest_plane_is_found(void **state)
{
    static struct box boxes[BOXES];
    static const uint32_t counts[] = {2, 3, 4, 5, 9, 17, 60, 65, 500, BOXES};

    (void)state;
    for (uint32_t k = 0; k < 2 * sizeof counts / sizeof counts[0]; k++) {
        uint32_t count = counts[k / 2], bits = k % 2 * 2;
        double least = INFINITY;
        struct extent all;
        struct bins bins;
        struct split s;

        random_boxes(boxes, count, k);
        all = extent_of(boxes, count);
        fill(&bins, boxes, count);
        s = bins_split(&bins, bits);
        for (int axis = 0; axis < 3; axis++)
            for (uint32_t bin = 1; bin < s.binning.count; bin++)
                least =
                    fmin(least, cost_of(boxes, count, &all.centers, axis,
                                        s.binning.count, 0, bin, 1u << bits) +
                                    cost_of(boxes, count, &all.centers, axis,
                                            s.binning.count, bin, SPLIT_BINS,
                                            1u << bits));
        check_close(s.cost / least, 1, 1e-5);
        check_sides(&s, boxes, count, &all.centers);
    }
}

static void extents_hold_all_boxes_and_no_more(void **state)
{
    static struct box boxes[BOXES];

    (void)state;
    for (uint32_t count = 1; count <= BOXES; count += 1 + count / 2) {
        struct extent all;

        random_boxes(boxes, count, count);
        all = extent_of(boxes, count);
        for (int axis = 0; axis < 3; axis++) {
            float least[4] = {9, 9, 9, 9};

            for (uint32_t i = 0; i < count; i++) {
                float lo = boxes[i].planes[axis];
                float hi = boxes[i].planes[4 + axis];

                least[0] = fminf(least[0], lo);
                least[1] = fminf(least[1], hi);
                least[2] = fminf(least[2], lo - hi);
                least[3] = fminf(least[3], hi - lo);
            }
            assert_true(all.bounds.planes[axis] == least[0]);
            assert_true(all.bounds.planes[4 + axis] == least[1]);
            assert_true(all.centers.planes[axis] == least[2]);
            assert_true(all.centers.planes[4 + axis] == least[3]);
        }
    }
}

static void strides_leave_out_boxes(void **state)
{
    static struct box boxes[BOXES], some[BOXES];
    struct bins of_all, of_some;
    struct extent all;
    uint32_t count = 0;

    (void)state;
    random_boxes(boxes, BOXES, 7);
    for (uint32_t i = 0; i < BOXES; i += 7)
        some[count++] = boxes[i];
    all = extent_of(boxes, BOXES);
    bins_clear(&of_all, BOXES, &all.centers);
    bins_clear(&of_some, BOXES, &all.centers);
    bins_add(&of_all, boxes, BOXES, 7);
    bins_add(&of_some, some, count, 1);
    assert_int_equal(of_all.box_count, count);
    for (int axis = 0; axis < 3; axis++)
        for (uint32_t i = 0; i < of_all.binning.count; i++) {
            const struct bin *a = &of_all.bins[i], *b = &of_some.bins[i];

            assert_int_equal(a->counts[axis], b->counts[axis]);
            assert_memory_equal(&a->boxes[axis], &b->boxes[axis],
                                3 * sizeof(float));
        }
}

/* Boxes with equal centres have no plane, even where bins would be smaller than
 * any float. */
static void equal_centres_have_no_plane(void **state)
{
    struct box boxes[8];
    struct bins bins;

    (void)state;
    for (int k = 0; k < 2; k++) {
        for (uint32_t i = 0; i < 8; i++)
            boxes[i] = box_of_point(
                v3(0.5f, k == 0 ? 0.25f : (float)i * 1e-44f, -0.5f));
        fill(&bins, boxes, 8);
        assert_int_equal(bins_split(&bins, 0).axis, -1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_cheapest_plane_is_found),
        cmocka_unit_test(extents_hold_all_boxes_and_no_more),
        cmocka_unit_test(strides_leave_out_boxes),
        cmocka_unit_test(equal_centres_have_no_plane),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
