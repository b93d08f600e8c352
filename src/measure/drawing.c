// SPDX-License-Identifier: MIT
#include "measure/drawing.h"

#include <math.h>
#include <stddef.h>

#include "measure/lettering.h"

/* Thickness of the strokes of letters, over the height of capitals. */
#define STROKE_THICKNESS 0.12

void drawing_box(struct frame *f, int x, int y, int width, int height,
                 uint32_t color)
{
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++)
            frame_dot(f, x + i, y + j, color);
}

/* Returns the square of the distance of a point from part i of a line. */
static double distance_square(const double *x, const double *y, int i,
                              double px, double py)
{
    double dx = x[i + 1] - x[i], dy = y[i + 1] - y[i];
    double length_square = dx * dx + dy * dy, t = 0;

    if (length_square > 0)
        t = ((px - x[i]) * dx + (py - y[i]) * dy) / length_square;
    t = fmin(fmax(t, 0), 1);
    dx = px - x[i] - t * dx;
    dy = py - y[i] - t * dy;
    return dx * dx + dy * dy;
}

/* Mixes the colour into a pixel. */
static void blend(struct frame *f, int x, int y, double share, uint32_t color)
{
    uint8_t *rgb;

    if (x < 0 || y < 0 || x >= f->width || y >= f->height || !(share > 0))
        return;
    rgb = f->rgb + 3 * ((size_t)y * (size_t)f->width + (size_t)x);
    share = fmin(share, 1);
    for (int c = 0; c < 3; c++) {
        double own = (color >> (16 - 8 * c)) & 255;

        rgb[c] = (uint8_t)(rgb[c] + share * (own - rgb[c]) + 0.5);
    }
}

/* Draws a dot, or the pixels whose distance from the line is below half of the
 * thickness; those at the border get a part of the colour. */
void drawing_line(struct frame *f, int count, const double *x, const double *y,
                  double thickness, uint32_t color)
{
    double reach = thickness / 2 + 0.5;
    double left = INFINITY, right = -INFINITY, top = INFINITY,
           bottom = -INFINITY;

    for (int i = 0; i < count; i++) {
        left = fmin(left, x[i]);
        right = fmax(right, x[i]);
        top = fmin(top, y[i]);
        bottom = fmax(bottom, y[i]);
    }
    left = fmax(left - reach, 0);
    top = fmax(top - reach, 0);
    right = fmin(right + reach, f->width);
    bottom = fmin(bottom + reach, f->height);
    for (int py = (int)top; py < bottom; py++)
        for (int px = (int)left; px < right; px++) {
            double nearest = pow(x[0] - px - 0.5, 2) + pow(y[0] - py - 0.5, 2);

            for (int i = 0; i + 1 < count; i++)
                nearest =
                    fmin(nearest, distance_square(x, y, i, px + 0.5, py + 0.5));
            blend(f, px, py, reach - sqrt(nearest), color);
        }
}

double drawing_text_width(double height, const char *text)
{
    int width = 0;

    for (const char *c = text; *c != '\0'; c++)
        width += lettering_width(*c) + (c[1] != '\0' ? LETTER_GAP : 0);
    return width * height / LETTER_HEIGHT;
}

void drawing_text(struct frame *f, double x, double y, double height,
                  enum drawing_align align, const char *text, uint32_t color)
{
    double scale = height / LETTER_HEIGHT;

    x -= drawing_text_width(height, text) * 0.5 * align;
    for (; *text != '\0'; text++) {
        const char *at = NULL;
        struct stroke s;

        while (lettering_stroke(*text, &at, &s)) {
            for (int i = 0; i < s.count; i++) {
                s.x[i] = x + scale * s.x[i];
                s.y[i] = y - scale * s.y[i];
            }
            drawing_line(f, s.count, s.x, s.y, STROKE_THICKNESS * height,
                         color);
        }
        x += scale * (lettering_width(*text) + LETTER_GAP);
    }
}
