// SPDX-License-Identifier: MIT
#include "terminal/sixel.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

/* Sixel format: six rows of pixels make a band. Each character from '?' on
 * holds one column as bits, the lowest bit at the top. A band is written once
 * for each of its colours. VT330/VT340 Programmer Reference Manual, chapter
 * 14. */
#define BAND_HEIGHT 6
#define COLORS      256

/* P2 = 1 keeps pixels that no colour sets; then the aspect ratio 1:1 and the
 * size. */
#define BEGIN "\033P0;1q\"1;1;%d;%d"
#define END   "\033\\"

/* Upper bounds: BEGIN and END; one colour "#255;2;100;100;100". */
#define BEGIN_BYTES 40
#define COLOR_BYTES 18

/* Shortest run that is written with a repeat count: shorter ones are not longer
 * as characters. */
#define RUN_MIN 4

/* Band: bits of each column for each colour in it. */
struct band {
    bool has[COLORS];
    uint8_t bits[COLORS][SIXEL_WIDTH_MAX];
};

size_t sixel_bytes_max(int width, int height)
{
    size_t bands = (size_t)(height + BAND_HEIGHT - 1) / BAND_HEIGHT;
    size_t pixels = (size_t)width * BAND_HEIGHT;
    size_t colors = pixels < COLORS ? pixels : COLORS;

    /* "#255", the columns and "$" for each colour, then "-" */
    return BEGIN_BYTES + COLORS * COLOR_BYTES +
           bands * (colors * ((size_t)width + 5) + 1);
}

static char *put_number(char *p, int n)
{
    if (n >= 100)
        *p++ = (char)('0' + n / 100);
    if (n >= 10)
        *p++ = (char)('0' + n / 10 % 10);
    *p++ = (char)('0' + n % 10);
    return p;
}

static int percent(int byte)
{
    return (byte * 100 + 127) / 255;
}

static char *put_colors(char *p, const struct sixel_image *image)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    bool has[COLORS] = {false};

    for (size_t i = 0; i < count; i++)
        has[image->numbers[i]] = true;
    for (int n = 0; n < COLORS; n++) {
        if (!has[n])
            continue;
        struct rgb c = image->colors[n];
        p += sprintf(p, "#%d;2;%d;%d;%d", n, percent(c.r), percent(c.g),
                     percent(c.b));
    }
    return p;
}

static char *put_run(char *p, char c, int length)
{
    if (length < RUN_MIN) {
        memset(p, c, (size_t)length);
        return p + length;
    }
    *p++ = '!';
    p = put_number(p, length);
    *p++ = c;
    return p;
}

/* Writes one colour of a band without the empty columns at its end. */
static char *put_line(char *p, const uint8_t *bits, int width)
{
    while (width > 0 && bits[width - 1] == 0)
        width--;
    for (int x = 0; x < width;) {
        int end = x + 1;

        while (end < width && bits[end] == bits[x])
            end++;
        p = put_run(p, (char)('?' + bits[x]), end - x);
        x = end;
    }
    return p;
}

static void fill_band(struct band *band, const struct sixel_image *image,
                      int top)
{
    int height = image->height - top;

    height = height < BAND_HEIGHT ? height : BAND_HEIGHT;
    memset(band->has, 0, sizeof band->has);
    for (int y = 0; y < height; y++) {
        const uint8_t *row =
            image->numbers + (size_t)(top + y) * (size_t)image->width;

        for (int x = 0; x < image->width; x++) {
            uint8_t n = row[x];

            if (!band->has[n])
                memset(band->bits[n], 0, (size_t)image->width);
            band->has[n] = true;
            band->bits[n][x] |= (uint8_t)(1u << y);
        }
    }
}

size_t sixel_encode(const struct sixel_image *image, char *bytes)
{
    char *p = bytes;
    struct band band;

    assert(image->width <= SIXEL_WIDTH_MAX);
    p += sprintf(p, BEGIN, image->width, image->height);
    p = put_colors(p, image);
    for (int top = 0; top < image->height; top += BAND_HEIGHT) {
        fill_band(&band, image, top);
        for (int n = 0; n < COLORS; n++) {
            if (!band.has[n])
                continue;
            *p++ = '#';
            p = put_number(p, n);
            p = put_line(p, band.bits[n], image->width);
            *p++ = '$';
        }
        p[-1] = '-'; /* next band after the last colour */
    }
    p--; /* there is no next band */
    memcpy(p, END, sizeof END - 1);
    return (size_t)(p - bytes) + sizeof END - 1;
}
