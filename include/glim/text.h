// SPDX-License-Identifier: MIT
/*
 * text.h - a film as lines of coloured text
 *
 * The cells are those that the screen shows of the same film at the same size.
 *
 * Units:     terminal cells
 * Ownership: the text is for free()
 * Threads:   any; the film may be in use
 * Errors:    memory
 */
#ifndef GLIM_TEXT_H
#define GLIM_TEXT_H

#include "glim/cells.h"

struct text_style {
    int cols, rows;
    enum palette palette;
    enum glyphs glyphs;
};

bool text_of_film(struct film *film, struct develop how,
                  const struct text_style *style, char **text,
                  size_t *size_bytes, struct error *err);

#endif
