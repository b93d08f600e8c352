// SPDX-License-Identifier: MIT
/*
 * material_ball.h - a ball of a material, path traced in a small studio
 *
 * The studio is a checkered floor under a sky with two bright areas. The
 * kernel of the CPU computes its samples, with the textures of the scene.
 *
 * Units:     the ball has the extent 1; lengths of the material are taken as
 *            normalised units of the scene
 * Ownership: material_ball_free() frees; a zeroed struct has no studio yet
 * Threads:   one
 * Errors:    memory
 */
#ifndef GLIM_MATERIAL_BALL_H
#define GLIM_MATERIAL_BALL_H

#include "image/frame.h"
#include "render/cpu_kernel.h"
#include "world/bvh/bvh8.h"
#include "world/light/sky_table.h"

/* Width and height of the picture. */
#define BALL_PIXELS 24

/* Samples of each pixel after which the picture is finished. */
#define BALL_SPP 64

#define BALL_MATERIALS 3

struct material_ball {
    const struct cpu_kernel *kernel; /* NULL: there is no studio yet */
    struct world studio;
    struct bvh8 tree;
    struct sky_table sky_table;
    struct ball_arrays *arrays; /* the world's */
    struct material materials[BALL_MATERIALS];
    uint64_t textures; /* version of the textures that the picture shows */
    uint32_t spp;
    struct vec3 sums[BALL_PIXELS * BALL_PIXELS];
};

/* Adds some samples of a material to the picture, in a few milliseconds. The
 * first ones after a change begin it anew. `world` has the textures, and
 * `textures` is their version. *is_new tells if the picture should be shown
 * again, as a draft or finished. */
bool material_ball_add(struct material_ball *ball, const struct world *world,
                       uint64_t textures, const struct material *material,
                       bool *is_new, struct error *err);

/* Returns true if all samples are there. */
bool material_ball_is_done(const struct material_ball *ball);

/* Fills a frame of BALL_PIXELS x BALL_PIXELS pixels. */
void material_ball_paint(const struct material_ball *ball, struct frame *frame);

void material_ball_free(struct material_ball *ball);

#endif
