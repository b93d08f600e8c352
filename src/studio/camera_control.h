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
 * Ownership: control and screen stay the caller's and outlive the camera;
 *            camera_control_free() frees the rest
 * Threads:   main only
 * Errors:    become messages
 */
#ifndef GLIM_CAMERA_CONTROL_H
#define GLIM_CAMERA_CONTROL_H

#include <stdbool.h>
#include <stdint.h>

#include "studio/camera_history.h"
#include "studio/camera_input.h"
#include "studio/clearance.h"
#include "studio/pick_cursor.h"

struct camera_control {
    struct render_control *control;
    struct screen *screen;
    struct camera_input input;
    struct camera_history history;
    enum action held; /* what the last step of undo was made by, and when */
    uint64_t held_ns;
    bool drag_is_new; /* no step of undo yet */
    struct pick_cursor cursor;
    struct clearance clearance; /* of the eye, where it was last */
    enum clearance_place said;
    uint64_t said_ns; /* when, if it was a message */
};

void camera_control_init(struct camera_control *camera,
                         struct render_control *control, struct screen *screen);

/* Does what the action says of camera and cursor. False if it is not the
 * camera's. Any but a move ends what is moving, where it would have ended. */
bool camera_control_act(struct camera_control *camera, enum action action);

/* Gives the view the number of an ACTION_VIEW_1 to _9; no other action does. */
void camera_control_keep_view(struct camera_control *camera,
                              enum action action);

void camera_control_mouse(struct camera_control *camera,
                          const struct event *event);

/* Moves the camera as far as keys were held until now; says what is under the
 * cursor. */
void camera_control_step(struct camera_control *camera, uint64_t now_ns);

/* When to call camera_control_step() next; UINT64_MAX: nothing moves. */
uint64_t camera_control_next_ns(const struct camera_control *camera);

/* After the scene was loaded anew: what was picked is of the one before. */
void camera_control_renew(struct camera_control *camera);

/* Lets go of all keys and buttons. */
void camera_control_stop(struct camera_control *camera);

void camera_control_free(struct camera_control *camera);

#endif
