// SPDX-License-Identifier: MIT
/*
 * room.h - a scene with its tree, from a file or as a box
 *
 * Ownership: room_close() frees the scene
 * Threads:   one
 * Errors:    a failure ends the test
 */
#ifndef TESTS_ROOM_H
#define TESTS_ROOM_H

#include <stdlib.h>

#include "engine/scene_load.h"
#include "studio/camera/surfaces.h"
#include "tests/unit/check.h"

struct room {
    struct scene scene;
    struct host_world host;
    struct view view;
    struct surfaces surfaces;
};

static inline void room_open(struct room *r, const char *path)
{
    struct scene_options how = {.path = path,
                                .up = SCENE_UP_OF_FILE,
                                .thread_count = 1};
    struct warnings report = {0};
    struct world world;
    struct error err;
    char *view_path;

    *r = (struct room){.surfaces = {&r->scene, &r->host}};
    view_init(&r->view);
    check_or_say(view_find(&r->view, path, NULL, &view_path, &report, &err) &&
                     scene_open(&r->scene, &r->host, &r->view, &how, &report,
                                &err),
                 err.text);
    world = world_arrays(&r->host, &r->scene);
    check_or_say(world_ensure_tree(&r->host, &world, NULL, &err), err.text);
    warnings_free(&report);
    free(view_path);
}

static inline void room_close(struct room *r)
{
    world_free(&r->host);
    scene_free(&r->scene);
    view_free(&r->view);
}

/* Writes a box of six faces with mixed winding, times `scale`, to box.obj and
 * opens it. */
static inline void room_open_box(struct room *r, const double lo[3],
                                 const double hi[3], double scale)
{
    FILE *to = fopen("box.obj", "w");

    assert_non_null(to);
    for (int face = 0; face < 6; face++) {
        int k = face / 2, i = (k + 1) % 3, j = (k + 2) % 3;
        double p[3];

        for (int c = 0; c < 4; c++) {
            p[k] = face % 2 ? hi[k] : lo[k];
            p[i] = c == 1 || c == 2 ? hi[i] : lo[i];
            p[j] = c >= 2 ? hi[j] : lo[j];
            fprintf(to, "v %.17g %.17g %.17g\n", p[0] * scale, p[1] * scale,
                    p[2] * scale);
        }
        fprintf(to, "f -4 -3 -2 -1\n");
    }
    assert_int_equal(fclose(to), 0);
    room_open(r, "box.obj");
}

#endif
