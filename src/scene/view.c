// SPDX-License-Identifier: MIT
#include "scene/view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const view_tones[TONES] = {
    [TONE_LINEAR] = "linear",
    [TONE_REINHARD] = "reinhard",
    [TONE_ACES] = "aces",
};

void view_init(struct view *view)
{
    *view = (struct view){
        .pose = {.up = {0, 1, 0}, .fovy_deg = 40},
        .lighting = {.sky_strength = 1},
        .width_px = 1024,
        .height_px = 576,
        .max_bounces = -1,
    };
}

void view_take_frame(struct view *view, const struct view *from)
{
    view->width_px = from->width_px;
    view->height_px = from->height_px;
    view->has_size = from->has_size;
    view->max_bounces = from->max_bounces;
}

/* The other side of a picture whose shape is kept. */
static int other_side(int side, int from, int to)
{
    double other = round((double)side * to / from);

    return other < 1.0 ? 1 : other > VIEW_SIDE_MAX ? VIEW_SIDE_MAX : (int)other;
}

void view_set_size(struct view *view, int width_px, int height_px)
{
    if (height_px == 0)
        height_px = other_side(width_px, view->width_px, view->height_px);
    else if (width_px == 0)
        width_px = other_side(height_px, view->height_px, view->width_px);
    view->width_px = width_px;
    view->height_px = height_px;
    view->has_size = true;
}

bool view_has_part(const struct view *view, int x, int y, int width, int height)
{
    return x >= 0 && y >= 0 && width > 0 && height > 0 &&
           width <= view->width_px && height <= view->height_px &&
           x <= view->width_px - width && y <= view->height_px - height;
}

/* False when memory is out. */
static bool copy_path(char **to, const char *from)
{
    *to = from ? strdup(from) : NULL;
    return *to || !from;
}

bool view_copy(struct view *to, const struct view *from)
{
    char *sky_path;
    struct assigns assigns = {0};

    if (!copy_path(&sky_path, from->lighting.sky_path) ||
        !assigns_copy(&assigns, &from->assigns)) {
        free(sky_path);
        return false;
    }
    view_free(to);
    *to = *from;
    to->lighting.sky_path = sky_path; /* copies of its own */
    to->assigns = assigns;
    return true;
}

static void take_shots(struct view *view, const struct view *before,
                       const struct view *after)
{
    for (int i = 0; i < VIEW_SHOTS; i++) {
        if (before->has_shot[i] == after->has_shot[i] &&
            memcmp(&before->shots[i], &after->shots[i],
                   sizeof after->shots[i]) == 0)
            continue;
        view->shots[i] = after->shots[i];
        view->has_shot[i] = after->has_shot[i];
    }
}

static bool has_other_sky(const struct lighting *a, const struct lighting *b)
{
    return !a->sky_path != !b->sky_path ||
           (a->sky_path && strcmp(a->sky_path, b->sky_path) != 0);
}

static bool take_sky(struct lighting *to, const struct lighting *before,
                     const struct lighting *after)
{
    char *sky_path;

    if (!has_other_sky(before, after))
        return true;
    if (!copy_path(&sky_path, after->sky_path))
        return false;
    free(to->sky_path);
    to->sky_path = sky_path;
    return true;
}

static void take_lighting(struct lighting *to, const struct lighting *before,
                          const struct lighting *after)
{
    if (memcmp(before->background, after->background,
               sizeof after->background) != 0) {
        memcpy(to->background, after->background, sizeof to->background);
        to->has_background = after->has_background;
    }
    if (before->sky_strength != after->sky_strength)
        to->sky_strength = after->sky_strength;
    if (before->sky_rotation_deg != after->sky_rotation_deg)
        to->sky_rotation_deg = after->sky_rotation_deg;
    if (before->exposure != after->exposure)
        to->exposure = after->exposure;
    if (before->tone != after->tone)
        to->tone = after->tone;
}

bool view_merge(struct view *view, const struct view *before,
                const struct view *after)
{
    if (!take_sky(&view->lighting, &before->lighting, &after->lighting))
        return false;
    /* one that was placed by the program follows the scene, not the file */
    if (after->has_camera &&
        (!before->has_camera ||
         memcmp(&before->pose, &after->pose, sizeof after->pose) != 0)) {
        view->pose = after->pose;
        view->has_camera = true;
    }
    take_shots(view, before, after);
    if (before->width_px != after->width_px ||
        before->height_px != after->height_px) {
        view->width_px = after->width_px;
        view->height_px = after->height_px;
        view->has_size = after->has_size;
    }
    take_lighting(&view->lighting, &before->lighting, &after->lighting);
    if (before->max_bounces != after->max_bounces)
        view->max_bounces = after->max_bounces;
    return true;
}

void view_free(struct view *view)
{
    free(view->lighting.sky_path);
    assigns_free(&view->assigns);
    *view = (struct view){0};
}
