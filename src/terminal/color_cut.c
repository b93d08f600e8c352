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
    double error; /* sum of squared differences along that axis */
    double mean[3];
};

bool color_cut_init(struct color_cut *c, struct error *err)
{
    *c = (struct color_cut){.bins = alloc_array(BINS, sizeof c->bins[0]),
                            .used = alloc_array(BINS, sizeof c->used[0])};
    if (c->bins && c->used)
        return true;
    color_cut_free(c);
    return fail(err, "out of memory for a palette");
}

void color_cut_free(struct color_cut *c)
{
    free(c->bins);
    free(c->used);
    *c = (struct color_cut){.bins = NULL};
}

/* Returns the cell of pixel i after the dither. */
static int bin_of(const struct color_cut_image *image, int i)
{
    int threshold = dither_threshold(image->x + i % image->width,
                                     image->y + i / image->width);
    int move = (2 * threshold - 15) * (1 << SHIFT) / 32;
    int bin = 0;

    for (int k = 0; k < 3; k++) {
        int v = image->rgb[3 * i + k] + move;

        bin = bin << (8 - SHIFT) | (v < 0 ? 0 : v > 255 ? 255 : v) >> SHIFT;
    }
    return bin;
}

static double mean_of(const struct color_bin *b, int axis)
{
    return (double)b->sum[axis] / b->count;
}

/* Finds the means of a box, and the axis of the largest error, with channels
 * weighted as the eye does. Cells count with their mean. */
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
        box->mean[axis] = sum / count;
        error = weight[axis] * (squares - sum * sum / count);
        if (error > box->error) {
            box->axis = axis;
            box->error = error;
        }
    }
}

/* Moves the cells above the mean to a box of their own. Returns false if the
 * error is not visible. */
static bool divide(struct color_cut *c, struct box *box, struct box *above)
{
    int at = box->begin;

    for (int i = box->begin; i < box->end && box->error > 1; i++) {
        uint16_t bin = c->used[i];

        if (mean_of(&c->bins[bin], box->axis) > box->mean[box->axis])
            continue;
        c->used[i] = c->used[at];
        c->used[at++] = bin;
    }
    if (at == box->begin || at == box->end)
        return false;
    *above = (struct box){.begin = at, .end = box->end};
    box->end = at;
    measure(c, box);
    measure(c, above);
    return true;
}

/* Divides the cells that are used into boxes, always that of the largest error,
 * and numbers them. */
static void cut(struct color_cut *c, int used_count, int most)
{
    struct box boxes[COLOR_CUT_MAX] = {{.end = used_count}};
    struct box *worst = boxes;

    c->count = 1;
    measure(c, worst);
    while (c->count < most && divide(c, worst, &boxes[c->count])) {
        c->count++;
        for (int i = 0; i < c->count; i++)
            if (boxes[i].error > worst->error)
                worst = &boxes[i];
    }
    for (int n = 0; n < c->count; n++) {
        const double *mean = boxes[n].mean;

        c->colors[n] = (struct rgb){(int)(mean[0] + 0.5), (int)(mean[1] + 0.5),
                                    (int)(mean[2] + 0.5)};
        for (int i = boxes[n].begin; i < boxes[n].end; i++)
            c->bins[c->used[i]].number = (uint8_t)n;
    }
}

void color_cut(struct color_cut *c, const struct color_cut_image *image,
               int most, uint8_t *numbers)
{
    int pixels = image->width * image->height;
    int used_count = 0;

    assert(most > 0 && most <= COLOR_CUT_MAX && pixels > 0);
    memset(c->bins, 0, BINS * sizeof c->bins[0]);
    for (int i = 0; i < pixels; i++) {
        int bin = bin_of(image, i);
        struct color_bin *b = &c->bins[bin];

        if (b->count++ == 0)
            c->used[used_count++] = (uint16_t)bin;
        for (int k = 0; k < 3; k++)
            b->sum[k] += image->rgb[3 * i + k];
    }
    cut(c, used_count, most);
    for (int i = 0; i < pixels; i++)
        numbers[i] = c->bins[bin_of(image, i)].number;
}
