// SPDX-License-Identifier: MIT
/*
 * batch_picture.h - renders to a picture file: a program of libglim
 *
 * Threads:   main only
 * Errors:    one line that names file, option or device
 */
#ifndef GLIM_BATCH_PICTURE_H
#define GLIM_BATCH_PICTURE_H

#include "session/command_line.h"

/* True if the options want a picture of light and nothing that libglim has not:
 * text, statistics, maps, properties, other instructions or kernels. */
bool batch_picture_is_wanted(const struct options *o);

/* Renders and saves. *status is the exit status. */
bool batch_picture_run(const struct options *o, uint64_t start_ns, int *status,
                       struct error *err);

#endif
