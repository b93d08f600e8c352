// SPDX-License-Identifier: MIT
/*
 * glim.h - renders OBJ scenes: the public interface of libglim
 *
 *     struct glim_error err;
 *     struct glim *g = glim_open("scene.obj", NULL, GLIM_UP_Y, &err);
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

/* The handle. */
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

/* GLIM_VERSION of the library that runs, which may be newer than the header. */
GLIM_API const char *glim_version(void);

/* ---- scenes ---- */

/* Opens the scene of an OBJ file with its materials and images, and the view
 * file with camera, size and sky: `view_path`, or if that is NULL the file
 * beside the scene that has its name and ends with .view, if there is one. A
 * scene without a camera is seen as a whole, a dark one gets a soft sky. NULL:
 * failed. */
GLIM_API struct glim *glim_open(const char *path, const char *view_path,
                                enum glim_up up, struct glim_error *err);

/* Frees the handle; NULL is none. */
GLIM_API void glim_close(struct glim *g);

/* What was odd in the files but does not keep them from being rendered: one
 * line for each number from 0; NULL behind the last. */
GLIM_API const char *glim_warning(const struct glim *g, int number);

/* The files that the scene was read from, and the view file, which need not be
 * there: one for each number from 0; NULL behind the last. */
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

/* Renders only this part of the picture, which must lie in it. What is read and
 * saved has the size of the part. */
GLIM_API bool glim_set_crop(struct glim *g, int x, int y, int width, int height,
                            struct glim_error *err);

/* Light that was reflected more often is lost. -1: no limit. */
GLIM_API bool glim_set_max_bounces(struct glim *g, int count,
                                   struct glim_error *err);

/* Other random numbers: pictures of different seeds have independent noise. */
GLIM_API void glim_set_seed(struct glim *g, uint32_t seed);

/* Threads of the CPU, which change no bit of a picture; 0: all that the process
 * may use. */
GLIM_API bool glim_set_threads(struct glim *g, int count,
                               struct glim_error *err);

/* What renders: at first the CPU. A device of OpenCL is tried by a copy of the
 * glim program before it is used here, which takes seconds: drivers crash.
 * `device` is its number or a part of its name, NULL: the best one. If this
 * fails, the CPU renders. */
GLIM_API bool glim_set_backend(struct glim *g, enum glim_backend backend,
                               const char *device, struct glim_error *err);

/* The glim program that tries devices; NULL: the installed one. */
GLIM_API bool glim_set_program(struct glim *g, const char *path,
                               struct glim_error *err);

/* What the driver or its compiler said at the last glim_set_backend(), in
 * lines; NULL: nothing. */
GLIM_API const char *glim_backend_log(const struct glim *g);

/* ---- the picture ---- */

/* Is called by glim_render() from its thread, ten times a second and at the
 * end. False: stop. It may read the picture. */
typedef bool glim_progress_fn(void *context, const struct glim_progress *p);

/* Renders until every pixel has `spp` samples, or so many seconds have passed;
 * 0: no such limit. Blocks until then. Goes on with the picture that it has
 * rendered before if no setting has changed since. `progress` may be NULL. */
GLIM_API enum glim_result glim_render(struct glim *g, uint64_t spp,
                                      double seconds,
                                      glim_progress_fn *progress, void *context,
                                      struct glim_error *err);

/* Stops glim_render(), or the next one if none runs. From any thread, and from
 * a handler of a signal. */
GLIM_API void glim_cancel(struct glim *g);

/* How far the picture is. */
GLIM_API struct glim_progress glim_get_progress(struct glim *g);

/* Size of the picture that glim_render() has made, 0 before. */
GLIM_API void glim_get_picture_size(const struct glim *g, int *width,
                                    int *height);

/* Linear radiance: 3 floats a pixel, red first; so many as the size says.
 * False: nothing was rendered yet, or `count` is another number. */
GLIM_API bool glim_read_floats(struct glim *g, float *rgb, size_t count,
                               struct glim_error *err);

/* The same as sRGB with the exposure and the tone curve of the view: 3 bytes a
 * pixel. */
GLIM_API bool glim_read_bytes(struct glim *g, uint8_t *rgb, size_t count,
                              struct glim_error *err);

/* Writes the picture: .png as glim_read_bytes(), .hdr and .pfm as
 * glim_read_floats(), "-" a PNG file to standard output. The old file or the
 * new one is there, never a part of it. */
GLIM_API bool glim_save(struct glim *g, const char *path,
                        struct glim_error *err);

/* Writes STEM.png, or STEM-2.png, STEM-3.png, ...: the first name that is free,
 * which it returns until the next call. NULL: failed. */
GLIM_API const char *glim_save_new(struct glim *g, const char *stem,
                                   struct glim_error *err);

#ifdef __cplusplus
}
#endif

#endif
