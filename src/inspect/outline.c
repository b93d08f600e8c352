// SPDX-License-Identifier: MIT
#include "inspect/outline.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/min_max.h"
#include "world/bvh/ray_queries.h"
#include "kernels/camera.h"

#define COLOR 0xff9a2eu

/* Width of the line: a pixel for so many pixels of the frame. */
#define PIXELS_A_LINE 300

static bool is_chosen(const struct world *w, const struct scene *scene,
                      struct outline_choice choice, struct ray ray)
{
    struct hit h;

    if (!hit_closest(w, ray, &h))
        return false;
    return choice.index ==
           (choice.is_object ? scene_tri_object(scene, h.tri)
                             : tri_material(w, h.tri, instance_of(w, h.tri)));
}

static bool resize(struct outline *o, const struct frame *frame)
{
    double places = (double)frame->width * frame->height;
    double scale = fmin(1, sqrt(OUTLINE_PLACES / places));
    int width = (int)fmax(1, frame->width * scale);
    int height = (int)fmax(1, frame->height * scale);

    if (o->mask && width == o->width && height == o->height)
        return true;
    outline_free(o);
    o->mask = alloc_array((size_t)width * (size_t)height, sizeof *o->mask);
    o->width = width;
    o->height = height;
    return o->mask != NULL;
}

void outline_find(struct outline *o, const struct world *w,
                  const struct scene *scene, uint64_t version,
                  struct outline_choice choice, const struct frame *frame)
{
    const struct camera *camera = &w->settings.camera;

    if (!resize(o, frame) ||
        (o->version == version && o->choice.index == choice.index &&
         o->choice.is_object == choice.is_object &&
         memcmp(&o->camera, camera, sizeof *camera) == 0))
        return;
    o->version = version;
    o->choice = choice;
    o->camera = *camera;
    for (int y = 0; y < o->height; y++) {
        for (int x = 0; x < o->width; x++) {
            double px = (x + 0.5) * frame->width / o->width;
            double py = (y + 0.5) * frame->height / o->height;
            struct vec2 within = {(float)(px - floor(px)),
                                  (float)(py - floor(py))};

            o->mask[y * o->width + x] =
                is_chosen(w, scene, choice,
                          camera_ray(*camera, (uint32_t)px, (uint32_t)py,
                                     within));
        }
    }
}

/* Returns the mask at a pixel of the frame, that of the border outside. */
static bool mask_at(const struct outline *o, const struct frame *frame, int x,
                    int y)
{
    x = index_clamp(x, frame->width);
    y = index_clamp(y, frame->height);
    return o->mask[(size_t)y * (size_t)o->height / (size_t)frame->height *
                       (size_t)o->width +
                   (size_t)x * (size_t)o->width / (size_t)frame->width];
}

void outline_draw(const struct outline *o, struct frame *frame)
{
    int reach = 1 + frame->width / PIXELS_A_LINE;

    if (!o->mask)
        return;
    for (int y = 0; y < frame->height; y++) {
        for (int x = 0; x < frame->width; x++) {
            if (!mask_at(o, frame, x, y) && (mask_at(o, frame, x - reach, y) ||
                                             mask_at(o, frame, x + reach, y) ||
                                             mask_at(o, frame, x, y - reach) ||
                                             mask_at(o, frame, x, y + reach)))
                frame_dot(frame, x, y, COLOR);
        }
    }
}

void outline_free(struct outline *o)
{
    free(o->mask);
    *o = (struct outline){.mask = NULL};
}
