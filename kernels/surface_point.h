// SPDX-License-Identifier: MIT
/*
 * surface_point.h - the surface at a hit: position, normals, frame and BSDF
 *
 * Units: normalised scene units
 */
#ifndef KERNELS_SURFACE_POINT_H
#define KERNELS_SURFACE_POINT_H

#include "kernels/bsdf.h"
#include "kernels/bump.h"
#include "kernels/hit.h"
#include "kernels/texture.h"

struct surface_point {
    struct vec3 p;
    struct vec3 p_error;
    struct vec3 above; /* origin of rays that leave on the side of ng */
    struct vec3 ng;    /* unit, on the eye's side */
    struct vec3 n;     /* unit shading normal, wo.n > 0 */
    struct uv_pair uv;
    struct vec3 color; /* of the vertices; if has_vertex_colors() */
    bool has_uv;
    bool is_outside;   /* the eye is on the side of the normal by the winding */
    bool is_lifted;    /* moved off its face by surface_lift() */
    uint32_t face;     /* value of ray.from for rays that leave */
    uint32_t instance; /* of the triangle, or NO_INDEX */
    struct vec3 t, b;  /* with n: the local frame of BSDFs */
    struct vec3 coat_n; /* unit; zero: n. FEATURE_COAT_NORMALS */
};

static inline struct vec3 shading_normal(const struct world *w, struct tri t,
                                         uint32_t instance, struct hit h,
                                         struct vec3 ng, struct vec3 wo)
{
    struct vec3 n;
    float length;

    if (t.vn[0] == NO_INDEX)
        return ng;
    n = v3_add(v3_add(v3_scale(normal_at(w, t.vn[0], instance), h.b0),
                      v3_scale(normal_at(w, t.vn[1], instance), h.b1)),
               v3_scale(normal_at(w, t.vn[2], instance), h.b2));
    length = v3_length(n);
    if (!(length > 1e-6f))
        return ng;
    n = v3_scale(n, 1.0f / length);
    /* by the side of the face, as normals and winding of a file may disagree */
    n = v3_scale(n, minus_if(v3_dot(n, ng) < 0.0f));
    return v3_dot(n, wo) > 0.0f ? n : ng;
}

/* True if a map turns the grain of the material. */
static inline bool has_grain_map(GLOBAL const struct material *m,
                                 const struct surface_point *v)
{
    return HAS(FEATURE_TEXTURE_OPTIONS) && v->has_uv &&
           m->grain_texture != NO_INDEX;
}

/* The direction of the grain, turned by its map. */
static inline struct vec2 grain_at(const struct world *w,
                                   GLOBAL const struct material *m,
                                   const struct surface_point *v)
{
    struct vec2 grain = m->grain;
    float x, y;

    if (has_grain_map(m, v)) {
        struct vec3 c =
            texture_at(w, m->grain_texture, uv_for(w, m->grain_texture, v->uv))
                .color;

        x = 2.0f * c.x - 1.0f;
        y = 2.0f * c.y - 1.0f;
        grain = v2(x * grain.x - y * grain.y, x * grain.y + y * grain.x);
    }
    return grain;
}

/* Turns the frame of a surface with a grain: t along the grain, or along the
 * horizontal where there are no texture coordinates. */
static inline void surface_turn_frame(const struct world *w, struct vec2 grain,
                                      const struct bump_place *at,
                                      struct surface_point *v)
{
    struct vec3 along_u, along_v, d;
    float length;

    if (!v->has_uv || !tangents_at(w, w->uvs, at, v->n, &along_u, &along_v)) {
        along_u = v3(v->n.z, 0.0f, -v->n.x);
        along_v = v3_cross(v->n, along_u);
    }
    d = v3_add(v3_scale(along_u, grain.x), v3_scale(along_v, grain.y));
    d = v3_sub(d, v3_scale(v->n, v3_dot(v->n, d)));
    length = v3_length(d);
    if (!(length > 1e-6f))
        return;
    v->t = v3_scale(d, 1.0f / length);
    v->b = v3_cross(v->n, v->t);
}

static inline bool has_vertex_colors(const struct world *w)
{
    return HAS(FEATURE_VERTEX_COLORS) && w->settings.color_count > 0u;
}

/* Returns the colour of the vertices at a hit. */
static inline struct vec3 vertex_color(const struct world *w, struct tri t,
                                       struct hit h)
{
    return v3_add(v3_add(v3_scale(w->colors[t.v[0]], h.b0),
                         v3_scale(w->colors[t.v[1]], h.b1)),
                  v3_scale(w->colors[t.v[2]], h.b2));
}

/* Fills *v with the surface at hit h of ray r. m is the triangle's material.
 * Returns false for a triangle without a normal. No scene has one, but without
 * this branch compilers order what follows so that scenes of several materials
 * take 4 to 6 % more time (gcc 12). */
static inline bool surface_at(const struct world *w,
                              GLOBAL const struct material *m, struct ray r,
                              struct hit h, struct surface_point *v)
{
    uint32_t instance = instance_of(w, h.tri);
    struct tri t = tri_at(w, h.tri, instance);
    struct vec3 p0 = position_at(w, t.v[0], instance);
    struct vec3 p1 = position_at(w, t.v[1], instance);
    struct vec3 p2 = position_at(w, t.v[2], instance);
    struct vec3 wo = v3_neg(r.d), smooth;
    struct bump_place at;

    if (instance != NO_INDEX)
        t.ng = instance_face(w->instances[instance], t.ng, p0, p1, p2);
    if (v3_is_zero(t.ng))
        return false;
    v->is_outside = v3_dot(t.ng, wo) > 0.0f;
    v->ng = v3_scale(t.ng, minus_if(!v->is_outside));
    v->instance = instance;
    smooth = v->n = shading_normal(w, t, instance, h, v->ng, wo);
    v->p = hit_point_inset(h, p0, p1, p2, &v->p_error);
    v->above = offset_ray_origin(v->p, v->p_error, v->ng);
    v->is_lifted = false;
    v->face = h.tri + 1u;
    v->has_uv = t.vt[0] != NO_INDEX;
    v->uv.first = v2(0.0f, 0.0f);
    if (v->has_uv)
        v->uv.first = uv_of(w->uvs, t, h);
    if (HAS(FEATURE_TEXTURE_OPTIONS))
        v->uv.second = v->uv.first;
    if (v->has_uv && has_second_uvs(w))
        v->uv.second = uv_of(w->uvs2, t, h);
    if (has_vertex_colors(w))
        v->color = vertex_color(w, t, h);
    at = (struct bump_place){t, instance, h, v->uv, v->ng, wo};
    if (HAS(FEATURE_BUMPS) && v->has_uv && has_bumps(m))
        v->n = bumped_normal(w, m, &at, v->n);
    if (HAS(FEATURE_COAT_NORMALS)) {
        v->coat_n = v3(0.0f, 0.0f, 0.0f);
        if (v->has_uv && has_coat_bumps(m))
            v->coat_n = coat_normal(w, m, &at, smooth, v->n);
    }
    frame_around(v->n, &v->t, &v->b);
    if (HAS(FEATURE_ANISOTROPY) && m->anisotropy > 0.0f)
        surface_turn_frame(w, grain_at(w, m, v), &at, v);
    return true;
}

static inline struct vec3 surface_to_local(const struct surface_point *v,
                                           struct vec3 d)
{
    return v3(v3_dot(d, v->t), v3_dot(d, v->b), v3_dot(d, v->n));
}

static inline struct vec3 surface_to_world(const struct surface_point *v,
                                           struct vec3 d)
{
    struct vec3 x = v3_add(v3_scale(v->t, d.x), v3_scale(v->b, d.y));

    return v3_add(x, v3_scale(v->n, d.z));
}

/* Looks up a texture at a surface point, which has texture coordinates. */
static inline struct rgba surface_texel(const struct world *w,
                                        const struct surface_point *v,
                                        uint32_t texture)
{
    return texture_at(w, texture, uv_for(w, texture, v->uv));
}

/* Returns the number of a map at a surface point, 1 if there is none. */
static inline float map_number_at(const struct world *w,
                                  const struct surface_point *v,
                                  uint32_t texture)
{
    return HAS(FEATURE_TEXTURES) && v->has_uv && texture != NO_INDEX
               ? surface_texel(w, v, texture).alpha
               : 1.0f;
}

/* Multiplies the stretch of a highlight by a map. The factor squared multiplies
 * how much wider it is along the grain than across, and the width across stays:
 * KHR_materials_anisotropy of glTF. */
static inline void stretch_at(const struct world *w,
                              GLOBAL const struct material *m,
                              const struct surface_point *v, struct bsdf *b)
{
    float factor = surface_texel(w, v, m->grain_texture).color.z;
    float q = 1.0f - ANISOTROPY_SHARE * m->anisotropy;
    float ratio = 1.0f + (1.0f / q - 1.0f) * factor * factor;

    b->alpha *= sqrtf(q * ratio);
    b->anisotropy = (1.0f - 1.0f / ratio) * (1.0f / ANISOTROPY_SHARE);
}

/* Multiplies members of a mixture by maps that few materials have. */
static inline void principled_maps_at(const struct world *w,
                                      GLOBAL const struct material *m,
                                      const struct surface_point *v,
                                      struct bsdf *b)
{
    float roughness = map_number_at(w, v, m->sheen_alpha_texture);
    float thickness = map_number_at(w, v, m->film_thickness_texture);

    b->sheen_alpha =
        f_max(b->sheen_alpha * roughness * roughness, SHEEN_ALPHA_MIN);
    b->film *= map_number_at(w, v, m->film_texture);
    b->film_thickness =
        m->film_thinnest + thickness * (b->film_thickness - m->film_thinnest);
}

/* Fills the members of a BSDF that mixtures have. */
static inline void principled_at(const struct world *w,
                                 GLOBAL const struct material *m,
                                 const struct surface_point *v, struct bsdf *b)
{
    float roughness = map_number_at(w, v, m->coat_alpha_texture);

    b->metalness = m->metalness * map_number_at(w, v, m->metal_texture);
    b->transmission =
        m->transmission * map_number_at(w, v, m->transmission_texture);
    b->coat = m->coat * map_number_at(w, v, m->coat_texture);
    b->coat_alpha = m->coat_alpha * roughness * roughness;
    b->anisotropy = m->anisotropy;
    if (HAS(FEATURE_COAT_NORMALS))
        b->coat_normal = surface_to_local(v, v->coat_n);
    b->sheen = m->sheen;
    if (HAS(FEATURE_TEXTURES) && v->has_uv && m->sheen_texture != NO_INDEX)
        b->sheen =
            v3_mul(b->sheen, surface_texel(w, v, m->sheen_texture).color);
    b->sheen_alpha = m->sheen_alpha;
    b->is_thin = m->is_thin;
    b->film = m->film;
    b->film_ior = m->film_ior;
    b->film_thickness = m->film_thickness;
    if (HAS(FEATURE_TEXTURE_OPTIONS))
        principled_maps_at(w, m, v, b);
    if (HAS(FEATURE_ANISOTROPY) && m->anisotropy > 0.0f && has_grain_map(m, v))
        stretch_at(w, m, v, b);
}

/* Index of the far side over that of the eye's side, for glass of this index.
 */
static inline float eta_at(const struct bsdf *b, const struct surface_point *v,
                           float ior)
{
    return bsdf_is_solid(b) && !v->is_outside ? 1.0f / ior : ior;
}

/* Fills the members of a BSDF that translucent materials have. */
static inline void translucency_at(const struct world *w,
                                   GLOBAL const struct material *m,
                                   const struct surface_point *v,
                                   struct bsdf *b)
{
    b->back_color = m->back_color;
    if (HAS(FEATURE_TEXTURES) && v->has_uv && m->back_texture != NO_INDEX)
        b->back_color =
            v3_mul(b->back_color, surface_texel(w, v, m->back_texture).color);
    b->translucency =
        m->translucency * map_number_at(w, v, m->translucency_texture);
}

static inline struct bsdf bsdf_at(const struct world *w,
                                  GLOBAL const struct material *m,
                                  const struct surface_point *v)
{
    bool has_maps = HAS(FEATURE_TEXTURES) && v->has_uv;
    struct bsdf b = {0};

    b.color = m->color;
    if (has_maps && m->color_texture != NO_INDEX)
        b.color = v3_mul(b.color, surface_texel(w, v, m->color_texture).color);
    if (has_vertex_colors(w))
        b.color = v3_mul(b.color, v->color);
    b.specular = m->specular;
    if (has_maps && m->specular_texture != NO_INDEX)
        b.specular =
            v3_mul(b.specular, surface_texel(w, v, m->specular_texture).color);
    if (HAS(FEATURE_TEXTURE_OPTIONS))
        b.specular = v3_scale(b.specular,
                              map_number_at(w, v, m->specular_weight_texture));
    b.alpha = m->alpha;
    if (has_maps && m->alpha_texture != NO_INDEX) {
        float roughness = surface_texel(w, v, m->alpha_texture).alpha;

        b.alpha *= roughness * roughness;
    }
    b.kind = m->kind;
    if (HAS(FEATURE_SUBSURFACE))
        b.subsurface = m->subsurface;
    if (bsdf_is_principled(&b))
        principled_at(w, m, v, &b);
    if (HAS(FEATURE_TRANSLUCENT) && m->translucency > 0.0f)
        translucency_at(w, m, v, &b);
    b.eta = eta_at(&b, v, m->ior);
    return b;
}

/* Least cosine of a vertex normal to its face for surface_lift(): 41 degrees. A
 * sphere of 12 segments has .97, the mean over an edge of a box .71. */
#define LIFT_COS_MIN 0.75f

/* Moves the point from the face to the smooth surface that the vertex normals
 * describe, so that faces of a coarse mesh do not shadow each other (Hanika
 * 2021, "Hacking the shadow terminator", Ray Tracing Gems II, 4). For surfaces
 * that do not transmit. Faces whose vertex normals are means over the sharp
 * edges of a box stay where they are: no smooth surface is near them, and a
 * lift would let light into the corners beside them. */
static inline void surface_lift(const struct world *w, uint32_t tri,
                                struct hit h, struct surface_point *v)
{
    const float b[3] = {h.b0, h.b1, h.b2};
    struct tri t = tri_at(w, tri, v->instance);
    struct vec3 up = v3(0.0f, 0.0f, 0.0f);

    if (t.vn[0] == NO_INDEX)
        return;
    for (uint32_t i = 0; i < 3; i++) {
        struct vec3 n = normal_at(w, t.vn[i], v->instance);
        float height;

        if (v3_dot(n, v->ng) < 0.0f)
            n = v3_neg(n);
        if (v3_dot(n, v->ng) < LIFT_COS_MIN)
            return;
        height = v3_dot(v3_sub(v->p, position_at(w, t.v[i], v->instance)), n);
        up = v3_add(up, v3_scale(n, -b[i] * f_min(height, 0.0f)));
    }
    /* on a flat face the offset is rounding only */
    v->is_lifted =
        v3_length(up) > 4.0f * (v->p_error.x + v->p_error.y + v->p_error.z);
    if (v->is_lifted) {
        v->p = v3_add(v->p, up);
        v->p_error = v3_scale(v->p_error, 2.0f);
        v->above = offset_ray_origin(v->p, v->p_error, v->ng);
        v->face = 0;
    }
}

/* True if direction d is on the same side of shading normal and face, so that
 * the shading normal leaks no light through the face. z is the cosine of d to
 * n. After surface_lift() the face itself blocks the directions that it has to.
 */
static inline bool surface_sides_agree(const struct surface_point *v,
                                       struct vec3 d, float z)
{
    float side = v3_dot(d, v->ng);

    return z > 0.0f ? v->is_lifted || side > 0.0f : side < 0.0f;
}

/* The surface point with the face normal as its shading normal. The normal of a
 * coat keeps its angle to the shading normal. */
static inline struct surface_point surface_of_face(struct surface_point v)
{
    v.n = v.ng;
    frame_around(v.n, &v.t, &v.b);
    return v;
}

/* Origin of a ray that leaves above or below the surface, by its cosine z to n.
 */
static inline struct vec3 surface_ray_origin(const struct surface_point *v,
                                             float z)
{
    return z > 0.0f ? v->above
                    : offset_ray_origin(v->p, v->p_error, v3_neg(v->ng));
}

/* Sets origin, direction and `from` of a ray that leaves in direction d, whose
 * cosine to n is z. The caller sets its range and key. */
static inline void surface_spawn_ray(const struct surface_point *v,
                                     struct vec3 d, float z, struct ray *r)
{
    r->o = surface_ray_origin(v, z);
    r->d = d;
    r->from = v->face;
}

/* Samples the BSDF; *wi is the direction in world space. Returns false if the
 * light is absorbed, or if the face blocks the direction. */
static inline bool surface_scatter(const struct surface_point *v,
                                   const struct bsdf *b, struct vec3 wo,
                                   struct vec2 direction, float choice,
                                   struct bsdf_sample *s, struct vec3 *wi)
{
    if (!bsdf_sample(b, wo, direction, choice, s))
        return false;
    *wi = v3_unit_again(surface_to_world(v, s->wi));
    return surface_sides_agree(v, *wi, s->wi.z);
}

#endif
