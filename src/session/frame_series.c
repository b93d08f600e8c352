// SPDX-License-Identifier: MIT
#include "session/frame_series.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/print.h"
#include "scene/camera_path.h"
#include "terminal/xmalloc.h"

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
