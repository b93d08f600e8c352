// SPDX-License-Identifier: MIT
#include "inspect/material_ball.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/geometry.h"
#include "base/memory.h"
#include "render/cpu_dispatch.h"
#include "scene/material.h"
#include "kernels/hit.h"
#include "kernels/tone.h"

/* Materials of the studio. */
enum { BALL, FLOOR_LIGHT, FLOOR_DARK };

/* The ball: rows of latitude, columns of longitude. */
#define ROWS    24
#define COLUMNS 48
#define CORNERS ((ROWS + 1) * (COLUMNS + 1))
#define RADIUS  0.5f

/* The floor: squares of one colour, under the ball. */
#define SQUARES      10
#define SQUARE_SIDE  0.35f
#define FLOOR_POINTS ((SQUARES + 1) * (SQUARES + 1))

#define POINTS (CORNERS + FLOOR_POINTS)
#define TRIS   (2 * ROWS * COLUMNS + 2 * SQUARES * SQUARES)

/* Texels of the sky, which is a lat-long image. */
#define SKY_ROWS    24
#define SKY_COLUMNS 48

/* Vertices of a path, and of one in a medium, where all vertices but a few are
 * collisions. */
#define VERTICES_MAX   12
#define COLLISIONS_MAX 256

/* Samples of each pixel that are added together: some 2000 paths. Those in a
 * medium take ten times as long. */
#define SPP_TOGETHER 4

/* Radiance of a white ball where the studio lights it most. */
#define WHITE_RADIANCE 2.1f

/* Arrays of the studio's world. */
struct ball_arrays {
    struct vec3 positions[POINTS], normals[CORNERS];
    struct vec2 uvs[CORNERS];
    struct tri tris[TRIS];
    struct vec3 sky_texels[SKY_ROWS * SKY_COLUMNS];
};

/* ---- the studio ---- */

static void add_tri(struct material_ball *b, uint32_t v0, uint32_t v1,
                    uint32_t v2, uint32_t material)
{
    struct tri *t = &b->arrays->tris[b->studio.settings.tri_count];
    bool is_ball = material == BALL;

    *t = (struct tri){.v = {v0, v1, v2},
                      .vn = {NO_INDEX, NO_INDEX, NO_INDEX},
                      .vt = {NO_INDEX, NO_INDEX, NO_INDEX},
                      .material = material};
    for (int i = 0; i < 3 && is_ball; i++)
        t->vn[i] = t->vt[i] = t->v[i];
    if (triangle_normal(b->arrays->positions[v0], b->arrays->positions[v1],
                        b->arrays->positions[v2], &t->ng))
        b->studio.settings.tri_count++;
}

static void add_ball(struct material_ball *b)
{
    for (uint32_t i = 0; i < CORNERS; i++) {
        uint32_t row = i / (COLUMNS + 1), column = i % (COLUMNS + 1);
        double theta = angle_rad(180.0 * row / ROWS);
        double phi = angle_rad(360.0 * (column % COLUMNS) / COLUMNS);
        bool is_pole = row == 0 || row == ROWS;
        double s = is_pole ? 0 : sin(theta);

        b->arrays->normals[i] =
            v3((float)(s * sin(phi)), (float)cos(theta), (float)(s * cos(phi)));
        b->arrays->positions[i] = v3_scale(b->arrays->normals[i], RADIUS);
        b->arrays->uvs[i] =
            v2((float)column / COLUMNS * 2, 1.0f - (float)row / ROWS);
    }
    for (uint32_t row = 0; row < ROWS; row++) {
        for (uint32_t column = 0; column < COLUMNS; column++) {
            uint32_t a = row * (COLUMNS + 1) + column, c = a + COLUMNS + 1;

            add_tri(b, a, c, c + 1, BALL);
            add_tri(b, a, c + 1, a + 1, BALL);
        }
    }
}

static void add_floor(struct material_ball *b)
{
    for (uint32_t i = 0; i < FLOOR_POINTS; i++) {
        uint32_t column = i % (SQUARES + 1), row = i / (SQUARES + 1);
        float x = (float)column - 0.5f * SQUARES;
        float z = (float)row - 0.5f * SQUARES;

        b->arrays->positions[CORNERS + i] =
            v3(x * SQUARE_SIDE, -RADIUS, z * SQUARE_SIDE);
    }
    for (uint32_t z = 0; z < SQUARES; z++) {
        for (uint32_t x = 0; x < SQUARES; x++) {
            uint32_t a = CORNERS + z * (SQUARES + 1) + x, c = a + SQUARES + 1;
            uint32_t material = (x + z) % 2 == 0 ? FLOOR_LIGHT : FLOOR_DARK;

            add_tri(b, a, c, c + 1, material);
            add_tri(b, a, c + 1, a + 1, material);
        }
    }
}

/* Returns the radiance of the sky: lighter above, with a large light at the
 * upper left and a strip at the right, seen from the camera. */
static struct vec3 sky_radiance(double elevation_deg, double azimuth_deg)
{
    double side = remainder(azimuth_deg, 360);
    float grey =
        elevation_deg > 0 ? 0.35f + 0.004f * (float)elevation_deg : 0.15f;

    if (elevation_deg > 30 && elevation_deg < 70 && fabs(side + 50) < 35)
        return v3(9.0f, 8.8f, 8.4f);
    if (elevation_deg > 5 && elevation_deg < 60 && fabs(side - 75) < 12)
        return v3(3.2f, 3.6f, 4.2f);
    return v3(grey, grey, grey * 1.06f);
}

static bool add_sky(struct material_ball *b, struct error *err)
{
    struct world *w = &b->studio;

    for (int i = 0; i < SKY_ROWS * SKY_COLUMNS; i++) {
        int row = i / SKY_COLUMNS, column = i % SKY_COLUMNS;

        b->arrays->sky_texels[i] =
            sky_radiance(90 - 180 * (row + 0.5) / SKY_ROWS,
                         360 * (column + 0.5) / SKY_COLUMNS);
    }
    w->settings.sky = (struct sky){.color = v3(1.0f, 1.0f, 1.0f),
                                   .width = SKY_COLUMNS,
                                   .height = SKY_ROWS,
                                   .rotation_cos = 1.0f};
    w->sky_texels = b->arrays->sky_texels;
    if (!sky_table_build(&b->sky_table, b->arrays->sky_texels, SKY_COLUMNS,
                         SKY_ROWS, SKY_WITH_MIS, err))
        return false;
    sky_table_lend(&b->sky_table, w);
    return true;
}

/* Sets the camera in front of the ball, a little above it. */
static void set_camera(struct camera *camera)
{
    const float sine = 0.28f, cosine = 0.96f, distance = 4.0f, tangent = 0.15f;

    *camera = (struct camera){
        .eye = v3(0.0f, sine * distance, cosine * distance),
        .forward = v3(0.0f, -sine, -cosine),
        .right = v3(tangent, 0.0f, 0.0f),
        .up = v3(0.0f, cosine * tangent, -sine * tangent),
        .width = BALL_PIXELS,
        .height = BALL_PIXELS,
        .focus = distance,
    };
}

static struct material grey_material(float grey)
{
    struct material m = material_default();

    m.color = v3(grey, grey, grey);
    return m;
}

static bool open_studio(struct material_ball *b, struct error *err)
{
    struct world *w = &b->studio;

    b->arrays = alloc_array(1, sizeof *b->arrays);
    if (!b->arrays)
        return fail(err, "out of memory for the ball of the material");
    b->materials[FLOOR_LIGHT] = grey_material(0.6f);
    b->materials[FLOOR_DARK] = grey_material(0.08f);
    add_ball(b);
    add_floor(b);
    w->positions = b->arrays->positions;
    w->normals = b->arrays->normals;
    w->uvs = b->arrays->uvs;
    w->tris = b->arrays->tris;
    w->materials = b->materials;
    w->settings.position_count = POINTS;
    w->settings.normal_count = w->settings.uv_count = CORNERS;
    w->settings.material_count = BALL_MATERIALS;
    w->settings.max_vertices = VERTICES_MAX;
    w->settings.features = cpu_kernel_best()->features;
    set_camera(&w->settings.camera);
    if (!add_sky(b, err) || !bvh8_build(&b->tree, w, NULL, err))
        return false;
    bvh8_lend(&b->tree, &b->studio);
    b->kernel = cpu_kernel_best();
    return true;
}

/* ---- samples ---- */

static void lend_textures(struct world *to, const struct world *from)
{
    to->textures = from->textures;
    to->texels = from->texels;
    to->linear_of_srgb = from->linear_of_srgb;
    to->settings.texture_count = from->settings.texture_count;
    to->settings.texel_count = from->settings.texel_count;
}

static void add_row(struct material_ball *b, uint32_t y)
{
    struct sample_id ids[SAMPLE_BLOCK];
    struct path_sample samples[SAMPLE_BLOCK];
    struct first_surface surfaces[SAMPLE_BLOCK];

    for (uint32_t x = 0; x < BALL_PIXELS; x += SAMPLE_BLOCK) {
        struct vec3 *sums = &b->sums[y * BALL_PIXELS + x];

        for (uint32_t i = 0; i < SAMPLE_BLOCK; i++)
            ids[i] = (struct sample_id){x + i, y, b->spp};
        b->kernel->samples(&b->studio, ids, SAMPLE_BLOCK, samples, surfaces,
                           NULL);
        for (uint32_t i = 0; i < SAMPLE_BLOCK; i++)
            sums[i] = v3_add(sums[i], samples[i].radiance);
    }
}

_Static_assert(BALL_PIXELS % SAMPLE_BLOCK == 0, "see add_row()");

static void add_sample(struct material_ball *b)
{
    for (uint32_t y = 0; y < BALL_PIXELS; y++)
        add_row(b, y);
    b->spp++;
}

_Static_assert(BALL_SPP % SPP_TOGETHER == 0, "see material_ball_add()");

bool material_ball_is_done(const struct material_ball *b)
{
    return b->spp >= BALL_SPP;
}

static bool is_medium(const struct material *m)
{
    return !v3_is_zero(m->medium.scattering);
}

bool material_ball_add(struct material_ball *b, const struct world *world,
                       uint64_t textures, const struct material *material,
                       bool *is_new, struct error *err)
{
    int together = is_medium(material) ? 1 : SPP_TOGETHER;

    *is_new = false;
    if (!b->kernel && !open_studio(b, err)) {
        material_ball_free(b);
        return false;
    }
    if (memcmp(&b->materials[BALL], material, sizeof *material) != 0 ||
        b->textures != textures) {
        b->materials[BALL] = *material;
        b->studio.settings.has_boundaries = material->is_boundary;
        b->studio.settings.max_vertices =
            is_medium(material) ? COLLISIONS_MAX : VERTICES_MAX;
        b->textures = textures;
        b->spp = 0;
        memset(b->sums, 0, sizeof b->sums);
    }
    if (material_ball_is_done(b))
        return true;
    lend_textures(&b->studio, world);
    for (int i = 0; i < together; i++)
        add_sample(b);
    *is_new = b->spp == SPP_TOGETHER || material_ball_is_done(b);
    return true;
}

/* Exposes for what a white ball reflects and what this one emits, so that
 * neither is all white. */
void material_ball_paint(const struct material_ball *b, struct frame *frame)
{
    float white =
        WHITE_RADIANCE + v3_max_component(b->materials[BALL].emission);
    float scale = b->spp > 0 ? 1.0f / (white * (float)b->spp) : 0.0f;

    for (size_t i = 0; i < (size_t)BALL_PIXELS * BALL_PIXELS; i++) {
        struct vec3 c = v3_scale(b->sums[i], scale);

        frame->rgb[3 * i] = (uint8_t)srgb_byte(c.x);
        frame->rgb[3 * i + 1] = (uint8_t)srgb_byte(c.y);
        frame->rgb[3 * i + 2] = (uint8_t)srgb_byte(c.z);
    }
}

void material_ball_free(struct material_ball *b)
{
    bvh8_free(&b->tree);
    sky_table_free(&b->sky_table);
    free(b->arrays);
    *b = (struct material_ball){.kernel = NULL};
}
