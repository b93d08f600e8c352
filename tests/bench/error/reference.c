// SPDX-License-Identifier: MIT
#include "reference.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/memory.h"
#include "command/difference.h"
#include "command/reference_info.h"
#include "film/image_write.h"
#include "terminal/xmalloc.h"
#include "tests/unit/whole_image.h"
#include "world/world.h"

#define HALF_SPP 1024

/* Measurements use seeds from 0 on. */
#define SEED_OF_HALVES 1000000u

static size_t number_count(const struct reference *r)
{
    return 3 * (size_t)r->width * (size_t)r->height;
}

static struct picture_error error_of(const struct reference *r,
                                     const float *rgb)
{
    struct picture_pair pair = {r->width, r->height, rgb, r->rgb};

    return picture_error_of(&pair);
}

double reference_error(const struct reference *r, const float *rgb)
{
    return error_of(r, rgb).relmse;
}

double reference_bias(const struct reference *r, const float *rgb)
{
    return error_of(r, rgb).bias;
}

static bool read_noise(const char *picture, double *noise, struct error *err)
{
    struct reference_info info = reference_info_read(picture);

    *noise = info.relmse;
    return info.is_known ||
           fail(err, "%s: found no relmse in the .json file beside it",
                picture);
}

/* Averages squares of pixels, as a render with larger pixels does. */
static void shrink(const struct image *from, int reduce, struct reference *to)
{
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < 3 * to->width; x++) {
            double sum = 0;

            for (int i = 0; i < reduce * reduce; i++) {
                int row = y * reduce + i / reduce;
                int column = x / 3 * reduce + i % reduce;

                sum +=
                    (double)from->rgb[3 * (row * from->width + column) + x % 3];
            }
            to->rgb[3 * y * to->width + x] = (float)(sum / (reduce * reduce));
        }
}

static bool reference_init(struct reference *r, int width, int height,
                           struct error *err)
{
    r->width = width;
    r->height = height;
    r->rgb = alloc_array(number_count(r), sizeof *r->rgb);
    return r->rgb != NULL || fail(err, "out of memory for a reference");
}

bool reference_read(struct reference *r, const char *scene_path, int reduce,
                    struct error *err)
{
    char *picture = path_beside(scene_path, "reference.pfm");
    struct image image = {0};
    uint64_t clamped;
    bool ok =
        image_read_linear(&image, picture, &clamped, err) &&
        read_noise(picture, &r->noise, err) &&
        reference_init(r, image.width / reduce, image.height / reduce, err);

    if (ok) {
        shrink(&image, reduce, r);
        r->noise /= reduce * reduce;
        snprintf(r->origin, sizeof r->origin, "by another renderer");
    }
    image_free(&image);
    free(picture);
    return ok;
}

/* Returns whether the file exists and is newer than the files of the scene. */
static bool is_fresh(const char *path, const char *scene_path)
{
    static const char *const endings[] = {"obj", "mtl", "view"};
    char *stem = path_stem(scene_path);
    struct stat own, other;
    bool fresh = stat(path, &own) == 0;

    for (size_t i = 0; i < sizeof endings / sizeof endings[0]; i++) {
        char *part = xformat("%s.%s", stem, endings[i]);

        fresh = fresh &&
                !(stat(part, &other) == 0 && other.st_mtime > own.st_mtime);
        free(part);
    }
    free(stem);
    return fresh;
}

static bool render_half(struct session *s, enum direct direct, int half,
                        const char *path, struct error *err)
{
    struct render_job job = {.host = &s->engine.world,
                             .crop = {0, 0, s->edit.now.view.width_px,
                                      s->edit.now.view.height_px},
                             .limits.spp = HALF_SPP};

    if (!world_lend(&s->engine.world, &s->engine.scene, &s->edit.now.view,
                    SEED_OF_HALVES + (uint32_t)half, &job.world, err))
        return false;
    job.world.settings.direct = direct;
    if (!render_start(s->engine.render, &job, err))
        return false;
    render_wait(s->engine.render, -1);
    return image_write(render_film(s->engine.render), develop_linear(0), NULL,
                       path, err);
}

/* Reads the half's picture from its file if that is new enough. */
static bool read_half(struct image *image, struct session *s,
                      enum direct direct, const char *folder, int half,
                      struct error *err)
{
    const char *scene_path = s->options->scene_path;
    const char *slash = strrchr(scene_path, '/');
    char *stem = path_stem(slash != NULL ? slash + 1 : scene_path);
    char *path = xformat("%s/%s-%d-%d.pfm", folder, stem, (int)direct, half);
    uint64_t clamped;
    bool ok = (is_fresh(path, scene_path) ||
               render_half(s, direct, half, path, err)) &&
              image_read_linear(image, path, &clamped, err);

    free(path);
    free(stem);
    return ok;
}

bool reference_make(struct reference *r, struct session *s, enum direct direct,
                    const char *folder, struct error *err)
{
    struct image halves[2] = {{0}, {0}};
    bool ok = reference_init(r, s->edit.now.view.width_px,
                             s->edit.now.view.height_px, err);

    for (int i = 0; ok && i < 2; i++)
        ok = read_half(&halves[i], s, direct, folder, i, err);
    if (ok) {
        for (size_t i = 0; i < number_count(r); i++)
            r->rgb[i] = (halves[0].rgb[i] + halves[1].rgb[i]) / 2;
        /* The mean of halves A and B has the variance ((A - B) / 2)^2. */
        r->noise = reference_error(r, halves[0].rgb);
        snprintf(r->origin, sizeof r->origin, "2 halves of %d spp by %s",
                 HALF_SPP,
                 direct == DIRECT_BSDF
                     ? "light met by chance alone"
                     : "glim itself, all techniques on, other seeds");
    }
    image_free(&halves[0]);
    image_free(&halves[1]);
    return ok;
}

void reference_free(struct reference *r)
{
    free(r->rgb);
    *r = (struct reference){0};
}
