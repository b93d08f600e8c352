// SPDX-License-Identifier: MIT
/*
 * types.h - the plain data that a sample reads, the same bytes on every machine
 *
 * Units:     normalised scene units: the loader moves the centre of the scene
 *            to the origin and scales by a power of two until its extent is in
 *            [1, 2); colours are linear Rec.709
 * Ownership: struct world borrows all its arrays
 * Threads:   everything here is read only while samples are computed
 */
#ifndef KERNELS_TYPES_H
#define KERNELS_TYPES_H

#include "kernels/dialect.h"
#include "kernels/features.h"

#define NO_INDEX 0xffffffffu

struct vec2 {
    float x, y;
};

struct vec3 {
    float x, y, z;
};

/* Indices into positions, normals and uvs; NO_INDEX where the file has none.
 * All three of vn, or none; the same for vt. */
struct tri {
    uint32_t v[3];
    uint32_t vn[3];
    uint32_t vt[3];
    uint32_t material;
    struct vec3 ng; /* unit normal by the winding; every triangle has one */
};

enum material_kind {
    MATERIAL_DIFFUSE,       /* color: albedo */
    MATERIAL_ROUGH_DIFFUSE, /* color: albedo; alpha: roughness */
    MATERIAL_METAL,         /* color: reflectance at normal incidence; alpha */
    MATERIAL_PLASTIC,       /* color: albedo of the base; coat; alpha */
    MATERIAL_GLASS,         /* color: tint of each crossing; ior, alpha */
    MATERIAL_THIN_GLASS     /* color: tint of each crossing; ior */
};

struct material {
    struct vec3 color;
    float alpha;          /* GGX; below ALPHA_SMOOTH a perfect mirror */
    struct vec3 emission; /* radiance, both sides; 0 for most */
    float ior;
    uint32_t kind;             /* enum material_kind */
    uint32_t color_texture;    /* multiplies color; NO_INDEX: none */
    uint32_t emission_texture; /* multiplies emission; NO_INDEX: none */
    float
        opacity; /* 1: opaque; less: a ray passes with probability 1-opacity */
    struct vec3 coat;         /* reflectance of the coat at normal incidence */
    uint32_t coat_texture;    /* multiplies coat; NO_INDEX: none */
    uint32_t alpha_texture;   /* its square multiplies alpha; NO_INDEX: none */
    uint32_t metal_texture;   /* times metalness at least 1/2: metal there */
    uint32_t opacity_texture; /* below 1/2: a hole; NO_INDEX: none */
    float metalness;          /* used with metal_texture only */
    uint32_t normal_texture;  /* shading normal in the tangents' frame */
    uint32_t bump_texture;    /* heights; NO_INDEX: none */
    float bump_scale;         /* texels that a height of 1 rises */
    uint32_t pad;
};

#define ALPHA_SMOOTH 5e-4f

/* width * height texels from texels[first] on, row 0 at the top of the image;
 * a texel is 8-bit sRGB with linear alpha, r in the lowest byte. Looked up at
 * uv * scale + offset. */
struct texture {
    uint32_t first;
    uint32_t width;
    uint32_t height;
    uint32_t has_holes; /* 1 if any alpha is below one half */
    struct vec2 scale;
    struct vec2 offset;
    uint32_t is_clamped; /* 1: the border goes on outside; 0: it repeats */
    uint32_t is_data;    /* 1: linear numbers, alpha holds their mean */
};

/* Constant radiance (width 0) or a lat-long image times `color`. */
struct sky {
    struct vec3 color;
    uint32_t width;
    uint32_t height;
    float rotation_sin; /* of the angle that turns the dome about +y, */
    float rotation_cos; /* counter-clockwise seen from above */
    uint32_t pad;
};

/* direction = forward + sx * right + sy * up, with sx and sy in [-1, 1]:
 * right and up carry the field of view and the aspect. */
struct camera {
    struct vec3 eye;
    float width; /* of the whole picture in pixels, not of a crop */
    struct vec3 forward;
    float height;
    struct vec3 right;
    float lens_radius; /* 0: a pinhole */
    struct vec3 up;
    float focus; /* from the eye to the sharp plane, along forward */
    float left;  /* where pixel (0, 0) begins in the picture, in pixels: the */
    float top;   /* corner of a crop, which in a draft is no whole number */
};

/* Depth-first: the left child of node i is node i + 1. */
struct node {
    struct vec3 lo;
    uint32_t next; /* inner: right child; leaf: first of its leaf_tris */
    struct vec3 hi;
    uint32_t count; /* triangles of a leaf; 0 for an inner node */
};

/* A triangle where the traversal wants it: raw vertices, in leaf order. */
struct leaf_tri {
    struct vec3 p0, p1, p2;
    uint32_t tri;
};

/* What shines, with what a sample of it needs: a triangle, or two that share a
 * side, each sampled half the time; and the way to it from the root of the
 * light tree: three bits a level, ten levels a word, the first lowest. Of the
 * corners of the two around both, those of the first triangle are 0, 1 and 3,
 * of the second 2, 3 and 1. */
struct light {
    uint32_t tris[2]; /* the second NO_INDEX: one triangle */
    uint32_t path[2];
    uint32_t texture;     /* multiplies emission; NO_INDEX: none */
    uint32_t rotation[2]; /* of these corners, where the mesh's begin */
    struct vec3 corners[4];
    struct vec3 scaled_normals[2]; /* normals, 2 / density of a point long */
    struct vec3 emission;
};

#define LIGHT_LEVELS 20
#define LIGHT_WIDTH  8
#define LIGHT_LEAF   0x80000000u

/* Eight clusters of lights, side by side for vector units. Lights shine from
 * both sides: their normals are lines, all within an angle of the axis. */
struct light_node {
    float x[LIGHT_WIDTH], y[LIGHT_WIDTH], z[LIGHT_WIDTH]; /* centre of a box */
    float radius[LIGHT_WIDTH]; /* of the ball around the box; above 0 */
    float axis_x[LIGHT_WIDTH]; /* unit */
    float axis_y[LIGHT_WIDTH];
    float axis_z[LIGHT_WIDTH];
    float spread[LIGHT_WIDTH];   /* sine of that angle */
    float power[LIGHT_WIDTH];    /* the sum over all lights is 1; 0: no child */
    uint32_t child[LIGHT_WIDTH]; /* a node, or a light and LIGHT_LEAF */
};

/* Directions on a side of the octahedral map in guide.h: a power of two. */
#define GUIDE_SIDE 16
#define GUIDE_BINS (GUIDE_SIDE * GUIDE_SIDE)

/* Ways that surfaces face: along either side of an axis, most of all. */
#define GUIDE_FACINGS 6

/* Cubes in the box around the scene, of GUIDE_FACINGS cells each, x next to
 * fastest, z slowest. */
struct guide_grid {
    struct vec3 lo; /* the box's corner */
    float cells_per_unit;
    uint32_t width, height, depth; /* cells; 0: there is no grid */
    uint32_t table_count;          /* of directions that cells have */
};

/* Where in guide_cdf a cell's directions begin; NO_INDEX: it has none. */
struct guide_cell {
    uint32_t scatter; /* for a path to go on, */
    uint32_t sky;     /* and for light samples of the sky */
};

/* How light is gathered where a path could meet it by chance as well. The
 * others are for comparing with. */
enum direct {
    DIRECT_MIS,    /* both ways, weighed */
    DIRECT_LIGHTS, /* only from lights that are chosen */
    DIRECT_BSDF    /* only where paths meet them */
};

/* What a sample is: light, or what the ray through a pixel's middle meets. */
enum sample_kind {
    SAMPLE_LIGHT,
    SAMPLE_PREVIEW, /* its colours, simply lit */
    /* numbers, in x y z; 0 for the sky */
    SAMPLE_NORMAL,  /* (1 + the shading normal on the eye's side) / 2 */
    SAMPLE_FACE,    /* (1 + the face's normal as it is wound) / 2 */
    SAMPLE_UV,      /* within the image, and 1 where there are any */
    SAMPLE_DEPTH,   /* x: distance from the eye */
    SAMPLE_MATERIAL /* x: 1 + its number */
};

/* Which random numbers a sample has; see rng.h. */
enum order {
    ORDER_PROGRESSIVE, /* pixels are independent, any number of samples */
    ORDER_DRAFT        /* pixels spread their error; DRAFT_SPP samples */
};

/* Paths without a limit of their own end here, counted; roulette ends them long
 * before. */
#define PATH_HARD_STOP 1000u

/* What a sample reads beside arrays. */
struct settings {
    struct camera camera;
    struct sky sky;
    uint32_t max_vertices; /* surface vertices of a path, emitter included */
    uint32_t seed;
    uint32_t features; /* enum feature, or-ed */
    uint32_t direct;   /* enum direct */
    uint32_t order;    /* enum order */
    uint32_t sample;   /* enum sample_kind */
    float sky_share;   /* probability that a light sample is one of the sky, */
    float light_share; /* of the lights; what is left is none at all */

    /* lengths of the world's arrays */
    uint32_t tri_count;
    uint32_t position_count;
    uint32_t normal_count;
    uint32_t uv_count;
    uint32_t material_count;
    uint32_t texture_count;
    uint32_t texel_count;
    uint32_t light_count;
    uint32_t light_node_count;
    uint32_t sky_cdf_count;

    struct guide_grid guide;
};

/* What a sample reads, nothing more. nodes and leaf_tris belong to the
 * backend, the rest to the scene. */
struct world {
    struct settings settings;
    GLOBAL const struct vec3 *positions;
    GLOBAL const struct vec3 *normals;
    GLOBAL const struct vec2 *uvs;
    GLOBAL const struct tri *tris;
    GLOBAL const struct material *materials;
    GLOBAL const struct texture *textures;
    GLOBAL const uint32_t *texels;
    GLOBAL const float *linear_of_srgb;   /* 256: the sRGB curve */
    GLOBAL const struct vec3 *sky_texels; /* row 0 is +y */
    GLOBAL const struct node *nodes;
    GLOBAL const struct leaf_tri *leaf_tris;
    GLOBAL const struct light *lights;
    GLOBAL const uint32_t *tri_lights;           /* NO_INDEX where it is dark */
    GLOBAL const struct light_node *light_nodes; /* none for one light */
    GLOBAL const float *sky_cdf; /* see kernels/sky.h; none: no table */
    GLOBAL const struct guide_cell *guide_cells; /* see kernels/guide.h */
    GLOBAL const float *guide_cdf; /* GUIDE_BINS of each table there */
};

struct ray {
    struct vec3 o;
    struct vec3 d; /* unit length; of shadow rays to surfaces any */
    float t_max;
    uint32_t key;  /* of the sample, for decisions at holes */
    uint32_t from; /* 1 + the triangle it leaves, which is flat: it cannot
                      meet it again; 0: none */
};

/* Where a ray meets a triangle: p = b0 p0 + b1 p1 + b2 p2. */
struct hit {
    float t;
    float b0, b1, b2;
    uint32_t tri;
};

#endif
