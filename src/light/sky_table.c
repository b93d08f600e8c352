// SPDX-License-Identifier: MIT
#include "light/sky_table.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "picture/color.h"
#include "kernels/sky.h"

/* Relative size of what rounding leaves of a constant sky after subtraction. */
#define ROUNDING 1e-6

/* Share of the sky in light samples beside area lights. Which of both a point
 * sees is not known, and with one half the variance is never more than twice
 * the least. */
#define SHARE_BESIDE_LIGHTS 0.5f

struct image {
    const struct vec3 *texels;
    uint32_t width, height;
};

static double radiance(const struct image *im, uint32_t x, uint32_t y)
{
    return color_mean(im->texels[(size_t)y * im->width + x]);
}

/* The mean of linear interpolation over a texel: 3/4 of its own value and 1/8
 * of either neighbour. */
static double row_mean(const struct image *im, uint32_t x, uint32_t y)
{
    uint32_t left = x > 0 ? x - 1 : im->width - 1;
    uint32_t right = x + 1 < im->width ? x + 1 : 0;

    return 0.75 * radiance(im, x, y) +
           0.125 * (radiance(im, left, y) + radiance(im, right, y));
}

static double bilinear_mean(const struct image *im, uint32_t x, uint32_t y)
{
    uint32_t above = y > 0 ? y - 1 : 0;
    uint32_t below = y + 1 < im->height ? y + 1 : y;

    return 0.75 * row_mean(im, x, y) +
           0.125 * (row_mean(im, x, above) + row_mean(im, x, below));
}

/* Solid angle of a row of texels. All rows add up to 4 pi. */
static double row_angle(const struct image *im, uint32_t y)
{
    double half = M_PI / (2 * (double)im->height);

    return 4 * M_PI * sin((2 * (double)y + 1) * half) * sin(half);
}

static double mean_radiance(const struct image *im)
{
    double sum = 0;

    for (uint32_t y = 0; y < im->height; y++) {
        double row = 0;

        for (uint32_t x = 0; x < im->width; x++)
            row += bilinear_mean(im, x, y);
        sum += row / im->width * row_angle(im, y);
    }
    return sum / (4 * M_PI);
}

/* Fills the cdf of a row over its columns. Returns the row's mean of what
 * exceeds the floor. */
static double fill_row(const struct image *im, uint32_t y, double floor,
                       float *sums)
{
    double total = 0, sum = 0;

    for (uint32_t x = 0; x < im->width; x++)
        total += fmax(bilinear_mean(im, x, y) - floor, 0);
    for (uint32_t x = 0; x < im->width && total > 0; x++) {
        sums[x] = (float)(sum / total);
        sum += fmax(bilinear_mean(im, x, y) - floor, 0);
    }
    sums[im->width] = 1;
    return total / im->width;
}

/* Fills the cdf over the rows, whose weights are in `rows`. */
static void fill_rows(const double *rows, uint32_t height, double total,
                      float *sums)
{
    double sum = 0;

    for (uint32_t y = 0; y < height; y++) {
        sums[y] = (float)(sum / total);
        sum += rows[y];
    }
    sums[height] = 1;
}

static void free_sums(struct sky_table *table)
{
    free(table->sums);
    table->sums = NULL;
}

bool sky_table_build(struct sky_table *table, const struct vec3 *texels,
                     uint32_t width, uint32_t height, enum sky_use use,
                     struct error *err)
{
    struct image im = {texels, width, height};
    struct sky sky = {.width = width, .height = height};
    double mean = texels != NULL ? mean_radiance(&im) : 0;
    double floor = use == SKY_WITH_MIS ? mean : 0;
    double total = 0;
    double *rows;

    sky_table_free(table);
    table->mean = mean;
    if (!(mean > 0))
        return true;
    rows = alloc_array(height, sizeof *rows);
    table->sums =
        alloc_array((size_t)height + 1 + (size_t)height * ((size_t)width + 1),
                    sizeof *table->sums);
    if (rows == NULL || table->sums == NULL) {
        free(rows);
        sky_table_free(table);
        return fail(err, "out of memory for the table of a sky of %ux%u", width,
                    height);
    }
    for (uint32_t y = 0; y < height; y++) {
        float *sums = table->sums + sky_row_cdf(sky, y);

        rows[y] = fill_row(&im, y, floor, sums) * row_angle(&im, y);
        total += rows[y];
    }
    if (total > ROUNDING * 4 * M_PI * mean)
        fill_rows(rows, height, total, table->sums);
    else
        free_sums(table);
    free(rows);
    return true;
}

/* The sky's share of light samples. */
static float share_of(const struct sky_table *table, const struct settings *s)
{
    bool is_black =
        v3_is_zero(s->sky.color) || (s->sky.width != 0 && !(table->mean > 0));

    if (is_black)
        return 0;
    if (s->light_count == 0)
        return 1;
    return table->sums != NULL ? SHARE_BESIDE_LIGHTS : 1 - s->light_share;
}

void sky_table_lend(const struct sky_table *table, struct world *world)
{
    struct settings *s = &world->settings;

    world->sky_cdf = table->sums;
    s->sky_share = share_of(table, s);
    s->sky_cdf_count = 0;
    if (table->sums == NULL || s->sky_share == 0)
        return;
    s->sky_cdf_count = sky_row_cdf(s->sky, s->sky.height);
    s->light_share = 1 - s->sky_share;
}

void sky_table_free(struct sky_table *table)
{
    free_sums(table);
    table->mean = 0;
}
