// SPDX-License-Identifier: MIT
#include "batch_aov.h"

#include <stdlib.h>

#include "base/file.h"
#include "base/memory.h"
#include "inspect/aov_picture.h"
#include "picture/image_write.h"
#include "terminal/xmalloc.h"

/* Names in EXR files: those of OpenEXR where it has some, else layers whose
 * channels have one letter, as Blender and Nuke need it. */
static const struct exr_layer layers_of_kinds[AOV_KINDS] = {
    [AOV_ALBEDO] = {"albedo.", "RGB", NULL},
    [AOV_NORMALS] = {"N.", "XYZ", NULL},
    [AOV_POSITION] = {"P.", "XYZ", NULL},
    [AOV_DEPTH] = {"", "Z", NULL},
    [AOV_UV] = {"uv.", "UV", NULL},
    [AOV_OBJECT] = {"object.", "X", NULL},
    [AOV_MATERIAL] = {"material.", "X", NULL},
};

/* Returns the name of the file beside the picture, for free(). */
static char *path_of(const char *picture, int kind)
{
    char *stem = xchecked(path_stem(picture));
    char *path = xformat("%s.%s.pfm", stem, options_aovs[kind]);

    free(stem);
    return path;
}

/* Fails if the file is one that the session reads, or another output. */
static bool check_path(const struct session *s, const char *picture,
                       const char *path, struct error *err)
{
    const struct options *o = s->options;
    const char *const others[] = {picture,       o->denoise_path,
                                  o->stats_path, o->error_map_path,
                                  o->film_path,  o->checkpoint_path};

    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        if (others[i] != NULL && path_is_same(path, others[i]))
            return fail(err,
                        "--aov: found '%s', the file of another option, "
                        "expected another file",
                        path);
    return session_check_output(s, "--aov", path, err) && file_check(path, err);
}

bool batch_aov_is_in_picture(const struct options *o)
{
    return o->aovs != 0 && o->output_path != NULL &&
           image_write_format_of(o->output_path) == IMAGE_WRITE_EXR;
}

bool batch_aov_check(const struct session *s, const char *picture,
                     struct error *err)
{
    bool ok = true;

    for (int i = 0; i < AOV_KINDS && ok; i++) {
        char *path;

        if ((s->options->aovs >> i & 1) == 0 ||
            batch_aov_is_in_picture(s->options))
            continue;
        path = path_of(picture, i);
        ok = check_path(s, picture, path, err);
        free(path);
    }
    return ok;
}

/* Renders the kinds, one after the other, each as 3 numbers for each pixel of
 * the crop. Returns memory for free(), or NULL. */
static float *render(struct view_mode *show, uint32_t kinds, struct error *err)
{
    const struct session *s = show->session;
    struct rect crop = s->engine.crop;
    size_t size = 3 * (size_t)crop.width * (size_t)crop.height;
    struct world world;
    float *numbers, *to;

    if (!view_mode_need_tree(show, err))
        return NULL;
    if (!view_mode_world(show, &world)) {
        fail(err, "--aov: found an impossible camera");
        return NULL;
    }
    to = numbers =
        alloc_array(size, (size_t)__builtin_popcount(s->options->aovs) *
                              sizeof *numbers);
    if (numbers == NULL)
        fail(err, "--aov: out of memory for %dx%d pixels", crop.width,
             crop.height);
    for (int i = 0; i < AOV_KINDS && numbers != NULL; i++) {
        struct aov_picture a = {(enum aov_kind)i, &s->engine.scene, &world,
                                crop};

        if ((kinds >> i & 1) == 0)
            continue;
        aov_picture_render(&a, view_mode_pool(show), to);
        to += size;
    }
    return numbers;
}

static bool write(struct view_mode *show, int kind, const char *path,
                  struct error *err)
{
    struct rect crop = show->session->engine.crop;
    float *numbers = render(show, 1u << kind, err);
    bool ok = numbers != NULL &&
              image_write_floats(numbers, crop.width, crop.height, path, err);

    free(numbers);
    return ok;
}

bool batch_aov_write(struct view_mode *show, const char *picture,
                     struct error *err)
{
    const struct options *o = show->session->options;
    bool ok = true;

    for (int i = 0; i < AOV_KINDS && ok; i++) {
        char *path;

        if ((o->aovs >> i & 1) == 0 || batch_aov_is_in_picture(o))
            continue;
        path = path_of(picture, i);
        ok = write(show, i, path, err);
        free(path);
    }
    return ok;
}

bool batch_aov_write_layers(struct view_mode *show, struct film *film,
                            const struct image_metadata *metadata,
                            struct error *err)
{
    const struct session *s = show->session;
    size_t size =
        3 * (size_t)s->engine.crop.width * (size_t)s->engine.crop.height;
    struct exr_layer layers[AOV_KINDS];
    float *numbers = render(show, s->options->aovs, err);
    int count = 0;
    bool ok;

    for (int i = 0; i < AOV_KINDS && numbers != NULL; i++) {
        if ((s->options->aovs >> i & 1) == 0)
            continue;
        layers[count] = layers_of_kinds[i];
        layers[count].values = numbers + (size_t)count * size;
        count++;
    }
    ok = numbers != NULL && image_write_layers(film, metadata, layers, count,
                                               s->options->output_path, err);
    free(numbers);
    return ok;
}
