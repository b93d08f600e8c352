// SPDX-License-Identifier: MIT
#include "command/chart.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/print.h"
#include "base/text_stream.h"
#include "terminal/glyphs.h"
#include "terminal/xmalloc.h"

/* ---- axes ---- */

/* Range in decimal logarithms, and the dots of its ends. */
struct axis {
    double low, high;
    int from, to;
};

#define AXIS_LABEL_BYTES 32

struct axis_tick {
    double value;
    bool is_power; /* of ten */
    char label[AXIS_LABEL_BYTES];
};

/* Added at both ends. */
#define BORDER 0.05

/* True if the point has two numbers above 0. Others are not drawn. */
static bool axis_shows(const struct series *s, int point)
{
    return s->x[point] > 0 && s->y[point] > 0 && isfinite(s->x[point]) &&
           isfinite(s->y[point]);
}

static void include(struct axis *a, double value)
{
    a->low = fmin(a->low, log10(value) - BORDER);
    a->high = fmax(a->high, log10(value) + BORDER);
}

/* Sets the ranges of both axes to those of all points that are drawn. Returns
 * false if there is no point. */
static bool axes_fit(struct axis *x, struct axis *y,
                     const struct series *series, int series_count)
{
    x->low = y->low = INFINITY;
    x->high = y->high = -INFINITY;
    for (int i = 0; i < series_count; i++)
        for (int k = 0; k < series[i].count; k++)
            if (axis_shows(&series[i], k)) {
                include(x, series[i].x[k]);
                include(y, series[i].y[k]);
            }
    return x->low < x->high;
}

/* Returns the place of a value, which must be above 0. */
static double axis_place(const struct axis *a, double value)
{
    return a->from +
           (a->to - a->from) * (log10(value) - a->low) / (a->high - a->low);
}

static void set_label(struct axis_tick *tick, int factor, int power)
{
    if (power < -2 || power > 5)
        snprintf(tick->label, sizeof tick->label, "%de%d", factor, power);
    else
        snprintf(tick->label, sizeof tick->label, "%.6g", tick->value);
}

/* Returns tick `number`, from 0: 1, 2 and 5 times each power of ten on the
 * axis. Returns false after the last. */
static bool axis_tick(const struct axis *a, int number, struct axis_tick *tick)
{
    static const int steps[] = {1, 2, 5};

    for (int power = (int)floor(a->low); power <= a->high; power++)
        for (int i = 0; i < 3; i++) {
            double value = steps[i] * pow(10, power);

            if (log10(value) < a->low || log10(value) > a->high || number-- > 0)
                continue;
            tick->value = value;
            tick->is_power = i == 0;
            set_label(tick, steps[i], power);
            return true;
        }
    return false;
}

/* ---- a script for gnuplot ---- */

/* The colours can be told apart by colour-blind people (Okabe and Ito 2008). */
static const char settings[] = "set terminal pngcairo noenhanced size 880,540\n"
                               "set colorsequence podo\n"
                               "set logscale xy\n"
                               "set format '%g'\n"
                               "set grid\n"
                               "set key outside\n";

/* Writes a command and a text in quotes, which are doubled inside. */
static void write_text(FILE *to, const char *command, const char *text)
{
    char *safe = xstrdup(text);

    print_replace(safe);
    fprintf(to, "%s '", command);
    for (const char *c = safe; *c != '\0'; c++)
        fprintf(to, *c == '\'' ? "''" : "%c", *c);
    fprintf(to, "'");
    free(safe);
}

static void write_points(FILE *to, const struct series *s, int number)
{
    fprintf(to, "$curve%d << END\n", number);
    for (int i = 0; i < s->count; i++)
        if (axis_shows(s, i))
            fprintf(to, "%.6g %.6g\n", s->x[i], s->y[i]);
    fprintf(to, "END\n");
}

static void write_script(FILE *to, const struct chart *chart,
                         const char *png_path)
{
    fprintf(to, "%s", settings);
    write_text(to, "set output", png_path);
    write_text(to, "\nset title", chart->title);
    write_text(to, "\nset xlabel", chart->x_label);
    write_text(to, "\nset ylabel", chart->y_label);
    fprintf(to, "\n");
    for (int i = 0; i < chart->series_count; i++)
        write_points(to, &chart->series[i], i);
    for (int i = 0; i < chart->series_count; i++) {
        const struct series *s = &chart->series[i];

        fprintf(to, "%s $curve%d with %s", i == 0 ? "plot" : ", \\\n    ", i,
                s->is_guide ? "lines dashtype 2 linecolor 'grey40'"
                            : "linespoints linewidth 2 pointtype 7");
        write_text(to, " title", s->name);
    }
    fprintf(to, "\n");
}

bool chart_write(const struct chart *chart, const char *path, struct error *err)
{
    char *stem = path_stem(path);
    char *png_path = xformat("%s.png", stem);
    struct text_stream s;
    bool ok;

    if (text_stream_open(&s))
        write_script(s.to, chart, png_path);
    ok = text_stream_write(&s, path, err);
    free(png_path);
    free(stem);
    return ok;
}

/* ---- characters ---- */

/* Columns of the labels at the left, with the border. */
#define LABEL_COLS 8

/* Rows of the title, the border and the labels below. */
#define FRAME_ROWS 4

/* Every third dot of a guide is drawn. */
#define GUIDE_STEP 3

/* Dots, row 0 at the top: 0, or 1 + the kind of dot. */
enum dot { DOT_NONE, DOT_GUIDE, DOT_LINE, DOT_POINT };

struct canvas {
    int cols, rows; /* characters of the diagram alone */
    int across, down;
    uint8_t *dots;
};

static void put_dot(struct canvas *c, int x, int y, enum dot dot)
{
    int width = c->cols * c->across, height = c->rows * c->down;
    uint8_t *at;

    if (x < 0 || y < 0 || x >= width || y >= height)
        return;
    at = &c->dots[y * width + x];
    if (*at < dot)
        *at = (uint8_t)dot;
}

static void put_line(struct canvas *c, double x0, double y0, double x1,
                     double y1, bool is_guide)
{
    int steps = (int)fmax(fabs(x1 - x0), fabs(y1 - y0)) + 1;

    for (int i = 0; i <= steps; i++)
        if (!is_guide || i % GUIDE_STEP == 0)
            put_dot(c, (int)(x0 + (x1 - x0) * i / steps),
                    (int)(y0 + (y1 - y0) * i / steps),
                    is_guide ? DOT_GUIDE : DOT_LINE);
}

static void put_series(struct canvas *c, const struct series *s,
                       const struct axis *x, const struct axis *y)
{
    int before = -1;

    for (int i = 0; i < s->count; i++) {
        if (!axis_shows(s, i))
            continue;
        if (!s->is_guide)
            put_dot(c, (int)axis_place(x, s->x[i]), (int)axis_place(y, s->y[i]),
                    DOT_POINT);
        if (before >= 0)
            put_line(c, axis_place(x, s->x[before]),
                     axis_place(y, s->y[before]), axis_place(x, s->x[i]),
                     axis_place(y, s->y[i]), s->is_guide);
        before = i;
    }
}

/* Returns the mask of the dots of a character, as glyphs.h numbers them. */
static unsigned mask_at(const struct canvas *c, int col, int row)
{
    unsigned mask = 0;

    for (int i = 0; i < c->across * c->down; i++) {
        int x = col * c->across + i % c->across;
        int y = row * c->down + i / c->across;

        if (c->dots[y * c->cols * c->across + x] != DOT_NONE)
            mask |= 1u << i;
    }
    return mask;
}

static void write_row(FILE *to, const struct canvas *c, int row)
{
    static const char signs[] = {' ', '.', '.', '*'};

    for (int col = 0; col < c->cols; col++) {
        char bytes[5] = {0};

        if (c->across == 1) {
            bytes[0] = signs[c->dots[row * c->cols + col]];
        } else if (mask_at(c, col, row) == 0) {
            bytes[0] = ' ';
        } else {
            glyph_utf8(glyph_of_braille(mask_at(c, col, row)), bytes);
        }
        print_text(to, "%s", bytes);
    }
}

/* Returns the label of the row, "" if it has no tick: a power of ten before
 * another one. */
static void find_label(const struct canvas *c, const struct axis *y, int row,
                       char label[AXIS_LABEL_BYTES])
{
    struct axis_tick tick;
    bool has_power = false;

    label[0] = '\0';
    for (int i = 0; axis_tick(y, i, &tick); i++) {
        int at = (int)axis_place(y, tick.value) / c->down;

        if (at != row || has_power)
            continue;
        memcpy(label, tick.label, AXIS_LABEL_BYTES);
        has_power = tick.is_power;
    }
}

/* Writes the labels of the x axis that have room, powers of ten first. */
static void write_x_labels(FILE *to, const struct canvas *c,
                           const struct axis *x)
{
    char *line = xcalloc((size_t)c->cols + 2, 1);
    struct axis_tick tick;

    memset(line, ' ', (size_t)c->cols + 1);
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; axis_tick(x, i, &tick); i++) {
            int length = (int)strlen(tick.label);
            int at = (int)axis_place(x, tick.value) / c->across - length / 2;
            bool has_room = true;

            if (tick.is_power != (pass == 0))
                continue;
            at = at < 0 ? 0 : at > c->cols - length ? c->cols - length : at;
            for (int k = at - 1; has_room && k <= at + length; k++)
                has_room = k < 0 || k >= c->cols || line[k] == ' ';
            if (has_room)
                memcpy(line + at, tick.label, (size_t)length);
        }
    print_line(to, "%*s%s", LABEL_COLS, "", line);
    free(line);
}

/* Writes what the axes are, and what a guide is if there is room. */
static void write_title(FILE *to, const struct chart *chart, int cols)
{
    char axes[80], guide[80] = "";

    snprintf(axes, sizeof axes, "%s over %s", chart->y_label, chart->x_label);
    for (int i = 0; i < chart->series_count; i++)
        if (chart->series[i].is_guide)
            snprintf(guide, sizeof guide, "; dotted: %s",
                     chart->series[i].name);
    print_line(to, "%s%s", axes,
               (int)(strlen(axes) + strlen(guide)) <= cols ? guide : "");
}

void chart_write_text(FILE *to, const struct chart *chart, int cols, int rows,
                      bool has_braille)
{
    struct glyph_grid grid = glyphs_grid(GLYPHS_BRAILLE);
    struct canvas c = {.across = has_braille ? grid.across : 1,
                       .down = has_braille ? grid.down : 1};
    struct axis x = {.from = 0}, y = {.to = 0};

    if (!axes_fit(&x, &y, chart->series, chart->series_count))
        return;
    c.cols = (cols > CHART_COLS_MIN ? cols : CHART_COLS_MIN) - LABEL_COLS;
    c.rows = (rows > CHART_ROWS_MIN ? rows : CHART_ROWS_MIN) - FRAME_ROWS;
    x.to = c.cols * c.across;
    y.from = c.rows * c.down;
    c.dots = xcalloc((size_t)c.cols * (size_t)c.rows,
                     (size_t)c.across * (size_t)c.down);
    for (int i = 0; i < chart->series_count; i++)
        put_series(&c, &chart->series[i], &x, &y);
    write_title(to, chart, c.cols + LABEL_COLS);
    for (int row = 0; row < c.rows; row++) {
        char label[AXIS_LABEL_BYTES];

        find_label(&c, &y, row, label);
        print_text(to, "%*s |", LABEL_COLS - 2, label);
        write_row(to, &c, row);
        print_line(to, "%s", "");
    }
    print_text(to, "%*s+", LABEL_COLS - 1, "");
    for (int col = 0; col < c.cols; col++)
        print_text(to, "-");
    print_line(to, "%s", "");
    write_x_labels(to, &c, &x);
    free(c.dots);
}
