// SPDX-License-Identifier: MIT
#include "inspect/error_map.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "film/film_error.h"
#include "film/image_write.h"
#include "inspect/false_color.h"

uint32_t error_map_color(float error)
{
    if (!(error > ERROR_MAP_BLACK))
        return false_color_heat(0);
    return false_color_heat(logf(error / ERROR_MAP_BLACK) /
                            logf(ERROR_MAP_WHITE / ERROR_MAP_BLACK));
}

static bool write_colors(const float *map, int width, int height,
                         const char *path, struct error *err)
{
    struct frame frame = {0};
    bool ok = frame_init(&frame, width, height, err);

    for (int y = 0; ok && y < height; y++)
        for (int x = 0; x < width; x++)
            frame_dot(&frame, x, y,
                      error_map_color(
                          map[(size_t)y * (size_t)width + (size_t)x]));
    ok = ok && image_write_frame(&frame, path, err);
    frame_free(&frame);
    return ok;
}

static bool write_numbers(const float *map, int width, int height,
                          const char *path, struct error *err)
{
    size_t pixels = (size_t)width * (size_t)height;
    float *rgb = alloc_array(pixels, 3 * sizeof *rgb);
    bool ok;

    if (rgb == NULL)
        return fail(err, "%s: out of memory for %dx%d pixels", path, width,
                    height);
    for (size_t i = 0; i < 3 * pixels; i++)
        rgb[i] = map[i / 3];
    ok = image_write_floats(rgb, width, height, path, err);
    free(rgb);
    return ok;
}

bool error_map_write(struct film *film, float exposure, const char *path,
                     struct error *err)
{
    int width = film->width, height = film->height;
    float *map = alloc_array((size_t)width * (size_t)height, sizeof *map);
    bool ok;

    if (map == NULL)
        ok = fail(err, "%s: out of memory for %dx%d pixels", path, width,
                  height);
    else if (!film_error_map(film, exposure, NULL, map))
        ok = fail(err,
                  "%s: found a pixel with less than two samples, which has no "
                  "known error",
                  path);
    else if (image_write_format_of(path) == IMAGE_WRITE_PNG)
        ok = write_colors(map, width, height, path, err);
    else
        ok = write_numbers(map, width, height, path, err);
    free(map);
    return ok;
}
