// SPDX-License-Identifier: MIT
/*
 * scene_files.h - scene files to choose from: those that were opened last,
 * those of a folder, and those that come with glim; and their last pictures
 *
 * Ownership: scene_files_free() frees; a zeroed struct is empty
 * Threads:   main only
 * Errors:    what cannot be read is not in the list
 */
#ifndef GLIM_SCENE_FILES_H
#define GLIM_SCENE_FILES_H

#include <stdbool.h>

#include "image/frame.h"

struct scene_file {
    char *path; /* absolute */
    char *text; /* what a person sees: its name, or a short path */
    const char *group;
    bool is_folder;
};

struct scene_files {
    char *folder; /* absolute path of the folder in the list */
    char *title;  /* of its group */
    struct scene_file *files;
    int count;
};

/* Lists what there is, with the scenes and folders of `folder` (NULL: the
 * current one). */
void scene_files_list(struct scene_files *s, const char *folder);
void scene_files_free(struct scene_files *s);

/* Returns true if the name of a file ends as those of a format that can be
 * read, perhaps with .gz behind it, and is not hidden. */
bool scene_files_reads(const char *name);

/* ---- pictures ---- */

/* Side of a picture in pixels, at most. */
#define SCENE_PICTURE_SIDE 128

/* Keeps a picture of a scene, in the user's state folder. */
void scene_picture_keep(const char *scene_path, const struct frame *frame);

/* Reads the picture of a scene that was kept, for frame_free(). Returns false
 * if there is none. */
bool scene_picture_read(const char *scene_path, struct frame *frame);

#endif
