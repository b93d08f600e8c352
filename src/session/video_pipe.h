// SPDX-License-Identifier: MIT
/*
 * video_pipe.h - a video file that a process of ffmpeg writes from pictures
 *
 * Ownership: video_pipe_close() ends the process; the path stays the caller's
 * Threads:   one at a time
 * Errors:    no ffmpeg, or one that fails; its own words go to standard error
 */
#ifndef GLIM_VIDEO_PIPE_H
#define GLIM_VIDEO_PIPE_H

#include <sys/types.h>

#include "base/error.h"
#include "base/file.h"
#include "image/frame.h"

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

#endif
