// SPDX-License-Identifier: MIT
#include "terminal/term_caps.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "terminal/tty.h"

const char *const term_caps_glyph_names[] = {"auto",    "half",  "block",
                                             "braille", "shade", "space",
                                             "ascii",   "sixel", "kitty",
                                             NULL};

/* Plausible sizes and aspect ratios of cells; answers beyond them are
 * ignored. */
#define CELL_PX_MAX 200
#define ASPECT_MIN  0.5
#define ASPECT_MAX  5

enum palette term_caps_palette(enum color_mode mode)
{
    switch (mode) {
    case COLOR_MONO: return PALETTE_MONO;
    case COLOR_16: return PALETTE_16;
    case COLOR_256: return PALETTE_256;
    case COLOR_24BIT:
    case COLOR_AUTO: break;
    }
    return PALETTE_24BIT;
}

/* Returns the glyphs for automatic choice, and for pixels where there are
 * none. */
static enum glyphs common_glyphs(enum palette palette, bool has_unicode)
{
    if (palette == PALETTE_MONO)
        return has_unicode ? GLYPHS_BRAILLE : GLYPHS_ASCII;
    if (!has_unicode)
        return GLYPHS_SPACE;
    return palette == PALETTE_16 ? GLYPHS_SHADE : GLYPHS_BLOCK;
}

enum glyphs term_caps_glyphs(enum glyph_mode mode, enum palette palette,
                             bool has_unicode)
{
    switch (mode) {
    case GLYPH_HALF: return GLYPHS_HALF;
    case GLYPH_BLOCK: return GLYPHS_BLOCK;
    case GLYPH_BRAILLE: return GLYPHS_BRAILLE;
    case GLYPH_SHADE: return GLYPHS_SHADE;
    case GLYPH_SPACE: return GLYPHS_SPACE;
    case GLYPH_ASCII: return GLYPHS_ASCII;
    case GLYPH_AUTO:
    case GLYPH_SIXEL:
    case GLYPH_KITTY: break;
    }
    return common_glyphs(palette, has_unicode);
}

static void choose_palette(struct term_caps *d, enum color_mode mode)
{
    d->palette_is_final = true;
    if (mode == COLOR_AUTO)
        d->palette = tty_palette(&d->palette_is_final);
    else
        d->palette = term_caps_palette(mode);
}

static enum glyphs glyphs_of(const struct term_caps *d, enum glyph_mode mode)
{
    return term_caps_glyphs(mode, d->palette, d->has_unicode);
}

static void choose_glyphs(struct term_caps *d, enum glyph_mode mode)
{
    d->glyph_mode = mode;
    d->glyphs = glyphs_of(d, mode);
}

/* Chooses the theme. COLORFGBG ends with the number of the background among 16
 * colours, where it is set. */
static void choose_theme(struct term_caps *d, enum theme_mode mode)
{
    const char *colors = getenv("COLORFGBG");
    const char *ground = colors ? strrchr(colors, ';') : NULL;
    bool is_light =
        ground && (strcmp(ground, ";7") == 0 || strcmp(ground, ";15") == 0);

    d->theme_is_final = mode != THEME_MODE_AUTO;
    if (mode == THEME_MODE_AUTO)
        d->theme = is_light ? THEME_LIGHT : THEME_DARK;
    else
        d->theme = mode == THEME_MODE_PLAIN   ? THEME_PLAIN
                   : mode == THEME_MODE_LIGHT ? THEME_LIGHT
                                              : THEME_DARK;
}

/* Names the terminal by the environment, until it says its name. */
static void choose_name(struct term_caps *d)
{
    const char *program = getenv("TERM_PROGRAM");
    const char *version = getenv("TERM_PROGRAM_VERSION");
    const char *term = getenv("TERM");
    char text[2 * TTY_NAME_BYTES];

    if (program && program[0] != '\0')
        snprintf(text, sizeof text, "%s(%s)", program, version ? version : "");
    else
        snprintf(text, sizeof text, "%s", term ? term : "");
    tty_name(d->name, text, strlen(text));
}

void term_caps_init(struct term_caps *d, const struct term_caps_choice *choice)
{
    bool may_learn;

    *d = (struct term_caps){.cell_aspect = choice->cell_aspect,
                            .aspect_is_final = choice->cell_aspect > 0};
    d->has_unicode = tty_is_utf8(&may_learn);
    d->unicode_is_final = !may_learn;
    choose_palette(d, choice->color);
    choose_theme(d, choice->theme);
    choose_glyphs(d, choice->glyph);
    choose_name(d);
}

static bool is_cell_size(int width_px, int height_px)
{
    return width_px >= 1 && height_px >= 1 && width_px <= CELL_PX_MAX &&
           height_px <= CELL_PX_MAX;
}

static bool is_aspect(double height_over_width)
{
    return height_over_width >= ASPECT_MIN && height_over_width <= ASPECT_MAX;
}

double term_caps_cell_aspect(const struct term_caps *d,
                             const struct tty_size *size)
{
    if (d->cell_aspect > 0)
        return d->cell_aspect;
    /* over a network the system's pixel sizes can be wrong */
    if (is_aspect(size->cell_aspect))
        return size->cell_aspect;
    return 2;
}

bool term_caps_cell_size(const struct term_caps *d, const struct tty_size *size,
                         int *width_px, int *height_px)
{
    bool was_told = d->cell_width_px > 0;

    *width_px = was_told ? d->cell_width_px : size->cell_width_px;
    *height_px = was_told ? d->cell_height_px : size->cell_height_px;
    return is_cell_size(*width_px, *height_px);
}

enum pixel_graphics_kind term_caps_pixels(const struct term_caps *d)
{
    if (d->palette == PALETTE_MONO)
        return PIXEL_GRAPHICS_NONE;
    if (d->glyph_mode == GLYPH_SIXEL && d->has_sixel)
        return PIXEL_GRAPHICS_SIXEL;
    return d->glyph_mode == GLYPH_KITTY && d->has_kitty ? PIXEL_GRAPHICS_KITTY
                                                        : PIXEL_GRAPHICS_NONE;
}

const char *term_caps_lack(const struct term_caps *d)
{
    bool is_sixel = d->glyph_mode == GLYPH_SIXEL;

    if (!is_sixel && d->glyph_mode != GLYPH_KITTY)
        return NULL;
    if (d->palette == PALETTE_MONO)
        return is_sixel ? "sixels need colours" : "kitty pixels need colours";
    if (term_caps_pixels(d) == PIXEL_GRAPHICS_NONE)
        return is_sixel ? "the terminal reports no sixels"
                        : "the terminal reports no kitty pixels";
    return "this terminal does not say how large a character is";
}

static bool take_cell_size(struct term_caps *d, const struct event *event)
{
    double before = d->cell_aspect;
    double aspect;

    if (!is_cell_size(event->x, event->y))
        return false;
    d->cell_width_px = event->x;
    d->cell_height_px = event->y;
    if (d->aspect_is_final)
        return false;
    aspect = (double)event->y / event->x;
    if (!is_aspect(aspect))
        return false;
    if (before <= 0) {
        struct tty_size size = term_size();

        before = term_caps_cell_aspect(d, &size);
    }
    d->cell_aspect = aspect;
    return fabs(before - aspect) > 0.01 * aspect;
}

static bool take_true_color(struct term_caps *d)
{
    enum glyphs before = d->glyphs;

    if (!d->palette_is_final)
        d->palette = PALETTE_24BIT;
    choose_glyphs(d, d->glyph_mode);
    return d->glyphs != before;
}

/* Takes the cursor position after a character that begins with a byte outside
 * ASCII. Column 2 means that the terminal took the bytes for one character. */
static bool take_cursor(struct term_caps *d, const struct event *event)
{
    enum glyphs before = d->glyphs;

    if (!d->unicode_is_final)
        d->has_unicode = event->x == 2;
    d->unicode_is_final = true;
    choose_glyphs(d, d->glyph_mode);
    return d->glyphs != before;
}

bool term_caps_answer(struct term_caps *d, const struct event *event)
{
    switch (event->kind) {
    case EVENT_TRUE_COLOR: return take_true_color(d);
    case EVENT_BACKGROUND:
        if (!d->theme_is_final)
            d->theme = event->x > 0 ? THEME_LIGHT : THEME_DARK;
        break;
    case EVENT_SYNC: tty_use_sync(); break;
    case EVENT_CELL_SIZE: return take_cell_size(d, event);
    case EVENT_CURSOR: return take_cursor(d, event);
    case EVENT_SIXEL_COLORS: d->sixel_colors = event->x; break;
    case EVENT_KITTY: d->has_kitty = true; break;
    case EVENT_NAME: memcpy(d->name, event->name, sizeof d->name); break;
    case EVENT_ATTRIBUTES: d->has_sixel = event->x == 1; break;
    case EVENT_READY:
    case EVENT_KEY:
    case EVENT_PASTED:
    case EVENT_MOUSE: break;
    }
    return false;
}

void term_caps_next_palette(struct term_caps *d)
{
    d->palette_is_final = true;
    d->palette = d->palette == PALETTE_MONO ? PALETTE_24BIT
                                            : (enum palette)(d->palette - 1);
    choose_glyphs(d, d->glyph_mode);
}

static bool has_mode(const struct term_caps *d, enum glyph_mode mode)
{
    switch (mode) {
    case GLYPH_SIXEL: return d->has_sixel;
    case GLYPH_KITTY: return d->has_kitty;
    case GLYPH_ASCII: return true;
    case GLYPH_SHADE: return d->has_unicode && d->palette == PALETTE_16;
    case GLYPH_SPACE: return !d->has_unicode;
    default: return d->has_unicode;
    }
}

static bool is_pixels(enum glyph_mode mode)
{
    return mode == GLYPH_SIXEL || mode == GLYPH_KITTY;
}

void term_caps_next_glyphs(struct term_caps *d)
{
    static const enum glyph_mode modes[] = {GLYPH_BLOCK,   GLYPH_HALF,
                                            GLYPH_BRAILLE, GLYPH_SHADE,
                                            GLYPH_SPACE,   GLYPH_ASCII,
                                            GLYPH_SIXEL,   GLYPH_KITTY};
    size_t count = sizeof modes / sizeof modes[0];
    size_t i = 0;

    while (i < count && modes[i] != d->glyph_mode)
        i++;
    if (i == count) /* the automatic choice */
        for (i = 0; i < count && glyphs_of(d, modes[i]) != d->glyphs;)
            i++;
    do
        i = (i + 1) % count;
    while (!has_mode(d, modes[i]));
    choose_glyphs(d, modes[i]);
    if (!is_pixels(modes[i]) && d->glyphs == glyphs_of(d, GLYPH_AUTO))
        d->glyph_mode = GLYPH_AUTO;
}

bool term_caps_use_glyphs(struct term_caps *d, enum glyph_mode mode)
{
    if (mode != GLYPH_AUTO && !has_mode(d, mode))
        return false;
    choose_glyphs(d, mode);
    return true;
}
