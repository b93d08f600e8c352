// SPDX-License-Identifier: MIT
/*
 * camera_control.h - what keys and mouse do with the camera
 *
 * Moves are held keys or drags; each is one step of undo. What is picked is the
 * point to orbit and to focus on, and its object the one to frame. Who leaves a
 * room through its wall, flies into a solid or sees nothing of the scene any
 * more is told how to come back.
 *
 * Units:     nanoseconds of clock_ns(), terminal cells
 * Ownership: control and screen stay the caller's and outlive the camera
 * Threads:   main only
 * Errors:    become messages
 */
#ifndef GLIM_CAMERA_CONTROL_H
#define GLIM_CAMERA_CONTROL_H

#include <stdbool.h>
#include <stdint.h>

#include "studio/camera_input.h"
#include "studio/clearance.h"
#include "studio/pick_cursor.h"

struct camera_control {
    struct render_control *control;
    struct screen *screen;
    struct camera_input input;
    enum held_keys_axis held; /* the last key was for this axis */
    bool drag_is_new;         /* nothing has moved yet */
    struct pick_cursor cursor;
    struct clearance clearance; /* of the eye, where it was last */
    enum clearance_state reported_state;
    uint64_t reported_ns; /* when, if it was a message */
};

void camera_control_init(struct camera_control *camera,
                         struct render_control *control, struct screen *screen);

/* A key for this axis was pressed, or repeats: the camera moves as long as it
 * is held. Sign is 1 or -1. */
void camera_control_move(struct camera_control *camera,
                         enum held_keys_axis axis, int sign);

/* Ends what is moving, where it would have ended: a command that follows a tap
 * finds the same view, however soon its key comes. */
void camera_control_end_move(struct camera_control *camera);

void camera_control_faster(struct camera_control *camera);
void camera_control_slower(struct camera_control *camera);

/* Picks what is under the cursor; that is the point to orbit then. */
void camera_control_pick(struct camera_control *camera);

/* Orbits what the cursor shows; without a cursor switches between looking
 * around and orbiting what was picked. */
void camera_control_switch_orbit(struct camera_control *camera);

/* Moves back until the picked object or the whole scene is in view. */
void camera_control_frame_object(struct camera_control *camera);
void camera_control_frame_all(struct camera_control *camera);

void camera_control_focus(struct camera_control *camera);
/* Undoes or redoes the last change, whatever it was. */
void camera_control_undo(struct camera_control *camera);
void camera_control_redo(struct camera_control *camera);

/* Back to the view as it was opened. */
void camera_control_reset(struct camera_control *camera);

/* Numbers are 1 to VIEW_SHOTS. */
void camera_control_keep_view(struct camera_control *camera, int number);
void camera_control_go_to_view(struct camera_control *camera, int number);

void camera_control_mouse(struct camera_control *camera,
                          const struct event *event);

/* Moves the camera as far as keys were held until now; says what is under the
 * cursor. */
void camera_control_step(struct camera_control *camera, uint64_t now_ns);

/* When to call camera_control_step() next; UINT64_MAX: nothing moves. */
uint64_t camera_control_next_ns(const struct camera_control *camera);

/* After the scene was loaded anew: what was picked is of the one before. */
void camera_control_set_scene(struct camera_control *camera);

/* Lets go of all keys and buttons. */
void camera_control_stop(struct camera_control *camera);

#endif
