// SPDX-License-Identifier: MIT
/*
 * scene_load.h - the formats of scene files, and loads a scene from its files
 * with the light that it lacks
 *
 * Units:     those of the scene file
 * Ownership: the caller frees scene and world
 * Threads:   one thread calls; images are decoded by several
 * Errors:    file and line, what was found and expected
 */
#ifndef GLIM_SCENE_LOAD_H
#define GLIM_SCENE_LOAD_H

#include "scene/scene.h"
#include "world/world.h"

/* ---- what a model shows by its own light ---- */

/*
 * A few thousand paths through a small picture measure the light that surfaces
 * reflect. Emission and sky that the camera sees itself count on request: a
 * lamp that shines into the camera need not show anything else.
 */

struct light_probe {
    double mean;  /* mean luminance, of which each sample adds 1 at most */
    double shown; /* share of the picture that is not black */
};

/* Measures the world with the lamps that it has, and the sky and camera of the
 * view. Builds the world's tree. */
bool light_probe_take(struct light_probe *probe, struct host_world *host,
                      const struct scene *scene, const struct view *view,
                      bool counts_seen, struct error *err);

/* Returns true if this light does enough beside the light that could be added:
 * `with` is measured with both. Light that shows nothing never does. */
bool light_probe_suffices(const struct light_probe *own,
                          const struct light_probe *with);

/* ---- scenes ---- */

/* ---- formats ---- */

/* Axis of a scene file that points up. */
enum scene_up {
    SCENE_UP_OF_FILE, /* the reader decides, and sets scene->up_is_z */
    SCENE_UP_Y,
    SCENE_UP_Z
};

/* Adds the contents of a file to a zeroed scene, which the caller frees, also
 * after an error. `path` is for messages and for files beside it. */
typedef bool scene_parse(struct scene *scene, const char *bytes,
                         size_t size_bytes, const char *path,
                         struct warnings *report, struct error *err);

struct scene_format {
    const char *name;
    const char *endings; /* of file names, separated by blanks */
    const char *about;   /* one line for --formats */
    /* Returns true if the bytes begin a file of this format. NULL: formats
     * that only the name tells. */
    bool (*matches)(const char *bytes, size_t size_bytes);
    scene_parse *parse;
    bool has_choices; /* it reads what scene->choice says */
    /* Returns NULL if all of the format can be read, else what is missing.
     * NULL: formats that need no library. */
    const char *(*missing)(void);
};

/* Returns the format of this number, from 0, or NULL after the last. */
const struct scene_format *scene_format_number(uint32_t number);

/* Returns the format with the ending of the file's name, before which .gz is
 * ignored, or NULL. */
const struct scene_format *scene_format_named(const char *path);

/* Returns the format of the file: one that its bytes begin, else the one with
 * the ending of its name, before which .gz is ignored, else OBJ. */
const struct scene_format *scene_format_of(const char *path, const char *bytes,
                                           size_t size_bytes);

/* ---- scenes ---- */

/* How a scene is opened. Zeroed but the path, all is as the files say. */
struct scene_options {
    const char *path;
    enum scene_up up;
    int thread_count; /* of loading; at least 1 */
    /* number or name of the camera; NULL: that of the view, or the first one of
     * the scene */
    const char *camera;
    struct scene_choice choice;
    const char *view_lines; /* for view_parse_over(); NULL: none */
};

/* Loads a scene file with its MTL files and finishes the scene. Models with z
 * up are turned to y up: (x, y, z) becomes (x, z, -y). */
bool scene_load(struct scene *scene, const char *path, enum scene_up up,
                struct warnings *report, struct error *err);

/* Reads the view file of a scene: `view_path`, or if that is NULL, STEM.view or
 * else camera.txt beside the scene. It need not exist. *path is the file to
 * write the view to, for free(), also after an error. */
bool view_find(struct view *view, const char *scene_path, const char *view_path,
               char **path, struct warnings *report, struct error *err);

/* Kind of the warning about a scene whose own light shows little. */
#define SCENE_LITTLE_LIGHT "scenes with little light"

/* Loads the scene and makes its world with the sky of the view. Completes the
 * view with what the options say, and with a camera that sees the whole scene.
 * Adds a soft sky if there is no light, and the light of a studio to a model
 * whose own light shows little of it. */
bool scene_open(struct scene *scene, struct host_world *host, struct view *view,
                const struct scene_options *options, struct warnings *report,
                struct error *err);

/* Returns true if scene_open() has added the soft sky. */
bool view_has_soft_sky(const struct view *view);

/* Returns the name of a file that the scene or its view comes from, for each
 * number from 0; NULL after the last. view_path need not exist. */
const char *scene_file(const struct scene *scene, const struct view *view,
                       const char *view_path, uint32_t number);

/* Finds the material that the view assigns to each object; NO_INDEX if none. */
void scene_find_assigned(const struct scene *scene,
                         const struct assigns *assigns, uint32_t *assigned,
                         struct warnings *report);

#endif
