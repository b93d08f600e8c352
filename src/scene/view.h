// SPDX-License-Identifier: MIT
/*
 * view.h - where the camera stands, what the sky is, how the picture is exposed
 *
 * Units:     as pose.h; pixels, radiance, degrees, stops
 * Ownership: view_free() frees what is in it
 * Threads:   one thread at a time
 */
#ifndef GLIM_VIEW_H
#define GLIM_VIEW_H

#include "base/error.h"
#include "scene/assign.h"
#include "scene/pose.h"
#include "kernels/tone.h"

/* Views that have a number: 1 to 9 in the file, from 0 here. */
#define VIEW_SHOTS 9

/* Neither side of a picture is longer: its square fits no memory, but is no
 * nonsense. */
#define VIEW_SIDE_MAX 65536

/* The light that comes from no surface, and how the picture is developed. */
struct lighting {
    double background[3]; /* constant radiance */
    bool has_background;
    char *sky_path; /* of an image, which replaces the background; NULL: none */
    double sky_strength;
    double sky_rotation_deg;
    double exposure; /* stops: the picture is multiplied by 2^exposure */
    uint32_t tone;   /* enum tone */
};

/* has_x says that the file (or the person) gave x; the value is a sensible
 * default else. */
struct view {
    struct pose pose;
    bool has_camera; /* eye and at are given */
    struct lighting lighting;
    int width_px, height_px;
    bool has_size;
    int max_bounces;               /* -1: no limit */
    struct pose shots[VIEW_SHOTS]; /* the numbered views */
    bool has_shot[VIEW_SHOTS];
    struct assigns assigns;
};

/* Names of enum tone. */
extern const char *const view_tones[TONES];

/* Defaults: no camera, up +y, fovy 40, 1024x576, black, no limit. */
void view_init(struct view *view);

/* Sets the size of the picture. A side of 0 follows from the other one and the
 * shape of the picture before. */
void view_set_size(struct view *view, int width_px, int height_px);

/* True if the rectangle lies in the picture. */
bool view_has_part(const struct view *view, int x, int y, int width,
                   int height);

/* `to` is zeroed or a lighting, which is freed. Returns false, and changes
 * nothing, when memory is out. */
bool lighting_copy(struct lighting *to, const struct lighting *from);
bool lighting_equal(const struct lighting *a, const struct lighting *b);

/* Returns true if the picture of one is that of the other, developed in another
 * way: all but exposure and tone is equal. */
bool lighting_is_same_light(const struct lighting *a, const struct lighting *b);

/* Takes over the camera of `now`, and its numbered views, but for what the file
 * has changed from `before` to `after`. */
void view_keep_camera(struct view *view, const struct view *now,
                      const struct view *before, const struct view *after);

/* Takes over size and bounces: what the command line may say for one run. */
void view_take_frame(struct view *view, const struct view *from);

/* `to` has been through view_init(). Returns false, and changes nothing, when
 * memory is out. */
bool view_copy(struct view *to, const struct view *from);
void view_free(struct view *view);

#endif
