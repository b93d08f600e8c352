// SPDX-License-Identifier: MIT
#include "engine/scene_format.h"

#include <string.h>
#include <strings.h>

#include "read/child/import.h"
#include "read/gltf/gltf.h"
#include "read/gltf/gltf_draco.h"
#include "read/obj.h"
#include "read/ply.h"
#include "read/ply_file.h"
#include "read/stl.h"

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

const struct scene_format *scene_format_of(const char *path, const char *bytes,
                                           size_t size_bytes)
{
    for (int i = 0; i < FORMAT_COUNT; i++)
        if (formats[i].matches != NULL && formats[i].matches(bytes, size_bytes))
            return &formats[i];
    for (int i = 0; i < FORMAT_COUNT; i++)
        if (has_ending(&formats[i], path))
            return &formats[i];
    return &formats[0];
}
