// SPDX-License-Identifier: MIT
#include "glim/split.h"

#include <math.h>

#include "brute.h"
#include "check.h"

#define BOXES 3000

/* Every third is large, every fifth has the place of the one before. */
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

static struct box centers_of(const struct box *boxes, uint32_t count)
{
    struct box centers = box_empty();

    for (uint32_t i = 0; i < count; i++) {
        struct box center = box_center(&boxes[i]);

        box_join(&centers, &center);
    }
    return centers;
}

static void fill(struct bins *bins, const struct box *boxes, uint32_t count)
{
    struct box centers = centers_of(boxes, count);

    bins_clear(bins, count, &centers);
    bins_add(bins, boxes, count);
}

/* Half the surface of what lies in [lo, hi) of the bins of an axis, times its
 * blocks; from the corners in double. */
static double cost_of(const struct box *boxes, uint32_t count,
                      const struct box *centers, int axis, uint32_t bin_count,
                      uint32_t lo, uint32_t hi, uint32_t block)
{
    double low[3] = {9, 9, 9}, high[3] = {-9, -9, -9};
    float first = centers->planes[axis];
    float length = -centers->planes[4 + axis] - first;
    uint32_t n = 0;

    for (uint32_t i = 0; i < count; i++) {
        const float *p = boxes[i].planes;
        float center = p[axis] - p[4 + axis];
        uint32_t bin =
            (uint32_t)((center - first) * ((float)bin_count / length));

        bin = bin >= bin_count ? bin_count - 1 : bin;
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

static void the_cheapest_plane_is_found(void **state)
{
    static struct box boxes[BOXES];
    static const uint32_t counts[] = {2, 3, 4, 5, 9, 17, 60, 65, 500, BOXES};

    (void)state;
    for (uint32_t k = 0; k < 2 * sizeof counts / sizeof counts[0]; k++) {
        uint32_t count = counts[k / 2], bits = k % 2 * 2;
        struct box centers, sides[2];
        struct bins bins;
        struct split s;
        double least = INFINITY;
        uint32_t rights = 0;

        random_boxes(boxes, count, k);
        centers = centers_of(boxes, count);
        fill(&bins, boxes, count);
        s = bins_split(&bins, count, bits, sides);
        for (int axis = 0; axis < 3; axis++)
            for (uint32_t bin = 1; bin < s.binning.count; bin++)
                least =
                    fmin(least, cost_of(boxes, count, &centers, axis,
                                        s.binning.count, 0, bin, 1u << bits) +
                                    cost_of(boxes, count, &centers, axis,
                                            s.binning.count, bin, SPLIT_BINS,
                                            1u << bits));
        check_close(s.cost / least, 1, 1e-5);
        for (uint32_t i = 0; i < count; i++) {
            bool right = split_goes_right(&s, &boxes[i]);

            rights += right;
            for (int i_plane = 0; i_plane < 8; i_plane++)
                if (i_plane % 4 != 3)
                    assert_true(sides[right].planes[i_plane] <=
                                boxes[i].planes[i_plane]);
        }
        assert_int_equal(bins_left(&bins, &s), count - rights);
        assert_in_range(rights, 1, count - 1);
    }
}

static void bins_of_threads_can_be_joined(void **state)
{
    static struct box boxes[BOXES];
    struct bins all, half, other;
    struct box centers;

    (void)state;
    random_boxes(boxes, BOXES, 7);
    centers = centers_of(boxes, BOXES);
    fill(&all, boxes, BOXES);
    bins_clear(&half, BOXES, &centers);
    bins_clear(&other, BOXES, &centers);
    bins_add(&half, boxes + 1000, BOXES - 1000);
    bins_add(&other, boxes, 1000);
    bins_join(&half, &other);
    for (int axis = 0; axis < 3; axis++)
        for (uint32_t i = 0; i < all.binning.count; i++) {
            assert_int_equal(all.counts[axis][i], half.counts[axis][i]);
            assert_memory_equal(&all.boxes[axis][i], &half.boxes[axis][i],
                                3 * sizeof(float));
        }
}

/* Also where bins would be smaller than any float. */
static void equal_centres_have_no_plane(void **state)
{
    struct box boxes[8], sides[2];
    struct bins bins;

    (void)state;
    for (int k = 0; k < 2; k++) {
        for (uint32_t i = 0; i < 8; i++)
            boxes[i] = box_of_point(
                v3(0.5f, k == 0 ? 0.25f : (float)i * 1e-44f, -0.5f));
        fill(&bins, boxes, 8);
        assert_int_equal(bins_split(&bins, 8, 0, sides).axis, -1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_cheapest_plane_is_found),
        cmocka_unit_test(bins_of_threads_can_be_joined),
        cmocka_unit_test(equal_centres_have_no_plane),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
