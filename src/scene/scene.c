// SPDX-License-Identifier: MIT
#include "scene/scene.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "picture/color.h"
#include "picture/image_read.h"
#include "scene/textures.h"
#include "kernels/hit.h"
#include "kernels/light.h"

/* Whether the triangle's edges span an area, computed in double. */
static bool has_area(const double a[3], const double b[3], const double c[3])
{
    double most = 0;
    double scale = 1;
    double e[3], f[3];
    int exponent;

    for (int k = 0; k < 3; k++)
        most = fmax(most, fmax(fabs(a[k]), fmax(fabs(b[k]), fabs(c[k]))));
    /* A power of two, so that nothing is rounded and no product overflows. */
    if (!(most > 1e-50 && most < 1e50)) {
        frexp(most, &exponent);
        scale = ldexp(1, exponent < -1000 ? 1000 : -exponent);
    }
    for (int k = 0; k < 3; k++) {
        e[k] = b[k] * scale - a[k] * scale;
        f[k] = c[k] * scale - a[k] * scale;
    }
    return e[1] * f[2] != e[2] * f[1] || e[2] * f[0] != e[0] * f[2] ||
           e[0] * f[1] != e[1] * f[0];
}

static bool is_finite(const double p[3])
{
    return isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
}

static bool file_tri_is_usable(const struct scene *scene, struct tri *t)
{
    const double *p[3];

    for (int k = 0; k < 3; k++) {
        p[k] = scene->file_positions + 3 * (size_t)t->v[k];
        if (!is_finite(p[k]))
            return false;
    }
    return has_area(p[0], p[1], p[2]);
}

/* Whether the triangle has a unit normal, which it is given. */
static bool tri_gets_normal(const struct scene *scene, struct tri *t)
{
    const struct vec3 *v[3];
    double p[3][3];

    for (int k = 0; k < 3; k++) {
        v[k] = &scene->positions[t->v[k]];
        p[k][0] = (double)v[k]->x;
        p[k][1] = (double)v[k]->y;
        p[k][2] = (double)v[k]->z;
    }
    return has_area(p[0], p[1], p[2]) &&
           triangle_normal(*v[0], *v[1], *v[2], &t->ng);
}

static void drop_tris(struct scene *scene, struct warnings *report,
                      bool (*is_usable)(const struct scene *, struct tri *))
{
    uint32_t kept = 0;

    for (uint32_t i = 0; i < scene->tri_count; i++) {
        if (!is_usable(scene, &scene->tris[i])) {
            warnings_add(report, "triangles without area",
                         "%s: found a triangle without area in face %" PRIu32
                         " of the file: triangle dropped",
                         scene->path, scene->tri_faces[i] + 1);
            continue;
        }
        scene->tris[kept] = scene->tris[i];
        scene->tri_faces[kept] = scene->tri_faces[i];
        scene->tri_objects[kept] = scene->tri_objects[i];
        kept++;
    }
    scene->dropped_count += scene->tri_count - kept;
    scene->tri_count = kept;
}

/* Bounds of the vertices that triangles use. */
static void find_bounds(struct scene *scene)
{
    double lo[3] = {INFINITY, INFINITY, INFINITY};
    double hi[3] = {-INFINITY, -INFINITY, -INFINITY};

    for (uint32_t i = 0; i < scene->tri_count; i++) {
        for (int c = 0; c < 3; c++) {
            size_t v = scene->tris[i].v[c];

            for (int k = 0; k < 3; k++) {
                double x = scene->file_positions[3 * v + (size_t)k];

                lo[k] = x < lo[k] ? x : lo[k];
                hi[k] = x > hi[k] ? x : hi[k];
            }
        }
    }
    for (int k = 0; k < 3; k++) {
        scene->bounds_lo[k] = scene->tri_count > 0 ? lo[k] : 0;
        scene->bounds_hi[k] = scene->tri_count > 0 ? hi[k] : 0;
    }
}

/* The centre, and the scale that brings the largest extent into [1, 2).
 * Halves first: no overflow. */
static void find_scale(struct scene *scene)
{
    double half = 0;
    int exponent;

    for (int k = 0; k < 3; k++) {
        double lo = scene->bounds_lo[k] / 2;
        double hi = scene->bounds_hi[k] / 2;

        scene->center[k] = lo + hi;
        half = fmax(half, hi - lo);
    }
    scene->scale = 1;
    if (half > 0) {
        frexp(half, &exponent);
        scene->scale = ldexp(1, exponent < -1000 ? 1000 : -exponent);
    }
}

/* Vertices that no triangle uses may be anywhere. */
static float normalized(double x, double center, double scale)
{
    float y = (float)((x - center) * scale);

    return isfinite(y) ? y : 0;
}

static bool fill_positions(struct scene *scene, struct error *err)
{
    free(scene->positions);
    scene->positions =
        alloc_array(scene->position_count, sizeof *scene->positions);
    if (scene->positions == NULL)
        return fail(err, "%s: out of memory for %" PRIu32 " vertices",
                    scene->path, scene->position_count);
    for (size_t i = 0; i < scene->position_count; i++) {
        const double *p = scene->file_positions + 3 * i;

        scene->positions[i] = (struct vec3){
            normalized(p[0], scene->center[0], scene->scale),
            normalized(p[1], scene->center[1], scene->scale),
            normalized(p[2], scene->center[2], scene->scale),
        };
    }
    free(scene->file_positions);
    scene->file_positions = NULL;
    return true;
}

static bool is_before(struct vec3 a, struct vec3 b)
{
    if (a.x != b.x)
        return a.x < b.x;
    return a.y != b.y ? a.y < b.y : a.z < b.z;
}

/* Every triangle begins with the corner that is first by its place: copies of a
 * face, wherever theirs begin and however they are wound, are met at the same
 * distance, and the first in the file is seen. */
static void turn_tris(struct scene *scene)
{
    for (uint32_t i = 0; i < scene->tri_count; i++) {
        struct tri *t = &scene->tris[i];
        const struct tri old = *t;
        uint32_t first = 0;

        for (uint32_t k = 1; k < 3; k++)
            if (is_before(scene->positions[old.v[k]],
                          scene->positions[old.v[first]]))
                first = k;
        for (uint32_t k = 0; k < 3; k++) {
            t->v[k] = old.v[(first + k) % 3];
            t->vn[k] = old.vn[(first + k) % 3];
            t->vt[k] = old.vt[(first + k) % 3];
        }
    }
}

static void fill_linear_of_srgb(float table[256])
{
    for (int i = 0; i < 256; i++)
        table[i] = (float)color_decoded(i / 255.0);
}

uint32_t scene_find_object(const struct scene *scene, const char *name)
{
    for (uint32_t i = 0; i < scene->object_count; i++)
        if (strcmp(scene->object_names[i], name) == 0)
            return i;
    return NO_INDEX;
}

void scene_find_emitters(struct scene *scene)
{
    scene->has_emitters = false;
    for (uint32_t i = 0; i < scene->material_count; i++)
        scene->has_emitters |=
            scene->material_is_used[i] && material_shines(&scene->materials[i]);
}

static bool find_used_materials(struct scene *scene, struct error *err)
{
    free(scene->material_is_used);
    scene->material_is_used =
        alloc_array(scene->material_count, sizeof *scene->material_is_used);
    if (scene->material_is_used == NULL)
        return fail(err, "%s: out of memory for its materials", scene->path);
    for (uint32_t i = 0; i < scene->tri_count; i++)
        scene->material_is_used[scene->tris[i].material] = true;
    scene_find_emitters(scene);
    return true;
}

struct world scene_arrays(const struct scene *scene)
{
    return (struct world){
        .positions = scene->positions,
        .normals = scene->normals,
        .uvs = scene->uvs,
        .tris = scene->tris,
        .materials = scene->materials,
        .textures = scene->textures,
        .texels = scene->texels,
        .linear_of_srgb = scene->linear_of_srgb,
        .sky_texels = scene->sky_texels,
        .settings =
            {
                .tri_count = scene->tri_count,
                .position_count = scene->position_count,
                .normal_count = scene->normal_count,
                .uv_count = scene->uv_count,
                .material_count = scene->material_count,
                .texture_count = scene->texture_count,
                .texel_count = (uint32_t)scene->texel_count,
            },
    };
}

uint64_t scene_geometry_bytes(const struct scene *s)
{
    return s->position_count * (uint64_t)sizeof *s->positions +
           s->normal_count * (uint64_t)sizeof *s->normals +
           s->uv_count * (uint64_t)sizeof *s->uvs +
           s->tri_count * (uint64_t)(sizeof *s->tris + sizeof *s->tri_faces +
                                     sizeof *s->tri_objects);
}

bool scene_finish(struct scene *scene, struct warnings *report,
                  struct error *err)
{
    struct world arrays;

    drop_tris(scene, report, file_tri_is_usable);
    find_bounds(scene);
    find_scale(scene);
    if (!fill_positions(scene, err))
        return false;
    turn_tris(scene);
    drop_tris(scene, report, tri_gets_normal);
    if (scene->tri_count == 0)
        warnings_add(
            report, "scenes without a face",
            "%s: found no visible face: only the background is rendered",
            scene->path);
    if (!find_used_materials(scene, err))
        return false;
    fill_linear_of_srgb(scene->linear_of_srgb);
    arrays = scene_arrays(scene);
    bvh8_free(&scene->tree);
    path_guide_outdate(&scene->guide);
    return lights_build(&scene->lights, &arrays, err);
}

bool scene_load_sky(struct scene *scene, const struct view *view,
                    struct warnings *report, struct error *err)
{
    struct image_file file;
    struct image image = {0};
    struct sky_table table = {0};
    uint64_t clamped_count = 0;

    if (view->lighting.sky_path != NULL &&
        (!image_open(&file, view->lighting.sky_path, IMAGE_LINEAR,
                     textures_bytes(scene), err) ||
         !image_decode(&file, &image, &clamped_count, err)))
        return false;
    if (clamped_count > 0)
        warnings_add(report, "skies with impossible values",
                     "%s: found %" PRIu64
                     " negative or infinite values: clamped",
                     view->lighting.sky_path, clamped_count);
    if (!sky_table_build(&table, (struct vec3 *)(void *)image.rgb,
                         (uint32_t)image.width, (uint32_t)image.height,
                         SKY_WITH_MIS, err)) {
        image_free(&image);
        return false;
    }
    /* not before: what has another address is known to be another array */
    free(scene->sky_texels);
    sky_table_free(&scene->sky_table);
    scene->sky_table = table;
    /* the scene owns the floats now, three of which are a vec3 */
    scene->sky_texels = (struct vec3 *)(void *)image.rgb;
    scene->sky_width = (uint32_t)image.width;
    scene->sky_height = (uint32_t)image.height;
    image.rgb = NULL;
    image_free(&image);
    return true;
}

static bool has_texture(const struct material *m)
{
    const uint32_t textures[] = {
        m->color_texture,  m->coat_texture,  m->emission_texture,
        m->alpha_texture,  m->metal_texture, m->opacity_texture,
        m->normal_texture, m->bump_texture,
    };

    for (size_t i = 0; i < sizeof textures / sizeof textures[0]; i++)
        if (textures[i] != NO_INDEX)
            return true;
    return false;
}

static bool has_holes(const struct scene *scene, uint32_t texture)
{
    return texture != NO_INDEX && scene->textures[texture].has_holes != 0;
}

uint32_t scene_material_features(const struct scene *scene,
                                 const struct material *m)
{
    bool is_metal = m->kind == MATERIAL_METAL || m->metal_texture != NO_INDEX;
    uint32_t features = 0;

    if (material_shines(m))
        features |= FEATURE_EMITTERS;
    if (has_texture(m))
        features |= FEATURE_TEXTURES;
    if (m->bump_texture != NO_INDEX || m->normal_texture != NO_INDEX)
        features |= FEATURE_BUMPS;
    if (m->opacity < 1 || has_holes(scene, m->color_texture) ||
        has_holes(scene, m->opacity_texture))
        features |= FEATURE_COVERAGE;
    if (is_metal)
        features |= FEATURE_METAL;
    if (m->kind == MATERIAL_GLASS || m->kind == MATERIAL_THIN_GLASS)
        features |= FEATURE_GLASS;
    if (m->kind == MATERIAL_PLASTIC)
        features |= FEATURE_PLASTIC;
    if (m->kind == MATERIAL_ROUGH_DIFFUSE)
        features |= FEATURE_ROUGH_DIFFUSE;
    else if ((is_metal || m->kind != MATERIAL_DIFFUSE) &&
             m->alpha >= ALPHA_SMOOTH)
        features |= FEATURE_ROUGH;
    return features;
}

uint32_t scene_features(const struct scene *scene)
{
    uint32_t features = scene->sky_texels != NULL ? FEATURE_SKY_IMAGE : 0;

    if (scene->guide.grid.table_count > 0)
        features |= FEATURE_GUIDE;
    for (uint32_t i = 0; i < scene->material_count; i++)
        if (scene->material_is_used[i])
            features |= scene_material_features(scene, &scene->materials[i]);
    return features;
}

static bool is_same_place(const struct scene *a, const struct scene *b)
{
    return a->scale == b->scale &&
           memcmp(a->center, b->center, sizeof a->center) == 0 &&
           a->position_count == b->position_count &&
           memcmp(a->positions, b->positions,
                  a->position_count * sizeof *a->positions) == 0;
}

bool scene_has_same_shape(const struct scene *a, const struct scene *b)
{
    if (a->tri_count != b->tri_count || !is_same_place(a, b))
        return false;
    for (uint32_t i = 0; i < a->tri_count; i++) {
        if (memcmp(a->tris[i].v, b->tris[i].v, sizeof a->tris[i].v) != 0)
            return false;
    }
    return true;
}

static void free_strings(char **strings, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        free(strings[i]);
    free(strings);
}

void scene_free(struct scene *scene)
{
    free(scene->path);
    free(scene->file_positions);
    free(scene->positions);
    free(scene->normals);
    free(scene->uvs);
    free(scene->tris);
    free(scene->tri_faces);
    free(scene->tri_objects);
    free(scene->file_materials);
    free(scene->assigned);
    free_strings(scene->object_names, scene->object_count);
    free(scene->materials);
    free(scene->material_is_used);
    free(scene->material_origins);
    free_strings(scene->material_names, scene->material_count);
    free_strings(scene->mtl_paths, scene->mtl_path_count);
    free(scene->textures);
    free(scene->texture_is_tried);
    free(scene->texture_origins);
    free_strings(scene->texture_paths, scene->texture_count);
    free(scene->texels);
    free(scene->sky_texels);
    lights_free(&scene->lights);
    sky_table_free(&scene->sky_table);
    path_guide_free(&scene->guide);
    bvh8_free(&scene->tree);
    memset(scene, 0, sizeof *scene);
}
