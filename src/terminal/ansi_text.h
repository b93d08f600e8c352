// SPDX-License-Identifier: MIT
/*
 * ansi_text.h - a picture as lines of coloured text
 *
 * The text has the same cells as the screen at the same size.
 *
 * Units:     terminal cells
 * Ownership: the text is for free()
 * Threads:   any
 * Errors:    memory
 */
#ifndef GLIM_ANSI_TEXT_H
#define GLIM_ANSI_TEXT_H

#include <stdbool.h>
#include <stddef.h>

#include "terminal/cells.h"

struct ansi_text_style {
    int cols, rows;
    enum palette palette;
    enum glyphs glyphs;
};

/* Initializes a frame of the size that the text needs, for frame_free(). */
bool ansi_text_frame_init(struct frame *frame,
                          const struct ansi_text_style *style,
                          struct error *err);

bool ansi_text_of_frame(const struct frame *frame,
                        const struct ansi_text_style *style, char **text,
                        size_t *size_bytes, struct error *err);

#endif
