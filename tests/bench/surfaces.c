// SPDX-License-Identifier: MIT
/*
 * surfaces - a picture with what other denoisers want: raw, filtered by glim,
 * and the mean albedo and normal of its first surfaces
 *
 * usage: surfaces SCENE SAMPLES STEM
 *
 * Writes STEM_raw.pfm, STEM_filtered.pfm, STEM_albedo.pfm and STEM_normal.pfm.
 * Rays that leave the scene have albedo 1 and no normal.
 */
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "film/filter/film_filter.h"
#include "film/image_write.h"
#include "session/session.h"
#include "terminal/xmalloc.h"
#include "tests/bench/render_crop.h"

static _Noreturn void stop(const struct error *err)
{
    fprintf(stderr, "surfaces: %s\n", err->text);
    exit(1);
}

static void render(struct session *s, uint64_t spp)
{
    struct rect crop = {0, 0, s->edit.now.view.width_px,
                        s->edit.now.view.height_px};
    struct error err;

    if (!render_crop(s, crop, spp, 1, FEATURE_FILTER, &err))
        stop(&err);
}

static void write_floats(const struct film *film, const float *rgb,
                         const char *stem, const char *name)
{
    char *path = xformat("%s_%s.pfm", stem, name);
    struct error err;

    if (!image_write_floats(rgb, film->width, film->height, path, &err))
        stop(&err);
    free(path);
}

static void write_film(struct film *film, const char *stem, const char *name)
{
    float *rgb =
        xcalloc((size_t)film->width * (size_t)film->height, 3 * sizeof *rgb);

    film_linear(film, rgb);
    write_floats(film, rgb, stem, name);
    free(rgb);
}

static void write_filtered(struct film *film, const char *stem)
{
    struct film filtered;
    struct error err;

    if (!film_init(&filtered, film->width, film->height, &err) ||
        !film_filter(film, NULL, &filtered, &err))
        stop(&err);
    write_film(&filtered, stem, "filtered");
    film_free(&filtered);
}

static void write_features(const struct film *film, const char *stem)
{
    size_t count = (size_t)film->width * (size_t)film->height;
    float *albedo = xcalloc(count, 3 * sizeof *albedo);
    float *normal = xcalloc(count, 3 * sizeof *normal);

    for (size_t i = 0; i < count; i++) {
        const struct surface_sums *s = &film->surfaces[i];
        float samples = (float)s->count, hits = (float)s->hit_count;

        for (size_t c = 0; c < 3; c++) {
            albedo[3 * i + c] =
                ((float)s->albedo[c] / SURFACE_ONE + samples - hits) / samples;
            normal[3 * i + c] =
                (2 * (float)s->normal[c] / SURFACE_ONE - hits) / samples;
        }
    }
    write_floats(film, albedo, stem, "albedo");
    write_floats(film, normal, stem, "normal");
    free(albedo);
    free(normal);
}

int main(int argc, char **argv)
{
    struct options o = {.max_bounces = -1};
    static struct session s;
    struct film *film;
    struct error err;

    if (argc != 4) {
        fprintf(stderr, "usage: surfaces SCENE SAMPLES STEM\n");
        return 2;
    }
    o.scene_path = argv[1];
    if (!session_open(&s, &o, clock_ns(), &err))
        stop(&err);
    render(&s, strtoull(argv[2], NULL, 10));
    film = render_film(s.engine.render);
    write_film(film, argv[3], "raw");
    write_filtered(film, argv[3]);
    write_features(film, argv[3]);
    session_close(&s);
    return 0;
}
