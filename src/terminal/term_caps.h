// SPDX-License-Identifier: MIT
/*
 * term_caps.h - what the terminal can show, as far as it is known, and what of
 * it is wanted
 *
 * Begins with what the environment says; the terminal's answers tell better
 * when they come.
 *
 * Units:     pixels of the terminal
 * Threads:   main only
 */
#ifndef GLIM_TERM_CAPS_H
#define GLIM_TERM_CAPS_H

#include <stdbool.h>

#include "terminal/palette.h"
#include "terminal/pixel_graphics.h"
#include "terminal/tty.h"
#include "terminal/tty_input.h"

enum color_mode { COLOR_AUTO, COLOR_MONO, COLOR_16, COLOR_256, COLOR_24BIT };

/* The cells of enum glyphs, or pixels where the terminal has them. */
enum glyph_mode {
    GLYPH_AUTO,
    GLYPH_HALF,
    GLYPH_UPPER,
    GLYPH_LOWER,
    GLYPH_QUADRANT,
    GLYPH_SEXTANT,
    GLYPH_BRAILLE,
    GLYPH_SPACE,
    GLYPH_ASCII,
    GLYPH_SIXEL,
    GLYPH_KITTY
};

/* What the person has asked for. */
struct term_caps_choice {
    enum color_mode color;
    enum glyph_mode glyph;
    double cell_aspect; /* height of a cell over its width; 0: ask */
};

struct term_caps {
    enum palette palette;
    bool palette_is_final;      /* no answer of the terminal changes it */
    enum glyph_mode glyph_mode; /* what is wanted, */
    enum glyphs glyphs;         /* and what cells are made of for it */
    bool has_unicode;           /* characters beyond ASCII are seen as such */
    bool unicode_is_final;      /* no answer of the terminal changes it */
    bool has_sixel, has_kitty;  /* the terminal has said so */
    int sixel_colors;           /* 0: it has not said how many */
    int cell_width_px, cell_height_px; /* 0: it has not said */
    double cell_aspect;                /* 0: not known */
    bool aspect_is_final;
};

/* After tty_open(). */
void term_caps_init(struct term_caps *d, const struct term_caps_choice *choice);

/* What a mode that is not COLOR_AUTO means. */
enum palette term_caps_palette(enum color_mode mode);

/* What the cells are made of. Pixels have what is common as the fall-back: half
 * blocks, without colours braille; blanks and letters without Unicode. */
enum glyphs term_caps_glyphs(enum glyph_mode mode, enum palette palette,
                             bool has_unicode);

/* Takes an answer of the terminal. True if cells are others than before, or of
 * another shape. */
bool term_caps_answer(struct term_caps *d, const struct event *event);

/* The next palette, from most to least and round. */
void term_caps_next_palette(struct term_caps *d);

/* The next kind of glyphs that the terminal has, and round. */
void term_caps_next_glyphs(struct term_caps *d);

/* The pixels that are wanted instead of cells. */
enum pixel_graphics_kind term_caps_pixels(const struct term_caps *d);

/* Why there are none although they are wanted, as the end of a sentence; NULL:
 * nothing is amiss. The terminal has answered, or never will. */
const char *term_caps_lack(const struct term_caps *d);

/* Height of a cell over its width: what the person gave, what the terminal
 * answered, what the system says, what is common. */
double term_caps_cell_aspect(const struct term_caps *d,
                             const struct tty_size *size);

/* False if nobody has said how large a cell is. */
bool term_caps_cell_size(const struct term_caps *d, const struct tty_size *size,
                         int *width_px, int *height_px);

#endif
