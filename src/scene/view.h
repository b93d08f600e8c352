// SPDX-License-Identifier: MIT
/*
 * view.h - camera, environment light, exposure, size of a picture, and
 * materials that replace those of the scene, object by object: the contents of
 * a view file
 *
 * A name of an `assign OBJECT MATERIAL` line that is empty or contains blanks,
 * quotes, # or \ is written in double quotes; a quote inside them is doubled.
 *
 * Units:     as pose.h; pixels, radiance, degrees, stops
 * Ownership: view_free() and assigns_free() free the members; the structs are
 *            the caller's; zeroed assigns are empty
 * Threads:   one thread at a time
 * Errors:    false when memory is out
 */
#ifndef GLIM_VIEW_H
#define GLIM_VIEW_H

#include <stdbool.h>
#include <stdio.h>

#include "base/error.h"
#include "base/lexer.h"
#include "scene/lamp.h"
#include "scene/pose.h"
#include "scene/smoke.h"
#include "kernels/tone.h"

/* ---- names ---- */

/*
 * A name that is empty or contains blanks, quotes, # or \ is written in double
 * quotes; a quote inside them is doubled.
 */

/* Reads the next name of the line. *name is for free(), or NULL if there is
 * none or its closing quote is missing. */
bool quoted_name_read(struct lexer *lex, char **name);
void quoted_name_write(FILE *to, const char *name);

/* ---- assignments ---- */

struct assign {
    char *object, *material;
};

struct assigns {
    struct assign *items;
    size_t count;
};

/* Reads the rest of a line after the key `assign`. *has_names becomes true if
 * the line has exactly two names; only then the assignment is added. */
bool assigns_read(struct assigns *assigns, struct lexer *lex, bool *has_names);

/* Writes one `assign` line for each assignment, in order. */
void assigns_write(const struct assigns *assigns, FILE *to);

/* Assigns a material to an object and removes its earlier assignment. With
 * material NULL the object has the material of its file again. */
bool assigns_set(struct assigns *assigns, const char *object,
                 const char *material);

/* Replaces the contents of `to`; leaves them unchanged when memory is out. */
bool assigns_copy(struct assigns *to, const struct assigns *from);
void assigns_free(struct assigns *assigns);

/* ---- views ---- */

/* Number of stored camera poses: 1 to 9 in the file, indices from 0 here. */
#define VIEW_SHOTS 9

/* Greatest width and height of a picture. A square of this size exceeds most
 * memories, so that larger numbers can only be mistakes. */
#define VIEW_SIDE_MAX 65536

/* Sun with a clear sky around it (world/light/daylight.h). */
struct sun {
    bool is_on;
    double azimuth_deg;   /* clockwise seen from above, 0 at -z, 90 at +x */
    double elevation_deg; /* above the horizon */
    double turbidity;     /* haze of the air */
};

/* Greatest azimuth, either way, and greatest elevation in degrees. */
#define SUN_AZIMUTH_MAX   360
#define SUN_ELEVATION_MAX 90

/* Medium outside of all bodies. Above `base` its density falls by 1/e over each
 * `falloff`; 0: it is even. */
struct fog {
    double scatter[3], absorb[3]; /* coefficients per unit of length */
    double anisotropy; /* mean cosine of scattering; above 0: forward */
    double base, falloff;
};

/* Environment light, fog, exposure and tone mapping. */
struct lighting {
    double background[3]; /* constant radiance */
    bool has_background;
    /* path of an image that replaces the background, or NULL */
    char *sky_path;
    double sky_strength; /* factor for the image or the sun with its sky */
    double sky_rotation_deg;
    struct sun sun; /* replaces the image and the background if it is on */
    struct fog fog;
    double exposure; /* in stops: radiance is multiplied by 2^exposure */
    uint32_t tone;   /* enum tone */
};

/* View of a scene. has_x is true if the file or the person gave x; otherwise x
 * has its default. */
struct view {
    struct pose pose;
    bool has_camera; /* eye and at are given */
    struct lighting lighting;
    int width_px, height_px;
    bool has_size;
    int max_bounces; /* greatest number of bounces; -1: no limit */
    struct pose shots[VIEW_SHOTS]; /* the numbered poses */
    bool has_shot[VIEW_SHOTS];
    struct assigns assigns;
    struct lamps lamps;
    struct smokes smokes;
    uint32_t light_unit; /* enum light_unit, of the scene's lamps */
};

/* Names of enum tone in view files. */
extern const char *const view_tones[TONES];

/* Sets the defaults: no camera, up +y, fovy 40, 1024x576, black background, no
 * limit of bounces, and the sun off, in the south-east. */
void view_init(struct view *view);

/* Sets the size of the picture. A side of 0 is computed from the other one and
 * the previous aspect ratio. */
void view_set_size(struct view *view, int width_px, int height_px);

/* Switches the sun on at these angles. */
bool view_set_sun(struct view *view, double azimuth_deg, double elevation_deg,
                  struct error *err);

/* Sets the turbidity of the view's sun, which must be on. */
bool view_set_turbidity(struct view *view, double turbidity, struct error *err);

/* Returns true if the rectangle is not empty and inside the picture. */
bool view_has_part(const struct view *view, int x, int y, int width,
                   int height);

/* Replaces `to`, which must be zeroed or a lighting, by a copy of `from`.
 * Returns false, and changes nothing, when memory is out. */
bool lighting_copy(struct lighting *to, const struct lighting *from);
/* Returns true if all members are equal. */
bool lighting_equal(const struct lighting *a, const struct lighting *b);

/* Returns true if there is a fog: something scatters or absorbs. */
bool fog_is_there(const struct fog *fog);

/* Returns true if the same image shows both suns, turned by their azimuths. */
bool sun_has_same_sky(const struct sun *a, const struct sun *b);

/* Returns true if the light is the same: all members except exposure and tone
 * are equal, so that only the development differs. */
bool lighting_is_same_light(const struct lighting *a, const struct lighting *b);

/* Copies pose and numbered poses of `now` into `view`, except those that the
 * file has changed from `before` to `after`. */
void view_keep_camera(struct view *view, const struct view *now,
                      const struct view *before, const struct view *after);

/* Copies size and bounces, which the command line may set for one run. */
void view_copy_frame(struct view *view, const struct view *from);

/* Replaces `to`, which must be initialised, by a copy of `from`. Returns false,
 * and changes nothing, when memory is out. */
bool view_copy(struct view *to, const struct view *from);
void view_free(struct view *view);

#endif
