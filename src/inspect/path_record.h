// SPDX-License-Identifier: MIT
/*
 * path_record.h - follows one sample step by step, and the directions of
 * scattering at a surface
 *
 * The steps are those of path_extend(), and the final radiance has the same
 * bits as that of path_trace().
 *
 * Units:     normalised scene units, radiance, densities per solid angle
 * Threads:   any
 */
#ifndef GLIM_PATH_RECORD_H
#define GLIM_PATH_RECORD_H

#include <stdbool.h>

#include "kernels/path_types.h"

#define PATH_RECORD_STEPS 32
#define PATH_RECORD_LOBES 64

enum path_record_way {
    PATH_RECORD_SKY,       /* the ray hit nothing */
    PATH_RECORD_ENDED,     /* absorbed */
    PATH_RECORD_LIMIT,     /* the limit of bounces, or of steps of a walk */
    PATH_RECORD_CELL,      /* ended at a radiance cell */
    PATH_RECORD_ROULETTE,  /* ended by Russian roulette */
    PATH_RECORD_SCATTERED, /* in a medium, or below a surface */
    PATH_RECORD_REFLECTED,
    PATH_RECORD_TRANSMITTED
};

/* Ray and the event at its end. */
struct path_record_step {
    struct vec3 from, to;
    struct hit hit;         /* no triangle: the sky, or a collision */
    struct vec3 n;          /* shading normal, if there is a triangle */
    struct vec3 throughput; /* of the path up to this step */
    struct vec3 light;      /* added to the pixel at the end of the ray, */
    struct vec3 sampled;    /* and the part of it by the light sample there */
    enum path_record_way way;
    float pdf; /* density of the next direction; 0 for a delta distribution */
    float wavelength; /* in nanometres, after this step; 0: none */
    uint32_t medium; /* material of the body in which the ray is, or NO_INDEX */
    bool is_boundary; /* the surface is only where a medium begins */
    bool enters;     /* a walk below the surface begins at the end of the ray */
    bool is_below;   /* the ray is one of such a walk */
    bool is_diffuse; /* the surface has no lobe but diffuse ones */
};

struct path_record {
    struct path_record_step steps[PATH_RECORD_STEPS];
    int count; /* recorded steps: the first of the path */
    int vertices;
    struct vec3 radiance;
};

/* Follows a sample in a world with a tree, calls `visit` for each step, and
 * returns the radiance. The light that light paths bring to the pixel by itself
 * is not that of its paths: light_block.h. */
typedef void path_record_visit(void *context,
                               const struct path_record_step *step);
struct vec3 path_record_each(const struct world *world, struct sample_id id,
                             path_record_visit *visit, void *context);

/* Records the first steps of sample `index` of pixel (x, y). */
void path_record_follow(struct path_record *t, const struct world *world,
                        uint32_t x, uint32_t y, uint64_t index);

/* Surface at the centre of a pixel: its frame, and sampled directions of
 * scattering for light from the eye. */
struct path_record_lobes {
    struct vec3 p, n, t, b; /* in scene units */
    struct vec3 wo;
    float distance; /* from the eye */
    uint32_t tri;
    int count; /* samples that were not absorbed */
    struct vec3 wi[PATH_RECORD_LOBES];
    struct vec3 weight[PATH_RECORD_LOBES]; /* f |cosine| / pdf */
    float pdf[PATH_RECORD_LOBES];          /* 0 for a delta distribution */
};

/* Samples the directions. Returns false if the pixel shows the sky. */
bool path_record_scatter(struct path_record_lobes *l, const struct world *world,
                         uint32_t x, uint32_t y);

#endif
