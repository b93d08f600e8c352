// SPDX-License-Identifier: MIT
#include "studio/plots.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Dots of a braille character. */
#define ACROSS 2
#define DOWN   4

#define WIDTH  (ACROSS * PLOT_COLS)
#define HEIGHT (DOWN * PLOT_ERROR_ROWS)

/* Dots between those of the continuation. */
#define PAUSE 3

/* Times of the target further than this are not shown: the course would be
 * squeezed. */
#define AHEAD_MAX 100

/* Dots of a plot, row 0 at the top; of lower plots the first rows. */
struct dots {
    bool is_set[HEIGHT][WIDTH];
};

/* Writes the character with the dots of a cell. Braille has Unicode's bits; an
 * ASCII character shows how high the dots are piled. */
static int put_cell(char *to, const struct dots *d, int row, int col,
                    bool has_unicode)
{
    static const unsigned char bits[DOWN][ACROSS] = {{0x01, 0x08},
                                                     {0x02, 0x10},
                                                     {0x04, 0x20},
                                                     {0x40, 0x80}};
    int count[ACROSS] = {0, 0};
    unsigned set = 0;

    for (int y = 0; y < DOWN; y++) {
        for (int x = 0; x < ACROSS; x++) {
            if (!d->is_set[DOWN * row + y][ACROSS * col + x])
                continue;
            set |= bits[y][x];
            count[x]++;
        }
    }
    if (!has_unicode) {
        to[0] = " .:|#"[count[0] > count[1] ? count[0] : count[1]];
        return 1;
    }
    to[0] = (char)0xe2;
    to[1] = (char)(0xa0 | set >> 6);
    to[2] = (char)(0x80 | (set & 0x3f));
    return 3;
}

static void format_rows(char rows[][PLOT_BYTES], int row_count,
                        const struct dots *d, bool has_unicode)
{
    for (int row = 0; row < row_count; row++) {
        char *to = rows[row];

        for (int col = 0; col < PLOT_COLS; col++)
            to += put_cell(to, d, row, col, has_unicode);
        *to = '\0';
    }
}

void plot_speeds(char rows[PLOT_SPEED_ROWS][PLOT_BYTES],
                 const struct speeds *speeds, double top, bool has_unicode)
{
    const int height = DOWN * PLOT_SPEED_ROWS;
    struct dots d = {{{false}}};

    for (int x = 0; x < WIDTH && x < speeds->count && top > 0; x++) {
        int count = (int)(speeds_at(speeds, x) / top * height + 0.5);

        for (int y = 0; y < count && y < height; y++)
            d.is_set[height - 1 - y][x] = true;
    }
    format_rows(rows, PLOT_SPEED_ROWS, &d, has_unicode);
}

/* ---- errors ---- */

struct plot {
    double from_s, to_s, high, low; /* ends of the axes */
    struct dots dots;
};

/* Returns the place of a value between the ends of a logarithmic axis. */
static int place(double value, double from, double to, int count)
{
    double part =
        from < to || from > to ? log(value / from) / log(to / from) : 0;

    return (int)(fmin(fmax(part, 0), 1) * (count - 1) + 0.5);
}

static void set_dot(struct plot *p, double time_s, double error)
{
    p->dots.is_set[place(error, p->high, p->low, HEIGHT)]
                  [place(time_s, p->from_s, p->to_s, WIDTH)] = true;
}

/* Draws a line that is straight on logarithmic axes, every `step` dots. */
static void draw_line(struct plot *p, struct error_then a, struct error_then b,
                      int step)
{
    int first = place(a.time_s, p->from_s, p->to_s, WIDTH);
    int last = place(b.time_s, p->from_s, p->to_s, WIDTH);

    set_dot(p, b.time_s, b.error);
    for (int x = first; x < last; x += step) {
        double part = (double)(x - first) / (last - first);

        set_dot(p, a.time_s * pow(b.time_s / a.time_s, part),
                a.error * pow(b.error / a.error, part));
    }
}

static void set_axes(struct plot *p, const struct error_history *h)
{
    p->from_s = h->points[0].time_s;
    p->to_s = h->points[h->count - 1].time_s;
    p->high = p->low = h->points[0].error;
    for (int i = 1; i < h->count; i++) {
        p->high = fmax(p->high, h->points[i].error);
        p->low = fmin(p->low, h->points[i].error);
    }
}

void plot_errors(char rows[PLOT_ERROR_ROWS][PLOT_BYTES],
                 const struct error_history *h, double target, double target_s,
                 bool has_unicode)
{
    struct plot p = {.from_s = 0};
    struct error_then last = {0, 0}, end = {target_s, target};
    bool goes_on;

    for (int row = 0; row < PLOT_ERROR_ROWS; row++)
        snprintf(rows[row], PLOT_BYTES, "%*s", PLOT_COLS, "");
    if (h->count < 2)
        return;
    last = h->points[h->count - 1];
    goes_on = target_s > last.time_s && target_s < AHEAD_MAX * last.time_s &&
              target > 0 && target < last.error;
    set_axes(&p, h);
    if (goes_on) {
        p.to_s = target_s;
        p.low = fmin(p.low, target);
        draw_line(&p, last, end, PAUSE);
    }
    for (int i = 1; i < h->count; i++)
        draw_line(&p, h->points[i - 1], h->points[i], 1);
    format_rows(rows, PLOT_ERROR_ROWS, &p.dots, has_unicode);
}
