// SPDX-License-Identifier: MIT
/*
 * scene_format.h - the formats of scene files, and which one a file has
 *
 * Threads:   any
 */
#ifndef GLIM_SCENE_FORMAT_H
#define GLIM_SCENE_FORMAT_H

#include "scene/scene.h"

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

/* Returns the format of the file: one that its bytes begin, else the one with
 * the ending of its name, before which .gz is ignored, else OBJ. */
const struct scene_format *scene_format_of(const char *path, const char *bytes,
                                           size_t size_bytes);

#endif
