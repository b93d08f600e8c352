// SPDX-License-Identifier: MIT
/*
 * bump.h - shading normals from bump and normal maps
 *
 * The tangents are those of the vertices, or the directions in which u and v
 * grow. A bent shading normal
 * may reflect the eye's direction to below the face, where surfaces are black.
 * Such normals are turned back until the reflection is just above the face (the
 * problem: Estevez, Lecocq and Stein 2019, "A microfacet-based shadowing
 * function to solve the bump terminator problem").
 *
 * Units:     unit vectors; heights of a bump map in texels
 * Errors:    where texture coordinates span no area the normal is not changed
 */
#ifndef KERNELS_BUMP_H
#define KERNELS_BUMP_H

#include "kernels/texture.h"

/* The texture coordinates of a hit, of both sets. */
struct uv_pair {
    struct vec2 first, second;
};

/* The pair's coordinates that a texture uses. */
static inline struct vec2 uv_for(const struct world *w, uint32_t texture,
                                 struct uv_pair uv)
{
    return uses_second_uvs(w, texture) ? uv.second : uv.first;
}

/* A hit whose shading normal maps bend. The triangle has texture coordinates
 * where they do. */
struct bump_place {
    struct tri t;
    uint32_t instance;
    struct hit h;
    struct uv_pair uv; /* at the hit */
    struct vec3 ng;    /* of the face, on the eye's side */
    struct vec3 wo;
};

/* Cosine to the face normal of a reflection that was turned back. */
#define BUMP_GRAZING 1e-3f

static inline bool has_bumps(GLOBAL const struct material *m)
{
    return m->normal_texture != NO_INDEX || m->bump_texture != NO_INDEX;
}

/* Unit tangents of the face, along which u and v of these texture coordinates
 * grow. Returns false where they span no area. */
static inline bool uv_tangents(const struct world *w,
                               GLOBAL const struct vec2 *uvs, struct tri t,
                               uint32_t instance, struct vec3 *along_u,
                               struct vec3 *along_v)
{
    struct vec3 p0 = position_at(w, t.v[0], instance);
    struct vec3 e1 = v3_sub(position_at(w, t.v[1], instance), p0);
    struct vec3 e2 = v3_sub(position_at(w, t.v[2], instance), p0);
    struct vec2 a = uvs[t.vt[0]];
    struct vec2 b = uvs[t.vt[1]];
    struct vec2 c = uvs[t.vt[2]];
    float du1 = b.x - a.x, dv1 = b.y - a.y;
    float du2 = c.x - a.x, dv2 = c.y - a.y;
    /* only the sign of the area in uv is used, as the area itself may be too
     * small to divide by */
    float sign = du1 * dv2 - du2 * dv1 < 0.0f ? -1.0f : 1.0f;
    float length_u, length_v;

    *along_u = v3_sub(v3_scale(e1, sign * dv2), v3_scale(e2, sign * dv1));
    *along_v = v3_sub(v3_scale(e2, sign * du1), v3_scale(e1, sign * du2));
    length_u = v3_length(*along_u);
    length_v = v3_length(*along_v);
    if (!(length_u > 1e-18f && length_v > 1e-18f))
        return false;
    *along_u = v3_scale(*along_u, 1.0f / length_u);
    *along_v = v3_scale(*along_v, 1.0f / length_v);
    return true;
}

/* Unit tangents at a hit from those of the vertices. n is the shading normal,
 * on any side. Returns false if the triangle has none. */
static inline bool vertex_tangents(const struct world *w,
                                   const struct bump_place *at, struct vec3 n,
                                   struct vec3 *along_u, struct vec3 *along_v)
{
    const float b[3] = {at->h.b0, at->h.b1, at->h.b2};
    struct vec3 up = v3(0.0f, 0.0f, 0.0f), u = up, v;
    float sign = 0.0f, length_u, length_v;

    if (at->t.vn[0] == NO_INDEX)
        return false;
    for (uint32_t i = 0; i < 3u; i++) {
        struct tangent tangent = tangent_at(w, at->t.vn[i], at->instance);

        up =
            v3_add(up, v3_scale(normal_at(w, at->t.vn[i], at->instance), b[i]));
        u = v3_add(u, v3_scale(tangent.d, b[i]));
        sign = tangent.sign;
    }
    v = v3_cross(n, u);
    length_u = v3_length(u);
    length_v = v3_length(v);
    if (!(length_u > 1e-6f && length_v > 1e-6f * length_u))
        return false;
    /* n may be turned to the eye, and the vertices' normals are not */
    sign *= minus_if(v3_dot(n, up) < 0.0f);
    *along_u = v3_scale(u, 1.0f / length_u);
    *along_v = v3_scale(v, sign / length_v);
    return true;
}

/* Unit tangents at a hit with shading normal n: of the vertices, else of the
 * face by these texture coordinates. Returns false if there are none. */
static inline bool tangents_at(const struct world *w,
                               GLOBAL const struct vec2 *uvs,
                               const struct bump_place *at, struct vec3 n,
                               struct vec3 *along_u, struct vec3 *along_v)
{
    if (HAS(FEATURE_TANGENTS) && w->settings.tangent_count > 0u &&
        vertex_tangents(w, at, n, along_u, along_v))
        return true;
    return uv_tangents(w, uvs, at->t, at->instance, along_u, along_v);
}

/* Slopes of the height map along u and v: central differences over one texel.
 */
static inline struct vec2 height_slopes(const struct world *w,
                                        GLOBAL const struct material *m,
                                        struct vec2 uv)
{
    struct texture t = w->textures[m->bump_texture];
    float x = 0.5f / ((float)t.width * t.scale.x);
    float y = 0.5f / ((float)t.height * t.scale.y);
    float right = texture_at(w, m->bump_texture, v2(uv.x + x, uv.y)).alpha;
    float left = texture_at(w, m->bump_texture, v2(uv.x - x, uv.y)).alpha;
    float above = texture_at(w, m->bump_texture, v2(uv.x, uv.y + y)).alpha;
    float below = texture_at(w, m->bump_texture, v2(uv.x, uv.y - y)).alpha;

    return v2(m->bump_scale * (right - left), m->bump_scale * (above - below));
}

/* Turns n towards ng if the reflection of wo about n is below the face. */
static inline struct vec3 bent_normal(struct vec3 n, struct vec3 ng,
                                      struct vec3 wo)
{
    struct vec3 r = v3_sub(v3_scale(n, 2.0f * v3_dot(n, wo)), wo);
    float above = v3_dot(r, ng);
    struct vec3 middle;
    float length;

    if (above >= BUMP_GRAZING)
        return n;
    middle = v3_add(wo, v3_unit(v3_add(r, v3_scale(ng, BUMP_GRAZING - above))));
    length = v3_length(middle);
    return length > 1e-6f ? v3_scale(middle, 1.0f / length) : ng;
}

/* Returns the normal of a map in tangent space. Its slope is multiplied by
 * strength, and its third component is mixed with 1 by depth. */
static inline struct vec3 normal_texel(const struct world *w, uint32_t texture,
                                       struct uv_pair uv, float strength,
                                       float depth)
{
    struct vec3 c = texture_at(w, texture, uv_for(w, texture, uv)).color;

    return v3(strength * (2.0f * c.x - 1.0f), strength * (2.0f * c.y - 1.0f),
              depth * (2.0f * c.z - 1.0f) + (1.0f - depth));
}

/* Turns the shading normal *n to `slope`, a normal in tangent space from this
 * texture. Returns false, and leaves *n, where it would face away from wo. */
static inline bool turn_normal(const struct world *w, uint32_t texture,
                               struct vec3 slope, const struct bump_place *at,
                               struct vec3 *n)
{
    bool is_second = has_second_uvs(w) && uses_second_uvs(w, texture);
    struct vec3 along_u, along_v, turned;
    float length;

    if (!tangents_at(w, is_second ? w->uvs2 : w->uvs, at, *n, &along_u,
                     &along_v))
        return false;
    turned =
        v3_add(v3_add(v3_scale(along_u, slope.x), v3_scale(along_v, slope.y)),
               v3_scale(*n, slope.z));
    length = v3_length(turned);
    if (!(length > 1e-6f))
        return false;
    turned = v3_scale(turned, 1.0f / length);
    if (!(v3_dot(turned, at->wo) > 0.0f))
        return false;
    *n = turned;
    return true;
}

/* Returns the shading normal n, bent by the bump and normal maps. wo.n > 0
 * before and after. The tangents are of the coordinates of the map of normals.
 */
static inline struct vec3 bumped_normal(const struct world *w,
                                        GLOBAL const struct material *m,
                                        const struct bump_place *at,
                                        struct vec3 n)
{
    struct vec3 slope = v3(0.0f, 0.0f, 1.0f);
    uint32_t texture = m->bump_texture;

    if (m->normal_texture != NO_INDEX) {
        texture = m->normal_texture;
        slope = normal_texel(w, texture, at->uv, m->normal_strength,
                             m->normal_depth);
    }
    if (m->bump_texture != NO_INDEX) {
        struct vec2 s = height_slopes(w, m, uv_for(w, m->bump_texture, at->uv));

        slope.x -= s.x;
        slope.y -= s.y;
    }
    return turn_normal(w, texture, slope, at, &n)
               ? bent_normal(n, at->ng, at->wo)
               : n;
}

/* True if the coat's normal may differ from that of the layers below. */
static inline bool has_coat_bumps(GLOBAL const struct material *m)
{
    return m->coat > 0.0f &&
           (has_bumps(m) || m->coat_normal_texture != NO_INDEX);
}

/* Returns the normal of the coat, which maps of the layers below do not bend:
 * n with the coat's own map (KHR_materials_clearcoat of glTF). Reflections
 * about it are above the layers below and above the face. */
static inline struct vec3 coat_normal(const struct world *w,
                                      GLOBAL const struct material *m,
                                      const struct bump_place *at,
                                      struct vec3 n, struct vec3 below)
{
    if (m->coat_normal_texture != NO_INDEX)
        turn_normal(w, m->coat_normal_texture,
                    normal_texel(w, m->coat_normal_texture, at->uv,
                                 m->coat_normal_strength, 1.0f),
                    at, &n);
    return bent_normal(bent_normal(n, below, at->wo), at->ng, at->wo);
}

#endif
