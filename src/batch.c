// SPDX-License-Identifier: MIT
#include "batch.h"

#include <errno.h>
#include <inttypes.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/event_fd.h"
#include "base/file.h"
#include "base/print.h"
#include "picture/image_write.h"
#include "terminal/ansi_text.h"
#include "terminal/tty.h"
#include "terminal/xmalloc.h"
#include "session/stats_json.h"
#include "inspect/view_modes.h"

/* The bar is drawn this often, which also bounds what a slow link gets. */
#define DRAW_MS 100

static const struct {
    int number;
    const char *name;
} stop_signals[] = {{SIGINT, "SIGINT"},
                    {SIGTERM, "SIGTERM"},
                    {SIGHUP, "SIGHUP"}};

#define STOP_SIGNAL_COUNT (int)(sizeof stop_signals / sizeof stop_signals[0])

/* What a handler may touch: the first signal, and what wakes poll().
 * Later signals change nothing, so the picture is saved in peace. */
static volatile sig_atomic_t stop_signal;
static int wake_fd;

static void on_stop_signal(int number)
{
    int saved_errno = errno;

    if (stop_signal == 0)
        stop_signal = number;
    event_fd_set(wake_fd);
    errno = saved_errno;
}

static bool catch_signals(struct error *err)
{
    struct sigaction action = {.sa_handler = on_stop_signal,
                               .sa_flags = SA_RESTART};

    wake_fd = event_fd_open("signals", err);
    if (wake_fd < 0)
        return false;
    sigemptyset(&action.sa_mask);
    for (int i = 0; i < STOP_SIGNAL_COUNT; i++) {
        struct sigaction old;

        /* nohup and background jobs ignore some of them on purpose */
        if (sigaction(stop_signals[i].number, NULL, &old) == 0 &&
            old.sa_handler != SIG_IGN)
            sigaction(stop_signals[i].number, &action, NULL);
    }
    return true;
}

static const char *signal_name(int number)
{
    for (int i = 0; i < STOP_SIGNAL_COUNT; i++) {
        if (stop_signals[i].number == number)
            return stop_signals[i].name;
    }
    return "a signal";
}

static bool is_standard_output(const char *path)
{
    return strcmp(path, "-") == 0;
}

/* Where the text goes; NULL: to standard output. */
static const char *text_path(const struct options *o)
{
    const char *path = o->output_path;

    return path && !is_standard_output(path) ? path : NULL;
}

/* Whole minutes may lie between this and the writing: mistakes are worth
 * finding now. */
static bool check_outputs(const struct session *s, struct error *err)
{
    const struct options *o = s->options;

    if (o->stats_path && (!session_spares(s, "--stats", o->stats_path, err) ||
                          !stats_json_check(o->stats_path, err)))
        return false;
    if (o->output_path && !session_spares(s, "-o", o->output_path, err))
        return false;
    if (o->text_cols > 0)
        return !text_path(o) || file_check(text_path(o), err);
    if (o->output_path)
        return image_write_check(o->output_path, err);
    if (access(".", W_OK | X_OK) != 0)
        return fail(err,
                    "current folder: %s, expected a writable one or -o FILE",
                    strerror(errno));
    return true;
}

struct bar {
    bool is_wanted;
    int shown_cols;
};

static void format_time(char text[16], double seconds)
{
    /* beyond 999 hours the answer is "long" anyway */
    unsigned s = seconds < 3599999.0 ? (unsigned)seconds : 3599999u;

    if (s < 3600)
        snprintf(text, 16, "%u:%02u", s / 60, s % 60);
    else
        snprintf(text, 16, "%u:%02u:%02u", s / 3600, s / 60 % 60, s % 60);
}

static int terminal_cols(void)
{
    struct winsize size;

    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0)
        return 80;
    return size.ws_col;
}

/* One line without its end. Samples per second are those of the tracing
 * alone: the time left follows from them. */
static void format_bar(char *text, size_t size_bytes,
                       const struct render_progress *p)
{
    static const char full[] = "####################";
    static const char empty[] = "--------------------";
    double done = p->samples_limit == 0
                      ? 0.0
                      : (double)p->samples / (double)p->samples_limit;
    double elapsed = seconds_between(0, p->render_ns);
    double tracing = elapsed - seconds_between(0, p->build_ns);
    double rate = tracing > 0.0 ? (double)p->samples / tracing : 0.0;
    int filled = (int)(done * 20.0);
    char elapsed_text[16], left_text[16] = "-";

    format_time(elapsed_text, elapsed);
    if (rate > 0.0)
        format_time(left_text, (double)(p->samples_limit - p->samples) / rate);
    snprintf(text, size_bytes,
             "%3d %% [%.*s%.*s] %" PRIu64 " of %" PRIu64
             " spp, %.2f Msamples/s, %s, left %s",
             (int)(done * 100.0), filled, full, 20 - filled, empty, p->spp_done,
             p->spp_limit, rate * 1e-6, elapsed_text, left_text);
}

/* Writes `text` over what is shown; a line that filled the last column would
 * wrap. */
static void bar_show(struct bar *bar, const char *text)
{
    int cols = (int)strlen(text);
    int limit = terminal_cols() - 1;

    if (cols > limit)
        cols = limit;
    fputc('\r', stderr);
    print_text(stderr, "%.*s", cols, text);
    if (bar->shown_cols > cols)
        print_text(stderr, "%*s", bar->shown_cols - cols, "");
    bar->shown_cols = cols;
    fflush(stderr);
}

static void bar_draw(struct bar *bar, const struct render_progress *p)
{
    char text[160];

    if (!bar->is_wanted)
        return;
    format_bar(text, sizeof text, p);
    bar_show(bar, text);
}

static void bar_erase(struct bar *bar)
{
    if (bar->shown_cols == 0)
        return;
    bar_show(bar, "");
    fputc('\r', stderr);
    bar->shown_cols = 0;
}

/* Until all samples are done or a signal comes; halted then. */
static void wait_for_end(struct session *s)
{
    struct bar bar = {.is_wanted = isatty(STDERR_FILENO) == 1};
    bool looks = bar.is_wanted || s->options->stats_path;
    struct pollfd fds[2] = {{.fd = render_event_fd(s->render),
                             .events = POLLIN},
                            {.fd = wake_fd, .events = POLLIN}};

    for (;;) {
        struct render_progress p = session_look(s);

        if (p.state != RENDER_RUNNING || stop_signal != 0)
            break;
        bar_draw(&bar, &p);
        poll(fds, 2, looks ? DRAW_MS : -1);
        if (fds[0].revents & POLLIN)
            event_fd_clear(fds[0].fd);
    }
    bar_erase(&bar);
    render_halt(s->render);
    session_look(s);
}

/* No terminal is asked: the reader of a file may be another one, and is taken
 * for one with Unicode. But letters alone are for anything: the locale says
 * whether dots may replace them. */
static enum glyphs text_glyphs(const struct options *o, enum palette palette)
{
    bool may_learn;
    bool has_unicode = palette != PALETTE_MONO || tty_is_utf8(&may_learn);

    return term_caps_glyphs(o->display.glyph, palette, has_unicode);
}

static enum palette text_palette(const struct options *o)
{
    const char *no_color = getenv("NO_COLOR");

    if (o->display.color == COLOR_AUTO && no_color && no_color[0] != '\0')
        return PALETTE_MONO;
    return term_caps_palette(o->display.color);
}

static bool save_text(struct view_mode *show, char **name, struct error *err)
{
    const struct session *s = show->session;
    const struct options *o = s->options;
    struct cells_rect fit =
        cells_fit(s->crop.width, s->crop.height, o->text_cols, o->text_rows,
                  o->display.cell_aspect > 0 ? o->display.cell_aspect : 2);
    enum palette palette = text_palette(o);
    struct ansi_text_style style = {fit.cols, fit.rows, palette,
                                    text_glyphs(o, palette)};
    const char *path = text_path(o);
    struct frame frame = {0};
    size_t size_bytes;
    char *text;
    bool ok = ansi_text_frame_init(&frame, &style, err) &&
              view_mode_picture(show, render_film(s->render), &frame, err) &&
              ansi_text_of_frame(&frame, &style, &text, &size_bytes, err);

    frame_free(&frame);
    if (!ok)
        return false;
    *name = xstrdup(path ? path : "standard output");
    ok = path ? file_write(path, text, size_bytes, false, NULL, err)
              : file_write_stdout(text, size_bytes, err);
    free(text);
    return ok;
}

/* Of the file that the options name. */
static bool write_picture(struct session *s, const struct frame *frame,
                          struct error *err)
{
    const char *path = s->options->output_path;

    return frame ? image_write_frame(frame, path, err)
                 : image_write(render_film(s->render), session_develop(s), path,
                               err);
}

/* Under a name that is free, which comes back for free(). */
static char *write_numbered(struct session *s, const struct frame *frame,
                            struct error *err)
{
    char *stem = xchecked(path_stem(s->options->scene_path));
    const char *slash = strrchr(stem, '/');
    const char *last = slash ? slash + 1 : stem;
    char *name =
        frame ? image_write_frame_numbered(frame, last, err)
              : image_write_numbered(render_film(s->render), session_develop(s),
                                     last, "png", err);

    free(stem);
    return name;
}

/* The frame, or without one the film; *name is what it is called now, for
 * free(). */
static bool save_pixels(struct session *s, const struct frame *frame,
                        char **name, struct error *err)
{
    const char *path = s->options->output_path;

    if (path) {
        *name = xstrdup(is_standard_output(path) ? "standard output" : path);
        return write_picture(s, frame, err);
    }
    *name = write_numbered(s, frame, err);
    return *name != NULL;
}

/* What is not light, computed at once. */
static bool save_shown(struct view_mode *show, char **name, struct error *err)
{
    struct session *s = show->session;
    struct frame frame = {0};
    bool ok = frame_init(&frame, s->crop.width, s->crop.height, err) &&
              view_mode_picture(show, NULL, &frame, err) &&
              save_pixels(s, &frame, name, err);

    frame_free(&frame);
    return ok;
}

static bool save_picture(struct view_mode *show, char **name, struct error *err)
{
    if (show->session->options->text_cols > 0)
        return save_text(show, name, err);
    if (show->kind != SHOW_LIGHT)
        return save_shown(show, name, err);
    return save_pixels(show->session, NULL, name, err);
}

static void say_result(const struct session *s, const char *name,
                       const struct render_progress *p)
{
    const struct film *film = render_film(s->render);

    if (stop_signal != 0)
        print_line(stderr,
                   "stopped by %s at %" PRIu64 " of %" PRIu64 " spp: wrote %s",
                   signal_name(stop_signal), p->spp_done, p->spp_limit, name);
    else
        print_line(stderr, "%s: %dx%d, %" PRIu64 " spp, %.1f s", name,
                   film->width, film->height, p->spp_done,
                   seconds_between(s->start_ns, clock_ns()));
    if (p->non_finite > 0)
        print_line(stderr,
                   "glim: warning: %" PRIu64
                   " samples were not finite and count "
                   "as black",
                   p->non_finite);
}

/* A picture that was given a free name may have taken that of the statistics.
 */
static bool save_stats(const struct session *s, const char *picture,
                       struct error *err)
{
    const char *path = s->options->stats_path;

    if (path_is_same(picture, path))
        return fail(err,
                    "--stats: found '%s', the file of the picture, expected "
                    "another file",
                    path);
    return stats_json_write(s, path, err);
}

static bool save_all(struct view_mode *show, struct error *err)
{
    struct session *s = show->session;
    struct render_progress p = render_progress(s->render);
    char *name = NULL;
    bool ok;

    if (p.samples == 0) {
        /* an old picture is worth more than a black one */
        print_line(stderr,
                   "stopped by %s before the first sample: nothing "
                   "written",
                   signal_name(stop_signal));
        return true;
    }
    ok = save_picture(show, &name, err);
    if (ok)
        say_result(s, name, &p);
    if (ok && s->options->stats_path)
        ok = save_stats(s, name, err);
    free(name);
    return ok;
}

static void warn_of_device(const struct error *err)
{
    print_line(stderr, "glim: warning: %s; the CPU renders", err->text);
}

/* The device that the options want, if it comes up. Who names one wants no
 * other machine. That there is no GPU is no news to those who let glim choose.
 */
static bool use_device(struct session *s, struct error *err)
{
    const struct options *o = s->options;
    struct backends *m = &s->machines;
    char *log = NULL;
    bool is_up = backends_begin_device(m, world_features(&s->world), err) &&
                 backends_end_device(m, &log, err);

    if (is_up)
        render_use(s->render, m->device);
    else if (log && (o->device || o->backend != BACKEND_AUTO))
        print_lines(stderr, log);
    free(log);
    if (!is_up && !o->device && o->backend != BACKEND_AUTO)
        warn_of_device(err);
    return is_up || !o->device;
}

/* Renders; a device that fails is replaced by the CPU, which starts anew. */
static bool render_all(struct session *s, struct error *err)
{
    struct render_progress p;

    if (!session_restart(s, s->options->spp, err))
        return false;
    wait_for_end(s);
    p = render_progress(s->render);
    if (p.state != RENDER_FAILED)
        return true;
    *err = p.error;
    if (!session_uses_device(s))
        return false;
    warn_of_device(err);
    render_use(s->render, s->machines.cpu);
    return render_all(s, err);
}

/* Renders nothing: a ray for each pixel tells all. */
static bool run_show(struct view_mode *show, struct error *err)
{
    const struct session *s = show->session;
    char *name = NULL;
    bool ok = view_mode_set(show, s->options->show, err) &&
              save_picture(show, &name, err);

    if (ok)
        print_line(stderr, "%s: %dx%d, %s, %.1f s", name, s->crop.width,
                   s->crop.height, options_shows[s->options->show],
                   seconds_between(s->start_ns, clock_ns()));
    free(name);
    return ok;
}

static bool run_light(struct view_mode *show, int *status, struct error *err)
{
    struct session *s = show->session;

    /* before our signals are set: drivers put theirs over them */
    if (s->options->backend != BACKEND_CPU && !use_device(s, err))
        return false;
    if (!catch_signals(err) || !render_all(s, err) || !save_all(show, err))
        return false;
    *status = stop_signal != 0 ? 128 + stop_signal : 0;
    return true;
}

bool batch_run(struct session *s, int *status, struct error *err)
{
    struct view_mode show;
    bool ok;

    if (!check_outputs(s, err))
        return false;
    view_mode_init(&show, s);
    *status = 0;
    ok = s->options->show == SHOW_LIGHT ? run_light(&show, status, err)
                                        : run_show(&show, err);
    view_mode_free(&show);
    return ok;
}
