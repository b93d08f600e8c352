// SPDX-License-Identifier: MIT
/*
 * instance.h - instances: meshes that are stored once and shown in many places
 *
 * An instance is a copy that is not stored. Its triangles have numbers, behind
 * those of the triangles outside of meshes and of earlier instances, and the
 * corners that instance_point() gives. So hits, ties and pictures are those of
 * a scene with all copies, bit for bit.
 *
 * Rays are intersected with the moved corners. Only for tests of boxes the ray
 * moves to the mesh, to instance_ray(), whose boxes are widened by a bound of
 * all errors.
 *
 * Units:   normalised scene units; in meshes, units in which the mesh is
 *          centred and its extent is in [1, 2)
 */
#ifndef KERNELS_INSTANCE_H
#define KERNELS_INSTANCE_H

#include "kernels/hit.h"

/* Errors of a ray and of a moved corner, in multiples of a float's rounding
 * u = 2^-24 and of the vector from the instance's origin to the ray's: 4 for
 * the sum of products o - origin, 3 for the direction's and 2 for the slab test
 * of a plane; 16 for those of the triangle test, which EXIT_WIDEN stands for in
 * world space. At a hit the distance times the direction is at most this vector
 * plus the reach of the instance, which instance.pad has. 32 has room for the
 * rounding of the bound. */
#define INSTANCE_ERROR (32.0f * 0x1p-24f)

static inline bool has_instances(const struct world *w)
{
    return HAS(FEATURE_INSTANCES) && w->settings.instance_count > 0;
}

/* The number of triangles outside of meshes, which are the first. */
static inline uint32_t plain_tri_count(const struct world *w)
{
    return has_instances(w) ? w->instances[0].first_tri : w->settings.tri_count;
}

/* The number of triangles with those of all instances. */
static inline uint32_t all_tri_count(const struct world *w)
{
    uint32_t last = w->settings.instance_count - 1u;

    return has_instances(w)
               ? w->instances[last].first_tri + w->instances[last].tri_count
               : w->settings.tri_count;
}

/* The instance of a triangle, or NO_INDEX if it is outside of meshes. */
static inline uint32_t instance_of(const struct world *w, uint32_t tri)
{
    uint32_t low = 0, high;

    if (!has_instances(w) || tri < w->instances[0].first_tri)
        return NO_INDEX;
    high = w->settings.instance_count;
    while (high - low > 1u) {
        uint32_t middle = low + (high - low) / 2u;

        if (tri < w->instances[middle].first_tri)
            high = middle;
        else
            low = middle;
    }
    return low;
}

/* Moves a point of the mesh to its place. */
static inline struct vec3 instance_point(struct instance at, struct vec3 p)
{
    return v3(v3_dot(at.rows[0], p) + at.origin.x,
              v3_dot(at.rows[1], p) + at.origin.y,
              v3_dot(at.rows[2], p) + at.origin.z);
}

/* Moves a normal of the mesh: a unit vector, or 0 if it is 0. */
static inline struct vec3 instance_normal(struct instance at, struct vec3 n)
{
    struct vec3 to = v3_add(v3_add(v3_scale(at.inverse[0], n.x),
                                   v3_scale(at.inverse[1], n.y)),
                            v3_scale(at.inverse[2], n.z));

    return v3_enlarge(&to) ? v3_unit(to) : v3(0.0f, 0.0f, 0.0f);
}

/* The geometric normal of a triangle with these moved corners, on the side
 * where the mesh has it. One that has lost its area in rounding keeps the
 * mesh's normal ng. */
static inline struct vec3 instance_face(struct instance at, struct vec3 ng,
                                        struct vec3 p0, struct vec3 p1,
                                        struct vec3 p2)
{
    struct vec3 n;

    if (!triangle_normal(p0, p1, p2, &n))
        return instance_normal(at, ng);
    return at.is_mirror != 0 ? v3_neg(n) : n;
}

/* A ray in the space of a mesh, with the same distances. Boxes that are wider
 * by `widen` on each side hold all places where the triangle test may have a
 * hit. */
struct mesh_ray {
    struct vec3 o, d;
    struct vec3 widen;
};

static inline struct vec3 v3_abs(struct vec3 a)
{
    return v3(fabsf(a.x), fabsf(a.y), fabsf(a.z));
}

static inline struct mesh_ray instance_ray(struct instance at, struct ray r)
{
    struct vec3 o = v3_sub(r.o, at.origin);
    struct vec3 error = v3(fabsf(o.x) * INSTANCE_ERROR + at.pad,
                           fabsf(o.y) * INSTANCE_ERROR + at.pad,
                           fabsf(o.z) * INSTANCE_ERROR + at.pad);
    struct mesh_ray m;

    m.o = v3(v3_dot(at.inverse[0], o), v3_dot(at.inverse[1], o),
             v3_dot(at.inverse[2], o));
    m.d = v3(v3_dot(at.inverse[0], r.d), v3_dot(at.inverse[1], r.d),
             v3_dot(at.inverse[2], r.d));
    m.widen = v3(v3_dot(v3_abs(at.inverse[0]), error) + at.inverse_error,
                 v3_dot(v3_abs(at.inverse[1]), error) + at.inverse_error,
                 v3_dot(v3_abs(at.inverse[2]), error) + at.inverse_error);
    return m;
}

/* ---- triangles by their number; `instance` is instance_of() it ---- */

/* The triangle as stored, with the material of its instance. Its corners and
 * normals are those of the functions below. */
static inline struct tri tri_at(const struct world *w, uint32_t tri,
                                uint32_t instance)
{
    struct tri t;

    if (!HAS(FEATURE_INSTANCES) || instance == NO_INDEX)
        return w->tris[tri];
    t = w->tris[w->instances[instance].mesh_tri +
                (tri - w->instances[instance].first_tri)];
    t.material = w->instances[instance].material;
    return t;
}

static inline uint32_t tri_material(const struct world *w, uint32_t tri,
                                    uint32_t instance)
{
    return HAS(FEATURE_INSTANCES) && instance != NO_INDEX
               ? w->instances[instance].material
               : w->tris[tri].material;
}

/* Position `index` where the instance shows it. */
static inline struct vec3 position_at(const struct world *w, uint32_t index,
                                      uint32_t instance)
{
    struct vec3 p = w->positions[index];

    return HAS(FEATURE_INSTANCES) && instance != NO_INDEX
               ? instance_point(w->instances[instance], p)
               : p;
}

static inline struct vec3 normal_at(const struct world *w, uint32_t index,
                                    uint32_t instance)
{
    struct vec3 n = w->normals[index];

    return HAS(FEATURE_INSTANCES) && instance != NO_INDEX
               ? instance_normal(w->instances[instance], n)
               : n;
}

/* The tangent beside normal `index` where the instance shows it. */
static inline struct tangent tangent_at(const struct world *w, uint32_t index,
                                        uint32_t instance)
{
    struct tangent t = w->tangents[index];

    if (HAS(FEATURE_INSTANCES) && instance != NO_INDEX) {
        struct instance at = w->instances[instance];

        t.d = v3(v3_dot(at.rows[0], t.d), v3_dot(at.rows[1], t.d),
                 v3_dot(at.rows[2], t.d));
        t.sign = at.is_mirror != 0 ? -t.sign : t.sign;
    }
    return t;
}

/* A triangle with its corners, for those who do not render. */
struct placed_tri {
    struct tri t;
    struct vec3 p[3];
};

static inline struct placed_tri tri_placed(const struct world *w, uint32_t tri)
{
    uint32_t instance = instance_of(w, tri);
    struct placed_tri placed;

    placed.t = tri_at(w, tri, instance);
    for (int k = 0; k < 3; k++)
        placed.p[k] = position_at(w, placed.t.v[k], instance);
    if (instance != NO_INDEX)
        placed.t.ng = instance_face(w->instances[instance], placed.t.ng,
                                    placed.p[0], placed.p[1], placed.p[2]);
    return placed;
}

#endif
