// SPDX-License-Identifier: MIT
#include "images.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "image/stb.h"

#define SIDE_MAX   256
#define SKY_WIDTH  256
#define SKY_HEIGHT 128

struct color {
    double r, g, b;
};

/* Returns a pseudorandom number in [0, 1) for a point of a grid. */
static double noise_at(int x, int y, uint32_t seed)
{
    uint32_t h = (uint32_t)x * 0x9e3779b9u ^ (uint32_t)y * 0x85ebca6bu ^ seed;

    h = (h ^ h >> 16) * 0x21f0aaadu;
    h = (h ^ h >> 15) * 0xd35a2d97u;
    return (h ^ h >> 15) / 4294967296.0;
}

static int wrap(int x, int period)
{
    return ((x % period) + period) % period;
}

/* Returns smooth noise that repeats after `period` steps in both directions. */
static double smooth_noise(double x, double y, int period, uint32_t seed)
{
    int xi = (int)floor(x), yi = (int)floor(y);
    double u = x - xi, v = y - yi;
    double sum = 0;

    u = u * u * (3 - 2 * u);
    v = v * v * (3 - 2 * v);
    for (int i = 0; i < 4; i++) {
        double weight = (i & 1 ? u : 1 - u) * (i & 2 ? v : 1 - v);

        sum += weight * noise_at(wrap(xi + (i & 1), period),
                                 wrap(yi + (i >> 1), period), seed);
    }
    return sum;
}

static struct color mix_colors(struct color a, struct color b, double t)
{
    return (struct color){a.r + t * (b.r - a.r), a.g + t * (b.g - a.g),
                          a.b + t * (b.b - a.b)};
}

/* Quantises to steps of 1/64, which are not visible and compress better as
 * PNG. */
static uint8_t byte_of(double x)
{
    double value = floor(x * 64 + .5) * 4;

    return (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value);
}

/* Output file of the encoders. */
struct output {
    char path[4096];
    FILE *file;
};

static void append(void *context, void *data, int size_bytes)
{
    struct output *out = context;

    if (out->file)
        fwrite(data, 1, (size_t)size_bytes, out->file);
}

static void open_output(struct output *out, const char *folder,
                        const char *name)
{
    snprintf(out->path, sizeof out->path, "%s/%s", folder, name);
    out->file = fopen(out->path, "wb");
}

/* Closes the file and reports any earlier failure. */
static void close_output(struct output *out, int is_encoded)
{
    int is_bad = !out->file || !is_encoded || ferror(out->file);

    if (out->file && fclose(out->file) != 0)
        is_bad = 1;
    if (is_bad) {
        fprintf(stderr, "%s: could not be written\n", out->path);
        exit(1);
    }
}

/* Writes an image point by point: x and y in [0, 1), y down. */
static void write_png(const char *folder, const char *name, int width,
                      int height, struct color (*draw)(double x, double y))
{
    static uint8_t rgb[SIDE_MAX * SIDE_MAX * 3];
    struct output out;

    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            struct color c = draw((x + .5) / width, (y + .5) / height);
            uint8_t *p = &rgb[(y * width + x) * 3];

            p[0] = byte_of(c.r);
            p[1] = byte_of(c.g);
            p[2] = byte_of(c.b);
        }
    }
    open_output(&out, folder, name);
    close_output(&out, stbi_write_png_to_func(append, &out, width, height, 3,
                                              rgb, width * 3));
}

/* Returns a point of eight planks side by side, each with its own tone and
 * grain. */
static struct color draw_planks(double x, double y)
{
    const struct color light = {.72, .52, .34}, dark = {.42, .26, .15};
    int plank = (int)(x * 8);
    double across = x * 8 - plank;
    double joint = wrap(plank * 3, 8) / 8.0;
    double along = y + joint - floor(y + joint);
    double tone = noise_at(plank, (int)(y + joint), 7u);
    double grain = smooth_noise(x * 64, y * 4, 4096, 11u) * .5 +
                   smooth_noise(x * 128, y * 8, 4096, 13u) * .25;

    if (across < .03 || across > .97 || along < .006)
        return (struct color){.16, .10, .06};
    return mix_colors(light, dark, .15 + .45 * tone + .4 * grain);
}

/* Returns a point of wallpaper: stripes with a small diamond between them. */
static struct color draw_paper(double x, double y)
{
    const struct color ground = {.86, .84, .76}, stripe = {.74, .78, .70};
    const struct color diamond = {.55, .42, .35};
    double u = x * 4 - floor(x * 4), v = y * 4 - floor(y * 4);

    if (fabs(u - .5) + fabs(v - .5) < .14)
        return diamond;
    return u < .2 || u > .8 ? stripe : ground;
}

static struct color draw_rug(double x, double y)
{
    const struct color red = {.55, .14, .13}, cream = {.85, .76, .60};
    const struct color blue = {.16, .20, .36};
    double edge = fmin(fmin(x, 1 - x), fmin(y, 1 - y));
    double u = fabs(x - .5), v = fabs(y - .5);

    if (edge < .03 || (edge > .10 && edge < .12))
        return cream;
    if (edge < .10)
        return ((int)(x * 24) + (int)(y * 24)) % 2 ? blue : red;
    if (u + v < .16)
        return blue;
    if (u + v < .19 || (u + v > .30 && u + v < .32))
        return cream;
    return red;
}

/* Returns a point of a painting for the wall: a sun over hills. */
static struct color draw_painting(double x, double y)
{
    const struct color top = {.20, .34, .55}, low = {.96, .72, .45};
    double hill = .62 + .08 * sin(x * 7) + .04 * sin(x * 17 + 1);
    double near = .80 + .07 * sin(x * 5 + 2);
    double dx = x - .68, dy = (y - .40) * .75;

    if (y > near)
        return (struct color){.13, .24, .14};
    if (y > hill)
        return (struct color){.26, .40, .26};
    if (dx * dx + dy * dy < .006)
        return (struct color){1, .93, .70};
    return mix_colors(top, low, y / .62);
}

static struct color draw_tiles(double x, double y)
{
    const struct color light = {.88, .87, .84}, dark = {.22, .26, .30};
    double u = x * 2 - floor(x * 2), v = y * 2 - floor(y * 2);
    int is_dark = (x < .5) != (y < .5);

    if (fmin(fmin(u, 1 - u), fmin(v, 1 - v)) < .02)
        return (struct color){.5, .5, .48};
    return is_dark ? dark : light;
}

/* Returns the radiance of a hazy evening sky: blue above, pale at the horizon,
 * brown below, and a wide low sun to the right, behind a camera that looks
 * along -z. */
static struct color sky_radiance(double x, double y, double z)
{
    const struct color zenith = {.16, .30, .62}, horizon = {.85, .80, .72};
    const struct color ground = {.22, .19, .16}, sun = {1, .80, .55};
    const double sx = .68, sy = .42, sz = .60;
    double size = sqrt(sx * sx + sy * sy + sz * sz);
    double angle_deg =
        acos(fmin(1, (x * sx + y * sy + z * sz) / size)) * 180 / M_PI;
    double disc = 1 / (1 + exp((angle_deg - 7) * 2));
    double glow = .6 * exp(-angle_deg / 18);
    struct color c = y > 0 ? mix_colors(horizon, zenith, pow(y, .45)) : ground;

    c.r += sun.r * (36 * disc + glow);
    c.g += sun.g * (36 * disc + glow);
    c.b += sun.b * (36 * disc + glow);
    return c;
}

/* Encodes Radiance's four bytes: three mantissas and the exponent of the
 * largest channel. */
static void put_rgbe(struct color c, uint8_t rgbe[4])
{
    int exponent;
    double scale;

    frexp(fmax(c.r, fmax(c.g, c.b)), &exponent);
    scale = ldexp(1, 8 - exponent);
    rgbe[0] = (uint8_t)(c.r * scale);
    rgbe[1] = (uint8_t)(c.g * scale);
    rgbe[2] = (uint8_t)(c.b * scale);
    rgbe[3] = (uint8_t)(exponent + 128);
}

/* Writes the sky image: the middle column is -z, u grows towards +x, row 0 is
 * +y. */
static void write_sky(const char *folder)
{
    static uint8_t rgbe[SKY_WIDTH * SKY_HEIGHT][4];
    struct output out;

    for (int row = 0; row < SKY_HEIGHT; row++) {
        for (int col = 0; col < SKY_WIDTH; col++) {
            double theta = M_PI * (row + .5) / SKY_HEIGHT;
            double phi = 2 * M_PI * ((col + .5) / SKY_WIDTH - .5);

            put_rgbe(sky_radiance(sin(theta) * sin(phi), cos(theta),
                                  -sin(theta) * cos(phi)),
                     rgbe[row * SKY_WIDTH + col]);
        }
    }
    open_output(&out, folder, "sky.hdr");
    if (out.file)
        fprintf(out.file, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n",
                SKY_HEIGHT, SKY_WIDTH);
    append(&out, rgbe, sizeof rgbe);
    close_output(&out, 1);
}

void images_write(const char *folder)
{
    write_png(folder, "planks.png", 256, 256, draw_planks);
    write_png(folder, "paper.png", 128, 128, draw_paper);
    write_png(folder, "rug.png", 128, 128, draw_rug);
    write_png(folder, "painting.png", 192, 144, draw_painting);
    write_png(folder, "tiles.png", 64, 64, draw_tiles);
    write_sky(folder);
}
