// SPDX-License-Identifier: MIT
#include "inspect/false_color.h"

#include <math.h>

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
