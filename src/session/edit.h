// SPDX-License-Identifier: MIT
/*
 * edit.h - the editable state of an open scene, with undo and redo
 *
 * The state has the values of materials, the assignment of materials to
 * objects, duplicated materials, light, lamps, smoke, exposure and tone, the
 * camera, and numbered views. It exists only here, and every change is made by
 * a function of this file. Changes without edit_end_step() between them are one
 * step: the whole motion of a slider or of a held key is undone at once.
 *
 * Units:     those of MTL and view files; times are of clock_ns()
 * Ownership: edit_free() frees; scene and view are copied
 * Threads:   one thread at a time
 * Errors:    xmalloc() ends the program when memory is out
 */
#ifndef GLIM_EDIT_H
#define GLIM_EDIT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/name_table.h"
#include "scene/material.h"
#include "scene/view.h"
#include "world/world_materials.h"

/* ---- history ---- */

/*
 * A step is one changed value. It holds the value that the scene does not have:
 * the one before the change if the step is done, the one after it if the step
 * was undone. The caller (edit.c) exchanges it with the scene's. Steps of one
 * group are undone and redone together.
 */

enum edit_step_kind {
    STEP_MATERIAL,
    STEP_ASSIGN,
    STEP_DUPLICATE,
    STEP_LIGHTING,
    STEP_LAMPS,
    STEP_SMOKES,
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
    uint32_t index; /* of the material, object, lamp, smoke or numbered view */
    uint32_t group;
    union {
        /* the step's own; these are larger than other values, and most steps
         * are poses */
        struct material_values *source;
        struct lighting *lighting; /* its sky_path is borrowed from the edit */
        uint32_t material;
        bool is_there;
        struct lamps lamps; /* the step's own */
        struct smokes smokes;
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

/* ---- edits ---- */

struct edit_state {
    struct material_values *sources; /* for each material */
    bool *is_there; /* for each material; false for an undone duplicate */
    /* for each object the assigned material, or NO_INDEX for that of the OBJ
     * file */
    uint32_t *assigned;
    /* its assigns have all lines of the file, also those without effect */
    struct view view;
};

struct edit {
    struct edit_state now;
    /* state of the files; size and bounces are not those of the command line */
    struct edit_state saved;
    bool is_comparing; /* the saved state is shown */
    uint32_t version;  /* counts changes that restart the render */
    uint32_t changes;  /* counts all but those of the camera, and what is marked
                          as saved */
    char **names;      /* of materials; first those of files */
    /* for each material its original, or NO_INDEX if it is from a file */
    uint32_t *copied_from;
    uint32_t material_count, object_count;
    struct name_table skies; /* paths of known sky images; 0 is "" */
    struct edit_history history;
    char step_text[128]; /* name of the last undone or redone step */
};

/* Initialises the state from a finished scene and its view. Assignments of
 * unknown objects or materials are warnings. */
void edit_init(struct edit *edit, const struct scene *scene,
               const struct view *view, struct warnings *report);

/* Ends the current step. The next change begins a new one. */
void edit_end_step(struct edit *edit);

/* Assigns the next changes to a gesture: a held key or a parameter in motion.
 * The caller chooses its number, above 0. Changes join the step of the same
 * gesture if its last call was at most 0.7 s ago. Returns true if a new step
 * begins. */
bool edit_begin_gesture(struct edit *edit, uint32_t gesture, uint64_t now_ns);

/* Change one value. An equal value is not a change, and a step that comes back
 * to the value before it is dropped. */
void edit_material(struct edit *edit, uint32_t material,
                   const struct material_values *source);
void edit_assign(struct edit *edit, uint32_t object, uint32_t material);
void edit_lighting(struct edit *edit, const struct lighting *lighting);
void edit_lamp(struct edit *edit, uint32_t number, const struct lamp *lamp);
void edit_smoke(struct edit *edit, uint32_t number,
                const struct smoke_numbers *numbers);
void edit_pose(struct edit *edit, const struct pose *pose);

/* Appends a lamp, whose number is returned, and removes one. */
uint32_t edit_add_lamp(struct edit *edit, const struct lamp *lamp);
void edit_remove_lamp(struct edit *edit, uint32_t number);

/* Stores the current camera as a numbered view, from 0. */
void edit_shot(struct edit *edit, uint32_t number);

/* Duplicates a material under a new name, or under `name`, which no material
 * has. Returns the number of the duplicate. */
uint32_t edit_duplicate(struct edit *edit, uint32_t material);
uint32_t edit_duplicate_as(struct edit *edit, uint32_t material,
                           const char *name);

/* Takes camera, numbered views, light, lamps and smokes of a view, and a
 * material or NO_INDEX for each object, in the present step. */
void edit_take_view(struct edit *edit, const struct view *view,
                    const uint32_t *assigned);

/* Returns the number of the sky image with this path, which is added if new. */
uint32_t edit_sky(struct edit *edit, const char *path);

/* Undo or redo one step. Return its name, such as "camera", valid until the
 * next call, or NULL if there is no step. */
const char *edit_undo(struct edit *edit);
const char *edit_redo(struct edit *edit);

/* Drops all steps. The values stay. */
void edit_forget_steps(struct edit *edit);

/* Chooses whether the saved or the current materials and light are shown. */
void edit_compare(struct edit *edit, bool is_comparing);

/* Returns the shown state of materials, assignments and light: the current one,
 * or the saved one while comparing. */
const struct edit_state *edit_shown(const struct edit *edit);

/* Returns the view to render: the current one with the shown light. Its
 * pointers belong to the edit. */
struct view edit_view(const struct edit *edit);

/* Returns true if the material has the statements that are saved. */
bool edit_has_saved_statements(const struct edit *edit, uint32_t material);

/* Returns true if the saved statements make the present material: a type that
 * was changed and chosen again has more statements of the same meaning. */
bool edit_is_saved(const struct edit *edit, uint32_t material);

/* Return true if a material, or an assignment, a lamp, smoke or the light, is
 * not saved. */
bool edit_has_unsaved_materials(const struct edit *edit);
bool edit_has_unsaved_view(const struct edit *edit);

/* Simplifies a material before it is saved over the block of `pattern`:
 * restores statements of the file that have no effect on its kind. Returns
 * false if nothing remains to be saved. */
bool edit_simplify_material(struct edit *edit, uint32_t material,
                            uint32_t pattern);

/* Marks a material as saved. This and the two functions below end the
 * comparison. */
void edit_saved_material(struct edit *edit, uint32_t material);

/* Returns the material with this name, or NO_INDEX. */
uint32_t edit_find_material(const struct edit *edit, const char *name);

/* Copies the current light, lamps, smokes and assignments into a view. */
void edit_to_view(const struct edit *edit, const struct scene *scene,
                  struct view *view);

/* Mark light, lamps, smokes and assignments of the written view, which are the
 * current ones, or all of that view, as saved. */
void edit_saved_lighting(struct edit *edit, const struct view *written);
void edit_saved_view(struct edit *edit, const struct view *written);

/* Copies camera, numbered views and camera steps of `before` into an edit that
 * was loaded anew from the same files, except values that the view file has
 * changed. A camera that it has changed is a step. */
void edit_keep_camera(struct edit *edit, const struct edit *before);

void edit_free(struct edit *edit);

#endif
