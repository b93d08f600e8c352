// SPDX-License-Identifier: MIT
/*
 * types.h - structs shared by host and device, of the same layout on both
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
#include "kernels/material_maps.h"

#define NO_INDEX 0xffffffffu

struct vec2 {
    float x, y;
};

struct vec3 {
    float x, y, z;
};

/* The tangent of a vertex, beside its normal: a unit vector along u, or 0 if
 * there is none. Times `sign`, 1 or -1, the product normal x tangent points
 * along v. */
struct tangent {
    struct vec3 d;
    float sign;
};

/* Indices into positions, normals and uvs. vn and vt are NO_INDEX, all three
 * of them, where the file has no normals or no texture coordinates. */
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
    MATERIAL_PLASTIC,       /* color: albedo of the base; specular; alpha */
    MATERIAL_GLASS,         /* color: tint of each crossing; ior, alpha */
    MATERIAL_THIN_GLASS,    /* color: tint of each crossing; ior, alpha */
    MATERIAL_PRINCIPLED /* mixture of metal, plastic and glass: principled.h */
};

/* Its part in paths from lamps: world/light/light_paths.h. */
enum material_role {
    ROLE_NONE,
    ROLE_CASTS, /* sends light into few directions */
    ROLE_MATTE  /* scatters light into all directions, and maybe a delta */
};

/* Most bodies in which a path is at a time; it does not notice others. */
#define MEDIA_MAX 8

/* Materials of the bodies in which a path is, in the order in which it has
 * entered them. */
struct media {
    uint32_t count;
    uint32_t at[MEDIA_MAX];
};

/* See medium.h. */
struct medium {
    struct vec3 extinction; /* coefficient of absorption and scattering */
    struct vec3 scattering;
    float anisotropy; /* mean cosine of scattering, between -1 and 1 */
    float base;       /* these two of fog: a height, */
    float falloff;    /* and a length; 0: it is even */
};

/* A grid of numbers in space: smoke.h. */
struct voxel_field {
    struct vec3 rows[3]; /* of the matrix from the world to voxels, */
    struct vec3 origin;  /* and where the world's origin is in it */
    struct vec3 first;   /* first and last voxel, counted from the first of the
                            first brick */
    struct vec3 last;
    uint32_t sides[3];    /* in bricks */
    uint32_t first_place; /* in voxel_places; the last axis is fastest */
};

/* Voxels on a side of a brick, and in a brick. */
#define BRICK_SIDE   8
#define BRICK_VOXELS 512

/* Where bricks are in a grid. */
struct voxel_place {
    uint32_t brick; /* its values begin at BRICK_VOXELS times this number */
    float majorant; /* bound of the values between its voxels and the next */
};

/* Most smokes of a world. */
#define SMOKES_MAX 8

/* Entries of a table of the radiance of black bodies. */
#define GLOW_ENTRIES 256

/* A medium whose density is a grid. */
struct smoke_medium {
    struct voxel_field density, temperature;
    struct vec3 extinction; /* coefficients of density 1 */
    struct vec3 scattering;
    float anisotropy;
    float most;          /* largest extinction */
    uint32_t first_glow; /* of its table in glows; NO_INDEX: it does not glow */
    float glow_scale;    /* entries per unit of temperature */
};

struct material {
    struct vec3 color;
    float alpha;          /* GGX roughness; below ALPHA_SMOOTH: a delta lobe */
    struct vec3 emission; /* radiance to both sides; 0: no light */
    float ior;
    uint32_t kind;            /* enum material_kind */
    uint32_t role;            /* enum material_role */
    float opacity;            /* probability that a ray is stopped */
    struct vec3 specular;     /* reflectance of the face at normal incidence */
    uint32_t color_is_opaque; /* 1: the alpha of color_texture does not
                                 multiply opacity */
    float metalness;          /* these four of MATERIAL_PRINCIPLED */
    float transmission;
    float coat; /* weight of the clear coat */
    float coat_alpha;
    struct vec3 sheen;
    float sheen_alpha;
    float anisotropy;  /* 0 to 1; of MATERIAL_PRINCIPLED too */
    struct vec2 grain; /* direction of the wider axis, in units of the tangents
                          along u and v */
    float subsurface;  /* weight of subsurface.h */
    struct medium medium;  /* below a subsurface, else inside a solid */
    uint32_t is_boundary;  /* 1: rays cross it; only its medium is there */
    uint32_t is_thin;      /* 1: glass of MATERIAL_PRINCIPLED is a thin sheet */
    float bump_scale;      /* height of an alpha of 1, in texels */
    float normal_strength; /* 0: the map of normals has no effect; 1: all */
    float normal_depth;    /* the same for its third component */
    float dispersion;      /* of ior, for dispersion.h; 0: none */
    float film; /* weight of a thin film on MATERIAL_PRINCIPLED: thin_film.h */
    float film_ior;
    float film_thickness; /* these two in nanometres */
    float film_thinnest;
    float cutoff; /* above 0: coverage from here on is 1, below it is 0 */
    float coat_normal_strength; /* as normal_strength */
    struct vec3 back_color;     /* albedo of diffuse transmission: diffuse.h */
    float translucency;         /* its weight in the diffuse base */
#define MATERIAL_MAP_MEMBER(name, member, ...) uint32_t member;
#define MATERIAL_MAP_NO_MEMBER(...)
    MATERIAL_MAP_LIST(MATERIAL_MAP_MEMBER, MATERIAL_MAP_NO_MEMBER)
#undef MATERIAL_MAP_MEMBER
#undef MATERIAL_MAP_NO_MEMBER
};

/* Roughness below which a microfacet lobe is a delta lobe. */
#define ALPHA_SMOOTH 5e-4f

/* How a texture is looked up, or-ed. Those after TEXTURE_CLAMP are of
 * FEATURE_TEXTURE_OPTIONS, except TEXTURE_OPAQUE, which decides has_alpha. */
enum texture_flag {
    TEXTURE_CLAMP_U = 1, /* clamped to the border, not repeated */
    TEXTURE_CLAMP_V = 2,
    TEXTURE_CLAMP = 3,
    TEXTURE_MIRROR_U = 4, /* repeated with every other copy mirrored */
    TEXTURE_MIRROR_V = 8,
    TEXTURE_NEAREST = 16,    /* no interpolation */
    TEXTURE_ROTATED = 32,    /* `rotation` is used */
    TEXTURE_SECOND_UVS = 64, /* looked up by uvs2 */
    TEXTURE_OPAQUE = 128     /* alpha is ignored */
};

/* The channel from which the number of a texel is read. */
enum texture_channel {
    CHANNEL_DEFAULT, /* alpha; of data, the mean of red, green and blue unless
                        the image has alpha */
    CHANNEL_RED,
    CHANNEL_GREEN,
    CHANNEL_BLUE,
    CHANNEL_ALPHA,
    CHANNEL_GREY = 8 /* the mean, in the byte of alpha */
};

/* An image of width * height texels, which begin at texels[first] with the top
 * row. A texel is 8-bit sRGB with linear alpha, red in the lowest byte. It is
 * looked up at uv * scale, rotated, + offset. */
struct texture {
    uint32_t first;
    uint32_t width;
    uint32_t height;
    uint32_t has_alpha; /* 1 if any alpha is below 1 */
    struct vec2 scale;
    struct vec2 offset;
    uint32_t flags;       /* enum texture_flag, or-ed */
    uint32_t is_data;     /* 1: linear channels */
    struct vec2 rotation; /* cosine and sine, counter-clockwise */
    uint32_t channel;     /* enum texture_channel */
    uint32_t pad;
};

/* Constant radiance (width 0) or a lat-long image times `color`. */
struct sky {
    struct vec3 color;
    uint32_t width;
    uint32_t height;
    float rotation_sin; /* rotation of the sky about +y, */
    float rotation_cos; /* counter-clockwise seen from above */
    uint32_t pad;
};

/* The camera. A ray has the direction forward + sx * right + sy * up, with sx
 * and sy in [-1, 1]; the lengths of right and up are tangents of half the
 * fields of view. */
struct camera {
    struct vec3 eye;
    float width; /* of the whole picture in pixels, not of a crop */
    struct vec3 forward;
    float height;
    struct vec3 right;
    float lens_radius; /* 0: a pinhole */
    struct vec3 up;
    float focus; /* distance of the focal plane along forward */
    float left;  /* position of pixel (0, 0) in the whole picture, in pixels: */
    float top;   /* the corner of a crop, which may be fractional in a draft */
};

/* Children of a node, and triangles of a block. */
#define BVH8_CHILDREN   8
#define BVH8_BLOCK_TRIS 4

/* A node of the tree of eight: the boxes of its children, as arrays for vector
 * units. src/world/bvh/bvh8.h draws the tree. */
struct bvh8_node {
    /* the signs of a ray choose near and far planes; [axis][low or high] */
    float planes[3][2][BVH8_CHILDREN]; /* no child: infinite */
    uint32_t child[BVH8_CHILDREN];     /* no child: the empty block */
};

/* The parts of a child: its place, and bits below. One shift makes its place an
 * offset from the root of the tree in bytes. */
#define BVH8_UNIT 32 /* bytes; all places are multiples of it */
#define BVH8_LEAF 4u /* it is a block, else a node */
#define BVH8_MORE 3u /* further blocks of the leaf, which follow the first */

/* Triangles of a leaf, with their corners as [corner][axis][triangle]. NaN and
 * NO_INDEX fill the places of missing triangles. */
struct tri_block {
    float corners[3][3][BVH8_BLOCK_TRIS];
    uint32_t tri[BVH8_BLOCK_TRIS];
};

/* A triangle with its corners. */
struct leaf_tri {
    struct vec3 p0, p1, p2;
    uint32_t tri;
};

/* A mesh in a place: instance.h. */
struct instance {
    struct vec3 rows[3];    /* of the matrix from the mesh to the world */
    struct vec3 origin;     /* where the origin of the mesh is */
    struct vec3 inverse[3]; /* rows of the matrix from the world to the mesh */
    float pad;           /* bound of errors near the instance, in the world */
    float inverse_error; /* bound of those of the inverse, in the mesh */
    uint32_t first_tri;  /* number of its first triangle */
    uint32_t tri_count;
    uint32_t mesh_tri;  /* index in tris of that of the mesh */
    uint32_t mesh;      /* number of the mesh */
    uint32_t material;  /* of all its triangles */
    uint32_t is_mirror; /* 1: the matrix mirrors */
};

/*
 * An area light: one emissive triangle, or two that share a side, of which each
 * is sampled half the time.
 *
 *     corners[3] +-----------+ corners[2]
 *                | \         |           tris[0] has corners 0, 1 and 3,
 *                |   \  t[1] |           tris[1] has corners 2, 3 and 1.
 *                |     \     |
 *                | t[0]  \   |           A light of one triangle has corners
 *                |         \ |           0, 1 and 3.
 *     corners[0] +-----------+ corners[1]
 *
 * `path` leads to the light from the root of the light tree. It has the index
 * of the child at each level: three bits a level from the lowest on,
 * LIGHT_LEVELS / 2 levels a word.
 */
struct light {
    uint32_t tris[2]; /* tris[1] is NO_INDEX for one triangle */
    uint32_t path[2];
    uint32_t texture;     /* multiplies emission; NO_INDEX: none */
    uint32_t rotation[2]; /* place above of the mesh triangle's first corner */
    struct vec3 corners[4];
    struct vec3 scaled_normals[2]; /* length: 2 / density of points by area */
    struct vec3 emission;
};

/*
 * A point light or a spot light. With a radius it is a sphere, which shines
 * with its radiance and hides nothing; without, it is a point, which only light
 * samples find. It lights a surface by its emission times
 *
 *     min(max(cosine * cone_scale + cone_offset, 0), 1)^2
 *
 * of the cosine between the axis and the direction from the light, as
 * KHR_lights_punctual of glTF defines spots. `path` is as in struct light.
 */
struct point_light {
    struct vec3 p;
    float radius;
    struct vec3 axis;     /* unit vector; 0 for a point light */
    float cone_scale;     /* 0 for a point light, */
    float cone_offset;    /* and 1 */
    struct vec3 emission; /* radiance of a sphere, intensity of a point */
    uint32_t path[2];
    uint32_t profile; /* 1 + its first value in profiles; 0: none */
    uint32_t profile_columns;
    struct vec3
        side; /* unit vector of angle 0 around the axis, with a profile */
};

/* Rows of the table of a profile: angles from 0 to 180 degrees from the axis.
 * Its columns divide the full circle around the axis; one column means that it
 * is the same all around. Values are factors of the emission. */
#define PROFILE_ROWS 181

/* A light at infinity in one direction. With a size it is a disc, which
 * escaping rays find too. */
struct directional_light {
    struct vec3 d;        /* unit vector to its middle */
    float size;           /* 1 - cosine of half its angle */
    struct vec3 emission; /* radiance of a disc; irradiance without a size */
    float sine;           /* of half its angle */
    float power;          /* irradiance, mean of the channels */
};

#define LIGHT_LEVELS 20
#define LIGHT_WIDTH  8
#define LIGHT_LEAF   0x80000000u

/* A node of the light tree: eight clusters of lights, as arrays for vector
 * units. Area lights emit to both sides, so that normals have no sign: the cone
 * around the axis bounds the lines along them. Point lights emit in all
 * directions, and their cone has a sine of 1. */
struct light_node {
    float x[LIGHT_WIDTH], y[LIGHT_WIDTH], z[LIGHT_WIDTH]; /* box centres */
    float radius[LIGHT_WIDTH]; /* of the sphere around the box; above 0 */
    float axis_x[LIGHT_WIDTH]; /* unit vectors, or 0 */
    float axis_y[LIGHT_WIDTH];
    float axis_z[LIGHT_WIDTH];
    float spread[LIGHT_WIDTH]; /* sine of the cone's half angle */
    float power[LIGHT_WIDTH];  /* share of all lights' power; 0: no child */
    /* a node; or a light, or-ed with LIGHT_LEAF: area lights are counted before
     * point lights */
    uint32_t child[LIGHT_WIDTH];
};

/* Bins along a side of the octahedral map of directions in guide.h. A power of
 * two. */
#define GUIDE_SIDE 16
#define GUIDE_BINS (GUIDE_SIDE * GUIDE_SIDE)

/* Classes of normals: by the axis of the largest component, and its sign. */
#define GUIDE_FACINGS 6

/* The grid of the path guide: the box around the scene divided into cubes, each
 * with GUIDE_FACINGS cells. Cells are ordered by z, y, x, then facing. */
struct guide_grid {
    struct vec3 lo; /* low corner of the box */
    float cells_per_unit;
    uint32_t width, height, depth; /* in cubes; 0: there is no grid */
    uint32_t table_count;          /* tables of directions in guide_cdf */
};

/* A cell of the path guide: where its tables begin in guide_cdf. NO_INDEX: it
 * has no such table. */
struct guide_cell {
    uint32_t scatter; /* directions for the next ray of a path */
    uint32_t sky;     /* directions for light samples of the sky */
};

/* Grids of light cells of the two halves, and of radiance cells of both. */
#define CELL_GRIDS 4

/* A grid of cell_grid.h. */
struct light_grid {
    struct vec3 eye;
    struct vec3 offset;   /* of the corner of a cell, in cells */
    struct vec3 facing;   /* a unit vector, of light_place() */
    float distance_scale; /* from 1 to 2 */
    float width;          /* of cells where the scaled distance is 1 */
    float count_min;      /* see light_level() */
    uint32_t first;       /* slot of the grid */
    uint32_t mask;        /* number of slots - 1; a power of two of them */
};

/* A cell of light_cells.h or of radiance_cells.h. */
struct light_cell {
    uint64_t key; /* 0: an empty slot */
    /* flux by the number of light paths, times the cosine of the shading normal
     * over that of the face; or radiance by the color of the surface */
    struct vec3 light;
    /* as long as the number of deposits: to where the flux of one came from,
     * chosen by flux; or along x, of estimates of the radiance */
    struct vec3 d;
};

/* Estimators of direct light. Pictures use DIRECT_MIS, the others are for
 * comparison. */
enum direct {
    DIRECT_MIS,    /* light samples and BSDF samples, weighted */
    DIRECT_LIGHTS, /* light samples only */
    DIRECT_BSDF    /* BSDF samples only: paths meet the lights */
};

/* The quantity of a sample: radiance, or an AOV at the first hit of the ray
 * through the middle of the pixel. */
enum sample_kind {
    SAMPLE_LIGHT,
    SAMPLE_PREVIEW, /* colours of surfaces, lit from the eye */
    /* numbers in x, y and z; 0 for the sky */
    SAMPLE_NORMAL,  /* (1 + shading normal on the eye's side) / 2 */
    SAMPLE_FACE,    /* (1 + face normal by the winding) / 2 */
    SAMPLE_UV,      /* x, y: fractions of uv; z: 1 where there are uvs */
    SAMPLE_DEPTH,   /* x: distance from the eye */
    SAMPLE_MATERIAL /* x: 1 + index of the material */
};

/* How random numbers are given to samples; see rng.h. */
enum order {
    ORDER_PROGRESSIVE, /* independent pixels, any number of samples */
    ORDER_DRAFT,       /* blue-noise error over pixels, DRAFT_SPP samples */
    ORDER_DRAFT_HALVES /* likewise, with independent halves */
};

/* Vertices after which every path ends. Russian roulette ends nearly all paths
 * long before; those that come so far are counted. */
#define PATH_HARD_STOP 1000u

/* Tentative collisions in smokes after which a path is cut: a bound for its
 * time, since media may be white and without end, and majorants far above
 * densities. Paths that only measure how light a scene is have few. */
#define SMOKE_STEPS_MAX 16384u
#define SMOKE_STEPS_FEW 2048u

/* The part of struct world that is not arrays. */
struct settings {
    struct camera camera;
    struct sky sky;
    uint32_t max_vertices; /* surface vertices of a path, emitter included */
    uint32_t seed;
    uint64_t features; /* a set of features.h */
    uint32_t direct;   /* enum direct */
    uint32_t order;    /* enum order */
    uint32_t sample;   /* enum sample_kind */
    /* 1: light paths bring the light whose last surface before the lamp casts,
     * and whose first one from the eye is matte. Paths from the eye then leave
     * it out; FEATURE_LIGHT_PATHS */
    uint32_t has_light_paths;
    uint32_t has_light_cells; /* light_cells.h: paths that begin with surfaces
                                 that cast leave that light out as well */
    uint32_t has_radiance_cells; /* radiance_cells.h: paths may end at them */
    float sky_level; /* of sky_below(): light paths bring what exceeds it */
    /* probability that a light sample is of light from infinity: of the sky or
     * of a directional light */
    float sky_share;
    float light_share; /* of a light of the tree; otherwise there is none */
    float sky_power;   /* importance of the sky beside the irradiance of
                          directional lights */
    struct medium fog; /* outside of all bodies */
    struct media camera_media; /* bodies in which the eye is */
    uint32_t has_boundaries;   /* 1: some material is one */

    /* lengths of the world's arrays */
    uint32_t tri_count; /* each mesh once */
    uint32_t instance_count;
    uint32_t position_count;
    uint32_t normal_count;
    uint32_t uv_count;
    uint32_t uv2_count;   /* uv_count, or 0 */
    uint32_t color_count; /* of vertices */
    uint32_t alpha_count;
    uint32_t tangent_count; /* normal_count, or 0 */
    uint32_t material_count;
    uint32_t texture_count;
    uint32_t texel_count;
    uint32_t light_count;
    uint32_t light_node_count;
    uint32_t sky_cdf_count;
    uint32_t point_light_count;
    uint32_t sphere_count; /* the first point lights, which have a radius */
    uint32_t directional_light_count;
    uint32_t profile_value_count;
    uint32_t smoke_count;
    uint32_t smoke_steps_max; /* of a path */
    uint32_t voxel_place_count;
    uint32_t voxel_count;
    uint32_t glow_count;
    uint32_t pad;

    struct guide_grid guide;
};

/* The data that a sample reads, and nothing more. */
struct world {
    struct settings settings;
    GLOBAL const struct vec3 *positions;
    GLOBAL const struct vec3 *normals;
    GLOBAL const struct vec2 *uvs;
    GLOBAL const struct vec2 *uvs2;          /* second uvs; NULL: none */
    GLOBAL const struct vec3 *colors;        /* of vertices; NULL: none */
    GLOBAL const float *alphas;              /* of vertices; NULL: all are 1 */
    GLOBAL const struct tangent *tangents;   /* by normals; NULL: none */
    GLOBAL const struct tri *tris;           /* those of meshes are the last */
    GLOBAL const struct instance *instances; /* by first_tri */
    GLOBAL const struct material *materials;
    GLOBAL const struct texture *textures;
    GLOBAL const uint32_t *texels;
    GLOBAL const float *linear_of_srgb;   /* 256 entries: the sRGB curve */
    GLOBAL const struct vec3 *sky_texels; /* top row: +y */
    /* The tree of eight; NULL: no triangles. With instances it is a tree of
     * stand-ins, which have the numbers of instances, and roots has where the
     * tree of each begins, in multiples of BVH8_UNIT from nodes. The last
     * stand-in stands for the triangles outside of meshes. */
    GLOBAL const struct bvh8_node *nodes;
    GLOBAL const uint32_t *roots;
    GLOBAL const struct light *lights;
    GLOBAL const uint32_t *tri_lights;           /* NO_INDEX: no light */
    GLOBAL const struct light_node *light_nodes; /* NULL for one light */
    GLOBAL const float *sky_cdf; /* see kernels/sky.h; NULL: no table */
    GLOBAL const struct guide_cell *guide_cells; /* see kernels/guide.h */
    GLOBAL const float *guide_cdf;               /* GUIDE_BINS of each table */
    GLOBAL const struct point_light *point_lights;
    GLOBAL const struct directional_light *directional_lights;
    GLOBAL const float *profiles; /* of point lights, row by row */
    GLOBAL const struct light_grid *light_grids; /* CELL_GRIDS, or NULL */
    GLOBAL const struct light_cell *light_cells; /* of all grids */
    GLOBAL const struct smoke_medium *smokes;
    GLOBAL const struct voxel_place *voxel_places; /* of all their grids */
    GLOBAL const float *voxels;                    /* brick by brick */
    GLOBAL const struct vec3 *glows;               /* tables of radiance */
};

struct ray {
    struct vec3 o;
    struct vec3 d; /* unit vector; any length for shadow rays to lights */
    float t_max;
    uint32_t key;  /* random key for partial coverage */
    uint32_t from; /* 1 + triangle that it leaves; 0: none */
};

/* The intersection of a ray and a triangle, at b0 p0 + b1 p1 + b2 p2. */
struct hit {
    float t;
    float b0, b1, b2;
    uint32_t tri;
};

#endif
