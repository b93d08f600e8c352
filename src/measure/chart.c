// SPDX-License-Identifier: MIT
#include "measure/chart.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "measure/axis.h"
#include "picture/stb.h"
#include "terminal/xmalloc.h"

#define WIDTH  930
#define HEIGHT 600

/* Borders of the diagram; the names of the curves are at its right. */
#define LEFT   90
#define RIGHT  620
#define TOP    50
#define BOTTOM 530

/* A glyph is 4 pixels wide and 6 high, each of SCALE x SCALE. */
#define SCALE    2
#define ADVANCE  (5 * SCALE)
#define GLYPH_PX (6 * SCALE)

#define BLACK 0x000000u
#define GRAY  0xdddddd

/* Each hexadecimal digit is a row, the top one first. */
static const uint32_t letters[] = {0x699f99, 0xe9e99e, 0x698896, 0xe9999e,
                                   0xf8e88f, 0xf8e888, 0x698b96, 0x99f999,
                                   0xe4444e, 0x311196, 0x9acca9, 0x88888f,
                                   0x9ff999, 0x9ddbb9, 0x699996, 0xe99e88,
                                   0x6999a5, 0xe99ea9, 0x78611e, 0xe44444,
                                   0x999996, 0x9999a4, 0x999ff9, 0x996699,
                                   0xaa4444, 0xf1248f};
static const uint32_t digits[] = {0x69bd96, 0x4c444e, 0x69124f, 0xe1611e,
                                  0x99f111, 0xf8e11e, 0x68e996, 0xf12244,
                                  0x696996, 0x699716};
static const char marks[] = "-.,:+/_()";
static const uint32_t mark_glyphs[] = {0x00f000, 0x000004, 0x000024,
                                       0x040040, 0x04e400, 0x112448,
                                       0x00000f, 0x244442, 0x422224};

static const uint32_t colors[] = {0x000000, 0xd62728, 0x1f77b4, 0x2ca02c,
                                  0xff7f0e, 0x9467bd, 0x17a2b8, 0x8c564b};

struct screen {
    uint8_t rgb[HEIGHT][WIDTH][3];
};

static uint32_t glyph_of(char c)
{
    const char *mark = strchr(marks, c);

    if (isalpha((unsigned char)c))
        return letters[toupper((unsigned char)c) - 'A'];
    if (isdigit((unsigned char)c))
        return digits[c - '0'];
    return c != '\0' && mark != NULL ? mark_glyphs[mark - marks] : 0;
}

static void fill(struct screen *c, int x, int y, int width, int height,
                 uint32_t color)
{
    for (int j = y < 0 ? 0 : y; j < y + height && j < HEIGHT; j++)
        for (int i = x < 0 ? 0 : x; i < x + width && i < WIDTH; i++)
            for (int k = 0; k < 3; k++)
                c->rgb[j][i][k] = (uint8_t)(color >> (16 - 8 * k));
}

static void put_text(struct screen *c, int x, int y, const char *text)
{
    for (; *text != '\0'; text++, x += ADVANCE) {
        uint32_t glyph = glyph_of(*text);

        for (int i = 0; i < 24; i++)
            if ((glyph >> (23 - i) & 1) != 0)
                fill(c, x + i % 4 * SCALE, y + i / 4 * SCALE, SCALE, SCALE,
                     BLACK);
    }
}

static int text_width(const char *text)
{
    return (int)strlen(text) * ADVANCE;
}

static void put_line(struct screen *c, double x0, double y0, double x1,
                     double y1, int thickness, uint32_t color)
{
    int steps = (int)(fabs(x1 - x0) + fabs(y1 - y0)) + 1;

    for (int i = 0; i <= steps; i++) {
        double t = (double)i / steps;

        fill(c, (int)(x0 + t * (x1 - x0)), (int)(y0 + t * (y1 - y0)), thickness,
             thickness, color);
    }
}

/* Calls `put` for each tick of the axis. */
static void each_tick(struct screen *c, const struct axis *a,
                      void (*put)(struct screen *, int, const char *))
{
    struct axis_tick tick;

    for (int i = 0; axis_tick(a, i, &tick); i++)
        put(c, (int)axis_place(a, tick.value), tick.label);
}

static void put_x_tick(struct screen *c, int x, const char *label)
{
    fill(c, x, TOP, 1, BOTTOM - TOP, GRAY);
    fill(c, x, BOTTOM, 1, 6, BLACK);
    put_text(c, x - text_width(label) / 2, BOTTOM + 10, label);
}

static void put_y_tick(struct screen *c, int y, const char *label)
{
    fill(c, LEFT, y, RIGHT - LEFT, 1, GRAY);
    fill(c, LEFT - 6, y, 6, 1, BLACK);
    put_text(c, LEFT - 10 - text_width(label), y - GLYPH_PX / 2, label);
}

static void put_series(struct screen *c, const struct series *s,
                       const struct axis *x, const struct axis *y,
                       uint32_t color)
{
    int before = -1;

    for (int i = 0; i < s->count; i++) {
        if (!axis_shows(s, i))
            continue;
        if (!s->is_guide)
            fill(c, (int)axis_place(x, s->x[i]) - 2,
                 (int)axis_place(y, s->y[i]) - 2, 6, 6, color);
        if (before >= 0)
            put_line(c, axis_place(x, s->x[before]),
                     axis_place(y, s->y[before]), axis_place(x, s->x[i]),
                     axis_place(y, s->y[i]), s->is_guide ? 1 : 2, color);
        before = i;
    }
}

static void draw(struct screen *c, const struct chart *chart,
                 const struct axis *x, const struct axis *y)
{
    fill(c, 0, 0, WIDTH, HEIGHT, 0xffffff);
    each_tick(c, x, put_x_tick);
    each_tick(c, y, put_y_tick);
    fill(c, LEFT, TOP, 1, BOTTOM - TOP, BLACK);
    fill(c, LEFT, BOTTOM, RIGHT - LEFT, 1, BLACK);
    put_text(c, LEFT, 12, chart->title);
    put_text(c, 10, TOP - GLYPH_PX - 6, chart->y_label);
    put_text(c, (LEFT + RIGHT - text_width(chart->x_label)) / 2, BOTTOM + 35,
             chart->x_label);
    for (int i = 0; i < chart->series_count; i++) {
        uint32_t color = colors[(size_t)i % (sizeof colors / sizeof *colors)];

        put_series(c, &chart->series[i], x, y, color);
        fill(c, RIGHT + 15, TOP + 24 * i + 4, 20, 4, color);
        put_text(c, RIGHT + 45, TOP + 24 * i, chart->series[i].name);
    }
}

/* Destination of the encoder. */
struct output {
    void *data;
    size_t size_bytes, capacity;
};

static void append(void *context, void *data, int size_bytes)
{
    struct output *o = context;
    size_t more = (size_t)size_bytes;

    if (!grow_array(&o->data, &o->capacity, o->size_bytes + more, 1))
        return;
    memcpy((char *)o->data + o->size_bytes, data, more);
    o->size_bytes += more;
}

bool chart_write(const struct chart *chart, const char *path, struct error *err)
{
    struct axis x = {.from = LEFT, .to = RIGHT};
    struct axis y = {.from = BOTTOM, .to = TOP};
    struct output out = {NULL, 0, 0};
    struct screen *c;
    bool ok;

    if (!axes_fit(&x, &y, chart->series, chart->series_count))
        return fail(err, "%s: found no point to draw", path);
    c = xmalloc(sizeof *c);
    draw(c, chart, &x, &y);
    ok = stbi_write_png_to_func(append, &out, WIDTH, HEIGHT, 3, c->rgb,
                                3 * WIDTH) != 0
             ? file_write(path, out.data, out.size_bytes, false, NULL, err)
             : fail(err, "%s: out of memory", path);
    free(out.data);
    free(c);
    return ok;
}
