// SPDX-License-Identifier: MIT
#include "session/video_pipe.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "terminal/xmalloc.h"

extern char **environ;

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

bool video_pipe_open(struct video_pipe *v, const char *path, int width,
                     int height, double fps, bool *is_missing,
                     struct error *err)
{
    char size[32], rate[32];
    int ends[2], reason;
    char *file;

    *v = (struct video_pipe){.path = path};
    *is_missing = false;
    if (pipe2(ends, O_CLOEXEC) != 0)
        return fail(err, "%s: cannot make a pipe: %s", path, strerror(errno));
    snprintf(size, sizeof size, "%dx%d", width, height);
    snprintf(rate, sizeof rate, "%.6f", fps);
    file = xformat("file:%s", path); /* not an option or a protocol */
    reason = start(v, ends[0], size, rate, file);
    free(file);
    close(ends[0]);
    v->fd = ends[1];
    if (reason == 0)
        return true;
    close(ends[1]);
    v->process = 0;
    *is_missing = reason == ENOENT;
    return fail(err, "%s: cannot start ffmpeg: %s", path, strerror(reason));
}

bool video_pipe_write(struct video_pipe *v, const struct frame *frame,
                      struct error *err)
{
    size_t left = 3 * (size_t)frame->width * (size_t)frame->height;
    const uint8_t *p = frame->rgb;

    while (left > 0) {
        ssize_t n = write(v->fd, p, left);

        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return fail(err, "%s: ffmpeg took no more pictures: %s", v->path,
                        strerror(errno));
        p += n;
        left -= (size_t)n;
    }
    return true;
}

bool video_pipe_close(struct video_pipe *v, struct error *err)
{
    pid_t process = v->process;
    const char *path = v->path;
    int status;

    if (process == 0)
        return true;
    close(v->fd);
    *v = (struct video_pipe){.path = NULL};
    while (waitpid(process, &status, 0) < 0)
        if (errno != EINTR)
            return fail(err, "%s: lost ffmpeg: %s", path, strerror(errno));
    return (WIFEXITED(status) && WEXITSTATUS(status) == 0) ||
           fail(err, "%s: ffmpeg failed with %s %d", path,
                WIFEXITED(status) ? "status" : "signal",
                WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status));
}
