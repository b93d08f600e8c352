// SPDX-License-Identifier: MIT
/*
 * glyph_memory.h - the glyphs that were chosen last on each terminal
 *
 * The file `glyphs` in the user's state folder has one terminal a line, the
 * last one first: the kind of glyphs and the terminal's name. Without such a
 * folder nothing is remembered.
 *
 * Threads:   main only
 */
#ifndef GLIM_GLYPH_MEMORY_H
#define GLIM_GLYPH_MEMORY_H

#include "terminal/term_caps.h"

/* Returns the remembered choice for a terminal; GLYPH_AUTO if there is none. */
enum glyph_mode glyph_memory_read(const char *terminal);

void glyph_memory_write(const char *terminal, enum glyph_mode mode);

#endif
