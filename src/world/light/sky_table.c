// SPDX-License-Identifier: MIT
#include "world/light/sky_table.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "image/color.h"
#include "kernels/sky.h"

/* Relative size of what rounding leaves of a constant sky after subtraction. */
#define ROUNDING 1e-6

/* Share of the sky in light samples beside area lights. Which of both a point
 * sees is not known, and with one half the variance is never more than twice
 * the least. */
#define SHARE_BESIDE_LIGHTS 0.5f

/* Factor for the irradiance by the sky where light samples choose between it
 * and directional lights: BSDF samples find the sky as well. With 1 scenes
 * under the sun need 10 to 17 % more samples, with 0.15 up to 12 % more or
 * fewer. */
#define SKY_POWER_PART 0.4

/* Image that is read row by row from the top. */
struct image {
    const struct vec3 *texels;
    uint32_t width, height;
    /* four rows of doubles: the bilinear means of the current row, then the row
     * means of it and of its neighbours, row y at y % 3 */
    double *lines;
};

static double *row_means(const struct image *im, uint32_t y)
{
    return im->lines + (size_t)im->width * (1 + y % 3);
}

/* Sets the means of linear interpolation over the texels of a row: 3/4 of each
 * value and 1/8 of either neighbour. */
static void read_row(const struct image *im, uint32_t y)
{
    const struct vec3 *row = im->texels + (size_t)y * im->width;
    double *means = row_means(im, y);
    double first = color_mean(row[0]);
    double left = color_mean(row[im->width - 1]);
    double here = first;

    for (uint32_t x = 0; x < im->width; x++) {
        double right = x + 1 < im->width ? color_mean(row[x + 1]) : first;

        means[x] = 0.75 * here + 0.125 * (left + right);
        left = here;
        here = right;
    }
}

/* Returns the means of bilinear interpolation over the texels of a row. Rows
 * come in their order. */
static const double *bilinear_means(const struct image *im, uint32_t y)
{
    uint32_t above = y > 0 ? y - 1 : 0;
    uint32_t below = y + 1 < im->height ? y + 1 : y;
    const double *up = row_means(im, above);
    const double *here = row_means(im, y);
    const double *down = row_means(im, below);

    if (y == 0)
        read_row(im, 0);
    if (below != y)
        read_row(im, below);
    for (uint32_t x = 0; x < im->width; x++)
        im->lines[x] = 0.75 * here[x] + 0.125 * (up[x] + down[x]);
    return im->lines;
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
        const double *means = bilinear_means(im, y);
        double row = 0;

        for (uint32_t x = 0; x < im->width; x++)
            row += means[x];
        sum += row / im->width * row_angle(im, y);
    }
    return sum / (4 * M_PI);
}

/* Fills the cdf of a row over its columns. Returns the row's mean of what
 * exceeds the floor. */
static double fill_row(const struct image *im, uint32_t y, double floor,
                       float *sums)
{
    const double *means = bilinear_means(im, y);
    double total = 0, sum = 0;

    for (uint32_t x = 0; x < im->width; x++)
        total += fmax(means[x] - floor, 0);
    for (uint32_t x = 0; x < im->width && total > 0; x++) {
        sums[x] = (float)(sum / total);
        sum += fmax(means[x] - floor, 0);
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

/* Fills the starts of a cdf of n intervals. */
static void fill_starts(const float *cdf, uint32_t n, float *starts)
{
    uint32_t i = 0;

    for (uint32_t k = 0; k <= SKY_STARTS; k++) {
        while (i + 1 < n && cdf[i + 1] <= (float)k / SKY_STARTS)
            i++;
        starts[k] = (float)i;
    }
}

/* Fills what the table has beside the cdfs. */
static void fill_rest(float *sums, struct sky sky)
{
    for (uint32_t y = 0; y < sky.height; y++)
        sums[sky_angles(sky) + y] = sky_texel_angle(sky, y);
    for (uint32_t y = 0; y <= sky.height; y++)
        sums[sky_heights(sky) + y] = sky_edge_height(sky, y);
    fill_starts(sums, sky.height, sums + sky_starts(sky, 0));
    for (uint32_t y = 0; y < sky.height; y++)
        fill_starts(sums + sky_row_cdf(sky, y), sky.width,
                    sums + sky_starts(sky, y + 1));
}

static void free_sums(struct sky_table *table)
{
    free(table->sums);
    table->sums = NULL;
}

/* Fills the table of an image whose mean is above zero. */
static void fill_table(struct sky_table *table, const struct image *im,
                       double floor, double *rows)
{
    struct sky sky = {.width = im->width, .height = im->height};
    double total = 0;

    for (uint32_t y = 0; y < im->height; y++) {
        float *sums = table->sums + sky_row_cdf(sky, y);

        rows[y] = fill_row(im, y, floor, sums) * row_angle(im, y);
        total += rows[y];
    }
    if (!(total > ROUNDING * 4 * M_PI * table->mean)) {
        free_sums(table);
        return;
    }
    fill_rows(rows, im->height, total, table->sums);
    fill_rest(table->sums, sky);
}

bool sky_table_build(struct sky_table *table, const struct vec3 *texels,
                     uint32_t width, uint32_t height, enum sky_use use,
                     struct error *err)
{
    const struct sky sky = {.width = width, .height = height};
    struct image im = {texels, width, height, NULL};
    double *rows;
    bool ok;

    sky_table_free(table);
    if (texels == NULL)
        return true;
    rows = alloc_array(height, sizeof *rows);
    im.lines = alloc_array((size_t)width * 4, sizeof *im.lines);
    ok = rows != NULL && im.lines != NULL;
    if (ok)
        table->mean = mean_radiance(&im);
    if (ok && table->mean > 0) {
        table->sums = alloc_array(sky_table_length(sky), sizeof *table->sums);
        ok = table->sums != NULL;
        if (ok)
            fill_table(table, &im, use == SKY_WITH_MIS ? table->mean : 0, rows);
    }
    free(im.lines);
    free(rows);
    if (ok)
        return true;
    sky_table_free(table);
    return fail(err, "out of memory for the table of a sky of %ux%u", width,
                height);
}

/* Mean radiance of the world's sky. */
static double sky_mean(const struct sky_table *table, const struct sky *sky)
{
    return color_mean(sky->color) * (sky->width != 0 ? table->mean : 1);
}

/* The share of light samples for light from infinity. */
static float share_of(const struct sky_table *table, const struct settings *s)
{
    bool is_black =
        v3_is_zero(s->sky.color) || (s->sky.width != 0 && !(table->mean > 0));

    if (is_black && s->directional_light_count == 0)
        return 0;
    if (s->light_count + s->point_light_count == 0)
        return 1;
    return table->sums != NULL || s->directional_light_count > 0
               ? SHARE_BESIDE_LIGHTS
               : 1 - s->light_share;
}

void sky_table_lend(const struct sky_table *table, struct world *world)
{
    struct settings *s = &world->settings;

    world->sky_cdf = table->sums;
    s->sky_share = share_of(table, s);
    s->sky_power = (float)(SKY_POWER_PART * M_PI * sky_mean(table, &s->sky));
    s->sky_cdf_count = 0;
    if (table->sums != NULL && s->sky_share > 0 && !v3_is_zero(s->sky.color))
        s->sky_cdf_count = sky_table_length(s->sky);
    if (s->sky_cdf_count > 0 || s->directional_light_count > 0)
        s->light_share = 1 - s->sky_share;
}

void sky_table_free(struct sky_table *table)
{
    free_sums(table);
    table->mean = 0;
}
