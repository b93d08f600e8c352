// SPDX-License-Identifier: MIT
/*
 * camera_input.h - keys that are held and a mouse that is dragged, to motions of a
 * view's camera
 *
 * Moves are as fast as what is around is far: in a room slow, slower at a wall,
 * fast over a landscape, the same for a model of any size. A key that is held
 * on gets faster.
 *
 * Units:     nanoseconds of clock_ns(), terminal cells, file units
 * Ownership: the view stays the caller's
 * Threads:   one thread at a time
 * Errors:    none
 */
#ifndef GLIM_CAMERA_INPUT_H
#define GLIM_CAMERA_INPUT_H

#include "terminal/cells.h"
#include "terminal/tty_input.h"
#include "studio/held_keys.h"
#include "scene/view.h"

struct steer {
    struct motion motion;
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
void steer_init(struct steer *s, const double lo[3], const double hi[3]);

/* The scene is between other corners now: what was chosen stays. */
void steer_resize(struct steer *s, const double lo[3], const double hi[3]);

/* What the speed of moves follows: how far the surfaces near the eye are
 * (INFINITY: there is none), and how far the scene's box is (0 within it). */
void steer_adapt(struct steer *s, double near, double away);

/* File units a second that a key moves at first. */
double steer_speed(const struct steer *s);

/* A key goes down that was not held: moves begin slowly. */
void steer_begin(struct steer *s, uint64_t now_ns);

/* Moves by the time that keys were held since the last call. True if the view
 * has changed. */
bool steer_step(struct steer *s, struct view *view, uint64_t now_ns);

/* True for a button that turns about the pivot: any that is no plain left one,
 * and all while is_orbiting. */
bool steer_orbits(const struct steer *s, const struct event *event);

/* Follows the pointer while a button is down; the picture of width_px x
 * height_px pixels lies at `fit`. True if the view has changed. */
bool steer_mouse(struct steer *s, struct view *view, const struct event *event,
                 const struct fit *fit, int width_px, int height_px);

/* Faster or slower by some steps. */
void steer_change_speed(struct steer *s, int steps);

#endif
