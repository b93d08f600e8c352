// SPDX-License-Identifier: MIT
#include "batch_aov.h"

#include <stdlib.h>

#include "base/file.h"
#include "base/memory.h"
#include "picture/image_write.h"
#include "terminal/xmalloc.h"
#include "inspect/aov_picture.h"

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

bool batch_aov_check(const struct session *s, const char *picture,
                     struct error *err)
{
    bool ok = true;

    for (int i = 0; i < AOV_KINDS && ok; i++) {
        char *path;

        if ((s->options->aovs >> i & 1) == 0)
            continue;
        path = path_of(picture, i);
        ok = check_path(s, picture, path, err);
        free(path);
    }
    return ok;
}

static bool write(struct view_mode *show, const char *path,
                  const struct aov_picture *a, float *numbers,
                  struct error *err)
{
    aov_picture_render(a, view_mode_pool(show), numbers);
    return image_write_floats(numbers, a->crop.width, a->crop.height, path,
                              err);
}

bool batch_aov_write(struct view_mode *show, const char *picture,
                     struct error *err)
{
    const struct session *s = show->session;
    struct rect crop = s->crop;
    struct world world;
    float *numbers;
    bool ok;

    if (s->options->aovs == 0)
        return true;
    if (!view_mode_need_tree(show, err))
        return false;
    if (!view_mode_world(show, &world))
        return fail(err, "--aov: found an impossible camera");
    numbers = alloc_array((size_t)crop.width * (size_t)crop.height,
                          3 * sizeof *numbers);
    ok = numbers != NULL || fail(err, "--aov: out of memory for %dx%d pixels",
                                 crop.width, crop.height);
    for (int i = 0; i < AOV_KINDS && ok; i++) {
        struct aov_picture a = {(enum aov_kind)i, &s->scene, &world, crop};
        char *path;

        if ((s->options->aovs >> i & 1) == 0)
            continue;
        path = path_of(picture, i);
        ok = write(show, path, &a, numbers, err);
        free(path);
    }
    free(numbers);
    return ok;
}
