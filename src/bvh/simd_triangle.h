// SPDX-License-Identifier: MIT
/*
 * simd_triangle.h - the triangle test in lanes, each with a ray and a triangle
 *
 * Lane by lane these are the steps of triangle_hit() in kernels/hit.h, and they
 * give the same bits. Where that takes another way, to the lost digits of an
 * edge or of a distance, the lane says so, and triangle_hit() itself decides.
 *
 * To be included for each width, where LANES is f4 or f8; the names of all that
 * is here begin with that. The includer has said what lanes have of a corner's
 * coordinate: LANES_corner() of where it stands in the block.
 *
 * Units:     normalised scene units
 * Threads:   any
 */
#include "bvh/simd_hits.h"

#define LANES_JOIN_(lanes, name) lanes##_##name
#define LANES_JOIN(lanes, name)  LANES_JOIN_(lanes, name)
#define OF(name)                 LANES_JOIN(LANES, name)
#define RAYS                     OF(rays)
#define CORNERS                  OF(corners)

/* Rays and their shears, which have one axis. */
struct RAYS {
    _Alignas(4 * LANES_RAYS) float o[3][LANES_RAYS], d[3][LANES_RAYS];
    _Alignas(4 * LANES_RAYS) float sx[LANES_RAYS], sy[LANES_RAYS],
        sz[LANES_RAYS];
    uint32_t axis;
};

/* Corners in the space of the sheared ray: x, y and z of each. */
struct CORNERS {
    LANES x[3], y[3], z[3];
};

static inline LANES OF(least)(const LANES v[3])
{
    return OF(min)(v[0], OF(min)(v[1], v[2]));
}

static inline LANES OF(most)(const LANES v[3])
{
    return OF(max)(v[0], OF(max)(v[1], v[2]));
}

static inline LANES OF(reach)(const LANES v[3])
{
    return OF(max)(OF(abs)(v[0]), OF(max)(OF(abs)(v[1]), OF(abs)(v[2])));
}

/* Grouped as in triangle_hit(). */
static inline LANES OF(sum)(const LANES v[3])
{
    return OF(add)(v[0], OF(add)(v[1], v[2]));
}

/* As shear_apply(), but for the factor of z: few blocks need it. */
static inline struct CORNERS OF(shear)(const struct tri_block *block,
                                       uint32_t at, const struct RAYS *r)
{
    uint32_t kz = r->axis;
    uint32_t kx = kz == 2 ? 0 : kz + 1;
    uint32_t ky = kx == 2 ? 0 : kx + 1;
    struct CORNERS c;

    for (int i = 0; i < 3; i++) {
        const float(*corner)[BLOCK_TRIS] = block->corners[i];

        c.z[i] = OF(sub)(OF(corner)(&corner[kz][at]), OF(ray)(r->o[kz]));
        c.x[i] =
            OF(sub)(OF(sub)(OF(corner)(&corner[kx][at]), OF(ray)(r->o[kx])),
                    OF(mul)(OF(ray)(r->sx), c.z[i]));
        c.y[i] =
            OF(sub)(OF(sub)(OF(corner)(&corner[ky][at]), OF(ray)(r->o[ky])),
                    OF(mul)(OF(ray)(r->sy), c.z[i]));
    }
    return c;
}

/* As distance_error(), or more than it: what rounds in another order is made
 * larger by more than that can matter. */
static inline LANES OF(error)(const struct CORNERS *c, LANES det)
{
    LANES spread = OF(sub)(OF(most)(c->z), OF(least)(c->z));
    LANES reach_x = OF(reach)(c->x);
    LANES reach_y = OF(reach)(c->y);
    LANES reach_z = OF(reach)(c->z);
    LANES gamma = OF(set1)(GAMMA(5));
    LANES error_x = OF(mul)(gamma, OF(add)(reach_x, reach_z));
    LANES error_y = OF(mul)(gamma, OF(add)(reach_y, reach_z));
    LANES products =
        OF(add)(OF(mul)(OF(mul)(OF(set1)(GAMMA(2)), reach_x), reach_y),
                OF(add)(OF(mul)(error_y, reach_x), OF(mul)(error_x, reach_y)));
    LANES weights = OF(mul)(OF(set1)(6.0f * (1.0f + 0x1p-20f)), products);

    return OF(add)(OF(div)(OF(mul)(weights, spread), OF(abs)(det)),
                   OF(mul)(OF(set1)(GAMMA(12)), reach_z));
}

/* The distances, and in *is_exact the lanes where they are triangle_hit()'s:
 * those across an axis by axis_distance(), the others by the edge functions if
 * these are good enough. */
static inline LANES OF(distance)(const struct tri_block *block, uint32_t at,
                                 const struct RAYS *r, struct CORNERS *c,
                                 const LANES edges[3], uint32_t *is_exact)
{
    LANES weighted[3], det = OF(sum)(edges);
    LANES over, under = det, t;
    uint32_t is_flat = 0;

    for (int i = 0; i < 3; i++) {
        c->z[i] = OF(mul)(OF(ray)(r->sz), c->z[i]);
        weighted[i] = OF(mul)(edges[i], c->z[i]);
    }
    over = OF(sum)(weighted);
    for (int i = 2; i >= 0; i--) {
        LANES p0 = OF(corner)(&block->corners[0][i][at]);
        LANES p1 = OF(corner)(&block->corners[1][i][at]);
        LANES p2 = OF(corner)(&block->corners[2][i][at]);

        over =
            OF(select_equal3)(p0, p1, p2, OF(sub)(p0, OF(ray)(r->o[i])), over);
        under = OF(select_equal3)(p0, p1, p2, OF(ray)(r->d[i]), under);
        is_flat |= OF(mask_equal3)(p0, p1, p2);
    }
    t = OF(div)(over, under);
    *is_exact =
        is_flat | OF(mask_lt)(OF(error)(c, det),
                              OF(mul)(OF(abs)(t), OF(set1)(T_PRECISION)));
    return t;
}

/* False if all of the rays pass by: of block's triangles from `at` on. Lanes
 * that are not wanted count as having done so. */
static inline bool OF(test)(const struct tri_block *block, uint32_t at,
                            const struct RAYS *r, LANES t_max, uint32_t wanted,
                            struct simd_hits *h)
{
    struct CORNERS c = OF(shear)(block, at, r);
    LANES zero = OF(set1)(0.0f);
    LANES edges[3] = {
        OF(sub)(OF(mul)(c.x[2], c.y[1]), OF(mul)(c.y[2], c.x[1])),
        OF(sub)(OF(mul)(c.x[0], c.y[2]), OF(mul)(c.y[0], c.x[2])),
        OF(sub)(OF(mul)(c.x[1], c.y[0]), OF(mul)(c.y[1], c.x[0])),
    };
    uint32_t met = (OF(mask_le)(zero, OF(least)(edges)) |
                    OF(mask_le)(OF(most)(edges), zero)) &
                   wanted;
    uint32_t is_exact;
    LANES t;

    if (met == 0)
        return false;
    t = OF(distance)(block, at, r, &c, edges, &is_exact);
    /* an edge function of 0 has lost its sign; a product that is too small for
     * a float only costs time */
    is_exact &= ~OF(
        mask_le)(OF(abs)(OF(mul)(OF(mul)(edges[0], edges[1]), edges[2])), zero);
    h->unsure = met & ~is_exact;
    h->sure = met & is_exact & OF(mask_lt)(zero, t) & OF(mask_le)(t, t_max);
    OF(store)(h->t, t);
    for (int i = 0; i < 3; i++)
        OF(store)(h->edges[i], edges[i]);
    return true;
}

#undef CORNERS
#undef RAYS
#undef OF
#undef LANES_JOIN
#undef LANES_JOIN_
#undef LANES
#undef LANES_RAYS
