// SPDX-License-Identifier: MIT
/*
 * view_modes.h - a scene shown otherwise than by its light: as a preview, or in
 * false colours by normals, uvs, depth, materials, cost of rays, samples
 *
 * What has samples of its own (enum sample_kind) is rendered as a draft; the
 * cost of rays and the samples of pixels are counted here.
 *
 * Units:     frames' pixels
 * Ownership: the session stays the caller's and outlives it; view_mode_free()
 * frees the rest Threads:   main only Errors:    memory, threads
 */
#ifndef GLIM_VIEW_MODES_H
#define GLIM_VIEW_MODES_H

#include <stdbool.h>
#include <stddef.h>

#include "bvh/bvh.h"
#include "session/session.h"
#include "inspect/false_color.h"
#include "inspect/traversal_cost.h"

struct view_mode {
    struct session *session;
    enum show_kind kind;
    char legend[256]; /* "": of light there is none */
    bool has_news;    /* in the legend; the screen clears it */

    struct bvh bvh; /* built when it is first wanted */
    bool has_bvh;
    struct pool *pool; /* likewise */

    float *numbers; /* of the frame that was painted last, or of its film */
    size_t number_capacity;
    struct traversal_cost *costs; /* of cost_camera and so many pixels */
    struct camera cost_camera;
    int cost_width, cost_height;
};

void view_mode_init(struct view_mode *s, struct session *session);

/* The samples that it is made of. */
enum sample_kind view_mode_sample(enum show_kind kind);

/* From now on; light if that fails. */
bool view_mode_set(struct view_mode *s, enum show_kind kind, struct error *err);

/* How films are to be shown: colours of a preview are as they are. */
struct develop view_mode_develop(const struct view_mode *s);

/* Replaces what a film and its draft show in a frame. */
void view_mode_paint(struct view_mode *s, struct film *film, struct film *draft,
                     struct frame *frame);

/* Fills a frame of any size with the whole picture as it is shown, not through
 * a draft: film is what light and samples are taken from, and may be NULL for
 * the others. Blocks while the rest is computed. */
bool view_mode_picture(struct view_mode *s, struct film *film,
                       struct frame *frame, struct error *err);

/* A binary tree of the scene, for drawings and costs, and the world as it is
 * rendered, but with that tree. */
bool view_mode_need_tree(struct view_mode *s, struct error *err);
bool view_mode_world(const struct view_mode *s, struct world *w);

/* The same camera in pixels of the frame. */
struct camera view_mode_camera(const struct view_mode *s,
                               const struct camera *camera,
                               const struct frame *frame);

/* The scene is another one: what was made of the old one is dropped. */
void view_mode_renew(struct view_mode *s);

void view_mode_free(struct view_mode *s);

#endif
