// SPDX-License-Identifier: MIT
/*
 * mapped.h - a triangle whose material has maps, and their images
 *
 * The files a.obj, a.mtl and the images are in the test's own folder.
 *
 * Threads:   one
 * Errors:    a failed check ends the test
 */
#ifndef TESTS_MAPPED_H
#define TESTS_MAPPED_H

#include <string.h>
#include <unistd.h>

#include "engine/scene_load.h"
#include "tests/unit/files.h"
#include "world/world.h"

#include "world/bvh/ray_queries.h"

#include "kernels/path.h"

/* A scene of one triangle whose material "m" has these statements, and its
 * world. */
struct loaded {
    struct scene scene;
    struct host_world host;
    struct warnings report;
    struct view view;
    struct world world;
    struct material material;
};

/* Writes an uncompressed Targa with the top row first and 3 or 4 channels in
 * the order red, green, blue, alpha. */
static inline void write_image(const char *path, int width, int height,
                               int channels, const uint8_t *pixels)
{
    uint8_t bytes[18 + 64] = {[2] = 2,
                              [12] = (uint8_t)width,
                              [14] = (uint8_t)height,
                              [16] = (uint8_t)(8 * channels),
                              [17] = 0x20};
    size_t size = (size_t)(width * height * channels);

    if (channels == 4)
        bytes[17] |= 8;
    assert_true(size <= 64);
    for (size_t i = 0; i < size; i++) {
        size_t channel = i % (size_t)channels;
        size_t to = channel < 3 ? i - channel + 2 - channel : i;

        bytes[18 + to] = pixels[i];
    }
    put_bytes(path, bytes, 18 + size);
}

static inline void load(struct loaded *l, const char *statements)
{
    static const char obj[] = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                              "vt 0 0\nvt 1 0\nvt 0 1\nusemtl m\n"
                              "f 1/1 2/2 3/3\n";
    char mtl[512];
    struct error err = {""};

    memset(l, 0, sizeof *l);
    snprintf(mtl, sizeof mtl, "newmtl m\n%s\n", statements);
    put_bytes("a.mtl", mtl, strlen(mtl));
    put_bytes("a.obj", obj, sizeof obj - 1);
    view_init(&l->view);
    l->view.pose.eye[2] = 5;
    if (!scene_load(&l->scene, "a.obj", SCENE_UP_OF_FILE, &l->report, &err) ||
        !world_init(&l->host, &l->scene, 2, &l->report, &err) ||
        !world_lend(&l->host, &l->scene, &l->view, 0, &l->world, &err))
        print_error("%s\n", err.text);
    assert_string_equal(err.text, "");
    for (int i = 0; i < l->report.entry_count; i++)
        print_error("%s\n", l->report.entries[i].text);
    assert_int_equal(l->report.entry_count, 0);
    l->material = l->host.materials[1];
}

static inline void unload(struct loaded *l)
{
    world_free(&l->host);
    scene_free(&l->scene);
    warnings_free(&l->report);
    view_free(&l->view);
}

static inline struct bsdf surface(const struct loaded *l, float u, float v)
{
    struct surface_point at = {.uv = {{u, v}, {0, 0}},
                               .has_uv = true,
                               .is_outside = true};

    return bsdf_at(&l->world, &l->material, &at);
}
/* Removes the files and the folder. */
static inline int remove_files(void **state)
{
    const char *const names[] = {"a.obj", "a.mtl", "six.tga", "two.tga",
                                 "leaf.tga"};

    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        unlink(names[i]);
    return leave_empty_folder(state);
}
#endif
