// SPDX-License-Identifier: MIT
/*
 * path_stream.h - samples of pixels, many paths at a time
 *
 * All paths of a stream are extended by a vertex, then all their shadow rays
 * are traced, then all their rays: 3 % less time than one path after the other,
 * 7 % less under an image of the sky. The samples have the same bits.
 *
 * The ray queries are those of kernels/path.h, and this, which finds the hits
 * of rays that go much the same way:
 *     void hits_closest(const struct world *, const struct ray *,
 *                       uint32_t count, struct hit *);
 *
 * Units:     as kernels/path.h
 * Threads:   any, on one world
 */
#ifndef GLIM_PATH_STREAM_H
#define GLIM_PATH_STREAM_H

#include "base/min_max.h"
#include "base/thread_pool.h"
#include "kernels/path.h"
#include "render/cpu_kernel.h"

/* Paths, with the hits of their rays. */
struct path_stream {
    struct ray camera[SAMPLE_STREAM];
    struct path paths[SAMPLE_STREAM];
    struct hit hits[SAMPLE_STREAM];
};

/* Makes the samplers of some samples, and their points within the pixel. */
VECTORISED static void path_points(const struct settings *s,
                                   const struct sample_id *places,
                                   uint32_t count, struct sampler *samplers,
                                   struct vec2 *points)
{
    for (uint32_t i = 0; i < count; i++)
        samplers[i] =
            camera_sampler(s, places[i].x, places[i].y, places[i].index);
    for (uint32_t i = 0; i < count; i++)
        points[i] = random_2d(samplers[i], DIMENSION_PIXEL);
}

/* Traces the shadow rays of the listed paths. */
static __attribute__((noinline, flatten)) void
stream_add_light(const struct world *w, struct path_stream *s,
                 const uint8_t *list, uint32_t count)
{
    for (uint32_t k = 0; k < count; k++)
        path_add_light(w, &s->paths[list[k]]);
}

/* Traces the rays of the listed paths, one after the other: in turns, of two to
 * eight rays, they take 1 to 10 % more time, in 4 M triangles as well. */
static __attribute__((noinline, flatten)) void
stream_intersect(const struct world *w, struct path_stream *s,
                 const uint8_t *list, uint32_t count)
{
    for (uint32_t k = 0; k < count; k++)
        hit_closest(w, s->paths[list[k]].ray, &s->hits[list[k]]);
}

/* Traces all paths to their ends, a vertex of all at a time. Walks below
 * surfaces have up to SUBSURFACE_STEPS_MAX steps: returns false if they are
 * halted. cancel: NULL without them. */
static inline bool stream_trace(const struct world *w, struct path_stream *s,
                                uint32_t count, const struct cancel *cancel)
{
    uint8_t list[SAMPLE_STREAM], lit[SAMPLE_STREAM];

    for (uint32_t k = 0; k < count; k++)
        list[k] = (uint8_t)k;
    while (count > 0) {
        uint32_t left = 0, lit_count = 0;

        if (HAS(FEATURE_SUBSURFACE) && cancel != NULL &&
            cancel_requested_at_once(cancel))
            return false;
        for (uint32_t k = 0; k < count; k++) {
            uint8_t i = list[k];
            bool goes_on = path_extend(w, &s->paths[i], &s->hits[i]);

            if (s->paths[i].light.is_lit)
                lit[lit_count++] = i;
            if (goes_on)
                list[left++] = i;
        }
        stream_add_light(w, s, lit, lit_count);
        stream_intersect(w, s, list, left);
        count = left;
    }
    return true;
}

/* Computes at most SAMPLE_STREAM samples, their first surfaces if the world's
 * samples have some, and estimates for radiance cells if the options have room
 * for them. Samples of one pixel, or of neighbours, take less time together.
 * Returns false if they are halted, and incomplete. */
static inline bool path_samples(const struct world *w,
                                const struct sample_id *places, uint32_t count,
                                struct path_sample *out,
                                struct first_surface *surfaces,
                                const struct sample_options *options)
{
    const struct sample_options none = {NULL, NULL};
    struct sampler samplers[SAMPLE_STREAM];
    struct vec2 points[SAMPLE_STREAM];
    struct path_stream s;
    bool has_walks = HAS(FEATURE_SUBSURFACE) &&
                     (w->settings.features & FEATURE_SUBSURFACE) != 0;

    if (options == NULL)
        options = &none;
    path_points(&w->settings, places, count, samplers, points);
    for (uint32_t i = 0; i < count; i++) {
        s.camera[i] = camera_sample_ray(&w->settings, places[i].x, places[i].y,
                                        points[i], samplers[i]);
        path_set_key(w, samplers[i], 1, &s.camera[i]);
    }
    for (uint32_t i = 0; i < count; i += SAMPLE_BLOCK)
        hits_closest(w, s.camera + i, u32_min(count - i, SAMPLE_BLOCK),
                     s.hits + i);
    if (samples_are_aovs(w)) {
        for (uint32_t i = 0; i < count; i++)
            out[i] = aov_sample(w, s.camera[i], s.hits[i]);
        return true;
    }
    for (uint32_t i = 0; i < count; i++) {
        struct camera_sample start = {s.camera[i], samplers[i],
                                      (uint32_t)places[i].index & 1u};

        path_open(w, &s.paths[i], start,
                  options->estimates != NULL ? options->estimates + i : NULL);
    }
    if (!stream_trace(w, &s, count, has_walks ? options->cancel : NULL))
        return false;
    for (uint32_t i = 0; i < count; i++)
        out[i] = path_close(w, &s.paths[i], s.camera[i], surfaces + i);
    return true;
}

#endif
