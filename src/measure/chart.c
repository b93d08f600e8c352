// SPDX-License-Identifier: MIT
#include "measure/chart.h"

#include <math.h>
#include <string.h>

#include "measure/axis.h"
#include "measure/drawing.h"
#include "picture/image_write.h"

#define WIDTH  880
#define HEIGHT 540

/* Borders of the diagram; the names of the curves are at its right. */
#define LEFT   90
#define TOP    64
#define BOTTOM 470
#define MARGIN 30

/* Heights of capitals. */
#define TITLE_PX 15
#define TEXT_PX  11

/* Keys of the names: a piece of line, and the distance of rows. */
#define KEY_PX     26
#define KEY_ROW_PX 26

#define LINE_PX  2.4
#define GUIDE_PX 1.2
#define DOT_PX   8
#define DASH_PX  7

/* Ticks that are no power of ten have labels up to this many powers. */
#define LABELLED_X 2.5
#define LABELLED_Y 5

#define BLACK      0x222222u
#define GUIDE_GRAY 0x777777u
#define LINE_GRAY  0xececec
#define POWER_GRAY 0xcccccc

/* Colours that colour-blind people can tell apart (Okabe and Ito 2008). Curves
 * beyond them have the same colours with hollow dots. */
static const uint32_t colors[] = {0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7,
                                  0xe69f00, 0x56b4e9, 0x555555};

enum { COLORS = sizeof colors / sizeof *colors };

/* A chart in the making. */
struct sheet {
    struct frame frame;
    struct axis x, y;
    int right; /* border of the diagram */
};

static void put_label(struct sheet *s, const struct axis_tick *tick,
                      bool is_labelled, double x, double y,
                      enum drawing_align align)
{
    if (tick->is_power || is_labelled)
        drawing_text(&s->frame, x, y, TEXT_PX, align, tick->label, BLACK);
}

/* Draws the lines of powers of ten, or those between. */
static void put_ticks(struct sheet *s, bool is_power)
{
    uint32_t color = is_power ? POWER_GRAY : LINE_GRAY;
    struct axis_tick tick;

    for (int i = 0; axis_tick(&s->x, i, &tick); i++) {
        int x = (int)axis_place(&s->x, tick.value);

        if (tick.is_power != is_power)
            continue;
        drawing_box(&s->frame, x, TOP, 1, BOTTOM - TOP, color);
        put_label(s, &tick, s->x.high - s->x.low < LABELLED_X, x + 0.5,
                  BOTTOM + 12 + TEXT_PX, DRAWING_CENTRE);
    }
    for (int i = 0; axis_tick(&s->y, i, &tick); i++) {
        int y = (int)axis_place(&s->y, tick.value);

        if (tick.is_power != is_power)
            continue;
        drawing_box(&s->frame, LEFT, y, s->right - LEFT, 1, color);
        put_label(s, &tick, s->y.high - s->y.low < LABELLED_Y, LEFT - 10,
                  y + 0.5 * TEXT_PX, DRAWING_RIGHT);
    }
}

static void put_dashes(struct frame *f, const double x[2], const double y[2])
{
    double length = hypot(x[1] - x[0], y[1] - y[0]);
    int count = (int)(length / (2 * DASH_PX));

    for (int i = 0; i <= count; i++) {
        double xs[2], ys[2];

        for (int k = 0; k < 2; k++) {
            double t = fmin((2 * i + k) * DASH_PX / length, 1);

            xs[k] = x[0] + t * (x[1] - x[0]);
            ys[k] = y[0] + t * (y[1] - y[0]);
        }
        drawing_line(f, 2, xs, ys, GUIDE_PX, GUIDE_GRAY);
    }
}

/* Draws a curve through places on the sheet. `number` gives its colour. */
static void put_curve(struct frame *f, int number, int count, const double *x,
                      const double *y)
{
    uint32_t color = colors[number % COLORS];

    drawing_line(f, count, x, y, LINE_PX, color);
    for (int i = 0; i < count; i++) {
        drawing_line(f, 1, &x[i], &y[i], DOT_PX, color);
        if (number >= COLORS)
            drawing_line(f, 1, &x[i], &y[i], DOT_PX - 2 * LINE_PX, 0xffffff);
    }
}

static void put_series(struct sheet *s, const struct series *series, int number)
{
    double x[SERIES_POINTS], y[SERIES_POINTS];
    int count = 0;

    for (int i = 0; i < series->count; i++) {
        if (!axis_shows(series, i))
            continue;
        x[count] = axis_place(&s->x, series->x[i]);
        y[count++] = axis_place(&s->y, series->y[i]);
    }
    if (!series->is_guide)
        put_curve(&s->frame, number, count, x, y);
    for (int i = 0; series->is_guide && i + 1 < count; i++)
        put_dashes(&s->frame, x + i, y + i);
}

static void put_key(struct sheet *s, const struct series *series, int row,
                    int number)
{
    double y = TOP + 8 + row * KEY_ROW_PX;
    double xs[2] = {s->right + 20, s->right + 20 + KEY_PX}, ys[2] = {y, y};
    double middle = (xs[0] + xs[1]) / 2;

    if (series->is_guide) {
        put_dashes(&s->frame, xs, ys);
    } else {
        drawing_line(&s->frame, 2, xs, ys, LINE_PX, colors[number % COLORS]);
        put_curve(&s->frame, number, 1, &middle, &y);
    }
    drawing_text(&s->frame, xs[1] + 12, y + 0.5 * TEXT_PX, TEXT_PX,
                 DRAWING_LEFT, series->name, BLACK);
}

/* Returns the border of the diagram that leaves place for the longest name. */
static int right_border(const struct chart *chart)
{
    double widest = 0;

    for (int i = 0; i < chart->series_count; i++)
        widest =
            fmax(widest, drawing_text_width(TEXT_PX, chart->series[i].name));
    return (int)fmax(WIDTH - MARGIN - widest - KEY_PX - 32, 0.5 * WIDTH);
}

static void draw(struct sheet *s, const struct chart *chart)
{
    int number = 0;

    drawing_box(&s->frame, 0, 0, WIDTH, HEIGHT, 0xffffff);
    put_ticks(s, false);
    put_ticks(s, true);
    drawing_box(&s->frame, LEFT, TOP, 1, BOTTOM - TOP, BLACK);
    drawing_box(&s->frame, LEFT, BOTTOM, s->right - LEFT, 1, BLACK);
    drawing_text(&s->frame, LEFT, 30, TITLE_PX, DRAWING_LEFT, chart->title,
                 BLACK);
    drawing_text(&s->frame, MARGIN, TOP - 10, TEXT_PX, DRAWING_LEFT,
                 chart->y_label, BLACK);
    drawing_text(&s->frame, 0.5 * (LEFT + s->right), BOTTOM + 50, TEXT_PX,
                 DRAWING_CENTRE, chart->x_label, BLACK);
    for (int i = 0; i < chart->series_count; i++) {
        put_series(s, &chart->series[i], number);
        put_key(s, &chart->series[i], i, number);
        number += !chart->series[i].is_guide;
    }
}

bool chart_write(const struct chart *chart, const char *path, struct error *err)
{
    struct sheet s = {.right = right_border(chart)};
    bool ok;

    s.x = (struct axis){.from = LEFT, .to = s.right};
    s.y =
        (struct axis){.is_linear = chart->is_linear, .from = BOTTOM, .to = TOP};
    if (!axes_fit(&s.x, &s.y, chart->series, chart->series_count))
        return fail(err, "%s: found no point to draw", path);
    if (!frame_init(&s.frame, WIDTH, HEIGHT, err))
        return false;
    draw(&s, chart);
    ok = image_write_frame(&s.frame, path, err);
    frame_free(&s.frame);
    return ok;
}
