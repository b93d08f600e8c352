// SPDX-License-Identifier: MIT
#include "inspect/false_color.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "film/film_error.h"
#include "film/image_write.h"

/* ---- numbers ---- */

#define NO_UV       0x404040u
#define FARTHEST    0.15f /* relative to white; only the sky is black */
#define GOLDEN_TURN 0.618034f
#define HUES        8 /* hues that can be told apart side by side */

struct number_range number_range_of(const float *x, size_t count, size_t stride)
{
    struct number_range r = {0.0f, 0.0f};

    for (size_t i = 0; i < count; i++) {
        float v = x[i * stride];

        if (!(v > 0.0f))
            continue;
        r.lo = r.hi == 0.0f ? v : fminf(r.lo, v);
        r.hi = fmaxf(r.hi, v);
    }
    return r;
}

static uint32_t byte_of(float x)
{
    return (uint32_t)(fminf(fmaxf(x, 0.0f), 1.0f) * 255.0f + 0.5f);
}

static uint32_t rgb_of(float r, float g, float b)
{
    return byte_of(r) << 16 | byte_of(g) << 8 | byte_of(b);
}

static float wave(float hue)
{
    float x = fabsf((hue - floorf(hue)) * 6.0f - 3.0f) - 1.0f;

    return fminf(fmaxf(x, 0.0f), 1.0f);
}

/* Returns the colour of a number. Hues advance by the golden ratio, which keeps
 * any number of them far apart; later ones are paler, then darker. */
static uint32_t color_of_number(uint32_t i)
{
    const float saturations[] = {0.75f, 0.45f, 0.75f};
    const float values[] = {1.0f, 1.0f, 0.6f};
    uint32_t shade = i / HUES % 3;
    float hue = (float)i * GOLDEN_TURN;
    float s = saturations[shade];
    float v = values[shade];

    return rgb_of(v * (1.0f - s + s * wave(hue)),
                  v * (1.0f - s + s * wave(hue + 2.0f / 3.0f)),
                  v * (1.0f - s + s * wave(hue + 1.0f / 3.0f)));
}

static uint32_t grey_of_depth(float depth, struct number_range r)
{
    float part = r.hi > r.lo ? (depth - r.lo) / (r.hi - r.lo) : 0.0f;
    float grey = 1.0f - (1.0f - FARTHEST) * part;

    return rgb_of(grey, grey, grey);
}

uint32_t false_color(enum sample_kind kind, const float xyz[3],
                     struct number_range range)
{
    switch (kind) {
    case SAMPLE_DEPTH: return xyz[0] > 0.0f ? grey_of_depth(xyz[0], range) : 0;
    case SAMPLE_MATERIAL:
        return xyz[0] > 0.0f ? color_of_number((uint32_t)xyz[0] - 1) : 0;
    case SAMPLE_UV: return xyz[2] > 0.0f ? rgb_of(xyz[0], xyz[1], 0.0f) : NO_UV;
    default: return rgb_of(xyz[0], xyz[1], xyz[2]);
    }
}

uint32_t false_color_heat(float part)
{
    static const float stops[][3] = {
        {0, 0, 0},    {0.35f, 0.1f, 0.6f}, {0.9f, 0.2f, 0.2f},
        {1, 0.8f, 0}, {1, 1, 1},
    };
    float at = 4.0f * fminf(fmaxf(part, 0.0f), 1.0f);
    int i = at < 4.0f ? (int)at : 3;
    float f = at - (float)i;
    const float *a = stops[i], *b = stops[i + 1];

    return rgb_of(a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1]),
                  a[2] + f * (b[2] - a[2]));
}

uint32_t false_color_difference(float part)
{
    float at = 2.0f * fminf(fabsf(part), 1.0f);
    float low = fminf(at, 1.0f), high = at - low;

    return part < 0.0f ? rgb_of(0.5f * high, 0.3f * low + 0.6f * high, low)
                       : rgb_of(low, 0.15f * low + 0.75f * high, 0.0f);
}

/* ---- errors ---- */

uint32_t error_map_color(float error)
{
    if (!(error > ERROR_MAP_BLACK))
        return false_color_heat(0);
    return false_color_heat(logf(error / ERROR_MAP_BLACK) /
                            logf(ERROR_MAP_WHITE / ERROR_MAP_BLACK));
}

static bool write_colors(const float *map, int width, int height,
                         const char *path, struct error *err)
{
    struct frame frame = {0};
    bool ok = frame_init(&frame, width, height, err);

    for (int y = 0; ok && y < height; y++)
        for (int x = 0; x < width; x++)
            frame_dot(&frame, x, y,
                      error_map_color(
                          map[(size_t)y * (size_t)width + (size_t)x]));
    ok = ok && image_write_frame(&frame, path, err);
    frame_free(&frame);
    return ok;
}

static bool write_numbers(const float *map, int width, int height,
                          const char *path, struct error *err)
{
    size_t pixels = (size_t)width * (size_t)height;
    float *rgb = alloc_array(pixels, 3 * sizeof *rgb);
    bool ok;

    if (rgb == NULL)
        return fail(err, "%s: out of memory for %dx%d pixels", path, width,
                    height);
    for (size_t i = 0; i < 3 * pixels; i++)
        rgb[i] = map[i / 3];
    ok = image_write_floats(rgb, width, height, path, err);
    free(rgb);
    return ok;
}

bool error_map_write(struct film *film, float exposure, const char *path,
                     struct error *err)
{
    int width = film->width, height = film->height;
    float *map = alloc_array((size_t)width * (size_t)height, sizeof *map);
    bool ok;

    if (map == NULL)
        ok = fail(err, "%s: out of memory for %dx%d pixels", path, width,
                  height);
    else if (!film_error_map(film, exposure, NULL, map))
        ok = fail(err,
                  "%s: found a pixel with less than two samples, which has no "
                  "known error",
                  path);
    else if (image_write_format_of(path) == IMAGE_WRITE_PNG)
        ok = write_colors(map, width, height, path, err);
    else
        ok = write_numbers(map, width, height, path, err);
    free(map);
    return ok;
}
