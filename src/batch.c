// SPDX-License-Identifier: MIT
#include "batch.h"

#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/event_fd.h"
#include "base/file.h"
#include "base/print.h"
#include "base/stop.h"
#include "picture/image_write.h"
#include "api/handle.h"
#include "terminal/xmalloc.h"
#include "session/frame_series.h"
#include "session/session_film.h"
#include "session/stats_json.h"
#include "inspect/error_map.h"
#include "inspect/view_modes.h"
#include "batch_aov.h"
#include "batch_filter.h"
#include "batch_progress.h"
#include "batch_text.h"

static bool is_standard_output(const char *path)
{
    return strcmp(path, "-") == 0;
}

static bool check_film(const struct session *s, const char *option,
                       const char *path, struct error *err)
{
    return !path || (session_check_output(s, option, path, err) &&
                     file_check(path, err));
}

/* Checks before the render, which may take minutes, that the output files can
 * be written. */
static bool check_outputs(const struct session *s, struct error *err)
{
    const struct options *o = s->options;

    if (o->stats_path &&
        (!session_check_output(s, "--stats", o->stats_path, err) ||
         !stats_json_check(o->stats_path, err)))
        return false;
    if (o->output_path &&
        (!session_check_output(s, "-o", o->output_path, err) ||
         !batch_aov_check(s, o->output_path, err)))
        return false;
    if (o->denoise_path && !batch_filter_check(s, err))
        return false;
    if (o->error_map_path &&
        (!session_check_output(s, "--error-map", o->error_map_path, err) ||
         !batch_check_picture(o->error_map_path, err)))
        return false;
    if (!check_film(s, "--film", o->film_path, err) ||
        !check_film(s, "--checkpoint", o->checkpoint_path, err))
        return false;
    if (o->text_cols > 0)
        return !batch_text_path(o) || file_check(batch_text_path(o), err);
    return s->video.process != 0 || batch_check_picture(o->output_path, err);
}

/* Says that a checkpoint failed: once, since a full disk stays full. */
static void say_failure(struct session_film *f, bool *is_said)
{
    struct error err;

    if (!session_film_failed(f, &err) || *is_said)
        return;
    *is_said = true;
    print_line(stderr,
               "glim: warning: --checkpoint: %s; the last good file stays",
               err.text);
}

/* Returns the progress of all pictures, and tells the bar which one it is. */
static struct glim_progress progress_of_all(const struct frame_series *series,
                                            struct batch_bar *bar,
                                            const struct glim_progress *p)
{
    snprintf(bar->of, sizeof bar->of,
             "%d of %d: ", frame_series_done(series) + 1,
             frame_series_count(series));
    bar->before_s = seconds_between(series->begin_ns, series->frame_begin_ns);
    return frame_series_progress(series, p, clock_ns());
}

/* Waits until all samples are done or a signal arrives, which halts the
 * render. */
static void wait_for_end(struct session *s, struct session_film *f,
                         const struct frame_series *series, int wake_fd)
{
    struct batch_bar bar = batch_bar_begin();
    bool looks =
        bar.is_wanted || s->options->stats_path || s->options->checkpoint_path;
    bool is_said = false;
    struct pollfd fds[2] = {{.fd = render_event_fd(s->render),
                             .events = POLLIN},
                            {.fd = wake_fd, .events = POLLIN}};

    for (;;) {
        struct render_progress p = session_progress(s);
        struct glim_progress shown = handle_progress(&p);

        if (p.state != RENDER_RUNNING || batch_stop_signal() != 0)
            break;
        if (series != NULL)
            shown = progress_of_all(series, &bar, &shown);
        batch_bar_draw(&bar, &shown);
        say_failure(f, &is_said);
        poll(fds, 2, looks ? BATCH_DRAW_MS : -1);
        if (fds[0].revents & POLLIN)
            event_fd_clear(fds[0].fd);
    }
    batch_bar_erase(&bar);
    render_halt(s->render);
    session_film_stop(f);
    session_progress(s);
}

/* Writes to the file that the options name. */
static bool write_picture(struct session *s, struct film *film,
                          const struct frame *frame, struct error *err)
{
    const char *path = s->options->output_path;
    struct image_metadata metadata = batch_filter_metadata(s, film);

    return frame ? image_write_frame(frame, path, err)
                 : image_write(film, session_develop(s), &metadata, path, err);
}

/* Writes to a file with a free name and returns the name, for free(). */
static char *write_numbered(struct session *s, struct film *film,
                            const struct frame *frame, struct error *err)
{
    char *stem = xchecked(path_stem_of_input(s->options->scene_path));
    const char *slash = strrchr(stem, '/');
    const char *last = slash ? slash + 1 : stem;
    struct image_metadata metadata = batch_filter_metadata(s, film);
    char *name = frame ? image_write_frame_numbered(frame, last, err)
                       : image_write_numbered(film, session_develop(s),
                                              &metadata, last, "png", err);

    free(stem);
    return name;
}

/* Adds the frame, or the film if frame is NULL, to the video. */
static bool write_to_video(struct session *s, struct film *film,
                           const struct frame *frame, struct error *err)
{
    struct frame developed = {0};
    bool ok;

    if (frame)
        return video_pipe_write(&s->video, frame, err);
    ok = frame_init(&developed, film->width, film->height, err);
    if (ok)
        film_resolve(film, session_develop(s), &developed);
    ok = ok && video_pipe_write(&s->video, &developed, err);
    frame_free(&developed);
    return ok;
}

/* Saves the frame, or the film if frame is NULL. *name is the file's name, for
 * free(). */
static bool save_pixels(struct session *s, struct film *film,
                        const struct frame *frame, char **name,
                        struct error *err)
{
    const char *path = s->options->output_path;

    if (s->video.process != 0) {
        *name = xstrdup(path);
        return write_to_video(s, film, frame, err);
    }
    if (path) {
        *name = xstrdup(is_standard_output(path) ? "standard output" : path);
        return write_picture(s, film, frame, err);
    }
    *name = write_numbered(s, film, frame, err);
    return *name != NULL;
}

/* Saves the picture of --show. */
static bool save_shown(struct view_mode *show, char **name, struct error *err)
{
    struct session *s = show->session;
    struct frame frame = {0};
    bool ok = frame_init(&frame, s->crop.width, s->crop.height, err) &&
              view_mode_picture(show, NULL, &frame, err) &&
              save_pixels(s, NULL, &frame, name, err);

    frame_free(&frame);
    return ok;
}

/* Saves the film with the layers of --aov. */
static bool save_layers(struct view_mode *show, struct film *film, char **name,
                        struct error *err)
{
    struct image_metadata metadata = batch_filter_metadata(show->session, film);

    *name = xstrdup(show->session->options->output_path);
    return batch_aov_write_layers(show, film, &metadata, err);
}

static bool save_picture(struct view_mode *show, struct film *film, char **name,
                         struct error *err)
{
    if (show->session->options->text_cols > 0)
        return batch_text_write(show, film, name, err);
    if (show->kind != SHOW_LIGHT)
        return save_shown(show, name, err);
    if (batch_aov_is_in_picture(show->session->options))
        return save_layers(show, film, name, err);
    return save_pixels(show->session, film, NULL, name, err);
}

/* Saves the film, filtered if the options want that. With --denoise=FILE the
 * filtered picture has a file of its own. */
static bool save_film(struct view_mode *show, char **name, struct error *err)
{
    struct session *s = show->session;
    struct film *film = render_film(s->render);
    struct film filtered = {0};
    bool ok = !s->options->denoise || batch_filter(s, &filtered, err);

    if (ok && s->is_denoised && s->options->denoise_path)
        ok = batch_filter_write(s, &filtered, err);
    else if (s->is_denoised)
        film = &filtered;
    ok = ok && save_picture(show, film, name, err);
    film_free(&filtered);
    return ok;
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
static bool save_more(struct view_mode *show, const char *picture,
                      struct error *err)
{
    const struct session *s = show->session;
    const char *stats = s->options->stats_path;
    const char *map = s->options->error_map_path;

    return (!map || (is_other_file("--error-map", map, picture, err) &&
                     error_map_write(render_film(s->render),
                                     session_develop(s).exposure, map, err))) &&
           (!stats || (is_other_file("--stats", stats, picture, err) &&
                       stats_json_write(s, stats, err))) &&
           batch_aov_check(s, picture, err) &&
           batch_aov_write(show, picture, err);
}

static void say_result(const struct session *s, const char *name,
                       const struct render_progress *p)
{
    const struct film *film = render_film(s->render);
    struct glim_progress done = handle_progress(p);

    batch_say_result(name, film->width, film->height, &done, s->options,
                     s->start_ns);
}

static bool save_all(struct view_mode *show, struct error *err)
{
    struct session *s = show->session;
    struct render_progress p = render_progress(s->render);
    char *name = NULL;
    bool ok;

    if (p.samples == 0) {
        /* an old picture is better than a black one */
        return batch_say_empty(err);
    }
    stop_hold();
    ok = save_film(show, &name, err);
    if (ok)
        say_result(s, name, &p);
    ok = ok && save_more(show, name, err);
    stop_release();
    free(name);
    return ok;
}

/* Starts the device that the options select. A device that was named must work.
 * If auto finds no GPU, that is not reported. */
static bool use_device(struct session *s, struct error *err)
{
    const struct options *o = s->options;
    struct backends *m = &s->backends;
    char *log = NULL;
    bool is_up = backends_begin_device(m, session_features(s), err) &&
                 backends_end_device(m, &log, err);

    if (is_up)
        render_set_backend(s->render, m->device);
    else if (log && (o->device || o->backend != BACKEND_AUTO))
        print_lines(stderr, log);
    free(log);
    if (!is_up && !o->device && o->backend != BACKEND_AUTO)
        batch_warn_of_device(err->text);
    return is_up || !o->device;
}

/* Renders. If a device fails, the CPU renders from the start. */
static bool render_all(struct session *s, struct session_film *f,
                       const struct frame_series *series, int wake_fd,
                       struct error *err)
{
    struct render_progress p;

    if (!session_film_resume(f, err) ||
        !session_restart(s, session_film_limits(s->options), err) ||
        !session_film_watch(f, err))
        return false;
    wait_for_end(s, f, series, wake_fd);
    p = render_progress(s->render);
    if (p.state != RENDER_FAILED)
        return true;
    *err = p.error;
    if (!session_uses_device(s))
        return false;
    batch_warn_of_device(err->text);
    render_set_backend(s->render, s->backends.cpu);
    return render_all(s, f, series, wake_fd, err);
}

/* Makes the picture of --show with one ray for each pixel. */
static bool run_show(struct view_mode *show, struct error *err)
{
    const struct session *s = show->session;
    char *name = NULL;
    bool ok = view_mode_set(show, s->options->show, err) &&
              save_picture(show, render_film(s->render), &name, err);

    if (ok)
        print_line(stderr, "%s: %dx%d, %s, %.1f s", name, s->crop.width,
                   s->crop.height, options_shows[s->options->show],
                   seconds_between(s->start_ns, clock_ns()));
    free(name);
    return ok;
}

/* Saves the films and the picture, each even if the other one fails. */
static bool save_film_and_all(struct view_mode *show, struct session_film *f,
                              struct error *err)
{
    struct error film_err;
    bool has_film, has_picture;

    stop_hold();
    has_film = session_film_write(f, &film_err);
    has_picture = save_all(show, err);
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

/* Returns true if a signal has stopped the render before its end. */
static bool is_incomplete(const struct session *s)
{
    return batch_stop_signal() != 0 &&
           render_progress(s->render).state != RENDER_DONE;
}

/* Renders one frame, and sets *is_written unless a signal came before its
 * end. */
static bool run_frame(struct view_mode *show, struct session_film *f,
                      const struct frame_series *series, int wake_fd,
                      bool *is_written, struct error *err)
{
    struct session *s = show->session;

    if (!check_outputs(s, err))
        return false;
    if (s->options->show != SHOW_LIGHT)
        return (*is_written = run_show(show, err));
    if (!render_all(s, f, series, wake_fd, err))
        return false;
    return is_incomplete(s) || (*is_written = save_all(show, err));
}

/* Renders the frames of a series, each as a picture of its own. */
static bool run_frames(struct view_mode *show, struct session_film *f,
                       int wake_fd, struct error *err)
{
    struct frame_series series;
    bool ok = frame_series_begin(&series, show->session, err), is_written;
    int done = 0;

    while (ok && batch_stop_signal() == 0 && frame_series_has_next(&series)) {
        is_written = false;
        ok = frame_series_next(&series, err) &&
             run_frame(show, f, &series, wake_fd, &is_written, err);
        done += is_written;
    }
    ok = ok && frame_series_close(&series, err);
    if (ok)
        batch_say_frames(done, frame_series_count(&series), series.begin_ns);
    frame_series_end(&series);
    return ok;
}

static bool run_picture(struct view_mode *show, struct session_film *f,
                        int wake_fd, struct error *err)
{
    return render_all(show->session, f, NULL, wake_fd, err) &&
           save_film_and_all(show, f, err);
}

/* Renders one picture or several. */
static bool run_render(struct view_mode *show, struct session_film *f,
                       int *status, struct error *err)
{
    struct session *s = show->session;
    bool uses_device =
        s->options->backend != BACKEND_CPU && s->options->show == SHOW_LIGHT;
    int wake_fd;

    if (!session_film_begin(f, s, err))
        return false;

    /* before the signal handlers are set, since drivers replace them */
    if ((uses_device && !use_device(s, err)) ||
        !batch_catch_signals(NULL, &wake_fd, err))
        return false;
    if (!(frame_series_is_wanted(s->options)
              ? run_frames(show, f, wake_fd, err)
              : run_picture(show, f, wake_fd, err)))
        return false;
    *status = batch_stop_signal() != 0 ? 128 + batch_stop_signal() : 0;
    return true;
}

bool batch_run(struct session *s, int *status, struct error *err)
{
    bool is_series = frame_series_is_wanted(s->options);
    struct session_film film = {.session = NULL};
    struct view_mode show;
    bool ok;

    /* each frame has its own names */
    if (!is_series && !check_outputs(s, err))
        return false;
    view_mode_init(&show, s);
    *status = 0;
    ok = is_series || s->options->show == SHOW_LIGHT
             ? run_render(&show, &film, status, err)
             : run_show(&show, err);
    session_film_end(&film);
    view_mode_free(&show);
    return ok;
}
