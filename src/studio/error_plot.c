// SPDX-License-Identifier: MIT
#include "studio/error_plot.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Dots of a braille character. */
#define ACROSS 2
#define DOWN   4

#define WIDTH  (ACROSS * PROGRESS_TEXT_COLS)
#define HEIGHT (DOWN * ERROR_PLOT_ROWS)

/* Dots between those of the continuation. */
#define PAUSE 3

/* Times of the target further than this are not shown: the course would be
 * squeezed. */
#define AHEAD_MAX 100

struct plot {
    double from_s, to_s, high, low; /* ends of the axes */
    bool dot[HEIGHT][WIDTH];
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
    p->dot[place(error, p->high, p->low, HEIGHT)]
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

/* Writes a braille character with the dots of a cell. The bits are Unicode's.
 */
static int put_braille(char *to, const struct plot *p, int row, int col)
{
    static const unsigned char bits[DOWN][ACROSS] = {{0x01, 0x08},
                                                     {0x02, 0x10},
                                                     {0x04, 0x20},
                                                     {0x40, 0x80}};
    unsigned set = 0;

    for (int y = 0; y < DOWN; y++)
        for (int x = 0; x < ACROSS; x++)
            if (p->dot[DOWN * row + y][ACROSS * col + x])
                set |= bits[y][x];
    to[0] = (char)0xe2;
    to[1] = (char)(0xa0 | set >> 6);
    to[2] = (char)(0x80 | (set & 0x3f));
    return 3;
}

static int put_ascii(char *to, const struct plot *p, int row, int col)
{
    to[0] = ' ';
    for (int y = 0; y < DOWN; y++)
        for (int x = 0; x < ACROSS; x++)
            if (p->dot[DOWN * row + y][ACROSS * col + x])
                to[0] = '*';
    return 1;
}

void error_plot_format(char rows[ERROR_PLOT_ROWS][PROGRESS_TEXT_BYTES],
                       const struct error_history *h, double target,
                       double target_s, bool has_unicode)
{
    struct plot p = {.from_s = 0};
    struct error_then last = {0, 0}, end = {target_s, target};
    bool goes_on;

    for (int row = 0; row < ERROR_PLOT_ROWS; row++)
        snprintf(rows[row], PROGRESS_TEXT_BYTES, "%*s", PROGRESS_TEXT_COLS, "");
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
    for (int row = 0; row < ERROR_PLOT_ROWS; row++) {
        char *to = rows[row];

        for (int col = 0; col < PROGRESS_TEXT_COLS; col++)
            to += has_unicode ? put_braille(to, &p, row, col)
                              : put_ascii(to, &p, row, col);
        *to = '\0';
    }
}
