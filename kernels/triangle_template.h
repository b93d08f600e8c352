// SPDX-License-Identifier: MIT
/*
 * triangle_template.h - the triangle test in four or eight lanes
 *
 * This file is a template: each inclusion defines the test for one type of
 * vector. traverse_block.h includes it for f4, with four triangles and one ray,
 * and src/world/bvh/ray_queries.h for f8, with one triangle and eight rays.
 * Before the inclusion define:
 *
 *     LANES         the vector type, f4 or f8
 *     LANES_RAYS    the number of rays: 1, or one for each lane
 *     f4_corner()   loads a coordinate of a corner into all lanes from the
 *                   block (or f8_corner())
 *     f4_ray()      the same for a component of the rays (or f8_ray())
 *     LANES_BLOCK   what the corners are loaded from
 *
 * FN(name) is the function of that type: FN(sub) is f4_sub or f8_sub of
 * src/base/simd4.h and simd8.h, or simd_cl.h. What the file defines has the
 * prefix as well: struct f4_rays, and f4_test(), which is the test.
 *
 * Lane by lane the test takes the steps of triangle_hit() in kernels/hit.h, and
 * gives the same bits. Where triangle_hit() would go on with pairs of floats,
 * for an edge function or a distance, the lane is marked as unsure, and the
 * caller asks triangle_hit().
 *
 * Units:     normalised scene units
 * Threads:   any
 */
#include "kernels/simd_hits.h"

/* The name is joined first, as an OpenCL compiler may have a macro of it. */
#define LANES_JOIN_(lanes, name) lanes##name
#define LANES_JOIN(lanes, name)  LANES_JOIN_(lanes, name)
#define FN(name)                 LANES_JOIN(LANES, _##name)
#define RAYS                     FN(rays)
#define CORNERS                  FN(corners)

/* Rays, and their shears, which have the same axis. */
struct RAYS {
    ALIGNED(4 * LANES_RAYS) float o[3][LANES_RAYS], d[3][LANES_RAYS];
    ALIGNED(4 * LANES_RAYS)
    float sx[LANES_RAYS], sy[LANES_RAYS], sz[LANES_RAYS];
    uint32_t axis;
};

/* Corners after the shear: x, y and z of each. */
struct CORNERS {
    LANES x[3], y[3], z[3];
};

static inline LANES FN(least)(const LANES v[3])
{
    return FN(min)(v[0], FN(min)(v[1], v[2]));
}

static inline LANES FN(most)(const LANES v[3])
{
    return FN(max)(v[0], FN(max)(v[1], v[2]));
}

static inline LANES FN(reach)(const LANES v[3])
{
    return FN(max)(FN(abs)(v[0]), FN(max)(FN(abs)(v[1]), FN(abs)(v[2])));
}

/* The sum, grouped as in triangle_hit(). */
static inline LANES FN(sum)(const LANES v[3])
{
    return FN(add)(v[0], FN(add)(v[1], v[2]));
}

/* shear_apply() without the factor of z, which few blocks need. */
static inline struct CORNERS FN(shear)(LANES_BLOCK b, const struct RAYS *r)
{
    uint32_t kz = r->axis;
    uint32_t kx = kz == 2 ? 0 : kz + 1;
    uint32_t ky = kx == 2 ? 0 : kx + 1;
    struct CORNERS c;

    UNROLLED
    for (int i = 0; i < 3; i++) {
        c.z[i] = FN(sub)(FN(corner)(b, i, kz), FN(ray)(r->o[kz]));
        c.x[i] = FN(sub)(FN(sub)(FN(corner)(b, i, kx), FN(ray)(r->o[kx])),
                         FN(mul)(FN(ray)(r->sx), c.z[i]));
        c.y[i] = FN(sub)(FN(sub)(FN(corner)(b, i, ky), FN(ray)(r->o[ky])),
                         FN(mul)(FN(ray)(r->sy), c.z[i]));
    }
    return c;
}

/* distance_error(), or a little more: enough for what is rounded in another
 * order. */
static inline LANES FN(error)(const struct CORNERS *c, LANES det)
{
    LANES spread = FN(sub)(FN(most)(c->z), FN(least)(c->z));
    LANES reach_x = FN(reach)(c->x);
    LANES reach_y = FN(reach)(c->y);
    LANES reach_z = FN(reach)(c->z);
    LANES gamma = FN(set1)(GAMMA(5));
    LANES error_x = FN(mul)(gamma, FN(add)(reach_x, reach_z));
    LANES error_y = FN(mul)(gamma, FN(add)(reach_y, reach_z));
    LANES products =
        FN(add)(FN(mul)(FN(mul)(FN(set1)(GAMMA(2)), reach_x), reach_y),
                FN(add)(FN(mul)(error_y, reach_x), FN(mul)(error_x, reach_y)));
    LANES weights = FN(mul)(FN(set1)(6.0f * (1.0f + 0x1p-20f)), products);

    return FN(add)(FN(div)(FN(mul)(weights, spread), FN(abs)(det)),
                   FN(mul)(FN(set1)(GAMMA(12)), reach_z));
}

/* Computes the distances. *is_flat has the lanes with triangles perpendicular
 * to an axis, whose distances are those of axis_distance(). */
static inline LANES FN(distance)(LANES_BLOCK b, const struct RAYS *r,
                                 struct CORNERS *c, const LANES edges[3],
                                 FN(mask) * is_flat)
{
    LANES weighted[3], over, under = FN(sum)(edges);

    *is_flat = FN(lt)(under, under); /* none */

    UNROLLED
    for (int i = 0; i < 3; i++) {
        c->z[i] = FN(mul)(FN(ray)(r->sz), c->z[i]);
        weighted[i] = FN(mul)(edges[i], c->z[i]);
    }
    over = FN(sum)(weighted);
    UNROLLED
    for (int i = 2; i >= 0; i--) {
        LANES p0 = FN(corner)(b, 0, (uint32_t)i);
        LANES p1 = FN(corner)(b, 1, (uint32_t)i);
        LANES p2 = FN(corner)(b, 2, (uint32_t)i);
        FN(mask) is_across = FN(equal3)(p0, p1, p2);

        over = FN(select)(is_across, FN(sub)(p0, FN(ray)(r->o[i])), over);
        under = FN(select)(is_across, FN(ray)(r->d[i]), under);
        *is_flat = FN(or)(*is_flat, is_across);
    }
    return FN(div)(over, under);
}

/* Tests rays against triangles. Returns false if no lane has a hit. Lanes that
 * are `passed` have none. */
static inline bool FN(test)(LANES_BLOCK b, const struct RAYS *r, LANES t_max,
                            FN(mask) passed, struct simd_hits *h)
{
    struct CORNERS c = FN(shear)(b, r);
    LANES zero = FN(set1)(0.0f);
    LANES edges[3] = {
        FN(sub)(FN(mul)(c.x[2], c.y[1]), FN(mul)(c.y[2], c.x[1])),
        FN(sub)(FN(mul)(c.x[0], c.y[2]), FN(mul)(c.y[0], c.x[2])),
        FN(sub)(FN(mul)(c.x[1], c.y[0]), FN(mul)(c.y[1], c.x[0])),
    };
    FN(mask)
    met = FN(but)(FN(or)(FN(le)(zero, FN(least)(edges)),
                         FN(le)(FN(most)(edges), zero)),
                  passed);
    FN(mask) is_flat, is_exact, is_near, is_beyond;
    LANES t, error;

    if (FN(bits)(met) == 0)
        return false;
    t = FN(distance)(b, r, &c, edges, &is_flat);
    error = FN(error)(&c, FN(sum)(edges));
    is_exact = FN(
        or)(is_flat, FN(lt)(error, FN(mul)(FN(abs)(t), FN(set1)(T_PRECISION))));
    /* Distances that are not exact are off by less than the bound. It is
     * doubled, so that roundings of the sums do not count. */
    error = FN(add)(error, error);
    is_beyond = FN(or)(FN(lt)(FN(add)(t, error), zero),
                       FN(lt)(t_max, FN(sub)(t, error)));
    /* an edge function of 0 has lost its sign; the product is also 0 if it
     * underflows, which only costs time */
    is_exact =
        FN(but)(is_exact,
                FN(le)(FN(abs)(FN(mul)(FN(mul)(edges[0], edges[1]), edges[2])),
                       zero));
    is_near = FN(and)(FN(lt)(zero, t), FN(le)(t, t_max));
    h->unsure = FN(bits)(FN(but)(FN(but)(met, is_exact), is_beyond));
    h->sure = FN(bits)(FN(and)(FN(and)(met, is_exact), is_near));
    FN(store)(h->t, t);
    UNROLLED
    for (int i = 0; i < 3; i++)
        FN(store)(h->edges[i], edges[i]);
    return true;
}

#undef CORNERS
#undef RAYS
#undef FN
#undef LANES_JOIN
#undef LANES_JOIN_
#undef LANES
#undef LANES_RAYS
#undef LANES_BLOCK
