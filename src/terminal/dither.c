// SPDX-License-Identifier: MIT
#include "terminal/dither.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#include "kernels/tone.h"

/* Channel levels of the first 16 colours: eight colours of 0 or 170, eight of
 * 85 or 255. Themes differ and not every terminal can be asked; these are the
 * levels of VGA and near the mean of common themes. */
#define DARK_ON    170
#define BRIGHT_OFF 85

/* The 6 channel levels of the colour cube 16..231. The greys follow it. */
static const uint8_t levels[6] = {0, 95, 135, 175, 215, 255};
#define CUBE_FIRST 16
#define GREY_FIRST 232
#define COLORS     256

/* Resolution of the cache of mixes: 6 bits a channel, finer than the steps of
 * the greys. */
#define KEY_BITS 6
#define KEY_MAX  ((1 << KEY_BITS) - 1)
#define MIXES    ((size_t)1 << 3 * KEY_BITS)

/* Colours in a mix, and nearest colours that are tried for each. Twice as many
 * of these change the error of five rendered pictures by less than 1 %. */
#define MIX_LENGTH 8
#define CANDIDATES 12

/* Weight of a mix's spread (the squared distance of its colours) beside the
 * error of its mean. A spread below GRAIN_FREE, a step of the greys, is not
 * visible and costs nothing. Six times the weight, and greys alone for a chroma
 * below 0.025, have tinted walls grey: the error of ten rendered pictures in
 * 256 colours, blurred over half a cell, is 16 % larger, in 17 % fewer bytes.
 */
#define GRAIN_WEIGHT 0.1f
#define GRAIN_FREE   0.0012f

/* A colour with less chroma than GREY is mixed of greys alone: complementary
 * colours whose mean is grey are seen as violet and teal specks. Others are
 * mixed of greys and of colours whose hue differs by at most 60 degrees. */
#define GREY       0.015f
#define HUE_COSINE 0.5f

/* Weight of the variance of a shade's colours beside the error of its mean. */
#define SHADE_WEIGHT 0.02f
#define SHADES       (3 * CUBE_FIRST * (CUBE_FIRST - 1) / 2)

/* Bayer matrix: thresholds that distribute a level over 4x4 pixels. */
#define THRESHOLDS 16
static const int8_t bayer[4][4] = {{0, 8, 2, 10},
                                   {12, 4, 14, 6},
                                   {3, 11, 1, 9},
                                   {15, 7, 13, 5}};

int dither_threshold(int x, int y)
{
    return bayer[y & 3][x & 3];
}

static struct rgb value_of_16(uint32_t number)
{
    int off = number < 8 ? 0 : BRIGHT_OFF;
    int on = number < 8 ? DARK_ON : 255;

    return (struct rgb){number & 1 ? on : off, number & 2 ? on : off,
                        number & 4 ? on : off};
}

struct rgb dither_value(uint32_t number, enum palette palette)
{
    int n = (int)number - CUBE_FIRST;
    int grey = 8 + 10 * ((int)number - GREY_FIRST);

    if (palette == PALETTE_16)
        return value_of_16(number);
    assert(palette == PALETTE_256 && n >= 0);
    if (number >= GREY_FIRST)
        return (struct rgb){grey, grey, grey};
    return (struct rgb){levels[n / 36], levels[n / 6 % 6], levels[n % 6]};
}

/* Returns the linear value of a byte: the middle between the thresholds of the
 * sRGB curve on both sides. */
static float light_of(int byte)
{
    if (byte == 0 || byte == 255)
        return byte == 0 ? 0.0f : 1.0f;
    return 0.5f * (srgb_thresholds[byte - 1] + srgb_thresholds[byte]);
}

/* Converts linear RGB to OKLab, where equal distances look equal. Bjorn
 * Ottosson, "A perceptual color space for image processing", 2020. */
static struct vec3 oklab(struct vec3 c)
{
    float l =
        cbrtf(0.4122214708f * c.x + 0.5363325363f * c.y + 0.0514459929f * c.z);
    float m =
        cbrtf(0.2119034982f * c.x + 0.6806995451f * c.y + 0.1073969566f * c.z);
    float s =
        cbrtf(0.0883024619f * c.x + 0.2817188376f * c.y + 0.6299787005f * c.z);

    return v3(0.2104542553f * l + 0.7936177850f * m - 0.0040720468f * s,
              1.9779984951f * l - 2.4285922050f * m + 0.4505937099f * s,
              0.0259040371f * l + 0.7827717662f * m - 0.8086757660f * s);
}

static struct palette_color palette_color_of(struct rgb c)
{
    struct vec3 light = v3(light_of(c.r), light_of(c.g), light_of(c.b));

    return (struct palette_color){light, oklab(light), {0}, 0.0f};
}

bool dither_init(struct dither *d, struct error *err)
{
    *d = (struct dither){.palette = PALETTE_MONO};
    d->colors = alloc_array(CUBE_FIRST + SHADES, sizeof d->colors[0]);
    d->mixes = alloc_array(MIXES, sizeof d->mixes[0]);
    if (d->colors && d->mixes)
        return true;
    dither_free(d);
    return fail(err, "out of memory for dithering");
}

void dither_free(struct dither *d)
{
    free(d->colors);
    free(d->mixes);
    *d = (struct dither){0};
}

/* ---- nearest colours ---- */

static float distance_of(struct vec3 a, struct vec3 b)
{
    struct vec3 d = v3_sub(a, b);

    return v3_dot(d, d);
}

/* Returns the number of the nearest level of the cube. */
static uint32_t nearest_level(int v)
{
    uint32_t level = 0;

    while (level < 5 && 2 * v > levels[level] + levels[level + 1])
        level++;
    return level;
}

/* Returns the distance between a colour in OKLab and one of the palette. */
static float distance_to(struct vec3 lab, uint32_t number, enum palette palette)
{
    return distance_of(palette_color_of(dither_value(number, palette)).lab,
                       lab);
}

static uint32_t nearest_16(struct vec3 lab)
{
    uint32_t nearest = 0;

    for (uint32_t i = 1; i < CUBE_FIRST; i++)
        if (distance_to(lab, i, PALETTE_16) <
            distance_to(lab, nearest, PALETTE_16))
            nearest = i;
    return nearest;
}

uint32_t dither_nearest(struct rgb c, enum palette palette)
{
    struct vec3 lab = palette_color_of(c).lab;
    int mean = (c.r + c.g + c.b) / 3;
    uint32_t cube = CUBE_FIRST + 36 * nearest_level(c.r) +
                    6 * nearest_level(c.g) + nearest_level(c.b);
    uint32_t grey = mean < 8     ? GREY_FIRST
                    : mean > 238 ? COLORS - 1
                                 : GREY_FIRST + (uint32_t)(mean - 3) / 10;

    if (palette == PALETTE_16)
        return nearest_16(lab);
    return distance_to(lab, grey, palette) < distance_to(lab, cube, palette)
               ? grey
               : cube;
}

/* ---- mixes ---- */

/* Colour that may enter a mix. */
struct candidate {
    int index;
    float distance; /* squared, to the requested colour */
};

/* Adds the shades of two colours. */
static void add_shades(struct dither *d, uint32_t bg, uint32_t fg)
{
    struct vec3 from = d->colors[bg].light, to = d->colors[fg].light;
    float distance = distance_of(d->colors[bg].lab, d->colors[fg].lab);

    for (int quarters = 1; quarters < 4; quarters++) {
        float part = 0.25f * (float)quarters;
        struct vec3 light =
            v3_add(v3_scale(from, 1.0f - part), v3_scale(to, part));

        d->colors[d->count++] =
            (struct palette_color){light,
                                   oklab(light),
                                   {fg, bg, quarters},
                                   SHADE_WEIGHT * part * (1.0f - part) *
                                       distance};
    }
}

/* Selects the palette whose mixes are kept. */
static void use_palette(struct dither *d, enum palette palette, bool has_shades)
{
    uint32_t first = palette == PALETTE_256 ? CUBE_FIRST : 0;
    uint32_t end = palette == PALETTE_256 ? COLORS : CUBE_FIRST;

    if (d->palette == palette && d->has_shades == has_shades)
        return;
    d->palette = palette;
    d->has_shades = has_shades;
    d->count = 0;
    for (uint32_t i = first; i < end; i++) {
        struct palette_color *color = &d->colors[d->count++];

        *color = palette_color_of(dither_value(i, palette));
        color->shade = (struct shade){i, i, 0};
    }
    for (uint32_t i = 0; i < CUBE_FIRST && has_shades; i++)
        for (uint32_t k = 0; k < i; k++)
            add_shades(d, k, i);
    memset(d->mixes, 0, MIXES * sizeof d->mixes[0]);
}

static float chroma_of(struct vec3 lab)
{
    return sqrtf(lab.y * lab.y + lab.z * lab.z);
}

/* Returns true if a colour may be in the mix for `wanted`. */
static bool may_mix(struct vec3 color, struct vec3 wanted)
{
    float chroma = chroma_of(color), wanted_chroma = chroma_of(wanted);

    if (chroma < 1e-3f)
        return true;
    return wanted_chroma >= GREY && color.y * wanted.y + color.z * wanted.z >=
                                        HUE_COSINE * chroma * wanted_chroma;
}

/* Finds the colours nearest to `lab`, by insertion. */
static void find_candidates(const struct dither *d, struct vec3 lab,
                            struct candidate found[CANDIDATES])
{
    for (int i = 0; i < CANDIDATES; i++)
        found[i] = (struct candidate){0, FLOAT_MAX};
    for (int i = 0; i < d->count; i++) {
        float distance = distance_of(d->colors[i].lab, lab);
        int at = CANDIDATES - 1;

        if (distance >= found[at].distance || !may_mix(d->colors[i].lab, lab))
            continue;
        for (; at > 0 && found[at - 1].distance > distance; at--)
            found[at] = found[at - 1];
        found[at] = (struct candidate){i, distance};
    }
}

/* Returns the candidate that brings the mean of the mix nearest to `lab`. */
static int next_of_mix(const struct dither *d, struct vec3 lab, int length,
                       struct vec3 sum,
                       const struct candidate candidates[CANDIDATES])
{
    float least = FLOAT_MAX;
    int best = 0;

    for (int i = 0; i < CANDIDATES; i++) {
        struct vec3 more = v3_add(sum, d->colors[candidates[i].index].light);
        struct vec3 mean = v3_scale(more, 1.0f / (float)(length + 1));
        float miss =
            (float)(length + 1) * distance_of(oklab(mean), lab) +
            GRAIN_WEIGHT * f_max(candidates[i].distance - GRAIN_FREE, 0.0f);

        if (miss < least) {
            least = miss;
            best = candidates[i].index;
        }
    }
    return best;
}

/* Inserts by lightness, so that a higher threshold selects a lighter colour. */
static void insert_sorted(const struct dither *d, int *mix, int length,
                          int index)
{
    int at = length;

    for (; at > 0 && d->colors[mix[at - 1]].lab.x > d->colors[index].lab.x;
         at--)
        mix[at] = mix[at - 1];
    mix[at] = index;
}

/* Builds a mix greedily, colour by colour. Means are taken of linear light, as
 * the eye does, and compared in OKLab. After Thomas Knoll, "Pattern dithering",
 * US 6606166. */
static uint64_t find_mix(const struct dither *d, struct rgb c)
{
    struct vec3 lab = palette_color_of(c).lab;
    struct candidate candidates[CANDIDATES];
    struct vec3 sum = v3(0.0f, 0.0f, 0.0f);
    int mix[MIX_LENGTH];
    uint64_t packed = 0;

    find_candidates(d, lab, candidates);
    for (int i = 0; i < MIX_LENGTH; i++) {
        int index = next_of_mix(d, lab, i, sum, candidates);

        sum = v3_add(sum, d->colors[index].light);
        insert_sorted(d, mix, i, index);
    }
    for (int i = 0; i < MIX_LENGTH; i++)
        packed |= (uint64_t)(1 + mix[i]) << 8 * i;
    return packed;
}

/* Rounds to the cache's resolution, down or up by place. Alternating between
 * both neighbours halves the visible steps. */
static int to_key(int v, bool is_up)
{
    return (v * KEY_MAX + (is_up ? 191 : 64)) / 255;
}

static int of_key(int v)
{
    return (v * 255 + KEY_MAX / 2) / KEY_MAX;
}

/* Returns the place of a colour in the cache, and rounds the colour to it. */
static uint64_t *cached(struct dither *d, struct rgb *c, bool is_up)
{
    struct rgb key = {to_key(c->r, is_up), to_key(c->g, is_up),
                      to_key(c->b, is_up)};

    *c = (struct rgb){of_key(key.r), of_key(key.g), of_key(key.b)};
    return &d->mixes[key.r << 2 * KEY_BITS | key.g << KEY_BITS | key.b];
}

static uint32_t mixed(struct dither *d, struct rgb c, int threshold)
{
    int place = threshold / (THRESHOLDS / MIX_LENGTH);
    uint64_t *mix = cached(d, &c, threshold & 1);

    if (*mix == 0)
        *mix = find_mix(d, c);
    return d->colors[(*mix >> 8 * place & 255) - 1].shade.bg;
}

static int nearest_shade(const struct dither *d, struct rgb c)
{
    struct vec3 lab = palette_color_of(c).lab;
    float least = FLOAT_MAX;
    int nearest = 0;

    for (int i = 0; i < d->count; i++) {
        const struct palette_color *p = &d->colors[i];
        float miss = distance_of(p->lab, lab) + p->variance;

        if (miss < least && may_mix(d->colors[p->shade.fg].lab, lab) &&
            may_mix(d->colors[p->shade.bg].lab, lab)) {
            least = miss;
            nearest = i;
        }
    }
    return nearest;
}

uint32_t dither_color(struct dither *d, struct rgb c, int x, int y,
                      enum palette palette)
{
    if (palette == PALETTE_24BIT)
        return (uint32_t)c.r << 16 | (uint32_t)c.g << 8 | (uint32_t)c.b;
    assert(palette != PALETTE_MONO);
    use_palette(d, palette, false);
    return mixed(d, c, dither_threshold(x, y));
}

struct shade dither_shade(struct dither *d, struct rgb c)
{
    uint64_t *number;

    use_palette(d, PALETTE_16, true);
    number = cached(d, &c, true);
    if (*number == 0)
        *number = 1 + (uint64_t)nearest_shade(d, c);
    return d->colors[*number - 1].shade;
}
