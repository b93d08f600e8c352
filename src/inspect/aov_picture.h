// SPDX-License-Identifier: MIT
/*
 * aov_picture.h - pictures of the first hit: normals, depth, materials
 *
 * Units:     as in enum sample_kind
 * Threads:   one at a time; workers of the pool trace the rays
 */
#ifndef GLIM_AOV_PICTURE_H
#define GLIM_AOV_PICTURE_H

#include "base/thread_pool.h"
#include "scene/scene.h"
#include "session/command_line.h"
#include "world/bvh/bvh8.h"

/* Fills 3 numbers for each pixel: the sample kind in the world's settings,
 * which must not be light, at the first hit of the ray through the pixel's
 * centre. The camera has width x height pixels. Blocks. */
void aov_of_pixels(struct pool *pool, const struct world *world, int width,
                   int height, float *numbers);

/* A picture of the first surfaces that the camera sees. */
struct aov_picture {
    enum aov_kind kind;
    const struct scene *scene;
    const struct world *world; /* for the whole picture */
    struct rect crop;
};

/* Rays of a pixel whose mean is an albedo or a normal. */
#define AOV_SAMPLES 16

/* Fills 3 numbers for each pixel of the crop, 0 where a ray meets nothing.
 * Albedos and normals are means over the first AOV_SAMPLES camera rays of the
 * pixel's samples, so that edges and blur are those of the picture. All other
 * kinds are those of the ray of a pinhole through the middle of the pixel,
 * since a mean of two places or numbers is a third one. Blocks. */
void aov_picture_render(const struct aov_picture *picture, struct pool *pool,
                        float *numbers);

#endif
