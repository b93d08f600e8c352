// SPDX-License-Identifier: MIT
#include "image/frame.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

bool frame_init(struct frame *frame, int width, int height, struct error *err)
{
    frame->width = width;
    frame->height = height;
    frame->cancel = NULL;
    frame->rgb = alloc_array((size_t)width * (size_t)height, 3);
    if (frame->rgb == NULL)
        return fail(err, "out of memory for a frame of %dx%d pixels", width,
                    height);
    return true;
}

void frame_free(struct frame *frame)
{
    free(frame->rgb);
    *frame = (struct frame){0};
}

static void scale_pixel(const struct frame *from, const struct frame *to, int x,
                        int y, uint8_t *rgb)
{
    struct area_walk rows = area_walk(from->height, to->height, y, 1);
    float area = (float)from->width * (float)from->height;
    float sum[3] = {0.0f, 0.0f, 0.0f};

    while (area_walks(&rows)) {
        struct area_walk columns = area_walk(from->width, to->width, x, 1);
        const uint8_t *row =
            from->rgb + 3 * (size_t)rows.from * (size_t)from->width;
        float height = area_step(&rows);

        while (area_walks(&columns)) {
            const uint8_t *p = row + 3 * columns.from;
            float weight = height * area_step(&columns) / area;

            for (int c = 0; c < 3; c++)
                sum[c] += weight * (float)p[c];
        }
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = (uint8_t)(sum[c] + 0.5f);
}

void frame_scale(const struct frame *from, struct frame *to)
{
    uint8_t *rgb = to->rgb;

    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++, rgb += 3)
            scale_pixel(from, to, x, y, rgb);
}

void frame_dot(struct frame *frame, double x, double y, uint32_t rgb)
{
    uint8_t *pixel;

    if (!(x >= 0 && x < frame->width && y >= 0 && y < frame->height))
        return;
    pixel = frame->rgb + 3 * ((size_t)y * (size_t)frame->width + (size_t)x);
    for (int c = 0; c < 3; c++)
        pixel[c] = (uint8_t)(rgb >> (16 - 8 * c));
}

/* Clips [*begin, *end] to the values t with at + slope * t in [0, length]. */
static void keep_inside(double at, double slope, double length, double *begin,
                        double *end)
{
    double a = -at / slope;
    double b = (length - at) / slope;

    if (slope == 0) {
        if (at < 0 || at > length)
            *end = -1;
        return;
    }
    *begin = fmax(*begin, fmin(a, b));
    *end = fmin(*end, fmax(a, b));
}

void frame_line(struct frame *frame, double x0, double y0, double x1, double y1,
                uint32_t rgb)
{
    double dx = x1 - x0, dy = y1 - y0;
    double begin = 0, end = 1;
    int steps;

    /* clip as Liang and Barsky 1984, since a line may extend far beyond the
     * frame */
    keep_inside(x0, dx, frame->width, &begin, &end);
    keep_inside(y0, dy, frame->height, &begin, &end);
    if (!(begin <= end))
        return;
    /* steps are shorter than a pixel, so that rounding leaves no gaps */
    steps = (int)(fmax(fabs(dx), fabs(dy)) * (end - begin)) + 2;
    for (int i = 0; i <= steps; i++) {
        double t = begin + (end - begin) * i / steps;

        frame_dot(frame, x0 + t * dx, y0 + t * dy, rgb);
    }
}

void frame_box(struct frame *frame, double x0, double y0, double x1, double y1,
               uint32_t rgb)
{
    frame_line(frame, x0, y0, x1, y0, rgb);
    frame_line(frame, x1, y0, x1, y1, rgb);
    frame_line(frame, x1, y1, x0, y1, rgb);
    frame_line(frame, x0, y1, x0, y0, rgb);
}

uint32_t frame_dim(uint32_t rgb, double brightness)
{
    uint32_t dim = 0;

    for (int shift = 0; shift <= 16; shift += 8)
        dim |= (uint32_t)((double)(rgb >> shift & 255) * brightness + 0.5)
               << shift;
    return dim;
}
