// SPDX-License-Identifier: MIT
#include "shapes.h"

#include <stdlib.h>
#include <unistd.h>

#include "base/memory.h"
#include "engine/scene_load.h"
#include "read/mtl.h"
#include "read/view_file.h"
#include "terminal/xmalloc.h"
#include "world/world.h"
#include "kernels/rng.h"

/* Number of octaves of a terrain's height. */
#define OCTAVES 10

#define WIDTH_PX  640
#define HEIGHT_PX 480

const char *const shape_names[SHAPES] = {"bunny",  "sponza_part", "veach_ajar",
                                         "forest", "terrain1m",   "terrain4m"};

/* The shape that is a scene of the repository, with instances. */
#define INSTANCED 3

/* Number of squares of a terrain along x, with half as many along z; 0 is a
 * file. */
static const uint32_t columns[SHAPES] = {0, 0, 0, 0, 1000, 2000};

/* Returns a number in [-1, 1] at a corner of a lattice. */
static double height_at(int x, int z, int octave)
{
    uint32_t h = hash_u32((uint32_t)x + hash_u32((uint32_t)z + 1u));

    return 2.0 * (double)unit_float(hash_u32(h + (uint32_t)octave)) - 1.0;
}

/* Value noise (Perlin's lattice with heights), for x and z at least 0. */
static double noise(double x, double z, int octave)
{
    int i = (int)x, k = (int)z;
    double u = x - i, v = z - k;
    double a = height_at(i, k, octave), b = height_at(i + 1, k, octave);
    double c = height_at(i, k + 1, octave), d = height_at(i + 1, k + 1, octave);

    u = u * u * (3 - 2 * u);
    v = v * v * (3 - 2 * v);
    return a + (b - a) * u + (c - a) * v + (a - b - c + d) * u * v;
}

/* Adds the square of the terrain whose first corner is `a`, as two
 * triangles. */
static void add_square(struct scene *s, uint32_t a, uint32_t across)
{
    const uint32_t corners[2][3] = {{a, a + across, a + 1},
                                    {a + 1, a + across, a + across + 1}};

    for (int k = 0; k < 2; k++)
        s->tris[s->tri_count++] =
            (struct tri){.v = {corners[k][0], corners[k][1], corners[k][2]},
                         .vn = {NO_INDEX, NO_INDEX, NO_INDEX},
                         .vt = {NO_INDEX, NO_INDEX, NO_INDEX}};
}

/* Fills the scene as obj_parse() does. */
static bool make_terrain(struct scene *s, uint32_t across, struct error *err)
{
    uint32_t along = across / 2;
    size_t corners = (size_t)(across + 1) * (along + 1);
    size_t tris = 2 * (size_t)across * along;

    s->file_positions = alloc_array(3 * corners, sizeof *s->file_positions);
    s->tris = alloc_array(tris, sizeof *s->tris);
    s->tri_faces = alloc_array(tris, sizeof *s->tri_faces);
    s->tri_objects = alloc_array(tris, sizeof *s->tri_objects);
    if (s->file_positions == NULL || s->tris == NULL || s->tri_faces == NULL ||
        s->tri_objects == NULL)
        return fail(err, "out of memory for a terrain");
    for (uint32_t z = 0; z <= along; z++)
        for (uint32_t x = 0; x <= across; x++) {
            double *p = s->file_positions + 3 * (size_t)s->position_count++;

            p[0] = 2.0 * x / across;
            p[2] = 2.0 * z / across;
            for (int i = 0; i < OCTAVES; i++)
                p[1] += noise(p[0] * 3 * (1 << i), p[2] * 3 * (1 << i), i) *
                        0.12 / (1 << i);
        }
    for (uint32_t z = 0; z < along; z++)
        for (uint32_t x = 0; x < across; x++)
            add_square(s, z * (across + 1) + x, across + 1);
    return mtl_add_default(s, err);
}

/* The view is from above one corner towards the middle. */
static bool load_terrain(struct scene *s, uint32_t across, struct view *view,
                         struct warnings *report, struct error *err)
{
    const struct pose pose = {.eye = {0.2, 0.5, 0.1},
                              .at = {1.1, 0.0, 0.6},
                              .up = {0, 1, 0},
                              .fovy_deg = 60};

    view->pose = pose;
    view->has_camera = true;
    s->path = xstrdup("terrain");
    return make_terrain(s, across, err) && scene_finish(s, report, err);
}

static bool load_file(struct scene *s, int i, const char *shared,
                      struct view *view, struct warnings *report,
                      struct error *err)
{
    const char *name = shape_names[i];
    char *folder = i == INSTANCED ? xstrdup("scenes")
                                  : xformat("%s/scenes-real/%s", shared, name);
    char *path =
        xformat(i == INSTANCED ? "%s/%s.glb" : "%s/%s.obj", folder, name);
    char *camera = i == INSTANCED ? xformat("%s/%s.view", folder, name)
                                  : xformat("%s/camera.txt", folder);
    bool ok = access(path, R_OK) == 0;

    err->text[0] = '\0';
    ok = ok && scene_load(s, path, SCENE_UP_OF_FILE, report, err) &&
         view_read(view, camera, report, err);
    if (ok && !view->has_camera && s->camera_count > 0)
        view->pose = s->cameras[0].pose;
    free(folder);
    free(path);
    free(camera);
    return ok;
}

/* Makes the world for the view, if the scene was loaded. */
static bool finish(struct shape *shape, struct view *view, bool is_loaded,
                   struct warnings *report, struct error *err)
{
    bool ok;

    view->width_px = WIDTH_PX;
    view->height_px = HEIGHT_PX;
    ok = is_loaded && world_init(&shape->host, &shape->scene, 1, report, err) &&
         world_lend(&shape->host, &shape->scene, view, 0, &shape->world, err);
    warnings_free(report);
    /* without holes, which Embree's rays do not pass */
    shape->world.settings.features = 0;
    view_free(view);
    if (!ok)
        shape_free(shape);
    return ok;
}

bool shape_make_terrain(struct shape *shape, uint32_t across, struct error *err)
{
    struct warnings report = {0};
    struct view view;
    bool ok;

    *shape = (struct shape){.scene.path = NULL};
    view_init(&view);
    ok = load_terrain(&shape->scene, across, &view, &report, err);
    return finish(shape, &view, ok, &report, err);
}

bool shape_load(struct shape *shape, int i, const char *shared,
                struct error *err)
{
    struct warnings report = {0};
    struct view view;
    bool ok;

    if (columns[i] != 0)
        return shape_make_terrain(shape, columns[i], err);
    *shape = (struct shape){.scene.path = NULL};
    view_init(&view);
    ok = load_file(&shape->scene, i, shared, &view, &report, err);
    return finish(shape, &view, ok, &report, err);
}

void shape_free(struct shape *shape)
{
    world_free(&shape->host);
    scene_free(&shape->scene);
}
