// SPDX-License-Identifier: MIT
/*
 * frame_series.h - the pictures of a moving camera or an animated scene: their
 * poses, the names of their files, their progress, and a video that a process
 * of ffmpeg writes from them
 *
 * Ownership: frame_series_end() frees; session and options are the caller's;
 *            video_pipe_close() ends the process
 * Threads:   main only
 * Errors:    too few numbered views; scenes without an animation; no ffmpeg, or
 * one that fails; its own words go to standard error
 */
#ifndef GLIM_FRAME_SERIES_H
#define GLIM_FRAME_SERIES_H

#include <sys/types.h>

#include "base/error.h"
#include "base/file.h"
#include "image/frame.h"
#include "render/progress.h"
#include "session/session.h"

/* ---- videos ---- */

struct video_pipe {
    const char *path;
    pid_t process; /* 0: none */
    int fd;
    struct file_identity before; /* the file of that name at the start */
    bool is_missing;             /* after a failed open: there is no ffmpeg */
};

/* Returns true if the name ends like that of a video: .mp4, .webm or .webp. */
bool video_pipe_is_name(const char *path);

/* Starts ffmpeg, which replaces the file. */
bool video_pipe_open(struct video_pipe *v, const char *path, int width,
                     int height, double fps, struct error *err);

/* Adds a picture of the video's size. Blocks until ffmpeg has read it. */
bool video_pipe_write(struct video_pipe *v, const struct frame *frame,
                      struct error *err);

/* Ends the video and waits until ffmpeg has written it. If it fails, or hangs
 * when a signal ends the program, what it has written of the file is removed. A
 * zeroed struct is closed. */
bool video_pipe_close(struct video_pipe *v, struct error *err);

/* ---- series ---- */

/*
 * Frames are numbered from 0. Frame k of a turntable of N is turned by
 * k * 360 / N degrees; those of a flight have equal steps along the numbered
 * views. Without either, the scene is loaded again for each frame, as its
 * animation poses it at k / fps seconds.
 */

struct frame_series {
    struct session *session;
    const struct options *given; /* the options of all frames */
    struct options options;      /* those of the present frame */
    struct pose base;            /* of a turntable */
    struct pose keys[VIEW_SHOTS];
    int key_count;
    int first, last, present; /* numbers of frames */
    uint64_t begin_ns, frame_begin_ns;
    struct video_pipe video; /* if it is open */
    char *default_path;      /* without -o or ffmpeg; NULL: not needed */
    char *names[4];          /* of the files of the present frame */
};

/* Returns true if the options ask for several frames. */
bool frame_series_is_wanted(const struct options *o);

/* Finds the frames of the session's options, and opens their video. If there is
 * no ffmpeg for it, a warning says so, and they become PNG files. */
bool frame_series_begin(struct frame_series *f, struct session *s,
                        struct error *err);

/* Returns true before the last frame. */
bool frame_series_has_next(const struct frame_series *f);

/* Gives the session the camera or the scene of the next frame, and options with
 * numbers in the names of the files. */
bool frame_series_next(struct frame_series *f, struct error *err);

/* Returns the number of frames, and of those before the present one. */
int frame_series_count(const struct frame_series *f);
int frame_series_done(const struct frame_series *f);

/* Returns what is left of all frames, from what is left of the present one:
 * the frames to come take the mean time of those that are done. */
struct render_left frame_series_left(const struct frame_series *f,
                                     struct render_left frame, uint64_t now_ns);

/* Ends the video, if there is one. */
bool frame_series_close(struct frame_series *f, struct error *err);

/* Gives the session its own options back. */
void frame_series_end(struct frame_series *f);

/* Returns the name of a frame's file, for free(): %d or %04d in the last part
 * of the path becomes the number; without it, -0001 goes before the ending.
 * NULL when memory is out. */
char *frame_name(const char *path, int number);

#endif
