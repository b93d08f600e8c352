// SPDX-License-Identifier: MIT
#include "studio/progress_text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/print.h"
#include "render/error_text.h"
#include "render/progress.h"
#include "studio/status_line.h"

#define NUMBER_BYTES 16

void progress_text_number(char *text, size_t size_bytes, double value)
{
    static const char units[] = " kMGTPE";
    int unit = 0;

    while (value >= 999.5 && units[unit + 1] != '\0') {
        value *= 1e-3;
        unit++;
    }
    if (unit == 0)
        snprintf(text, size_bytes, "%.0f", value);
    else
        snprintf(text, size_bytes, "%.*f %c",
                 value < 9.995   ? 2
                 : value < 99.95 ? 1
                                 : 0,
                 value, units[unit]);
}

/* Copies a character and returns its end. */
static char *put(char *to, const char *character)
{
    size_t length = strlen(character);

    memcpy(to, character, length + 1);
    return to + length;
}

/* Puts one text at the left end of the line and one at the right. */
static void put_sides(char *line, const char *left, const char *right)
{
    int gap = PROGRESS_TEXT_COLS - (int)strlen(left) - (int)strlen(right);

    snprintf(line, PROGRESS_TEXT_BYTES, "%.*s%*s%s", PROGRESS_TEXT_COLS, left,
             gap > 0 ? gap : 0, "", gap >= 0 ? right : "");
}

static void format_done(char *line, const struct render_progress *p)
{
    bool has_limit =
        p->spp_limit > 0 || p->error_limit > 0 || p->time_limit_ns > 0;
    char left[64], right[16] = "no limit";

    if (p->spp_limit > 0)
        snprintf(left, sizeof left, "%" PRIu64 " of %" PRIu64 " spp",
                 p->spp_done, p->spp_limit);
    else
        snprintf(left, sizeof left, "%" PRIu64 " spp", p->spp_done);
    if (has_limit)
        snprintf(right, sizeof right, "%.1f %%", 100 * render_left(p).part);
    put_sides(line, left, right);
}

/* The interval gives way to the words for an unresolved error. */
static void format_noise(char *line, const struct render_progress *p)
{
    struct film_error e = p->film_error;
    const char *left =
        e.is_known && !e.is_resolved ? "noise, few pixels" : "noise";
    char interval[ERROR_TEXT_BYTES];

    e.is_resolved = true;
    error_text_interval(interval, &e);
    if (strlen(left) + 1 + strlen(interval) > PROGRESS_TEXT_COLS)
        interval[strcspn(interval, "(") - 1] = '\0';
    put_sides(line, left, interval);
}

static void format_rate(char *line, const char *name, uint64_t count,
                        uint64_t time_ns)
{
    double rate = time_ns > 0 ? (double)count * 1e9 / (double)time_ns : 0;
    char number[NUMBER_BYTES], a_second[NUMBER_BYTES];
    char left[64], right[32];

    progress_text_number(number, sizeof number, (double)count);
    progress_text_number(a_second, sizeof a_second, rate);
    snprintf(left, sizeof left, "%-8s%9s", name, number);
    snprintf(right, sizeof right, "%s/s", a_second);
    put_sides(line, left, right);
}

static void format_time(char *line, const struct render_progress *p)
{
    char elapsed[24], left_time[24] = "";
    char left[48], right[48] = "";

    status_line_duration(elapsed, sizeof elapsed, p->render_ns);
    snprintf(left, sizeof left, "%-8s%9s", "elapsed", elapsed);
    if (p->state == RENDER_RUNNING &&
        status_line_left(left_time, sizeof left_time, p))
        snprintf(right, sizeof right, "left %s", left_time);
    put_sides(line, left, right);
}

/* ---- diagrams ---- */

static double top_speed(const struct speeds *s)
{
    double top = 0;

    for (int i = 0; i < s->count; i++)
        top = fmax(top, speeds_at(s, i));
    return top;
}

static void format_plot_title(char *line, const struct speeds *s)
{
    char now[NUMBER_BYTES], top[NUMBER_BYTES], right[48];

    /* the last span is skipped, as it may have begun a moment ago */
    progress_text_number(now, sizeof now,
                         s->count > 0
                             ? speeds_at(s, s->count > 1 ? s->count - 2 : 0)
                             : 0);
    progress_text_number(top, sizeof top, top_speed(s));
    snprintf(right, sizeof right, "%s, most %s", now, top);
    put_sides(line, "samples/s", right);
}

static double mean_load(const double *loads, int begin, int end)
{
    double sum = 0;

    for (int i = begin; i < end; i++)
        sum += loads[i];
    return end > begin ? sum / (end - begin) : 0;
}

/* Formats the loads with one column per thread, or per group of threads if
 * there are more threads than columns. */
static void format_loads(char *line, const struct progress_text_facts *f)
{
    static const char ascii[] = "_.:-=+*#@";
    int cols =
        f->load_count < PROGRESS_TEXT_COLS ? f->load_count : PROGRESS_TEXT_COLS;

    line[0] = '\0';
    for (int i = 0; i < cols; i++) {
        double load = mean_load(f->loads, i * f->load_count / cols,
                                (i + 1) * f->load_count / cols);
        int eighths = (int)(load * 8 + 0.5);
        char cell[4] = {ascii[eighths]};

        if (f->has_unicode) /* U+2581 to U+2588; the lowest one means idle */
            snprintf(cell, sizeof cell, "\xe2\x96%c",
                     (char)(0x80 + (eighths > 0 ? eighths : 1)));
        line = put(line, cell);
    }
}

static void format_load_title(char *line, const struct progress_text_facts *f)
{
    char left[32], right[32] = "";

    if (f->load_count == 0) {
        put_sides(line, "an OpenCL device renders", "");
        return;
    }
    snprintf(left, sizeof left, "%d thread%s", f->load_count,
             print_plural((uint64_t)f->load_count));
    snprintf(right, sizeof right, "busy %.0f %%",
             100 * mean_load(f->loads, 0, f->load_count));
    put_sides(line, left, right);
}

/* Formats the plot of the error with the time to its target. */
static int format_errors(char lines[][PROGRESS_TEXT_BYTES],
                         const struct progress_text_facts *f)
{
    const struct render_progress *p = f->progress;
    double target = p->error_limit > 0 ? p->error_limit
                                       : error_text_target(p->film_error.high);
    char right[48] = "";
    double ns = 0;

    if (p->state == RENDER_RUNNING && p->film_error.is_known &&
        p->film_error.high > target && render_left_to_error(p, target, &ns)) {
        char left[24];

        status_line_duration(left, sizeof left, ns < 1e18 ? (uint64_t)ns : 0);
        snprintf(right, sizeof right, "%g %% in %s", 100 * target, left);
    }
    put_sides(lines[0], "error", right);
    plot_errors(lines + 1, f->errors, target,
                ns > 0 ? (ns + (double)p->render_ns) * 1e-9 : 0,
                f->has_unicode);
    return 1 + PLOT_ERROR_ROWS;
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
static int choose_ranks(const struct progress_text_facts *f,
                        int chosen[PROGRESS_TEXT_RANKS])
{
    int count = 0;

    for (int i = 0; i < f->rank_count; i++) {
        int before = 0;

        for (int k = 0; k < f->rank_count; k++)
            before += comes_first(&f->ranks[k], &f->ranks[i]) ||
                      (k < i && !comes_first(&f->ranks[i], &f->ranks[k]));
        if (before < PROGRESS_TEXT_RANKS)
            chosen[count++] = i;
    }
    return count;
}

static void format_rank_title(char *line, const struct progress_text_facts *f)
{
    char left[32], right[32] = "";
    int late = 0;

    for (int i = 0; i < f->rank_count; i++)
        late += rank_is_late(&f->ranks[i]);
    snprintf(left, sizeof left, "%d ranks", f->rank_count);
    if (late > 0)
        snprintf(right, sizeof right, "%d late", late);
    else if (f->rank_count > PROGRESS_TEXT_RANKS)
        snprintf(right, sizeof right, "the slowest %d", PROGRESS_TEXT_RANKS);
    put_sides(line, left, right);
}

static void format_rank(char *line, const struct rank_progress *p, int rank)
{
    char samples[NUMBER_BYTES], rate[NUMBER_BYTES], silent[24];
    char left[64], right[32];

    progress_text_number(samples, sizeof samples, (double)p->samples);
    progress_text_number(rate, sizeof rate, rank_rate(p));
    status_line_duration(silent, sizeof silent, p->silent_ns);
    snprintf(left, sizeof left, "rank %-5d%8s", rank, samples);
    snprintf(right, sizeof right, rank_is_late(p) ? "late %s" : "%s/s",
             rank_is_late(p) ? silent : rate);
    put_sides(line, left, right);
}

int progress_text_format(char lines[PROGRESS_TEXT_ROWS][PROGRESS_TEXT_BYTES],
                         const struct progress_text_facts *f)
{
    const struct render_progress *p = f->progress;
    int row = 0, chosen[PROGRESS_TEXT_RANKS], count = choose_ranks(f, chosen);

    format_done(lines[row++], p);
    lines[row++][0] = '\0'; /* PROGRESS_TEXT_GAUGE */
    format_noise(lines[row++], p);
    format_rate(lines[row++], "samples", p->samples, p->render_ns);
    format_rate(lines[row++], "rays", p->rays, p->render_ns);
    format_time(lines[row++], p);
    format_plot_title(lines[row++], f->speeds);
    plot_speeds(lines + row, f->speeds, top_speed(f->speeds), f->has_unicode);
    row += PLOT_SPEED_ROWS;
    format_load_title(lines[row++], f);
    format_loads(lines[row++], f);
    row += format_errors(lines + row, f);
    if (count > 0)
        format_rank_title(lines[row++], f);
    for (int i = 0; i < count; i++)
        format_rank(lines[row++], &f->ranks[chosen[i]], chosen[i]);
    return row;
}
