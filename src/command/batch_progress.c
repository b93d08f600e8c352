// SPDX-License-Identifier: MIT
#include "command/batch_progress.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/background.h"
#include "base/clock.h"
#include "base/file.h"
#include "base/print.h"
#include "base/stop.h"
#include "base/thread_pool.h"
#include "film/image_write.h"
#include "render/error_text.h"
#include "render/progress.h"

/* The bar is drawn this often, which also bounds what a slow link gets. */
#define DRAW_MS 100

/* The line about a scene that is being read counts seconds, from one on. */
#define NOTICE_NS 1000000000

/* ---- device and output file ---- */

bool batch_use_device(struct session *s, struct error *err)
{
    const struct options *o = s->options;
    struct view view = edit_view(&s->edit);
    bool is_auto = o->backend == BACKEND_AUTO;
    char *log;
    bool is_up;

    if (o->backend == BACKEND_CPU)
        return true;
    is_up = engine_use_device(&s->engine, &view, &log, err);
    if (!is_up && log && (o->device || !is_auto))
        print_lines(stderr, log);
    free(log);
    if (!is_up && !o->device && !is_auto)
        batch_warn_of_device(err->text);
    return is_up || !o->device;
}

bool batch_check_picture(const char *path, struct error *err)
{
    if (path)
        return image_write_check(path, err);
    if (access(".", W_OK | X_OK) != 0)
        return fail(err,
                    "current folder: %s, expected a writable one or -o FILE",
                    strerror(errno));
    return true;
}

/* ---- signals ---- */

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
static int stop_fd = -1;

static void on_stop_signal(int number)
{
    int saved_errno = errno;

    if (stop_signal == 0)
        stop_signal = number;
    stop_request(128 + number, true);
    event_fd_set(stop_fd);
    errno = saved_errno;
}

static const char *signal_name(int number)
{
    for (int i = 0; i < STOP_SIGNAL_COUNT; i++) {
        if (stop_signals[i].number == number)
            return stop_signals[i].name;
    }
    return "a signal";
}

/* Says that the program did not end by itself. Standard error may be what it
 * waits for. */
static void say_end(void)
{
    struct pollfd out = {.fd = STDERR_FILENO, .events = POLLOUT};
    char text[80];
    int length =
        snprintf(text, sizeof text, "stopped by %s: nothing more is written\n",
                 signal_name(stop_signal));

    if (poll(&out, 1, 0) == 1 && (out.revents & POLLOUT) != 0 &&
        write(STDERR_FILENO, text, (size_t)length) < 0)
        return; /* errors cannot be reported here */
}

bool batch_catch_signals(struct error *err)
{
    struct sigaction action = {.sa_handler = on_stop_signal,
                               .sa_flags = SA_RESTART};

    if (stop_fd < 0)
        stop_fd = event_fd_open("signals", err);
    if (stop_fd < 0 || !stop_begin(err))
        return false;
    stop_at_end(say_end);
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

int batch_stop_signal(void)
{
    return stop_signal;
}

/* ---- the bar ---- */

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

/* Formats the samples: "12 of 16 spp", or "12 spp" without a limit. */
static void format_spp(char text[48], const struct render_progress *p)
{
    if (p->spp_limit > 0)
        snprintf(text, 48, "%" PRIu64 " of %" PRIu64 " spp", p->spp_done,
                 p->spp_limit);
    else
        snprintf(text, 48, "%" PRIu64 " spp", p->spp_done);
}

/* What the bar shows. */
struct bar_values {
    struct render_progress progress;
    struct render_left left; /* of all pictures, if there are several */
    char of[32];             /* which of them it is, or "" */
    double before_s;         /* time of the pictures before */
};

/* Formats the line for `cols` columns, without the speed or also without the
 * noise if there is no room. Samples per second are those of the tracing alone,
 * from which the time left follows. */
static void format_bar(char *text, size_t size_bytes, int cols,
                       const struct bar_values *v)
{
    static const char full[] = "####################";
    static const char empty[] = "--------------------";
    const struct render_progress *p = &v->progress;
    double tracing = seconds_between(p->build_ns, p->render_ns);
    double rate = tracing > 0.0 ? (double)p->samples / tracing : 0.0;
    int filled = (int)(v->left.part * 20.0);
    char elapsed[16], left[16] = "-", spp[48], noise[ERROR_TEXT_BYTES];
    char speed[48];

    format_time(elapsed, v->before_s + seconds_between(0, p->render_ns));
    if (v->left.limit != RENDER_LIMIT_NONE)
        format_time(left, ceil(v->left.ns * 1e-9)); /* 0:00 means done */
    format_spp(spp, p);
    error_text_noise(noise, &p->film_error);
    snprintf(speed, sizeof speed, ", %.2f Msamples/s", rate * 1e-6);
    for (int left_out = 0; left_out < 3; left_out++) {
        int length =
            snprintf(text, size_bytes,
                     "%3d %% [%.*s%.*s] %s%s%s, %s, left %s%s%s",
                     (int)(v->left.part * 100.0), filled, full, 20 - filled,
                     empty, v->of, spp, left_out < 1 ? speed : "", elapsed,
                     left, left_out < 2 ? ", " : "", left_out < 2 ? noise : "");

        if (length <= cols)
            break;
    }
}

/* Writes `text` over what is shown; a line that filled the last column would
 * wrap. */
static void bar_show(struct batch_bar *bar, const char *text)
{
    int cols = (int)strlen(text);
    int limit = terminal_cols() - 1;

    if (cols > limit)
        cols = limit;
    stop_allow_begin();
    fputc('\r', stderr);
    print_text(stderr, "%.*s", cols, text);
    if (bar->shown_cols > cols)
        print_text(stderr, "%*s", bar->shown_cols - cols, "");
    bar->shown_cols = cols;
    fflush(stderr);
    stop_allow_end();
}

struct batch_bar batch_bar_begin(void)
{
    return (struct batch_bar){.is_wanted = isatty(STDERR_FILENO) == 1};
}

static void draw(struct batch_bar *bar, const struct render_progress *p)
{
    const struct frame_series *f = bar->series;
    struct bar_values v = {.progress = *p, .left = render_left(p)};
    char text[256];

    if (!bar->is_wanted)
        return;
    if (f != NULL) {
        snprintf(v.of, sizeof v.of, "%d of %d: ", frame_series_done(f) + 1,
                 frame_series_count(f));
        v.before_s = seconds_between(f->begin_ns, f->frame_begin_ns);
        v.left = frame_series_left(f, v.left, clock_ns());
    }
    format_bar(text, sizeof text, terminal_cols() - 1, &v);
    bar_show(bar, text);
}

static void erase(struct batch_bar *bar)
{
    if (bar->shown_cols == 0)
        return;
    stop_allow_begin();
    bar_show(bar, "");
    fputc('\r', stderr);
    stop_allow_end();
    bar->shown_cols = 0;
}

/* Says that a checkpoint failed: once, since a full disk stays full. */
static void say_failure(struct batch_bar *bar)
{
    struct error err;

    if (bar->film == NULL || !session_film_failed(bar->film, &err) ||
        bar->has_failed)
        return;
    bar->has_failed = true;
    print_line(stderr,
               "glim: warning: --checkpoint: %s; the last good file stays",
               err.text);
}

struct render_progress batch_wait(struct session *s, struct batch_bar *bar)
{
    struct render *r = s->engine.render;
    const struct options *o = s->options;
    bool looks = bar->is_wanted || o->stats_path || o->checkpoint_path;
    struct pollfd fds[2] = {{.fd = render_event_fd(r), .events = POLLIN},
                            {.fd = stop_fd, .events = POLLIN}};
    struct render_progress p = session_progress(s);

    while (p.state == RENDER_RUNNING && stop_signal == 0) {
        draw(bar, &p);
        say_failure(bar);
        poll(fds, 2, looks ? DRAW_MS : -1);
        if (fds[0].revents & POLLIN)
            event_fd_clear(fds[0].fd);
        p = session_progress(s);
    }
    erase(bar);
    render_halt(r);
    return session_progress(s);
}

/* ---- the scene ---- */

/* A line on a terminal for who waits for a large scene. */
struct notice {
    const char *name;
    uint64_t before_bytes; /* of all files that were read before */
    struct batch_bar bar;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t end;
    bool is_ending;
};

/* Shows the line with what was read, and its seconds, until the end. */
static void *notice_run(void *context)
{
    struct notice *n = context;
    char text[96];

    pthread_mutex_lock(&n->lock);
    for (int s = 1;; s++) {
        struct timespec until = clock_time_after(NOTICE_NS);
        int late = 0;

        while (!n->is_ending && late == 0)
            late = pthread_cond_timedwait(&n->end, &n->lock, &until);
        if (n->is_ending)
            break;
        snprintf(text, sizeof text,
                 "reading %.40s, %.1f MB, %d s (Ctrl-C ends)", n->name,
                 (double)(file_bytes_read() - n->before_bytes) * 1e-6, s);
        bar_show(&n->bar, text);
    }
    pthread_mutex_unlock(&n->lock);
    return NULL;
}

/* Starts the line, without which everything works as well. */
static void notice_begin(struct notice *n, const char *path)
{
    *n = (struct notice){.name = strcmp(path, "-") == 0 ? "standard input"
                                                        : path_name(path),
                         .before_bytes = file_bytes_read(),
                         .bar = batch_bar_begin()};
    pthread_mutex_init(&n->lock, NULL);
    thread_condition_init(&n->end);
    n->bar.is_wanted =
        n->bar.is_wanted && thread_start(&n->thread, notice_run, n) == 0;
}

static void notice_end(struct notice *n)
{
    pthread_mutex_lock(&n->lock);
    n->is_ending = true;
    pthread_cond_signal(&n->end);
    pthread_mutex_unlock(&n->lock);
    if (n->bar.is_wanted)
        pthread_join(n->thread, NULL);
    erase(&n->bar);
    pthread_cond_destroy(&n->end);
    pthread_mutex_destroy(&n->lock);
}

bool batch_open(struct session *s, const struct options *o, uint64_t start_ns,
                struct error *err)
{
    struct notice notice;
    bool ok;

    notice_begin(&notice, o->scene_path);
    ok = session_open(s, o, start_ns, err);
    notice_end(&notice);
    /* warnings about a file matter only if it is rendered */
    if (ok)
        warnings_print(&s->engine.report, stderr);
    return ok;
}

/* ---- lines ---- */

bool batch_say_empty(struct error *err)
{
    if (stop_signal == 0)
        return fail(err, "--time: found an end before the first sample, "
                         "expected a longer time: nothing written");
    print_line(stderr, "stopped by %s before the first sample: nothing written",
               signal_name(stop_signal));
    return true;
}

/* Formats the limit that ended the render, with a colon: "stopped at 1 %: ".
 * The text is empty if there was no choice, since samples were the only limit.
 */
static void format_limit(char text[ERROR_TEXT_BYTES],
                         const struct render_progress *p,
                         const struct options *o)
{
    struct render_limits limits = options_limits(o);
    bool has_choice = limits.error > 0 || limits.time_ns != 0;

    text[0] = '\0';
    if (p->stopped_by == RENDER_LIMIT_ERROR)
        snprintf(text, ERROR_TEXT_BYTES,
                 "stopped at %g %%: ", 100 * limits.error);
    else if (p->stopped_by == RENDER_LIMIT_TIME)
        snprintf(text, ERROR_TEXT_BYTES,
                 "stopped after %g s: ", seconds_between(0, limits.time_ns));
    else if (p->stopped_by == RENDER_LIMIT_SPP && has_choice)
        snprintf(text, ERROR_TEXT_BYTES,
                 "stopped at %" PRIu64 " spp: ", p->spp_limit);
}

void batch_say_result(const char *name, const struct session *s,
                      const struct render_progress *p)
{
    const struct film *film = render_film(s->engine.render);
    char limit[ERROR_TEXT_BYTES], spp[48], error[ERROR_TEXT_BYTES];

    format_limit(limit, p, s->options);
    format_spp(spp, p);
    error_text_interval(error, &p->film_error);
    if (stop_signal != 0)
        print_line(stderr, "stopped by %s at %s: wrote %s, error %s",
                   signal_name(stop_signal), spp, name, error);
    else
        print_line(stderr, "%s: %s%dx%d, %" PRIu64 " spp, %.1f s, error %s",
                   name, limit, film->width, film->height, p->spp_done,
                   seconds_between(s->start_ns, clock_ns()), error);
    batch_warn_of_samples(p->non_finite, p->saturated);
}

void batch_say_filtered(const char *name)
{
    print_line(stderr, "%s: filtered", name);
}

void batch_warn_unfiltered(void)
{
    print_line(stderr, "glim: warning: --denoise: a pixel has fewer than two "
                       "samples or no features; the picture is not filtered");
}

void batch_warn_of_samples(uint64_t non_finite, uint64_t saturated)
{
    const uint64_t faults[2][2] = {{non_finite, 0}, {0, saturated}};
    char text[ERROR_FAULTS_BYTES];

    for (int i = 0; i < 2; i++)
        if (error_text_faults(text, faults[i][0], faults[i][1]))
            print_line(stderr, "glim: warning: %s", text);
}

void batch_say_frames(int done, int count, uint64_t begin_ns)
{
    if (done < count)
        print_line(stderr, "stopped by %s after %d of %d picture%s",
                   signal_name(stop_signal), done, count,
                   print_plural((uint64_t)count));
    else
        print_line(stderr, "%d picture%s, %.1f s", done,
                   print_plural((uint64_t)done),
                   seconds_between(begin_ns, clock_ns()));
}

void batch_warn_of_device(const char *text)
{
    print_line(stderr, "glim: warning: %s; the CPU renders", text);
}
