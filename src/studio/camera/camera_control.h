// SPDX-License-Identifier: MIT
/*
 * camera_control.h - the camera commands of keys and mouse
 *
 * A held key or a drag is one undo step. The picked point is the centre of
 * orbits and the point of focus, and its object is the one to frame. Walls stop
 * the camera unless it is told to pass them. A message says so, and names the
 * key to return when no part of the scene is in view.
 *
 * Units:     nanoseconds of clock_ns(), terminal cells
 * Ownership: control and screen are the caller's and outlive the camera
 * Threads:   main only
 * Errors:    become messages
 */
#ifndef GLIM_CAMERA_CONTROL_H
#define GLIM_CAMERA_CONTROL_H

#include <stdbool.h>
#include <stdint.h>

#include "studio/camera/camera_input.h"
#include "studio/camera/pick_cursor.h"

/* What the last message about a motion said. */
enum camera_trouble {
    CAMERA_FREE,       /* the normal case */
    CAMERA_STOPPED,    /* a surface stops the motion */
    CAMERA_OUT_OF_VIEW /* no part of the scene is in the picture */
};

struct camera_control {
    struct live_render *control;
    struct screen *screen;
    struct camera_input input;
    enum held_keys_axis held; /* axis of the last key */
    bool drag_is_new;         /* no motion since the press */
    struct pick_cursor cursor;
    bool passes_walls;
    enum camera_trouble reported;
    uint64_t reported_ns; /* time of the message about it */
};

void camera_control_init(struct camera_control *camera,
                         struct live_render *control, struct screen *screen);

/* Handles a press or repeat of a key of an axis. The camera moves while the key
 * is held. Sign is 1 or -1. */
void camera_control_move(struct camera_control *camera,
                         enum held_keys_axis axis, int sign);

/* Completes the motion of a held key at once, as if its time had passed, so
 * that the next command does not depend on how soon its key is pressed. */
void camera_control_end_move(struct camera_control *camera);

/* Changes the speed by steps; negative steps are slower. */
void camera_control_change_speed(struct camera_control *camera, int steps);

/* Picks the surface under the cursor, which becomes the centre of orbits. */
void camera_control_pick(struct camera_control *camera);

/* Picks the surface under the cursor and orbits it. Without a cursor, switches
 * between looking around and orbiting the last pick. */
void camera_control_switch_orbit(struct camera_control *camera);

/* Switches between walls that stop the camera and walls that it passes. */
void camera_control_switch_walls(struct camera_control *camera);

/* Move the camera so that the picked object or the whole scene fills the
 * picture. Something that is hidden in this direction is shown from another
 * one. */
void camera_control_frame_object(struct camera_control *camera);
void camera_control_frame_all(struct camera_control *camera);

/* Focuses on the picked point. */
void camera_control_focus(struct camera_control *camera);

/* Undoes (-1) or redoes (1) the last change of the edit, of any kind. */
void camera_control_step_history(struct camera_control *camera, int by);

/* Restores the camera that the scene was opened with, and the initial speed and
 * modes. Frames the whole scene if that camera is the present one. */
void camera_control_reset(struct camera_control *camera);

/* Store the camera as a numbered view, or go to one. Numbers are 1 to
 * VIEW_SHOTS. */
void camera_control_keep_view(struct camera_control *camera, int number);
void camera_control_go_to_view(struct camera_control *camera, int number);

void camera_control_mouse(struct camera_control *camera,
                          const struct event *event);

/* Moves the camera for the time that keys were held until now. Describes the
 * surface under the cursor. */
void camera_control_step(struct camera_control *camera, uint64_t now_ns);

/* Returns the time of the next camera_control_step(), or UINT64_MAX if nothing
 * moves. */
uint64_t camera_control_next_ns(const struct camera_control *camera);

/* Adapts to a newly loaded scene. The pick is dropped, since its numbers are
 * those of the old scene. */
void camera_control_set_scene(struct camera_control *camera);

/* Releases all keys and buttons. */
void camera_control_stop(struct camera_control *camera);

#endif
