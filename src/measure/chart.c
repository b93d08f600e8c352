// SPDX-License-Identifier: MIT
#include "measure/chart.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/print.h"
#include "terminal/xmalloc.h"
#include "measure/axis.h"

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
    char *stem = path_stem(path), *script = NULL;
    char *png_path = xformat("%s.png", stem);
    size_t size_bytes;
    FILE *to = open_memstream(&script, &size_bytes);
    bool ok = to != NULL;

    if (ok) {
        write_script(to, chart, png_path);
        ok = fclose(to) == 0;
    }
    ok = ok ? file_write(path, script, size_bytes, false, NULL, err)
            : fail(err, "%s: out of memory", path);
    free(script);
    free(png_path);
    free(stem);
    return ok;
}
