// SPDX-License-Identifier: MIT
/*
 * edit_history.h - all that a person changes of an opened scene, step by step
 * and back
 *
 * Values of materials, which object has which material, duplicates, light and
 * its development, the camera, numbered views. This is their only place; each
 * change goes through a function here. Changes that follow each other without
 * edit_end_step() between them are one step: a slider or a key that is held
 * down is undone at once.
 *
 * Units:     those of MTL and view files
 * Ownership: edit_free() frees; nothing of the scene or view is kept
 * Threads:   one thread at a time
 * Errors:    none; what has no memory ends the program, as small things do
 */
#ifndef GLIM_EDIT_HISTORY_H
#define GLIM_EDIT_HISTORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/name_table.h"
#include "scene/world_materials.h"

struct edit_state {
    struct mtl_source *sources; /* one a material */
    bool *is_there;     /* one a material; false: a duplicate that was undone */
    uint32_t *assigned; /* one an object, NO_INDEX: as in the file */
    struct view view;   /* its assigns are lines of the file, some without
                           effect */
};

struct edit_step;

struct edit {
    struct edit_state now;
    struct edit_state saved; /* as the files have it, or would: without the
                                size and bounces of the command line */
    bool is_comparing;       /* saved materials and light are to be shown */
    uint32_t version;        /* counts changes that need a new render */
    char **names;            /* of materials; those of files first */
    uint32_t *copied_from;   /* one a material; NO_INDEX: from a file */
    uint32_t material_count, object_count;
    struct name_table skies; /* paths of images to choose from; 0 is "" */

    struct edit_step *steps;
    size_t step_count, step_capacity;
    size_t done_count; /* the others were undone */
    uint32_t group;    /* of the next change */
    uint32_t gesture;  /* that it belongs to; 0: none */
    uint64_t gesture_ns;
    char step_text[128]; /* names the step that was undone or redone last */
};

/* Begins with a finished scene and its view. Assignments of objects or
 * materials that are not there are a warning. */
void edit_init(struct edit *edit, const struct scene *scene,
               const struct view *view, struct warnings *report);

/* The next change is a step of its own. */
void edit_end_step(struct edit *edit);

/* The next changes belong to a gesture: a key that is held, a parameter that is
 * turned; its number, above 0, is the caller's. They join the step of the same
 * gesture if that was shortly before. Returns true if a new step begins. */
bool edit_begin_gesture(struct edit *edit, uint32_t gesture, uint64_t now_ns);

/* What is equal to what was there is no change. */
void edit_material(struct edit *edit, uint32_t material,
                   const struct mtl_source *source);
void edit_assign(struct edit *edit, uint32_t object, uint32_t material);
void edit_lighting(struct edit *edit, const struct lighting *lighting);
void edit_pose(struct edit *edit, const struct pose *pose);

/* The camera of now becomes the numbered view, from 0. */
void edit_shot(struct edit *edit, int number);

/* A new material like this one under a new name; its number. */
uint32_t edit_duplicate(struct edit *edit, uint32_t material);

/* The number of the sky with this path. */
uint32_t edit_sky(struct edit *edit, const char *path);

/* One step back or forth. Returns the words that name the step, such as
 * "camera", until the next one; NULL if there is none. */
const char *edit_undo(struct edit *edit);
const char *edit_redo(struct edit *edit);

/* Shows what is saved of materials and light, or again what is now. */
void edit_compare(struct edit *edit, bool is_comparing);

/* Returns materials, assignments and light that are to be shown: of now, or
 * while comparing those that are saved. */
const struct edit_state *edit_shown(const struct edit *edit);

/* Returns the view to render: now's, with the light that is shown. It borrows
 * from the edit. */
struct view edit_view(const struct edit *edit);

/* True if the files have this material as it is now. */
bool edit_is_saved(const struct edit *edit, uint32_t material);

/* True if a material, or assignments and light, are not as in the files. */
bool edit_has_unsaved_materials(const struct edit *edit);
bool edit_has_unsaved_view(const struct edit *edit);

/* For a material that is to be saved over what the files have of another or the
 * same: takes back what was left by kinds that it has no more. False if there
 * is nothing to save. */
bool edit_simplify_material(struct edit *edit, uint32_t material,
                            uint32_t pattern);

/* A material's values are in the files now. */
void edit_saved_material(struct edit *edit, uint32_t material);

/* Puts light and assignments of now into a view. */
void edit_to_view(const struct edit *edit, const struct scene *scene,
                  struct view *view);

/* This view was written: its light and assignments, which are now's, are in the
 * file. edit_saved_view(): all of it. */
void edit_saved_lighting(struct edit *edit, const struct view *written);
void edit_saved_view(struct edit *edit, const struct view *written);

/* After the files were loaded anew into `edit`: takes the camera and its steps
 * over from the edit before, but for what the view file has changed. */
void edit_keep_camera(struct edit *edit, const struct edit *before);

void edit_free(struct edit *edit);

#endif
