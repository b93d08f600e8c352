// SPDX-License-Identifier: MIT
#include "terminal/color_cut.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Cells of the colour cube: 32 along each axis. The dither moves a colour by
 * half a cell at most: more has a larger error, even with 16 colours. */
#define SHIFT 3
#define BINS  (1 << 3 * (8 - SHIFT))

/* Sums of the pixels of a cell. */
struct color_bin {
    uint32_t count, sum[3];
    uint8_t number; /* of its box */
};

/* Box of cells: used[begin] to used[end - 1]. */
struct box {
    int begin, end;
    int axis;     /* of the largest error */
    double mean;  /* along that axis */
    double error; /* sum of squared differences along that axis */
};

bool color_cut_init(struct color_cut *c, struct error *err)
{
    *c = (struct color_cut){.count = 0};
    c->bins = alloc_array(BINS, sizeof c->bins[0]);
    c->used = alloc_array(BINS, sizeof c->used[0]);
    if (c->bins && c->used)
        return true;
    color_cut_free(c);
    return fail(err, "out of memory for a palette");
}

void color_cut_free(struct color_cut *c)
{
    free(c->bins);
    free(c->used);
    *c = (struct color_cut){.count = 0};
}

/* Returns the cell of a colour that the dither has moved. */
static int bin_of(const uint8_t *rgb, int threshold)
{
    int move = (2 * threshold + 1 - 16) * (1 << SHIFT) / 32;
    int bin = 0;

    for (int i = 0; i < 3; i++) {
        int v = rgb[i] + move;

        bin = bin << (8 - SHIFT) | (v < 0 ? 0 : v > 255 ? 255 : v) >> SHIFT;
    }
    return bin;
}

static double mean_of(const struct color_bin *b, int axis)
{
    return (double)b->sum[axis] / b->count;
}

/* Finds the axis of the largest error of a box, with green and blue weighted as
 * the eye does. Cells count with their mean. */
static void measure(const struct color_cut *c, struct box *box)
{
    static const double weight[3] = {2, 4, 3};

    box->error = 0;
    for (int axis = 0; axis < 3; axis++) {
        double count = 0, sum = 0, squares = 0, error;

        for (int i = box->begin; i < box->end; i++) {
            const struct color_bin *b = &c->bins[c->used[i]];

            count += b->count;
            sum += b->sum[axis];
            squares += mean_of(b, axis) * b->sum[axis];
        }
        error = weight[axis] * (squares - sum * sum / count);
        if (error > box->error) {
            box->axis = axis;
            box->mean = sum / count;
            box->error = error;
        }
    }
}

/* Moves the cells above the mean to the end of the box. Returns the first of
 * them. */
static int divide(struct color_cut *c, const struct box *box)
{
    int at = box->begin;

    for (int i = box->begin; i < box->end; i++) {
        uint16_t bin = c->used[i];

        if (mean_of(&c->bins[bin], box->axis) > box->mean)
            continue;
        c->used[i] = c->used[at];
        c->used[at++] = bin;
    }
    return at;
}

/* Divides the box of the largest error until there are enough, or until none
 * has an error that is visible. */
static int cut(struct color_cut *c, int used_count, int most,
               struct box boxes[COLOR_CUT_MAX])
{
    int count = 1;

    boxes[0] = (struct box){.begin = 0, .end = used_count};
    measure(c, &boxes[0]);
    while (count < most) {
        struct box *worst = &boxes[0];
        int middle;

        for (int i = 1; i < count; i++)
            if (boxes[i].error > worst->error)
                worst = &boxes[i];
        middle = worst->error > 1 ? divide(c, worst) : worst->end;
        if (middle == worst->end)
            break;
        boxes[count] = (struct box){.begin = middle, .end = worst->end};
        worst->end = middle;
        measure(c, worst);
        measure(c, &boxes[count++]);
    }
    return count;
}

/* Gives the cells of a box their number, and the palette their mean. */
static void number_box(struct color_cut *c, const struct box *box, int number)
{
    uint32_t count = 0, sum[3] = {0, 0, 0};

    for (int i = box->begin; i < box->end; i++) {
        struct color_bin *b = &c->bins[c->used[i]];

        b->number = (uint8_t)number;
        count += b->count;
        for (int k = 0; k < 3; k++)
            sum[k] += b->sum[k];
    }
    c->colors[number] = (struct rgb){(int)((sum[0] + count / 2) / count),
                                     (int)((sum[1] + count / 2) / count),
                                     (int)((sum[2] + count / 2) / count)};
}

void color_cut(struct color_cut *c, const struct color_cut_image *image,
               int most, uint8_t *numbers)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    struct box boxes[COLOR_CUT_MAX];
    int used_count = 0;

    assert(most > 0 && most <= COLOR_CUT_MAX && pixels > 0);
    memset(c->bins, 0, BINS * sizeof c->bins[0]);
    for (int pass = 0; pass < 2; pass++) {
        const uint8_t *p = image->rgb;

        for (size_t i = 0; i < pixels; i++, p += 3) {
            int x = image->x + (int)(i % (size_t)image->width);
            int y = image->y + (int)(i / (size_t)image->width);
            int at = bin_of(p, dither_threshold(x, y));
            struct color_bin *b = &c->bins[at];

            if (pass == 1) {
                numbers[i] = b->number;
                continue;
            }
            if (b->count++ == 0)
                c->used[used_count++] = (uint16_t)at;
            for (int k = 0; k < 3; k++)
                b->sum[k] += p[k];
        }
        if (pass == 1)
            break;
        c->count = cut(c, used_count, most, boxes);
        for (int i = 0; i < c->count; i++)
            number_box(c, &boxes[i], i);
    }
}
