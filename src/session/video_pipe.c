// SPDX-License-Identifier: MIT
#include "session/video_pipe.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/stop.h"
#include "terminal/xmalloc.h"

/* Interval of looks at an ffmpeg that ends, and how many of them it has if a
 * signal ends the program between two pictures. */
#define LOOK_NS    10000000
#define LOOKS_LAST 25

extern char **environ;

/* The video of the program, for end_now(). */
static struct video_pipe running;
static atomic_bool is_running, is_between; /* between two pictures */

static const char *ending_of(const char *path)
{
    const char *dot = strrchr(path, '.');

    return dot != NULL ? dot : "";
}

bool video_pipe_is_name(const char *path)
{
    const char *ending = ending_of(path);

    return strcmp(ending, ".mp4") == 0 || strcmp(ending, ".webm") == 0 ||
           strcmp(ending, ".webp") == 0;
}

/* Starts the process with the read end of the pipe as its standard input. It
 * has a process group of its own, since Ctrl-C must not end it before the last
 * picture has come. Returns an error number. */
static int spawn(struct video_pipe *v, int input, const char *const *arguments)
{
    posix_spawn_file_actions_t files;
    posix_spawnattr_t how;
    int reason;

    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null",
                                     O_WRONLY, 0);
    posix_spawnattr_init(&how);
    posix_spawnattr_setflags(&how, POSIX_SPAWN_SETPGROUP);
    reason = posix_spawnp(&v->process, arguments[0], &files, &how,
                          (char *const *)(const void *)arguments, environ);
    posix_spawnattr_destroy(&how);
    posix_spawn_file_actions_destroy(&files);
    return reason;
}

/* Starts ffmpeg with the names and numbers as texts. Films get the colours of
 * BT.709, and even sides, which its chroma needs. */
static int start(struct video_pipe *v, int input, const char *size,
                 const char *rate, const char *file)
{
    static const char film_filter[] =
        "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:"
        "out_range=tv,format=yuv420p";
    bool is_film = strcmp(ending_of(v->path), ".webp") != 0;
    const char *const film[] = {
        "ffmpeg",      "-nostdin",    "-hide_banner",
        "-loglevel",   "error",       "-y",
        "-f",          "rawvideo",    "-pixel_format",
        "rgb24",       "-video_size", size,
        "-framerate",  rate,          "-i",
        "pipe:0",      "-vf",         film_filter,
        "-colorspace", "bt709",       "-color_primaries",
        "bt709",       "-color_trc",  "iec61966-2-1",
        file,          NULL};
    const char *const images[] = {"ffmpeg",     "-nostdin",    "-hide_banner",
                                  "-loglevel",  "error",       "-y",
                                  "-f",         "rawvideo",    "-pixel_format",
                                  "rgb24",      "-video_size", size,
                                  "-framerate", rate,          "-i",
                                  "pipe:0",     "-loop",       "0",
                                  file,         NULL};

    return spawn(v, input, is_film ? film : images);
}

/* ---- ends ---- */

/* Removes the file if ffmpeg has changed it. */
static void remove_partial(const struct video_pipe *v)
{
    struct file_identity now = file_identify(v->path);

    if (!file_is_same(&now, &v->before))
        unlink(v->path);
}

static bool has_failed(int status)
{
    return !WIFEXITED(status) || WEXITSTATUS(status) != 0;
}

/* Ends ffmpeg with the program, in the thread of stop.h. Between two pictures
 * it may end the video. */
static void end_now(void)
{
    const struct timespec look = {.tv_nsec = LOOK_NS};
    struct video_pipe v = running;
    int looks = 0, status = 0;
    pid_t ended = 0;

    if (!atomic_load(&is_running))
        return;
    if (atomic_load(&is_between)) {
        close(v.fd);
        while ((ended = waitpid(v.process, &status, WNOHANG)) == 0 &&
               looks++ < LOOKS_LAST)
            nanosleep(&look, NULL);
    }
    if (ended == v.process && !has_failed(status))
        return;
    kill(-v.process, SIGKILL);
    remove_partial(&v);
}

/* ---- the pipe ---- */

bool video_pipe_open(struct video_pipe *v, const char *path, int width,
                     int height, double fps, struct error *err)
{
    char size[32], rate[32];
    int ends[2], reason;
    char *file;

    *v = (struct video_pipe){.path = path, .before = file_identify(path)};
    if (pipe2(ends, O_CLOEXEC) != 0)
        return fail(err, "%s: cannot make a pipe: %s", path, strerror(errno));
    snprintf(size, sizeof size, "%dx%d", width, height);
    snprintf(rate, sizeof rate, "%.6f", fps);
    file = xformat("file:%s", path); /* not an option or a protocol */
    reason = start(v, ends[0], size, rate, file);
    free(file);
    close(ends[0]);
    v->fd = ends[1];
    if (reason == 0) {
        running = *v;
        atomic_store(&is_between, true);
        atomic_store(&is_running, true);
        stop_at_end(end_now);
        return true;
    }
    close(ends[1]);
    v->process = 0;
    v->is_missing = reason == ENOENT;
    return fail(err, "%s: cannot start ffmpeg: %s", path, strerror(reason));
}

bool video_pipe_write(struct video_pipe *v, const struct frame *frame,
                      struct error *err)
{
    size_t size_bytes = 3 * (size_t)frame->width * (size_t)frame->height;
    bool ok;

    atomic_store(&is_between, false);
    ok = file_write_pipe(v->fd, frame->rgb, size_bytes);
    atomic_store(&is_between, ok);
    if (!ok)
        stop_stay();
    return ok || fail(err, "%s: ffmpeg took no more pictures: %s", v->path,
                      strerror(errno));
}

/* Waits for the process. After a signal, stop.h ends the wait if the process
 * works no more: its processor time stands still. Returns false and errno if
 * its status is lost. */
static bool await(pid_t process, int *status)
{
    const struct timespec look = {.tv_nsec = LOOK_NS};
    uint64_t cpu_ns = 0;
    pid_t ended;

    stop_allow_begin();
    while ((ended = waitpid(process, status, WNOHANG)) == 0) {
        uint64_t now_ns = clock_process_ns(process);

        if (now_ns > cpu_ns) {
            stop_allow_end();
            stop_allow_begin();
        }
        cpu_ns = now_ns;
        nanosleep(&look, NULL);
    }
    stop_allow_end();
    return ended == process;
}

bool video_pipe_close(struct video_pipe *v, struct error *err)
{
    struct video_pipe ended = *v;
    int status;
    bool ok;

    if (v->process == 0)
        return true;
    atomic_store(&is_between, false);
    close(v->fd);
    *v = (struct video_pipe){.path = NULL};
    stop_hold();
    ok = await(ended.process, &status);
    stop_release();
    atomic_store(&is_running, false);
    if (!ok)
        return fail(err, "%s: lost ffmpeg: %s", ended.path, strerror(errno));
    if (!has_failed(status))
        return true;
    stop_stay();
    remove_partial(&ended);
    return fail(err, "%s: ffmpeg failed with %s %d", ended.path,
                WIFEXITED(status) ? "status" : "signal",
                WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status));
}
