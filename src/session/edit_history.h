// SPDX-License-Identifier: MIT
/*
 * edit_history.h - what a person changes of an opened scene, step by step and
 * back
 *
 * Values of materials, which object has which material, duplicates, sky,
 * exposure and tone. Changes that follow each other without edit_break()
 * between them are one step: a slider that is held down is undone at once.
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

/* The light that is no surface, and how the picture is developed. */
struct mood {
    double background[3];
    bool has_background;
    uint32_t sky; /* of the edit's skies; 0: none */
    double sky_strength, sky_rotation_deg;
    double exposure;
    uint32_t tone;
};

struct edit_state {
    struct mtl_source *sources; /* one a material */
    bool *is_there;     /* one a material; false: a duplicate that was undone */
    uint32_t *assigned; /* one an object; NO_INDEX: as in the file */
    struct mood mood;
};

struct edit_step;

struct edit {
    struct edit_state now;
    struct edit_state saved; /* as the files have it */
    bool is_comparing;       /* what is saved is to be shown */
    char **names;            /* of materials; those of files first */
    uint32_t *copied_from;   /* one a material; NO_INDEX: from a file */
    uint32_t material_count, object_count;
    struct name_table skies; /* paths of images; 0 is "" */

    struct edit_step *steps;
    size_t step_count, step_capacity;
    size_t done_count; /* the others were undone */
    uint32_t group;    /* of the next change */
};

/* From a finished scene and its view. Assignments of objects or materials that
 * are not there are a warning. */
void edit_init(struct edit *edit, const struct scene *scene,
               const struct view *view, struct warnings *report);

/* The next change is a step of its own. */
void edit_break(struct edit *edit);

/* What is equal to what was there is no change. */
void edit_material(struct edit *edit, uint32_t material,
                   const struct mtl_source *source);
void edit_assign(struct edit *edit, uint32_t object, uint32_t material);
void edit_mood(struct edit *edit, const struct mood *mood);

/* A new material like this one under a new name; its number. */
uint32_t edit_duplicate(struct edit *edit, uint32_t material);

/* The number of the sky with this path. */
uint32_t edit_sky(struct edit *edit, const char *path);

/* One step back or forth; false if there is none. */
bool edit_undo(struct edit *edit);
bool edit_redo(struct edit *edit);

/* What is to be shown: now, or while comparing what is saved. */
const struct edit_state *edit_shown(const struct edit *edit);

/* True if the files have this material as it is now. */
bool edit_is_saved(const struct edit *edit, uint32_t material);

/* True if a material, or assignments and mood, are not as in the files. */
bool edit_has_unsaved_materials(const struct edit *edit);
bool edit_has_unsaved_view(const struct edit *edit);

/* For a material that is to be saved over what the files have of another or the
 * same: takes back what was left by kinds that it has no more. False if there
 * is nothing to save. */
bool edit_tidy_material(struct edit *edit, uint32_t material, uint32_t pattern);

/* A material's values, or assignments and mood, are in the files now. */
void edit_saved_material(struct edit *edit, uint32_t material);
void edit_saved_view(struct edit *edit);

/* Puts mood and assignments of a state into a view. */
void edit_to_view(const struct edit *edit, const struct edit_state *state,
                  const struct scene *scene, struct view *view);

void edit_free(struct edit *edit);

#endif
