// SPDX-License-Identifier: MIT
#include "film/filter/screen_detail.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/area.h"

/* Variance of a pixel that has samples in one half only. */
#define UNKNOWN_VARIANCE 1e30f

/* Numbers of a pixel in the planes. */
#define HIGH_NUMBERS 3
#define LOW_NUMBERS  (4 + 4 + 4)

/* Weight of a pixel with seen light only. */
#define LEAST_WEIGHT 1e-6f

void screen_detail_free(struct screen_detail *d)
{
    screen_halves_free(&d->halves);
    free(d->memory);
    *d = (struct screen_detail){0};
}

static void take_planes(struct screen_detail *d, size_t high, size_t low)
{
    d->detail = d->memory;
    d->filtered = d->detail + 3 * high;
    d->low = d->filtered + 4 * low;
    d->count = d->low + 4 * low;
    d->noise = d->count + low;
    d->energy = d->noise + low;
    d->weight = d->energy + low;
    d->between = d->weight + low;
    d->row = d->between + 4 * (size_t)d->low_width;
    d->weights = d->row + 4 * (size_t)d->width;
}

bool screen_detail_init(struct screen_detail *d, int width, int height,
                        int low_width, int low_height,
                        const struct filter_loops *loops)
{
    size_t high = (size_t)width * (size_t)height;
    size_t low = (size_t)low_width * (size_t)low_height;
    size_t rows = 5 * (size_t)width + 4 * (size_t)low_width;

    *d = (struct screen_detail){
        .width = width,
        .height = height,
        .low_width = low_width,
        .low_height = low_height,
        .memory = alloc_array(HIGH_NUMBERS * high + LOW_NUMBERS * low + rows,
                              sizeof *d->memory),
    };
    if (d->memory == NULL ||
        !screen_halves_init(&d->halves, width, height, loops)) {
        screen_detail_free(d);
        return false;
    }
    take_planes(d, high, low);
    return true;
}

/* ---- enlargement ---- */

/* Place of a pixel between two pixels of a smaller picture. */
struct place {
    int first, second;
    float part; /* of the second */
};

static inline struct place place_of(int i, int size, int low_size)
{
    float at = ((float)i + 0.5f) * (float)low_size / (float)size - 0.5f;
    float floor_at = floorf(at);
    int first = (int)floor_at, last = low_size - 1;

    return (struct place){first > 0 ? first : 0,
                          first < last ? first + 1 : last, at - floor_at};
}

static void blend(const float *a, const float *b, float part, int count,
                  float *restrict to)
{
    for (int i = 0; i < count; i++)
        to[i] = a[i] + part * (b[i] - a[i]);
}

/* Enlarges row y of a picture whose pixels have `numbers` numbers. */
static void enlarge(const struct screen_detail *d, const float *picture,
                    int numbers, int y, float *to)
{
    struct place v = place_of(y, d->height, d->low_height);
    int count = numbers * d->low_width;

    blend(picture + (size_t)v.first * (size_t)count,
          picture + (size_t)v.second * (size_t)count, v.part, count,
          d->between);
    for (int x = 0; x < d->width; x++, to += numbers) {
        struct place h = place_of(x, d->width, d->low_width);

        blend(d->between + numbers * h.first, d->between + numbers * h.second,
              h.part, numbers, to);
    }
}

/* Enlarges row y of a picture whose pixels are weighted, the weight last, to
 * d->row, whose pixels have three numbers then. */
static void enlarge_weighted(const struct screen_detail *d,
                             const float *picture, int y)
{
    const float *from = d->row;
    float *to = d->row;

    enlarge(d, picture, 4, y, d->row);
    for (int x = 0; x < d->width; x++, from += 4) {
        float scale = 1.0f / from[3];

        for (int c = 0; c < 3; c++)
            *to++ = from[c] * scale;
    }
}

/* Weighs a pixel by the light in it that is not seen. */
static void put_weighted(float seen, const float rgb[3], float to[4])
{
    to[3] = fmaxf(1.0f - seen, LEAST_WEIGHT);
    for (int c = 0; c < 3; c++)
        to[c] = rgb[c] * to[3];
}

/* ---- detail ---- */

/* Returns the variance of a pixel's mean, summed over channels. */
static float variance_of(const struct screen_halves *h, int x)
{
    float a = h->count[0][x], b = h->count[1][x], square = 0.0f;

    if (!(a > 0.0f && b > 0.0f))
        return UNKNOWN_VARIANCE;
    for (int c = 0; c < 3; c++) {
        float difference = h->light[0][c][x] - h->light[1][c][x];

        square += difference * difference;
    }
    return square * (a * b / ((a + b) * (a + b)));
}

/* Returns the pixel of the filtered picture that has pixel (x, y) of the
 * result. */
static size_t low_pixel(const struct screen_detail *d, int x, int y)
{
    int row = area_cell(y, d->low_height, d->height);
    int column = area_cell(x, d->low_width, d->width);

    return (size_t)row * (size_t)d->low_width + (size_t)column;
}

/* Returns row y of the film's detail. */
static float *detail_row(const struct screen_detail *d, int y)
{
    return d->detail + 3 * (size_t)y * (size_t)d->width;
}

/* Adds row y of the film to means and noise, and keeps its pixels. */
static void add_row(struct screen_detail *d, struct film *film, int y)
{
    float *high = detail_row(d, y);

    screen_halves_row(&d->halves, film, NULL, y);
    memcpy(high, d->halves.raw, 3 * (size_t)d->width * sizeof *high);
    for (int x = 0; x < d->width; x++, high += 3) {
        size_t at = low_pixel(d, x, y);

        for (int c = 0; c < 3; c++)
            d->low[4 * at + (size_t)c] += high[c];
        d->noise[at] += variance_of(&d->halves, x);
        d->count[at]++;
    }
}

static void find_low(struct screen_detail *d, struct film *film,
                     const float *seen)
{
    size_t pixels = (size_t)d->low_width * (size_t)d->low_height;

    memset(d->low, 0, 4 * pixels * sizeof *d->low);
    memset(d->count, 0, 3 * pixels * sizeof *d->count);
    screen_halves_begin(&d->halves);
    for (int y = 0; y < d->height; y++)
        add_row(d, film, y);
    for (size_t i = 0; i < pixels; i++) {
        float *low = d->low + 4 * i, mean[3];

        for (int c = 0; c < 3; c++)
            mean[c] = low[c] / d->count[i];
        put_weighted(seen[i], mean, low);
    }
}

/* Makes the pixels of row y the detail in them, and adds its energy. */
static void find_detail(struct screen_detail *d, int y)
{
    float *detail = detail_row(d, y);

    enlarge_weighted(d, d->low, y);
    for (int i = 0; i < 3 * d->width; i++)
        detail[i] -= d->row[i];
    for (int x = 0; x < d->width; x++, detail += 3)
        d->energy[low_pixel(d, x, y)] += detail[0] * detail[0] +
                                         detail[1] * detail[1] +
                                         detail[2] * detail[2];
}

/* Returns the sum over 3x3 pixels, fewer at the edges. */
static float sum_around(const struct screen_detail *d, const float *plane,
                        int x, int y)
{
    float sum = 0.0f;

    for (int j = y > 0 ? y - 1 : y; j <= y + 1 && j < d->low_height; j++)
        for (int i = x > 0 ? x - 1 : x; i <= x + 1 && i < d->low_width; i++)
            sum += plane[(size_t)j * (size_t)d->low_width + (size_t)i];
    return sum;
}

static void find_weights(struct screen_detail *d)
{
    float *weight = d->weight;

    for (int y = 0; y < d->low_height; y++)
        for (int x = 0; x < d->low_width; x++) {
            float energy = sum_around(d, d->energy, x, y);
            float noise = sum_around(d, d->noise, x, y);

            *weight++ = energy > noise ? 1.0f - noise / energy : 0.0f;
        }
}

void screen_detail_find(struct screen_detail *d, struct film *film,
                        const float *filtered, const float *seen)
{
    uint64_t film_pixels = (uint64_t)film->width * (uint64_t)film->height;
    size_t pixels = (size_t)d->low_width * (size_t)d->low_height;

    for (size_t i = 0; i < pixels; i++)
        put_weighted(seen[i], filtered + 3 * i, d->filtered + 4 * i);
    d->has_detail = atomic_load(&film->samples) >= 2 * film_pixels;
    if (!d->has_detail)
        return;
    find_low(d, film, seen);
    for (int y = 0; y < d->height; y++)
        find_detail(d, y);
    find_weights(d);
}

const float *screen_detail_row(struct screen_detail *d, int y)
{
    const float *detail = detail_row(d, y);

    enlarge_weighted(d, d->filtered, y);
    if (!d->has_detail)
        return d->row;
    enlarge(d, d->weight, 1, y, d->weights);
    for (int i = 0; i < 3 * d->width; i++)
        d->row[i] = fmaxf(d->row[i] + d->weights[i / 3] * detail[i], 0.0f);
    return d->row;
}
