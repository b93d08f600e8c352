// SPDX-License-Identifier: MIT
#include "session/frame_series.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
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
#include "base/file.h"
#include "base/memory.h"
#include "base/print.h"
#include "base/stop.h"
#include "scene/camera_path.h"
#include "terminal/xmalloc.h"

/* ---- videos ---- */

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

/* ---- series ---- */

/* ---- names ---- */

/* Finds %d or %0Nd in a name. Returns NULL if there is none; *end is behind
 * it. */
static const char *find_place(const char *name, int *digits, const char **end)
{
    for (const char *p = strchr(name, '%'); p; p = strchr(p + 1, '%')) {
        bool has_width = p[1] == '0' && p[2] >= '1' && p[2] <= '9';

        *end = p + (has_width ? 4 : 2);
        *digits = has_width ? p[2] - '0' : 1;
        if (p[has_width ? 3 : 1] == 'd')
            return p;
    }
    return NULL;
}

char *frame_name(const char *path, int number)
{
    const char *name = path_name(path), *end;
    const char *dot = strrchr(name, '.');
    int digits;
    const char *place = find_place(name, &digits, &end);

    if (place != NULL)
        return format_text("%.*s%0*d%s", (int)(place - path), path, digits,
                           number, end);
    if (dot == NULL || dot == name)
        dot = name + strlen(name);
    return format_text("%.*s-%04d%s", (int)(dot - path), path, number, dot);
}

/* Replaces the name of a file by that of the present frame. */
static void number_name(struct frame_series *f, int i, const char **path)
{
    free(f->names[i]);
    f->names[i] = NULL;
    if (*path == NULL || strcmp(*path, "-") == 0)
        return;
    f->names[i] = xchecked(frame_name(*path, f->present));
    *path = f->names[i];
}

static void number_names(struct frame_series *f)
{
    struct options *o = &f->options;

    *o = *f->given;
    if (f->default_path != NULL)
        o->output_path = f->default_path;
    if (f->video.process == 0)
        number_name(f, 0, &o->output_path);
    number_name(f, 1, &o->denoise_path);
    number_name(f, 2, &o->error_map_path);
    number_name(f, 3, &o->stats_path);
}

/* ---- frames ---- */

bool frame_series_is_wanted(const struct options *o)
{
    return o->turntable_count > 0 || o->fly_count > 0 || o->has_frames;
}

static bool find_keys(struct frame_series *f, struct error *err)
{
    const struct view *view = &f->session->edit.now.view;

    for (int i = 0; i < VIEW_SHOTS; i++)
        if (view->has_shot[i])
            f->keys[f->key_count++] = view->shots[i];
    return f->key_count >= 2 ||
           fail(err,
                "--fly: found %d numbered view%s in %s, expected at least 2",
                f->key_count, print_plural((uint64_t)f->key_count),
                f->session->engine.view_path);
}

/* Returns the name of the scene as that of a picture in the current folder. */
static char *default_path(const char *scene_path)
{
    char *stem = xchecked(path_stem_of_input(scene_path));
    char *path = xformat("%s.png", path_name(stem));

    free(stem);
    return path;
}

/* Returns the name of a video as that of pictures. */
static char *path_of_pictures(const char *video_path)
{
    char *stem = xchecked(path_stem(video_path));
    char *path = xformat("%s.png", stem);

    free(stem);
    return path;
}

/* Opens the video, or finds the names of files without one. */
static bool find_output(struct frame_series *f, struct error *err)
{
    struct session *s = f->session;
    const char *path = f->given->output_path;
    char *first;

    if (path == NULL && f->given->text_cols == 0)
        f->default_path = default_path(f->given->scene_path);
    if (!options_output_is_video(f->given))
        return true;
    if (!session_check_output(s, "-o", path, err) || !file_check(path, err))
        return false;
    if (video_pipe_open(&f->video, path, s->engine.crop.width,
                        s->engine.crop.height, f->given->fps, err))
        return true;
    if (!f->video.is_missing)
        return false;
    f->default_path = path_of_pictures(path);
    first = xchecked(frame_name(f->default_path, f->first));
    print_line(stderr,
               "glim: warning: -o %s: found no ffmpeg, expected one for a "
               "video: the pictures are files, from %s on",
               path, first);
    free(first);
    return true;
}

bool frame_series_begin(struct frame_series *f, struct session *s,
                        struct error *err)
{
    const struct options *o = s->options;

    *f = (struct frame_series){.session = s,
                               .given = o,
                               .base = s->edit.now.view.pose,
                               .begin_ns = clock_ns()};
    f->last = (o->fly_count > 0 ? o->fly_count : o->turntable_count) - 1;
    if (o->has_frames) {
        f->first = o->first_frame;
        f->last = o->last_frame;
    }
    f->present = f->first - 1;
    if (o->fly_count > 0 && !find_keys(f, err))
        return false;
    if (o->fly_count == 0 && o->turntable_count == 0 &&
        !s->engine.scene.has_choices)
        return fail(err,
                    "--frames: found no animation in %s, expected a glTF "
                    "file, --turntable or --fly",
                    o->scene_path);
    return find_output(f, err);
}

/* Loads the scene as it is at the time of the frame. */
static bool load(struct frame_series *f, struct error *err)
{
    struct session *s = f->session, fresh;
    bool ok;

    f->options.choice.has_time = true;
    f->options.choice.time_s = f->present / f->given->fps;
    ok = session_load(&fresh, &f->options, f->frame_begin_ns, err);
    if (ok)
        session_take_loaded(s, &fresh);
    session_close(&fresh);
    return ok;
}

static struct pose pose_of(const struct frame_series *f)
{
    const struct options *o = f->given;
    struct pose pose = f->base;

    if (o->fly_count > 0)
        return camera_path_at(f->keys, f->key_count,
                              (double)f->present * (f->key_count - 1) /
                                  (o->fly_count - 1));
    pose_turn(&pose, f->present * 360.0 / o->turntable_count);
    return pose;
}

bool frame_series_has_next(const struct frame_series *f)
{
    return f->present < f->last;
}

bool frame_series_next(struct frame_series *f, struct error *err)
{
    struct pose pose;

    f->present++;
    f->frame_begin_ns = clock_ns();
    f->session->start_ns = f->frame_begin_ns;
    number_names(f);
    f->session->options = &f->options;
    if (f->given->turntable_count == 0 && f->given->fly_count == 0)
        return load(f, err);
    pose = pose_of(f);
    edit_pose(&f->session->edit, &pose);
    return true;
}

int frame_series_count(const struct frame_series *f)
{
    return f->last - f->first + 1;
}

int frame_series_done(const struct frame_series *f)
{
    return f->present - f->first;
}

struct render_left frame_series_left(const struct frame_series *f,
                                     struct render_left frame, uint64_t now_ns)
{
    int done = frame_series_done(f), count = frame_series_count(f);
    bool is_known = frame.limit != RENDER_LIMIT_NONE;
    double spent_ns = (double)(now_ns - f->frame_begin_ns);
    double mean_ns = spent_ns + frame.ns;
    double left_ns = frame.ns;

    frame.part = (done + frame.part) / count;
    if (done > 0)
        mean_ns = (double)(f->frame_begin_ns - f->begin_ns) / done;
    else if (!is_known)
        return frame;
    if (!is_known)
        left_ns = fmax(mean_ns - spent_ns, 0);
    frame.limit = is_known ? frame.limit : RENDER_LIMIT_SPP;
    frame.ns = left_ns + mean_ns * (count - done - 1);
    return frame;
}

bool frame_series_close(struct frame_series *f, struct error *err)
{
    return video_pipe_close(&f->video, err);
}

void frame_series_end(struct frame_series *f)
{
    struct error ignored; /* there is another one */

    frame_series_close(f, &ignored);
    for (size_t i = 0; i < sizeof f->names / sizeof f->names[0]; i++)
        free(f->names[i]);
    free(f->default_path);
    f->session->options = f->given;
    *f = (struct frame_series){.session = NULL};
}
