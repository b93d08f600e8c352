// SPDX-License-Identifier: MIT
#include "command/command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/print.h"
#include "base/stop.h"
#include "command/batch_progress.h"
#include "command/chart.h"
#include "command/command.h"
#include "command/curve.h"
#include "film/image_write.h"
#include "terminal/tty.h"

#define SPP_DEFAULT 256

/* Size of the diagram unless the terminal is smaller, which needs a row for the
 * prompt. */
#define CHART_COLS 76
#define CHART_ROWS 20

/* The measurement in progress. */
struct measurement {
    struct options options; /* with the size of the reference */
    struct session session;
    bool is_complete; /* no limit or signal has come */
    struct image reference;
    struct reference_info own;
    float *rgb;
    struct curve curve;
    uint64_t cpu_ns; /* processor time of the render so far */
    struct batch_bar bar;
};

/* Finds mistakes before minutes of rendering. */
static bool check_output(const struct measurement *m, const char *option,
                         const char *path, struct error *err)
{
    if (path == NULL)
        return true;
    if (path_is_same(path, m->options.reference_path))
        return fail(err, "%s: found '%s', the reference, expected another file",
                    option, path);
    return session_check_output(&m->session, option, path, err) &&
           file_check(path, err);
}

static bool check_outputs(const struct measurement *m, struct error *err)
{
    const char *script = m->options.output_path, *csv = m->options.csv_path;

    if (script != NULL && csv != NULL && path_is_same(script, csv))
        return fail(err, "--csv: found '%s', the file of -o, expected another",
                    csv);
    return check_output(m, "-o", script, err) &&
           check_output(m, "--csv", csv, err);
}

/* Opens the scene. The render has the size of the reference, unless the options
 * have one, which must be the same. */
static bool open_scene(struct measurement *m, uint64_t start_ns,
                       struct error *err)
{
    struct options *o = &m->options;
    const struct image *r = &m->reference;
    const struct rect *crop = &m->session.engine.crop;

    if (o->width_px == 0 && o->height_px == 0 && !o->has_crop) {
        o->width_px = r->width;
        o->height_px = r->height;
    }
    if (!batch_open(&m->session, o, start_ns, err))
        return false;
    return (crop->width == r->width && crop->height == r->height) ||
           fail(err, "%s: found %dx%d pixels, expected %dx%d as rendered",
                o->reference_path, r->width, r->height, crop->width,
                crop->height);
}

/* Warns if the render would share its noise with the reference. */
static void check_seed(const struct measurement *m)
{
    double index = (double)m->options.seed - m->own.first_seed;

    if (index >= 0 && index < m->own.seed_count)
        print_line(stderr,
                   "glim: warning: --seed %lu is one of the seeds of %s, so "
                   "the error seems too small",
                   (unsigned long)m->options.seed, m->options.reference_path);
}

/* Renders up to this many samples, from the first one or after those before.
 * *is_complete is false if a limit or a signal came first. */
static bool render(struct measurement *m, uint64_t spp, bool is_first,
                   struct error *err)
{
    struct session *s = &m->session;
    struct render_limits limits = {.spp = spp, .time_ns = m->options.time_ns};
    uint64_t begin_ns = clock_cpu_ns();
    struct render_progress p;

    if (!is_first)
        render_resume(s->engine.render, limits);
    else if (!session_restart(s, limits, err))
        return false;
    p = batch_wait(s, &m->bar);
    m->cpu_ns += clock_cpu_ns() - begin_ns;
    m->is_complete = p.state == RENDER_DONE && p.spp_done >= spp;
    if (p.state == RENDER_FAILED)
        *err = p.error;
    return p.state != RENDER_FAILED;
}

/* Renders one sample of another seed, so that the first point has no part of
 * the time to build the tree and to bring up threads. */
static bool warm_up(struct measurement *m, struct error *err)
{
    m->session.engine.options.seed = m->options.seed + 1;
    if (!render(m, 1, true, err))
        return false;
    m->session.engine.options.seed = m->options.seed;
    m->cpu_ns = 0;
    return true;
}

/* Measures the picture so far and prints its row. */
static bool add_point(struct measurement *m, struct error *err)
{
    struct picture_pair pair = {m->reference.width, m->reference.height, m->rgb,
                                m->reference.rgb};
    struct render *r = m->session.engine.render;
    struct render_progress p = render_progress(r);
    struct curve_render render = {
        .spp = p.spp_done,
        .seconds = seconds_between(p.build_ns, p.render_ns),
        .cpu_seconds = seconds_between(0, m->cpu_ns),
        .exposure = m->session.edit.now.view.lighting.exposure,
        .stated = p.film_error,
    };

    film_linear(render_film(r), m->rgb);
    curve_add(&m->curve, &render, &pair, &m->own);
    curve_write_row(stdout, &m->curve.points[m->curve.count - 1]);
    return print_finish(stdout, err); /* the reader may have gone */
}

static bool measure(struct measurement *m, struct error *err)
{
    uint64_t last = m->options.has_spp       ? m->options.spp
                    : m->options.time_ns > 0 ? UINT64_MAX
                                             : SPP_DEFAULT;

    if (!warm_up(m, err))
        return false;
    print_line(stdout, "%s: %dx%d pixels", m->options.reference_path,
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
         m->is_complete && spp <= last && m->curve.count < SERIES_POINTS;
         spp *= 2) {
        if (!render(m, spp, spp == 1, err) ||
            (m->is_complete && !add_point(m, err)))
            return false;
    }
    return true;
}

/* Draws the diagram in characters, and writes it to the file of -o. */
static bool draw(const struct measurement *m, struct error *err)
{
    struct series series[2] = {
        curve_series(&m->curve, (struct curve_axes){.is_relative = true})};
    struct chart chart = {.title = path_name(m->options.scene_path),
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
        return m->options.output_path == NULL ||
               fail(err, "%s: found %d point%s to draw, expected at least 2",
                    m->options.output_path, series[0].count,
                    print_plural((uint64_t)series[0].count));
    series[1] = series_half_slope(&series[0]);
    chart_write_text(stdout, &chart, cols, rows, tty_is_utf8(&ignored));
    return m->options.output_path == NULL ||
           chart_write(&chart, m->options.output_path, err);
}

static bool write_csv(const struct measurement *m, struct error *err)
{
    const char *path = m->options.csv_path;
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
    struct render_progress p = render_progress(m->session.engine.render);
    bool ok;

    batch_warn_of_samples(p.non_finite, p.saturated);
    stop_hold();
    curve_write_slopes(stdout, &m->curve);
    ok = write_csv(m, err) && draw(m, err) && print_finish(stdout, err);
    stop_release();
    return ok;
}

static bool run(struct measurement *m, uint64_t start_ns, struct error *err)
{
    size_t count;

    if (!batch_compare_read(&m->reference, m->options.reference_path, 0, err))
        return false;
    m->own = reference_info_read(m->options.reference_path);
    if (!open_scene(m, start_ns, err) || !check_outputs(m, err))
        return false;
    count = (size_t)m->reference.width * (size_t)m->reference.height;
    m->rgb = alloc_array(count, 3 * sizeof *m->rgb);
    if (m->rgb == NULL)
        return fail(err, "out of memory for %dx%d pixels", m->reference.width,
                    m->reference.height);
    check_seed(m);
    /* before our signals are set: drivers put theirs over them */
    return batch_use_device(&m->session, err) && batch_catch_signals(err) &&
           measure(m, err) && report(m, err);
}

bool batch_curve_run(const struct options *o, uint64_t start_ns, int *status,
                     struct error *err)
{
    struct measurement m = {.options = *o, .bar = batch_bar_begin()};
    bool ok = run(&m, start_ns, err);

    *status = batch_stop_signal() != 0 ? 128 + batch_stop_signal() : 0;
    session_close(&m.session);
    image_free(&m.reference);
    free(m.rgb);
    return ok;
}
