// SPDX-License-Identifier: MIT
/*
 * edit_history.h - the list of changes to a scene, for undo and redo
 *
 * A step is one changed value. It holds the value that the scene does not have:
 * the one before the change if the step is done, the one after it if the step
 * was undone. The caller (edit.c) exchanges it with the scene's. Steps of one
 * group are undone and redone together.
 *
 * Units:     those of MTL and view files; times are of clock_ns()
 * Ownership: edit_history_free() frees; a zeroed history is empty
 * Threads:   one thread at a time
 * Errors:    the program ends when memory is out
 */
#ifndef GLIM_EDIT_HISTORY_H
#define GLIM_EDIT_HISTORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "scene/material.h"
#include "scene/view.h"

enum edit_step_kind {
    STEP_MATERIAL,
    STEP_ASSIGN,
    STEP_DUPLICATE,
    STEP_LIGHTING,
    STEP_LAMPS,
    STEP_POSE,
    STEP_SHOT
};

/* A numbered view, or its absence. */
struct edit_shot {
    struct pose pose;
    bool is_there;
};

struct edit_step {
    enum edit_step_kind kind;
    uint32_t index; /* of the material, object, lamp or numbered view */
    uint32_t group;
    union {
        struct mtl_source *source; /* the step's own; it is larger than other
                                      values, and most steps are poses */
        uint32_t material;
        bool is_there;
        struct lighting lighting; /* its sky_path is borrowed from the edit */
        struct lamps lamps;       /* the step's own */
        struct pose pose;
        struct edit_shot shot;
    } value;
};

struct edit_history {
    struct edit_step *steps;
    size_t step_count, step_capacity;
    size_t done_count;   /* the later steps were undone */
    uint32_t group;      /* group of the next step */
    uint32_t gesture;    /* gesture of the next step; 0: none */
    uint64_t gesture_ns; /* time of the gesture's last event */
};

/* Ends the current group; the next step begins a new one. */
void edit_history_end_step(struct edit_history *history);

/* Begins a new group unless the gesture, a number above 0, is that of the
 * previous call, at most 700 ms before `now_ns`. Returns true if a group
 * begins. */
bool edit_history_begin_gesture(struct edit_history *history, uint32_t gesture,
                                uint64_t now_ns);

/* Adds a step that was done, with the value before it, and drops all undone
 * steps. A step that continues the last one (same group, kind and index) is
 * merged with it, and what it owns is freed. Another kind or index during a
 * gesture begins a new group. Returns the last step, valid until the next
 * call. */
const struct edit_step *edit_history_add(struct edit_history *history,
                                         struct edit_step step);

/* Drops the last step, which is done, and all undone steps. */
void edit_history_drop_last(struct edit_history *history);

/* Marks the last done step as undone and returns it, for the caller to exchange
 * the values. Returns NULL if there is none, or if `group` is not NULL and the
 * step is not of that step's group. */
struct edit_step *edit_history_back(struct edit_history *history,
                                    const struct edit_step *group);

/* The same for the first undone step, which becomes done. */
struct edit_step *edit_history_forward(struct edit_history *history,
                                       const struct edit_step *group);

/* Replaces an empty history by the camera's steps (poses and numbered views) of
 * another one. */
void edit_history_take_camera(struct edit_history *history,
                              const struct edit_history *from);

void edit_history_free(struct edit_history *history);

#endif
