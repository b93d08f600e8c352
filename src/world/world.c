// SPDX-License-Identifier: MIT
#include "world/world.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/geometry.h"
#include "base/memory.h"
#include "base/print.h"
#include "image/color.h"
#include "image/image_read.h"
#include "scene/material.h"
#include "world/bvh/instance_trees.h"
#include "world/camera_media.h"
#include "world/light/daylight.h"
#include "world/light/guide_grid.h"
#include "world/textures.h"
#include "world/world_smoke.h"
#include "kernels/instance.h"
#include "kernels/light.h"
#include "kernels/sky.h"

/* Limit for coordinates in float, whose squares do not overflow. */
#define EYE_MAX 1e18

/* Inverse of the shortest mean free path for which a walk below a surface is
 * more than its color. */
#define SUBSURFACE_MAX 1e4f

static struct vec3 scaled(const double v[3], double scale)
{
    return (struct vec3){(float)(v[0] * scale), (float)(v[1] * scale),
                         (float)(v[2] * scale)};
}

static bool make_camera(const struct scene *scene, const struct view *view,
                        struct camera *camera, struct error *err)
{
    const struct pose *pose = &view->pose;
    double tangent = tan(angle_rad(pose->fovy_deg) / 2);
    double focus = pose->focus == 0 ? pose_reach(pose) : pose->focus;
    double eye[3];
    struct axes axes;

    for (int k = 0; k < 3; k++) {
        eye[k] = (pose->eye[k] - scene->center[k]) * scene->scale;
        if (!(fabs(eye[k]) < EYE_MAX))
            return fail(err,
                        "camera: found eye %g %g %g, expected it nearer to the "
                        "scene",
                        pose->eye[0], pose->eye[1], pose->eye[2]);
    }
    pose_axes(pose, &axes);
    *camera = (struct camera){
        .eye = scaled(eye, 1),
        .width = (float)view->width_px,
        .height = (float)view->height_px,
        .forward = scaled(axes.forward, 1),
        .right = scaled(axes.right, tangent * view->width_px / view->height_px),
        .up = scaled(axes.up, tangent),
        .lens_radius = (float)fmin(pose->aperture / 2 * scene->scale, EYE_MAX),
        .focus = (float)fmin(fmax(focus * scene->scale, 1 / EYE_MAX), EYE_MAX),
    };
    return true;
}

/* ---- arrays ---- */

void world_renew(struct host_world *host, enum world_part part)
{
    static atomic_uint_fast64_t
        last; /* shared by all worlds; atomic since reloads have a thread */

    host->generation = atomic_fetch_add(&last, 1) + 1;
    host->versions[part] = host->generation;
}

static bool find_used_materials(struct host_world *host,
                                const struct scene *scene, struct error *err)
{
    host->material_is_used =
        alloc_array(scene->material_count, sizeof *host->material_is_used);
    if (host->material_is_used == NULL)
        return fail(err, "%s: out of memory for its materials", scene->path);
    for (uint32_t i = 0; i < scene->tri_count; i++)
        host->material_is_used[scene->tris[i].material] = true;
    for (uint32_t i = 0; i < scene->placed_count; i++)
        host->material_is_used[scene->placed[i].material] = true;
    return true;
}

/* Returns true if both textures show one image. */
static bool is_one_image(const struct scene *scene, uint32_t a, uint32_t b)
{
    return a != NO_INDEX && b != NO_INDEX &&
           scene->texture_origins[a].image == scene->texture_origins[b].image;
}

/* Converts the lengths of a material to normalised units. An image that gives
 * its colour and its opacity counts once. */
static struct material in_world(const struct scene *scene, struct material m)
{
    m.color_is_opaque = is_one_image(scene, m.color_texture, m.opacity_texture);
    m.medium = medium_scaled(m.medium, (float)(1 / scene->scale));
    if (f_min(m.medium.extinction.x,
              f_min(m.medium.extinction.y, m.medium.extinction.z)) >
            SUBSURFACE_MAX &&
        m.subsurface > 0) {
        m.subsurface = 0; /* light leaves where it has entered */
        m.medium = (struct medium){.base = 0};
    }
    return m;
}

struct material world_material(const struct scene *scene,
                               const struct material_values *source)
{
    struct warnings ignored = {0};
    struct material m = material_from_source(source, scene->path, &ignored);

    warnings_free(&ignored);
    return in_world(scene, m);
}

static bool copy_materials(struct host_world *host, const struct scene *scene,
                           struct error *err)
{
    uint32_t count = scene->material_count;

    host->materials = alloc_array(count, sizeof *host->materials);
    host->sources = alloc_array(count, sizeof *host->sources);
    if (host->materials == NULL || host->sources == NULL)
        return fail(err, "%s: out of memory for its materials", scene->path);
    for (uint32_t i = 0; i < count; i++) {
        host->materials[i] = in_world(scene, scene->materials[i]);
        host->sources[i] = scene->material_origins[i].source;
    }
    host->material_count = count;
    return true;
}

bool world_init(struct host_world *host, const struct scene *scene,
                int thread_count, struct warnings *report, struct error *err)
{
    struct world arrays;

    *host = (struct host_world){.thread_count = thread_count};
    for (int i = 0; i < WORLD_PARTS; i++)
        world_renew(host, (enum world_part)i);
    for (int i = 0; i < 256; i++)
        host->linear_of_srgb[i] = (float)color_decoded(i / 255.0);
    host->has_vertex_colors = scene->color_count > 0;
    host->has_vertex_alphas = scene->alphas != NULL;
    host->has_tangents = scene->tangents != NULL;
    host->has_instances = scene->placed_count > 0;
    if (!find_used_materials(host, scene, err) ||
        !copy_materials(host, scene, err) ||
        !textures_load(host, scene, report, err))
        return false;
    arrays = world_arrays(host, scene);
    return lights_build(&host->lights, &arrays, err);
}

/* Returns the path of the image that the view shows, or NULL. */
static const char *shown_sky(const struct view *view)
{
    return view->lighting.sun.is_on ? NULL : view->lighting.sky_path;
}

bool world_has_sky(const struct host_world *host, const struct view *view)
{
    const char *a = host->sky_path, *b = shown_sky(view);

    return (a == b || (a != NULL && b != NULL && strcmp(a, b) == 0)) &&
           sun_has_same_sky(&host->sun, &view->lighting.sun);
}

static bool read_sky(const struct host_world *host, const char *path,
                     struct image *image, struct warnings *report,
                     struct error *err)
{
    struct image_file file;
    uint64_t clamped_count = 0;

    if (!image_open(&file, path, IMAGE_LINEAR, textures_bytes(host), err) ||
        !image_decode(&file, image, &clamped_count, err))
        return false;
    if (clamped_count > 0)
        warnings_add(report, "skies with impossible values",
                     "%s: found %" PRIu64
                     " negative or infinite value%s: clamped",
                     path, clamped_count, print_plural(clamped_count));
    return true;
}

static bool make_sun_sky(const struct host_world *host, struct image *image,
                         struct error *err)
{
    struct pool *pool = world_pool(host);

    image->width = SUN_SKY_WIDTH;
    image->height = SUN_SKY_HEIGHT;
    image->rgb =
        (float *)(void *)sun_sky_create(SUN_SKY_WIDTH, SUN_SKY_HEIGHT,
                                        host->sun.elevation_deg,
                                        host->sun.turbidity, pool, err);
    pool_destroy(pool);
    return image->rgb != NULL;
}

/* Sets the sky that is tried from now on. */
static bool set_tried_sky(struct host_world *host, const struct view *view,
                          struct error *err)
{
    const char *path = shown_sky(view);

    free(host->sky_path);
    host->sky_path = path != NULL ? strdup(path) : NULL;
    host->sun = view->lighting.sun;
    return path == NULL || host->sky_path != NULL ||
           fail(err, "%s: out of memory", path);
}

bool world_load_sky(struct host_world *host, const struct view *view,
                    struct warnings *report, struct error *err)
{
    struct image image = {0};
    struct sky_table table = {0};

    if (!set_tried_sky(host, view, err) ||
        (host->sun.is_on && !make_sun_sky(host, &image, err)) ||
        (host->sky_path != NULL &&
         !read_sky(host, host->sky_path, &image, report, err)))
        return false;
    if (!sky_table_build(&table, (struct vec3 *)(void *)image.rgb,
                         (uint32_t)image.width, (uint32_t)image.height,
                         SKY_WITH_MIS, err)) {
        image_free(&image);
        return false;
    }
    free(host->sky_texels);
    sky_table_free(&host->sky_table);
    host->sky_table = table;
    /* the world owns the floats now; three of them are a vec3 */
    host->sky_texels = (struct vec3 *)(void *)image.rgb;
    host->sky_width = (uint32_t)image.width;
    host->sky_height = (uint32_t)image.height;
    image.rgb = NULL;
    image_free(&image);
    world_renew(host, WORLD_SKY);
    return true;
}

const struct tri *world_tris(const struct host_world *host,
                             const struct scene *scene)
{
    return host->tris != NULL ? host->tris : scene->tris;
}

const struct instance *world_instances(const struct host_world *host,
                                       const struct scene *scene)
{
    return host->instances != NULL ? host->instances : scene->placed;
}

struct world world_arrays(const struct host_world *host,
                          const struct scene *scene)
{
    const struct bvh8 *tree = world_tree(host);
    struct world w = {
        .positions = scene->positions,
        .normals = scene->normals,
        .uvs = scene->uvs,
        .uvs2 = scene->uvs2,
        .colors = scene->colors,
        .alphas = scene->alphas,
        .tangents = scene->tangents,
        .tris = world_tris(host, scene),
        .instances = world_instances(host, scene),
        .materials = host->materials,
        .textures = host->textures,
        .texels = host->texels,
        .linear_of_srgb = host->linear_of_srgb,
        .sky_texels = host->sky_texels,
        .point_lights = host->point_lights,
        .profiles = host->profiles,
        .directional_lights = host->directional_lights,
        .smokes = host->smokes,
        .voxel_places = host->voxel_places,
        .voxels = host->voxels,
        .glows = host->glows,
        .settings =
            {
                .tri_count = scene->tri_count,
                .instance_count = scene->placed_count,
                .position_count = scene->position_count,
                .normal_count = scene->normal_count,
                .uv_count = scene->uv_count,
                .uv2_count = scene->uvs2 != NULL ? scene->uv_count : 0,
                .color_count = scene->color_count,
                .alpha_count =
                    scene->alphas != NULL ? scene->position_count : 0,
                .tangent_count =
                    scene->tangents != NULL ? scene->normal_count : 0,
                .material_count = host->material_count,
                .texture_count = host->texture_count,
                .texel_count = (uint32_t)host->texel_count,
                .point_light_count = host->point_light_count,
                .profile_value_count = host->profile_value_count,
                .directional_light_count = host->directional_light_count,
                .smoke_count = host->smoke_count,
                .smoke_steps_max = SMOKE_STEPS_MAX,
                .voxel_place_count = host->voxel_place_count,
                .voxel_count = host->voxel_count,
                .glow_count = host->glow_count,
            },
    };

    if (tree != NULL)
        bvh8_lend(tree, &w);
    return w;
}

uint64_t world_features(const struct host_world *host)
{
    uint64_t features = host->sky_texels != NULL ? FEATURE_SKY_IMAGE : 0;

    if (host->guide.grid.table_count > 0)
        features |= FEATURE_GUIDE;
    if (host->point_light_count > 0)
        features |= FEATURE_POINT_LIGHTS;
    if (host->directional_light_count > 0)
        features |= FEATURE_DIRECTIONAL_LIGHTS;
    if (host->smoke_count > 0)
        features |= FEATURE_GRIDS | FEATURE_MEDIA;
    if (host->has_vertex_colors)
        features |= FEATURE_VERTEX_COLORS;
    if (host->has_vertex_alphas)
        features |= FEATURE_VERTEX_ALPHAS | FEATURE_COVERAGE;
    if (host->has_instances)
        features |= FEATURE_INSTANCES;
    for (uint32_t i = 0; i < host->material_count; i++)
        if (host->material_is_used[i])
            features |= material_features(&host->materials[i], host->textures);
    if ((features & FEATURE_MEDIA) != 0)
        features |= FEATURE_ATTENUATION;
    if (host->has_tangents && features_use_tangents(features))
        features |= FEATURE_TANGENTS;
    return features;
}

uint64_t view_features(const struct view *view)
{
    return fog_is_there(&view->lighting.fog)
               ? FEATURE_MEDIA | FEATURE_ATTENUATION
               : 0;
}

static bool has_boundaries(const struct host_world *host)
{
    for (uint32_t i = 0; i < host->material_count; i++)
        if (host->material_is_used[i] && host->materials[i].is_boundary != 0)
            return true;
    return false;
}

bool world_has_emitters(const struct host_world *host)
{
    for (uint32_t i = 0; i < host->material_count; i++)
        if (host->material_is_used[i] && material_shines(&host->materials[i]))
            return true;
    return false;
}

/* ---- tree ---- */

struct pool *world_pool(const struct host_world *host)
{
    struct error ignored;

    return host->thread_count > 1 ? pool_create(host->thread_count, &ignored)
                                  : NULL;
}

bool world_ensure_tree(struct host_world *host, struct world *world,
                       struct pool *pool, struct error *err)
{
    static pthread_mutex_t building = PTHREAD_MUTEX_INITIALIZER;
    bool ok;

    pthread_mutex_lock(&building);
    ok = world_tree(host) != NULL || bvh8_build(&host->tree, world, pool, err);
    if (ok)
        atomic_store(&host->has_tree, true);
    pthread_mutex_unlock(&building);
    if (ok)
        bvh8_lend(&host->tree, world);
    return ok;
}

const struct bvh8 *world_tree(const struct host_world *host)
{
    return atomic_load(&host->has_tree) ? &host->tree : NULL;
}

void world_drop_tree(struct host_world *host)
{
    atomic_store(&host->has_tree, false);
    bvh8_free(&host->tree);
}

void world_take_shape(struct host_world *host, struct host_world *from)
{
    host->versions[WORLD_SHAPE] = from->versions[WORLD_SHAPE];
    if (world_tree(from) == NULL)
        return;
    world_drop_tree(host);
    host->tree = from->tree;
    from->tree = (struct bvh8){0}; /* the other world owns it now */
    atomic_store(&from->has_tree, false);
    atomic_store(&host->has_tree, true);
}

/* ---- sky, guide ---- */

static struct sky make_sky(const struct host_world *host,
                           const struct view *view)
{
    const struct sun *sun = &view->lighting.sun;
    double angle = angle_rad(sun->is_on ? -sun->azimuth_deg
                                        : view->lighting.sky_rotation_deg);
    double one[3] = {1, 1, 1};
    struct sky sky = {
        .color = scaled(view->lighting.background, 1),
        .rotation_sin = (float)sin(angle),
        .rotation_cos = (float)cos(angle),
    };

    if (host->sky_texels != NULL) {
        sky.color = scaled(one, view->lighting.sky_strength);
        sky.width = host->sky_width;
        sky.height = host->sky_height;
    }
    return sky;
}

/* A height or a falloff beyond the reach of floats becomes the nearest of their
 * range. */
static struct medium make_fog(const struct scene *scene, const struct fog *f)
{
    double base = (f->base - scene->center[1]) * scene->scale;
    double falloff = f->falloff * scene->scale;
    struct medium m = {
        .scattering = scaled(f->scatter, 1 / scene->scale),
        .anisotropy = medium_anisotropy(f->anisotropy),
        .base = (float)fmax(fmin(base, EYE_MAX), -EYE_MAX),
        .falloff = f->falloff > 0
                       ? (float)fmin(fmax(falloff, 1 / EYE_MAX), EYE_MAX)
                       : 0,
    };

    m.extinction = v3_add(m.scattering, scaled(f->absorb, 1 / scene->scale));
    return medium_scaled(m, 1);
}

static bool aim_light_paths(struct host_world *host, struct world w,
                            struct error *err)
{
    struct pool *pool = world_pool(host);
    bool ok = world_ensure_tree(host, &w, pool, err);

    sky_table_lend(&host->sky_table, &w);
    if (ok)
        light_paths_aim(&host->light_paths, &w, pool);
    pool_destroy(pool);
    return ok;
}

/* Builds the tables of light paths unless they are current. Versions grow, so
 * that equal sums have equal parts. */
static bool find_light_paths(struct host_world *host, const struct world *w,
                             double sky_mean, struct error *err)
{
    uint64_t version =
        host->versions[WORLD_SHAPE] + host->versions[WORLD_TRIS] +
        host->versions[WORLD_MATERIALS] + host->versions[WORLD_LIGHTS] +
        host->versions[WORLD_DIRECTIONAL_LIGHTS] + host->versions[WORLD_SKY];

    if (host->light_paths_version == version &&
        host->light_paths_sky == sky_mean)
        return true;
    light_paths_free(&host->light_paths);
    if (!light_paths_build(&host->light_paths, w, &host->lights, sky_mean))
        return fail(err, "out of memory for light paths");
    if (host->light_paths.sources != NULL && !aim_light_paths(host, *w, err))
        return false;
    host->light_paths_version = version;
    host->light_paths_sky = sky_mean;
    return true;
}

bool world_guide(struct host_world *host, const struct scene *scene,
                 const struct view *view, struct error *err)
{
    struct world w = world_arrays(host, scene);
    struct path_guide *guide = &host->guide;
    double sky;
    bool had_table = path_guide_has_tables(guide);
    struct pool *pool = NULL;
    bool ok = true;

    w.settings.sky = make_sky(host, view);
    sky = color_mean(w.settings.sky.color);
    lights_lend(&host->lights, &w);
    if (host->sky_texels != NULL)
        sky *= host->sky_table.mean;
    if (((world_features(host) | view_features(view)) & FEATURE_MEDIA) != 0) {
        /* light paths do not know media that scatter, nor boundaries */
        light_paths_free(&host->light_paths);
        host->light_paths_version = 0;
    } else if (!find_light_paths(host, &w, sky, err)) {
        return false;
    }
    if (path_guide_is_current(guide, sky))
        return true;
    if (path_guide_needs_rays(guide, &w, sky)) {
        pool = world_pool(host);
        ok = world_ensure_tree(host, &w, pool, err);
    }
    ok = ok && path_guide_update(guide, &w, &host->lights, sky, pool, err);
    pool_destroy(pool);
    if (ok && (had_table || path_guide_has_tables(guide)))
        world_renew(host, WORLD_GUIDE);
    return ok;
}

bool world_lend(const struct host_world *host, const struct scene *scene,
                const struct view *view, uint32_t seed, struct world *world,
                struct error *err)
{
    struct world w = world_arrays(host, scene);

    w.settings.sky = make_sky(host, view);
    lights_lend(&host->lights, &w);
    sky_table_lend(&host->sky_table, &w);
    path_guide_lend(&host->guide, &w);
    w.settings.sky_level = host->light_paths.sources != NULL
                               ? host->light_paths.spots.level
                               : INFINITY;
    w.settings.max_vertices = view->max_bounces < 0
                                  ? PATH_HARD_STOP
                                  : (uint32_t)view->max_bounces + 1;
    w.settings.seed = seed;
    w.settings.features = world_features(host) | view_features(view);
    w.settings.fog = make_fog(scene, &view->lighting.fog);
    w.settings.has_boundaries = has_boundaries(host);
    if (!pose_check(&view->pose, "camera", err) ||
        !make_camera(scene, view, &w.settings.camera, err))
        return false;
    if ((w.settings.features & FEATURE_ATTENUATION) != 0)
        w.settings.camera_media = camera_media(&w, w.settings.camera.eye);
    *world = w;
    return true;
}

void world_free(struct host_world *host)
{
    free(host->sky_path);
    free(host->tris);
    free(host->instances);
    free(host->assigned);
    free(host->materials);
    free(host->sources);
    free(host->material_is_used);
    free(host->textures);
    free(host->texture_is_tried);
    free(host->texels);
    free(host->sky_texels);
    sky_table_free(&host->sky_table);
    free(host->point_lights);
    free(host->profiles);
    free(host->directional_lights);
    lights_free(&host->lights);
    path_guide_free(&host->guide);
    light_paths_free(&host->light_paths);
    bvh8_free(&host->tree);
    world_free_smokes(host);
    *host = (struct host_world){.tris = NULL};
}

/* ---- the list of arrays ---- */

_Static_assert(sizeof(struct world) - offsetof(struct world, positions) ==
                   WORLD_LIST_COUNT * sizeof(void *),
               "WORLD_LIST has all arrays");

void world_list(const struct world *w,
                struct world_array list[WORLD_LIST_COUNT])
{
    const struct settings *s = &w->settings;
    size_t i = 0;

#define TAKE(name, count, part_of)                                           \
    list[i++] = (struct world_array){w->name,                                \
                                     w->name != NULL                         \
                                         ? (size_t)(count) * sizeof *w->name \
                                         : 0,                                \
                                     part_of};
    WORLD_LIST(TAKE)
#undef TAKE
}

void world_list_set(struct world *world, enum world_list_index index,
                    const void *data)
{
#define MEMBER(name, count, part) offsetof(struct world, name),
    static const size_t members[] = {WORLD_LIST(MEMBER)};
#undef MEMBER

    memcpy((char *)world + members[index], &data, sizeof data);
}
