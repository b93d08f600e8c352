// SPDX-License-Identifier: MIT
/*
 * plot - draws curves from standard input, lines of NAME,X,Y, as a PNG file
 *
 * usage: plot PICTURE.png TITLE X_LABEL Y_LABEL [linear]
 *
 * Both axes are logarithmic, or only that of x with "linear".
 * Curves have the order in which their names first occur. A curve whose name
 * begins with "-" is a guide, a thin line without points.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure/chart.h"
#include "terminal/xmalloc.h"

#define CURVES_MAX 16
#define LINE_BYTES 256

static struct series curves[CURVES_MAX];
static int curve_count;

static _Noreturn void stop(const char *text)
{
    fprintf(stderr, "plot: %s\n", text);
    exit(1);
}

static struct series *curve_named(const char *name)
{
    bool is_guide = name[0] == '-';

    name += is_guide;
    for (int i = 0; i < curve_count; i++)
        if (strcmp(curves[i].name, name) == 0)
            return &curves[i];
    if (curve_count == CURVES_MAX)
        stop("found too many curves");
    curves[curve_count] =
        (struct series){.name = xstrdup(name), .is_guide = is_guide};
    return &curves[curve_count++];
}

/* Reads a line NAME,X,Y. */
static void add_point(char *line)
{
    char *x = strchr(line, ','), *y, *end;
    struct series *s;

    if (x == NULL || (y = strchr(x + 1, ',')) == NULL)
        stop("expected lines of NAME,X,Y");
    *x = '\0';
    s = curve_named(line);
    if (s->count == SERIES_POINTS)
        stop("found too many points");
    s->x[s->count] = strtod(x + 1, &end);
    if (end != y)
        stop("expected a number for X");
    s->y[s->count++] = strtod(y + 1, &end);
    if (*end != '\n')
        stop("expected a number for Y");
}

int main(int argc, char **argv)
{
    struct chart chart = {.series = curves};
    char line[LINE_BYTES];
    struct error err;

    if (argc < 5) {
        fprintf(stderr,
                "usage: plot PICTURE.png TITLE X_LABEL Y_LABEL [linear]\n");
        return 2;
    }
    while (fgets(line, sizeof line, stdin) != NULL)
        add_point(line);
    chart.title = argv[2];
    chart.x_label = argv[3];
    chart.y_label = argv[4];
    chart.is_linear = argc > 5;
    chart.series_count = curve_count;
    if (!chart_write(&chart, argv[1], &err))
        stop(err.text);
    return 0;
}
