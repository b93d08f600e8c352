// SPDX-License-Identifier: MIT
#include "batch.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/print.h"
#include "base/stop.h"
#include "picture/image_write.h"
#include "terminal/xmalloc.h"
#include "session/frame_series.h"
#include "session/session_film.h"
#include "session/stats_json.h"
#include "inspect/error_map.h"
#include "inspect/view_modes.h"
#include "batch_aov.h"
#include "batch_progress.h"
#include "batch_text.h"

/* A render to files: of one picture, or of a series. */
struct batch {
    struct session *session;
    struct view_mode show;
    struct session_film film;
    struct frame_series series; /* its session is NULL for one picture */
    bool is_denoised;           /* a filtered picture was written */
};

/* ---- before the render ---- */

/* Checks the file of an option, if it is given: that the scene is not read from
 * it, and then with `check`. */
static bool check_file(const struct session *s, const char *option,
                       const char *path,
                       bool (*check)(const char *path, struct error *err),
                       struct error *err)
{
    return !path ||
           (session_check_output(s, option, path, err) && check(path, err));
}

/* Checks before the render, which may take minutes, that the output files can
 * be written. */
static bool check_outputs(const struct batch *b, struct error *err)
{
    const struct session *s = b->session;
    const struct options *o = s->options;

    if (!check_file(s, "--stats", o->stats_path, stats_json_check, err))
        return false;
    if (o->output_path &&
        (!session_check_output(s, "-o", o->output_path, err) ||
         !batch_aov_check(s, o->output_path, err)))
        return false;
    if (!check_file(s, "--denoise", o->denoise_path, image_write_check, err) ||
        !check_file(s, "--error-map", o->error_map_path, image_write_check,
                    err) ||
        !check_file(s, "--film", o->film_path, file_check, err) ||
        !check_file(s, "--checkpoint", o->checkpoint_path, file_check, err))
        return false;
    if (o->text_cols > 0)
        return !batch_text_path(o) || file_check(batch_text_path(o), err);
    return b->series.video.process != 0 ||
           batch_check_picture(o->output_path, err);
}

/* ---- pictures ---- */

/* Returns the metadata of the film, which may be the filtered one. */
static struct image_metadata metadata_of(const struct session *s,
                                         const struct film *film)
{
    return engine_metadata(&s->engine, film == &s->engine.filtered);
}

/* Writes to the file that the options name. */
static bool write_picture(struct session *s, struct film *film,
                          const struct frame *frame, struct error *err)
{
    const char *path = s->options->output_path;
    struct image_metadata metadata = metadata_of(s, film);

    return frame ? image_write_frame(frame, path, err)
                 : image_write(film, session_develop(s), &metadata, path, err);
}

/* Writes to a file with a free name and returns the name, for free(). */
static char *write_numbered(struct session *s, struct film *film,
                            const struct frame *frame, struct error *err)
{
    char *stem = xchecked(path_stem_of_input(s->options->scene_path));
    const char *last = path_name(stem);
    struct image_metadata metadata = metadata_of(s, film);
    char *name = frame ? image_write_frame_numbered(frame, last, err)
                       : image_write_numbered(film, session_develop(s),
                                              &metadata, last, "png", err);

    free(stem);
    return name;
}

/* Adds the frame, or the film if frame is NULL, to the video. */
static bool write_to_video(struct batch *b, struct film *film,
                           const struct frame *frame, struct error *err)
{
    struct frame developed = {0};
    bool ok;

    if (frame)
        return video_pipe_write(&b->series.video, frame, err);
    ok = frame_init(&developed, film->width, film->height, err);
    if (ok)
        film_resolve(film, session_develop(b->session), &developed);
    ok = ok && video_pipe_write(&b->series.video, &developed, err);
    frame_free(&developed);
    return ok;
}

/* Saves the frame, or the film if frame is NULL. *name is the file's name, for
 * free(). */
static bool save_pixels(struct batch *b, struct film *film,
                        const struct frame *frame, char **name,
                        struct error *err)
{
    struct session *s = b->session;
    const char *path = s->options->output_path;

    if (b->series.video.process != 0) {
        *name = xstrdup(path);
        return write_to_video(b, film, frame, err);
    }
    if (path) {
        *name = xstrdup(strcmp(path, "-") == 0 ? "standard output" : path);
        return write_picture(s, film, frame, err);
    }
    *name = write_numbered(s, film, frame, err);
    return *name != NULL;
}

/* Saves the picture of --show. */
static bool save_shown(struct batch *b, char **name, struct error *err)
{
    const struct rect *crop = &b->session->engine.crop;
    struct frame frame = {0};
    bool ok = frame_init(&frame, crop->width, crop->height, err) &&
              view_mode_picture(&b->show, NULL, &frame, err) &&
              save_pixels(b, NULL, &frame, name, err);

    frame_free(&frame);
    return ok;
}

/* Saves the film with the layers of --aov. */
static bool save_layers(struct batch *b, struct film *film, char **name,
                        struct error *err)
{
    struct image_metadata metadata = metadata_of(b->session, film);

    *name = xstrdup(b->session->options->output_path);
    return batch_aov_write_layers(&b->show, film, &metadata, err);
}

static bool save_picture(struct batch *b, struct film *film, char **name,
                         struct error *err)
{
    const struct options *o = b->session->options;

    if (o->text_cols > 0)
        return batch_text_write(&b->show, film, name, err);
    if (b->show.kind != SHOW_LIGHT)
        return save_shown(b, name, err);
    if (batch_aov_is_in_picture(o))
        return save_layers(b, film, name, err);
    return save_pixels(b, film, NULL, name, err);
}

/* Filters the film into *film, unless pixels lack samples. */
static bool filter(struct batch *b, struct film **film, struct error *err)
{
    struct film *filtered;

    if (!engine_can_filter(&b->session->engine)) {
        batch_warn_unfiltered();
        return true;
    }
    filtered = engine_filtered(&b->session->engine, err);
    if (!filtered)
        return false;
    b->is_denoised = true;
    *film = filtered;
    return true;
}

/* Writes the filtered picture to its own file. */
static bool write_filtered(struct session *s, struct film *film,
                           struct error *err)
{
    struct image_metadata metadata = metadata_of(s, film);
    const char *path = s->options->denoise_path;

    if (!image_write(film, session_develop(s), &metadata, path, err))
        return false;
    batch_say_filtered(path);
    return true;
}

/* Saves the film, filtered if the options want that. With --denoise=FILE the
 * filtered picture has a file of its own. */
static bool save_film(struct batch *b, char **name, struct error *err)
{
    struct session *s = b->session;
    struct film *own = render_film(s->engine.render), *film = own;

    b->is_denoised = false;
    if (s->options->denoise && !filter(b, &film, err))
        return false;
    if (b->is_denoised && s->options->denoise_path) {
        if (!write_filtered(s, film, err))
            return false;
        film = own;
    }
    return save_picture(b, film, name, err);
}

/* Fails if the free name of the picture is that of another file. */
static bool is_other_file(const char *option, const char *path,
                          const char *picture, struct error *err)
{
    return !path_is_same(picture, path) ||
           fail(err,
                "%s: found '%s', the file of the picture, expected another "
                "file",
                option, path);
}

/* Writes the files beside the picture. */
static bool save_more(struct batch *b, const char *picture, struct error *err)
{
    const struct session *s = b->session;
    const char *stats = s->options->stats_path;
    const char *map = s->options->error_map_path;

    return (!map || (is_other_file("--error-map", map, picture, err) &&
                     error_map_write(render_film(s->engine.render),
                                     session_develop(s).exposure, map, err))) &&
           (!stats || (is_other_file("--stats", stats, picture, err) &&
                       stats_json_write(s, b->is_denoised, stats, err))) &&
           batch_aov_check(s, picture, err) &&
           batch_aov_write(&b->show, picture, err);
}

static bool save_all(struct batch *b, struct error *err)
{
    struct session *s = b->session;
    struct render_progress p = render_progress(s->engine.render);
    char *name = NULL;
    bool ok;

    if (p.samples == 0) {
        /* an old picture is better than a black one */
        return batch_say_empty(err);
    }
    stop_hold();
    ok = save_film(b, &name, err);
    if (ok)
        batch_say_result(name, s, &p);
    ok = ok && save_more(b, name, err);
    stop_release();
    free(name);
    return ok;
}

/* Saves the films and the picture, each even if the other one fails. */
static bool save_film_and_all(struct batch *b, struct error *err)
{
    struct error film_err;
    bool has_film, has_picture;

    stop_hold();
    has_film = session_film_write(&b->film, &film_err);
    has_picture = save_all(b, err);
    stop_release();
    if (!has_picture) {
        if (!has_film)
            error_add(err, &film_err);
        return false;
    }
    if (!has_film)
        *err = film_err;
    return has_film;
}

/* Makes the picture of --show with one ray for each pixel. */
static bool run_show(struct batch *b, struct error *err)
{
    const struct session *s = b->session;
    char *name = NULL;
    bool ok = view_mode_set(&b->show, s->options->show, err) &&
              save_picture(b, render_film(s->engine.render), &name, err);

    if (ok)
        print_line(stderr, "%s: %dx%d, %s, %.1f s", name, s->engine.crop.width,
                   s->engine.crop.height, options_shows[s->options->show],
                   seconds_between(s->start_ns, clock_ns()));
    free(name);
    return ok;
}

/* ---- one or several ---- */

/* Renders. If a device fails, the CPU renders from the start. */
static bool render_all(struct batch *b, struct error *err)
{
    struct batch_bar bar = batch_bar_begin();
    struct session *s = b->session;
    struct session_start start = {.limits = session_film_limits(s->options),
                                  .first_sample = b->film.first_sample};
    struct render_progress p;

    if (!session_film_resume(&b->film, &start.from, err) ||
        !session_start(s, &start, err) || !session_film_watch(&b->film, err))
        return false;
    bar.film = &b->film;
    bar.series = b->series.session != NULL ? &b->series : NULL;
    p = batch_wait(s, &bar);
    session_film_stop(&b->film);
    if (p.state != RENDER_FAILED)
        return true;
    *err = p.error;
    if (!engine_uses_device(&s->engine))
        return false;
    batch_warn_of_device(err->text);
    engine_use_cpu(&s->engine);
    return render_all(b, err);
}

/* Returns true if a signal has stopped the render before its end. */
static bool is_incomplete(const struct session *s)
{
    return batch_stop_signal() != 0 &&
           render_progress(s->engine.render).state != RENDER_DONE;
}

/* Renders one frame, and sets *is_written unless a signal came before its
 * end. */
static bool run_frame(struct batch *b, bool *is_written, struct error *err)
{
    struct session *s = b->session;

    if (!check_outputs(b, err))
        return false;
    if (s->options->show != SHOW_LIGHT)
        return (*is_written = run_show(b, err));
    if (!render_all(b, err))
        return false;
    return is_incomplete(s) || (*is_written = save_all(b, err));
}

/* Renders the frames of a series, each as a picture of its own. */
static bool run_frames(struct batch *b, struct error *err)
{
    struct frame_series *series = &b->series;
    bool ok = frame_series_begin(series, b->session, err), is_written;
    int done = 0;

    while (ok && batch_stop_signal() == 0 && frame_series_has_next(series)) {
        is_written = false;
        ok = frame_series_next(series, err) && run_frame(b, &is_written, err);
        done += is_written;
    }
    ok = ok && frame_series_close(series, err);
    if (ok)
        batch_say_frames(done, frame_series_count(series), series->begin_ns);
    frame_series_end(series);
    return ok;
}

/* Renders one picture or several. */
static bool run_render(struct batch *b, int *status, struct error *err)
{
    const struct options *o = b->session->options;
    bool is_series = frame_series_is_wanted(o);

    if (!session_film_begin(&b->film, b->session, err))
        return false;
    /* before the signal handlers are set, since drivers replace them */
    if (o->show == SHOW_LIGHT && !batch_use_device(b->session, err))
        return false;
    if (!batch_catch_signals(err))
        return false;
    if (!(is_series ? run_frames(b, err)
                    : render_all(b, err) && save_film_and_all(b, err)))
        return false;
    *status = batch_stop_signal() != 0 ? 128 + batch_stop_signal() : 0;
    return true;
}

bool batch_run(struct session *s, int *status, struct error *err)
{
    bool is_series = frame_series_is_wanted(s->options);
    struct batch b = {.session = s};
    bool ok;

    /* each frame has its own names */
    if (!is_series && !check_outputs(&b, err))
        return false;
    view_mode_init(&b.show, s);
    *status = 0;
    ok = is_series || s->options->show == SHOW_LIGHT
             ? run_render(&b, status, err)
             : run_show(&b, err);
    session_film_end(&b.film);
    view_mode_free(&b.show);
    return ok;
}
