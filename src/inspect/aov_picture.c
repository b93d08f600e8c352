// SPDX-License-Identifier: MIT
#include "inspect/aov_picture.h"

#include <assert.h>

#include "world/bvh/ray_queries.h"

#include "kernels/path.h"

struct job {
    const struct world *world;
    int width;
    float *numbers;
};

static void set_vector(struct vec3 v, float *to)
{
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}

static void trace_row(void *context, uint32_t y, int worker)
{
    const struct job *j = context;
    const struct world *w = j->world;
    float *row = j->numbers + 3 * (size_t)y * (size_t)j->width;

    (void)worker;
    for (int x = 0; x < j->width; x++) {
        struct camera_sample start =
            camera_sample_begin(&w->settings, (uint32_t)x, y, 0);
        struct hit h;

        path_set_key(w, start.sampler, 1, &start.ray);
        hit_closest(w, start.ray, &h);
        set_vector(aov_sample(w, start.ray, h).radiance, row + 3 * x);
    }
}

void aov_of_pixels(struct pool *pool, const struct world *world, int width,
                   int height, float *numbers)
{
    struct job j = {world, width, numbers};

    assert(world->settings.sample != SAMPLE_LIGHT);
    pool_each(pool, (uint32_t)height, trace_row, &j);
}

/* ---- files ---- */

/* Sets a place in file units. */
static void set_position(const struct scene *scene, struct vec3 p, float *to)
{
    double point[3];

    scene_file_point(scene, p, point);
    for (int k = 0; k < 3; k++)
        to[k] = (float)point[k];
}

static void set_all(double number, float *to)
{
    to[0] = to[1] = to[2] = (float)number;
}

/* Sets the numbers of the surface that the ray meets. They stay 0 if there is
 * none. */
static void set_surface(const struct aov_picture *a, struct ray r,
                        struct sampler sampler, float *to)
{
    const struct world *w = a->world;
    struct surface_point v;
    struct material m;
    struct bsdf b;
    struct hit h;
    uint32_t material;

    path_set_key(w, sampler, 1, &r);
    set_all(0, to);
    if (!hit_closest(w, r, &h))
        return;
    material = tri_material(w, h.tri, instance_of(w, h.tri));
    m = w->materials[material];
    if (!surface_at(w, &m, r, h, &v))
        return;
    switch (a->kind) {
    case AOV_ALBEDO:
        b = bsdf_at(w, &m, &v);
        set_vector(b.color, to);
        break;
    case AOV_NORMALS: set_vector(v.n, to); break;
    case AOV_POSITION: set_position(a->scene, v.p, to); break;
    case AOV_DEPTH: set_all((double)h.t / a->scene->scale, to); break;
    case AOV_UV:
        set_vector(v3(v.uv.first.x, v.uv.first.y, v.has_uv ? 1.0f : 0.0f), to);
        break;
    case AOV_OBJECT:
        set_all(1.0 + scene_tri_object(a->scene, h.tri), to);
        break;
    default: set_all(1.0 + material, to); break;
    }
}

static void set_mean(const struct aov_picture *a, uint32_t x, uint32_t y,
                     float *to)
{
    double sums[3] = {0, 0, 0};

    for (uint64_t i = 0; i < AOV_SAMPLES; i++) {
        struct camera_sample start =
            camera_sample_begin(&a->world->settings, x, y, i);

        set_surface(a, start.ray, start.sampler, to);
        for (int c = 0; c < 3; c++)
            sums[c] += (double)to[c];
    }
    for (int c = 0; c < 3; c++)
        to[c] = (float)(sums[c] / AOV_SAMPLES);
}

struct rows {
    const struct aov_picture *picture;
    float *numbers;
};

static void render_row(void *context, uint32_t row, int worker)
{
    const struct rows *j = context;
    const struct aov_picture *a = j->picture;
    float *to = j->numbers + 3 * (size_t)row * (size_t)a->crop.width;
    uint32_t y = (uint32_t)a->crop.y + row;

    (void)worker;
    for (int i = 0; i < a->crop.width; i++, to += 3) {
        uint32_t x = (uint32_t)(a->crop.x + i);

        if (a->kind == AOV_ALBEDO || a->kind == AOV_NORMALS)
            set_mean(a, x, y, to);
        else
            set_surface(a,
                        camera_ray(a->world->settings.camera, x, y,
                                   v2(0.5f, 0.5f)),
                        camera_sampler(&a->world->settings, x, y, 0), to);
    }
}

void aov_picture_render(const struct aov_picture *picture, struct pool *pool,
                        float *numbers)
{
    struct rows j = {picture, numbers};

    assert(picture->world->settings.sample == SAMPLE_LIGHT);
    pool_each(pool, (uint32_t)picture->crop.height, render_row, &j);
}
