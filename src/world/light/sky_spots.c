// SPDX-License-Identifier: MIT
#include "world/light/sky_spots.h"

#include <math.h>

#include "image/color.h"
#include "kernels/sky.h"

/* The level by the mean radiance of the sky. */
#define LEVEL 16

/* Least part of the sky's light that spots are worth. */
#define PART_MIN 0.02

/* What exceeds the level at a texel, the mean of the channels. */
static double excess_at(const struct world *w, double level, uint32_t x,
                        uint32_t y)
{
    const struct sky *s = &w->settings.sky;
    struct vec3 texel = w->sky_texels[(size_t)y * s->width + x % s->width];

    return fmax(color_mean(v3_mul(texel, s->color)) - level, 0);
}

/* Bound of the mean of what exceeds the level over a texel, within which the
 * image is bilinear: what exceeds the level is convex. */
static double excess_over(const struct world *w, double level, uint32_t x,
                          uint32_t y)
{
    const struct sky *s = &w->settings.sky;
    double sum = 0;

    for (int j = -1; j <= 1; j++) {
        uint32_t row = j < 0   ? (y > 0 ? y - 1 : 0)
                       : j > 0 ? (y + 1 < s->height ? y + 1 : y)
                               : y;
        double part = j == 0 ? 0.75 : 0.125;

        sum += part * (0.125 * excess_at(w, level, x + s->width - 1, row) +
                       0.75 * excess_at(w, level, x, row) +
                       0.125 * excess_at(w, level, x + 1, row));
    }
    return sum;
}

/* Calls excess_over() for all texels, whose number above 0 is returned, and
 * lists them unless `list` is NULL. */
static uint32_t find(const struct world *w, double level,
                     struct triangle_cdf *list)
{
    const struct sky *s = &w->settings.sky;
    uint32_t count = 0;

    for (uint32_t y = 0; y < s->height; y++)
        for (uint32_t x = 0; x < s->width; x++) {
            double excess = excess_over(w, level, x, y);

            count += excess > 0;
            if (excess > 0 && list != NULL)
                triangle_cdf_add(list, y * s->width + x,
                                 excess * (double)sky_texel_angle(*s, y));
        }
    return count;
}

bool sky_spots_build(struct sky_spots *spots, const struct world *w,
                     double mean)
{
    double level = LEVEL * mean;
    uint32_t count;

    *spots = (struct sky_spots){.level = INFINITY};
    if (w->settings.sky.width == 0 || !(level > 0))
        return true;
    count = find(w, level, NULL);
    if (count == 0)
        return true;
    if (!triangle_cdf_init(&spots->texels, count))
        return false;
    find(w, level, &spots->texels);
    spots->power = triangle_cdf_total(&spots->texels);
    if (spots->power > PART_MIN * 4 * M_PI * mean)
        spots->level = (float)level;
    else
        sky_spots_free(spots);
    return true;
}

struct vec3 sky_spots_sample(const struct sky_spots *spots,
                             const struct world *w, float choice, struct vec2 u,
                             struct vec3 *direction)
{
    const struct sky s = w->settings.sky;
    uint32_t texel = triangle_cdf_choose(&spots->texels, choice);
    uint32_t x = texel % s.width, y = texel / s.width;
    double chance = excess_over(w, (double)spots->level, x, y) *
                    (double)sky_texel_angle(s, y) / spots->power;
    struct vec3 radiance;

    *direction = sky_texel_direction(w, x, y, u);
    radiance = sky_radiance(w, *direction);
    return v3_scale(v3_sub(radiance, sky_below(spots->level, radiance)),
                    sky_texel_angle(s, y) / (float)chance);
}

void sky_spots_free(struct sky_spots *spots)
{
    triangle_cdf_free(&spots->texels);
    *spots = (struct sky_spots){.level = INFINITY};
}
