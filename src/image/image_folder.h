// SPDX-License-Identifier: MIT
/*
 * image_folder.h - lists the image files beside a file
 *
 * Their first bytes tell images that can be read, whatever their names are;
 * TGA, which has no signature, needs its ending.
 *
 * Ownership: image_folder_free() frees the paths
 * Threads:   any
 * Errors:    folders and files that cannot be read are left out
 */
#ifndef GLIM_IMAGE_FOLDER_H
#define GLIM_IMAGE_FOLDER_H

/* Most images that are listed. */
#define IMAGE_FOLDER_MAX 1000

struct image_folder {
    char **paths; /* in the order of strcmp() */
    int count;
};

/* Lists the images in the folder of the file `beside` and in the folders in it,
 * without hidden ones. */
void image_folder_list(struct image_folder *images, const char *beside);

void image_folder_free(struct image_folder *images);

#endif
