// SPDX-License-Identifier: MIT
#include "studio/progress_panel.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/print.h"
#include "render/error_text.h"
#include "render/progress.h"
#include "studio/status_line.h"
#include "terminal/gauge.h"
#include "terminal/xmalloc.h"

/* ---- plots ---- */

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

/* ---- text ---- */

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

/* ---- the panel ---- */

/* Time between two updates, long enough to read the numbers. */
#define UPDATE_NS UINT64_C(500000000)

/* The same on a slow line, which the picture needs. */
#define SLOW_NS UINT64_C(2000000000)

static const struct backend *backend_of(const struct live_render *control)
{
    return render_backend(control->session->engine.render);
}

uint64_t progress_panel_next_ns(const struct progress_panel *panel,
                                const struct live_render *control)
{
    bool changes =
        control->progress.state == RENDER_RUNNING || panel->due_ns == 0;

    return changes ? panel->due_ns : UINT64_MAX;
}

/* Measures the load of each thread since the last update. Loads are 0 if the
 * render is paused. */
static void measure_loads(struct progress_panel *panel,
                          const struct live_render *control, uint64_t now_ns,
                          double *loads)
{
    const struct backend *b = backend_of(control);
    bool is_running = control->progress.state == RENDER_RUNNING;

    for (int i = 0; i < b->thread_count && is_running; i++)
        loads[i] =
            thread_load_share(&panel->load, b, i, now_ns - panel->load_ns);
    thread_load_begin(&panel->load, b);
    panel->load_ns = now_ns;
}

/* Draws the gauge into its blank line, at a cell of a part of the screen. */
static void draw_gauge(const struct render_progress *p,
                       const struct screen *screen, enum window_part part_of,
                       int row, int col)
{
    const struct term_caps *d = &screen->display;
    struct cell cells[PROGRESS_TEXT_COLS];
    double part = 0;

    status_line_part(p, &part);
    gauge_cells(cells, PROGRESS_TEXT_COLS, part,
                theme_style(d->theme, d->palette, ROLE_GAUGE), d->has_unicode);
    windows_paint(part_of, row + PROGRESS_TEXT_GAUGE, col, cells,
                  PROGRESS_TEXT_COLS);
}

static void draw_window(const struct render_progress *p, struct screen *screen,
                        const char *const *lines, int count)
{
    if (screen->window.cols == 0)
        screen_open_window(screen, WINDOW_TOP_RIGHT, " progress ", lines,
                           count);
    else
        screen_set_window(screen, lines, count);
    draw_gauge(p, screen, WINDOW_OVER, 1, 2);
}

static void draw_in_bar(const struct render_progress *p, struct screen *screen,
                        const struct window_rect *bar, const char *const *lines,
                        int count)
{
    int first = bar->row - (term_size().rows - 1); /* the status line is 0 */

    for (int i = 0; i < bar->rows; i++) {
        char text[PROGRESS_TEXT_BYTES + 1];

        snprintf(text, sizeof text, " %s", i < count ? lines[i] : "");
        windows_text(WINDOW_STATUS, first + i, bar->col, bar->cols, ROLE_TEXT,
                     text);
    }
    draw_gauge(p, screen, WINDOW_STATUS, first, bar->col + 1);
    screen->must_update = true;
}

void progress_panel_draw(struct progress_panel *panel,
                         const struct live_render *control,
                         struct screen *screen, const struct window_rect *bar,
                         uint64_t now_ns)
{
    const struct backend *b = backend_of(control);
    double *loads = xcalloc((size_t)b->thread_count, sizeof *loads);
    struct rank_progress *ranks = xcalloc((size_t)b->rank_count, sizeof *ranks);
    int row_count;
    char texts[PROGRESS_TEXT_ROWS][PROGRESS_TEXT_BYTES];
    const char *lines[PROGRESS_TEXT_ROWS];
    struct progress_text_facts facts = {
        .progress = &control->progress,
        .speeds = &control->session->speeds,
        .errors = &control->session->errors,
        .loads = loads,
        .has_unicode = screen->display.has_unicode,
        .ranks = ranks,
        .rank_count = b->rank_count,
    };

    measure_loads(panel, control, now_ns, loads);
    facts.load_count = panel->load.count;
    for (int i = 0; i < b->rank_count; i++)
        ranks[i] = b->rank_progress(b, i);
    row_count = progress_text_format(texts, &facts);
    free(loads);
    free(ranks);
    for (int i = 0; i < row_count; i++)
        lines[i] = texts[i];
    if (bar)
        draw_in_bar(&control->progress, screen, bar, lines, row_count);
    if (panel->is_on)
        draw_window(&control->progress, screen, lines, row_count);
    panel->due_ns =
        now_ns + (frame_pacing_is_slow(&screen->pace) ? SLOW_NS : UPDATE_NS);
}

void progress_panel_free(struct progress_panel *panel)
{
    thread_load_free(&panel->load);
    *panel = (struct progress_panel){0};
}
