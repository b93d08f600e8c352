// SPDX-License-Identifier: MIT
#include "inspect/snapshot.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "image/area.h"

/* Least width and height of a block in pixels: a sum of fewer e^2 says little
 * of the variance. */
#define BLOCK_MIN 8

/* Pixels that are read for differences, some 40 ms. */
#define PIXELS_READ (1 << 19)

/* Relative difference that rounding may cause where there is no noise. */
#define ROUNDING 1e-5

/* Pictures with a marked block although only their noise differs. */
#define FALSE_ALARMS 0.05

bool snapshot_take(struct snapshot *k, struct film *film, struct error *err)
{
    size_t count = (size_t)film->width * (size_t)film->height;
    float *means = alloc_array(3 * count, sizeof *means);

    *k = (struct snapshot){.width = film->width, .height = film->height};
    k->pixels = alloc_array(count, sizeof *k->pixels);
    if (!means || !k->pixels) {
        free(means);
        snapshot_free(k);
        return fail(err, "out of memory to keep a render of %dx%d pixels",
                    film->width, film->height);
    }
    film_linear(film, means);
    for (size_t i = 0; i < count; i++) {
        struct snapshot_pixel *p = &k->pixels[i];
        int y = (int)(i / (size_t)film->width);

        *p = (struct snapshot_pixel){.is_known = 1.0f};
        film_lock_row(film, y);
        if (!film_pixel_error(film, i, p->mean, p->e))
            *p = (struct snapshot_pixel){
                .mean = {means[3 * i], means[3 * i + 1], means[3 * i + 2]}};
        film_unlock_row(film, y);
    }
    free(means);
    return true;
}

uint64_t snapshot_bytes(const struct snapshot *k)
{
    return (uint64_t)k->width * (uint64_t)k->height * sizeof *k->pixels;
}

void snapshot_free(struct snapshot *k)
{
    free(k->pixels);
    *k = (struct snapshot){.pixels = NULL};
}

/* ---- painting ---- */

/* Adds what a pixel shows: linear light after the tone curve, at most 1. */
static void add_shown(const struct snapshot_pixel *p, float factor,
                      uint32_t tone, float weight, float sum[3])
{
    float rgb[4] = {factor * p->mean[0], factor * p->mean[1],
                    factor * p->mean[2], 0.0f};

    if (tone != TONE_LINEAR)
        tone_curve(tone, rgb);
    for (int c = 0; c < 3; c++)
        sum[c] += weight * f_min(rgb[c], 1.0f);
}

static void paint_pixel(const struct snapshot *k, struct develop how, int x,
                        int y, const struct frame *frame, uint8_t *bytes)
{
    struct area_walk rows = area_walk(k->height, frame->height, y, 1);
    float factor = develop_factor(how);
    float area = (float)k->width * (float)k->height;
    float sum[3] = {0.0f, 0.0f, 0.0f};

    while (area_walks(&rows)) {
        struct area_walk columns = area_walk(k->width, frame->width, x, 1);
        const struct snapshot_pixel *row =
            k->pixels + (size_t)rows.from * (size_t)k->width;
        float height = area_step(&rows);

        while (area_walks(&columns)) {
            const struct snapshot_pixel *p = row + columns.from;

            add_shown(p, factor, how.tone, height * area_step(&columns) / area,
                      sum);
        }
    }
    for (int c = 0; c < 3; c++)
        bytes[c] = (uint8_t)srgb_byte(sum[c]);
}

void snapshot_paint(const struct snapshot *k, struct develop how,
                    struct frame *frame)
{
    for (int y = 0; y < frame->height; y++)
        for (int x = 0; x < frame->width; x++)
            paint_pixel(k, how, x, y, frame,
                        frame->rgb +
                            3 * ((size_t)y * (size_t)frame->width + (size_t)x));
}

/* ---- differences ---- */

/* Sums over the pixels of a block that were read. */
struct sums {
    double difference[3]; /* of film and kept render */
    double variance[3];
    double both; /* all channels of both */
    bool is_unknown;
};

static void add_pixel(struct sums *s, const struct snapshot_pixel *before,
                      const struct film *film, size_t at)
{
    float mean[3], e[3];

    if (before->is_known == 0.0f || !film_pixel_error(film, at, mean, e)) {
        s->is_unknown = true;
        return;
    }
    for (int c = 0; c < 3; c++) {
        double v[2] = {(double)e[c], (double)before->e[c]};

        s->difference[c] += (double)mean[c] - (double)before->mean[c];
        s->variance[c] += v[0] * v[0] + v[1] * v[1];
        s->both += (double)mean[c] + (double)before->mean[c];
    }
}

static struct snapshot_block block_of(const struct sums *s, double bound)
{
    struct snapshot_block block = {0.0f, false};
    double all = 0;

    if (s->is_unknown)
        return block;
    for (int c = 0; c < 3; c++) {
        all += s->difference[c];
        if (fabs(s->difference[c]) >
            bound * sqrt(s->variance[c]) + ROUNDING * s->both)
            block.is_significant = true;
    }
    if (s->both > 0)
        block.difference = (float)(2 * all / s->both);
    return block;
}

static bool alloc_blocks(struct snapshot_blocks *b, const struct snapshot *k,
                         int cols, int rows, struct error *err)
{
    int most_cols = k->width / BLOCK_MIN, most_rows = k->height / BLOCK_MIN;

    cols = cols < most_cols ? cols : most_cols;
    rows = rows < most_rows ? rows : most_rows;
    snapshot_blocks_free(b);
    b->cols = cols > 0 ? cols : 1;
    b->rows = rows > 0 ? rows : 1;
    b->blocks =
        alloc_array((size_t)b->cols * (size_t)b->rows, sizeof *b->blocks);
    return b->blocks != NULL || fail(err, "out of memory for differences");
}

bool snapshot_differences(const struct snapshot *k, struct film *film, int cols,
                          int rows, struct snapshot_blocks *b,
                          struct error *err)
{
    size_t pixels = (size_t)k->width * (size_t)k->height;
    int step = 1 + (int)(pixels / PIXELS_READ);
    struct sums *sums;
    double bound;
    int count;

    if (!alloc_blocks(b, k, cols, rows, err))
        return false;
    count = b->cols * b->rows;
    sums = alloc_array((size_t)count, sizeof *sums);
    if (!sums)
        return fail(err, "out of memory for differences");
    for (int y = 0; y < k->height; y += step) {
        struct sums *row =
            sums + (size_t)(y * b->rows / k->height) * (size_t)b->cols;

        film_lock_row(film, y);
        for (int x = 0; x < k->width; x++) {
            size_t at = (size_t)y * (size_t)k->width + (size_t)x;

            add_pixel(&row[x * b->cols / k->width], &k->pixels[at], film, at);
        }
        film_unlock_row(film, y);
    }
    /* the tail of a normal distribution is below exp(-bound^2 / 2) */
    bound = sqrt(2 * log(3 * count / FALSE_ALARMS));
    b->significant_count = 0;
    for (int i = 0; i < count; i++) {
        b->blocks[i] = block_of(&sums[i], bound);
        b->significant_count += b->blocks[i].is_significant;
    }
    free(sums);
    return true;
}

void snapshot_blocks_free(struct snapshot_blocks *b)
{
    free(b->blocks);
    *b = (struct snapshot_blocks){.blocks = NULL};
}
