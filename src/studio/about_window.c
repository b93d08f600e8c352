// SPDX-License-Identifier: MIT
#include "studio/about_window.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/print.h"
#include "render/error_text.h"
#include "studio/status_line.h"
#include "terminal/xmalloc.h"

#define NUMBER_BYTES 16

void about_number(char *text, size_t size_bytes, double value)
{
    static const char units[] = " kMGTPE";
    int unit = 0;

    while (value >= 999.5 && units[unit + 1] != '\0') {
        value *= 1e-3;
        unit++;
    }
    if (unit == 0)
        snprintf(text, size_bytes, "%.0f ", value);
    else
        snprintf(text, size_bytes, "%.*f %c",
                 value < 9.995   ? 2
                 : value < 99.95 ? 1
                                 : 0,
                 value, units[unit]);
}

/* Formats a number a second. */
static void format_rate(char text[NUMBER_BYTES], uint64_t count,
                        uint64_t time_ns)
{
    about_number(text, NUMBER_BYTES,
                 time_ns > 0 ? (double)count * 1e9 / (double)time_ns : 0);
}

void about_speed(const struct live_render *control, char *text,
                 size_t size_bytes)
{
    const struct render_progress *p = &control->progress;
    char rate[NUMBER_BYTES];

    format_rate(rate, p->samples + p->draft_samples, p->render_ns);
    snprintf(text, size_bytes, "%ssamples/s", rate);
}

/* ---- lines ---- */

/* Puts one text at the left end of the line and one at the right, if it has
 * room. */
static void put_sides(char *line, const char *left, const char *right)
{
    int gap = ABOUT_COLS - text_width_of(left) - text_width_of(right);

    if (gap > 0)
        snprintf(line, ABOUT_BYTES, "%s%*s%s", left, gap, "", right);
    else
        text_width_cut(line, ABOUT_BYTES, left, ABOUT_COLS);
}

static void format_device(char *line, const struct about_facts *f)
{
    char left[64], right[32] = "";

    if (f->device) {
        snprintf(left, sizeof left, "OpenCL %.40s", f->device);
    } else {
        snprintf(left, sizeof left, "CPU, %d thread%s", f->thread_count,
                 print_plural((uint64_t)f->thread_count));
        snprintf(right, sizeof right, "busy %.0f %%", 100 * f->load);
    }
    put_sides(line, left, right);
}

static void format_picture(char *line, const struct about_facts *f)
{
    const struct render_progress *p = f->progress;
    char left[64], right[64];

    snprintf(left, sizeof left, "%dx%d pixels", f->width_px, f->height_px);
    if (p->spp_limit > 0)
        snprintf(right, sizeof right, "%" PRIu64 " of %" PRIu64 " spp",
                 p->spp_done, p->spp_limit);
    else
        snprintf(right, sizeof right, "%" PRIu64 " spp", p->spp_done);
    put_sides(line, left, right);
}

static void format_count(char *line, const char *name, uint64_t count,
                         uint64_t time_ns)
{
    char number[NUMBER_BYTES], rate[NUMBER_BYTES], left[64], right[64];

    about_number(number, sizeof number, (double)count);
    format_rate(rate, count, time_ns);
    snprintf(left, sizeof left, "%-8s%9s", name, number);
    snprintf(right, sizeof right, "%s%s/s", rate, name);
    put_sides(line, left, right);
}

static void format_noise(char *line, const struct film_error *error)
{
    struct film_error e = *error;
    char interval[ERROR_TEXT_BYTES];

    e.is_resolved = true;
    error_text_interval(interval, &e);
    put_sides(line,
              e.is_known && !error->is_resolved ? "noise, few pixels" : "noise",
              interval);
}

static void format_time(char *line, const struct render_progress *p)
{
    char elapsed[24], left_time[24] = "";
    char left[48], right[48] = "no limit";

    status_line_duration(elapsed, sizeof elapsed, p->render_ns);
    snprintf(left, sizeof left, "%s of rendering", elapsed);
    if (status_line_left(left_time, sizeof left_time, p))
        snprintf(right, sizeof right, "left %s", left_time);
    put_sides(line, left, right);
}

/* ---- ranks ---- */

/* Returns true if rank a is to be shown before rank b. */
static bool comes_first(const struct rank_progress *a,
                        const struct rank_progress *b)
{
    bool a_is_late = rank_is_late(a), b_is_late = rank_is_late(b);

    if (a_is_late != b_is_late)
        return a_is_late;
    return rank_rate(a) < rank_rate(b);
}

/* Chooses the ranks that are shown, in the order of their numbers. */
static int choose_ranks(const struct about_facts *f, int chosen[ABOUT_RANKS])
{
    int count = 0;

    for (int i = 0; i < f->rank_count; i++) {
        int before = 0;

        for (int k = 0; k < f->rank_count; k++)
            before += comes_first(&f->ranks[k], &f->ranks[i]) ||
                      (k < i && !comes_first(&f->ranks[i], &f->ranks[k]));
        if (before < ABOUT_RANKS)
            chosen[count++] = i;
    }
    return count;
}

static void format_rank_title(char *line, const struct about_facts *f)
{
    char left[32], right[32] = "";
    int late = 0;

    for (int i = 0; i < f->rank_count; i++)
        late += rank_is_late(&f->ranks[i]);
    snprintf(left, sizeof left, "%d ranks", f->rank_count);
    if (late > 0)
        snprintf(right, sizeof right, "%d late", late);
    else if (f->rank_count > ABOUT_RANKS)
        snprintf(right, sizeof right, "the slowest %d", ABOUT_RANKS);
    put_sides(line, left, right);
}

static void format_rank(char *line, const struct rank_progress *p, int rank)
{
    char samples[NUMBER_BYTES], rate[NUMBER_BYTES], silent[24];
    char left[64], right[32];

    about_number(samples, sizeof samples, (double)p->samples);
    about_number(rate, sizeof rate, rank_rate(p));
    status_line_duration(silent, sizeof silent, p->silent_ns);
    snprintf(left, sizeof left, "rank %-5d%8s", rank, samples);
    snprintf(right, sizeof right, rank_is_late(p) ? "late %s" : "%s/s",
             rank_is_late(p) ? silent : rate);
    put_sides(line, left, right);
}

int about_format(char lines[ABOUT_ROWS][ABOUT_BYTES],
                 const struct about_facts *f)
{
    const struct render_progress *p = f->progress;
    int row = 0, chosen[ABOUT_RANKS], count = choose_ranks(f, chosen);

    format_device(lines[row++], f);
    format_picture(lines[row++], f);
    format_count(lines[row++], "samples", p->samples, p->render_ns);
    format_count(lines[row++], "rays", p->rays, p->render_ns);
    format_noise(lines[row++], &p->film_error);
    format_time(lines[row++], p);
    put_sides(lines[row++], f->glyphs, f->colors);
    if (count > 0)
        format_rank_title(lines[row++], f);
    for (int i = 0; i < count; i++)
        format_rank(lines[row++], &f->ranks[chosen[i]], chosen[i]);
    return row;
}

/* ---- the window ---- */

static double mean_load(const struct live_render *control,
                        const struct backend *b)
{
    double sum = 0;

    for (int i = 0; i < b->thread_count; i++)
        sum += thread_load_share(&control->session->load, b, i,
                                 control->progress.render_ns);
    return b->thread_count > 0 ? sum / b->thread_count : 0;
}

void about_window_draw(const struct live_render *control, struct screen *screen)
{
    struct render *render = control->session->engine.render;
    const struct backend *b = render_backend(render);
    struct rank_progress *ranks = xcalloc((size_t)b->rank_count, sizeof *ranks);
    char texts[ABOUT_ROWS][ABOUT_BYTES];
    const char *lines[ABOUT_ROWS];
    struct about_facts facts = {
        .progress = &control->progress,
        .device = b->device,
        .thread_count = b->thread_count,
        .load = mean_load(control, b),
        .width_px = render_film(render)->width,
        .height_px = render_film(render)->height,
        .glyphs = screen_glyphs_name(screen),
        .colors = palette_name(screen->display.palette),
        .ranks = ranks,
        .rank_count = b->rank_count,
    };
    int count;

    for (int i = 0; i < b->rank_count; i++)
        ranks[i] = b->rank_progress(b, i);
    count = about_format(texts, &facts);
    free(ranks);
    for (int i = 0; i < count; i++)
        lines[i] = texts[i];
    if (screen->window.cols == 0)
        screen_open_window(screen, WINDOW_TOP_LEFT, " about this render ",
                           lines, count);
    else
        screen_set_window(screen, lines, count);
}
