// SPDX-License-Identifier: MIT
/*
 * edits.h - an edit of a small scene, and changes of it to given values
 *
 * Threads:   one
 * Errors:    -1 ends the program's tests
 */
#ifndef TESTS_EDITS_H
#define TESTS_EDITS_H

#include <stdlib.h>

#include "engine/scene_load.h"
#include "session/edit.h"
#include "terminal/xmalloc.h"
#include "tests/unit/check.h"
#include "tests/unit/files.h"

enum { LAMP = 1, WALL, BALL_OBJECT = 2 };

static struct scene scene;
static struct warnings report;

static inline int open_scene(void **state)
{
    struct error err;

    if (enter_folder(state) != 0)
        return -1;
    put("s.obj", "mtllib s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                 "o lamp\nusemtl lamp\nf 1 2 3\no ball\nusemtl wall\nf 1 2 3\n"
                 "o floor\nusemtl wall\nf 1 2 3\n");
    put("s.mtl", "newmtl lamp\nKe 3 2 1\nnewmtl wall\nKd .5 .5 .5\n");
    return scene_load(&scene, "s.obj", SCENE_UP_OF_FILE, &report, &err) ? 0
                                                                        : -1;
}

static inline int close_scene(void **state)
{
    scene_free(&scene);
    warnings_free(&report);
    return remove_folder(state);
}

static inline void open_edit(struct edit *e)
{
    struct lamp lamp;
    struct view view;

    view_init(&view);
    lamp_init(&lamp, LAMP_POINT);
    xcheck(lamps_add(&view.lamps, &lamp));
    edit_init(e, &scene, &view, &report);
    view_free(&view);
}

static inline void put_eye(struct edit *e, double x)
{
    struct pose pose = e->now.view.pose;

    pose.eye[0] = x;
    edit_pose(e, &pose);
}

static inline void put_kd(struct edit *e, uint32_t material, double red)
{
    struct material_values source = e->now.sources[material];

    source.base_color.rgb[0] = red;
    source.base_color.line = 1;
    edit_material(e, material, &source);
}

static inline void put_background(struct edit *e, double red)
{
    struct lighting light = e->now.view.lighting;

    light.background[0] = red;
    light.has_background = true;
    edit_lighting(e, &light);
}

static inline void put_exposure(struct edit *e, double exposure)
{
    struct lighting light = e->now.view.lighting;

    light.exposure = exposure;
    edit_lighting(e, &light);
}

static inline void put_tone(struct edit *e, uint32_t tone)
{
    struct lighting light = e->now.view.lighting;

    light.tone = tone;
    edit_lighting(e, &light);
}

static inline void put_sky(struct edit *e, const char *path)
{
    struct lighting light = e->now.view.lighting;
    char *copy = path != NULL ? xstrdup(path) : NULL;

    light.sky_path = copy;
    edit_lighting(e, &light);
    free(copy);
}

/* The change is a step, and 1 if it needs a new render, 0 if not. */
#define COUNTS(change, count)                     \
    do {                                          \
        uint32_t before_ = e.version;             \
        edit_end_step(&e);                        \
        change;                                   \
        if ((count) == 0)                         \
            assert_int_equal(e.version, before_); \
        else                                      \
            assert_true(e.version != before_);    \
    } while (0)

#endif
