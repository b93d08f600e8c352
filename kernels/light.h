// SPDX-License-Identifier: MIT
/*
 * light.h - what shines: emissive surfaces and the sky, and directions to them
 *
 * light_sample() draws a direction from a receiver to a light, for next-event
 * estimation; light_pdf_at() and sky_light_terms() have its density at what a
 * ray has met by chance, to weigh both (Veach 1997, 9.2). Densities of a sample
 * and of the same point met by chance are the same bits.
 *
 * Units:     normalised scene units, radiance, densities per solid angle
 */
#ifndef KERNELS_LIGHT_H
#define KERNELS_LIGHT_H

#include "kernels/guide.h"
#include "kernels/hit.h"
#include "kernels/light_tree.h"
#include "kernels/sample.h"
#include "kernels/sky.h"
#include "kernels/texture.h"

struct light_sample {
    struct vec3 wi;       /* unit, from the receiver */
    struct vec3 radiance; /* that comes along it if nothing is in the way */
    float pdf;            /* of wi per solid angle; above 0 and finite */
    uint32_t tri;         /* NO_INDEX: the sky */
    struct vec3 p;        /* on the triangle */
};

/* True if a material emits light. One that is invisible emits none. */
static inline bool material_shines(const struct material *m)
{
    return (m->emission.x > 0.0f || m->emission.y > 0.0f ||
            m->emission.z > 0.0f) &&
           m->opacity > 0.0f;
}

/* Emitted radiance of a material at uv, the same to both sides. */
static inline struct vec3 emission_at(const struct world *w,
                                      const struct material *m, struct vec2 uv,
                                      bool has_uv)
{
    if (!HAS(FEATURE_TEXTURES) || m->emission_texture == NO_INDEX || !has_uv)
        return m->emission;
    return v3_mul(m->emission, texture_at(w, m->emission_texture, uv).color);
}

/* Density per solid angle, seen from the receiver, of a point of a light:
 * distance^2 / cosine times its density per area; to_point leads there, and
 * `part` is the triangle that it is on. 0 where it is not finite: such points
 * are not sampled. */
static inline float light_point_pdf(const struct world *w, uint32_t light,
                                    uint32_t part, struct vec3 to_point)
{
    float square = v3_dot(to_point, to_point);
    float pdf = 2.0f * square * sqrtf(square) /
                fabsf(v3_dot(to_point, w->lights[light].scaled_normals[part]));

    return pdf <= FLOAT_MAX ? pdf : 0.0f;
}

/* Uniform barycentrics that keep stratified numbers stratified (Heitz 2019,
 * "A low-distortion map between triangle and square"). */
static inline struct hit triangle_point(struct vec2 u)
{
    struct hit h = {0.0f, 0.0f, 0.0f, 0.0f, NO_INDEX};
    float less = 0.5f * f_min(u.x, u.y);

    h.b0 = u.x - less;
    h.b1 = u.y - less;
    h.b2 = f_max(1.0f - h.b0 - h.b1, 0.0f);
    return h;
}

/* The same of two triangles that share a side: those of a parallelogram on
 * either side of a diagonal. Both keep u.x and u.y for their second and third
 * corners, the other one turned by half a turn. */
static inline struct hit pair_point(struct vec2 u, uint32_t *part)
{
    struct hit h = {0.0f, 0.0f, 0.0f, 0.0f, NO_INDEX};
    float turn;

    /* without a branch, which would be wrong every other time */
    *part = (uint32_t)(u.x + u.y > 1.0f);
    turn = (float)*part;
    h.b1 = fabsf(turn - u.x);
    h.b2 = fabsf(turn - u.y);
    h.b0 = f_max(1.0f - h.b1 - h.b2, 0.0f);
    return h;
}

/* The same place by the mesh's order of the corners. */
static inline struct hit hit_rotated(struct hit h, uint32_t turn)
{
    const float b[5] = {h.b0, h.b1, h.b2, h.b0, h.b1};

    h.b0 = b[turn];
    h.b1 = b[turn + 1];
    h.b2 = b[turn + 2];
    return h;
}

/* Emitted radiance of a light at a hit on it. */
static inline struct vec3 light_radiance(const struct world *w, uint32_t light,
                                         struct hit h)
{
    struct vec3 radiance = w->lights[light].emission;
    uint32_t texture = w->lights[light].texture;

    if (HAS(FEATURE_TEXTURES) && texture != NO_INDEX)
        radiance =
            v3_mul(radiance,
                   texture_at(w, texture, uv_at(w, w->tris[h.tri], h)).color);
    if (has_coverage(w))
        radiance = v3_scale(radiance, coverage_at(w, h));
    return radiance;
}

static inline bool sample_surface(const struct world *w,
                                  const struct receiver *r, struct vec2 point,
                                  struct vec2 choice, struct light_sample *s)
{
    uint32_t light, part = 0;
    float probability =
        w->settings.light_share * light_tree_sample(w, r, choice, &light);
    struct vec3 p_error, to_point;
    struct hit h;

    if (!(probability > 0.0f))
        return false;
    h = w->lights[light].tris[1] == NO_INDEX ? triangle_point(point)
                                             : pair_point(point, &part);
    s->tri = h.tri = w->lights[light].tris[part];
    s->p = hit_point(h, w->lights[light].corners[2 * part],
                     w->lights[light].corners[1 + 2 * part],
                     w->lights[light].corners[3 - 2 * part], &p_error);
    to_point = v3_sub(s->p, r->p);
    s->pdf = probability * light_point_pdf(w, light, part, to_point);
    if (!(s->pdf > 0.0f))
        return false;
    s->wi = v3_unit(to_point);
    s->radiance =
        light_radiance(w, light,
                       hit_rotated(h, w->lights[light].rotation[part]));
    return true;
}

/* The light that a triangle is, or is a part of; NO_INDEX: none. */
static inline uint32_t light_of(const struct world *w, uint32_t tri)
{
    return w->settings.light_count > 0 ? w->tri_lights[tri] : NO_INDEX;
}

/* Density of light_sample() at point p of a triangle that a ray from the
 * receiver has met. */
static inline float light_pdf_at(const struct world *w,
                                 const struct receiver *r, uint32_t tri,
                                 struct vec3 p)
{
    uint32_t light = light_of(w, tri);
    uint32_t part;

    if (light == NO_INDEX)
        return 0.0f;
    part = w->lights[light].tris[1] == tri ? 1u : 0u;
    return w->settings.light_share * light_tree_pmf(w, r, light) *
           light_point_pdf(w, light, part, v3_sub(p, r->p));
}

static inline float sky_cosine_pdf(const struct receiver *r, struct vec3 wi)
{
    return f_max(v3_dot(wi, r->n), 0.0f) * (1.0f / PI);
}

/* Radiance of the sky in direction wi, a unit vector, and the density of
 * light_sample() there. Without a table the sky is drawn by the cosine at the
 * receiver: another look at what is open beside the path's own. `first` is the
 * receiver's table of the guide, which is asked as well, or NO_INDEX. */
static inline struct vec3 sky_light_terms(const struct world *w,
                                          const struct receiver *r,
                                          uint32_t first, struct vec3 wi,
                                          float *pdf)
{
    struct vec3 radiance;

    if (sky_has_table(w)) {
        radiance = sky_terms(w, wi, pdf);
    } else {
        radiance = sky_radiance(w, wi);
        *pdf = sky_cosine_pdf(r, wi);
    }
    if (HAS(FEATURE_GUIDE) && first != NO_INDEX)
        *pdf = guide_mixed_pdf(w, first, wi, *pdf);
    *pdf *= w->settings.sky_share;
    return radiance;
}

/* A direction to the sky. */
static inline struct vec3 sky_direction(const struct world *w,
                                        const struct receiver *r,
                                        uint32_t first, struct vec2 u)
{
    if (HAS(FEATURE_GUIDE) && first != NO_INDEX) {
        float share = guide_share(w, first);

        if (u.x < share)
            return guide_sample(w, first, u);
        u = guide_remap(u, share);
    }
    return sky_has_table(w) ? sky_sample(w, u) : cosine_around(r->n, u);
}

/* A direction towards a light; false if there is none to sample here, or by
 * choice.x not this time. `first` is the receiver's table of the guide, or
 * NO_INDEX. Whether it is above the surface and free is for the caller to find.
 */
static inline bool light_sample(const struct world *w, const struct receiver *r,
                                uint32_t first, struct vec2 point,
                                struct vec2 choice, struct light_sample *s)
{
    if (choice.x < w->settings.sky_share) {
        s->wi = sky_direction(w, r, first, point);
        s->radiance = sky_light_terms(w, r, first, s->wi, &s->pdf);
        s->tri = NO_INDEX;
        s->p = r->p;
        return s->pdf > 0.0f;
    }
    /* a division that most scenes do without */
    if (w->settings.light_share != 1.0f)
        choice.x = (choice.x - w->settings.sky_share) / w->settings.light_share;
    if (!(choice.x < 1.0f))
        return false;
    return sample_surface(w, r, point, choice, s);
}

#endif
