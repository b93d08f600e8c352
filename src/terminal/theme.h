// SPDX-License-Identifier: MIT
/*
 * theme.h - colours of a terminal: its palettes, the control sequence that sets
 * them, and those of the text on the screen, by what the text is
 *
 * Units:     colours as in struct cell
 * Threads:   any
 */
#ifndef GLIM_THEME_H
#define GLIM_THEME_H

#include <stdbool.h>

#include "terminal/cells.h"

/* ---- control sequences ---- */

/* ---- palettes ---- */

/* Facts known before the terminal answers; NULL if a variable is not set. */
struct palette_facts {
    const char *no_color;  /* NO_COLOR */
    const char *colorterm; /* COLORTERM */
    const char *term;      /* TERM */
    const char *sty;       /* STY, set inside screen */
    const char *tmux;      /* TMUX, set inside tmux */
    int colors;            /* from terminfo; none if less than 8 */
    bool has_rgb;          /* terminfo has RGB or Tc */
};

/* Returns the palette. *is_final is true if the terminal's answers must not
 * raise it. */
enum palette palette_guess(const struct palette_facts *facts, bool *is_final);

/* Returns the name as a person sees it. */
const char *palette_name(enum palette palette);

/* ---- parameters ---- */

/* Bytes of the longest text: 38;2;255;255;255 */
#define SGR_COLOR_BYTES 16

enum sgr_ground { SGR_FOREGROUND = 30, SGR_BACKGROUND = 40 };

/* Writes the parameters for a colour of a cell, without a final 0. Returns
 * their end. All terminals parse the form with semicolons alike. */
char *sgr_color(char *to, uint32_t color, enum palette palette,
                enum sgr_ground ground);

/* Writes a number. Returns its end. */
char *sgr_number(char *to, uint32_t n);

/* ---- themes ---- */

/*
 * A theme has colours of its own for text and ground, so that text is legible
 * whatever colours the terminal has; THEME_PLAIN uses the terminal's and tells
 * parts apart by bold, dim and reverse, as palettes without colours do. The
 * contrast of text is 4.5:1 at least, as WCAG 2.1 asks (1.4.3).
 */

enum theme { THEME_DARK, THEME_LIGHT, THEME_PLAIN };

/* What a text is. */
enum text_role {
    ROLE_OUTSIDE,  /* the terminal's own colours */
    ROLE_TEXT,     /* in panels and windows */
    ROLE_FAINT,    /* explains, or cannot be changed */
    ROLE_TITLE,    /* of a panel, window or part of it */
    ROLE_KEY,      /* a key to press */
    ROLE_SELECTED, /* line that keys act on */
    ROLE_PICKED,   /* line that is selected while keys act elsewhere */
    ROLE_FRAME,    /* lines around and between */
    ROLE_STATUS,   /* the last row */
    ROLE_STATUS_FAINT,
    ROLE_STATUS_KEY,
    ROLE_LIVE, /* modes in the last row */
    ROLE_NORMAL,
    ROLE_PAUSED,
    ROLE_FAILED,
    ROLE_MESSAGE, /* in the last row */
    ROLE_GAUGE,   /* the filled part of a gauge; its ground is the rest */
    ROLES
};

enum text_attribute { TEXT_BOLD = 1, TEXT_DIM = 2, TEXT_REVERSE = 4 };

struct text_style {
    uint32_t fg, bg;
    unsigned attributes; /* enum text_attribute */
};

/* Returns how text of this role is written with the colours of a palette. */
struct text_style theme_style(enum theme theme, enum palette palette,
                              enum text_role role);

#endif
