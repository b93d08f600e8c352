// SPDX-License-Identifier: MIT
/*
 * batch_aov.h - properties of the surfaces, in files beside a picture or as
 * layers of its EXR file
 *
 * Threads:   main only
 * Errors:    files that cannot be written or are those of other outputs
 */
#ifndef GLIM_BATCH_AOV_H
#define GLIM_BATCH_AOV_H

#include "picture/image_write.h"
#include "inspect/view_modes.h"

/* Returns true if the properties are layers of the picture that the options
 * name. */
bool batch_aov_is_in_picture(const struct options *o);

/* Checks before the render that the files of --aov beside the picture can be
 * written. */
bool batch_aov_check(const struct session *s, const char *picture,
                     struct error *err);

/* Writes the files of --aov beside the picture, unless they are layers. */
bool batch_aov_write(struct view_mode *show, const char *picture,
                     struct error *err);

/* Writes the film and the layers of --aov to the picture. */
bool batch_aov_write_layers(struct view_mode *show, struct film *film,
                            const struct image_metadata *metadata,
                            struct error *err);

#endif
