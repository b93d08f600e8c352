// SPDX-License-Identifier: MIT
/*
 * path_state.h - a path between two vertices: its ray, throughput and random
 * numbers
 *
 * Units:   normalised scene units, radiance
 */
#ifndef KERNELS_PATH_STATE_H
#define KERNELS_PATH_STATE_H

#include "kernels/first_surface.h"
#include "kernels/guide.h"
#include "kernels/light.h"
#include "kernels/path_types.h"
#include "kernels/rng.h"
#include "kernels/segment.h"

/* Number of vertices of a path whose random numbers are computed together if
 * there are vectors of eight, else each is computed when it is used. If those
 * of one vertex of many paths are instead, a picture takes 1 to 9 % more time.
 */
#define VERTICES_AHEAD 2u

/* Light sample of a vertex: its radiance at the pixel if the shadow ray, which
 * ends at triangle `tri`, is not occluded. */
struct path_light {
    struct ray shadow;
    struct vec3 radiance;
    uint32_t tri; /* NO_INDEX: none; the light is not a triangle */
    bool is_lit;  /* there is a sample, whose shadow ray is to be traced */
};

/* A walk below a surface: subsurface.h. */
struct subsurface_walk {
    struct medium medium;
    uint32_t material;
    uint32_t steps; /* 0: there is none */
    float reach; /* distance to the next collision, if no surface is nearer */
};

/* State of a path between two vertices. */
struct path {
    struct ray ray;
    struct sampler sampler;
    uint32_t vertex; /* number of the next vertex; the first has 1 */
    /* x, then y of the points of VERTICES_AHEAD vertices */
    float numbers[2][VERTICES_AHEAD * DIMENSION_KINDS];
    struct vec3 beta; /* throughput for Russian roulette */
    float scale;      /* factor of the throughput that roulette ignores */
    float pdf;        /* density of the ray's direction; 0 for the camera and
                         delta lobes, with which light samples do not compete */
    struct receiver from;    /* vertex that the ray left, if pdf is above 0 */
    struct guide_cell cell;  /* tables of the path guide at that vertex */
    struct path_light light; /* light sample of the last vertex */
    struct path_sample out;
    struct first_surface surface;
    struct cell_estimates *estimates; /* NULL: none; FEATURE_RADIANCE_CELLS */
    uint32_t half_number; /* as in struct camera_sample; of these two: */
    /* FEATURE_LIGHT_PATHS: */
    bool drops;    /* light paths bring light of lamps to surfaces that cast */
    bool is_chain; /* all vertices so far cast */
    bool casts;    /* the last one does */
    float wavelength;   /* in nanometres; 0: none yet. FEATURE_DISPERSION */
    struct media media; /* where the ray is; FEATURE_ATTENUATION */
    /* FEATURE_MEDIA: */
    struct media light_media; /* where the shadow ray begins */
    uint32_t crossings;       /* of boundaries since that vertex */
    struct segment segment;   /* on which the last vertex is */
    struct vec3 along;    /* light that media scatter before the first vertex */
    uint32_t smoke_steps; /* tentative collisions in smokes. FEATURE_GRIDS */
    struct subsurface_walk below; /* FEATURE_SUBSURFACE */
};

/* Caps a factor at the largest float, because an infinite factor times a black
 * channel is NaN. NaN stays NaN, and the film counts it. */
static inline float f_finite(float x)
{
    return f_min(FLOAT_MAX, x);
}

/* Weights incoming radiance by the path throughput. */
static inline struct vec3 path_part(const struct path *p, struct vec3 radiance,
                                    float weight)
{
    return v3_mul(v3_scale(p->beta, f_finite(p->scale * weight)), radiance);
}

/* Returns two random numbers of a vertex. Vertices are counted from 1. `kind`
 * is a dimension counted from DIMENSION_BOUNCE in enum dimension. */
static inline struct vec2 vertex_2d(struct sampler s, uint32_t vertex,
                                    uint32_t kind)
{
    return random_2d(s, vertex * DIMENSION_STRIDE + kind);
}

#if HAS_WIDE_VECTORS
/* Computes all random numbers of VERTICES_AHEAD vertices. */
static inline void
vertices_2d(struct sampler s, uint32_t vertex,
            float numbers[2][VERTICES_AHEAD * DIMENSION_KINDS])
{
    const u32x8 vertices = {0, 0, 0, 0, 1, 1, 1, 1};
    const u32x8 kinds = {0, 1, 2, 3, 0, 1, 2, 3};
    u32x8 dimensions = (vertex + vertices) * DIMENSION_STRIDE + kinds;
    u32x8 indices = s.reversed_index + 0 * kinds;
    struct bits2_8 p =
        sobol_point_8(indices, dimension_key_8(s.key, dimensions));

    f32x8_store(numbers[0], unit_float_8(p.x));
    f32x8_store(numbers[1], unit_float_8(p.y));
}
#endif

/* Computes random numbers ahead. Call it before the first path_2d() of a
 * vertex. */
static inline void path_prepare_2d(struct path *p)
{
#if HAS_WIDE_VECTORS
    if ((p->vertex - 1) % VERTICES_AHEAD == 0)
        vertices_2d(p->sampler, p->vertex, p->numbers);
#else
    (void)p;
#endif
}

/* Returns two random numbers of the path's next vertex. */
static inline struct vec2 path_2d(const struct path *p, uint32_t kind)
{
    uint32_t at = (p->vertex - 1) % VERTICES_AHEAD * DIMENSION_KINDS + kind;

    return HAS_WIDE_VECTORS ? v2(p->numbers[0][at], p->numbers[1][at])
                            : vertex_2d(p->sampler, p->vertex, kind);
}

static inline void path_add(struct path *p, struct vec3 radiance, float weight)
{
    p->out.radiance = v3_add(p->out.radiance, path_part(p, radiance, weight));
}

#endif
