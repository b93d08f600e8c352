// SPDX-License-Identifier: MIT
#include "batch_curve.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/print.h"
#include "base/stop.h"
#include "picture/image_write.h"
#include "api/handle.h"
#include "terminal/tty.h"
#include "measure/curve.h"
#include "measure/text_chart.h"
#include "batch_compare.h"
#include "batch_handle.h"
#include "batch_progress.h"

#define SPP_DEFAULT 256

/* Size of the diagram unless the terminal is smaller, which needs a row for the
 * prompt. */
#define CHART_COLS 76
#define CHART_ROWS 20

/* The measurement in progress. */
struct measurement {
    const struct options *o;
    struct glim *g;
    struct image reference;
    struct reference_info own;
    float *rgb;
    struct curve curve;
    uint64_t cpu_ns; /* processor time of the render so far */
    struct batch_bar bar;
};

static bool on_progress(void *context, const struct glim_progress *p)
{
    batch_bar_draw(context, p);
    return true;
}

/* Finds mistakes before minutes of rendering. */
static bool check_output(const struct measurement *m, const char *option,
                         const char *path, struct error *err)
{
    if (path == NULL)
        return true;
    if (path_is_same(path, m->o->reference_path))
        return fail(err, "%s: found '%s', the reference, expected another file",
                    option, path);
    return batch_handle_spares(m->g, option, path, err) &&
           file_check(path, err);
}

static bool check_outputs(const struct measurement *m, struct error *err)
{
    const char *png = m->o->output_path, *csv = m->o->csv_path;

    if (png != NULL && csv != NULL && path_is_same(png, csv))
        return fail(err, "--csv: found '%s', the file of -o, expected another",
                    csv);
    return check_output(m, "-o", png, err) &&
           check_output(m, "--csv", csv, err);
}

/* Gives the render the size of the reference, unless the options have one,
 * which must be the same. */
static bool fit_size(struct measurement *m, struct error *err)
{
    const struct options *o = m->o;
    const struct image *r = &m->reference;
    int width, height;
    struct glim_error why;

    if (o->width_px == 0 && o->height_px == 0 && !o->has_crop)
        return glim_set_size(m->g, r->width, r->height, &why) ||
               batch_fail_as(err, &why);
    glim_get_size(m->g, &width, &height);
    if (o->has_crop) {
        width = o->crop.width;
        height = o->crop.height;
    }
    return (width == r->width && height == r->height) ||
           fail(err, "%s: found %dx%d pixels, expected %dx%d as rendered",
                o->reference_path, r->width, r->height, width, height);
}

/* Warns if the render would share its noise with the reference. */
static void check_seed(const struct measurement *m)
{
    double index = (double)m->o->seed - m->own.first_seed;

    if (index >= 0 && index < m->own.seed_count)
        print_line(stderr,
                   "glim: warning: --seed %lu is one of the seeds of %s, so "
                   "the error seems too small",
                   (unsigned long)m->o->seed, m->o->reference_path);
}

/* Renders up to this many samples. *is_complete is false if a limit or a signal
 * came first. */
static bool render(struct measurement *m, uint64_t spp, bool *is_complete,
                   struct error *err)
{
    double limit_s = (double)m->o->time_ns * 1e-9;
    double left_s = limit_s - glim_get_progress(m->g).seconds;
    struct glim_error why;
    enum glim_result result;
    uint64_t begin_ns = clock_cpu_ns();

    *is_complete = false;
    if (m->o->time_ns > 0 && left_s <= 0)
        return true;
    result = glim_render(m->g, spp, m->o->time_ns > 0 ? left_s : 0,
                         m->bar.is_wanted ? on_progress : NULL, &m->bar, &why);
    m->cpu_ns += clock_cpu_ns() - begin_ns;
    batch_bar_erase(&m->bar);
    if (result == GLIM_FAILED)
        return batch_fail_as(err, &why);
    *is_complete = result == GLIM_DONE && glim_get_progress(m->g).spp >= spp;
    return true;
}

/* Renders one sample of another seed, so that the first point has no part of
 * the time to build the tree and to bring up threads. */
static bool warm_up(struct measurement *m, bool *is_complete, struct error *err)
{
    glim_set_seed(m->g, m->o->seed + 1);
    if (!render(m, 1, is_complete, err))
        return false;
    glim_set_seed(m->g, m->o->seed);
    m->cpu_ns = 0;
    return true;
}

/* Measures the picture so far and prints its row. */
static bool add_point(struct measurement *m, struct error *err)
{
    struct picture_pair pair = {m->reference.width, m->reference.height, m->rgb,
                                m->reference.rgb};
    size_t count = 3 * (size_t)pair.width * (size_t)pair.height;
    struct glim_progress p = glim_get_progress(m->g);
    struct curve_render render = {
        .spp = p.spp,
        .seconds = p.seconds - p.build_seconds,
        .cpu_seconds = seconds_between(0, m->cpu_ns),
        .exposure = m->g->view.lighting.exposure,
        .stated = {p.error_is_known, p.error_is_resolved, p.error, p.error_low,
                   p.error_high},
    };
    struct glim_error why;

    if (!glim_read_floats(m->g, m->rgb, count, &why))
        return batch_fail_as(err, &why);
    curve_add(&m->curve, &render, &pair, &m->own);
    curve_write_row(stdout, &m->curve.points[m->curve.count - 1]);
    return print_finish(stdout, err); /* the reader may have gone */
}

static bool measure(struct measurement *m, struct error *err)
{
    uint64_t last = m->o->has_spp       ? m->o->spp
                    : m->o->time_ns > 0 ? UINT64_MAX
                                        : SPP_DEFAULT;
    bool is_complete;

    if (!warm_up(m, &is_complete, err))
        return false;
    print_line(stdout, "%s: %dx%d pixels", m->o->reference_path,
               m->reference.width, m->reference.height);
    if (m->own.is_known)
        print_line(stdout,
                   "its own relMSE of %.2g is subtracted where it is more than "
                   "5 %%",
                   m->own.relmse);
    else
        print_line(stdout, "its own error is not known");
    curve_write_head(stdout);
    for (uint64_t spp = 1;
         is_complete && spp <= last && m->curve.count < SERIES_POINTS;
         spp *= 2) {
        if (!render(m, spp, &is_complete, err) ||
            (is_complete && !add_point(m, err)))
            return false;
    }
    return true;
}

/* Draws the diagram in characters, and to the file of -o. */
static bool draw(const struct measurement *m, struct error *err)
{
    struct series series[2] = {
        curve_series(&m->curve, (struct curve_axes){.is_relative = true})};
    struct chart chart = {.title = path_name(m->o->scene_path),
                          .x_label = "seconds",
                          .y_label = "relative MSE",
                          .series = series,
                          .series_count = 2};
    bool ignored;
    struct tty_size size = term_size();
    int cols =
        size.cols > 0 && size.cols <= CHART_COLS ? size.cols - 1 : CHART_COLS;
    int rows = size.rows > 0 && size.rows < CHART_ROWS + 2 ? size.rows - 2
                                                           : CHART_ROWS;

    if (series[0].count < 2)
        return m->o->output_path == NULL ||
               fail(err, "%s: found %d point%s to draw, expected at least 2",
                    m->o->output_path, series[0].count,
                    print_plural((uint64_t)series[0].count));
    series[1] = series_half_slope(&series[0]);
    text_chart_write(stdout, &chart, cols, rows, tty_is_utf8(&ignored));
    return m->o->output_path == NULL ||
           chart_write(&chart, m->o->output_path, err);
}

static bool write_csv(const struct measurement *m, struct error *err)
{
    const char *path = m->o->csv_path;
    char *text;
    bool ok;

    if (path == NULL)
        return true;
    text = curve_csv(&m->curve);
    ok = text != NULL ? file_write(path, text, strlen(text), false, NULL, err)
                      : fail(err, "%s: out of memory", path);
    free(text);
    return ok;
}

static bool report(const struct measurement *m, struct error *err)
{
    struct glim_progress p = glim_get_progress(m->g);
    bool ok;

    batch_warn_of_samples(p.non_finite, p.saturated);
    stop_hold();
    curve_write_slopes(stdout, &m->curve);
    ok = write_csv(m, err) && draw(m, err) && print_finish(stdout, err);
    stop_release();
    return ok;
}

static bool run(struct measurement *m, struct error *err)
{
    size_t count;
    int wake_fd;

    if (!batch_compare_read(&m->reference, m->o->reference_path, 0, err))
        return false;
    m->own = reference_info_read(m->o->reference_path);
    m->g = batch_handle_open(m->o, err);
    if (m->g == NULL || !check_outputs(m, err) || !fit_size(m, err))
        return false;
    count = (size_t)m->reference.width * (size_t)m->reference.height;
    m->rgb = alloc_array(count, 3 * sizeof *m->rgb);
    if (m->rgb == NULL)
        return fail(err, "out of memory for %dx%d pixels", m->reference.width,
                    m->reference.height);
    check_seed(m);
    /* before our signals are set: drivers put theirs over them */
    if (m->o->backend != BACKEND_CPU &&
        !batch_handle_use_device(m->g, m->o, err))
        return false;
    return batch_catch_signals(m->g, &wake_fd, err) && measure(m, err) &&
           report(m, err);
}

bool batch_curve_run(const struct options *o, int *status, struct error *err)
{
    struct measurement m = {.o = o, .bar = batch_bar_begin()};
    bool ok = run(&m, err);

    *status = batch_stop_signal() != 0 ? 128 + batch_stop_signal() : 0;
    glim_close(m.g);
    image_free(&m.reference);
    free(m.rgb);
    return ok;
}
