// SPDX-License-Identifier: MIT
/*
 * view_modes.h - other views of a scene: a preview, or false colours for
 * normals, uvs, depth, materials, cost of rays, samples, error
 *
 * Kinds with samples of their own (enum sample_kind) are rendered like a
 * draft. The cost of rays, the sample counts and the errors of pixels are
 * computed here.
 *
 * Units:     pixels of frames
 * Ownership: the session stays the caller's and outlives the view_mode;
 *            view_mode_free() frees the rest
 * Threads:   main only
 * Errors:    memory, threads
 */
#ifndef GLIM_VIEW_MODES_H
#define GLIM_VIEW_MODES_H

#include <stdbool.h>
#include <stddef.h>

#include "film/filter/screen_filter.h"
#include "inspect/false_color.h"
#include "inspect/traversal_cost.h"
#include "session/session.h"

struct view_mode {
    struct session *session;
    enum show_kind kind;
    char legend[256];   /* "" for light, which has none */
    bool legend_is_new; /* cleared by the screen */

    bool is_filtered; /* the last frame for the screen */
    struct screen_filter filter;

    struct pool *pool; /* of world_pool(), started on first use */

    float *numbers; /* of the frame that was painted last, or of its film */
    size_t number_capacity;
    uint64_t error_spp; /* of the errors in `numbers`; 0: none */
    uint64_t error_restart_ns;
    struct film_error error;      /* of that picture */
    struct traversal_cost *costs; /* for cost_camera, one for each pixel */
    uint64_t cost_generation;
    struct camera cost_camera;
    int cost_width, cost_height;
};

void view_mode_init(struct view_mode *s, struct session *session);

/* Returns the kind of samples that a view needs. */
enum sample_kind view_mode_sample(enum show_kind kind);

/* Switches the view. If that fails, light is shown. */
bool view_mode_set(struct view_mode *s, enum show_kind kind, struct error *err);

/* Fills a frame for the screen: light and the preview as film_preview() does,
 * false colours from the numbers of the draft or the film. Light is filtered if
 * there are surfaces (NULL: none) to do it. */
void view_mode_preview(struct view_mode *s, struct film *film,
                       struct film *draft, struct film *surfaces,
                       struct frame *frame);

/* Fills a frame of any size with the whole picture of this view, without a
 * draft. Light, sample counts and errors are taken from `film`, which may be
 * NULL for other views. Light is filtered if the last frame for the screen was.
 * Blocks while the rest is computed. */
bool view_mode_picture(struct view_mode *s, struct film *film,
                       struct frame *frame, struct error *err);

/* Lends the world as rendered, with its tree if that has been built. */
bool view_mode_world(const struct view_mode *s, struct world *w);

/* Lends the world as rendered with its tree, which is built if there is none.
 */
bool view_mode_traced(struct view_mode *s, struct world *w, struct error *err);

/* The same with a camera of width x height pixels for the whole picture. */
bool view_mode_scaled(struct view_mode *s, int width, int height,
                      struct world *w, struct error *err);

/* Fills a frame with the preview from another place. Blocks for some
 * milliseconds, and while the tree is built. */
bool view_mode_thumbnail(struct view_mode *s, const struct pose *pose,
                         struct frame *frame, struct error *err);

/* Returns the threads for pictures of the view, which start on first use. */
struct pool *view_mode_pool(struct view_mode *s);

/* Returns the camera scaled to the pixels of the frame. */
struct camera view_mode_camera(const struct view_mode *s,
                               const struct camera *camera,
                               const struct frame *frame);

void view_mode_free(struct view_mode *s);

#endif
