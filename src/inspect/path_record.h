// SPDX-License-Identifier: MIT
/*
 * path_record.h - one sample step by step: where its path went and what it
 * gathered; and which directions a surface would have sent it
 *
 * The steps are path_extend()'s: the radiance at the end is path_trace()'s,
 * bit for bit.
 *
 * Units:     normalised scene units, radiance, densities per solid angle
 * Threads:   any
 */
#ifndef GLIM_PATH_RECORD_H
#define GLIM_PATH_RECORD_H

#include <stdbool.h>

#include "kernels/types.h"

#define PATH_RECORD_STEPS 32
#define PATH_RECORD_LOBES 64

enum path_record_way {
    PATH_RECORD_SKY,      /* the ray has met nothing */
    PATH_RECORD_ENDED,    /* absorbed, or the last vertex that may be */
    PATH_RECORD_ROULETTE, /* ended by chance */
    PATH_RECORD_REFLECTED,
    PATH_RECORD_TRANSMITTED
};

/* A ray and what came of it. */
struct path_record_step {
    struct vec3 from, to;
    struct hit hit;         /* no triangle: the sky */
    struct vec3 throughput; /* of the path before it */
    struct vec3 light;      /* in the pixel, gathered at the end of the ray */
    enum path_record_way way;
    float pdf; /* of the direction in which it goes on; 0: the only one */
};

struct path_record {
    struct path_record_step steps[PATH_RECORD_STEPS];
    int count; /* of the steps that are kept: the first */
    int vertices;
    struct vec3 radiance;
};

/* Sample `index` of pixel (x, y) in a world that has nodes. */
void path_record_follow(struct path_record *t, const struct world *world,
                        uint32_t x, uint32_t y, uint64_t index);

/* The frame of the surface where the middle of a pixel is seen, and directions
 * in which samples of light from the eye would go on. */
struct path_record_lobes {
    struct vec3 p, n, t, b; /* in the scene */
    struct vec3 wo;
    float distance; /* from the eye */
    uint32_t tri;
    int count; /* some samples end instead */
    struct vec3 wi[PATH_RECORD_LOBES];
    struct vec3 weight[PATH_RECORD_LOBES]; /* f |cosine| / pdf */
    float pdf[PATH_RECORD_LOBES];          /* 0: a delta */
};

/* False: there is only the sky. */
bool path_record_scatter(struct path_record_lobes *l, const struct world *world,
                         uint32_t x, uint32_t y);

#endif
