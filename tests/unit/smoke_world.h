// SPDX-License-Identifier: MIT
/*
 * smoke_world.h - grids of numbers and smokes of them, in a scene whose units
 * are normalised, for tests
 *
 * Units:     voxels; normalised scene units
 * Ownership: smoke_world_free() frees grids and smokes, which worlds have lent
 * Threads:   one
 * Errors:    a failed check ends the test
 */
#ifndef TESTS_SMOKE_WORLD_H
#define TESTS_SMOKE_WORLD_H

#include "read/npy.h"
#include "scene/scene.h"
#include "tests/unit/npy_file.h"
#include "world/world_smoke.h"

#define SMOKE_FILE "smoke"

struct smoke_world {
    struct host_world host;
    struct scene scene;
    struct smokes smokes;
};

static inline void smoke_world_init(struct smoke_world *w)
{
    *w = (struct smoke_world){.scene.scale = 1};
}

/* Makes a grid whose first voxel is at 0 0 0. */
static inline struct voxel_grid grid_of(const uint32_t size[3],
                                        const float *numbers)
{
    size_t size_bytes;
    char *bytes = npy_file_of(size, numbers, &size_bytes);
    struct voxel_grid grid;
    struct error err;

    check_or_say(npy_parse(&grid, bytes, size_bytes, &err), err.text);
    free(bytes);
    return grid;
}

/* Gives the world a grid of this name, and frees it. */
static inline void smoke_world_add(struct smoke_world *w, const char *name,
                                   struct voxel_grid *grid)
{
    struct error err;

    check_or_say(world_add_grid(&w->host, SMOKE_FILE, name, grid, &err),
                 err.text);
    voxel_grid_free(grid);
}

/* Gives the world a grid of one number everywhere. */
static inline void smoke_world_add_even(struct smoke_world *w, const char *name,
                                        uint32_t side, float number)
{
    size_t count = (size_t)side * side * side;
    float *numbers = malloc(count * sizeof *numbers);
    struct voxel_grid grid;

    assert_non_null(numbers);
    for (size_t i = 0; i < count; i++)
        numbers[i] = number;
    grid = grid_of((const uint32_t[3]){side, side, side}, numbers);
    free(numbers);
    smoke_world_add(w, name, &grid);
}

static inline void set3(double to[3], double x, double y, double z)
{
    to[0] = x;
    to[1] = y;
    to[2] = z;
}

/* Appends a smoke of a grid, whose box is the cube between low and high. */
static inline struct smoke_numbers *smoke_world_fill(struct smoke_world *w,
                                                     const char *grid,
                                                     const char *temperature,
                                                     double low, double high)
{
    char path[] = SMOKE_FILE, name[16], heat[16];
    struct smoke s = {.path = path,
                      .grid = name,
                      .temperature = heat,
                      .numbers = smoke_defaults};

    snprintf(name, sizeof name, "%s", grid);
    snprintf(heat, sizeof heat, "%s", temperature);
    for (int a = 0; a < 3; a++) {
        s.numbers.box[a] = low;
        s.numbers.box[a + 3] = high;
    }
    assert_true(smokes_add(&w->smokes, &s));
    return &w->smokes.items[w->smokes.count - 1].numbers;
}

/* Builds the smokes, and lends them to a world. */
static inline void smoke_world_lend(struct smoke_world *w, struct world *to)
{
    struct error err;

    check_or_say(world_set_smokes(&w->host, &w->scene, &w->smokes, &err),
                 err.text);
    to->smokes = w->host.smokes;
    to->voxel_places = w->host.voxel_places;
    to->voxels = w->host.voxels;
    to->glows = w->host.glows;
    to->settings.smoke_count = w->host.smoke_count;
    to->settings.smoke_steps_max = SMOKE_STEPS_MAX;
    to->settings.voxel_place_count = w->host.voxel_place_count;
    to->settings.voxel_count = w->host.voxel_count;
    to->settings.glow_count = w->host.glow_count;
}

static inline void smoke_world_free(struct smoke_world *w)
{
    world_free_smokes(&w->host);
    smokes_free(&w->smokes);
}

#endif
