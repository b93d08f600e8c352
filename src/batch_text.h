// SPDX-License-Identifier: MIT
/*
 * batch_text.h - the picture of a batch render as coloured text
 *
 * Threads:   main only
 * Errors:    memory; a file that cannot be written
 */
#ifndef GLIM_BATCH_TEXT_H
#define GLIM_BATCH_TEXT_H

#include "inspect/view_modes.h"

/* Returns the file for the text; NULL for standard output. */
const char *batch_text_path(const struct options *o);

/* Writes the picture of the view as text. *name becomes the name for messages,
 * for free(). */
bool batch_text_write(struct view_mode *show, struct film *film, char **name,
                      struct error *err);

#endif
