// SPDX-License-Identifier: MIT
/*
 * batch_aov.h - files with properties of the surfaces, beside a picture
 *
 * Threads:   main only
 * Errors:    files that cannot be written or are those of other outputs
 */
#ifndef GLIM_BATCH_AOV_H
#define GLIM_BATCH_AOV_H

#include "inspect/view_modes.h"

/* Checks before the render that the files of --aov beside the picture can be
 * written. */
bool batch_aov_check(const struct session *s, const char *picture,
                     struct error *err);

/* Writes the files of --aov beside the picture. */
bool batch_aov_write(struct view_mode *show, const char *picture,
                     struct error *err);

#endif
