// SPDX-License-Identifier: MIT
#include "scene/view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

const char *const view_tones[TONES] = {
    [TONE_LINEAR] = "linear",
    [TONE_REINHARD] = "reinhard",
    [TONE_ACES] = "aces",
};

void view_init(struct view *view)
{
    *view = (struct view){
        .up = {0, 1, 0},
        .fovy_deg = 40,
        .width_px = 1024,
        .height_px = 576,
        .max_bounces = -1,
        .sky_strength = 1,
    };
}

static bool is_zero(const double v[3])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

bool view_check(const struct view *view, const char *place, struct error *err)
{
    double look[3];

    for (int i = 0; i < 3; i++) {
        look[i] = view->at[i] - view->eye[i];
        if (!isfinite(look[i]) || !isfinite(view->up[i]))
            return fail(err,
                        "%s: found a camera at infinity, expected finite "
                        "numbers for eye, at and up",
                        place);
    }
    if (is_zero(look))
        return fail(err, "%s: found eye and at in one point, expected two",
                    place);
    if (is_zero(view->up))
        return fail(err, "%s: found 0 0 0, expected a direction for up", place);
    if (!(view->fovy_deg > 0 && view->fovy_deg < 180))
        return fail(err,
                    "%s: found a fovy of %g degrees, expected one above "
                    "0 and below 180",
                    place, view->fovy_deg);
    return true;
}

struct pose view_pose(const struct view *view)
{
    struct pose pose = {.fovy_deg = view->fovy_deg,
                        .aperture = view->aperture,
                        .focus = view->focus};

    memcpy(pose.eye, view->eye, sizeof pose.eye);
    memcpy(pose.at, view->at, sizeof pose.at);
    memcpy(pose.up, view->up, sizeof pose.up);
    return pose;
}

void view_set_pose(struct view *view, const struct pose *pose)
{
    memcpy(view->eye, pose->eye, sizeof view->eye);
    memcpy(view->at, pose->at, sizeof view->at);
    memcpy(view->up, pose->up, sizeof view->up);
    view->has_camera = true;
    view->fovy_deg = pose->fovy_deg;
    view->aperture = pose->aperture;
    view->focus = pose->focus;
}

void view_take_frame(struct view *view, const struct view *from)
{
    view->width_px = from->width_px;
    view->height_px = from->height_px;
    view->has_size = from->has_size;
    view->max_bounces = from->max_bounces;
}

void view_copy(struct view *to, const struct view *from)
{
    char *sky_path = from->sky_path ? xstrdup(from->sky_path) : NULL;
    struct assigns assigns = {0};

    assigns_copy(&assigns, &from->assigns);
    view_free(to);
    *to = *from;
    to->sky_path = sky_path; /* copies of its own */
    to->assigns = assigns;
}

static bool has_other_camera(const struct view *a, const struct view *b)
{
    struct pose of_a = view_pose(a), of_b = view_pose(b);

    return a->has_camera != b->has_camera ||
           memcmp(&of_a, &of_b, sizeof of_a) != 0;
}

static bool has_other_sky(const struct view *a, const struct view *b)
{
    return !a->sky_path != !b->sky_path ||
           (a->sky_path && strcmp(a->sky_path, b->sky_path) != 0);
}

static void take_camera(struct view *view, const struct view *from)
{
    struct pose pose = view_pose(from);

    view_set_pose(view, &pose);
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

void view_merge(struct view *view, const struct view *before,
                const struct view *after)
{
    /* one that was placed by the program follows the scene, not the file */
    if (after->has_camera && has_other_camera(before, after))
        take_camera(view, after);
    take_shots(view, before, after);
    if (before->width_px != after->width_px ||
        before->height_px != after->height_px) {
        view->width_px = after->width_px;
        view->height_px = after->height_px;
        view->has_size = after->has_size;
    }
    if (memcmp(before->background, after->background,
               sizeof after->background) != 0) {
        memcpy(view->background, after->background, sizeof view->background);
        view->has_background = after->has_background;
    }
    if (has_other_sky(before, after)) {
        free(view->sky_path);
        view->sky_path = after->sky_path ? xstrdup(after->sky_path) : NULL;
    }
    if (before->max_bounces != after->max_bounces)
        view->max_bounces = after->max_bounces;
    if (before->sky_strength != after->sky_strength)
        view->sky_strength = after->sky_strength;
    if (before->sky_rotation_deg != after->sky_rotation_deg)
        view->sky_rotation_deg = after->sky_rotation_deg;
    if (before->exposure != after->exposure)
        view->exposure = after->exposure;
    if (before->tone != after->tone)
        view->tone = after->tone;
}

void view_free(struct view *view)
{
    free(view->sky_path);
    assigns_free(&view->assigns);
    *view = (struct view){0};
}
