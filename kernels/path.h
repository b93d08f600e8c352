// SPDX-License-Identifier: MIT
/*
 * path.h - one sample of a pixel: a path from the eye
 *
 * The estimator of Kajiya 1986 with throughput roulette. Whoever includes
 * this file supplies
 *     bool hit_closest(const struct world *, struct ray, struct hit *);
 * first: traverse.h, or a faster one that finds the same hits.
 *
 * Units:     normalised scene units, radiance
 * Ownership: none
 * Threads:   path_samples() from any, on one world
 * Errors:    none: what cannot be computed is black
 */
#ifndef KERNELS_PATH_H
#define KERNELS_PATH_H

#include "kernels/bsdf.h"
#include "kernels/bump.h"
#include "kernels/camera.h"
#include "kernels/hit.h"
#include "kernels/light.h"
#include "kernels/path_types.h"
#include "kernels/rng.h"

/* Paths without a limit of their own end here, counted. */
#define PATH_HARD_STOP 1000u

/* A hit with all that shading needs. */
struct vertex {
    struct vec3 p;
    struct vec3 p_error;
    struct vec3 ng; /* unit, on the eye's side */
    struct vec3 n;  /* unit shading normal, wo.n > 0 */
    struct vec2 uv;
    bool has_uv;
    bool is_outside; /* the eye is on the side of the file's normal */
};

static inline struct vec3 shading_normal(const struct world *w, struct tri t,
                                         struct hit h, struct vec3 ng,
                                         struct vec3 wo)
{
    struct vec3 n;
    float length;

    if (t.vn[0] == NO_INDEX)
        return ng;
    n = v3_add(v3_add(v3_scale(w->normals[t.vn[0]], h.b0),
                      v3_scale(w->normals[t.vn[1]], h.b1)),
               v3_scale(w->normals[t.vn[2]], h.b2));
    length = v3_length(n);
    if (!(length > 1e-6f))
        return ng;
    n = v3_scale(n, 1.0f / length);
    /* exporters write normals and winding that disagree: go by the face */
    if (v3_dot(n, ng) < 0.0f)
        n = v3_neg(n);
    return v3_dot(n, wo) > 0.0f ? n : ng;
}

static inline bool vertex_at(const struct world *w, struct ray r, struct hit h,
                             struct vertex *v)
{
    struct tri t = w->tris[h.tri];
    struct vec3 p0 = w->positions[t.v[0]];
    struct vec3 p1 = w->positions[t.v[1]];
    struct vec3 p2 = w->positions[t.v[2]];
    struct vec3 wo = v3_neg(r.d);

    if (!triangle_normal(p0, p1, p2, &v->ng))
        return false;
    v->is_outside = v3_dot(v->ng, wo) > 0.0f;
    if (!v->is_outside)
        v->ng = v3_neg(v->ng);
    v->n = shading_normal(w, t, h, v->ng, wo);
    v->p = hit_point(h, p0, p1, p2, &v->p_error);
    v->has_uv = t.vt[0] != NO_INDEX;
    v->uv = v2(0.0f, 0.0f);
    if (v->has_uv) {
        struct vec2 a = w->uvs[t.vt[0]];
        struct vec2 b = w->uvs[t.vt[1]];
        struct vec2 c = w->uvs[t.vt[2]];

        v->uv = v2(h.b0 * a.x + h.b1 * b.x + h.b2 * c.x,
                   h.b0 * a.y + h.b1 * b.y + h.b2 * c.y);
    }
    return true;
}

static inline struct bsdf
bsdf_at(const struct world *w, const struct material *m, const struct vertex *v)
{
    struct bsdf b;

    b.color = m->color;
    if (m->color_texture != NO_INDEX && v->has_uv)
        b.color = v3_mul(b.color, texture_at(w, m->color_texture, v->uv).color);
    b.coat = m->coat;
    if (m->coat_texture != NO_INDEX && v->has_uv)
        b.coat = v3_mul(b.coat, texture_at(w, m->coat_texture, v->uv).color);
    b.alpha = m->alpha;
    if (m->alpha_texture != NO_INDEX && v->has_uv) {
        float roughness = texture_at(w, m->alpha_texture, v->uv).alpha;

        b.alpha *= roughness * roughness;
    }
    b.kind = m->kind;
    if (m->metal_texture != NO_INDEX && v->has_uv &&
        m->metalness * texture_at(w, m->metal_texture, v->uv).alpha >= 0.5f)
        b.kind = MATERIAL_METAL;
    b.eta = m->ior;
    if (m->kind == MATERIAL_GLASS && !v->is_outside)
        b.eta = 1.0f / m->ior;
    return b;
}

/* Draws where the path goes on. False if it ends here. */
static inline bool scatter(const struct bsdf *b, const struct vertex *v,
                           struct vec2 direction, float choice, struct ray *r,
                           struct bsdf_sample *s)
{
    struct vec3 t, bt, wo, wi;
    float side;

    if (bsdf_is_black(b))
        return false; /* lamps: no ray for nothing */
    frame_around(v->n, &t, &bt);
    wo = v3_neg(r->d);
    wo = v3(v3_dot(wo, t), v3_dot(wo, bt), v3_dot(wo, v->n));
    if (!bsdf_sample(b, wo, direction, choice, s))
        return false;
    wi = v3_add(v3_add(v3_scale(t, s->wi.x), v3_scale(bt, s->wi.y)),
                v3_scale(v->n, s->wi.z));
    wi = v3_unit(wi);
    side = v3_dot(wi, v->ng);
    /* a shading normal must not let light through the face, nor keep it in */
    if (s->wi.z > 0.0f ? !(side > 0.0f) : !(side < 0.0f))
        return false;
    r->o = leave_surface(v->p, v->p_error, side > 0.0f ? v->ng : v3_neg(v->ng));
    r->d = wi;
    return true;
}

/* One path; s is its random numbers. */
static inline struct path_sample path_trace(const struct world *w, struct ray r,
                                            struct sampler s)
{
    struct path_sample out = {{0.0f, 0.0f, 0.0f}, 0, 0};
    struct vec3 beta = {1.0f, 1.0f, 1.0f};
    float eta_scale = 1.0f; /* apart, so that roulette does not see it */

    for (uint32_t vertex = 1;; vertex++) {
        uint32_t dimension = DIMENSION_BOUNCE + (vertex - 1) * DIMENSION_STRIDE;
        struct hit h;
        struct vertex v;
        struct material m;
        struct bsdf b;
        struct bsdf_sample next;
        struct vec2 lobe;
        float q;

        r.key = ray_key(s, vertex);
        r.t_max = FLOAT_MAX;
        out.rays++;
        if (!hit_closest(w, r, &h)) {
            out.radiance =
                v3_add(out.radiance,
                       v3_mul(v3_scale(beta, eta_scale), sky_radiance(w, r.d)));
            break;
        }
        if (!vertex_at(w, r, h, &v))
            break;
        m = w->materials[w->tris[h.tri].material];
        if (has_bumps(&m) && v.has_uv)
            v.n = bumped_normal(w, &m, w->tris[h.tri], v.uv, v.n, v.ng,
                                v3_neg(r.d));
        if (!v3_is_zero(m.emission))
            out.radiance = v3_add(out.radiance,
                                  v3_mul(v3_scale(beta, eta_scale),
                                         emission_at(w, &m, v.uv, v.has_uv)));
        if (vertex >= w->max_vertices) {
            out.cut = vertex >= PATH_HARD_STOP ? 1u : 0u;
            break;
        }
        b = bsdf_at(w, &m, &v);
        lobe = random_2d(s, dimension + DIMENSION_BSDF_LOBE);
        if (!scatter(&b, &v, random_2d(s, dimension + DIMENSION_BSDF_DIRECTION),
                     lobe.x, &r, &next))
            break;
        beta = v3_mul(beta, next.weight);
        eta_scale *= next.eta_scale;
        q = sqrtf(v3_max(beta));
        if (vertex == 1) {
            if (!(q > 0.0f))
                break;
        } else if (q < 1.0f) {
            if (!(lobe.y < q))
                break;
            beta = v3_scale(beta, 1.0f / q);
        }
    }
    return out;
}

/* Samples first .. first + count - 1 of pixel (x, y); count is 1 to
 * SAMPLE_BLOCK. */
static inline void path_samples(const struct world *w, uint32_t x, uint32_t y,
                                uint64_t first, uint32_t count,
                                struct path_sample *out)
{
    for (uint32_t i = 0; i < count; i++) {
        struct sampler s = sampler_start(x, y, first + i, w->seed);
        struct vec2 offset = random_2d(s, DIMENSION_PIXEL);

        out[i] = path_trace(w, camera_ray(w->camera, x, y, offset), s);
    }
}

#endif
