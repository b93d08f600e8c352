// SPDX-License-Identifier: MIT
#include "batch_progress.h"

#include <errno.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/event_fd.h"
#include "base/print.h"
#include "picture/image_write.h"

/* ---- output file ---- */

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
static int stop_fd;
static struct glim *volatile stopped; /* NULL: none */

static void on_stop_signal(int number)
{
    int saved_errno = errno;

    if (stop_signal == 0)
        stop_signal = number;
    event_fd_set(stop_fd);
    if (stopped != NULL)
        glim_cancel(stopped);
    errno = saved_errno;
}

bool batch_catch_signals(struct glim *g, int *wake_fd, struct error *err)
{
    struct sigaction action = {.sa_handler = on_stop_signal,
                               .sa_flags = SA_RESTART};

    stop_fd = event_fd_open("signals", err);
    if (stop_fd < 0)
        return false;
    *wake_fd = stop_fd;
    stopped = g;
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

static const char *signal_name(int number)
{
    for (int i = 0; i < STOP_SIGNAL_COUNT; i++) {
        if (stop_signals[i].number == number)
            return stop_signals[i].name;
    }
    return "a signal";
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

/* One line without its end. Samples per second are those of the tracing
 * alone: the time left follows from them. */
static void format_bar(char *text, size_t size_bytes,
                       const struct glim_progress *p)
{
    static const char full[] = "####################";
    static const char empty[] = "--------------------";
    double done = p->samples_limit == 0
                      ? 0.0
                      : (double)p->samples / (double)p->samples_limit;
    double elapsed = p->seconds;
    double tracing = elapsed - p->build_seconds;
    double rate = tracing > 0.0 ? (double)p->samples / tracing : 0.0;
    int filled = (int)(done * 20.0);
    char elapsed_text[16], left_text[16] = "-";

    format_time(elapsed_text, elapsed);
    if (rate > 0.0)
        format_time(left_text, (double)(p->samples_limit - p->samples) / rate);
    snprintf(text, size_bytes,
             "%3d %% [%.*s%.*s] %" PRIu64 " of %" PRIu64
             " spp, %.2f Msamples/s, %s, left %s",
             (int)(done * 100.0), filled, full, 20 - filled, empty, p->spp,
             p->spp_limit, rate * 1e-6, elapsed_text, left_text);
}

/* Writes `text` over what is shown; a line that filled the last column would
 * wrap. */
static void bar_show(struct batch_bar *bar, const char *text)
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

struct batch_bar batch_bar_begin(void)
{
    return (struct batch_bar){.is_wanted = isatty(STDERR_FILENO) == 1};
}

void batch_bar_draw(struct batch_bar *bar, const struct glim_progress *p)
{
    char text[160];

    if (!bar->is_wanted)
        return;
    format_bar(text, sizeof text, p);
    bar_show(bar, text);
}

void batch_bar_erase(struct batch_bar *bar)
{
    if (bar->shown_cols == 0)
        return;
    bar_show(bar, "");
    fputc('\r', stderr);
    bar->shown_cols = 0;
}

/* ---- lines ---- */

void batch_say_empty(void)
{
    print_line(stderr, "stopped by %s before the first sample: nothing written",
               signal_name(stop_signal));
}

void batch_say_result(const char *name, int width, int height,
                      const struct glim_progress *p, uint64_t start_ns)
{
    if (stop_signal != 0)
        print_line(stderr,
                   "stopped by %s at %" PRIu64 " of %" PRIu64 " spp: wrote %s",
                   signal_name(stop_signal), p->spp, p->spp_limit, name);
    else
        print_line(stderr, "%s: %dx%d, %" PRIu64 " spp, %.1f s", name, width,
                   height, p->spp, seconds_between(start_ns, clock_ns()));
    if (p->non_finite > 0)
        print_line(stderr,
                   "glim: warning: %" PRIu64
                   " samples were not finite and count as black",
                   p->non_finite);
}

void batch_warn_of_device(const char *text)
{
    print_line(stderr, "glim: warning: %s; the CPU renders", text);
}
