// SPDX-License-Identifier: MIT
/*
 * camera_input.h - keys that are held and a mouse that is dragged, to motions
 * of a camera
 *
 * Moves are as fast as what is around is far: in a room slow, slower at a wall,
 * fast over a landscape, the same for a model of any size. A key that is held
 * on gets faster.
 *
 * Units:     nanoseconds of clock_ns(), terminal cells, file units
 * Ownership: the pose stays the caller's
 * Threads:   one thread at a time
 */
#ifndef GLIM_CAMERA_INPUT_H
#define GLIM_CAMERA_INPUT_H

#include <stdbool.h>
#include <stdint.h>

#include "scene/pose.h"
#include "terminal/cells.h"
#include "terminal/tty_input.h"
#include "studio/held_keys.h"

struct camera_input {
    struct held_keys motion;
    double scene_size;
    double reach;      /* how far things are, for the speed of moves */
    double speed;      /* the person's factor; 1 at first */
    uint64_t begun_ns; /* when the key that is held went down */
    bool is_orbiting;  /* what would look around turns about the pivot */
    double pivot[3];
    bool is_dragging;
    bool drag_orbits;
    bool has_dragged; /* since the button went down */
    int drag_x, drag_y;
};

/* For a scene between these corners. */
void camera_input_init(struct camera_input *s, const double lo[3],
                       const double hi[3]);

/* The scene is between other corners now: what was chosen stays. */
void camera_input_resize(struct camera_input *s, const double lo[3],
                         const double hi[3]);

/* What the speed of moves follows: how far the surfaces near the eye are
 * (INFINITY: there is none), and how far the scene's box is (0 within it). */
void camera_input_adapt(struct camera_input *s, double near, double away);

/* File units a second that a key moves at first. */
double camera_input_speed(const struct camera_input *s);

/* A key goes down that was not held: moves begin slowly. */
void camera_input_begin(struct camera_input *s, uint64_t now_ns);

/* Moves by the time that keys were held since the last call. True if the pose
 * has changed. */
bool camera_input_step(struct camera_input *s, struct pose *pose,
                       uint64_t now_ns);

/* True for a button that turns about the pivot: any that is no plain left one,
 * and all while is_orbiting. */
bool camera_input_orbits(const struct camera_input *s,
                         const struct event *event);

/* Follows the pointer while a button is down; the picture of width_px x
 * height_px pixels lies at `fit`. True if the pose has changed. */
bool camera_input_mouse(struct camera_input *s, struct pose *pose,
                        const struct event *event, const struct cells_rect *fit,
                        int width_px, int height_px);

/* Faster or slower by some steps. */
void camera_input_change_speed(struct camera_input *s, int steps);

#endif
