// SPDX-License-Identifier: MIT
/*
 * term_caps.h - the terminal's capabilities, and which of them are used
 *
 * The first values come from the environment. The terminal's answers correct
 * them when they arrive.
 *
 * Units:     pixels of the terminal
 * Threads:   main only
 */
#ifndef GLIM_TERM_CAPS_H
#define GLIM_TERM_CAPS_H

#include <stdbool.h>

#include "terminal/pixel_graphics.h"
#include "terminal/theme.h"
#include "terminal/tty.h"
#include "terminal/tty_input.h"

enum color_mode { COLOR_AUTO, COLOR_MONO, COLOR_16, COLOR_256, COLOR_24BIT };

/* Requested drawing: glyphs as in enum glyphs, or pixels where the terminal has
 * them. */
enum glyph_mode {
    GLYPH_AUTO,
    GLYPH_HALF,
    GLYPH_BLOCK,
    GLYPH_BRAILLE,
    GLYPH_SHADE,
    GLYPH_SPACE,
    GLYPH_ASCII,
    GLYPH_SIXEL,
    GLYPH_KITTY
};

enum theme_mode {
    THEME_MODE_AUTO,
    THEME_MODE_DARK,
    THEME_MODE_LIGHT,
    THEME_MODE_PLAIN
};

/* Settings from the user. */
struct term_caps_choice {
    enum theme_mode theme;
    enum color_mode color;
    enum glyph_mode glyph;
    bool has_glyph;     /* `glyph` was given, if only as GLYPH_AUTO */
    double cell_aspect; /* height over width; 0: ask the terminal */
};

/* Names of the modes as options have them, ending with NULL. */
extern const char *const term_caps_glyph_names[];

struct term_caps {
    enum palette palette;
    bool palette_is_final;      /* no answer of the terminal changes it */
    enum glyph_mode glyph_mode; /* requested drawing */
    enum glyphs glyphs;         /* glyphs of the cells, chosen for it */
    bool has_unicode;           /* the terminal shows characters beyond ASCII */
    bool unicode_is_final;      /* no answer of the terminal changes it */
    enum theme theme;
    bool theme_is_final;       /* no answer of the terminal changes it */
    bool has_sixel, has_kitty; /* reported by the terminal */
    int sixel_colors;          /* 0 if not reported */
    int cell_width_px, cell_height_px; /* 0 if not reported */
    double cell_aspect;                /* 0 if unknown */
    bool aspect_is_final;
    char name[TTY_NAME_BYTES]; /* of the terminal, with its version if known */
};

/* Initializes from the environment, after tty_open(). */
void term_caps_init(struct term_caps *d, const struct term_caps_choice *choice);

/* Returns the palette of a mode, which must not be COLOR_AUTO. */
enum palette term_caps_palette(enum color_mode mode);

/* Returns the glyphs for a mode. Modes for pixels fall back to the common
 * glyphs: blocks, shades with 16 colours, or braille without colours; without
 * Unicode blanks, or characters without colours. */
enum glyphs term_caps_glyphs(enum glyph_mode mode, enum palette palette,
                             bool has_unicode);

/* Takes an answer of the terminal. Returns true if it changes the cells or
 * their shape. */
bool term_caps_answer(struct term_caps *d, const struct event *event);

/* Selects the next palette, from most colours to least and around. */
void term_caps_next_palette(struct term_caps *d);

/* Selects the next kind of glyphs that the terminal shows, and around. The kind
 * of the automatic choice becomes that again. */
void term_caps_next_glyphs(struct term_caps *d);

/* Selects a kind of glyphs. Returns false if the terminal does not show it. */
bool term_caps_use_glyphs(struct term_caps *d, enum glyph_mode mode);

/* Returns the kind of pixel graphics in use, if any. */
enum pixel_graphics_kind term_caps_pixels(const struct term_caps *d);

/* Returns why requested pixels are not shown, as the end of a sentence; NULL if
 * they are shown or were not requested. Call it when the terminal has answered
 * or will not. */
const char *term_caps_lack(const struct term_caps *d);

/* Returns the height of a cell over its width, from the first of these that is
 * known: the user's setting, the terminal's answer, the system's size, a common
 * value. */
double term_caps_cell_aspect(const struct term_caps *d,
                             const struct tty_size *size);

/* Finds the size of a cell in pixels. Returns false if it is unknown. */
bool term_caps_cell_size(const struct term_caps *d, const struct tty_size *size,
                         int *width_px, int *height_px);

#endif
