// SPDX-License-Identifier: MIT
#include "session/picture_options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "engine/engine_metadata.h"
#include "session/option_table.h"
#include "terminal/xmalloc.h"

/* Keys of the metadata that are options, and options in lines of the view. No
 * others are taken from a file. */
static const struct {
    const char *key, *option;
} keys[] = {
    {"glim:seed", "seed"},
    {"glim:spp", "s"},
    {"glim:crop", "crop"},
    {"glim:adaptive", "adaptive"},
};

static const char *const lines[] = {"gi",      "up",        "scene",
                                    "variant", "animation", "anim-time"};

static bool read_texts(struct options *o, struct error *err)
{
    char *bytes;
    size_t size_bytes;

    if (!file_read(o->picture_path, &bytes, &size_bytes, err))
        return false;
    o->picture = xcalloc(1, sizeof *o->picture);
    image_metadata_find(o->picture, bytes, size_bytes);
    free(bytes);
    if (image_metadata_value(o->picture, "glim:scene") == NULL)
        return fail(err,
                    "%s: found no texts of glim, expected a picture of glim as "
                    ".png, .hdr or .exr (or the scene and its options)",
                    o->picture_path);
    o->view_text = engine_metadata_view(o->picture);
    return o->view_text != NULL ||
           fail(err,
                "%s: found no view in its texts, expected one (or the scene "
                "and its options)",
                o->picture_path);
}

/* Returns the scene's path, or NULL after an error. */
static const char *find_scene(const struct options *o, struct error *err)
{
    const char *name =
        path_name(image_metadata_value(o->picture, "glim:scene"));
    char *beside;

    if (o->scene_path != NULL)
        return o->scene_path;
    beside = xchecked(path_beside(o->picture_path, name));
    if (file_identify(beside).exists)
        return beside;
    free(beside);
    if (file_identify(name).exists)
        return name;
    fail(err,
         "%s: found no scene '%s' beside it or in this folder, expected it, or "
         "its path behind that of the picture",
         o->picture_path, name);
    return NULL;
}

static bool take_option(struct options *o, const char *path, const char *name,
                        const char *value, struct error *err)
{
    struct option_given g = {.rule = option_rule_named(name, strlen(name)),
                             .value = value};

    snprintf(g.shown, sizeof g.shown, "%.480s: %s", path, name);
    return value == NULL || option_set(o, &g, err);
}

/* Takes the lines `option NAME VALUE` out of the view's text, which are the
 * first. */
static bool take_lines(struct options *o, const char *path, struct error *err)
{
    static const char word[] = "option ";
    char *p = o->view_text, *end;

    for (; strncmp(p, word, sizeof word - 1) == 0 &&
           (end = strchr(p, '\n')) != NULL;
         p = end + 1) {
        char *name = p + sizeof word - 1, *value = strchr(name, ' ');
        size_t i = 0, count = sizeof lines / sizeof lines[0];

        *end = '\0';
        if (value != NULL)
            *value++ = '\0';
        while (i < count && strcmp(lines[i], name) != 0)
            i++;
        if (i < count && !take_option(o, path, name, value, err))
            return false;
    }
    o->view_text = p;
    return true;
}

static bool take_options(struct options *o, const char *path, struct error *err)
{
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
        if (!take_option(o, path, keys[i].option,
                         image_metadata_value(o->picture, keys[i].key), err))
            return false;
    return take_lines(o, path, err);
}

bool picture_options_parse(struct options *o, const struct options *before,
                           int argc, char **argv, struct error *err)
{
    const char *scene;
    struct options of_picture = *before;

    if (!read_texts(o, err) || (scene = find_scene(o, err)) == NULL)
        return false;
    of_picture.picture = o->picture;
    of_picture.view_text = o->view_text;
    if (!take_options(&of_picture, o->picture_path, err))
        return false;
    free(o->view_lines);
    *o = of_picture;
    if (!options_parse(o, argc, argv, err))
        return false;
    o->scene_path = scene;
    return true;
}
