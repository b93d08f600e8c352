// SPDX-License-Identifier: MIT
#include "measure/difference.h"

#include <math.h>

#include "inspect/false_color.h"

#define WHITE 0xffffff

/* The brightest colour is for this many times the root mean square, so that a
 * few bright pixels do not make all others black. */
#define SCALE 3.0

/* Dark pixels are compared with this radiance instead of their own, as in
 * relMSE. */
#define DARK 0.1

/* Returns the mean difference of a pixel's channels, relative to the reference.
 */
static double relative_at(const struct picture_pair *p, size_t pixel)
{
    double difference = 0, reference = 0;

    for (size_t i = 3 * pixel; i < 3 * pixel + 3; i++) {
        difference += ((double)p->rgb[i] - (double)p->reference[i]) / 3;
        reference += (double)p->reference[i] / 3;
    }
    return difference / hypot(reference, DARK);
}

static void draw_tiles(const struct tile_test *test, struct frame *frame)
{
    for (int i = 0; i < test->cols * test->rows; i++) {
        const struct tile *t = &test->tiles[i];

        if (t->differs)
            frame_box(frame, t->x + 0.5, t->y + 0.5, t->x + t->width - 0.5,
                      t->y + t->height - 0.5, WHITE);
    }
}

double difference_draw(const struct picture_pair *p,
                       const struct tile_test *test, struct frame *frame)
{
    size_t count = (size_t)p->width * (size_t)p->height;
    double squares = 0, full;

    for (size_t i = 0; i < count; i++)
        squares += relative_at(p, i) * relative_at(p, i);
    full = SCALE * sqrt(squares / (double)count);
    for (size_t i = 0; i < count; i++) {
        double part = full > 0 ? relative_at(p, i) / full : 0;
        uint32_t color = false_color_difference((float)part);

        for (int c = 0; c < 3; c++)
            frame->rgb[3 * i + (size_t)c] = (uint8_t)(color >> (16 - 8 * c));
    }
    draw_tiles(test, frame);
    return full;
}
