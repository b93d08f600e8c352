// SPDX-License-Identifier: MIT
/*
 * glim.h - renders OBJ scenes: the public interface of libglim
 *
 *     struct glim_error err;
 *     struct glim *g = glim_open("scene.obj", NULL, &err);
 *
 *     if (g == NULL || glim_render(g, 64, 0, NULL, NULL, &err) != GLIM_DONE ||
 *         !glim_save(g, "scene.png", &err))
 *         fprintf(stderr, "%s\n", err.text);
 *     glim_close(g);
 *
 * A handle holds a scene, the camera that sees it, and the picture that is
 * rendered of it. libglim(3) describes all of it.
 *
 * Units:     points in the scene's units, degrees, pixels, seconds, samples a
 *            pixel; row 0 of a picture is the top
 * Ownership: glim_close() frees a handle and all that it holds; texts that
 *            functions return are the handle's
 * Threads:   handles do not know each other: each may have a thread of its own.
 *            One thread at a time uses a handle, but for glim_cancel()
 * Errors:    functions that can fail return NULL, false or GLIM_FAILED and
 *            write one finished line to *err, which may be NULL. Nothing is
 *            printed, no signal, locale or variable of the environment is
 *            changed, and the process goes on, also when memory is out
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

/* Handle. */
struct glim;

struct glim_error {
    char text[1024]; /* place, what was found, what was expected */
};

enum glim_up { GLIM_UP_Y, GLIM_UP_Z };

enum glim_backend {
    GLIM_BACKEND_CPU,
    GLIM_BACKEND_GPU,   /* OpenCL on a GPU */
    GLIM_BACKEND_OPENCL /* OpenCL on any device */
};

enum glim_result {
    GLIM_FAILED,  /* see the error */
    GLIM_DONE,    /* every pixel has the samples, or the time is up */
    GLIM_STOPPED, /* by the progress function or glim_cancel() */
};

struct glim_camera {
    double eye[3];
    double at[3]; /* the point that the camera looks at */
    double up[3];
    double fovy_deg; /* vertical; above 0, below 180 */
    double aperture; /* diameter of the lens; 0: a pinhole */
    double focus;    /* distance of the sharp plane; 0: that of `at` */
};

struct glim_progress {
    uint64_t spp;           /* samples that every pixel has */
    uint64_t spp_limit;     /* 0: none */
    uint64_t samples;       /* of all pixels together */
    uint64_t samples_limit; /* 0: none */
    uint64_t non_finite;    /* samples that count as black: a damaged scene */
    double seconds;         /* of rendering since the picture's first sample */
    double build_seconds;   /* those of them that the tree of triangles took */
};

/* Returns GLIM_VERSION of the library that runs, which may differ from the
 * header's. */
GLIM_API const char *glim_version(void);

/* ---- scenes ---- */

/* Options of glim_open(); a zeroed struct has the defaults. */
struct glim_open_options {
    const char *view_path; /* the view file; NULL: the file beside the scene
                              that has its name and ends with .view, if there
                              is one */
    enum glim_up up;
    int threads; /* as in glim_set_threads(), also for reading images */
};

/* Opens the scene of an OBJ file with its materials and images, and its view
 * file with camera, size and sky. A scene without a camera is seen as a whole,
 * a dark one gets a soft sky. `options` may be NULL. Returns NULL if it
 * fails. */
GLIM_API struct glim *glim_open(const char *path,
                                const struct glim_open_options *options,
                                struct glim_error *err);

/* Frees the handle; NULL is none. */
GLIM_API void glim_close(struct glim *g);

/* Returns a warning about the files, one line for each number from 0; NULL
 * after the last. The scene is rendered without the part that it is about. */
GLIM_API const char *glim_warning(const struct glim *g, int number);

/* Returns the name of a file that the scene was read from, for each number from
 * 0; NULL after the last. The view file is among them and need not exist. */
GLIM_API const char *glim_file(const struct glim *g, int number);

/* ---- settings, each of which ends the picture: the next glim_render() begins
 * a new one ---- */

GLIM_API struct glim_camera glim_get_camera(const struct glim *g);

/* False for a camera that sees nothing, such as one with eye and at in one
 * point. */
GLIM_API bool glim_set_camera(struct glim *g, const struct glim_camera *camera,
                              struct glim_error *err);

/* Size of the picture: 1 to 65536 pixels. The set function takes 0 for the one
 * of both that follows from the shape of the picture so far. A crop ends. */
GLIM_API void glim_get_size(const struct glim *g, int *width, int *height);
GLIM_API bool glim_set_size(struct glim *g, int width, int height,
                            struct glim_error *err);

/* Restricts the picture to a part, which must lie in it. The picture that is
 * read and saved has the size of the part. */
GLIM_API bool glim_set_crop(struct glim *g, int x, int y, int width, int height,
                            struct glim_error *err);

/* Sets the number of reflections after which a path ends; -1, the default: no
 * limit. */
GLIM_API bool glim_set_max_bounces(struct glim *g, int count,
                                   struct glim_error *err);

/* Sets the seed of the random numbers. Pictures of different seeds have
 * independent noise. */
GLIM_API void glim_set_seed(struct glim *g, uint32_t seed);

/* Sets the number of CPU threads; 0: all that the process may use. It changes
 * no bit of a picture. */
GLIM_API bool glim_set_threads(struct glim *g, int count,
                               struct glim_error *err);

/* Selects the backend; the default is the CPU. A copy of the glim program tests
 * an OpenCL device before it is used here, which takes seconds, because drivers
 * crash. `device` is the number of a device or a part of its name, NULL: the
 * best one. After a failure the CPU renders. */
GLIM_API bool glim_set_backend(struct glim *g, enum glim_backend backend,
                               const char *device, struct glim_error *err);

/* Sets the path of the glim program that tests devices; NULL: the installed
 * one. */
GLIM_API bool glim_set_program(struct glim *g, const char *path,
                               struct glim_error *err);

/* Returns the output of the driver and its compiler at the last
 * glim_set_backend(), in lines; NULL if there is none. */
GLIM_API const char *glim_backend_log(const struct glim *g);

/* ---- the picture ---- */

/* Progress function. glim_render() calls it in the thread of its caller, ten
 * times a second. It may read and save the picture; false stops the render. */
typedef bool glim_progress_fn(void *context, const struct glim_progress *p);

/* Renders until every pixel has `spp` samples, or so many seconds have passed;
 * 0: no such limit. Blocks until then. Goes on with the picture that it has
 * rendered before if no setting has changed since. `progress` may be NULL. */
GLIM_API enum glim_result glim_render(struct glim *g, uint64_t spp,
                                      double seconds,
                                      glim_progress_fn *progress, void *context,
                                      struct glim_error *err);

/* Stops glim_render(), or the next call of it if none runs. From any thread,
 * and from a signal handler. */
GLIM_API void glim_cancel(struct glim *g);

/* Returns the progress of the picture; zeros if there is none. */
GLIM_API struct glim_progress glim_get_progress(struct glim *g);

/* Size of the picture that glim_render() has made; 0 if there is none. */
GLIM_API void glim_get_picture_size(const struct glim *g, int *width,
                                    int *height);

/* Reads linear radiance: red, green and blue of each pixel. `count` is the
 * number of floats, 3 times the pixels of the picture's size. */
GLIM_API bool glim_read_floats(struct glim *g, float *rgb, size_t count,
                               struct glim_error *err);

/* Reads 8-bit sRGB with the exposure and the tone curve of the view, likewise.
 */
GLIM_API bool glim_read_bytes(struct glim *g, uint8_t *rgb, size_t count,
                              struct glim_error *err);

/* Writes the picture: .png as glim_read_bytes(), .hdr and .pfm as
 * glim_read_floats(), "-" a PNG file to standard output. A file is replaced as
 * a whole or not at all. */
GLIM_API bool glim_save(struct glim *g, const char *path,
                        struct glim_error *err);

/* Writes STEM.png, or STEM-2.png, STEM-3.png, ...: the first name that is free.
 * Returns the name, valid until the next call, or NULL. */
GLIM_API const char *glim_save_new(struct glim *g, const char *stem,
                                   struct glim_error *err);

#ifdef __cplusplus
}
#endif

#endif
