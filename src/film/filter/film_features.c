// SPDX-License-Identifier: MIT
#include "film/filter/film_features.h"

/* Depth of a film without surfaces. */
#define DEPTH_ANY 1.0f

/* Prefetch distance in pixels. Features are in no cache. */
#define AHEAD 16

float film_features_far(struct film *f, int stride)
{
    float far = 0.0f;

    for (int y = 0; y < f->height; y += stride) {
        film_lock_row(f, y);
        for (int x = 0; x < f->width; x += stride) {
            const struct surface_sums *s =
                &f->surfaces[(size_t)y * (size_t)f->width + (size_t)x];

            if (s->hit_count > 0)
                far = f_max(sum_float(s->depth) / (float)s->hit_count, far);
        }
        film_unlock_row(f, y);
    }
    return far > 0.0f ? far : DEPTH_ANY;
}

/* Returns the variance of the mean of 1 / inverse samples from the sum of their
 * squares and the square of their mean. */
static float mean_variance(float squares, float mean_square, float inverse)
{
    return f_max(squares * inverse - mean_square, 0.0f) * inverse;
}

/* Writes the features of a pixel. Rays that leave the scene have an albedo of
 * 1, no normal, and the greatest depth. */
static void put_features(const struct surface_sums *s, float far, int x,
                         const struct filter_row *to)
{
    float inverse = 1.0f / (float)s->count, hits = (float)s->hit_count;
    float misses = (float)(s->count - s->hit_count);
    float albedo_square = 0.0f, normal_square = 0.0f, depth;

    for (int c = 0; c < 3; c++) {
        float albedo =
            ((float)s->albedo[c] * (1.0f / SURFACE_ONE) + misses) * inverse;
        float normal =
            ((float)s->normal[c] * (2.0f / SURFACE_ONE) - hits) * inverse;

        to->albedo[c][x] = albedo;
        to->normal[c][x] = normal;
        albedo_square += albedo * albedo;
        normal_square += normal * normal;
    }
    depth = (sum_float(s->depth) + misses * far) * inverse;
    to->depth[x] = depth;
    to->albedo_noise[x] =
        mean_variance((float)s->albedo_square * (3.0f / SURFACE_ONE) +
                          3.0f * misses,
                      albedo_square, inverse);
    to->normal_noise[x] = mean_variance(hits, normal_square, inverse);
    to->depth_noise[x] =
        mean_variance(sum_float(s->depth_square) + misses * far * far,
                      depth * depth, inverse);
}

void film_features(struct film *f, float far, int y,
                   struct film_columns columns, const struct filter_row *to)
{
    const struct surface_sums *s =
        f->surfaces + (size_t)y * (size_t)f->width + columns.first;

    film_lock_row(f, y);
    for (int x = 0; x < columns.count; x++, s += columns.step) {
        if (x + AHEAD < columns.count) {
            __builtin_prefetch(&s[AHEAD * columns.step].depth);
            __builtin_prefetch(&s[AHEAD * columns.step].count);
        }
        put_features(s, far, x, to);
    }
    film_unlock_row(f, y);
}
