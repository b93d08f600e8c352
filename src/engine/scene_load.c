// SPDX-License-Identifier: MIT
#include "engine/scene_load.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/decimal.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/name_table.h"
#include "base/thread_pool.h"
#include "engine/smoke_load.h"
#include "film/film.h"
#include "image/color.h"
#include "read/child/import.h"
#include "read/child/voxel_file.h"
#include "read/gltf/gltf.h"
#include "read/gltf/gltf_draco.h"
#include "read/mtl.h"
#include "read/obj.h"
#include "read/ply.h"
#include "read/ply_file.h"
#include "read/stl.h"
#include "read/text_file.h"
#include "read/view_file.h"
#include "render/cpu_dispatch.h"
#include "scene/pose_fit.h"
#include "world/world_lamps.h"

/* ---- what a model shows by its own light ---- */

/* Pixels of the small picture, samples of each, and bounces of a path. */
#define PROBE_PIXELS  1024
#define PROBE_SAMPLES 4
#define PROBE_BOUNCES 6
#define PROBE_SIDE    256

/* Luminance from which a pixel is not black: 16 of 255 in sRGB. */
#define SHOWN_LUMINANCE 0.005

/* Light suffices if it shows a quarter of what the added light would show, or
 * makes a sixteenth of the luminance. A diode on a board does neither; a lamp
 * in a hall shows much, dimly, and a spot light little, brightly. */
#define SHOWN_SHARE (1 / 4.0)
#define MEAN_SHARE  (1 / 16.0)

struct probe_job {
    struct world w;
    const struct cpu_kernel *kernel;
    int width;
    double exposure;
    bool counts_seen;
    const float *light;                  /* of light paths, or NULL */
    struct light_probe rows[PROBE_SIDE]; /* sums */
};

/* Light paths of each half. */
#define PROBE_PATHS 4096

/* Returns the light that light paths bring to the picture, for free(), or NULL
 * if there are none. Paths from the eye then leave it out. */
static float *light_of_paths(struct probe_job *j, const struct host_world *host,
                             int height, struct pool *pool)
{
    size_t pixels = (size_t)j->width * (size_t)height;
    struct light_paths paths = {.sources = NULL};
    struct light_image image = {.width = 0};
    const struct cancel never = {0};
    float *means = NULL;
    double sky_mean =
        host->sky_table.mean * color_mean(j->w.settings.sky.color);

    bool ok = light_paths_build(&paths, &j->w, &host->lights, sky_mean) &&
              paths.sources != NULL &&
              light_image_init(&image, j->width, height);

    if (ok)
        light_paths_aim(&paths, &j->w, pool);
    if (ok && light_paths_trace(&paths, &j->w, 0, PROBE_PATHS, pool, &never,
                                (struct light_film){&image, NULL}))
        means = alloc_array(pixels, 6 * sizeof *means);
    if (means != NULL) {
        light_image_means(&image, PROBE_PATHS, means);
        for (size_t i = 0; i < 3 * pixels; i++)
            means[i] = 0.5f * (means[i] + means[3 * pixels + i]);
        j->w.settings.has_light_paths = 1;
        j->w.settings.sky_level = paths.spots.level;
        j->w.settings.features |= FEATURE_LIGHT_PATHS;
    }
    light_image_free(&image);
    light_paths_free(&paths);
    return means;
}

static void add_pixel(const struct probe_job *j, uint32_t x, uint32_t y,
                      struct light_probe *sum)
{
    struct sample_id places[PROBE_SAMPLES];
    struct path_sample samples[PROBE_SAMPLES];
    struct first_surface surfaces[PROBE_SAMPLES];
    const float *light = j->light != NULL
                             ? j->light + 3 * ((size_t)y * (size_t)j->width + x)
                             : NULL;
    double luminance = 0;

    for (uint32_t i = 0; i < PROBE_SAMPLES; i++)
        places[i] = (struct sample_id){x, y, i};
    j->kernel->samples(&j->w, places, PROBE_SAMPLES, samples, surfaces, NULL);
    for (int i = 0; i < PROBE_SAMPLES; i++) {
        struct vec3 c = j->counts_seen
                            ? samples[i].radiance
                            : v3_sub(samples[i].radiance, surfaces[i].seen);
        double y_of;

        if (light != NULL)
            c = v3_add(c, v3(light[0], light[1], light[2]));
        y_of =
            0.2126 * (double)c.x + 0.7152 * (double)c.y + 0.0722 * (double)c.z;

        luminance += fmax(0, fmin(y_of * j->exposure, 1)) / PROBE_SAMPLES;
    }
    sum->mean += luminance;
    sum->shown += luminance >= SHOWN_LUMINANCE;
}

static void probe_row(void *context, uint32_t y, int worker)
{
    struct probe_job *j = context;

    (void)worker;
    for (int x = 0; x < j->width; x++)
        add_pixel(j, (uint32_t)x, y, &j->rows[y]);
}

/* Makes a view of about PROBE_PIXELS pixels, through a pinhole. */
static struct view small_view(const struct view *view)
{
    struct view small = *view;
    double aspect = (double)view->width_px / view->height_px;
    double height = fmin(fmax(sqrt(PROBE_PIXELS / aspect), 1), PROBE_SIDE);

    small.height_px = (int)height;
    small.width_px = (int)fmin(fmax(PROBE_PIXELS / (double)small.height_px, 1),
                               PROBE_PIXELS);
    small.pose.aperture = 0;
    if (small.max_bounces < 0 || small.max_bounces > PROBE_BOUNCES)
        small.max_bounces = PROBE_BOUNCES;
    return small;
}

bool light_probe_take(struct light_probe *probe, struct host_world *host,
                      const struct scene *scene, const struct view *view,
                      bool counts_seen, struct error *err)
{
    struct view small = small_view(view);
    struct probe_job j = {.kernel = cpu_kernel_best(),
                          .width = small.width_px,
                          .exposure = exp2(view->lighting.exposure),
                          .counts_seen = counts_seen};
    struct pool *pool;
    float *light = NULL;
    bool ok;

    if (!world_lend(host, scene, &small, 0, &j.w, err))
        return false;
    pool = world_pool(host);
    ok = world_ensure_tree(host, &j.w, pool, err);
    if (ok) {
        j.w.settings.features |= FEATURE_FILTER;
        j.w.settings.smoke_steps_max = SMOKE_STEPS_FEW;
        j.light = light = light_of_paths(&j, host, small.height_px, pool);
        pool_each(pool, (uint32_t)small.height_px, probe_row, &j);
    }
    pool_destroy(pool);
    free(light);
    *probe = (struct light_probe){0, 0};
    for (int y = 0; y < small.height_px; y++) {
        probe->mean += j.rows[y].mean;
        probe->shown += j.rows[y].shown;
    }
    probe->mean /= (double)small.width_px * small.height_px;
    probe->shown /= (double)small.width_px * small.height_px;
    return ok;
}

bool light_probe_suffices(const struct light_probe *own,
                          const struct light_probe *with)
{
    return own->mean > MEAN_SHARE * with->mean ||
           own->shown > SHOWN_SHARE * with->shown;
}

/* ---- scenes ---- */

/* ---- formats ---- */

/* The first row is that of files that no row recognises. */
static const struct scene_format formats[] = {
    {"Wavefront OBJ", "obj", "y up, with MTL files and images", NULL, obj_parse,
     false, NULL},
    {"PLY", "ply", "y up, z from Blender; ascii and binary", ply_matches,
     ply_parse, false, NULL},
    {"glTF", "gltf glb", "y up; version 2.0, with buffers, images and Draco",
     gltf_matches, gltf_parse, true, gltf_draco_missing},
    {"STL", "stl", "z up; ascii and binary", stl_matches, stl_parse, false,
     NULL},
    {"voxels", "vdb npy", "y up; smoke of OpenVDB and NumPy files",
     voxel_file_matches, voxel_scene_parse, false, NULL},
    {"others", import_endings, "FBX, COLLADA, 3DS, X3D and more, by libassimp",
     NULL, import_parse, false, import_missing},
};

enum { FORMAT_COUNT = sizeof formats / sizeof formats[0] };

const struct scene_format *scene_format_number(uint32_t number)
{
    return number < FORMAT_COUNT ? &formats[number] : NULL;
}

/* Returns the length of the name without .gz. */
static size_t unpacked_length(const char *name)
{
    size_t length = strlen(name);

    return length > 3 && strcasecmp(name + length - 3, ".gz") == 0 ? length - 3
                                                                   : length;
}

static bool has_ending(const struct scene_format *f, const char *path)
{
    size_t length = unpacked_length(path);
    const char *p = f->endings;

    while (*p != '\0') {
        size_t n = strcspn(p, " ");

        if (length > n && path[length - n - 1] == '.' &&
            strncasecmp(path + length - n, p, n) == 0)
            return true;
        p += n;
        p += strspn(p, " ");
    }
    return false;
}

const struct scene_format *scene_format_named(const char *path)
{
    for (int i = 0; i < FORMAT_COUNT; i++)
        if (has_ending(&formats[i], path))
            return &formats[i];
    return NULL;
}

const struct scene_format *scene_format_of(const char *path, const char *bytes,
                                           size_t size_bytes)
{
    const struct scene_format *named;

    for (int i = 0; i < FORMAT_COUNT; i++)
        if (formats[i].matches != NULL && formats[i].matches(bytes, size_bytes))
            return &formats[i];
    named = scene_format_named(path);
    return named != NULL ? named : &formats[0];
}

/* ---- scenes ---- */

/* Radiance of the soft sky: an overcast noon, bright enough for exposure 0. */
static const double soft_sky[3] = {0.7, 0.8, 0.9};

/* Radiance of the sky and irradiance of the lamp of a model. Together they give
 * clay 0.75 of white where it faces the lamp. */
static const double studio_sky[3] = {0.35, 0.37, 0.4};
static const double studio_lamp[3] = {2.6, 2.5, 2.35};

/* Makes a matrix that maps z-up space to itself map y-up space to itself. */
static void turn_matrix(struct affine *a)
{
    for (int k = 0; k < 4; k++) {
        double y = a->m[1][k];

        a->m[1][k] = a->m[2][k];
        a->m[2][k] = -y;
    }
    for (int i = 0; i < 3; i++) {
        double y = a->m[i][1];

        a->m[i][1] = a->m[i][2];
        a->m[i][2] = -y;
    }
}

static void turn_vector(double v[3])
{
    double y = v[1];

    v[1] = v[2];
    v[2] = -y;
}

static void turn_float(struct vec3 *v)
{
    float y = v->y;

    v->y = v->z;
    v->z = -y;
}

static void turn_lamp(struct lamp *lamp)
{
    double d[3];

    turn_vector(lamp->position);
    turn_vector(lamp->at);
    lamp_direction(lamp, d);
    turn_vector(d);
    lamp_set_direction(lamp, d);
}

static void turn_bounds(double low[3], double high[3])
{
    double y = low[1];

    low[1] = low[2];
    low[2] = -high[1];
    high[1] = high[2];
    high[2] = -y;
}

static void turn_z_up(struct scene *scene)
{
    for (size_t i = 0; i < scene->position_count; i++)
        turn_vector(scene->file_positions + 3 * i);
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        struct pose *pose = &scene->cameras[i].pose;

        turn_vector(pose->eye);
        turn_vector(pose->at);
        turn_vector(pose->up);
    }
    for (uint32_t i = 0; i < scene->lamps.count; i++)
        turn_lamp(&scene->lamps.items[i]);
    for (size_t i = 0; i < scene->normal_count; i++)
        turn_float(&scene->normals[i]);
    for (size_t i = 0; scene->tangents != NULL && i < scene->normal_count; i++)
        turn_float(&scene->tangents[i].d);
    for (uint32_t i = 0; i < scene->instances.count; i++)
        turn_matrix(&scene->instances.items[i].matrix);
    for (uint32_t i = 0; i < scene->smokes.count; i++)
        scene->smokes.items[i].up_is_z = true;
    turn_bounds(scene->bounds_lo, scene->bounds_hi);
}

static bool read_file(struct scene *scene, const char *path,
                      struct warnings *report, struct error *err)
{
    const struct scene_choice *c = &scene->choice;
    const struct scene_format *f;
    char *bytes;
    size_t size_bytes;
    bool ok;

    if (!text_file_read(path, &bytes, &size_bytes, err))
        return false;
    f = scene_format_of(path, bytes, size_bytes);
    scene->has_choices = f->has_choices;
    if (!f->has_choices &&
        (c->scene || c->animation || c->variant || c->has_time))
        warnings_add(report, "choices without effect",
                     "%s: found no scenes, variants or animations, which "
                     "%s does not have: the options for them have no effect",
                     path, f->name);
    ok = f->parse(scene, bytes, size_bytes, path, report, err);
    free(bytes);
    return ok;
}

/* Moves the point that a camera looks at to the depth of the scene's centre:
 * files only say its direction. */
static void look_at_center(const struct scene *scene, struct pose *pose)
{
    double forward[3], way[3], depth;

    vec3d_sub(pose->at, pose->eye, forward);
    for (int i = 0; i < 3; i++)
        way[i] =
            scene->bounds_lo[i] / 2 + scene->bounds_hi[i] / 2 - pose->eye[i];
    if (!vec3d_normalize(forward))
        return;
    depth = vec3d_dot(forward, way);
    for (int i = 0; depth > 0 && isfinite(depth) && i < 3; i++)
        pose->at[i] = pose->eye[i] + depth * forward[i];
}

bool scene_load(struct scene *scene, const char *path, enum scene_up up,
                struct warnings *report, struct error *err)
{
    if (!read_file(scene, path, report, err))
        return false;
    if (up == SCENE_UP_Z || (up == SCENE_UP_OF_FILE && scene->up_is_z))
        turn_z_up(scene);
    if (!scene_finish(scene, report, err))
        return false;
    for (uint32_t i = 0; i < scene->camera_count; i++)
        look_at_center(scene, &scene->cameras[i].pose);
    return true;
}

/* ---- the view ---- */

/* Reads a view file if it exists and sets *is_there. It is an error if it
 * exists but cannot be read. */
static bool read_if_there(struct view *view, const char *path, bool *is_there,
                          struct warnings *report, struct error *err)
{
    *is_there = access(path, F_OK) == 0;
    return !*is_there || view_read(view, path, report, err);
}

/* Reads STEM.view, or camera.txt beside the scene if there is no such file. */
static bool read_beside(struct view *view, const char *scene_path,
                        const char *path, struct warnings *report,
                        struct error *err)
{
    bool is_there;
    bool ok = read_if_there(view, path, &is_there, report, err);
    char *camera;

    if (!ok || is_there)
        return ok;
    camera = path_beside(scene_path, "camera.txt");
    if (camera == NULL)
        return fail(err, "%s: out of memory", scene_path);
    ok = read_if_there(view, camera, &is_there, report, err);
    free(camera);
    return ok;
}

/* Returns STEM.view for free(), or NULL when memory is out. */
static char *path_of_view(const char *scene_path)
{
    char *stem = path_stem_of_input(scene_path);
    char *path = stem != NULL ? format_text("%s.view", stem) : NULL;

    free(stem);
    return path;
}

bool view_find(struct view *view, const char *scene_path, const char *view_path,
               char **path, struct warnings *report, struct error *err)
{
    *path = view_path != NULL ? strdup(view_path) : path_of_view(scene_path);
    if (*path == NULL)
        return fail(err, "%s: out of memory", scene_path);
    return view_path != NULL
               ? view_read(view, *path, report, err)
               : read_beside(view, scene_path, *path, report, err);
}

/* ---- cameras ---- */

/* Returns the pose of a camera by its number, from 1, or NULL. The numbered
 * poses of the view go before the scene's cameras. */
static const struct pose *numbered_pose(const struct scene *scene,
                                        const struct view *view,
                                        uint64_t number)
{
    if (number >= 1 && number <= VIEW_SHOTS && view->has_shot[number - 1])
        return &view->shots[number - 1];
    return number >= 1 && number <= scene->camera_count
               ? &scene->cameras[number - 1].pose
               : NULL;
}

static const struct pose *named_pose(const struct scene *scene,
                                     const char *name)
{
    for (uint32_t i = 0; i < scene->camera_count; i++)
        if (strcmp(scene->cameras[i].name, name) == 0)
            return &scene->cameras[i].pose;
    return NULL;
}

/* Fails with the cameras that there are. */
static bool fail_camera(const struct scene *scene, const struct view *view,
                        const char *wanted, struct error *err)
{
    char known[256] = "";
    size_t length = 0;

    for (uint32_t i = 1; i <= VIEW_SHOTS || i <= scene->camera_count; i++) {
        const char *name =
            i <= scene->camera_count ? scene->cameras[i - 1].name : "";

        if (numbered_pose(scene, view, i) == NULL || length > sizeof known / 2)
            continue;
        length +=
            (size_t)snprintf(known + length, sizeof known - length,
                             "%s%" PRIu32 "%s%.60s", length > 0 ? ", " : "", i,
                             *name != '\0' ? " " : "", name);
    }
    return fail(err, "%s: found no camera '%s', expected %s%s", scene->path,
                wanted, length > 0 ? "one of " : "a numbered view",
                length > 0 ? known : " in its view file");
}

/* Gives the view the camera of the options, or the first one of the scene if
 * the view has none. */
static bool choose_camera(const struct scene *scene, const char *wanted,
                          struct view *view, struct error *err)
{
    const char *p = wanted;
    const struct pose *pose = NULL;
    uint64_t number;

    if (wanted == NULL && (view->has_camera || scene->camera_count == 0))
        return true;
    if (wanted == NULL)
        pose = &scene->cameras[0].pose;
    else if (digits_parse(&p, 10, UINT32_MAX, &number) && *p == '\0')
        pose = numbered_pose(scene, view, number);
    if (pose == NULL)
        pose = named_pose(scene, wanted);
    if (pose == NULL)
        return fail_camera(scene, view, wanted, err);
    view->pose = *pose;
    view->has_camera = true;
    return true;
}

/* ---- the scene with its view ---- */

bool view_has_soft_sky(const struct view *view)
{
    const struct lighting *l = &view->lighting;

    return !l->has_background &&
           memcmp(l->background, soft_sky, sizeof soft_sky) == 0;
}

static bool has_lamps(const struct host_world *host)
{
    return host->point_light_count + host->directional_light_count > 0;
}

/* Radiance up to which surfaces of models glow, but claim to be no lamps: that
 * of emissiveFactor in glTF. */
#define GLOW_MAX 1.0f

static bool claims_lamps(const struct host_world *host)
{
    for (uint32_t i = 0; i < host->material_count; i++)
        if (host->material_is_used[i] &&
            v3_max_component(host->materials[i].emission) > GLOW_MAX)
            return true;
    return has_lamps(host);
}

/* Lights a scene with a soft sky, and a model as a studio does: by a large lamp
 * above the camera's shoulder and a dim sky, as under the soft sky alone the
 * shape of clay is hardly visible. */
static bool add_light(const struct scene *scene, struct host_world *host,
                      struct view *view, struct error *err)
{
    struct lighting *light = &view->lighting;
    struct lamp lamp;

    memcpy(light->background, scene->is_model ? studio_sky : soft_sky,
           sizeof light->background);
    if (!scene->is_model)
        return true;
    light->has_background = true; /* written with the lamp */
    lamp_init(&lamp, LAMP_DIRECTIONAL);
    memcpy(lamp.rgb, studio_lamp, sizeof studio_lamp);
    lamp.azimuth_deg = 190;
    lamp.elevation_deg = 40;
    lamp.angle_deg = 25;
    return lamps_add(&view->lamps, &lamp)
               ? world_set_lamps(host, scene, view, err)
               : fail(err, "%s: out of memory for its light", scene->path);
}

static bool remove_light(const struct scene *scene, struct host_world *host,
                         struct view *view, struct error *err)
{
    memset(view->lighting.background, 0, sizeof view->lighting.background);
    view->lighting.has_background = false;
    if (!scene->is_model)
        return true;
    lamps_remove(&view->lamps, (uint32_t)view->lamps.count - 1);
    return world_set_lamps(host, scene, view, err);
}

/* Adds light to a scene whose own light does little for what the camera sees.
 * Only models get it: what else has lamps is meant to be as dark as it is. */
static bool help_light(const struct scene *scene, struct host_world *host,
                       struct view *view, struct warnings *report,
                       struct error *err)
{
    struct light_probe own, with;
    bool is_model = scene->is_model;
    bool has_own_lamps = claims_lamps(host);

    if (!light_probe_take(&own, host, scene, view, !is_model, err) ||
        !add_light(scene, host, view, err) ||
        !light_probe_take(&with, host, scene, view, false, err))
        return false;
    if (light_probe_suffices(&own, &with))
        return remove_light(scene, host, view, err);
    if (is_model ? has_own_lamps : with.shown > 0)
        warnings_add(report, SCENE_LITTLE_LIGHT,
                     "%s: found that its own light shows %.0f %% of what the "
                     "camera sees: %s",
                     scene->path,
                     with.shown > 0 ? 100 * own.shown / with.shown : 0,
                     is_model ? "lit as a studio; 'background 0 0 0' in the "
                                "view file leaves its own light alone"
                              : "not lit by a sky; 'background .7 .8 .9' in "
                                "the view file adds one");
    return is_model || remove_light(scene, host, view, err);
}

/* Lights a scene without a sky that has too little light of its own. */
static bool complete_light(const struct scene *scene, struct host_world *host,
                           struct view *view, bool has_view_lamps,
                           struct warnings *report, struct error *err)
{
    const struct lighting *light = &view->lighting;

    bool is_empty = scene->tri_count == 0 && host->smoke_count == 0;

    if (is_empty || light->has_background || host->sky_texels || has_view_lamps)
        return true;
    if (world_has_emitters(host) || has_lamps(host) || host->glow_count > 0)
        return help_light(scene, host, view, report, err);
    if (!scene->is_model)
        warnings_add(report, "scenes without light",
                     "%s: found no light: lit by a soft sky", scene->path);
    return add_light(scene, host, view, err);
}

/* Sums over the faces of solid glass of an object. */
struct glass_body {
    uint32_t count;   /* of corners */
    double middle[3]; /* of the corners: first their sum */
    double volume;    /* six times it, by the winding, seen from the middle */
    double area;      /* twice it */
    double open[3];   /* vectors of the faces, which cancel in closed bodies */
    double radius;    /* largest distance of a corner from the middle */
};

static void add_corners(const struct scene *scene, const struct tri *t,
                        struct glass_body *b)
{
    for (int k = 0; k < 3; k++) {
        struct vec3 p = scene->positions[t->v[k]];

        b->middle[0] += (double)p.x;
        b->middle[1] += (double)p.y;
        b->middle[2] += (double)p.z;
        b->count++;
    }
}

static void add_glass_face(const struct scene *scene, const struct tri *t,
                           struct glass_body *b)
{
    struct vec3 from =
        v3((float)(b->middle[0] / b->count), (float)(b->middle[1] / b->count),
           (float)(b->middle[2] / b->count));
    struct vec3 p[3], across;

    for (int k = 0; k < 3; k++) {
        p[k] = v3_sub(scene->positions[t->v[k]], from);
        b->radius = fmax(b->radius, (double)v3_length(p[k]));
    }
    across = v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]));
    b->volume += (double)v3_dot(p[0], across);
    b->area += (double)v3_length(across);
    b->open[0] += (double)across.x;
    b->open[1] += (double)across.y;
    b->open[2] += (double)across.z;
}

/* Least thickness of a body, as part of its radius. */
#define BODY_MIN 1e-4

/* True if the body has less than no volume, whatever closes its openings. */
static bool is_inverted(const struct glass_body *b)
{
    double open = hypot(hypot(b->open[0], b->open[1]), b->open[2]);

    return b->count > 0 && b->volume < -(open + BODY_MIN * b->area) * b->radius;
}

/* Says which bodies of glass are wound inwards: for light their inside is the
 * air, and lamps hardly shine through. */
static bool tell_inverted_glass(const struct scene *scene,
                                const struct host_world *host,
                                struct warnings *report, struct error *err)
{
    const struct tri *tris = world_tris(host, scene);
    struct glass_body *bodies =
        alloc_array(scene->object_count, sizeof *bodies);

    if (bodies == NULL)
        return fail(err, "%s: out of memory", scene->path);
    for (int turn = 0; turn < 2; turn++)
        for (uint32_t i = 0; i < scene->tri_count; i++)
            if (host->materials[tris[i].material].kind == MATERIAL_GLASS)
                (turn == 0 ? add_corners
                           : add_glass_face)(scene, &tris[i],
                                             &bodies[scene->tri_objects[i]]);
    for (uint32_t i = 0; i < scene->object_count; i++)
        if (is_inverted(&bodies[i]))
            warnings_add_named(report, "glass that is wound inwards",
                               scene->object_names[i],
                               "%s: found glass whose faces are wound inwards "
                               "(object '%s'), so that light takes its inside "
                               "for air: turn the faces around",
                               scene->path, scene->object_names[i]);
    free(bodies);
    return true;
}

/* Adds a camera and light to scenes without them. */
static bool complete_view(const struct scene *scene, struct host_world *host,
                          struct view *view, bool has_view_lamps,
                          struct warnings *report, struct error *err)
{
    if (!view->has_camera)
        scene_frame(scene, view);
    if (!pose_check(&view->pose, scene->path, err) ||
        !complete_light(scene, host, view, has_view_lamps, report, err))
        return false;
    if (pose_up_is_parallel(&view->pose))
        warnings_add(report, "views along their up",
                     "%s: found the camera's up along its view: took another "
                     "axis for it",
                     scene->path);
    return true;
}

/* Gives the view the lamps of the scene if it has none, in the unit that the
 * view says. */
static bool take_lamps(const struct scene *scene, struct view *view,
                       struct warnings *report, struct error *err)
{
    if (view->lamps.count > 0 || scene->lamps.count == 0)
        return true;
    if (!lamps_copy(&view->lamps, &scene->lamps))
        return fail(err, "%s: out of memory for its lights", scene->path);
    if (scene->light_unit != LIGHT_UNIT_OF_FILE &&
        view->light_unit != LIGHT_UNIT_OF_FILE)
        lamps_change_unit(&view->lamps, scene->light_unit,
                          (enum light_unit)view->light_unit);
    else if (scene->light_unit_is_guessed)
        warnings_add(report, "lights of an unknown unit",
                     "%s: found lights of a unit that the file does not tell, "
                     "read as '%s': 'light_unit' lumen, watt or none in the "
                     "view file, or --light-unit, sets it",
                     scene->path, light_units[scene->light_unit]);
    return true;
}

/* Gives the view the smokes of the scene if it has none. */
static bool take_smokes(const struct scene *scene, struct view *view,
                        struct error *err)
{
    return view->smokes.count > 0 ||
           smokes_copy(&view->smokes, &scene->smokes) ||
           fail(err, "%s: out of memory for its smoke", scene->path);
}

/* Adds the files of the lamps' profiles to those of the scene, each once. */
static bool add_profile_paths(struct scene *scene, const struct lamps *lamps,
                              struct error *err)
{
    struct name_table names = {.items = NULL};
    char **paths;
    bool ok = true;

    for (size_t i = 0; ok && i < lamps->count; i++) {
        const struct profile *p = lamps->items[i].profile;

        ok = p == NULL || name_table_add(&names, p->path) != NO_NAME;
    }
    if (names.count == 0)
        return ok || fail(err, "%s: out of memory", scene->path);
    paths =
        realloc(scene->data_paths,
                ((size_t)scene->data_path_count + names.count) * sizeof *paths);
    ok = ok && paths != NULL;
    if (paths != NULL)
        scene->data_paths = paths;
    if (ok) {
        memcpy(paths + scene->data_path_count, names.items,
               names.count * sizeof *paths);
        scene->data_path_count += names.count;
        names.count = 0; /* the scene has its names now */
    }
    name_table_free(&names);
    return ok || fail(err, "%s: out of memory", scene->path);
}

bool scene_open(struct scene *scene, struct host_world *host, struct view *view,
                const struct scene_options *options, struct warnings *report,
                struct error *err)
{
    bool has_view_lamps;

    scene->thread_count = options->thread_count;
    scene->choice = options->choice;
    if (!scene_load(scene, options->path, options->up, report, err) ||
        !choose_camera(scene, options->camera, view, err) ||
        (options->view_lines != NULL &&
         !view_parse_over(view, options->view_lines, report, err)))
        return false;
    has_view_lamps = view->lamps.count > 0;
    if (!take_lamps(scene, view, report, err) ||
        !take_smokes(scene, view, err) ||
        !add_profile_paths(scene, &view->lamps, err) ||
        !world_init(host, scene, options->thread_count, report, err) ||
        !world_load_sky(host, view, report, err) ||
        !smoke_load(host, scene, view, report, err) ||
        !world_set_lamps(host, scene, view, err))
        return false;
    if (scene->tri_count == 0 && host->smoke_count == 0)
        warnings_add(
            report, "scenes without a face",
            "%s: found no visible face: only the background is rendered",
            scene->path);
    return tell_inverted_glass(scene, host, report, err) &&
           complete_view(scene, host, view, has_view_lamps, report, err) &&
           (!report->has_lost ||
            fail(err, "%s: out of memory for the warnings", options->path));
}

const char *scene_file(const struct scene *scene, const struct view *view,
                       const char *view_path, uint32_t number)
{
    const char *own[] = {scene->path, view_path, view->lighting.sky_path};
    uint32_t own_count = own[2] != NULL ? 3 : 2;

    if (number < own_count)
        return own[number];
    number -= own_count;
    if (number < scene->mtl_path_count)
        return scene->mtl_paths[number];
    number -= scene->mtl_path_count;
    if (number < scene->data_path_count)
        return scene->data_paths[number];
    number -= scene->data_path_count;
    if (number < scene->texture_count)
        return scene->texture_paths[number];
    number -= scene->texture_count;
    if (number < view->smokes.count)
        return view->smokes.items[number].path;
    return NULL;
}

/* ---- materials that the view gives to objects ---- */

void scene_find_assigned(const struct scene *scene,
                         const struct assigns *assigns, uint32_t *assigned,
                         struct warnings *report)
{
    for (uint32_t i = 0; i < scene->object_count; i++)
        assigned[i] = NO_INDEX;
    for (size_t i = 0; i < assigns->count; i++) {
        const struct assign *a = &assigns->items[i];
        uint32_t object = scene_find_object(scene, a->object);
        uint32_t material = mtl_find(scene, a->material);

        if (object != NO_INDEX && material != NO_INDEX)
            assigned[object] = material;
        else
            warnings_add_named(report, "assignments without effect", a->object,
                               "%s: found no %s '%s' to assign", scene->path,
                               object == NO_INDEX ? "object" : "material",
                               object == NO_INDEX ? a->object : a->material);
    }
}
