// SPDX-License-Identifier: MIT
/*
 * glim.h - renders scenes: the public interface of libglim
 *
 *     struct glim_error err;
 *     struct glim *g = glim_open("scene.obj", NULL, &err);
 *
 *     if (g == NULL || glim_render(g, 64, 0, NULL, NULL, &err) != GLIM_DONE ||
 *         !glim_save(g, "scene.png", &err))
 *         fprintf(stderr, "%s\n", err.text);
 *     glim_close(g);
 *
 * A handle holds a scene, a camera and the picture that is rendered. libglim(3)
 * is the manual.
 *
 * Units:     points in the scene's units, degrees, pixels, seconds, samples per
 *            pixel; row 0 of a picture is the top
 * Ownership: glim_close() frees a handle and everything in it; texts that
 *            functions return belong to the handle
 * Threads:   handles are independent: each may have a thread of its own. One
 *            thread at a time uses a handle; only glim_cancel() may be called
 *            from others
 * Errors:    functions that can fail return NULL, false or GLIM_FAILED and
 *            write one finished line to *err, which may be NULL. Nothing is
 *            printed, no signal, locale or variable of the environment is
 *            changed, and the process goes on, also when memory is out.
 *            A pointer may be NULL only where this file says so: as a handle,
 *            name or buffer it is an error, and functions without errors do
 *            nothing or return 0. So are NaN, and values that an enum lacks
 */
#ifndef GLIM_GLIM_H
#define GLIM_GLIM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "glim/version.h"

#ifdef __cplusplus
extern "C" {
#endif

#ifdef __GNUC__
#define GLIM_API __attribute__((visibility("default")))
#else
#define GLIM_API
#endif

/* Handle of a scene and its picture. */
struct glim;

struct glim_error {
    char text[1024]; /* place, what was found, what was expected */
};

enum glim_up {
    GLIM_UP_OF_FILE, /* axis that the format of the file has */
    GLIM_UP_Y,
    GLIM_UP_Z
};

enum glim_backend {
    GLIM_BACKEND_CPU,
    GLIM_BACKEND_GPU,   /* OpenCL on a GPU */
    GLIM_BACKEND_OPENCL /* OpenCL on any device */
};

enum glim_result {
    GLIM_FAILED,  /* *err has the reason */
    GLIM_DONE,    /* a limit is reached */
    GLIM_STOPPED, /* stopped by the progress function or glim_cancel() */
};

/* Limits of a render. */
enum glim_limit {
    GLIM_LIMIT_NONE,
    GLIM_LIMIT_SPP,
    GLIM_LIMIT_ERROR,
    GLIM_LIMIT_SECONDS
};

struct glim_camera {
    double eye[3];
    double at[3]; /* the point that the camera looks at */
    double up[3];
    double fovy_deg; /* vertical; above 0, below 180 */
    double aperture; /* diameter of the lens; 0 for a pinhole */
    double focus;    /* distance of the sharp plane; 0: that of `at` */
};

struct glim_progress {
    uint64_t spp;           /* samples that every pixel has */
    uint64_t spp_limit;     /* 0: none */
    uint64_t samples;       /* samples of all pixels together */
    uint64_t samples_limit; /* 0: none */
    uint64_t non_finite;    /* NaN, infinite or negative samples: black */
    uint64_t saturated;     /* samples too bright for the sums: cut */
    double seconds;         /* time spent on the picture */
    double build_seconds;   /* part of it for the tree of triangles */
    /* relative error of the picture at the end of the last pass, 0.01 for 1 %,
     * and its 95 % interval; all 0 while unknown */
    bool error_is_known;
    bool error_is_resolved; /* false if few pixels carry most of it */
    double error, error_low, error_high;
    /* the limit that ended the last glim_render(), or the nearest one while it
     * runs */
    enum glim_limit limit;
    double part_done;    /* part of the way to that limit, 0 to 1 */
    double seconds_left; /* time until then; negative if unknown */
};

/* Returns the GLIM_VERSION of the linked library, which may differ from the
 * header's. */
GLIM_API const char *glim_version(void);

/* ---- scenes ---- */

/* Sun with a clear sky around it, which replaces the sky of the view file. */
struct glim_sun {
    double azimuth_deg;   /* clockwise from -z, -360 to 360 */
    double elevation_deg; /* above the horizon, -90 to 90 */
};

/* Options of glim_open(); a zeroed struct has the defaults. */
struct glim_open_options {
    /* path of the view file; NULL means the file with the scene's name and the
     * ending .view, if it exists */
    const char *view_path;
    enum glim_up up;
    const struct glim_sun *sun; /* NULL means that of the view file, if any */
    double turbidity; /* haze of the sun's sky, 1.7 to 10; 0 means that of the
                         view file */
    /* number or name of the camera: a numbered view of the view file, or a
     * camera of the scene; NULL means the view's own */
    const char *camera;
    /* scene and animation of a glTF file by number, from 1, or name; NULL means
     * the file's default and the first one */
    const char *scene;
    const char *animation;
    const char *variant; /* of its materials; NULL means none */
    /* pose as the animation has it after anim_time_s seconds; without both, the
     * file is at rest */
    bool has_anim_time;
    double anim_time_s;
    /* lines of a view file that go over its own: "exposure 1.5\nsky a.hdr". A
     * sky or background replaces the sun. Names of files are relative to the
     * current folder. NULL means none */
    const char *view_lines;
    int threads; /* CPU threads as in glim_set_threads(), also for reading
                    images */
    /* path of the glim program, whose copies test devices and read formats of
     * others; NULL means the installed one */
    const char *program;
};

/* Opens the scene of a file of a format that glim --formats lists, which gzip
 * may have packed ("-": standard input), with its materials and images, and its
 * view file with camera, size and sky. A scene without a camera is framed as a
 * whole; a scene without light gets a soft sky, a glTF, PLY or STL model also a
 * lamp. `options` may be NULL, which means the defaults. Returns NULL on
 * errors. */
GLIM_API struct glim *glim_open(const char *path,
                                const struct glim_open_options *options,
                                struct glim_error *err);

/* Frees the handle. NULL is allowed. */
GLIM_API void glim_close(struct glim *g);

/* Returns warning `number` about the files, one line, or NULL after the last.
 * Numbers begin with 0. Parts of the scene with a warning are not rendered as
 * the file says. */
GLIM_API const char *glim_warning(const struct glim *g, int number);

/* Returns the name of file `number` that the scene was read from, or NULL after
 * the last. Numbers begin with 0. The view file is included even if it does not
 * exist. */
GLIM_API const char *glim_file(const struct glim *g, int number);

/* ---- settings. Each ends the picture: the next glim_render() begins a new one
 * ---- */

/* Returns the camera. */
GLIM_API struct glim_camera glim_get_camera(const struct glim *g);

/* Sets the camera. Returns false for an impossible one, such as one with eye
 * and at in one point. */
GLIM_API bool glim_set_camera(struct glim *g, const struct glim_camera *camera,
                              struct glim_error *err);

/* Get and set the size of the picture: 1 to 65536 pixels each way. A width or
 * height of 0 is computed from the other one and the previous aspect ratio.
 * Setting the size removes the crop. A pointer to a number that is not wanted
 * may be NULL. */
GLIM_API void glim_get_size(const struct glim *g, int *width, int *height);
GLIM_API bool glim_set_size(struct glim *g, int width, int height,
                            struct glim_error *err);

/* Restricts the picture to a part. Pictures that are read and saved have the
 * size of the part. Returns false if it is not inside the picture. */
GLIM_API bool glim_set_crop(struct glim *g, int x, int y, int width, int height,
                            struct glim_error *err);

/* Sets the greatest number of bounces of a path; -1, the default, is no
 * limit. */
GLIM_API bool glim_set_max_bounces(struct glim *g, int count,
                                   struct glim_error *err);

/* Sets the seed of the random numbers. Different seeds give independent
 * noise. */
GLIM_API void glim_set_seed(struct glim *g, uint32_t seed);

/* Sets the number of CPU threads; 0 means all processors that the process may
 * use. The number does not affect the picture. */
GLIM_API bool glim_set_threads(struct glim *g, int count,
                               struct glim_error *err);

/* Selects the backend; the default is the CPU. `device` is the number of an
 * OpenCL device or a part of its name, or NULL for the best one. The glim
 * program first tests the device in a process of its own, since drivers crash;
 * this takes seconds. After an error the CPU renders. */
GLIM_API bool glim_set_backend(struct glim *g, enum glim_backend backend,
                               const char *device, struct glim_error *err);

/* Returns the output of the driver and its compiler at the last
 * glim_set_backend(), in lines; NULL if there is none. */
GLIM_API const char *glim_backend_log(const struct glim *g);

/* ---- the picture ---- */

/* Progress function. glim_render() calls it ten times per second, in the thread
 * of its caller. It may read and save the picture. Returning false stops the
 * render. */
typedef bool glim_progress_fn(void *context, const struct glim_progress *p);

/* Sets the limit of the picture's error for glim_render(), 0.01 for 1 %; 0, the
 * default, is no limit. The picture so far stays. Returns false for an error
 * that is not a number from 0 to 1. */
GLIM_API bool glim_set_error_limit(struct glim *g, double error,
                                   struct glim_error *err);

/* Sets whether pixels with more error get more samples: then `spp` is the mean
 * over the pixels. Off by default. A change begins a new picture. */
GLIM_API void glim_set_adaptive(struct glim *g, bool is_adaptive);

/* Sets whether the picture that is read and saved is filtered, which removes
 * most of its noise. Off by default. The filter needs 264 bytes more a pixel
 * from the first sample on: a picture that began without them ends. Switching
 * it off keeps the picture. Fails if the kernels of glim_set_backend() lack the
 * filter, because it was not wanted then. */
GLIM_API bool glim_set_denoise(struct glim *g, bool is_wanted,
                               struct glim_error *err);

/* Returns true if the picture that is read and saved is filtered. It is not
 * while a pixel has fewer than two samples. */
GLIM_API bool glim_is_denoised(struct glim *g);

/* Renders until every pixel has `spp` samples, `seconds` have passed, or the
 * upper end of the error is at its limit; 0 is no limit, and `seconds` below 0
 * are an error. Blocks until then. Continues the previous picture if no setting
 * has changed since. `progress` may be NULL. */
GLIM_API enum glim_result glim_render(struct glim *g, uint64_t spp,
                                      double seconds,
                                      glim_progress_fn *progress, void *context,
                                      struct glim_error *err);

/* Stops glim_render(), or its next call if none is running. Callable from any
 * thread and from signal handlers. */
GLIM_API void glim_cancel(struct glim *g);

/* Returns the progress of the picture, all 0 if there is none. */
GLIM_API struct glim_progress glim_get_progress(struct glim *g);

/* Returns the size of the rendered picture, 0 if there is none. A pointer to a
 * number that is not wanted may be NULL. */
GLIM_API void glim_get_picture_size(const struct glim *g, int *width,
                                    int *height);

/* Reads linear radiance: red, green and blue of each pixel. `count` must be 3
 * times the number of pixels in the picture. */
GLIM_API bool glim_read_floats(struct glim *g, float *rgb, size_t count,
                               struct glim_error *err);

/* Reads 8-bit sRGB with the exposure and the tone curve of the view. `count` is
 * as in glim_read_floats(). */
GLIM_API bool glim_read_bytes(struct glim *g, uint8_t *rgb, size_t count,
                              struct glim_error *err);

/* Writes the picture: .png with the values of glim_read_bytes(), .hdr,
 * .pfm and .exr with those of glim_read_floats(), "-" as PNG to standard
 * output. A file is replaced completely or stays unchanged. */
GLIM_API bool glim_save(struct glim *g, const char *path,
                        struct glim_error *err);

/* Writes STEM.png, or STEM-2.png, STEM-3.png, ...: the first free name. Returns
 * the name, valid until the next call, or NULL on errors. */
GLIM_API const char *glim_save_new(struct glim *g, const char *stem,
                                   struct glim_error *err);

/* ---- films: files with the exact sums of all samples ---- */

/* Writes the film of the picture, from which glim_load_films() and the program,
 * with --resume, go on to the bytes of a render at once. */
GLIM_API bool glim_save_film(struct glim *g, const char *path,
                             struct glim_error *err);

/* Replaces the picture by that of one or more films, such as shares of its
 * samples: together they must have all samples from the first on. The next
 * glim_render() adds to it. Films of another scene or of other settings are an
 * error, and the picture stays. */
GLIM_API bool glim_load_films(struct glim *g, const char *const *paths,
                              int count, struct glim_error *err);

#ifdef __cplusplus
}
#endif

#endif
